//! No scene, however odd, makes compiling or rendering panic, hang or fill the memory.

use std::path::{Path, PathBuf};

use jaspe_render::{CompileOptions, Look, RenderOptions, compile, render};
use jaspe_scene::{Dialect, DiskLoader, MemoryLoader, parse};

/// Compiles and renders a few pixels in both dialects; returns how often there was a picture.
fn try_everything(path: &Path, text: &str) -> usize {
    let mut rendered = 0;
    for dialect in [Dialect::Sunflow, Dialect::Report] {
        for look in [None, Some(Look::AmbientOcclusion)] {
            let (scene, diagnostics) = parse(path, text.as_bytes(), &DiskLoader);
            if diagnostics.has_errors() {
                continue;
            }
            let options = CompileOptions {
                dialect: Some(dialect),
                resolution: Some([6, 5]),
                aa: Some([0, 1]),
                samples: None,
                look,
            };
            let Some(compiled) = compile(&scene, &DiskLoader, &options).scene else { continue };
            let (film, _) = render(&compiled, &RenderOptions { threads: Some(1), ..RenderOptions::default() }, &())
                .expect("nobody cancels");
            assert_eq!(film.pixels.len(), 30);
            assert!(film.pixels.iter().flatten().all(|value| !value.is_nan()), "NaN in a picture of\n{text}");
            rendered += 1;
        }
    }
    rendered
}

/// A small generator, so that every run sees the same scenes.
struct Random(u64);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) % n as u64) as usize
    }
}

const SCENE: &str = "
image { resolution 64 48 aa 0 1 samples 1 contrast 0.1 filter mitchell }
trace-depths { diff 1 refl 2 refr 2 }
background { color 0.1 0.2 0.3 }
camera { type thinlens eye 0 0 9 target 0 0 0 up 0 1 0 fov 50 aspect 1.3 fdist 9 lensr 0.1 }
light { type point color 1 1 1 power 300 p 3 5 8 }
light { type directional source 0 9 0 target 0 0 0 radius 3 emit 1 1 1 intensity 1 }
shader { name a type marble depth 5 scale 1 }
shader { name b type phong diff 0.5 0.5 0.5 spec 0.3 0.3 0.3 20 samples 2 }
shader { name c type glass eta 1.5 color 1 1 1 absorption.distance 2 absorption.color 0.5 0.6 0.7 }
shader { name d type mirror refl 0.8 0.8 0.8 }
shader { name e type water space uv depth 3 }
object { shader a type sphere c 0 0 0 r 1 }
object { shader c transform { scale 1 2 0.5 rotate 1 1 0 30 translate 2 0 1 } type sphere name ball }
object { shader d type plane p 0 -2 0 n 0 1 0 }
object { shader b type plane p 0 0 -4 p 1 0 -4 p 0 1 -4 }
object { shader e type generic-mesh name tri points 3 -2 0 1 -1 0 1 -1.5 1 1 triangles 1 0 1 2
    normals vertex 0 0 1 0 0 1 0 0 1 uvs vertex 0 0 1 0 0 1 }
instance { name t geometry tri transform { translate 0 1 0 } shader a }
object { shader b transform { rotatey 30 translate 2 -1 0 } type box }
";

#[test]
fn the_scene_that_is_mutated_renders() {
    assert_eq!(try_everything(Path::new("robust.sc"), SCENE), 4);
}

#[test]
fn extreme_numbers_never_break_a_picture() {
    let numbers = [
        "0",
        "-1",
        "1",
        "1e-30",
        "1e-6",
        "1e6",
        "1e18",
        "1e30",
        "3e38",
        "-3e38",
        "89.999",
        "90",
        "180",
        "360",
        "-0",
        "1e-45",
        "255",
        "2147483647",
        "-2147483648",
    ];
    let words: Vec<&str> = SCENE.split(' ').collect();
    let places: Vec<usize> = (0..words.len()).filter(|&i| words[i].trim().parse::<f32>().is_ok()).collect();
    let mut random = Random(7);
    let mut rendered = 0;
    for round in 0..400 {
        let mut mutant: Vec<String> = words.iter().map(|word| word.to_string()).collect();
        for _ in 0..1 + round % 3 {
            mutant[places[random.below(places.len())]] = numbers[random.below(numbers.len())].to_owned();
        }
        rendered += try_everything(Path::new("robust.sc"), &mutant.join(" "));
    }
    assert!(rendered > 400, "only {rendered} pictures: the mutations break too much to tell anything");
}

