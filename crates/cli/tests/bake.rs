//! `jaspe bake`.

mod common;

use std::fs;

use common::{folder, jaspe, names, run_in};
use jaspe_bake::{Bake, Map, Settings};
use jaspe_texture::Texture;
use jaspe_texture::declare::Value;

#[test]
fn the_command_and_the_library_give_the_same_bits() {
    let here = folder();
    let arguments = [
        "bake",
        "organic",
        "--size",
        "40",
        "--maps",
        "color,normal,ao",
        "--set",
        "depth=6",
        "--seed",
        "9",
        "--bits",
        "16",
        "-o",
        "set",
    ];
    for threads in ["1", "3"] {
        let run = run_in(here.path(), &[&arguments[..], &["--threads", threads]].concat());
        assert_eq!((run.status, run.stdout.as_str()), (0, ""), "{}", run.stderr);
        assert!(run.stderr.starts_with("set: 3 maps of 40x40, 7 files, "), "{}", run.stderr);
        let texture =
            Texture::build("organic", &[("depth", Value::Int(6)), ("seed", Value::Int(9))]).expect("it is one");
        let maps = vec![Map::Color, Map::Normal, Map::Occlusion];
        let bake = Bake::new(texture, Settings { size: 40, maps, ..Settings::default() }).expect("it can be baked");
        for array in bake.arrays(0, &()).expect("nobody stops it").maps {
            let bytes = fs::read(here.path().join(format!("set/{}.png", array.map.name()))).expect("it was written");
            let image = image::load_from_memory(&bytes).expect("it is a picture");
            let found = if array.map.declaration().channels == 1 {
                image.into_luma16().into_raw()
            } else {
                image.into_rgb16().into_raw()
            };
            let expected: Vec<u16> = array.values.iter().map(|&v| (65535.0 * f64::from(v) + 0.5) as u16).collect();
            assert_eq!(found, expected, "{:?}", array.map);
        }
    }
}

#[test]
fn what_cannot_be_baked_is_told_with_advice() {
    let here = folder();
    fs::write(here.path().join("notes.txt"), "").expect("written");
    fs::create_dir(here.path().join("mine")).expect("made");
    fs::write(here.path().join("mine/notes.txt"), "").expect("written");
    let before = names(here.path());
    for (arguments, part) in [
        (&["bake", "marbel", "-o", "x"][..], "marble"),
        (&["bake", "marble"], "--output"),
        (&["bake", "marble", "-o", "x", "--maps", "colour"], "color"),
        (&["bake", "marble", "-o", "x", "--maps", "color,color"], "name each map once"),
        (&["bake", "marble", "-o", "x", "--set", "dept=3"], "did you mean `depth`?"),
        (&["bake", "marble", "-o", "x", "--set", "space=uv"], "--surface"),
        (&["bake", "marble", "-o", "x", "--tile", "-1"], "positive"),
        (&["bake", "stone", "-o", "x", "--tile", "1000"], "a smaller --tile"),
        (&["bake", "stone", "-o", "x", "--size", "0"], "1..=16384"),
        (&["bake", "stone", "-o", "x", "--frames", "5..5"], "such as 0..48"),
        (&["bake", "stone", "-o", "x", "--bits", "12"], "PNG takes 8 or 16"),
        (&["bake", "stone", "-o", "x", "--format", "jpeg", "--bits", "16"], "PNG takes 8 or 16"),
        (&["bake", "stone", "-o", "x", "--mesh", "missing.obj"], "missing.obj"),
        (&["bake", "stone", "-o", "x", "--mesh", "notes.txt"], "texture coordinates"),
        (&["bake", "stone", "-o", "x", "--format", "webp", "--size", "16384"], "at most 16383 pixels"),
        (&["bake", "stone", "-o", "missing/x"], "mkdir -p missing"),
        (&["bake", "stone", "-o", "notes.txt/x"], "cannot write `notes.txt/x`"),
        (&["bake", "stone", "-o", "notes.txt"], "cannot write"),
        (&["bake", "wood", "-o", "mine", "--size", "8"], "holds `notes.txt`"),
    ] {
        let run = run_in(here.path(), arguments);
        assert!(run.status == 2 && run.stderr.contains(part), "{arguments:?}: {}", run.stderr);
        assert_eq!(names(here.path()), before, "{arguments:?}");
    }
}

