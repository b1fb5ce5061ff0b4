//! `jaspe check`, `textures`, `texture` and `compare`.

mod common;

use common::{SCENE, folder, names, run, run_in, write_scene};
use image::{Rgb, RgbImage, Rgba, RgbaImage};
use serde_json::Value;
use std::path::Path;

fn json(text: &str) -> Value {
    serde_json::from_str(text).expect("it is JSON")
}

#[test]
fn check_reports_on_standard_output_and_by_its_status() {
    let here = folder();
    write_scene(here.path(), "good.sc", SCENE);
    let run = run_in(here.path(), &["check", "good.sc"]);
    assert_eq!((run.status, run.stdout.as_str(), run.stderr.as_str()), (0, "good.sc: no errors\n", ""));

    let broken = SCENE.replace("type marble", "type marbel").replace("fov 30", "fov wide");
    write_scene(here.path(), "bad.sc", &broken);
    let run = run_in(here.path(), &["check", "bad.sc"]);
    assert_eq!((run.status, run.stderr.as_str()), (1, ""));
    for part in ["bad.sc:4:", "wide", "bad.sc:5:26", "did you mean `marble`?", "bad.sc: 2 errors"] {
        assert!(run.stdout.contains(part), "{part} in {}", run.stdout);
    }
    assert_eq!(names(here.path()), ["bad.sc", "good.sc"]);
    assert_eq!(run_in(here.path(), &["check", "missing.sc"]).status, 2);
}

#[test]
fn check_gives_places_as_data() {
    let here = folder();
    write_scene(here.path(), "bad.sc", &SCENE.replace("type marble", "type marbel"));
    let run = run_in(here.path(), &["check", "bad.sc", "--format", "json"]);
    let value = json(&run.stdout);
    assert_eq!((run.status, &value["errors"], &value["suppressed"]), (1, &1.into(), &0.into()));
    let first = &value["diagnostics"][0];
    assert_eq!((&first["severity"], &first["line"], &first["column"]), (&"error".into(), &5.into(), &26.into()));
    assert_eq!(first["file"], "bad.sc");
    assert!(first["hints"][0].as_str().is_some_and(|hint| hint.contains("marble")), "{first}");
}

#[test]
fn textures_are_listed_for_people_and_programs() {
    let list = json(&run(&["textures", "--format", "json"]).stdout);
    let names: Vec<_> = list.as_array().expect("a list").iter().map(|entry| entry["name"].as_str()).collect();
    for name in ["fire", "water", "organic", "stone", "wood", "marble"] {
        assert!(names.contains(&Some(name)), "{name}");
    }
    let one = json(&run(&["textures", "marble", "--format", "json"]).stdout);
    let parameters = one[0]["parameters"].as_array().expect("a list");
    let depth = parameters.iter().find(|parameter| parameter["name"] == "depth").expect("marble has a depth");
    assert!(depth["kind"] == "int" && depth["min"].is_i64() && depth["max"].is_i64() && depth["default"].is_i64());

    let text = run(&["textures", "marble"]).stdout;
    assert!(text.starts_with("marble\n") && text.contains("improved|classic|lattice") && !text.contains("wood\n"));
    let wrong = run(&["textures", "marbel"]);
    assert!(wrong.status == 2 && wrong.stderr.contains("'marble'"), "{}", wrong.stderr);
}

#[test]
fn a_texture_is_drawn_as_asked() {
    let here = folder();
    let draw = |options: &[&str]| {
        let run = run_in(here.path(), &[&["texture", "wood", "-o", "x.png", "--size", "60x40"], options].concat());
        assert_eq!((run.status, run.stdout.as_str()), (0, ""), "{options:?}: {}", run.stderr);
        image::open(here.path().join("x.png")).expect("it is a picture").into_rgb8()
    };
    let plain = draw(&[]);
    assert_eq!(plain.dimensions(), (60, 40));
    assert!(draw(&["--quiet"]) == plain);
    for options in [&["--set", "depth=1"][..], &["--set", "seed=3"], &["--scale", "2"], &["--set", "space=uv"]] {
        assert!(draw(options) != plain, "{options:?}");
    }
    // Twice as large is what `scale 2` means in a scene.
    assert!(draw(&["--scale", "2"]) == draw(&["--set", "scale=2"]));
}

