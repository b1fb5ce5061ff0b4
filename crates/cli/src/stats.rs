//! What a rendering cost: `--stats json` and `--time`.

use std::time::Duration;

use jaspe_render::{Spent, Stats};
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
    /// Finding what rays meet, the mean of the threads; together with the next two about `render_s`, less what threads
    /// waited.
    pub trace_s: f64,
    /// Evaluating textures.
    pub texture_s: f64,
    /// Surfaces, shaders and lights.
    pub shade_s: f64,
    /// Encoding and writing the picture.
    pub write_s: f64,
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
    /// What the threads did meanwhile, one thread's mean share of it.
    pub spent: Spent,
    /// Encoding and writing the picture.
    pub write: Duration,
    /// From the start of the command to the file on disk.
    pub total: Duration,
}

impl Times {
    /// What all threads spent together, as the mean of one.
    pub fn mean(stats: &Stats) -> Spent {
        let Spent { trace, texture, shade } = stats.spent;
        let [trace, texture, shade] = [trace, texture, shade].map(|time| time / stats.threads.max(1) as u32);
        Spent { trace, texture, shade }
    }

    /// One line for people: seconds, and shares of the total. What no stage accounts for is the rest: threads that had
    /// nothing to do, and whatever is done between tiles.
    pub fn line(&self) -> String {
        let Spent { trace, texture, shade } = self.spent;
        let stages = [
            ("parse", self.parse),
            ("build", self.build),
            ("trace", trace),
            ("texture", texture),
            ("shade", shade),
            ("write", self.write),
        ];
        let rest = self.total.saturating_sub(stages.iter().map(|&(_, time)| time).sum());
        let show = |(name, time): &(&str, Duration)| {
            let share = 100.0 * time.as_secs_f64() / self.total.as_secs_f64().max(f64::MIN_POSITIVE);
            format!("{name} {} ({share:.0} %)", duration(*time))
        };
        let words: Vec<String> = stages.iter().chain(&[("rest", rest)]).map(show).collect();
        words.join(", ")
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
