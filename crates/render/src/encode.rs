//! Image → bytes of a picture file. Which file they go to is the caller's business.

use std::fmt;
use std::io::Cursor;
use std::path::Path;

use exr::prelude::{self as openexr, WritableImage as _};
use image::ExtendedColorType::{Rgb8, Rgb16, Rgba8, Rgba16};
use image::codecs::{bmp, hdr, jpeg, png, tiff};
use image::{ExtendedColorType, ImageEncoder};

use crate::develop::{Alpha, Depth, Image, Samples, develop, is_transparent};
use crate::film::{Film, Pixel};

/// A kind of picture file.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Format {
    /// Display-encoded, without loss; straight alpha unless every pixel is covered.
    Png(Depth),
    /// Display-encoded, with slight loss, on black.
    Jpeg,
    /// Linear light as 32-bit floats, with alpha (colours multiplied by it, as the format wants).
    Exr,
    /// Linear light with a shared exponent (Radiance), on black.
    Hdr,
    /// As PNG, uncompressed.
    Tiff(Depth),
    /// Display-encoded, uncompressed, on black.
    Bmp,
}

impl Format {
    /// The extensions that [`Self::from_path`] knows, for messages.
    pub const EXTENSIONS: &[&str] = &["png", "jpg", "jpeg", "exr", "hdr", "tif", "tiff", "bmp"];

    /// The format that the path's extension names, with 8 bits where there is a choice.
    ///
    /// # Errors
    /// [`UnknownFormat`] when there is no extension or not one of [`Self::EXTENSIONS`].
    pub fn from_path(path: &Path) -> Result<Format, UnknownFormat> {
        let extension = path.extension().map(|extension| extension.to_string_lossy().into_owned());
        match extension.as_deref().unwrap_or_default().to_ascii_lowercase().as_str() {
            "png" => Ok(Format::Png(Depth::Eight)),
            "jpg" | "jpeg" => Ok(Format::Jpeg),
            "exr" => Ok(Format::Exr),
            "hdr" => Ok(Format::Hdr),
            "tif" | "tiff" => Ok(Format::Tiff(Depth::Eight)),
            "bmp" => Ok(Format::Bmp),
            _ => Err(UnknownFormat { extension }),
        }
    }

    /// The same format with samples of that depth; `None` where the format offers no choice.
    #[must_use]
    pub fn with_depth(self, depth: Depth) -> Option<Format> {
        match self {
            Format::Png(_) => Some(Format::Png(depth)),
            Format::Tiff(_) => Some(Format::Tiff(depth)),
            Format::Jpeg | Format::Exr | Format::Hdr | Format::Bmp => None,
        }
    }

    /// What people call it.
    pub fn name(self) -> &'static str {
        match self {
            Format::Png(_) => "PNG",
            Format::Jpeg => "JPEG",
            Format::Exr => "OpenEXR",
            Format::Hdr => "Radiance HDR",
            Format::Tiff(_) => "TIFF",
            Format::Bmp => "BMP",
        }
    }
}

/// The extension of a path names no picture format.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct UnknownFormat {
    /// The extension, without its dot, if there was one.
    pub extension: Option<String>,
}

impl fmt::Display for UnknownFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.extension {
            Some(extension) => write!(f, "unknown picture format `.{extension}`"),
            None => f.write_str("a picture's name needs an extension"),
        }
    }
}

impl std::error::Error for UnknownFormat {}

/// A picture that its format cannot hold (a JPEG wider than 65535 pixels, for instance).
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct EncodeError {
    format: Format,
    reason: String,
}

impl fmt::Display for EncodeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "cannot be written as {}: {}", self.format.name(), self.reason)
    }
}

impl std::error::Error for EncodeError {}

/// The bytes of a picture file.
///
/// # Errors
/// [`EncodeError`] when the format cannot hold a picture of this size.
pub fn encode(film: &Film, format: Format) -> Result<Vec<u8>, EncodeError> {
    let mut bytes = Vec::new();
    match format {
        Format::Png(depth) => write_png(&mut bytes, &develop(film, depth, Alpha::Straight)),
        Format::Tiff(depth) => {
            write(tiff::TiffEncoder::new(Cursor::new(&mut bytes)), &develop(film, depth, Alpha::Straight))
        }
        Format::Jpeg => {
            let image = develop(film, Depth::Eight, Alpha::OnBlack);
            write(jpeg::JpegEncoder::new_with_quality(&mut bytes, JPEG_QUALITY), &image)
        }
        Format::Bmp => write(bmp::BmpEncoder::new(&mut bytes), &develop(film, Depth::Eight, Alpha::OnBlack)),
        Format::Hdr => write_hdr(&mut bytes, film),
        Format::Exr => write_exr(&mut bytes, film),
    }
    .map_err(|reason| EncodeError { format, reason })?;
    Ok(bytes)
}

