//! The Python package: built, installed into an environment of its own below `target/python`, and tested there.

use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::{cargo, root, run, target};

/// What a check may come to, beside passing.
pub enum Trouble {
    /// This machine cannot run it; why, and what would help.
    Skipped(String),
    /// These parts failed.
    Failed(Vec<String>),
}

/// Builds the package and runs all that is to be said about it: tests, types, stubs and documentation.
pub fn check() -> Result<(), Trouble> {
    let interpreter = interpreter().ok_or_else(|| {
        let message = "there is no Python of 3.9 or later (as python3, python, or as PYTHON names it)";
        Trouble::Skipped(message.to_owned())
    })?;
    let failed = |message: String| Trouble::Failed(vec![message]);
    let python = environment(&interpreter)?;
    install(&python).map_err(failed)?;
    let program = program().map_err(failed)?;
    let documentation = target().join("python/docs");
    let parts: [(&str, Vec<&OsStr>); 4] = [
        ("pytest", ["-m", "pytest", "-q"].map(OsStr::new).to_vec()),
        ("mypy", ["-m", "mypy"].map(OsStr::new).to_vec()),
        ("stubtest", ["-m", "mypy.stubtest", "jaspe", "--ignore-disjoint-bases"].map(OsStr::new).to_vec()),
        (
            "pdoc",
            [&["-W", "error", "-m", "pdoc", "jaspe", "-o"].map(OsStr::new)[..], &[documentation.as_os_str()]].concat(),
        ),
    ];
    let mut broken = Vec::new();
    for (name, arguments) in parts {
        println!("-- {name}");
        let mut command = Command::new(&python);
        command.args(arguments).current_dir(root()).env("JASPE", &program).env_remove("PYTHONPATH");
        if run(&mut command).is_err() {
            broken.push(name.to_owned());
        }
    }
    if broken.is_empty() { Ok(()) } else { Err(Trouble::Failed(broken)) }
}

/// A Python that is new enough.
fn interpreter() -> Option<PathBuf> {
    let named = std::env::var_os("PYTHON").map(PathBuf::from);
    let candidates = named.into_iter().chain(["python3", "python"].map(PathBuf::from));
    candidates.into_iter().find(|python| {
        let mut command = Command::new(python);
        command.args(["-c", "import sys; sys.exit(sys.version_info < (3, 9))"]);
        command.stdout(Stdio::null()).stderr(Stdio::null()).status().is_ok_and(|status| status.success())
    })
}

/// The environment's Python, with all that the tests need. It is kept until what they need changes.
fn environment(interpreter: &Path) -> Result<PathBuf, Trouble> {
    let folder = target().join("python/environment");
    let python = if cfg!(windows) { folder.join("Scripts/python.exe") } else { folder.join("bin/python") };
    let (wanted, stamp) = (wanted(), folder.join("wanted"));
    if fs::read_to_string(&stamp).is_ok_and(|found| found == wanted) {
        return Ok(python);
    }
    let _ = fs::remove_dir_all(&folder);
    run(Command::new(interpreter).args(["-m", "venv"]).arg(&folder)).map_err(|error| {
        Trouble::Skipped(format!("{error}: Python's own module `venv` is needed (often a package `python3-venv`)"))
    })?;
    let mut pip = pip(&python);
    pip.args(wanted.lines());
    run(&mut pip).map_err(|error| Trouble::Failed(vec![error]))?;
    fs::write(&stamp, &wanted).map_err(|error| Trouble::Failed(vec![error.to_string()]))?;
    Ok(python)
}

/// What the tests need: the group `test` of pyproject.toml, and what builds and runs the package.
fn wanted() -> String {
    let project = fs::read_to_string(root().join("pyproject.toml")).unwrap_or_default();
    let quoted = |start: &str| {
        let list = project.split_once(start).map_or("", |(_, rest)| rest);
        let list = list.split_once(']').map_or(list, |(list, _)| list);
        list.split('"').skip(1).step_by(2).map(str::to_owned).collect::<Vec<_>>()
    };
    [quoted("\nrequires = ["), quoted("\ndependencies = ["), quoted("\ntest = [")].concat().join("\n")
}

fn pip(python: &Path) -> Command {
    let mut command = Command::new(python);
    command.args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check"]).current_dir(root());
    command
}

/// Builds the wheel in the profile of the tests, and installs it.
fn install(python: &Path) -> Result<(), String> {
    let wheels = target().join("python/wheels");
    let _ = fs::remove_dir_all(&wheels);
    let mut maturin = Command::new(python);
    maturin.args(["-m", "maturin", "build", "--quiet", "--profile", "checked", "--interpreter"]).arg(python);
    run(maturin.arg("--out").arg(&wheels).current_dir(root()))?;
    let wheel = fs::read_dir(&wheels).map_err(|error| error.to_string())?.flatten().next();
    let wheel = wheel.ok_or("maturin has built no wheel")?.path();
    run(pip(python).args(["--no-deps", "--force-reinstall"]).arg(wheel))
}

/// The command line program, with which results are compared.
fn program() -> Result<PathBuf, String> {
    // With the features of the whole workspace, as the tests build it.
    run(&mut cargo(&["build", "--workspace", "--exclude", "jaspe-python", "--bins", "--profile", "checked"]))?;
    Ok(target().join("checked").join(format!("jaspe{}", std::env::consts::EXE_SUFFIX)))
}
