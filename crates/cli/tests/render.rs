//! `jaspe render`: where things go, what they are called, and that nothing is ever half there.

mod common;

use common::{SCENE, folder, jaspe, names, run, run_in, write_scene};
use serde_json::Value;
use std::process::Stdio;

#[test]
fn the_default_output_is_named_after_the_scene_and_stands_in_the_current_folder() {
    let (scenes, here) = (folder(), folder());
    let scene = write_scene(scenes.path(), "my.first.sc", SCENE);
    let run = run_in(here.path(), &["render", &scene.to_string_lossy()]);
    assert_eq!((run.status, run.stdout.as_str()), (0, ""), "{}", run.stderr);
    assert_eq!(names(here.path()), ["my.first.png"]);
    assert_eq!(names(scenes.path()), ["my.first.sc"]);
    let lines: Vec<_> = run.stderr.lines().collect();
    assert!(lines.len() == 1 && lines[0].starts_with("my.first.png: 64x48, "), "{lines:?}");
}

#[test]
fn quiet_means_silent() {
    let here = folder();
    write_scene(here.path(), "a.sc", SCENE);
    let run = run_in(here.path(), &["render", "a.sc", "--quiet", "--progress", "on"]);
    assert_eq!((run.status, run.stdout.as_str(), run.stderr.as_str()), (0, "", ""));
}

#[test]
fn statistics_are_one_object_on_standard_output() {
    let here = folder();
    write_scene(here.path(), "a.sc", SCENE);
    let run = run_in(here.path(), &["render", "a.sc", "--stats", "json", "--threads", "2", "--time", "--samples", "4"]);
    let stats: Value = serde_json::from_str(&run.stdout).expect("it is JSON");
    let seconds = |key: &str| stats[key].as_f64().unwrap_or_else(|| panic!("no {key} in {stats}"));
    for key in ["parse_s", "build_s", "render_s", "trace_s", "texture_s", "shade_s", "write_s"] {
        assert!((0.0..=seconds("total_s")).contains(&seconds(key)), "{key} in {stats}");
    }
    // Threads wait at the end of so small a picture; they cannot work longer than it takes.
    let busy: f64 = ["trace_s", "texture_s", "shade_s"].map(seconds).iter().sum();
    assert!(busy > 0.1 * seconds("render_s") && busy <= seconds("render_s"), "{busy} in {stats}");
    assert_eq!((&stats["width"], &stats["height"], &stats["threads"]), (&64.into(), &48.into(), &2.into()));
    assert_eq!(stats["samples"], 64 * 48 * 4);
    assert_eq!(stats["rays"]["camera"], 64 * 48 * 4);
    for kind in ["shadow", "reflection", "refraction"] {
        assert!(stats["rays"][kind].as_u64().is_some_and(|count| count > 0), "{kind} in {stats}");
    }
    assert!(stats["texture_points"].as_u64().is_some_and(|count| count > 0), "{stats}");
    assert!(["scalar", "sse", "avx2", "avx512", "neon"].contains(&stats["simd"].as_str().expect("a word")));
    assert_eq!(stats["warnings"], 0);
    assert!(stats.get("peak_rss_bytes").is_some());
    let line = run.stderr.lines().find(|line| line.starts_with("parse ")).expect("a line of times");
    let stages: Vec<&str> = line.split(", ").filter_map(|stage| stage.split(' ').next()).collect();
    assert_eq!(stages, ["parse", "build", "trace", "texture", "shade", "write", "rest"], "{line}");
    let shares = line.split('(').skip(1).map(|rest| rest.split(' ').next().and_then(|share| share.parse::<i32>().ok()));
    let total: i32 = shares.map(|share| share.expect("a share")).sum();
    assert!((96..=104).contains(&total), "rounded shares add up to {total} in {line}");
}

#[test]
fn progress_can_be_printed_without_a_terminal() {
    let here = folder();
    write_scene(here.path(), "a.sc", SCENE);
    let run = run_in(here.path(), &["render", "a.sc", "--progress", "on"]);
    assert!(run.stderr.contains("rendering: 100 %"), "{}", run.stderr);
    let run = run_in(here.path(), &["render", "a.sc"]);
    assert!(!run.stderr.contains('%'), "{}", run.stderr);
}

#[test]
fn a_scene_with_errors_exits_with_one_and_writes_nothing() {
    let here = folder();
    write_scene(here.path(), "a.sc", &SCENE.replace("type marble", "type marbel"));
    let run = run_in(here.path(), &["render", "a.sc", "--stats", "json"]);
    assert_eq!((run.status, run.stdout.as_str()), (1, ""));
    for part in ["a.sc:5:26", "marbel", "did you mean `marble`?", "1 error"] {
        assert!(run.stderr.contains(part), "{part} in {}", run.stderr);
    }
    assert_eq!(names(here.path()), ["a.sc"]);
}

