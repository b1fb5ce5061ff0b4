//! `jaspe render`.

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use clap::{Args, ValueEnum};
use jaspe_edge::file::Output;
use jaspe_edge::message;
use jaspe_render::{CompileOptions, CompiledScene, Film, Look, RenderOptions, ResumeError, Stats, render, resume};
use jaspe_scene::{Dialect, DiskLoader, Loader, Severity};

use crate::Outcome;
use crate::arguments::{crop, dialect, look, size};
use crate::failure::Failure;
use crate::keeper::{self, Keeper, Recorder};
use crate::progress::{Progress, When};
use crate::scene_file::{self, Loaded};
use crate::show::{duration, json_text, size as file_size};
use crate::stats::{Rays, Report, Times, peak_rss_bytes};
use crate::viewer::{self, Viewer};
use crate::watch::Watch;
use crate::{interrupt, report, terminal};

/// Render a scene to a picture file.
///
/// The extension of the output chooses its format: .png (8 or 16 bits), .jpg, .tiff and .bmp are encoded for display,
/// .exr and .hdr hold linear light. The file appears whole or not at all. Ctrl-C stops and leaves nothing behind but
/// the state that --checkpoint asks for.
#[derive(Debug, Args)]
#[command(after_long_help = "\
Examples:
  jaspe render scene.sc                                  writes scene.png here
  jaspe render scene.sc -o big.exr --resolution 3840x2160
  jaspe render scene.sc --samples 4 --show               a quick look in the terminal
  jaspe render scene.sc --override normals               what the surfaces look like
  jaspe render scene.sc --set floor.depth=3 --set floor.scale=2.5
  jaspe render old.sc --dialect report --resolution 640x480 --aa 0 0
  jaspe render scene.sc --checkpoint night.state         may be stopped at any time …
  jaspe render scene.sc --resume night.state             … and goes on to the same picture
  jaspe render scene.sc --tev                            watch it in tev, on this machine
  jaspe render scene.sc --quiet --stats json | jq .render_s")]
pub struct Render {
    /// The scene
    #[arg(value_name = "SCENE.sc")]
    scene: PathBuf,

    /// The picture [default: the scene's name with .png, in the current folder]
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,

    /// Size of the picture in pixels, in place of the scene's own
    #[arg(long, value_name = "WxH", value_parser = size)]
    resolution: Option<[u32; 2]>,

    /// Exactly N samples per pixel, without adaptation
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1_000_000), conflicts_with = "aa")]
    samples: Option<u32>,

    /// Adaptive antialiasing in place of the scene's own: 2^MIN to 2^MAX samples along each edge of a pixel
    #[arg(long, num_args = 2, value_names = ["MIN", "MAX"], allow_negative_numbers = true,
        value_parser = clap::value_parser!(i32).range(-8..=8))]
    aa: Option<Vec<i32>>,

    /// Threads that work [default: all that the machine has]; the picture does not depend on it
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=4096))]
    threads: Option<u32>,

    /// Another seed gives other sampling noise
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,

    /// Render only this part: pixels from the top left, the ends excluded
    #[arg(long, value_name = "X0,Y0,X1,Y1", value_parser = crop)]
    crop: Option<[u32; 4]>,

    /// Whose meaning the scene's words have [default: what the scene says, else sunflow]
    #[arg(long, value_name = "DIALECT", value_parser = dialect())]
    dialect: Option<Dialect>,

    /// A quick look in place of every shader
    #[arg(long = "override", value_name = "LOOK", value_parser = look())]
    look: Option<Look>,

    /// Change a parameter of a named shader, such as floor.depth=3; may be repeated
    #[arg(long, value_name = "NAME.KEY=VALUE")]
    set: Vec<String>,

    /// Print where the time went: parse, build, trace, texture, shade, write, and their shares
    #[arg(long)]
    time: bool,

    /// Print what the rendering cost on standard output
    #[arg(long, value_enum, value_name = "FORMAT")]
    stats: Option<StatsFormat>,

    /// When to show progress
    #[arg(long, value_enum, value_name = "WHEN", default_value_t = When::Auto)]
    progress: When,

    /// Print errors only
    #[arg(short, long)]
    quiet: bool,

    /// Draw the picture in the terminal too
    #[arg(long)]
    show: bool,

    /// Send the picture to the viewer tev while it is rendered, at 127.0.0.1:14158 unless told otherwise
    #[arg(long, value_name = "HOST:PORT", num_args = 0..=1, default_missing_value = viewer::DEFAULT,
        value_parser = viewer::address)]
    tev: Option<String>,

    /// Keep the state of the rendering in this file now and then and at Ctrl-C; it is removed when the picture is written
    #[arg(long, value_name = "FILE")]
    checkpoint: Option<PathBuf>,

    /// Seconds between two states of --checkpoint
    #[arg(long, value_name = "SECONDS", default_value_t = 30.0, value_parser = seconds)]
    checkpoint_every: f64,

    /// Go on from the state in this file, to the same bits, with the same scene and options (threads may differ); further
    /// states go there too, unless --checkpoint names another file. Times and counts are of what is left
    #[arg(long, value_name = "FILE")]
    resume: Option<PathBuf>,

    /// Bits per sample of a PNG or TIFF [default: 8]
    #[arg(long, value_name = "8|16", value_parser = bits)]
    bits: Option<u8>,
}

