//! `jaspe gallery`.

use std::path::PathBuf;
use std::time::Instant;

use clap::Args;
use jaspe_bake::{SetFolder, write_gallery};
use jaspe_edge::message::count;
use jaspe_texture::Texture;
use jaspe_texture::declare::Declaration;

use crate::Outcome;
use crate::command::bake::unwritable;
use crate::command::textures::names;
use crate::failure::Failure;
use crate::interrupt;
use crate::progress::{Progress, When};
use crate::show::{duration, size as file_size};

/// Draw the materials with their names and parameters: a sheet of all, and a page for each.
///
/// The sheet is index.png; the page of a material has its name. The folder appears whole or not at all; a gallery that is
/// there is replaced.
#[derive(Debug, Args)]
#[command(after_long_help = "\
Examples:
  jaspe gallery -o gallery/
  jaspe gallery stone marble -o stones/")]
pub struct Gallery {
    /// The materials [default: all of them]
    #[arg(value_name = "NAME", value_parser = names())]
    names: Vec<String>,

    /// The folder for the pictures
    #[arg(short, long, value_name = "FOLDER")]
    output: PathBuf,

    /// When to show progress
    #[arg(long, value_enum, value_name = "WHEN", default_value_t = When::Auto)]
    progress: When,

    /// Print errors only
    #[arg(short, long)]
    quiet: bool,
}

impl Gallery {
    /// Draws and writes.
    pub fn run(self) -> Result<Outcome, Failure> {
        let started = Instant::now();
        interrupt::listen();
        let failed = |error| unwritable(&self.output, error);
        let folder = SetFolder::new(&self.output).map_err(failed)?;
        let progress = Progress::new("drawing", if self.quiet { When::Off } else { self.progress });
        let is_wanted = |declaration: &&Declaration| {
            self.names.is_empty() || self.names.iter().any(|name| name == declaration.name)
        };
        let materials: Vec<_> = Texture::ALL.iter().copied().filter(is_wanted).collect();
        let written = write_gallery(&materials, folder, &progress);
        progress.finish();
        let written = written.map_err(failed)?;
        if !self.quiet {
            let bytes: u64 = written.files.iter().map(|(_, size)| size).sum();
            let (files, size) = (count(written.files.len(), "file"), file_size(bytes as usize));
            eprintln!("{}: {files}, {size}, in {}", self.output.display(), duration(started.elapsed()));
        }
        Ok(Outcome::Done)
    }
}