/// High enough that blocks do not show in smooth shading.
const JPEG_QUALITY: u8 = 95;

fn write_png(bytes: &mut Vec<u8>, image: &Image) -> Result<(), String> {
    // 640 × 480 rendered pixels take 2–4 ms; the encoder's default takes 25–70 ms for a file a fifth to a half smaller.
    let (compression, filter) = (png::CompressionType::Fast, png::FilterType::Paeth);
    write(png::PngEncoder::new_with_quality(bytes, compression, filter), image)
}

fn write(encoder: impl ImageEncoder, image: &Image) -> Result<(), String> {
    let alpha = image.channel_count == 4;
    let write = |samples: &[u8], color: ExtendedColorType| {
        encoder.write_image(samples, image.width, image.height, color).map_err(|error| error.to_string())
    };
    match &image.samples {
        Samples::Eight(samples) => write(samples, if alpha { Rgba8 } else { Rgb8 }),
        Samples::Sixteen(samples) => {
            // The encoders take 16-bit samples as bytes in the machine's own order.
            let native: Vec<u8> = samples.iter().flat_map(|sample| sample.to_ne_bytes()).collect();
            write(&native, if alpha { Rgba16 } else { Rgb16 })
        }
    }
}

fn write_hdr(bytes: &mut Vec<u8>, film: &Film) -> Result<(), String> {
    let light = |pixel: &Pixel| {
        let [red, green, blue, _] = film.linear(pixel);
        image::Rgb([red.max(0.0), green.max(0.0), blue.max(0.0)])
    };
    let pixels: Vec<_> = film.pixels.iter().map(light).collect();
    let encoder = hdr::HdrEncoder::new(bytes);
    encoder.encode(&pixels, film.width as usize, film.height as usize).map_err(|error| error.to_string())
}

