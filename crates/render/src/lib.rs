//! The ray tracer.
//!
//! ```text
//! Scene ──compile──▶ CompiledScene ──render──▶ Film ──develop──▶ Image ──encode──▶ bytes
//! ```
//!
//! [`compile()`] resolves names, bakes transforms and builds the hierarchy; what it returns is immutable and valid, so
//! that [`render`] cannot fail. This crate prints nothing and opens no file itself.
//!
//! ```
//! use jaspe_render::{CompileOptions, Format, RenderOptions, compile, encode, render};
//! use jaspe_scene::{MemoryLoader, parse};
//!
//! let text = r#"
//!     image { resolution 32 24 }
//!     camera { type pinhole eye 0 0 4 target 0 0 0 up 0 1 0 fov 40 aspect 1.333 }
//!     light { type point color 1 1 1 power 400 p 3 4 5 }
//!     shader { name veined type marble }
//!     object { shader veined type sphere c 0 0 0 r 1 }
//! "#;
//! let loader = MemoryLoader::default();
//! let (scene, diagnostics) = parse("marble.sc".as_ref(), text.as_bytes(), &loader);
//! assert!(diagnostics.is_empty());
//!
//! let compilation = compile(&scene, &loader, &CompileOptions::default());
//! let scene = compilation.scene.expect("the diagnostics hold no error");
//! let (film, stats) = render(&scene, &RenderOptions::default(), &())?;
//! assert_eq!((film.width, film.height, stats.samples), (32, 24, 32 * 24));
//! assert!(film.pixels[12 * 32 + 16][0] > 0.01, "light falls on the middle of the ball");
//!
//! let png = encode(&film, Format::from_path("marble.png".as_ref())?)?;
//! assert!(png.starts_with(b"\x89PNG"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod affine;
mod camera;
mod checkpoint;
mod clock;
mod compile;
mod develop;
mod encode;
mod environment;
mod film;
mod filter;
mod flip;
mod geometry;
mod hierarchy;
mod light;
mod material;
mod math;
mod mesh_file;
mod modifier;
mod motion;
mod options;
mod passes;
mod picture;
mod report;
mod sampler;
mod sunflow;
mod swatch;
mod threads;
mod tile;
mod wave;

pub use checkpoint::{Checkpoint, CheckpointError};
pub use clock::Spent;
pub use compile::{Compilation, CompiledScene, compile};
pub use develop::{Alpha, Depth, Image, Samples, develop};
pub use encode::{EncodeError, Format, UnknownFormat, encode};
pub use film::{Encoding, Film, Pixel};
pub use flip::flip;
pub use hierarchy::{Answers, Hierarchy, RaySet, TriangleHit};
pub use jaspe_scene::{srgb_decode, srgb_encode};
pub use mesh_file::{MeshFile, read_mesh};
pub use options::{Cancelled, CompileOptions, Look, Observer, RenderOptions, ResumeError, Stats};
pub use picture::{DecodeError, Picture, PicturePixels};
pub use swatch::swatch;

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
    passes::render(scene, options, None, observer).map_err(|error| match error {
        ResumeError::Cancelled => Cancelled,
        ResumeError::Unfit => unreachable!("there is no checkpoint"),
    })
}

/// Goes on with a rendering from a [`Checkpoint`] that [`Observer::checkpoint`] has kept of it. The picture has the same bits
/// as one that was never interrupted, whatever the numbers of threads.
///
/// That scene and options are the same is for the caller to make sure: see [`Checkpoint::to_bytes`].
///
/// # Errors
/// [`ResumeError`] when the observer asked for it, or when the checkpoint cannot be of this rendering.
pub fn resume(
    scene: &CompiledScene,
    options: &RenderOptions,
    checkpoint: &Checkpoint,
    observer: &dyn Observer,
) -> Result<(Film, Stats), ResumeError> {
    passes::render(scene, options, Some(checkpoint), observer)
}