/// How `--stats` prints.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum StatsFormat {
    /// One JSON object
    Json,
}

fn seconds(text: &str) -> Result<f64, String> {
    text.parse()
        .ok()
        .filter(|seconds| (0.1..=1e6).contains(seconds))
        .ok_or("expected 0.1 to 1000000 seconds".to_owned())
}

fn bits(text: &str) -> Result<u8, String> {
    match text {
        "8" => Ok(8),
        "16" => Ok(16),
        _ => Err("expected 8 or 16".to_owned()),
    }
}

impl Render {
    /// Renders and writes the picture.
    pub fn run(self) -> Result<Outcome, Failure> {
        let started = Instant::now();
        let path = self.output.clone().unwrap_or_else(|| default_output(&self.scene));
        let output = Output::new(&path, self.bits)?;
        let keeper = self.keeper()?;
        interrupt::listen();

        let recorder = keeper.is_some().then(Recorder::default);
        let loader = recorder.as_ref().map_or(&DiskLoader as &dyn Loader, |recorder| recorder);
        let loaded = scene_file::load(&self.scene, &self.set, &self.compile_options(), loader)?;
        self.print_diagnostics(&loaded);
        let Some(scene) = &loaded.scene else {
            eprintln!("{}: {}; nothing was rendered", self.scene.display(), message::summary(&loaded.diagnostics));
            return Ok(Outcome::Found);
        };
        self.check_crop(scene)?;

        let origin = recorder.map(|recorder| recorder.origin(&self.marks())).unwrap_or_default();
        let watch = self.watch(scene, output.path(), keeper.map(|keeper| (keeper, origin)));
        let rendering = Instant::now();
        let (film, stats) = self.render(scene, &watch)?;
        let render_time = rendering.elapsed();
        if interrupt::asked() {
            return Err(Failure::Interrupted);
        }
        let writing = Instant::now();
        let byte_count = output.write(&film)?;
        let times = Times {
            parse: loaded.parse_time,
            build: loaded.build_time,
            render: render_time,
            spent: Times::mean(&stats),
            write: writing.elapsed(),
            total: started.elapsed(),
        };

        self.finish(watch, &film);
        if self.show {
            terminal::show(&film);
        }
        if self.time {
            eprintln!("{}", times.line());
        }
        if !self.quiet {
            let size = file_size(byte_count);
            let (path, total) = (output.path().display(), duration(times.total));
            eprintln!("{path}: {}x{}, {size}, in {total}", film.width, film.height);
        }
        if self.stats.is_some() {
            let warnings = loaded.diagnostics.count(Severity::Warning);
            let report = self.report(&film, &stats, &times, warnings);
            writeln!(std::io::stdout(), "{}", json_text(&report))?;
        }
        Ok(Outcome::Done)
    }

    fn compile_options(&self) -> CompileOptions {
        CompileOptions {
            dialect: self.dialect,
            resolution: self.resolution,
            samples: self.samples,
            aa: self.aa.as_deref().and_then(|range| range.try_into().ok()),
            look: self.look,
        }
    }

    fn print_diagnostics(&self, loaded: &Loaded) {
        let least = if self.quiet { Severity::Error } else { Severity::Note };
        anstream::eprint!("{}", report::text(&loaded.diagnostics, &loaded.sources, least));
    }

    fn check_crop(&self, scene: &CompiledScene) -> Result<(), Failure> {
        let [width, height] = scene.resolution();
        match self.crop {
            Some([_, _, x1, y1]) if x1 > width || y1 > height => {
                let message = format!("--crop reaches {x1},{y1}, but the picture ends at {width},{height}");
                Err(Failure::new(message)
                    .hint("--crop takes X0,Y0,X1,Y1 in pixels from the top left, the ends excluded"))
            }
            _ => Ok(()),
        }
    }

    /// Where the state of the rendering is kept, if anywhere.
    fn keeper(&self) -> Result<Option<Keeper>, Failure> {
        let resumed = self.resume.as_deref();
        resumed.map(keeper::look_for).transpose()?;
        let path = self.checkpoint.as_deref().or(resumed);
        path.map(|path| Keeper::new(path, resumed, Duration::from_secs_f64(self.checkpoint_every))).transpose()
    }

