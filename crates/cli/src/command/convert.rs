//! `jaspe convert`.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use clap::Args;
use jaspe_edge::file::Target;
use jaspe_scene::{DiskLoader, Includes, Severity};

use crate::Outcome;
use crate::failure::Failure;
use crate::report;

/// Write a scene anew: the same scene, tidy, in the order that Sunflow insists on.
///
/// Old and loose forms are written as they should be, numbers keep their values exactly, and comments are left out. Included
/// files become part of the scene unless they are kept. A scene with errors is not written.
#[derive(Debug, Args)]
#[command(after_long_help = "\
Examples:
  jaspe convert old.sc -o new.sc
  jaspe convert old.sc --keep-includes -o new.sc
  jaspe convert old.sc | less")]
pub struct Convert {
    /// The scene
    #[arg(value_name = "SCENE.sc")]
    scene: PathBuf,

    /// The file to write [default: standard output]
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,

    /// Keep the `include` lines instead of what they include
    #[arg(long)]
    keep_includes: bool,
}

impl Convert {
    /// Reads, and writes.
    pub fn run(self) -> Result<Outcome, Failure> {
        let target = self.output.as_deref().map(Target::new).transpose()?;
        std::fs::File::open(&self.scene).map_err(|error| Failure::reading(&self.scene, &error))?;
        let (scene, diagnostics) = jaspe_scene::read(&self.scene, &DiskLoader);
        anstream::eprint!("{}", report::text(&diagnostics, &scene.sources, Severity::Note));
        if diagnostics.has_errors() {
            return Ok(Outcome::Found);
        }
        let includes = if self.keep_includes { Includes::Keep } else { Includes::Inline };
        let folder = self.output.as_deref().and_then(Path::parent).unwrap_or(Path::new(""));
        let mut bytes = Vec::new();
        jaspe_scene::write(&scene, includes, folder, &mut bytes)?;
        match target {
            Some(target) => target.write(&bytes)?,
            None => std::io::stdout().write_all(&bytes)?,
        }
        Ok(Outcome::Done)
    }
}
