//! `jaspe bake`.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

use clap::builder::PossibleValuesParser;
use clap::{Args, ValueEnum};
use jaspe_bake::{
    BakeError, Loop, Map, MapFormat, Model, NormalConvention, PREVIEW_SIZE, Preview, SetError, SetFolder, SetOptions,
    Settings, Surface, Written, write_set,
};
use jaspe_edge::message::count;
use jaspe_edge::plain;

use crate::Outcome;
use crate::arguments::{Assignment, assignment};
use crate::command::textures::names;
use crate::failure::Failure;
use crate::progress::{Progress, When};
use crate::show::{duration, size as file_size};
use crate::{interrupt, material};

/// Bake a material into maps for game engines, modellers and pipelines.
///
/// The maps of a plane tile without a seam. Beside them lie material.json, which says what was baked, and a .gltf and a .mtlx
/// file by which other programs open the material. The folder appears whole or not at all; a set that is there is replaced.
#[derive(Debug, Args)]
#[command(after_long_help = "\
Examples:
  jaspe bake marble -o marble/
  jaspe bake stone --size 2048 --maps color,height,normal,roughness,ao --tile 1 --preview -o stone/
  jaspe bake wood --set diffuse_initial=0.2,0.1,0 --seed 7 --normal dx --format jpeg -o wood/
  jaspe bake organic --surface sphere --size 4096 --format exr --bits 32 -o ball/
  jaspe bake marble --mesh teapot.obj --tile 4 -o teapot/
  jaspe bake water --frames 0..48 --maps color,normal -o water/")]
pub struct Bake {
    /// The material; `jaspe textures` lists them
    #[arg(value_name = "NAME", value_parser = names())]
    name: String,

    /// The folder for the set
    #[arg(short, long, value_name = "FOLDER")]
    output: PathBuf,

    /// Width of the maps in pixels
    #[arg(long, value_name = "N", default_value_t = 1024, value_parser = clap::value_parser!(u32).range(1..=i64::from(jaspe_bake::Bake::MAX_SIZE)))]
    size: u32,

    /// The maps, parted by commas [default: color,height,normal,roughness,ao, and emission for what glows]
    #[arg(long, value_name = "MAP,…", value_delimiter = ',', value_parser = map_names())]
    maps: Vec<String>,

    /// Set a parameter, such as depth=5; may be repeated
    #[arg(long, value_name = "KEY=VALUE", value_parser = assignment)]
    set: Vec<Assignment>,

    /// Another seed gives another piece of the material: the parameter `seed`
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(i64).range(0..))]
    seed: Option<i64>,

    /// The width of the surface in units of the texture [default: what shows the material well on a plane; 2 for a sphere,
    /// cube or cylinder; a mesh's own width]
    #[arg(long, value_name = "T", value_parser = positive, allow_negative_numbers = true)]
    tile: Option<f64>,

    /// What the maps unroll
    #[arg(long, value_name = "SURFACE", default_value = "plane", value_parser = PossibleValuesParser::new(Surface::NAMES))]
    surface: String,

    /// Bake into the texture coordinates of a mesh, padded around its charts
    #[arg(long, value_name = "MODEL.obj", conflicts_with = "surface")]
    mesh: Option<PathBuf>,

    /// Which way green points in the normal map
    #[arg(long, value_enum, value_name = "gl|dx", default_value_t = Normal::Gl)]
    normal: Normal,

    /// The format of the maps
    #[arg(long, value_enum, value_name = "FORMAT", default_value_t = Format::Png)]
    format: Format,

    /// Bits per sample: 8 or 16 for PNG, 16 or 32 for EXR [default: 8, and 16 for heights; EXR: 16]
    #[arg(long, value_name = "8|16|32", value_parser = clap::value_parser!(u8).range(8..=32))]
    bits: Option<u8>,

    /// Bake the frames A to B-1 of a sequence that returns to its beginning, such as 0..48
    #[arg(long, value_name = "A..B", value_parser = frames)]
    frames: Option<[u32; 2]>,

    /// How many noise cells of time pass in a sequence: more is livelier
    #[arg(long, value_name = "N", default_value_t = 1, requires = "frames", value_parser = clap::value_parser!(u32).range(1..=1000))]
    pace: u32,

    /// Render the material on a ball and a cloth under a sky: preview.png, or preview.jpg beside JPEG maps
    #[arg(long)]
    preview: bool,

    /// Threads that work [default: all that the machine has]; the maps do not depend on it
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=4096))]
    threads: Option<u32>,

    /// When to show progress
    #[arg(long, value_enum, value_name = "WHEN", default_value_t = When::Auto)]
    progress: When,

    /// Print errors only
    #[arg(short, long)]
    quiet: bool,
}

