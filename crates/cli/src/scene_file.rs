//! Scene → compiled scene, with everything that is to be said about it on the way.

use std::fs::File;
use std::path::Path;
use std::time::{Duration, Instant};

use jaspe_render::{CompileOptions, CompiledScene, compile};
use jaspe_scene::{Diagnostics, Loader, Severity, Sources};

use crate::failure::Failure;
use crate::report;

/// A scene file, read and compiled.
#[derive(Debug)]
pub struct Loaded {
    /// The scene, unless there are errors.
    pub scene: Option<CompiledScene>,
    /// Everything there is to say.
    pub diagnostics: Diagnostics,
    /// What the diagnostics point into.
    pub sources: Sources,
    /// How long reading took.
    pub parse_time: Duration,
    /// How long compiling took.
    pub build_time: Duration,
}

/// Reads and compiles a scene, with all its files by this loader.
pub fn load(
    path: &Path,
    assignments: &[String],
    options: &CompileOptions,
    loader: &dyn Loader,
) -> Result<Loaded, Failure> {
    // That the file cannot be read at all is not the scene's fault.
    let metadata = File::open(path).and_then(|file| file.metadata()).map_err(|error| Failure::reading(path, &error))?;
    if metadata.is_dir() {
        return Err(Failure::new(format!("`{}` is a folder", path.display())).hint("name a scene file in it"));
    }

    let started = Instant::now();
    let (mut scene, mut diagnostics) = jaspe_scene::read(path, loader);
    // A scene with errors may lack the very shaders that are to change.
    if !diagnostics.has_errors() {
        for assignment in assignments {
            if let Err(refused) = jaspe_scene::set(&mut scene, assignment) {
                anstream::eprint!("{}", report::text(&refused, &scene.sources, Severity::Note));
                return Err(Failure::Reported);
            }
        }
    }
    let parse_time = started.elapsed();

    let started = Instant::now();
    let compilation = compile(&scene, loader, options);
    diagnostics.extend(compilation.diagnostics);
    let scene_without_errors = if diagnostics.has_errors() { None } else { compilation.scene };
    Ok(Loaded {
        scene: scene_without_errors,
        diagnostics,
        sources: scene.sources,
        parse_time,
        build_time: started.elapsed(),
    })
}
