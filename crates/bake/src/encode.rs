//! Rows of a map → a picture file, as the rows come.

use std::fmt;
use std::io::{self, BufWriter, Write};
use std::sync::mpsc::{SyncSender, sync_channel};
use std::thread::JoinHandle;

use exr::block::writer::ChunksWriter as _;
use exr::block::{BlockIndex, UncompressedBlock};
use exr::meta::attribute::{ChannelDescription, SampleType, Text};
use exr::meta::header::Header;
use exr::prelude::{Compression, LineOrder, Vec2, f16};
use image::{ExtendedColorType, ImageEncoder as _};
use jaspe_scene::srgb_decode;

use crate::map::{ColorSpace, Map};

/// A kind of picture file for maps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum MapFormat {
    /// Without loss, 8 bits per sample.
    Png8,
    /// Without loss, 16 bits per sample.
    Png16,
    /// OpenEXR with 16-bit floats; colours as linear light.
    ExrHalf,
    /// OpenEXR with 32-bit floats; colours as linear light.
    ExrFloat,
    /// With slight loss, 8 bits per sample.
    Jpeg,
    /// Without loss, 8 bits per sample.
    WebP,
}

impl MapFormat {
    /// Every format.
    pub const ALL: &[MapFormat] =
        &[MapFormat::Png8, MapFormat::Png16, MapFormat::ExrHalf, MapFormat::ExrFloat, MapFormat::Jpeg, MapFormat::WebP];

    /// The extension of its files.
    pub fn extension(self) -> &'static str {
        match self {
            MapFormat::Png8 | MapFormat::Png16 => "png",
            MapFormat::ExrHalf | MapFormat::ExrFloat => "exr",
            MapFormat::Jpeg => "jpg",
            MapFormat::WebP => "webp",
        }
    }

    /// What kind of bytes its files hold.
    pub fn mime_type(self) -> &'static str {
        match self {
            MapFormat::Png8 | MapFormat::Png16 => "image/png",
            MapFormat::ExrHalf | MapFormat::ExrFloat => "image/x-exr",
            MapFormat::Jpeg => "image/jpeg",
            MapFormat::WebP => "image/webp",
        }
    }

    /// Bits per sample.
    pub fn bits(self) -> u32 {
        match self {
            MapFormat::Png8 | MapFormat::Jpeg | MapFormat::WebP => 8,
            MapFormat::Png16 | MapFormat::ExrHalf => 16,
            MapFormat::ExrFloat => 32,
        }
    }

    /// Whether colours are stored as linear light.
    pub fn is_linear(self) -> bool {
        matches!(self, MapFormat::ExrHalf | MapFormat::ExrFloat)
    }

    /// The longest side that its files may have, where that is shorter than [`crate::Bake::MAX_SIZE`].
    pub fn max_side(self) -> Option<u32> {
        (self == MapFormat::WebP).then_some(16_383)
    }
}

impl fmt::Display for MapFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            MapFormat::Png8 => "PNG, 8 bits",
            MapFormat::Png16 => "PNG, 16 bits",
            MapFormat::ExrHalf => "OpenEXR, half floats",
            MapFormat::ExrFloat => "OpenEXR, floats",
            MapFormat::Jpeg => "JPEG",
            MapFormat::WebP => "WebP, lossless",
        })
    }
}

/// A file that rows of a map are added to, from the top.
pub(crate) trait MapWriter: Send {
    /// Adds rows: as many as a band has, save for the last ones.
    fn rows(&mut self, values: &[f32]) -> io::Result<()>;
    /// Completes the file.
    fn finish(self: Box<Self>) -> io::Result<()>;
}

/// A writer of this format into `out`.
pub(crate) fn writer<W: Write + io::Seek + Send + 'static>(
    out: W,
    map: Map,
    format: MapFormat,
    extent: [u32; 2],
) -> io::Result<Box<dyn MapWriter>> {
    Ok(match format {
        MapFormat::Png8 => Box::new(Png::new(out, map, png::BitDepth::Eight, extent)?),
        MapFormat::Png16 => Box::new(Png::new(out, map, png::BitDepth::Sixteen, extent)?),
        MapFormat::ExrHalf => Box::new(Exr::new(out, map, SampleType::F16, extent)),
        MapFormat::ExrFloat => Box::new(Exr::new(out, map, SampleType::F32, extent)),
        MapFormat::Jpeg | MapFormat::WebP => Box::new(Whole { out, map, format, extent, samples: Vec::new() }),
    })
}

/// A number from 0 to 1 as one of 256.
fn byte(value: f32) -> u8 {
    (255.0 * value.clamp(0.0, 1.0) + 0.5) as u8
}

fn is_gray(map: Map) -> bool {
    map.declaration().channels == 1
}

struct Png<W: Write + Send + 'static> {
    stream: png::StreamWriter<'static, BufWriter<W>>,
    depth: png::BitDepth,
}

impl<W: Write + Send + 'static> Png<W> {
    fn new(out: W, map: Map, depth: png::BitDepth, [width, height]: [u32; 2]) -> io::Result<Self> {
        let mut encoder = png::Encoder::new(BufWriter::new(out), width, height);
        encoder.set_color(if is_gray(map) { png::ColorType::Grayscale } else { png::ColorType::Rgb });
        encoder.set_depth(depth);
        encoder.set_compression(png::Compression::Fast);
        encoder.set_filter(png::Filter::Paeth);
        if map.declaration().color_space == ColorSpace::Srgb {
            encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
        }
        Ok(Png { stream: encoder.write_header()?.into_stream_writer()?, depth })
    }
}

