//! The ray tracer.
//!
//! ```text
//! Scene ──compile──▶ CompiledScene ──render──▶ Film ──develop──▶ Image ──encode──▶ bytes
//! ```
//!
//! [`compile`] resolves names, bakes transforms and builds the hierarchy; what it returns is immutable and valid, so
//! that [`render`] cannot fail. This crate prints nothing and opens no file itself.

mod develop;
mod encode;
mod film;
mod options;
mod picture;

pub use develop::{Alpha, Depth, Image, Samples, develop, srgb_decode, srgb_encode};
pub use encode::{EncodeError, Format, UnknownFormat, encode};
pub use film::{Encoding, Film, Pixel};
pub use options::{Cancelled, CompileOptions, Look, Observer, RenderOptions, Stats};
pub use picture::{DecodeError, Picture, PicturePixels};

use jaspe_scene::{Diagnostics, Loader, Scene};

/// A scene ready to render: immutable and valid.
#[derive(Debug)]
pub struct CompiledScene {}

impl CompiledScene {
    /// Width and height of the picture in pixels.
    pub fn resolution(&self) -> [u32; 2] {
        [640, 480]
    }
}

/// What [`compile`] made of a scene, with everything it has to say about it.
#[derive(Debug)]
pub struct Compilation {
    /// The scene, unless the diagnostics hold an error.
    pub scene: Option<CompiledScene>,
    /// In the order in which they were found.
    pub diagnostics: Diagnostics,
}

/// Resolves names, bakes transforms, loads textures and builds the hierarchy.
pub fn compile(scene: &Scene, loader: &dyn Loader, options: &CompileOptions) -> Compilation {
    let _ = (scene, loader, options);
    Compilation { scene: Some(CompiledScene {}), diagnostics: Diagnostics::default() }
}

/// Renders a compiled scene.
///
/// # Errors
/// [`Cancelled`] when the observer asked for it.
pub fn render(
    scene: &CompiledScene,
    options: &RenderOptions,
    observer: &dyn Observer,
) -> Result<(Film, Stats), Cancelled> {
    let _ = (options, observer);
    let [width, height] = scene.resolution();
    Ok((Film::new(width, height, Encoding::Linear), Stats::default()))
}
