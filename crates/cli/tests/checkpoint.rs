//! `--checkpoint` and `--resume`: long renderings may be stopped, and go on to the same picture.

mod common;

use common::{Run, SCENE, folder, jaspe, names, run_in, write_scene};
use std::path::Path;
use std::process::Stdio;
use std::time::{Duration, Instant};

/// A picture that takes a second or more.
const SLOW: [&str; 6] = ["render", "a.sc", "--resolution", "160x120", "--samples", "128"];

/// Starts a rendering and presses Ctrl-C as soon as its state is in the file.
#[cfg(unix)]
fn interrupted(here: &Path, options: &[&str], state: &str) -> Run {
    let path = here.join(state);
    let old = std::fs::read(&path).ok();
    let child = jaspe()
        .args([&SLOW, options].concat())
        .current_dir(here)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    let started = Instant::now();
    while std::fs::read(&path).ok() == old {
        assert!(started.elapsed() < Duration::from_secs(60), "no checkpoint appears");
        std::thread::sleep(Duration::from_millis(10));
    }
    let killed = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(killed.is_ok_and(|status| status.success()));
    child.wait_with_output().expect("it ends").into()
}

#[cfg(unix)]
#[test]
fn a_rendering_goes_on_after_an_interrupt_to_the_same_bits() {
    let here = folder();
    write_scene(here.path(), "a.sc", SCENE);
    let whole = run_in(here.path(), &[&SLOW[..], &["-o", "whole.exr"]].concat());
    assert_eq!(whole.status, 0, "{}", whole.stderr);

    let options = ["-o", "x.exr", "--checkpoint", "a.state", "--checkpoint-every", "0.1", "--threads", "1"];
    let run = interrupted(here.path(), &options, "a.state");
    assert_eq!((run.status, run.stdout.as_str()), (130, ""), "{}", run.stderr);
    assert!(run.stderr.contains("stopped; go on with --resume a.state"), "{}", run.stderr);
    assert_eq!(names(here.path()), ["a.sc", "a.state", "whole.exr"]);

    let options = ["-o", "x.exr", "--resume", "a.state", "--checkpoint-every", "0.1", "--threads", "2"];
    let run = interrupted(here.path(), &options, "a.state");
    assert_eq!(run.status, 130, "{}", run.stderr);

    let kept = std::fs::read(here.path().join("a.state")).expect("it is there");
    let run = run_in(here.path(), &[&SLOW[..], &["-o", "x.exr", "--resume", "a.state"]].concat());
    assert_eq!(run.status, 0, "{}", run.stderr);
    let read = |name: &str| std::fs::read(here.path().join(name)).expect("it was written");
    assert!(read("x.exr") == read("whole.exr"), "the interruptions left a trace");
    assert_eq!(names(here.path()), ["a.sc", "whole.exr", "x.exr"], "the state is of no more use");

    // A state that is kept under another name stays.
    std::fs::write(here.path().join("a.state"), &kept).expect("it can be written");
    let options = ["-o", "x.exr", "--resume", "a.state", "--checkpoint", "b.state", "--checkpoint-every", "0.1"];
    let run = run_in(here.path(), &[&SLOW[..], &options].concat());
    assert_eq!(run.status, 0, "{}", run.stderr);
    assert!(read("x.exr") == read("whole.exr") && read("a.state") == kept);
    assert_eq!(names(here.path()), ["a.sc", "a.state", "whole.exr", "x.exr"]);
}

#[cfg(unix)]
#[test]
fn states_of_other_renderings_and_other_files_are_refused_with_a_reason() {
    let here = folder();
    write_scene(here.path(), "a.sc", SCENE);
    let kept = ["--checkpoint", "a.state", "--checkpoint-every", "0.1"];
    assert_eq!(interrupted(here.path(), &kept, "a.state").status, 130);
    let state = std::fs::read(here.path().join("a.state")).expect("it is there");
    let write = |name: &str, bytes: &[u8]| std::fs::write(here.path().join(name), bytes).expect("it can be written");
    write("cut.state", &state[..state.len() / 2]);
    let mut changed = state.clone();
    changed[state.len() / 2] ^= 1;
    write("changed.state", &changed);
    write("a.png", b"\x89PNG\r\n\x1a\n and so on");
    write("empty", b"");
    write("b.sc", SCENE.replace("depth 4", "depth 5").as_bytes());
    let resolution = ["--resolution", "160x120"];
    for (arguments, messages) in [
        (&["a.sc", "--resume", "none.state"][..], &["cannot read `none.state`"][..]),
        (&["a.sc", "--resume", "."], &["cannot go on from `.`: it is no file"]),
        (&["a.sc", "--checkpoint", "a.state"], &["there is a checkpoint in `a.state` already", "--resume a.state"]),
        (&["a.sc", "--checkpoint", "no/a.state"], &["there is no folder `no`"]),
        (&["a.sc", "--checkpoint", "x", "--checkpoint-every", "0"], &["expected 0.1"]),
        (&["a.sc", "--samples", "128", "--resume", "a.png"], &["it is no checkpoint", "--checkpoint has written"]),
        (&["a.sc", "--samples", "128", "--resume", "empty"], &["it is no checkpoint"]),
        (&["a.sc", "--samples", "128", "--resume", "cut.state"], &["it is cut off or damaged"]),
        (&["a.sc", "--samples", "128", "--resume", "changed.state"], &["it is cut off or damaged"]),
        (&["a.sc", "--samples", "64", "--resume", "a.state"], &["another rendering", "started with `--samples 128`"]),
        (&["a.sc", "--samples", "128", "--seed", "1", "--resume", "a.state"], &["started without `--seed 1`"]),
        (&["b.sc", "--samples", "128", "--resume", "a.state"], &["its scene was made of `a.sc`"]),
    ] {
        let run = run_in(here.path(), &[&["render", "-o", "x.png"], &resolution[..], arguments].concat());
        assert_eq!(run.status, 2, "{arguments:?}: {}", run.stderr);
        for message in messages {
            assert!(run.stderr.contains(message), "{message} in {arguments:?}: {}", run.stderr);
        }
        assert!(!here.path().join("x.png").exists(), "{arguments:?}");
    }
    write("a.sc", SCENE.replace("depth 4", "depth 5").as_bytes());
    let run = run_in(here.path(), &[&SLOW[..], &["--resume", "a.state"]].concat());
    assert_eq!(run.status, 2);
    assert!(run.stderr.contains("`a.sc` has changed since"), "{}", run.stderr);
    assert!(std::fs::read(here.path().join("a.state")).expect("it is there") == state, "nothing was lost");
}
