//! What a caller may ask for beyond what the scene says, and how it follows the work.

use jaspe_scene::Dialect;

use crate::checkpoint::Checkpoint;
use crate::clock::Spent;
use crate::film::Film;

/// Choices that are made when a scene is compiled.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct CompileOptions {
    /// Whose meaning the scene's words have; `None` leaves it to the scene.
    pub dialect: Option<Dialect>,
    /// Width and height in pixels in place of the scene's own.
    pub resolution: Option<[u32; 2]>,
    /// Exactly this many samples per pixel, without adaptation.
    pub samples: Option<u32>,
    /// In place of the scene's `aa MIN MAX`.
    pub aa: Option<[i32; 2]>,
    /// A quick look in place of every shader.
    pub look: Option<Look>,
}

/// Quick looks, as Sunflow's `quick` modes: every surface gets this shader.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Look {
    /// The shading normal, (n + 1) / 2.
    Normals,
    /// Texture coordinates as red and green.
    Uvs,
    /// A colour per object.
    Ids,
    /// Ambient occlusion.
    AmbientOcclusion,
    /// Matte grey under the scene's lights.
    Gray,
}

impl Look {
    /// Every look.
    pub const ALL: &[Look] = &[Look::Normals, Look::Uvs, Look::Ids, Look::AmbientOcclusion, Look::Gray];

    /// The word for it.
    pub fn name(self) -> &'static str {
        match self {
            Look::Normals => "normals",
            Look::Uvs => "uvs",
            Look::Ids => "ids",
            Look::AmbientOcclusion => "ambocc",
            Look::Gray => "gray",
        }
    }

    /// The look of this name.
    pub fn from_name(name: &str) -> Option<Look> {
        Look::ALL.iter().copied().find(|look| look.name() == name)
    }
}

/// Choices that are made for one rendering.
#[derive(Debug, Clone, Default)]
pub struct RenderOptions {
    /// How many threads work; `None` means all that the machine has. The picture does not depend on it.
    pub threads: Option<usize>,
    /// Another seed gives other sampling noise.
    pub seed: u64,
    /// Renders only this part: x0, y0, x1, y1 in pixels, from the top left, ends excluded.
    pub crop: Option<[u32; 4]>,
}

/// Follows a rendering, and may stop it. Called from several threads.
pub trait Observer: Sync {
    /// `done` of `total` units of work are finished; neither ever shrinks much, `total` may grow as pixels are refined.
    fn progress(&self, done: u64, total: u64) {
        let _ = (done, total);
    }

    /// Asked between waves; true stops the rendering.
    fn cancelled(&self) -> bool {
        false
    }

    /// A part of the picture is done, or a better version of it: its top left corner in pixels of the part of the
    /// picture that was asked for, and its colours before the reconstruction filter.
    fn tile(&self, corner: [u32; 2], part: &Film) {
        let _ = (corner, part);
    }

    /// Asked between waves; true pauses the rendering and gives its state to [`Observer::checkpoint`], also when it is
    /// cancelled at the same time.
    fn wants_checkpoint(&self) -> bool {
        false
    }

    /// The state from which [`crate::resume`] goes on.
    fn checkpoint(&self, state: Checkpoint) {
        let _ = state;
    }
}

/// An observer that looks away.
impl Observer for () {}

/// The rendering was stopped by its [`Observer`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Cancelled;

impl std::fmt::Display for Cancelled {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("the rendering was stopped")
    }
}

impl std::error::Error for Cancelled {}

/// Why a rendering did not go on from a checkpoint.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ResumeError {
    /// It was stopped by its [`Observer`].
    Cancelled,
    /// The checkpoint is of a rendering with another size, crop, seed or number of samples.
    Unfit,
}

impl From<Cancelled> for ResumeError {
    fn from(Cancelled: Cancelled) -> Self {
        ResumeError::Cancelled
    }
}

impl std::fmt::Display for ResumeError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            ResumeError::Cancelled => Cancelled.fmt(f),
            ResumeError::Unfit => f.write_str("the checkpoint does not fit the rendering"),
        }
    }
}

impl std::error::Error for ResumeError {}

/// What a rendering did: the part of it after the checkpoint, if it went on from one.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Stats {
    /// Camera samples traced.
    pub samples: u64,
    /// Rays from the camera.
    pub camera_rays: u64,
    /// Rays towards lights.
    pub shadow_rays: u64,
    /// Reflected and glossy rays.
    pub reflection_rays: u64,
    /// Refracted rays.
    pub refraction_rays: u64,
    /// Rays that look for light from other surfaces.
    pub gather_rays: u64,
    /// Points at which a procedural texture was evaluated.
    pub texture_points: u64,
    /// Threads that worked.
    pub threads: usize,
    /// Where their time went.
    pub spent: Spent,
}

impl Stats {
    /// The counts and times of two parts of a rendering together; the threads are those of the larger.
    #[must_use]
    pub fn plus(self, other: Stats) -> Stats {
        Stats {
            samples: self.samples + other.samples,
            camera_rays: self.camera_rays + other.camera_rays,
            shadow_rays: self.shadow_rays + other.shadow_rays,
            reflection_rays: self.reflection_rays + other.reflection_rays,
            refraction_rays: self.refraction_rays + other.refraction_rays,
            gather_rays: self.gather_rays + other.gather_rays,
            texture_points: self.texture_points + other.texture_points,
            threads: self.threads.max(other.threads),
            spent: self.spent.plus(other.spent),
        }
    }
}
