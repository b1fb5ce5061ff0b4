//! `jaspe texture`.

use std::path::PathBuf;
use std::time::Instant;

use clap::Args;
use jaspe_edge::file::Output;
use jaspe_render::swatch;

use crate::Outcome;
use crate::arguments::{Assignment, assignment, size};
use crate::command::textures::names;
use crate::failure::Failure;
use crate::material;
use crate::show::{duration, size as file_size};
use crate::terminal;

/// Draw one procedural material on a plane.
///
/// The plane is a slice z = 0.35 through the material, two units across its shorter side, as a unit sphere is; with
/// --set space=uv it is u and v from 0 to 1. There is no light: the picture shows the material's own colours.
#[derive(Debug, Args)]
#[command(after_long_help = "\
Examples:
  jaspe texture marble -o marble.png
  jaspe texture wood -o wood.png --size 1920x1080 --scale 0.5
  jaspe texture stone -o stone.exr --set noise=classic --set seed=7
  jaspe texture marble -o red.png --set 'diffuse_initial=0.3 0 0' --set diffuse_final=1,0.9,0.8")]
pub struct Texture {
    /// The material; `jaspe textures` lists them
    #[arg(value_name = "NAME", value_parser = names())]
    name: String,

    /// The picture; its extension chooses the format
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,

    /// Set a parameter, such as depth=5; may be repeated
    #[arg(long, value_name = "KEY=VALUE", value_parser = assignment)]
    set: Vec<Assignment>,

    /// Size of the picture in pixels
    #[arg(long, value_name = "WxH", value_parser = size, default_value = "512x512")]
    size: [u32; 2],

    /// Everything so many times as large
    #[arg(long, value_name = "S", value_parser = factor, default_value = "1")]
    scale: f64,

    /// Draw the picture in the terminal too
    #[arg(long)]
    show: bool,

    /// Print errors only
    #[arg(short, long)]
    quiet: bool,
}

fn factor(text: &str) -> Result<f64, String> {
    let value = text.parse().ok().filter(|value| (1e-6..=1e6).contains(value));
    value.ok_or_else(|| "expected a number from 0.000001 to 1000000".to_owned())
}

impl Texture {
    /// Draws and writes.
    pub fn run(self) -> Result<Outcome, Failure> {
        let started = Instant::now();
        let material = material::build(&self.name, &self.set)?;
        let output = Output::new(&self.output, None)?;
        let film = swatch(&material, self.size, self.scale);
        let byte_count = output.write(&film)?;
        if self.show {
            terminal::show(&film);
        }
        if !self.quiet {
            let ([width, height], size) = (self.size, file_size(byte_count));
            eprintln!("{}: {width}x{height}, {size}, in {}", output.path().display(), duration(started.elapsed()));
        }
        Ok(Outcome::Done)
    }
}
