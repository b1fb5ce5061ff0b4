//! Runs the program as its users do.

#![allow(dead_code, reason = "each test binary uses its part")]

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

/// The repository's root.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().expect("the repository is there")
}

/// The program, with nothing of the tester's own environment that could matter.
pub fn jaspe() -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_jaspe"));
    command.env_remove("JASPE_SIMD").stdin(Stdio::null());
    command
}

/// What a run left behind.
pub struct Run {
    /// The exit status.
    pub status: i32,
    /// Results.
    pub stdout: String,
    /// Messages.
    pub stderr: String,
}

impl From<Output> for Run {
    fn from(output: Output) -> Self {
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("output is text");
        let status = output.status.code().expect("it ended by itself");
        Run { status, stdout: text(output.stdout), stderr: text(output.stderr) }
    }
}

/// Runs with these arguments in that folder.
pub fn run_in(folder: &Path, arguments: &[&str]) -> Run {
    jaspe().args(arguments).current_dir(folder).output().expect("the program starts").into()
}

/// Runs with these arguments.
pub fn run(arguments: &[&str]) -> Run {
    run_in(Path::new(env!("CARGO_TARGET_TMPDIR")), arguments)
}

/// Runs with these arguments and that text on standard input.
pub fn run_with_input(arguments: &[&str], input: &str) -> Run {
    let mut command = jaspe();
    let command = command.args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().expect("the program starts");
    let mut stdin = child.stdin.take().expect("it is piped");
    let input = input.to_owned();
    let writer = std::thread::spawn(move || {
        // A program that stops reading at a bad line is right to.
        let _ = stdin.write_all(input.as_bytes());
    });
    let run = child.wait_with_output().expect("it ends").into();
    writer.join().expect("writing does not panic");
    run
}

/// An empty folder that vanishes.
pub fn folder() -> tempfile::TempDir {
    tempfile::tempdir().expect("a folder can be made")
}

/// A small scene with one of everything that matters for how a picture is computed.
pub const SCENE: &str = "\
image { resolution 64 48 aa 0 1 }
background { color 0.1 0.2 0.3 }
light { type point color 1 1 1 power 2600 p 5 7 6 }
camera { type thinlens eye 1.5 2 6 target 0 0 0 up 0 1 0 fov 30 aspect 1.333333 fdist 6 lensr 0.1 }
shader { name floor type marble depth 4 }
shader { name clear type glass eta 1.5 color 1 1 1 }
shader { name silver type mirror refl 0.9 0.9 0.9 }
shader { name wood type wood }
object { shader floor type plane p 0 -1 0 n 0 1 0 }
object { shader clear type sphere c -0.8 0 0.5 r 0.9 }
object { shader silver type sphere c 1 0 -0.5 r 0.9 }
object { shader wood transform { scaleu 0.8 rotatey 30 translate 0 -0.6 1.8 } type box }
";

/// Writes a scene into a folder.
pub fn write_scene(folder: &Path, name: &str, text: &str) -> PathBuf {
    let path = folder.join(name);
    std::fs::write(&path, text).expect("it can be written");
    path
}

/// The names in a folder, sorted.
pub fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).expect("it can be read");
    let mut names: Vec<String> =
        entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}
