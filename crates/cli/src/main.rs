//! The command line: arguments, progress, messages and files. The only part of the project that talks to a terminal.
//!
//! Results go to standard output, everything else to standard error. Exit status: 0 done, 1 the scene (or comparison)
//! has errors, 2 usage or input/output, 130 interrupted.

mod arguments;
mod command;
mod failure;
mod interrupt;
mod keeper;
mod material;
mod measure;
mod progress;
mod report;
mod scene_file;
mod show;
mod stats;
mod terminal;
mod viewer;
mod watch;

use std::ffi::OsString;
use std::process::ExitCode;

use clap::{Parser, Subcommand};

use crate::failure::Failure;

/// Procedural materials, ray traced: renders Sunflow .sc scenes.
#[derive(Debug, Parser)]
#[command(name = "jaspe", version, propagate_version = true, arg_required_else_help = true)]
#[command(after_help = "Start with `jaspe render SCENE.sc`; `jaspe COMMAND --help` shows examples.")]
#[command(after_long_help = "\
Examples:
  jaspe render scenes/six-materials.sc       writes six-materials.png
  jaspe check my-scene.sc                    what is wrong with it, and where
  jaspe convert old.sc -o new.sc             the same scene, tidy and in one file
  jaspe textures marble                      the parameters of marble
  jaspe texture wood -o wood.png             one texture on a plane
  jaspe bake stone -o stone/                 maps that tile, for engines and modellers
  jaspe noise improved 0.5 0.25 0.5          prints -0.262939453125
  jaspe compare before.png after.png         how far apart two pictures are

Results go to standard output, progress and messages to standard error.
Exit status: 0 done, 1 the scene (or comparison) has errors, 2 usage or input/output, 130 interrupted.")]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    Render(command::render::Render),
    Check(command::check::Check),
    Convert(command::convert::Convert),
    Textures(command::textures::Textures),
    Texture(command::texture::Texture),
    Bake(command::bake::Bake),
    Gallery(command::gallery::Gallery),
    Noise(command::noise::Noise),
    Compare(command::compare::Compare),
    Bench(command::bench::Bench),
}

/// How a command ended, when nothing went wrong with using it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Outcome {
    /// It did what was asked.
    Done,
    /// The scene has errors, or the pictures differ too much.
    Found,
}

fn main() -> ExitCode {
    let result = match Arguments::parse_from(std::env::args_os().map(plain_number)).command {
        Command::Render(render) => render.run(),
        Command::Check(check) => check.run(),
        Command::Convert(convert) => convert.run(),
        Command::Textures(textures) => textures.run(),
        Command::Texture(texture) => texture.run(),
        Command::Bake(bake) => bake.run(),
        Command::Gallery(gallery) => gallery.run(),
        Command::Noise(noise) => noise.run(),
        Command::Compare(compare) => compare.run(),
        Command::Bench(bench) => bench.run(),
    };
    match result {
        Ok(Outcome::Done) => ExitCode::SUCCESS,
        Ok(Outcome::Found) => ExitCode::from(1),
        Err(Failure::Reported) => ExitCode::from(2),
        Err(Failure::Interrupted) => ExitCode::from(130),
        // Whoever read our results has had enough of them: `jaspe noise improved - | head`.
        Err(Failure::BrokenPipe) => ExitCode::SUCCESS,
        Err(Failure::Message { message, hints }) => {
            report::print_failure(&message, &hints);
            ExitCode::from(2)
        }
    }
}

/// Writes `-1e-3` as `-0.001` and `-.5` as `-0.5`: the argument parser knows the plainest negative numbers only and
/// takes others for options.
fn plain_number(argument: OsString) -> OsString {
    let number = argument.to_str().filter(|text| text.starts_with('-'));
    match number.and_then(|text| text.parse::<f64>().ok()) {
        Some(number) if number.is_finite() => number.to_string().into(),
        _ => argument,
    }
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory as _;

    #[test]
    fn arguments_are_declared_consistently() {
        super::Arguments::command().debug_assert();
    }

    #[test]
    fn negative_numbers_lose_their_exponents_and_nothing_else_changes() {
        let plain = |text: &str| super::plain_number(text.into()).into_string().expect("it is text");
        assert_eq!(plain("-1e-3"), "-0.001");
        assert_eq!(plain("-2.5E2"), "-250");
        assert_eq!(plain("-.5"), "-0.5");
        for text in ["1e-3", "-4.2", "--seed", "-e", "-o", "-", "-inf", "-1e999", "scene.sc"] {
            assert_eq!(plain(text), text);
        }
    }
}