impl<W: Write + Send + 'static> MapWriter for Png<W> {
    fn rows(&mut self, values: &[f32]) -> io::Result<()> {
        let bytes: Vec<u8> = match self.depth {
            png::BitDepth::Sixteen => {
                let sample = |value: &f32| (65535.0 * f64::from(value.clamp(0.0, 1.0)) + 0.5) as u16;
                values.iter().flat_map(|value| sample(value).to_be_bytes()).collect()
            }
            _ => values.iter().map(|&value| byte(value)).collect(),
        };
        self.stream.write_all(&bytes)
    }

    fn finish(mut self: Box<Self>) -> io::Result<()> {
        self.stream.flush()?;
        Ok(self.stream.finish()?)
    }
}

/// The library asks for its rows, so it has a thread of its own, to which they are sent.
struct Exr {
    rows: SyncSender<Vec<f32>>,
    thread: JoinHandle<Result<(), exr::error::Error>>,
}

/// Lines that are compressed together.
const EXR_LINES: usize = 16;

impl Exr {
    fn new<W: Write + io::Seek + Send + 'static>(
        out: W,
        map: Map,
        sample_type: SampleType,
        [width, height]: [u32; 2],
    ) -> Self {
        let (rows, received) = sync_channel::<Vec<f32>>(1);
        let (width, height) = (width as usize, height as usize);
        // The channels of a line, in the order of their names.
        let names: &'static [(&str, usize)] = if is_gray(map) { &[("Y", 0)] } else { &[("B", 2), ("G", 1), ("R", 0)] };
        let count = names.len();
        let channels = names.iter().map(|(name, _)| ChannelDescription::new(Text::from(*name), sample_type, false));
        let header = Header::new(Text::from("map"), (width, height), channels.collect());
        let blocks = exr::meta::BlockDescription::ScanLines;
        let header = header.with_encoding(Compression::ZIP16, blocks, LineOrder::Increasing);
        let decode = map.declaration().color_space == ColorSpace::Srgb;
        let thread = std::thread::spawn(move || {
            exr::block::write(BufWriter::new(out), std::iter::once(header).collect(), true, |meta, chunks| {
                let mut compressor = chunks.sequential_blocks_compressor(&meta);
                let mut top = 0;
                for band in received {
                    for lines in band.chunks(EXR_LINES * width * count) {
                        let mut data = Vec::with_capacity(lines.len() * sample_type.bytes_per_sample());
                        for line in lines.chunks_exact(width * count) {
                            for (_, channel) in names {
                                for &value in line[*channel..].iter().step_by(count) {
                                    let value = if decode { srgb_decode(f64::from(value)) as f32 } else { value };
                                    match sample_type {
                                        SampleType::F16 => data.extend(f16::from_f32(value).to_ne_bytes()),
                                        _ => data.extend(value.to_ne_bytes()),
                                    }
                                }
                            }
                        }
                        let size = Vec2(width, lines.len() / (width * count));
                        let index =
                            BlockIndex { layer: 0, pixel_position: Vec2(0, top), pixel_size: size, level: Vec2(0, 0) };
                        compressor.compress_block(top / EXR_LINES, UncompressedBlock { index, data })?;
                        top += size.1;
                    }
                }
                Ok(())
            })
        });
        Exr { rows, thread }
    }

    fn join(thread: JoinHandle<Result<(), exr::error::Error>>) -> io::Result<()> {
        match thread.join() {
            Ok(Ok(())) => Ok(()),
            Ok(Err(exr::error::Error::Io(error))) => Err(error),
            Ok(Err(error)) => Err(io::Error::other(error)),
            Err(_) => Err(io::Error::other("the OpenEXR writer ended early")),
        }
    }
}

impl MapWriter for Exr {
    fn rows(&mut self, values: &[f32]) -> io::Result<()> {
        // (Why the other end is gone, the thread's result tells.)
        self.rows.send(values.to_vec()).map_err(|_| io::Error::other("the OpenEXR writer ended early"))
    }

    fn finish(self: Box<Self>) -> io::Result<()> {
        drop(self.rows);
        Self::join(self.thread)
    }
}

/// Formats whose encoders take whole pictures: the rows are kept as bytes.
struct Whole<W> {
    out: W,
    map: Map,
    format: MapFormat,
    extent: [u32; 2],
    samples: Vec<u8>,
}

/// High enough that blocks do not show in smooth shading.
const JPEG_QUALITY: u8 = 95;

impl<W: Write + Send> MapWriter for Whole<W> {
    fn rows(&mut self, values: &[f32]) -> io::Result<()> {
        self.samples.extend(values.iter().map(|&value| byte(value)));
        Ok(())
    }

    fn finish(mut self: Box<Self>) -> io::Result<()> {
        let color = if is_gray(self.map) { ExtendedColorType::L8 } else { ExtendedColorType::Rgb8 };
        let mut out = BufWriter::new(&mut self.out);
        let [width, height] = self.extent;
        let written = if self.format == MapFormat::Jpeg {
            let encoder = image::codecs::jpeg::JpegEncoder::new_with_quality(&mut out, JPEG_QUALITY);
            encoder.write_image(&self.samples, width, height, color)
        } else {
            let encoder = image::codecs::webp::WebPEncoder::new_lossless(&mut out);
            encoder.write_image(&self.samples, width, height, color)
        };
        match written {
            Ok(()) => out.flush(),
            Err(image::ImageError::IoError(error)) => Err(error),
            Err(error) => Err(io::Error::other(error)),
        }
    }
}
