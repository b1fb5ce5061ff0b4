//! `jaspe check`.

use std::io::Write as _;
use std::path::PathBuf;

use clap::Args;
use jaspe_edge::message;
use jaspe_render::CompileOptions;
use jaspe_scene::{Dialect, DiskLoader, Severity};
use serde_json::json;

use crate::Outcome;
use crate::arguments::{OutputFormat, dialect};
use crate::failure::Failure;
use crate::{report, scene_file};

/// Read a scene and report everything that is wrong with it.
///
/// Nothing is rendered. The exit status is 1 when the scene has errors; warnings and notes do not count.
#[derive(Debug, Args)]
#[command(after_long_help = "\
Examples:
  jaspe check my-scene.sc
  jaspe check my-scene.sc --dialect report
  jaspe check my-scene.sc --format json | jq '.diagnostics[] | \"\\(.file):\\(.line): \\(.message)\"'")]
pub struct Check {
    /// The scene
    #[arg(value_name = "SCENE.sc")]
    scene: PathBuf,

    /// How to print the messages
    #[arg(long, value_enum, default_value_t = OutputFormat::Text)]
    format: OutputFormat,

    /// Whose meaning the scene's words have [default: what the scene says, else sunflow]
    #[arg(long, value_name = "DIALECT", value_parser = dialect())]
    dialect: Option<Dialect>,

    /// Change a parameter of a named shader before checking
    #[arg(long, value_name = "NAME.KEY=VALUE")]
    set: Vec<String>,
}

impl Check {
    /// Checks and prints.
    pub fn run(self) -> Result<Outcome, Failure> {
        let options = CompileOptions { dialect: self.dialect, ..CompileOptions::default() };
        let loaded = scene_file::load(&self.scene, &self.set, &options, &DiskLoader)?;
        let (diagnostics, sources) = (&loaded.diagnostics, &loaded.sources);
        match self.format {
            OutputFormat::Text => {
                let text = report::text(diagnostics, sources, Severity::Note);
                let summary = message::summary(diagnostics);
                writeln!(anstream::stdout(), "{text}{}: {summary}", self.scene.display())?;
            }
            OutputFormat::Json => {
                let value = json!({
                    "scene": self.scene.to_string_lossy(),
                    "errors": diagnostics.count(Severity::Error),
                    "warnings": diagnostics.count(Severity::Warning),
                    "notes": diagnostics.count(Severity::Note),
                    "suppressed": diagnostics.suppressed(),
                    "diagnostics": report::json(diagnostics, sources),
                });
                writeln!(std::io::stdout(), "{value:#}")?;
            }
        }
        Ok(if diagnostics.has_errors() { Outcome::Found } else { Outcome::Done })
    }
}
