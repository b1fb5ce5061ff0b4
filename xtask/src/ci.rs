//! `cargo xtask ci`: everything that must hold before a change is merged.

use std::process::Stdio;

use crate::python::{self, Trouble};
use crate::{cargo, run};

/// A check that runs before the tests.
struct Check {
    name: &'static str,
    /// The component that rustup may not have installed.
    component: Option<&'static str>,
    arguments: &'static [&'static str],
    environment: &'static [(&'static str, &'static str)],
}

const CHECKS: &[Check] = &[
    Check { name: "format", component: Some("fmt"), arguments: &["fmt", "--all", "--check"], environment: &[] },
    Check {
        name: "lints",
        component: Some("clippy"),
        arguments: &["clippy", "--workspace", "--all-targets", "--", "-D", "warnings"],
        environment: &[],
    },
    Check {
        name: "documentation",
        component: None,
        arguments: &["doc", "--workspace", "--no-deps", "--document-private-items"],
        environment: &[("RUSTDOCFLAGS", "-D warnings")],
    },
];

/// The tests. Those of the Python package are Python's.
const TESTS: &[&str] = &["test", "--workspace", "--exclude", "jaspe-python", "--profile", "checked"];

/// Runs every check, and the tests last, so that their results end the output. What failed is named at the end.
pub fn run_all() -> Result<(), String> {
    let mut failed = Vec::new();
    for check in CHECKS {
        if check.component.is_some_and(|component| !is_installed(component)) {
            println!("== {}: skipped, `cargo {}` is not installed", check.name, check.arguments[0]);
            continue;
        }
        println!("== {}", check.name);
        let mut command = cargo(check.arguments);
        command.envs(check.environment.iter().copied());
        if run(&mut command).is_err() {
            failed.push(check.name);
        }
    }
    println!("== python");
    match python::check() {
        Ok(()) => {}
        Err(Trouble::Skipped(reason)) => println!("== python: skipped, {reason}"),
        Err(Trouble::Failed(parts)) => {
            println!("== python: failed: {}", parts.join(", "));
            failed.push("python");
        }
    }
    println!("== tests");
    if run(&mut cargo(TESTS)).is_err() {
        failed.push("tests");
    }
    if failed.is_empty() { Ok(()) } else { Err(format!("failed: {}", failed.join(", "))) }
}

/// Checks the Python package alone.
pub fn run_python() -> Result<(), String> {
    python::check().map_err(|trouble| match trouble {
        Trouble::Skipped(reason) => reason,
        Trouble::Failed(parts) => format!("failed: {}", parts.join(", ")),
    })
}

fn is_installed(subcommand: &str) -> bool {
    let mut command = cargo(&[subcommand, "--version"]);
    command.stdout(Stdio::null()).stderr(Stdio::null()).status().is_ok_and(|status| status.success())
}
