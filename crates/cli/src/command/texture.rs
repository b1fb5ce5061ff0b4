//! `jaspe texture`.

use std::path::PathBuf;
use std::time::Instant;

use clap::Args;
use jaspe_render::{Encoding, Film, srgb_decode};
use jaspe_texture::declare::Value;
use jaspe_texture::{BuildError, Space, Texture as Material};

use crate::Outcome;
use crate::arguments::{Assignment, assignment, size};
use crate::command::textures::names;
use crate::failure::{Failure, nearest};
use crate::output::Output;
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

/// Samples along each edge of a pixel: wood has sharp rings.
const SAMPLE_COUNT: usize = 3;

/// Not a whole number of cells at any material's frequency: there all gradient noises vanish.
const SLICE: f64 = 0.35;

impl Texture {
    /// Draws and writes.
    pub fn run(self) -> Result<Outcome, Failure> {
        let started = Instant::now();
        let material = self.build()?;
        let output = Output::new(&self.output, None)?;
        let film = self.draw(&material);
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

    fn build(&self) -> Result<Material, Failure> {
        let declaration = Material::ALL.iter().find(|declaration| declaration.name == self.name);
        let declaration = declaration.expect("the parser accepts the names of materials only");
        let mut arguments: Vec<(&str, Value)> = Vec::new();
        for Assignment { key, value } in &self.set {
            let parameter = declaration.parameter(key).ok_or_else(|| self.unknown(key, declaration.parameters))?;
            let value = parameter.parse(value).map_err(|error| self.refused(&error))?;
            arguments.push((parameter.name, value));
        }
        Material::build(&self.name, &arguments).map_err(|error| self.refused(&error))
    }

    fn unknown(&self, key: &str, parameters: &[jaspe_texture::declare::Parameter]) -> Failure {
        let failure = Failure::new(format!("--set: `{}` has no parameter `{key}`", self.name));
        match nearest(key, parameters.iter().map(|parameter| parameter.name.to_owned())) {
            Some(name) => failure.hint(format!("did you mean `{name}`?")),
            None => failure.hint(format!("`jaspe textures {}` lists its parameters", self.name)),
        }
    }

    fn refused(&self, error: &BuildError) -> Failure {
        let hint = format!("`jaspe textures {}` lists its parameters", self.name);
        Failure::new(format!("--set: {error}")).hint(hint)
    }

    fn draw(&self, material: &Material) -> Film {
        let [width, height] = self.size.map(|side| side as usize);
        let columns = SAMPLE_COUNT * width;
        let mut film = Film::new(self.size[0], self.size[1], Encoding::Linear);
        let plane = Plane::new(material.space(), self.size, self.scale);
        let x: Vec<f32> = (0..columns).map(|i| plane.x(i)).collect();
        let z = vec![(SLICE / self.scale) as f32; columns];
        let mut colors = vec![[0.0; 3]; columns];
        for (row, pixels) in film.pixels.chunks_exact_mut(width).enumerate() {
            for j in 0..SAMPLE_COUNT {
                let y = vec![plane.y(row * SAMPLE_COUNT + j); columns];
                match material.space() {
                    Space::Uv => material.colors([&x, &y], &mut colors),
                    Space::Local | Space::World => material.colors([&x, &y, &z], &mut colors),
                }
                for (pixel, samples) in pixels.iter_mut().zip(colors.chunks_exact(SAMPLE_COUNT)) {
                    add(pixel, samples);
                }
            }
        }
        debug_assert_eq!(film.pixels.len(), width * height);
        film
    }
}

/// Adds the light of some of a pixel's samples.
fn add(pixel: &mut jaspe_render::Pixel, samples: &[[f32; 3]]) {
    let share = 1.0 / (SAMPLE_COUNT * SAMPLE_COUNT) as f32;
    for sample in samples {
        (0..3).for_each(|i| pixel[i] += share * srgb_decode(f64::from(sample[i])) as f32);
    }
    pixel[3] = 1.0;
}

/// Where samples lie: y upwards, the origin in the middle of the picture (u and v: in its lower left corner).
struct Plane {
    step: f64,
    left: f64,
    top: f64,
}

impl Plane {
    fn new(space: Space, [width, height]: [u32; 2], scale: f64) -> Self {
        let across = if space == Space::Uv { 1.0 } else { 2.0 };
        let step = across / (f64::from(width.min(height)) * SAMPLE_COUNT as f64 * scale);
        let [width, height] = [width, height].map(|side| f64::from(side) * SAMPLE_COUNT as f64);
        match space {
            Space::Uv => Plane { step, left: 0.5, top: height - 0.5 },
            Space::Local | Space::World => Plane { step, left: 0.5 - 0.5 * width, top: 0.5 * height - 0.5 },
        }
    }

    fn x(&self, column: usize) -> f32 {
        (self.step * (self.left + column as f64)) as f32
    }

    fn y(&self, row: usize) -> f32 {
        (self.step * (self.top - row as f64)) as f32
    }
}
