//! Bytes of a picture file → [`Picture`]: what textures are made of. Where a lookup lands and how bytes become light
//! is the shader's business.

use std::fmt;
use std::io::Cursor;
use std::path::Path;

use image::{ColorType, DynamicImage, ImageDecoder, ImageFormat, ImageReader, Limits};

/// A decoded picture; whatever transparency it had is ignored.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// The colours.
    pub pixels: PicturePixels,
    /// Whether it is a PNG or JPEG with a single channel, which Sunflow takes as linear light. The channel then stands
    /// in red, green and blue alike.
    pub grayscale: bool,
}

/// `width × height` pixels, row by row from the top left: red, green, blue.
#[derive(Debug, Clone, PartialEq)]
pub enum PicturePixels {
    /// Display-encoded (or whatever the author stored).
    Bytes(Vec<[u8; 3]>),
    /// Linear light.
    Floats(Vec<[f32; 3]>),
}

/// Why a file is not a usable picture.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DecodeError(String);

impl fmt::Display for DecodeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for DecodeError {}

impl Picture {
    /// Longest side, in pixels.
    pub const MAX_SIDE: u32 = 32_768;
    /// Most pixels: 400 MB of bytes.
    pub const MAX_PIXELS: u64 = 1 << 27;
    /// What can be read, for messages.
    pub const FORMATS: &str = "PNG, JPEG, GIF, BMP, TGA or Radiance HDR";

    /// Decodes a picture. Its first bytes tell the format; `path` only helps for TGA, which has no mark of its own.
    ///
    /// # Errors
    /// [`DecodeError`] when the format is unknown, the file damaged or the picture too large.
    pub fn decode(bytes: &[u8], path: &Path) -> Result<Picture, DecodeError> {
        let format = format_of(bytes, path)?;
        let reader = || ImageReader::with_format(Cursor::new(bytes), format);
        let failed = |error| DecodeError(format!("damaged {} picture: {error}", name_of(format)));

        // The size stands at the start of a file, before anything is allocated for the pixels.
        let (width, height) = reader().into_dimensions().map_err(failed)?;
        check_size(width, height)?;

        let mut limited = reader();
        limited.limits(limits());
        let decoder = limited.into_decoder().map_err(failed)?;
        let one_channel =
            matches!(decoder.color_type(), ColorType::L8 | ColorType::L16 | ColorType::La8 | ColorType::La16);
        let grayscale = one_channel && matches!(format, ImageFormat::Png | ImageFormat::Jpeg);
        let image = DynamicImage::from_decoder(decoder).map_err(failed)?;
        let pixels = match format {
            ImageFormat::Hdr => PicturePixels::Floats(image.into_rgb32f().pixels().map(|p| centred(p.0)).collect()),
            _ => PicturePixels::Bytes(image.into_rgb8().pixels().map(|p| p.0).collect()),
        };
        Ok(Picture { width, height, pixels, grayscale })
    }
}

fn format_of(bytes: &[u8], path: &Path) -> Result<ImageFormat, DecodeError> {
    let readable = |format: &ImageFormat| {
        use ImageFormat::{Bmp, Gif, Hdr, Jpeg, Png, Tga};
        matches!(format, Png | Jpeg | Gif | Bmp | Tga | Hdr)
    };
    let by_content = image::guess_format(bytes).ok().filter(readable);
    let is_tga = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("tga"));
    by_content.or(is_tga.then_some(ImageFormat::Tga)).ok_or_else(|| {
        let found = if bytes.is_empty() { "the file is empty" } else { "not a picture that can be read" };
        DecodeError(format!("{found}: expected {}", Picture::FORMATS))
    })
}

fn name_of(format: ImageFormat) -> &'static str {
    match format {
        ImageFormat::Png => "PNG",
        ImageFormat::Jpeg => "JPEG",
        ImageFormat::Gif => "GIF",
        ImageFormat::Bmp => "BMP",
        ImageFormat::Tga => "TGA",
        _ => "Radiance HDR",
    }
}

fn check_size(width: u32, height: u32) -> Result<(), DecodeError> {
    let too_long = width.max(height) > Picture::MAX_SIDE;
    if width == 0 || height == 0 {
        Err(DecodeError(format!("the picture is empty ({width} × {height} pixels)")))
    } else if too_long || u64::from(width) * u64::from(height) > Picture::MAX_PIXELS {
        let (side, millions) = (Picture::MAX_SIDE, Picture::MAX_PIXELS / 1_000_000);
        let limit = format!("at most {side} pixels a side and {millions} million in all");
        Err(DecodeError(format!("the picture is too large ({width} × {height} pixels): {limit}")))
    } else {
        Ok(())
    }
}

fn limits() -> Limits {
    let mut limits = Limits::default();
    limits.max_image_width = Some(Picture::MAX_SIDE);
    limits.max_image_height = Some(Picture::MAX_SIDE);
    limits.max_alloc = Some(2 << 30);
    limits
}

