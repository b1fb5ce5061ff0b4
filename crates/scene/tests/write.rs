//! What is written reads as the same scene.

mod common;

use std::fs;
use std::path::Path;

use common::{OTHERS, REST, SKELETON, clean, scenes};
use jaspe_scene::description::{Color, ColorOrTexture, Op, ShaderKind, Transform, TransformKind, View};
use jaspe_scene::{DiskLoader, Includes, Loader, MemoryLoader, Scene, parse, write};

fn text(scene: &Scene, includes: Includes, folder: &Path) -> String {
    let mut bytes = Vec::new();
    write(scene, includes, folder, &mut bytes).expect("memory has room");
    String::from_utf8(bytes).expect("it is text")
}

/// All that a scene says, without the places where it says it.
fn said(scene: &Scene) -> String {
    let mut scene = scene.clone();
    let cameras = scene.cameras.iter_mut().filter_map(|camera| match &mut camera.view {
        View::Transform(transform) => Some(transform),
        _ => None,
    });
    let objects = scene.objects.iter_mut().filter_map(|object| object.transform.as_mut());
    let instances = scene.instances.iter_mut().filter_map(|instance| instance.transform.as_mut());
    cameras.chain(objects).chain(instances).for_each(|transform: &mut Transform| plain(&mut transform.kind));
    // What is not seen has no use for shaders, and Sunflow no place.
    for object in scene.objects.iter_mut().filter(|object| !object.visible) {
        (object.shaders, object.modifiers, object.transform) = Default::default();
    }
    // What stands in for a shader that could not be read is written.
    for shader in &mut scene.shaders {
        if let ShaderKind::Unsupported = shader.kind {
            shader.kind =
                ShaderKind::Diffuse { diffuse: ColorOrTexture::Color(Color::new_linear([0.5; 3], shader.span)) };
        }
    }
    let Scene { dialect, image, background, trace_depths, gi, caustics, cameras, lights, shaders, .. } = &scene;
    let Scene { textures, modifiers, objects, instances, override_shader, override_photons, .. } = &scene;
    let options = format!("{dialect:?} {image:?} {background:?} {trace_depths:?} {gi:?} {caustics:?}");
    let things = format!("{cameras:?} {lights:?} {shaders:?} {textures:?} {modifiers:?} {objects:?} {instances:?}");
    without_places(&format!("{options} {things} {override_shader:?} {override_photons}"))
}

/// Scales along one axis are written as scales.
fn plain(kind: &mut TransformKind) {
    match kind {
        TransformKind::Ops(ops) => {
            for op in ops {
                *op = match *op {
                    Op::ScaleX(factor) => Op::Scale([factor, 1.0, 1.0]),
                    Op::ScaleY(factor) => Op::Scale([1.0, factor, 1.0]),
                    Op::ScaleZ(factor) => Op::Scale([1.0, 1.0, factor]),
                    other => other,
                };
            }
        }
        TransformKind::Matrix(_) => {}
        TransformKind::Steps { steps, .. } => steps.iter_mut().for_each(plain),
    }
}

fn without_places(text: &str) -> String {
    let mut parts = text.split("Span { file: ");
    let mut kept = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        kept += part.split_once(" }").map_or("", |(_, rest)| rest);
    }
    kept
}

#[track_caller]
fn survives(what: &str, scene: &Scene, folder: &Path, loader: &dyn Loader) {
    let written = text(scene, Includes::Inline, folder);
    let (again, diagnostics) = parse(&folder.join("written.sc"), written.as_bytes(), loader);
    // Names that are declared twice stay so.
    let remark = diagnostics.iter().find(|diagnostic| !diagnostic.message.starts_with("there is already"));
    assert!(remark.is_none(), "{what}: {remark:#?}");
    let (before, after) = (said(scene), said(&again));
    if before != after {
        let at = before.bytes().zip(after.bytes()).take_while(|(a, b)| a == b).count();
        let around = |text: &str| {
            let text: Vec<char> = text.chars().collect();
            text[at.saturating_sub(200).min(text.len())..(at + 200).min(text.len())].iter().collect::<String>()
        };
        panic!("{what} became another scene:\n{}\n{}", around(&before), around(&after));
    }
}