#[test]
fn usage_and_files_that_cannot_work_are_told_before_rendering() {
    let here = folder();
    write_scene(here.path(), "a.sc", SCENE);
    std::fs::create_dir(here.path().join("folder.png")).expect("it can be made");
    for (arguments, message) in [
        (&["missing.sc"][..], "cannot read `missing.sc`"),
        (&["b.sc"], "did you mean `./a.sc`?"),
        (&["folder.png", "-o", "x.png"], "is a folder"),
        (&["a.sc", "-o", "x.webm"], "unknown picture format `.webm`"),
        (&["a.sc", "-o", "x"], "needs an extension"),
        (&["a.sc", "-o", "nowhere/x.png"], "there is no folder `nowhere`"),
        (&["a.sc", "-o", "folder.png"], "it is a folder"),
        (&["a.sc", "-o", "x.jpg", "--bits", "16"], "no choice of bits"),
        (&["a.sc", "--resolution", "0x5"], "from 1 to 16384"),
        (&["a.sc", "--resolution", "640"], "such as 640x480"),
        (&["a.sc", "--crop", "0,0,65,48"], "the picture ends at 64,48"),
        (&["a.sc", "--crop", "5,5,5,9"], "no pixel"),
        (&["a.sc", "--samples", "0"], "--samples"),
        (&["a.sc", "--samples", "4", "--aa", "0", "1"], "cannot be used with"),
        (&["a.sc", "--threads", "0"], "--threads"),
        (&["a.sc", "--set", "nobody.depth=3"], "nobody"),
        (&["a.sc", "--set", "floor.dept=3"], "depth"),
        (&["a.sc", "--dialect", "sunfow"], "sunflow"),
        (&["a.sc", "--overide", "ids"], "--override"),
    ] {
        let run = run_in(here.path(), &[&["render"], arguments].concat());
        assert_eq!((run.status, run.stdout.as_str()), (2, ""), "{arguments:?}: {}", run.stderr);
        assert!(run.stderr.contains(message), "{arguments:?}: {}", run.stderr);
        assert_eq!(names(here.path()), ["a.sc", "folder.png"], "{arguments:?}");
    }
}

#[test]
fn every_format_is_written() {
    let here = folder();
    write_scene(here.path(), "a.sc", SCENE);
    for name in ["a.png", "a.jpg", "a.tiff", "a.bmp", "a.exr", "a.hdr"] {
        let run = run_in(here.path(), &["render", "a.sc", "-o", name, "--samples", "1"]);
        assert_eq!(run.status, 0, "{name}: {}", run.stderr);
        let bytes = std::fs::read(here.path().join(name)).expect("it was written");
        let image = image::load_from_memory(&bytes).expect("it is a picture");
        assert_eq!((image.width(), image.height()), (64, 48), "{name}");
    }
    assert_eq!(run_in(here.path(), &["render", "a.sc", "-o", "b.png", "--bits", "16"]).status, 0);
    let image = image::open(here.path().join("b.png")).expect("it is a picture");
    assert_eq!(image.color().bits_per_pixel() / u16::from(image.color().channel_count()), 16);
}

#[test]
fn options_reach_the_renderer() {
    let here = folder();
    write_scene(here.path(), "a.sc", SCENE);
    let render = |options: &[&str]| {
        let run = run_in(here.path(), &[&["render", "a.sc", "-o", "x.png"], options].concat());
        assert_eq!(run.status, 0, "{options:?}: {}", run.stderr);
        image::open(here.path().join("x.png")).expect("it is a picture").into_rgb8()
    };
    let plain = render(&[]);
    assert_eq!(render(&["--resolution", "32x24"]).dimensions(), (32, 24));
    for options in [
        &["--set", "floor.depth=1"][..],
        &["--set", "floor.seed=5", "--set", "wood.depth=1"],
        &["--override", "normals"],
        &["--override", "ids"],
        &["--dialect", "report"],
        &["--seed", "9"],
        &["--aa", "-1", "0"],
        &["--samples", "9"],
    ] {
        assert!(render(options) != plain, "{options:?}");
    }
}

#[test]
fn a_link_stays_a_link_and_an_old_picture_stays_until_the_new_one_is_whole() {
    let here = folder();
    write_scene(here.path(), "a.sc", SCENE);
    std::fs::write(here.path().join("real.png"), "old").expect("it can be written");
    assert_eq!(run_in(here.path(), &["render", "a.sc", "-o", "real.png", "--crop", "0,0,99,99"]).status, 2);
    assert_eq!(std::fs::read(here.path().join("real.png")).expect("it is there"), b"old");
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("real.png", here.path().join("link.png")).expect("links can be made");
        assert_eq!(run_in(here.path(), &["render", "a.sc", "-o", "link.png"]).status, 0);
        assert!(here.path().join("link.png").is_symlink());
        assert!(image::open(here.path().join("real.png")).is_ok());
    }
}

#[cfg(unix)]
#[test]
fn an_interrupt_ends_with_130_and_leaves_nothing() {
    let here = folder();
    write_scene(here.path(), "a.sc", SCENE);
    let mut child = jaspe()
        .args(["render", "a.sc", "--resolution", "4000x3000", "--samples", "4096", "--progress", "on"])
        .current_dir(here.path())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    std::thread::sleep(std::time::Duration::from_millis(300));
    let killed = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(killed.is_ok_and(|status| status.success()));
    assert_eq!(child.wait().expect("it ends").code(), Some(130));
    assert_eq!(names(here.path()), ["a.sc"]);
}

#[test]
fn help_and_version_go_to_standard_output() {
    for arguments in [&["--help"][..], &["render", "--help"], &["--version"], &["help", "noise"]] {
        let run = run(arguments);
        assert_eq!((run.status, run.stderr.as_str()), (0, ""), "{arguments:?}");
        assert!(run.stdout.contains("jaspe"), "{arguments:?}");
    }
    let run = run(&[]);
    assert_eq!((run.status, run.stdout.as_str()), (2, ""));
    assert!(run.stderr.contains("Usage: jaspe <COMMAND>"), "{}", run.stderr);
}
