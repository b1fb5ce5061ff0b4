//! `jaspe bench scenes`.

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

use clap::Args;

use super::stopwatch::median;
use crate::Outcome;
use crate::failure::Failure;
use crate::measure::{Shown, compare};

/// Time scenes as whole processes, next to another renderer.
///
/// Each scene is rendered by this program and by the other one in turn, several times; the table gives the medians, how
/// many times as long the other one takes, and the FLIP of the two pictures (how visible their difference is, from 0 to
/// 1).
#[derive(Debug, Args)]
#[command(after_long_help = "\
Examples:
  jaspe bench scenes scenes/*.sc
  jaspe bench scenes a.sc b.sc --peer 'java -jar sunflow.jar -nogui -o {out} {scene}'
  jaspe bench scenes old.sc --option=--dialect --option=report --runs 9")]
pub struct Scenes {
    /// The scenes
    #[arg(value_name = "SCENE.sc", required = true)]
    scenes: Vec<PathBuf>,

    /// Another renderer: a command of the shell in which {scene} and {out} stand for the scene and a PNG to write
    #[arg(long, value_name = "COMMAND", value_parser = template)]
    peer: Option<String>,

    /// How often each renders each scene
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..=1000))]
    runs: u32,

    /// An option of `jaspe render` to measure with; may be repeated
    #[arg(long = "option", value_name = "OPTION", allow_hyphen_values = true)]
    options: Vec<String>,
}

fn template(text: &str) -> Result<String, String> {
    match ["{scene}", "{out}"].into_iter().find(|place| !text.contains(place)) {
        Some(missing) => Err(format!("expected a command with {missing}, as in 'renderer {{scene}} -o {{out}}'")),
        None => Ok(text.to_owned()),
    }
}

impl Scenes {
    /// Measures, and prints a row for each scene.
    pub fn run(self) -> Result<Outcome, Failure> {
        let folder = tempfile::tempdir().map_err(|error| Failure::new(format!("no room for pictures: {error}")))?;
        let [ours, theirs] = ["jaspe.png", "peer.png"].map(|name| folder.path().join(name));
        let mut out = std::io::stdout().lock();
        match self.peer {
            Some(_) => {
                writeln!(out, "{:32} {:>10} {:>10} {:>8} {:>8}", "scene", "jaspe, s", "peer, s", "ratio", "FLIP")?
            }
            None => writeln!(out, "{:32} {:>10}", "scene", "jaspe, s")?,
        }
        let mut logarithms = Vec::new();
        for scene in &self.scenes {
            let (mut times, mut peer_times) = (Vec::new(), Vec::new());
            for _ in 0..self.runs {
                times.push(time(&mut self.our_command(scene, &ours)?, scene)?);
                if let Some(peer) = &self.peer {
                    peer_times.push(time(&mut shell(peer, scene, &theirs), scene)?);
                }
            }
            let (name, time) = (scene.file_name().unwrap_or(scene.as_os_str()).to_string_lossy(), median(times));
            if peer_times.is_empty() {
                writeln!(out, "{name:32} {time:>10.3}")?;
                continue;
            }
            let peer_time = median(peer_times);
            logarithms.push(jaspe_noise::math::ln(peer_time / time));
            let flip = flip(&ours, &theirs)?;
            writeln!(out, "{name:32} {time:>10.3} {peer_time:>10.3} {:>8.2} {flip:>8}", peer_time / time)?;
        }
        if logarithms.len() > 1 {
            let mean = jaspe_noise::math::exp(logarithms.iter().sum::<f64>() / logarithms.len() as f64);
            writeln!(out, "{:32} {:>10} {:>10} {mean:>8.2}", "geometric mean", "", "")?;
        }
        Ok(Outcome::Done)
    }

    fn our_command(&self, scene: &Path, picture: &Path) -> Result<Command, Failure> {
        let program = std::env::current_exe()
            .map_err(|error| Failure::new(format!("this program cannot find itself: {error}")))?;
        let mut command = Command::new(program);
        command.arg("render").arg(scene).arg("-o").arg(picture).arg("--quiet").args(&self.options);
        Ok(command)
    }
}

/// A command of the shell, with the places filled in.
fn shell(template: &str, scene: &Path, out: &Path) -> Command {
    let quoted = |path: &Path| {
        let text = path.to_string_lossy();
        if cfg!(windows) { format!("\"{text}\"") } else { format!("'{}'", text.replace('\'', r"'\''")) }
    };
    let line = template.replace("{scene}", &quoted(scene)).replace("{out}", &quoted(out));
    let (program, option) = if cfg!(windows) { ("cmd", "/C") } else { ("sh", "-c") };
    let mut command = Command::new(program);
    command.arg(option).arg(line);
    command
}

/// Seconds that a command takes from its start to its end.
fn time(command: &mut Command, scene: &Path) -> Result<f64, Failure> {
    let program = command.get_program().to_string_lossy().into_owned();
    let start = Instant::now();
    let output = command
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .output()
        .map_err(|error| Failure::new(format!("cannot run `{program}`: {error}")))?;
    let seconds = start.elapsed().as_secs_f64();
    if output.status.success() {
        return Ok(seconds);
    }
    let told = String::from_utf8_lossy(&output.stderr);
    let last = told.lines().rfind(|line| !line.trim().is_empty()).unwrap_or("it says nothing");
    Err(Failure::new(format!("`{}` was not rendered: {}, {last}", scene.display(), output.status)))
}

/// FLIP of two pictures, or why there is none.
fn flip(ours: &Path, theirs: &Path) -> Result<String, Failure> {
    let (a, b) = (Shown::read(ours)?, Shown::read(theirs)?);
    if (a.width, a.height) != (b.width, b.height) {
        return Ok("sizes".to_owned());
    }
    Ok(format!("{:.4}", compare(&b, &a).0.flip))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn peers_need_a_scene_and_a_picture() {
        assert!(template("sunflow {scene}").unwrap_err().contains("{out}"));
        assert!(template("sunflow -o {out} {scene}").is_ok());
    }

    #[cfg(unix)]
    #[test]
    fn odd_names_survive_the_shell() {
        let folder = tempfile::tempdir().expect("a folder");
        let odd = folder.path().join("it's a $scene.sc");
        std::fs::write(&odd, "text").expect("written");
        let copy = folder.path().join("copy of it.png");
        time(&mut shell("cp {scene} {out}", &odd, &copy), &odd).unwrap_or_else(|_| panic!("cp works"));
        assert_eq!(std::fs::read_to_string(copy).expect("copied"), "text");
        assert!(time(&mut shell("cp {out} {scene}", &odd, &folder.path().join("none")), &odd).is_err());
    }
}
