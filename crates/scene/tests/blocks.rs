//! Every block is read as the format describes it.

use std::path::Path;

use jaspe_scene::description::{ColorOrTexture, Geometry, Lens, LightKind, Plane, ShaderKind, View};
use jaspe_scene::{Diagnostics, MemoryLoader, Scene, Severity, parse};

fn read(text: &str) -> (Scene, Diagnostics) {
    parse(Path::new("test.sc"), text.as_bytes(), &MemoryLoader::default())
}

/// The scene of a text that gives rise to no remark at all.
#[track_caller]
fn clean(text: &str) -> Scene {
    let (scene, diagnostics) = read(text);
    assert!(diagnostics.is_empty(), "{diagnostics:#?}");
    scene
}

/// Format reference, §2.14: a line of everything, in the order that Sunflow requires.
const SKELETON: &str = r#"
% comment
image { resolution 640 480 aa 0 2 samples 1 contrast 0.1 filter mitchell jitter false }
trace-depths { diff 1 refl 4 refr 4 }
background { color { "sRGB nonlinear" 0.2 0.3 0.5 } }
gi { type irr-cache samples 256 tolerance 0.05 spacing 0.05 5.0 global 100000 grid 50 0.5 }
photons { caustics 100000 kd 64 0.5 }
camera { type thinlens shutter 0 1 eye 0 -10 3 target 0 0 1 up 0 0 1 fov 45 aspect 1.333 shift 0 0 fdist 10 lensr 0.1 sides 6 rotation 15 }
shader { name "red" type shiny diff { "sRGB nonlinear" 0.8 0.1 0.1 } refl 0.2 }
shader { name tex type diffuse texture "textures/a b.png" }
modifier { name bump1 type bump texture textures/b.png scale 0.02 }
object { shader "red" type sphere name ball c 0 0 1 r 1 }
object { shader tex modifier bump1 transform { scaleu 0.02 rotatez 45 translate 3 0 0 } type teapot name pot subdivs 8 smooth true }
object { noinstance type generic-mesh name tri points 3 0 0 0 1 0 0 0 1 0 triangles 1 0 1 2 normals none uvs vertex 0 0 1 0 0 1 }
instance { name t1 geometry tri transform steps 2 times 0 1 { translate 0 0 0 } { translate 0 0 1 } shaders 1 tex }
light { type point color 1 1 1 power 500 p 5 -5 8 }
"#;

#[test]
fn the_skeleton_of_the_format_is_read() {
    let (scene, diagnostics) = read(SKELETON);
    let messages: Vec<&str> = diagnostics.iter().map(|diagnostic| diagnostic.message.as_str()).collect();
    let skipped = ["`gi`", "`photons`", "shader type `shiny`", "`modifier`", "object type `teapot`"];
    assert_eq!(messages, skipped.map(|what| format!("skipped: {what} is not supported yet")));
    assert_eq!(diagnostics.count(Severity::Warning), skipped.len());
    assert!(matches!(scene.cameras[0].lens, Lens::Thinlens { sides: 6, fov: 45.0, lensr: 0.1, .. }));
    assert!(matches!(scene.cameras[0].view, View::LookAt { eye: [0.0, -10.0, 3.0], .. }));
    assert!(matches!(scene.shaders[0].kind, ShaderKind::Unsupported));
    let ShaderKind::Diffuse { diffuse: ColorOrTexture::Texture(file) } = &scene.shaders[1].kind else {
        panic!("{:?}", scene.shaders[1]);
    };
    assert_eq!(file.value, "textures/a b.png");
    assert_eq!(scene.objects.len(), 2);
    assert!(!scene.objects[1].visible);
    assert_eq!(scene.instances.len(), 1);
    assert!(matches!(scene.lights[0].kind, LightKind::Point { power: 500.0, position: [5.0, -5.0, 8.0], .. }));
}

#[test]
fn keywords_come_in_any_order() {
    let scene = clean("camera { fov 40 up 0 1 0 aspect 2 target 0 0 0 eye 0 0 5 type pinhole }");
    assert!(matches!(scene.cameras[0].lens, Lens::Pinhole { fov: 40.0, aspect: 2.0, shift: [0.0, 0.0] }));
    let scene = clean("shader { spec 1 1 1 50 diff 1 0 0 type phong name a samples 2 }");
    assert!(matches!(scene.shaders[0].kind, ShaderKind::Phong { power: 50.0, samples: 2, .. }));
}

#[test]
fn planes_have_two_forms() {
    let scene =
        clean("object { shader s type plane p 0 0 1 n 0 0 2 } object { shader s type plane p 0 0 0 p 1 0 0 p 0 1 0 }");
    let planes: Vec<_> = scene.objects.iter().map(|object| &object.geometry).collect();
    assert!(matches!(planes[0], Geometry::Plane(Plane::Normal { point: [0.0, 0.0, 1.0], normal: [0.0, 0.0, 2.0] })));
    assert!(matches!(planes[1], Geometry::Plane(Plane::Points([_, [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]))));
}
