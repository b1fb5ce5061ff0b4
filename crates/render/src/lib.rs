//! The ray tracer.
//!
//! ```text
//! Scene ──compile──▶ CompiledScene ──render──▶ Film ──develop──▶ Image ──encode──▶ bytes
//! ```
//!
//! [`compile`] resolves names, bakes transforms and builds the hierarchy; what it returns is immutable and valid, so
//! that [`render`] cannot fail. This crate prints nothing and opens no file itself.

mod affine;
mod camera;
mod compile;
mod develop;
mod encode;
mod film;
mod filter;
mod geometry;
mod light;
mod material;
mod math;
mod options;
mod picture;
mod report;
mod sampler;
mod sunflow;
mod tile;
mod wave;

pub use compile::{Compilation, CompiledScene, compile};
pub use develop::{Alpha, Depth, Image, Samples, develop, srgb_decode, srgb_encode};
pub use encode::{EncodeError, Format, UnknownFormat, encode};
pub use film::{Encoding, Film, Pixel};
pub use options::{Cancelled, CompileOptions, Look, Observer, RenderOptions, Stats};
pub use picture::{DecodeError, Picture, PicturePixels};

/// Renders a compiled scene.
///
/// The picture depends on the scene, the seed and nothing else: not on threads, tiles, or the machine.
///
/// # Errors
/// [`Cancelled`] when the observer asked for it.
pub fn render(
    scene: &CompiledScene,
    options: &RenderOptions,
    observer: &dyn Observer,
) -> Result<(Film, Stats), Cancelled> {
    tile::render(scene, options, observer)
}
