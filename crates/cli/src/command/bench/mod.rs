//! `jaspe bench`.

mod noise;
#[cfg(feature = "bench-peers")]
mod peers;
mod rays;
mod scenes;
mod stopwatch;

use clap::{Args, Subcommand};

use crate::Outcome;
use crate::failure::Failure;

/// Measure this program, with ratios to its peers.
#[derive(Debug, Args)]
pub struct Bench {
    #[command(subcommand)]
    what: What,
}

/// What is measured.
#[derive(Debug, Subcommand)]
enum What {
    Noise(noise::Noise),
    Rays(rays::Rays),
    Scenes(scenes::Scenes),
}

impl Bench {
    /// Measures, and prints a table.
    pub fn run(self) -> Result<Outcome, Failure> {
        match self.what {
            What::Noise(noise) => noise.run(),
            What::Rays(rays) => rays.run(),
            What::Scenes(scenes) => scenes.run(),
        }
    }
}