/// Which way green points.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Normal {
    /// Up: OpenGL, Blender, Godot, Unity
    Gl,
    /// Down: DirectX, Unreal
    Dx,
}

/// The formats of maps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Format {
    /// Without loss, 8 or 16 bits
    Png,
    /// Floats of 16 or 32 bits; colours as linear light
    Exr,
    /// With slight loss, 8 bits; heights as PNG of 16 bits
    #[value(alias = "jpg")]
    Jpeg,
    /// Without loss, 8 bits; heights as PNG of 16 bits
    Webp,
}

fn map_names() -> PossibleValuesParser {
    PossibleValuesParser::new(Map::ALL.iter().map(|map| map.name()))
}

fn positive(text: &str) -> Result<f64, String> {
    let value = text.parse().ok().filter(|value: &f64| *value > 0.0 && value.is_finite());
    value.ok_or_else(|| "expected a positive number".to_owned())
}

fn frames(text: &str) -> Result<[u32; 2], String> {
    let expected = || "expected A..B, such as 0..48: the last frame is B-1".to_owned();
    let (first, end) = text.split_once("..").ok_or_else(expected)?;
    let number = |text: &str| text.trim().parse::<u32>().map_err(|_| expected());
    let [first, end] = [number(first)?, number(end)?];
    if first < end && end <= jaspe_bake::Bake::MAX_FRAMES { Ok([first, end]) } else { Err(expected()) }
}