    /// The options that change the picture, each as it is written.
    fn marks(&self) -> Vec<String> {
        let list = |numbers: &[u32]| numbers.iter().map(u32::to_string).collect::<Vec<_>>().join(",");
        let [low, high] = self.aa.as_deref().and_then(|aa| aa.try_into().ok()).unwrap_or([0, 0]);
        [
            self.resolution.map(|[width, height]| format!("--resolution {width}x{height}")),
            self.samples.map(|samples| format!("--samples {samples}")),
            self.aa.as_ref().map(|_| format!("--aa {low} {high}")),
            (self.seed != 0).then(|| format!("--seed {}", self.seed)),
            self.crop.map(|crop| format!("--crop {}", list(&crop))),
            self.dialect.map(|dialect| format!("--dialect {}", dialect.name())),
            self.look.map(|look| format!("--override {}", look.name())),
        ]
        .into_iter()
        .flatten()
        .chain(self.set.iter().map(|assignment| format!("--set {assignment}")))
        .collect()
    }

    /// All that follows the rendering.
    fn watch(&self, scene: &CompiledScene, name: &Path, keeper: Option<(Keeper, String)>) -> Watch {
        let progress = Progress::new("rendering", if self.quiet { When::Off } else { self.progress });
        let mut watch = Watch { progress, keeper, viewer: None, quiet: self.quiet };
        if let Some(address) = &self.tev {
            let size = self.crop.map_or(scene.resolution(), |[x0, y0, x1, y1]| [x1 - x0, y1 - y0]);
            match Viewer::open(address, &name.to_string_lossy(), size) {
                Ok(viewer) => watch.viewer = Some(viewer),
                Err(warning) => watch.warn(Some(warning)),
            }
        }
        watch
    }

    fn render(&self, scene: &CompiledScene, watch: &Watch) -> Result<(Film, Stats), Failure> {
        let options =
            RenderOptions { threads: self.threads.map(|threads| threads as usize), seed: self.seed, crop: self.crop };
        let result = match (&self.resume, &watch.keeper) {
            (Some(path), Some((_, origin))) => {
                let [width, height] = scene.resolution().map(u64::from);
                let state = keeper::read(path, origin, width * height)?;
                resume(scene, &options, &state, watch)
            }
            _ => render(scene, &options, watch).map_err(Into::into),
        };
        watch.progress.finish();
        result.map_err(|error| match (error, &self.resume, &watch.keeper) {
            (ResumeError::Unfit, Some(path), _) => keeper::unusable(path, "does not fit the rendering"),
            (_, _, Some((keeper, _))) if keeper.has_kept() => {
                eprintln!("stopped; go on with --resume {}", keeper.path().display());
                Failure::Interrupted
            }
            _ => {
                eprintln!("stopped; nothing was written");
                Failure::Interrupted
            }
        })
    }

    /// Shows the finished picture to the viewer, and removes what it no longer needs.
    fn finish(&self, mut watch: Watch, film: &Film) {
        if let Some((keeper, _)) = &watch.keeper {
            let warning = |why| format!("cannot remove the checkpoint `{}`: {why}", keeper.path().display());
            watch.warn(keeper.remove().map(warning));
        }
        let viewer = watch.viewer.take();
        watch.warn(viewer.and_then(|viewer| viewer.finish(film)));
    }

    fn report(&self, film: &Film, stats: &Stats, times: &Times, warnings: usize) -> Report {
        Report {
            parse_s: times.parse.as_secs_f64(),
            build_s: times.build.as_secs_f64(),
            render_s: times.render.as_secs_f64(),
            trace_s: times.spent.trace.as_secs_f64(),
            texture_s: times.spent.texture.as_secs_f64(),
            shade_s: times.spent.shade.as_secs_f64(),
            write_s: times.write.as_secs_f64(),
            total_s: times.total.as_secs_f64(),
            width: film.width,
            height: film.height,
            samples: stats.samples,
            rays: Rays::from(stats),
            texture_points: stats.texture_points,
            threads: stats.threads,
            simd: jaspe_noise::simd::level().name().to_owned(),
            peak_rss_bytes: peak_rss_bytes(),
            warnings,
        }
    }
}

/// The scene's name with `.png`, in the current folder.
fn default_output(scene: &Path) -> PathBuf {
    let mut name = scene.file_stem().unwrap_or_default().to_owned();
    name.push(".png");
    PathBuf::from(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_default_output_is_beside_the_reader() {
        assert_eq!(default_output(Path::new("scenes/six.materials.sc")), Path::new("six.materials.png"));
    }
}