/// A limit on the size of files stands for a disk that is full.
#[cfg(unix)]
#[test]
fn a_full_disk_leaves_nothing_behind() {
    let here = folder();
    let program = jaspe().get_program().to_owned();
    for format in ["png", "exr", "jpeg"] {
        let mut shell = std::process::Command::new("sh");
        shell.args(["-c", "trap '' XFSZ; ulimit -f 8; exec \"$0\" \"$@\""]).arg(&program);
        shell.args(["bake", "stone", "--size", "256", "--maps", "color", "--format", format, "-o", "set"]);
        let output = shell.current_dir(here.path()).output().expect("the shell starts");
        let message = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{format}: {message}");
        assert!(message.contains("cannot write `set/color."), "{format}: {message}");
        assert_eq!(names(here.path()), Vec::<String>::new(), "{format}");
    }
}

/// What is forbidden is allowed to those who may do everything, as root may: then the program runs as somebody else.
#[cfg(unix)]
#[test]
fn a_read_only_folder_stays_as_it_is() {
    use std::os::unix::fs::PermissionsExt as _;
    use std::os::unix::process::CommandExt as _;

    const NOBODY: u32 = 65_534;
    let here = folder();
    let set_mode = |path: &std::path::Path, mode: u32| {
        fs::set_permissions(path, fs::Permissions::from_mode(mode)).expect("the folder is ours");
    };
    // A copy, since the program may lie where nobody else may go.
    let program = here.path().join("jaspe");
    fs::copy(jaspe().get_program(), &program).expect("copied");
    set_mode(here.path(), 0o755);
    let locked = here.path().join("locked");
    fs::create_dir(&locked).expect("made");
    set_mode(&locked, 0o555);
    let is_privileged = fs::write(locked.join("probe"), "").is_ok() && fs::remove_file(locked.join("probe")).is_ok();
    let bake = |name: &str, output: &str| {
        let mut command = std::process::Command::new(&program);
        command.args(["bake", name, "--size", "64", "--maps", "color", "-o", output]).current_dir(here.path());
        if is_privileged {
            command.uid(NOBODY).gid(NOBODY);
        }
        let output = command.output().expect("it starts");
        (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
    };
    let (status, message) = bake("stone", "locked/set");
    assert!(status == Some(2) && message.contains("cannot write `locked/set`: permission denied"), "{message}");
    assert!(message.contains("choose another place"), "{message}");
    assert_eq!(names(&locked), Vec::<String>::new());

    // Neither is a set there lost that cannot be replaced.
    set_mode(&locked, 0o777);
    let (status, message) = bake("stone", "locked/set");
    assert_eq!(status, Some(0), "{message}");
    let before = names(&locked.join("set"));
    for (parent, set) in [(0o555, 0o755), (0o777, 0o555)] {
        set_mode(&locked.join("set"), set);
        set_mode(&locked, parent);
        let (status, message) = bake("wood", "locked/set");
        assert!(status == Some(2) && message.contains("permission denied"), "{parent:o}: {message}");
        assert_eq!(
            (names(&locked), names(&locked.join("set"))),
            (vec!["set".to_owned()], before.clone()),
            "{parent:o}"
        );
    }
    set_mode(&locked, 0o777);
    set_mode(&locked.join("set"), 0o777);
}

/// A disk of a few pages, where one can be mounted: whichever write is the one too many, the set is whole or not there.
#[cfg(target_os = "linux")]
#[test]
fn a_disk_that_fills_up_holds_a_whole_set_or_none() {
    struct Disk(tempfile::TempDir);
    impl Disk {
        fn new(pages: u32) -> Option<Disk> {
            let disk = Disk(folder());
            let size = format!("size={}k", 4 * pages);
            let mut mount = std::process::Command::new("mount");
            mount.args(["-t", "tmpfs", "-o", &size, "jaspe-test"]).arg(disk.0.path());
            mount.output().is_ok_and(|output| output.status.success()).then_some(disk)
        }
    }
    impl Drop for Disk {
        fn drop(&mut self) {
            let _ = std::process::Command::new("umount").arg(self.0.path()).output();
        }
    }
    let (mut whole, mut refused) = (0, 0);
    for pages in 1..24 {
        // (Only those who may do everything may mount.)
        let Some(disk) = Disk::new(pages) else { return };
        let arguments = ["bake", "stone", "--size", "64", "--maps", "color,normal", "--normal", "dx", "-o", "set"];
        let run = run_in(disk.0.path(), &arguments);
        if run.status == 0 {
            let files =
                ["color.png", "material.json", "normal.gl.png", "normal.png", "stone.bin", "stone.gltf", "stone.mtlx"];
            assert_eq!(names(&disk.0.path().join("set")), files);
            whole += 1;
        } else {
            assert!(run.status == 2 && run.stderr.contains("cannot write `set/"), "{pages} pages: {}", run.stderr);
            assert!(
                run.stderr.contains("no space left") && run.stderr.contains("nothing was left behind"),
                "{}",
                run.stderr
            );
            assert_eq!(names(disk.0.path()), Vec::<String>::new(), "{pages} pages");
            refused += 1;
        }
    }
    assert!(whole > 0 && refused > 5, "{whole} whole, {refused} refused");
}

#[test]
fn sequences_and_previews_are_written() {
    let here = folder();
    let arguments =
        ["bake", "fire", "--size", "32", "--frames", "2..5", "--maps", "color,emission", "--quiet", "-o", "set"];
    let run = run_in(here.path(), &arguments);
    assert_eq!((run.status, run.stderr.as_str()), (0, ""));
    let files = names(&here.path().join("set"));
    assert_eq!(files[..4], ["color.0002.png", "color.0003.png", "color.0004.png", "emission.0002.png"]);
}

#[test]
fn a_gallery_has_a_sheet_and_a_page_for_each_material() {
    // One gallery takes the place of another.
    let here = folder();
    fs::create_dir(here.path().join("set")).expect("made");
    fs::write(here.path().join("set/gallery.json"), r#"{ "files": ["gallery.json", "jade.png"] }"#).expect("written");
    fs::write(here.path().join("set/jade.png"), "").expect("written");
    let run = run_in(here.path(), &["gallery", "stone", "-o", "set"]);
    assert!(run.status == 0 && run.stderr.starts_with("set: 3 files, "), "{}", run.stderr);
    let files = ["gallery.json", "index.png", "stone.png"];
    assert_eq!(
        (names(here.path()), names(&here.path().join("set"))),
        (vec!["set".to_owned()], files.map(str::to_owned).to_vec())
    );
    let list = fs::read(here.path().join("set/gallery.json")).expect("it was written");
    let list: serde_json::Value = serde_json::from_slice(&list).expect("it is JSON");
    assert_eq!((&list["materials"], &list["files"]), (&serde_json::json!(["stone"]), &serde_json::json!(files)));
    // Both show the rendered picture, with its many colours, on paper.
    for (name, least) in [("index.png", 5_000), ("stone.png", 20_000)] {
        let picture = image::open(here.path().join("set").join(name)).expect("a picture").into_rgb8();
        let colors = picture.pixels().collect::<std::collections::HashSet<_>>().len();
        assert!(colors > least && picture.get_pixel(2, 2).0 == [250, 249, 246], "{name}: {colors} colours");
    }
    let run = run_in(here.path(), &["gallery", "jade", "-o", "other"]);
    assert!(run.status == 2 && run.stderr.contains("marble"), "{}", run.stderr);
    assert_eq!(names(here.path()), ["set"]);
}

#[test]
fn the_gallery_refuses_a_folder_of_other_things() {
    let here = folder();
    fs::write(here.path().join("notes.txt"), "").expect("written");
    let run = run_in(here.path(), &["gallery", "-o", "."]);
    assert!(run.status == 2 && run.stderr.contains("holds `notes.txt`"), "{}", run.stderr);
    assert_eq!(names(here.path()), ["notes.txt"]);
}