#[test]
fn wrong_textures_are_explained() {
    let here = folder();
    for (arguments, message) in [
        (&["wod", "-o", "x.png"][..], "'wood'"),
        (&["wood", "-o", "x.png", "--set", "dept=3"], "did you mean `depth`?"),
        (&["wood", "-o", "x.png", "--set", "depth=many"], "a whole number from"),
        (&["wood", "-o", "x.png", "--set", "depth=-1"], "a whole number from"),
        (&["wood", "-o", "x.png", "--set", "depth"], "KEY=VALUE"),
        (&["wood", "-o", "x.png", "--scale", "0"], "--scale"),
        (&["wood", "-o", "x.gif"], "unknown picture format `.gif`"),
        (&["wood"], "--output"),
    ] {
        let run = run_in(here.path(), &[&["texture"], arguments].concat());
        assert_eq!((run.status, run.stdout.as_str()), (2, ""), "{arguments:?}");
        assert!(run.stderr.contains(message), "{arguments:?}: {}", run.stderr);
        assert!(names(here.path()).is_empty(), "{arguments:?}");
    }
}

/// Two small pictures, one pixel apart by ten steps.
fn pictures(folder: &Path) {
    let mut picture = RgbImage::from_fn(20, 10, |x, y| Rgb([10 * x as u8, 20 * y as u8, 128]));
    picture.save(folder.join("a.png")).expect("it can be written");
    picture.get_pixel_mut(5, 5).0[2] += 10;
    picture.save(folder.join("b.png")).expect("it can be written");
    RgbImage::new(10, 20).save(folder.join("turned.png")).expect("it can be written");
}

#[test]
fn compare_measures_and_judges() {
    let here = folder();
    pictures(here.path());
    let compare = |arguments: &[&str]| run_in(here.path(), &[&["compare"], arguments].concat());

    let same = json(&compare(&["a.png", "a.png", "--format", "json"]).stdout);
    assert_eq!((&same["mean_error"], &same["flip"], &same["psnr_db"]), (&0.0.into(), &0.0.into(), &Value::Null));

    let other = json(&compare(&["a.png", "b.png", "--format", "json"]).stdout);
    assert_eq!((&other["max_error"], &other["pixels_past_one_step"]), (&10.0.into(), &1.into()));
    assert!((other["mean_error"].as_f64().expect("a number") - 10.0 / 600.0).abs() < 1e-5, "{other}");
    assert!(other["flip"].as_f64().is_some_and(|flip| flip > 0.0 && flip < 0.1), "{other}");

    assert_eq!(compare(&["a.png", "b.png"]).status, 0);
    assert_eq!(compare(&["a.png", "a.png", "--max-flip", "0"]).status, 0);
    let strict = compare(&["a.png", "b.png", "--max-flip", "0"]);
    assert!(strict.status == 1 && strict.stdout.contains("FLIP") && strict.stderr.contains("more than 0"));
    let turned = compare(&["a.png", "turned.png"]);
    assert!(turned.status == 1 && turned.stderr.contains("`turned.png` is 10x20"), "{}", turned.stderr);
    assert_eq!(compare(&["a.png", "nothing.png"]).status, 2);
    assert_eq!(compare(&["a.png", "b.png", "--max-flip", "2"]).status, 2);

    assert_eq!(compare(&["a.png", "b.png", "-o", "d.png"]).status, 0);
    assert_eq!(image::open(here.path().join("d.png")).expect("it is a picture").width(), 20);
}