impl Bake {
    /// Bakes and writes.
    pub fn run(self) -> Result<Outcome, Failure> {
        let started = Instant::now();
        let options = self.options()?;
        let bake = self.bake()?;
        interrupt::listen();
        let folder = SetFolder::new(&self.output).map_err(|error| unwritable(&self.output, error))?;
        let progress = Progress::new("baking", if self.quiet { When::Off } else { self.progress });
        let work = || write_set(&bake, &options, folder, &progress);
        let written = match self.threads {
            None => work(),
            Some(threads) => {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads as usize).build();
                pool.map_err(|error| Failure::new(format!("--threads: {error}")))?.install(work)
            }
        };
        progress.finish();
        let written = written.map_err(|error| unwritable(&self.output, error))?;
        if !self.quiet {
            self.tell(&bake, &written, started);
        }
        Ok(Outcome::Done)
    }

    fn tell(&self, bake: &jaspe_bake::Bake, written: &Written, started: Instant) {
        let bytes: u64 = written.files.iter().map(|(_, size)| size).sum();
        let maps = count(bake.settings().maps.len(), "map");
        let frames = if bake.frames() > 1 { format!(" × {} frames", bake.frames()) } else { String::new() };
        let (folder, took) = (self.output.display(), duration(started.elapsed()));
        let [width, height] = [bake.width(), bake.height()];
        let size = file_size(bytes as usize);
        let files = count(written.files.len(), "file");
        eprintln!("{folder}: {maps} of {width}x{height}{frames}, {files}, {size}, in {took}");
    }

    fn bake(&self) -> Result<jaspe_bake::Bake, Failure> {
        let mut set = self.set.clone();
        set.extend(self.seed.map(|seed| Assignment { key: "seed".to_owned(), value: seed.to_string() }));
        if set.iter().any(|assignment| assignment.key == "space") {
            let failure = Failure::new("--set: `space` has no meaning in a bake");
            return Err(failure.hint("the maps are fixed to the surface; --surface chooses it, and --tile its size"));
        }
        let texture = material::build(&self.name, &set)?;
        let mut maps: Vec<Map> = self.maps.iter().filter_map(|name| Map::from_name(name)).collect();
        if maps.is_empty() {
            maps = Settings::maps_of(&texture);
        }
        let normal = match self.normal {
            Normal::Gl => NormalConvention::OpenGl,
            Normal::Dx => NormalConvention::DirectX,
        };
        let animation = self.frames.map(|[first, end]| Loop { frames: end - first, first, cells: self.pace });
        let settings = Settings { size: self.size, tile: self.tile, surface: self.surface()?, maps, normal, animation };
        jaspe_bake::Bake::new(texture, settings).map_err(|error| {
            let failure = Failure::new(format!("`{}`: {error}", self.name));
            match error {
                BakeError::TooFine { .. } => {
                    failure.hint("choose a larger --size, a smaller --tile or a larger --set scale=…")
                }
                BakeError::Twice(_) => failure.hint("name each map once"),
                _ => failure,
            }
        })
    }

    fn surface(&self) -> Result<Surface, Failure> {
        let Some(path) = &self.mesh else {
            return Ok(Surface::from_name(&self.surface).expect("the parser accepts the names of surfaces only"));
        };
        let bytes = std::fs::read(path).map_err(|error| Failure::reading(path, &error))?;
        let model = Model::from_mesh_file(&bytes, path).map_err(|error| {
            let failure = Failure::new(format!("`{}` cannot be used: {error}", path.display()));
            failure.hint("maps are baked into the texture coordinates (vt) of an OBJ file")
        })?;
        Ok(Surface::Mesh(Arc::new(model)))
    }

    fn options(&self) -> Result<SetOptions, Failure> {
        let format = match (self.format, self.bits) {
            (Format::Png, None | Some(8)) => MapFormat::Png8,
            (Format::Png, Some(16)) => MapFormat::Png16,
            (Format::Exr, None | Some(16)) => MapFormat::ExrHalf,
            (Format::Exr, Some(32)) => MapFormat::ExrFloat,
            (Format::Jpeg, None | Some(8)) => MapFormat::Jpeg,
            (Format::Webp, None | Some(8)) => MapFormat::WebP,
            (_, bits) => {
                let message = format!("--bits {} does not go with this --format", bits.unwrap_or_default());
                return Err(Failure::new(message).hint("PNG takes 8 or 16, EXR 16 or 32, JPEG and WebP 8"));
            }
        };
        let mut options = SetOptions::new(format);
        if self.bits == Some(8) {
            // Whoever says so shall have it.
            options.height_format = format;
        }
        if self.preview {
            options.preview = Preview::Rendered(PREVIEW_SIZE);
        }
        Ok(options)
    }
}

/// Why a set, or a gallery, could not be written, and what to do about it.
pub fn unwritable(output: &Path, error: SetError) -> Failure {
    match error {
        SetError::Cancelled => {
            eprintln!("stopped; nothing was written");
            Failure::Interrupted
        }
        SetError::Write { path, error } => {
            let failure = Failure::new(format!("cannot write `{}`: {}", path.display(), plain(&error)));
            match (error.kind(), missing_parent(&path, output)) {
                (std::io::ErrorKind::NotFound, Some(parent)) => {
                    failure.hint(format!("create its folder first: mkdir -p {}", parent.display()))
                }
                _ => failure.hint("choose another place with -o FOLDER; nothing was left behind"),
            }
        }
        SetError::Occupied { .. } => Failure::new(error.to_string())
            .hint("what is written replaces its folder: choose a new one, or one that was written so"),
        SetError::TooLarge { .. } => {
            Failure::new(error.to_string()).hint("choose another --format or a smaller --size")
        }
    }
}

/// The folder around the set, if it is not there.
fn missing_parent<'a>(path: &Path, output: &'a Path) -> Option<&'a Path> {
    let parent = output.parent().filter(|parent| *parent != Path::new(""))?;
    (path == output && !parent.is_dir()).then_some(parent)
}