/// Sunflow takes the middle of a mantissa's step where the decoder takes its start: half a step of the shared exponent
/// is added, which the largest component (whose mantissa fills its byte) reveals.
fn centred(pixel: [f32; 3]) -> [f32; 3] {
    let largest = pixel[0].max(pixel[1]).max(pixel[2]);
    if largest <= 0.0 {
        return pixel;
    }
    // Clearing the fraction leaves the power of two at or below `largest`: 128 steps.
    let half_step = f32::from_bits(largest.to_bits() & 0x7f80_0000) / 256.0;
    pixel.map(|component| component + half_step)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn encoded(image: &DynamicImage, format: ImageFormat) -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        image.write_to(&mut bytes, format).expect("a small picture can be written");
        bytes.into_inner()
    }

    fn color_image() -> DynamicImage {
        image::RgbImage::from_fn(7, 4, |x, y| image::Rgb([x as u8 * 30, y as u8 * 60, 77])).into()
    }

    #[test]
    fn every_format_is_read() {
        let image = color_image();
        let expected: Vec<_> = image.to_rgb8().pixels().map(|p| p.0).collect();
        for format in [ImageFormat::Png, ImageFormat::Bmp, ImageFormat::Tga, ImageFormat::Gif, ImageFormat::Jpeg] {
            let picture =
                Picture::decode(&encoded(&image, format), Path::new("some/texture.TGA")).expect("can be read");
            assert_eq!((picture.width, picture.height, picture.grayscale), (7, 4, false));
            let PicturePixels::Bytes(pixels) = picture.pixels else { panic!("{format:?} holds bytes") };
            let slack = if format == ImageFormat::Jpeg { 24 } else { 0 };
            let far = |(a, b): (&[u8; 3], &[u8; 3])| (0..3).any(|i| a[i].abs_diff(b[i]) > slack);
            assert!(!pixels.iter().zip(&expected).any(far), "{format:?}: {pixels:?}");
        }
    }

    #[test]
    fn single_channels_are_marked() {
        let gray = DynamicImage::from(color_image().to_luma8());
        for (format, marked) in [(ImageFormat::Png, true), (ImageFormat::Jpeg, true), (ImageFormat::Tga, false)] {
            let picture = Picture::decode(&encoded(&gray, format), Path::new("a.tga")).expect("can be read");
            assert_eq!(picture.grayscale, marked, "{format:?}");
        }
    }

    #[test]
    fn hdr_mantissas_stand_for_the_middle_of_their_step() {
        let file = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n\x80\x40\x00\x81\xff\xff\xff\x00";
        let picture = Picture::decode(file, Path::new("a.hdr")).expect("can be read");
        let step = 2.0_f32.powi(129 - 136);
        let first = [128.5 * step, 64.5 * step, 0.5 * step];
        assert_eq!(picture.pixels, PicturePixels::Floats(vec![first, [0.0; 3]]));
    }

    #[test]
    fn what_is_no_picture_says_so() {
        let message = |bytes: &[u8]| Picture::decode(bytes, Path::new("a.png")).expect_err("no picture").to_string();
        assert_eq!(message(b""), "the file is empty: expected PNG, JPEG, GIF, BMP, TGA or Radiance HDR");
        assert!(message(b"hello").starts_with("not a picture that can be read: expected PNG"));
        assert!(message(b"\x89PNG\r\n\x1a\n").starts_with("damaged PNG picture: "));
    }

    #[test]
    fn huge_sizes_are_refused_before_they_are_allocated() {
        let mut png = encoded(&color_image(), ImageFormat::Png);
        png[16..24].copy_from_slice(&[0x00, 0x00, 0x7f, 0xff, 0x00, 0x00, 0x7f, 0xff]);
        let crc = crc_of(&png[12..29]);
        png[29..33].copy_from_slice(&crc.to_be_bytes());
        let message = Picture::decode(&png, Path::new("a.png")).expect_err("too large").to_string();
        assert!(message.starts_with("the picture is too large (32767 × 32767 pixels)"), "{message}");
    }

    /// CRC-32 as PNG chunks carry it.
    fn crc_of(bytes: &[u8]) -> u32 {
        let step = |crc: u32| if crc & 1 == 1 { (crc >> 1) ^ 0xedb8_8320 } else { crc >> 1 };
        !bytes.iter().fold(!0_u32, |crc, &byte| (0..8).fold(crc ^ u32::from(byte), |crc, _| step(crc)))
    }

    #[test]
    fn damaged_files_never_panic() {
        let image = color_image();
        let mut state = 1_u32;
        for format in [ImageFormat::Png, ImageFormat::Bmp, ImageFormat::Tga, ImageFormat::Gif, ImageFormat::Jpeg] {
            let whole = encoded(&image, format);
            for cut in 0..whole.len() {
                let _ = Picture::decode(&whole[..cut], Path::new("a.tga"));
                let mut broken = whole.clone();
                state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                broken[cut] ^= (state >> 24) as u8 | 1;
                if let Ok(picture) = Picture::decode(&broken, Path::new("a.tga")) {
                    assert!(u64::from(picture.width) * u64::from(picture.height) <= Picture::MAX_PIXELS);
                }
            }
        }
    }
}
