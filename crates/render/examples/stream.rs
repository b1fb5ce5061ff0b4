//! Renders a scene again and again, as a program with a window does, and says how many pictures a second that makes.
//!
//! ```sh
//! cargo run --release -p jaspe-render --example stream -- scenes/figures/7-six.sc --samples 1
//! cargo run --release -p jaspe-render --example stream -- scene.sc --dialect report --resolution 640x480 --threads 1
//! ```

use std::error::Error;
use std::path::Path;
use std::time::Instant;

use jaspe_render::{CompileOptions, RenderOptions, compile, render};
use jaspe_scene::{Dialect, DiskLoader, Loader, parse};

fn main() -> Result<(), Box<dyn Error>> {
    let mut args = std::env::args().skip(1);
    let scene =
        args.next().ok_or("give a scene, and if wished --threads, --pictures, --samples, --resolution, --dialect")?;
    let (mut options, mut threads, mut pictures) = (CompileOptions::default(), None, 200);
    while let Some(option) = args.next() {
        let value = args.next().ok_or(format!("{option} has no value"))?;
        match option.as_str() {
            "--threads" => threads = Some(value.parse()?),
            "--pictures" => pictures = value.parse::<usize>()?.max(1),
            "--samples" => options.samples = Some(value.parse()?),
            "--resolution" => {
                let (width, height) = value.split_once('x').ok_or("a resolution is WIDTHxHEIGHT")?;
                options.resolution = Some([width.parse()?, height.parse()?]);
            }
            "--dialect" if value == "report" => options.dialect = Some(Dialect::Report),
            "--dialect" if value == "sunflow" => options.dialect = Some(Dialect::Sunflow),
            _ => return Err(format!("{option} {value} means nothing here").into()),
        }
    }

    let path = Path::new(&scene);
    let (scene, mistakes) = parse(path, DiskLoader.load(path)?, &DiskLoader);
    let compilation = compile(&scene, &DiskLoader, &options);
    for mistake in mistakes.iter().chain(compilation.diagnostics.iter()) {
        eprintln!("{}", mistake.message);
    }
    let scene = compilation.scene.ok_or("the scene cannot be rendered: `jaspe check` says where and why")?;

    let options = RenderOptions { threads, ..RenderOptions::default() };
    let mut times = Vec::with_capacity(pictures);
    for _ in 0..pictures {
        let start = Instant::now();
        render(&scene, &options, &())?;
        times.push(start.elapsed().as_secs_f64());
    }
    times.sort_by(f64::total_cmp);
    let (least, median) = (times[0], times[pictures / 2]);
    println!("least {:.2} ms, median {:.2} ms: {:.0} pictures a second", 1e3 * least, 1e3 * median, 1.0 / median);
    Ok(())
}
