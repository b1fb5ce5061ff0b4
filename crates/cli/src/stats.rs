//! What a rendering cost: `--stats json` and `--time`.

use std::time::Duration;

use jaspe_render::Stats;
use serde::Serialize;

use crate::show::duration;

/// The object that `--stats json` prints. Its words are a contract.
#[derive(Debug, Serialize)]
pub struct Report {
    /// Reading the scene, in seconds.
    pub parse_s: f64,
    /// Compiling it: transforms, textures, hierarchy.
    pub build_s: f64,
    /// Rendering.
    pub render_s: f64,
    /// From the start of the command to the file on disk.
    pub total_s: f64,
    /// Of the picture, in pixels.
    pub width: u32,
    /// Of the picture, in pixels.
    pub height: u32,
    /// Camera samples traced.
    pub samples: u64,
    /// Rays by kind.
    pub rays: Rays,
    /// Points at which a procedural texture was evaluated.
    pub texture_points: u64,
    /// Threads that worked.
    pub threads: usize,
    /// The instruction set of the batches.
    pub simd: String,
    /// The most memory that the program held at a time; none where the system does not tell.
    pub peak_rss_bytes: Option<u64>,
    /// Warnings about the scene.
    pub warnings: usize,
}

/// Rays by kind.
#[derive(Debug, Serialize)]
pub struct Rays {
    /// From the camera.
    pub camera: u64,
    /// Towards lights.
    pub shadow: u64,
    /// Mirrored and glossy.
    pub reflection: u64,
    /// Refracted.
    pub refraction: u64,
    /// From matte surfaces, for light from others.
    pub gather: u64,
}

impl From<&Stats> for Rays {
    fn from(stats: &Stats) -> Self {
        Rays {
            camera: stats.camera_rays,
            shadow: stats.shadow_rays,
            reflection: stats.reflection_rays,
            refraction: stats.refraction_rays,
            gather: stats.gather_rays,
        }
    }
}

/// How long each stage took.
#[derive(Debug, Clone, Copy, Default)]
pub struct Times {
    /// Reading the scene.
    pub parse: Duration,
    /// Compiling it.
    pub build: Duration,
    /// Rendering.
    pub render: Duration,
    /// Encoding and writing the picture.
    pub write: Duration,
}

impl Times {
    /// One line for people.
    pub fn line(&self) -> String {
        let [parse, build, render, write] = [self.parse, self.build, self.render, self.write].map(duration);
        format!("parse {parse}, build {build}, render {render}, write {write}")
    }
}

/// The largest resident set of this process so far.
pub fn peak_rss_bytes() -> Option<u64> {
    // Linux tells it in a file; elsewhere it would take a foreign function call, which is not worth it.
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kibibytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(1024 * kibibytes)
}
