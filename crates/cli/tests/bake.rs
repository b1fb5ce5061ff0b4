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
fn the_gallery_refuses_a_folder_of_other_things() {
    let here = folder();
    fs::write(here.path().join("notes.txt"), "").expect("written");
    let run = run_in(here.path(), &["gallery", "-o", "."]);
    assert!(run.status == 2 && run.stderr.contains("holds `notes.txt`"), "{}", run.stderr);
    assert_eq!(names(here.path()), ["notes.txt"]);
}
