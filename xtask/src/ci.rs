//! `cargo xtask ci`: everything that must hold before a change is merged.

use std::process::Stdio;

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
    println!("== tests");
    if run(&mut cargo(&["test", "--workspace", "--profile", "checked"])).is_err() {
        failed.push("tests");
    }
    if failed.is_empty() { Ok(()) } else { Err(format!("failed: {}", failed.join(", "))) }
}

fn is_installed(subcommand: &str) -> bool {
    let mut command = cargo(&[subcommand, "--version"]);
    command.stdout(Stdio::null()).stderr(Stdio::null()).status().is_ok_and(|status| status.success())
}