#[test]
fn transparent_pictures_are_compared_on_black() {
    let here = folder();
    RgbaImage::from_pixel(8, 8, Rgba([200, 100, 50, 0])).save(here.path().join("clear.png")).expect("written");
    RgbImage::new(8, 8).save(here.path().join("black.png")).expect("written");
    let value = json(&run_in(here.path(), &["compare", "clear.png", "black.png", "--format", "json"]).stdout);
    assert_eq!(value["max_error"], 0.0);
}

#[test]
fn pictures_that_are_none_are_usage_errors() {
    let here = folder();
    std::fs::write(here.path().join("a.png"), "not a picture").expect("written");
    let run = run_in(here.path(), &["compare", "a.png", "a.png"]);
    assert!(run.status == 2 && run.stderr.contains("cannot read `a.png` as a picture"), "{}", run.stderr);
}

#[test]
fn convert_writes_the_same_scene_with_or_without_its_includes() {
    let here = folder();
    std::fs::create_dir(here.path().join("out")).expect("a folder");
    write_scene(here.path(), "part.sc", "shader { name a type constant 1 0 0 }");
    write_scene(here.path(), "main.sc", "% a remark\ninclude part.sc object { shader a type sphere c 0 0 0 r 1 }");
    let inlined = run_in(here.path(), &["convert", "main.sc"]);
    let ball = "object { shader a type sphere c 0 0 0 r 1 }\n";
    let expected = format!("shader {{ name a type constant color 1 0 0 }}\n{ball}");
    assert_eq!((inlined.status, inlined.stdout, inlined.stderr.as_str()), (0, expected, ""));
    let kept = run_in(here.path(), &["convert", "main.sc", "--keep-includes", "-o", "out/new.sc"]);
    assert_eq!((kept.status, kept.stdout.as_str()), (0, ""));
    let written = std::fs::read_to_string(here.path().join("out/new.sc")).expect("written");
    assert_eq!(written, format!("includepath ..\ninclude part.sc\n{ball}"));
    let checked = run_in(here.path(), &["check", "out/new.sc"]);
    assert!(checked.stdout.contains("no camera"), "{}", checked.stdout);

    write_scene(here.path(), "bad.sc", "object { shader a type spere }");
    let bad = run_in(here.path(), &["convert", "bad.sc", "-o", "out/bad.sc"]);
    assert!(bad.status == 1 && bad.stderr.contains("did you mean `sphere`?"), "{}", bad.stderr);
    assert!(!here.path().join("out/bad.sc").exists());
    assert_eq!(run_in(here.path(), &["convert", "missing.sc"]).status, 2);
}

#[test]
fn rays_are_timed_with_and_without_a_peer() {
    let here = folder();
    let obj = "v -1 0 -1\nv 1 0 -1\nv 0 0 1\nv 0 1 0\nf 1 2 3\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
    std::fs::write(here.path().join("four.obj"), obj).expect("written");
    let run = run_in(here.path(), &["bench", "rays", "four.obj", "--runs", "1"]);
    assert_eq!(run.status, 0, "{}", run.stderr);
    assert!(run.stdout.contains("four.obj, 4 triangles"), "{}", run.stdout);
    for row in ["camera", "bounce", "shuffled", "ambient occlusion", "shadow", "build, ms", "memory, MB"] {
        let line = run.stdout.lines().find_map(|line| line.strip_prefix(row)).expect(row);
        let figure = line.split_whitespace().next().and_then(|figure| figure.parse::<f64>().ok());
        assert!(figure.is_some_and(|figure| figure >= 0.0), "{row}: {line}");
    }
    assert!(run.stderr.contains("--embree") || run.stdout.contains("Embree"), "{}", run.stderr);

    let run = run_in(here.path(), &["bench", "rays", "--embree", "four.obj"]);
    assert!(run.status == 2 && run.stderr.contains("libembree4.so"), "{}", run.stderr);
    std::fs::write(here.path().join("none.obj"), "v 0 0 0\n").expect("written");
    let run = run_in(here.path(), &["bench", "rays", "none.obj"]);
    assert!(run.status == 2 && run.stderr.contains("no triangles"), "{}", run.stderr);
}