fn write_exr(bytes: &mut Vec<u8>, film: &Film) -> Result<(), String> {
    let size = (film.width as usize, film.height as usize);
    let encoding = openexr::Encoding {
        compression: openexr::Compression::ZIP16,
        blocks: openexr::Blocks::ScanLines,
        line_order: openexr::LineOrder::Increasing,
    };
    let at = |place: openexr::Vec2<usize>| film.linear(&film.pixels[place.y() * size.0 + place.x()]);
    let out = Cursor::new(bytes);
    let attributes = || openexr::LayerAttributes::default();
    if is_transparent(film) {
        let channels = openexr::SpecificChannels::rgba(|place| {
            let [red, green, blue, alpha] = at(place);
            (red, green, blue, alpha)
        });
        let layer = openexr::Layer::new(size, attributes(), encoding, channels);
        openexr::Image::from_layer(layer).write().non_parallel().to_buffered(out)
    } else {
        let channels = openexr::SpecificChannels::rgb(|place| {
            let [red, green, blue, _] = at(place);
            (red, green, blue)
        });
        let layer = openexr::Layer::new(size, attributes(), encoding, channels);
        openexr::Image::from_layer(layer).write().non_parallel().to_buffered(out)
    }
    .map_err(|error| error.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::Encoding;
    use crate::picture::{Picture, PicturePixels};
    use jaspe_scene::srgb_decode;

    /// A gradient with colours that an 8-bit display holds exactly, and one uncovered pixel if asked for.
    fn film(alpha: f32) -> Film {
        let mut film = Film::new(9, 5, Encoding::Linear);
        for (i, pixel) in film.pixels.iter_mut().enumerate() {
            let light = |byte: usize| srgb_decode(byte as f64 / 255.0) as f32;
            *pixel = [light(5 * i), light(255 - i), light(100), 1.0];
        }
        film.pixels[7] = [0.0, 0.0, 0.0, alpha];
        film
    }

    fn expected() -> Vec<[u8; 3]> {
        (0..45).map(|i| if i == 7 { [0; 3] } else { [5 * i, 255 - i, 100] }).collect()
    }

    fn decoded(format: Format, alpha: f32) -> Picture {
        let bytes = encode(&film(alpha), format).expect("a small picture fits every format");
        Picture::decode(&bytes, Path::new("x")).expect("what was written can be read")
    }

    #[test]
    fn lossless_formats_return_every_byte() {
        for alpha in [0.0, 1.0] {
            for format in [Format::Png(Depth::Eight), Format::Png(Depth::Sixteen), Format::Bmp] {
                let picture = decoded(format, alpha);
                assert_eq!((picture.width, picture.height, picture.grayscale), (9, 5, false));
                assert_eq!(picture.pixels, PicturePixels::Bytes(expected()), "{format:?}");
            }
            for depth in [Depth::Eight, Depth::Sixteen] {
                let bytes = encode(&film(alpha), Format::Tiff(depth)).expect("fits");
                let image = image::load_from_memory(&bytes).expect("is a TIFF");
                assert_eq!(image.color().has_alpha(), alpha == 0.0);
                assert_eq!(image.into_rgb8().pixels().map(|p| p.0).collect::<Vec<_>>(), expected());
            }
        }
    }

    #[test]
    fn png_holds_alpha_only_where_something_is_uncovered() {
        for (alpha, depth, color) in [
            (1.0, Depth::Eight, image::ColorType::Rgb8),
            (0.5, Depth::Eight, image::ColorType::Rgba8),
            (1.0, Depth::Sixteen, image::ColorType::Rgb16),
            (0.0, Depth::Sixteen, image::ColorType::Rgba16),
        ] {
            let bytes = encode(&film(alpha), Format::Png(depth)).expect("fits");
            assert_eq!(image::load_from_memory(&bytes).expect("is a PNG").color(), color);
        }
    }

    #[test]
    fn linear_formats_keep_light_beyond_white() {
        let mut bright = film(1.0);
        bright.pixels[3] = [40.0, 0.5, 0.0, 1.0];
        let bytes = encode(&bright, Format::Hdr).expect("fits");
        let picture = Picture::decode(&bytes, Path::new("x.hdr")).expect("can be read");
        let PicturePixels::Floats(pixels) = picture.pixels else { panic!("HDR holds floats") };
        assert!((pixels[3][0] - 40.0).abs() < 0.2, "{:?}", pixels[3]);

        let bytes = encode(&bright, Format::Exr).expect("fits");
        assert_eq!(read_exr(&bytes), bright.pixels);
    }

    #[test]
    fn exr_of_a_display_film_is_linear() {
        let mut display = Film::new(2, 1, Encoding::Display);
        display.pixels = vec![[0.5, 1.0, 0.0, 1.0]; 2];
        let pixel = read_exr(&encode(&display, Format::Exr).expect("fits"))[0];
        assert!((pixel[0] - 0.2140).abs() < 1e-4 && pixel[1..] == [1.0, 0.0, 1.0], "{pixel:?}");
    }

    fn read_exr(bytes: &[u8]) -> Vec<Pixel> {
        use openexr::{ReadChannels as _, ReadLayers as _};
        openexr::read()
            .no_deep_data()
            .largest_resolution_level()
            .rgba_channels(
                |size, _| (size.width(), vec![[0.0; 4]; size.area()]),
                |(width, pixels): &mut (usize, Vec<Pixel>), at, (r, g, b, a): (f32, f32, f32, f32)| {
                    pixels[at.y() * *width + at.x()] = [r, g, b, a];
                },
            )
            .first_valid_layer()
            .all_attributes()
            .from_buffered(Cursor::new(bytes))
            .expect("is an EXR")
            .layer_data
            .channel_data
            .pixels
            .1
    }

    #[test]
    fn extensions_name_formats() {
        let named = |path: &str| Format::from_path(Path::new(path));
        for extension in Format::EXTENSIONS {
            assert!(named(&format!("a.b.{}", extension.to_uppercase())).is_ok());
        }
        assert_eq!(named("a.jpg"), Ok(Format::Jpeg));
        let message = |path| named(path).map_err(|error| error.to_string());
        assert_eq!(message("a.webm"), Err("unknown picture format `.webm`".to_owned()));
        assert_eq!(message("folder.png/a"), Err("a picture's name needs an extension".to_owned()));
        assert_eq!(Format::Jpeg.with_depth(Depth::Sixteen), None);
    }

    #[test]
    fn too_wide_a_jpeg_is_an_error() {
        let error = encode(&Film::new(70_000, 1, Encoding::Linear), Format::Jpeg).expect_err("JPEG ends at 65535");
        assert!(error.to_string().starts_with("cannot be written as JPEG: "), "{error}");
    }
}