#[test]
fn scenes_at_any_scale_look_alike() {
    // A sphere over a floor, from a millimetre to a million: the same picture, without specks of self-shadowing.
    let scene = |s: f32| {
        let text = format!(
            "image {{ resolution 40 30 aa 0 0 }}
             camera {{ type pinhole eye 0 {} {} target 0 {} 0 up 0 1 0 fov 40 aspect 1.333 }}
             light {{ type point color 1 1 1 power {} p {} {} {} }}
             shader {{ name w type diffuse diff 0.8 0.8 0.8 }}
             object {{ shader w type sphere c 0 {} 0 r {} }}
             object {{ shader w type plane p 0 0 0 n 0 1 0 }}",
            2.0 * s,
            6.0 * s,
            0.8 * s,
            400.0 * s * s,
            3.0 * s,
            5.0 * s,
            4.0 * s,
            s,
            s
        );
        let (scene, diagnostics) = parse(Path::new("scale.sc"), text.as_bytes(), &DiskLoader);
        assert!(!diagnostics.has_errors(), "{diagnostics:?}");
        let compiled = compile(&scene, &DiskLoader, &CompileOptions::default()).scene.expect("compiles");
        render(&compiled, &RenderOptions::default(), &()).expect("nobody cancels").0
    };
    let reference = scene(1.0);
    for s in [1e-3, 1e-2, 10.0, 1e3, 1e6] {
        let film = scene(s);
        let apart = film
            .pixels
            .iter()
            .zip(&reference.pixels)
            .filter(|(a, b)| a.iter().zip(b.iter()).any(|(a, b)| (a - b).abs() > 0.02))
            .count();
        assert!(apart <= 6, "at scale {s}, {apart} of {} pixels differ", film.pixels.len());
    }
}

#[test]
fn broken_real_scenes_never_panic() {
    // Scenes of the project, and others where they are at hand, with words swapped, dropped and doubled.
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut files: Vec<PathBuf> = Vec::new();
    for folder in ["scenes", "scenes/figures", "../shared/scenes/original", "../shared/scenes/original/procedural"] {
        let entries = std::fs::read_dir(root.join(folder)).into_iter().flatten().flatten();
        files.extend(entries.map(|entry| entry.path()).filter(|path| {
            path.extension().is_some_and(|e| e == "sc") && path.metadata().is_ok_and(|m| m.len() < 20_000)
        }));
    }
    files.sort();
    assert!(files.len() >= 10, "found only {files:?}");
    let mut random = Random(11);
    for path in &files {
        let text = std::fs::read_to_string(path).expect("the project's scenes are text");
        let words: Vec<&str> = text.split(' ').collect();
        for _ in 0..8 {
            let mut mutant = words.clone();
            for _ in 0..3 {
                let (i, j) = (random.below(mutant.len()), random.below(mutant.len()));
                match random.below(3) {
                    0 => mutant.swap(i, j),
                    1 => mutant[i] = "",
                    _ => mutant[i] = mutant[j],
                }
            }
            try_everything(path, &mutant.join(" "));
        }
    }
}

#[test]
fn absurd_numbers_of_samples_and_photons_are_bounded() {
    let most = 4_000_000_000u32;
    let scene = |rest: &str| {
        format!(
            "image {{ resolution 2 2 aa 0 0 }} trace-depths {{ diff 1 refl 1 refr 1 }}
             camera {{ type pinhole eye 0 0 5 target 0 0 0 up 0 1 0 fov 40 aspect 1 }}
             object {{ shader s type sphere c 0 0 0 r 2 }} {rest}"
        )
    };
    let matte = "shader { name s type diffuse diff 0.5 0.5 0.5 }";
    let lamp = "light { type point color 1 1 1 power 100 p 0 0 9 }";
    for rest in [
        format!("{matte} light {{ type spherical color 1 1 1 radiance 10 center 3 0 3 radius 1 samples {most} }}"),
        format!("{matte} {lamp} gi {{ type path samples {most} }}"),
        format!("{matte} {lamp} gi {{ type ambocc bright 1 1 1 dark 0 0 0 samples {most} maxdist 3 }}"),
        format!("shader {{ name s type amb-occ bright 1 1 1 dark 0 0 0 samples {most} dist 1 }}"),
        format!("{lamp} shader {{ name s type phong diff 1 1 1 spec 1 1 1 20 samples {most} }}"),
        format!("{matte} {lamp} gi {{ type igi samples 9 sets {most} b 0.1 bias-samples 0 }}"),
    ] {
        let text = scene(&rest);
        let loader = MemoryLoader::default();
        let (scene, _) = parse(Path::new("absurd.sc"), text.as_bytes(), &loader);
        if let Some(scene) = compile(&scene, &loader, &CompileOptions::default()).scene {
            render(&scene, &RenderOptions::default(), &()).expect("not cancelled");
        }
    }
}