#[test]
fn every_block_is_written_as_it_was_read() {
    for text in [SKELETON, OTHERS, REST] {
        let (scene, _) = common::read(text);
        survives("a scene of everything", &scene, Path::new(""), &MemoryLoader::default());
    }
    survives("nothing", &clean("image { }"), Path::new(""), &MemoryLoader::default());
}

#[test]
fn scenes_that_people_have_made_are_written_as_they_were_read() {
    let mut count = 0;
    for folder in ["scenes", "tests/scenes", "../shared/scenes"] {
        for path in scenes(folder) {
            let (scene, diagnostics) = jaspe_scene::read(&path, &DiskLoader);
            assert!(!diagnostics.has_errors(), "{}", path.display());
            survives(&path.display().to_string(), &scene, path.parent().expect("a folder"), &DiskLoader);
            count += 1;
        }
    }
    assert!(count > 30, "only {count} scenes");
}

#[test]
fn includes_may_be_kept() {
    let loader = MemoryLoader::default()
        .with("s/part.sc", *b"image { resolution 10 20 aa 1 2 } shader { name b type mirror refl 1 1 1 }")
        .with("s/main.sc", *b"image { resolution 30 40 } shader { name a type constant 1 1 1 } include part.sc image { contrast 0.5 } trace-depths { diff 3 }");
    let (scene, _) = jaspe_scene::read(Path::new("s/main.sc"), &loader);
    let kept = text(&scene, Includes::Keep, Path::new("s"));
    assert_eq!(
        kept,
        "shader { name a type constant color 1 1 1 }\ninclude part.sc\nimage { contrast 0.5 }\ntrace-depths { diff 3 }\n"
    );
    let (again, _) = parse(Path::new("s/main.sc"), kept.as_bytes(), &loader);
    assert_eq!(said(&again), said(&scene));
    let inlined = text(&scene, Includes::Inline, Path::new("s"));
    assert_eq!(
        inlined,
        "shader { name a type constant color 1 1 1 }\nshader { name b type mirror refl 1 1 1 }\n\
         image { resolution 10 20 aa 1 2 contrast 0.5 }\ntrace-depths { diff 3 }\n"
    );
    // From elsewhere, the folder has to be named.
    let elsewhere = text(&scene, Includes::Keep, Path::new("out"));
    assert!(elsewhere.starts_with("includepath ../s\n"), "{elsewhere}");
}

#[test]
fn folders_of_textures_are_named() {
    let scene = common::clean("shader { name a type diffuse texture b.png }");
    let written = text(&scene, Includes::Inline, Path::new("out"));
    assert!(written.starts_with("texturepath ..\n"), "{written}");
    let (again, _) = parse(Path::new("out/a.sc"), written.as_bytes(), &MemoryLoader::default());
    assert!(again.texture_folders.iter().any(|folder| folder == Path::new("out/..")));
}

#[test]
fn the_text_is_laid_out_in_lines() {
    let scene = clean(
        "object { shader a type generic-mesh points 3 0 0 0 1 0 0 0 1 0 triangles 1 0 1 2 normals none uvs none }
         shader { name \"a b\" type phong texture \"a b.png\" spec { \"sRGB nonlinear\" 1 1 1 } 50 }",
    );
    let written = text(&scene, Includes::Inline, Path::new(""));
    assert_eq!(
        written,
        "object {\n   shader a\n   type generic-mesh\n   points 3\n      0 0 0\n      1 0 0\n      0 1 0\n   triangles 1\n      0 1 2\n   \
         normals none\n   uvs none\n}\nshader { name \"a b\" type phong texture \"a b.png\" spec { \"sRGB nonlinear\" 1 1 1 } 50 samples 4 }\n"
    );
}

#[test]
fn large_scenes_are_written_too() {
    for path in scenes("../shared/scenes/sunflow") {
        let size = fs::metadata(&path).expect("it exists").len();
        if size > 1_000_000 {
            let (scene, _) = jaspe_scene::read(&path, &DiskLoader);
            let written = text(&scene, Includes::Inline, path.parent().expect("a folder"));
            assert!((written.len() as u64) < 2 * size, "{} grew from {size} to {}", path.display(), written.len());
        }
    }
}
