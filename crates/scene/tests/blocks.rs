//! Every block is read as the format describes it.

mod common;

use std::path::Path;

use common::{OTHERS, SKELETON, clean, messages, read};
use jaspe_scene::description::{
    Caustics, ColorOrTexture, ColorSpec, Filter, Geometry, Gi, GiKind, GlobalPhotons, Lens, LightKind, Mesh, Op,
    PhotonMap, Plane, SettingValue, ShaderKind, Tessellation, TransformKind, VertexData, View,
};
use jaspe_scene::{Dialect, MemoryLoader, Scene, Severity, parse};

#[test]
fn the_skeleton_of_the_format_is_read() {
    let (scene, diagnostics) = read(SKELETON);
    let messages: Vec<&str> = diagnostics.iter().map(|diagnostic| diagnostic.message.as_str()).collect();
    assert!(messages.is_empty(), "{messages:?}");
    assert!(matches!(scene.cameras[0].lens, Lens::Thinlens { sides: 6, fov: 45.0, lensr: 0.1, .. }));
    assert!(matches!(scene.cameras[0].view, View::LookAt { eye: [0.0, -10.0, 3.0], .. }));
    assert!(matches!(scene.shaders[0].kind, ShaderKind::Shiny { reflection: 0.2, .. }));
    assert!(matches!(scene.objects[1].geometry, Geometry::Teapot(Tessellation { subdivs: 8, smooth: true })));
    assert_eq!(scene.objects[1].modifiers[0].value, "bump1");
    let Some(Gi { kind: GiKind::IrradianceCache { global: Some(global), .. }, .. }) = &scene.gi else {
        panic!("a cache")
    };
    assert_eq!(*global, GlobalPhotons { emit: 100_000, map: PhotonMap::Grid, gather: 50, radius: 0.5 });
    assert!(matches!(scene.caustics, Some(Caustics { emit: 100_000, gather: 64, radius: 0.5, .. })));
    let ShaderKind::Diffuse { diffuse: ColorOrTexture::Texture(file) } = &scene.shaders[1].kind else {
        panic!("{:?}", scene.shaders[1]);
    };
    assert_eq!(file.value, "textures/a b.png");
    assert_eq!(scene.objects.len(), 3);
    assert!(!scene.objects[2].visible);
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

#[test]
fn the_other_forms_are_read() {
    let (scene, diagnostics) = read(OTHERS);
    assert_eq!(diagnostics.count(Severity::Error), 0, "{diagnostics:#?}");
    let java = "warning: skipped: the shader is written in Java (`janino`), which cannot be read: a grey stands in";
    assert_eq!(messages(OTHERS), [java]);
    assert_eq!(scene.dialect.map(|dialect| dialect.value), Some(Dialect::Report));
    assert_eq!(scene.image.filter.map(|filter| filter.value), Some(Filter::Gaussian));
    assert!(scene.override_shader.is_none());
    let names: Vec<&str> = scene.shaders.iter().map(|shader| shader.name.value.as_str()).collect();
    assert_eq!(names, ["p", "g", "m", "c", "w", "j"]);
    assert!(matches!(scene.lights[1].kind, LightKind::Point { power: 1.0, .. }));
    assert!(matches!(scene.lights[0].kind, LightKind::Directional { radius: 1.0, intensity: 2.0, .. }));
}

fn shader(text: &str) -> ShaderKind {
    let scene = clean(&format!("shader {{ name a {text} }}"));
    scene.shaders[0].kind.clone()
}

#[test]
fn a_constant_may_leave_out_its_keyword() {
    for text in ["type constant 1 2 3", "type constant color 1 2 3", "type constant { \"sRGB linear\" 1 2 3 }"] {
        let ShaderKind::Constant { color } = shader(text) else { panic!("{text}") };
        assert!(matches!(color, ColorOrTexture::Color(color) if color.linear() == [1.0, 2.0, 3.0]), "{text}");
    }
    let ShaderKind::Constant { color } = shader("type constant texture embers.png") else { panic!("a texture") };
    assert!(matches!(color, ColorOrTexture::Texture(name) if name.value == "embers.png"));
}

#[test]
fn absorption_is_spelled_both_ways() {
    for spelling in ["absorbtion", "absorption"] {
        let text = format!("type glass eta 1.5 color 1 1 1 {spelling}.distance 2 {spelling}.color 1 0 0");
        let ShaderKind::Glass { absorption_distance, absorption_color, .. } = shader(&text) else { panic!("{text}") };
        assert_eq!((absorption_distance, absorption_color.linear()), (2.0, [1.0, 0.0, 0.0]));
    }
    let ShaderKind::Glass { eta, absorption_distance, absorption_color, .. } = shader("type glass eta 1.5 color 1 1 1")
    else {
        panic!("glass")
    };
    assert_eq!((eta, absorption_distance, absorption_color.linear()), (1.5, 0.0, [0.5; 3]));
}

#[test]
fn materials_take_their_declared_parameters() {
    let text =
        "type marble depth 5 diffuse_final { \"sRGB nonlinear\" 1 0.5 0 } noise classic scale 2.5 seed 7 space world";
    let ShaderKind::Procedural { declaration, settings } = shader(text) else { panic!("marble") };
    assert_eq!(declaration.name, "marble");
    let names: Vec<&str> = settings.iter().map(|setting| setting.name).collect();
    assert_eq!(names, ["depth", "diffuse_final", "noise", "scale", "seed", "space"]);
    assert_eq!(settings[0].value, SettingValue::Int(5));
    let SettingValue::Color(color) = &settings[1].value else { panic!("a colour") };
    assert_eq!(color.spec, ColorSpec::SrgbNonlinear([1.0, 0.5, 0.0]));
    assert_eq!(settings[2].value, SettingValue::Choice("classic"));
    assert_eq!(settings[3].value, SettingValue::Float(2.5));
    for declaration in jaspe_texture::Texture::ALL {
        let ShaderKind::Procedural { settings, .. } = shader(&format!("type {}", declaration.name)) else {
            panic!("{}", declaration.name)
        };
        assert!(settings.is_empty(), "a name and a type are enough");
    }
}

#[test]
fn spans_cover_what_was_written() {
    let text = "shader { name a type marble depth 12 } object { shader \"a\" type box }";
    let scene = clean(text);
    let at = |span: jaspe_scene::Span| &text[span.start as usize..span.end as usize];
    assert_eq!(at(scene.shaders[0].span), "shader { name a type marble depth 12 }");
    assert_eq!(at(scene.shaders[0].name.span), "a");
    let ShaderKind::Procedural { settings, .. } = &scene.shaders[0].kind else { panic!("marble") };
    assert_eq!(at(settings[0].span), "depth 12");
    assert_eq!(at(scene.objects[0].span), "object { shader \"a\" type box }");
    assert_eq!(at(scene.objects[0].shaders[0].span), "a");
}

fn object(text: &str) -> Geometry {
    let scene = clean(&format!("object {{ shader a {text} }}"));
    scene.objects[0].geometry.clone()
}

#[test]
fn a_box_is_the_unit_cube_or_lies_between_two_corners() {
    assert!(matches!(object("type box"), Geometry::Box { corners: [[-0.5, -0.5, -0.5], [0.5, 0.5, 0.5]] }));
    let Geometry::Box { corners } = object("type box points 2 1 -1 3 -2 2 -3") else { panic!("a box") };
    assert_eq!(corners, [[-2.0, -1.0, -3.0], [1.0, 2.0, 3.0]]);
}

fn mesh(text: &str) -> Mesh {
    match object(text) {
        Geometry::Mesh(mesh) => mesh,
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_mesh_takes_its_lists_in_any_order() {
    let head = "type generic-mesh";
    let (points, triangles) = ("points 3 0 0 0 1 0 0 0 1 0", "triangles 1 0 1 2");
    let (normals, uvs) = ("normals vertex 0 0 1 0 0 1 0 0 2", "uvs facevarying 0 0 1 0 0 1 face_shaders 0");
    let forwards = mesh(&format!("{head} {points} {triangles} {normals} {uvs}"));
    let backwards = mesh(&format!("{head} {uvs} {normals} {triangles} {points}"));
    for mesh in [forwards, backwards] {
        assert_eq!(mesh.points, [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
        assert_eq!(mesh.triangles, [[0, 1, 2]]);
        assert_eq!(mesh.normals, VertexData::Vertex(vec![[0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [0.0, 0.0, 2.0]]));
        assert_eq!(mesh.uvs, VertexData::FaceVarying(vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]));
        assert_eq!(mesh.face_shaders, Some(vec![0]));
    }
}

#[test]
fn the_old_mesh_is_smooth_and_the_flat_one_is_not() {
    let numbers = "3 1 v 0 0 0 0 0 1 0 0 v 1 0 0 0 0 1 1 0 v 0 1 0 0 0 1 0 1 t 0 1 2";
    let smooth = mesh(&format!("type mesh name m {numbers}"));
    assert_eq!(smooth.normals, VertexData::Vertex(vec![[0.0, 0.0, 1.0]; 3]));
    assert_eq!(smooth.uvs, VertexData::Vertex(vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]));
    assert_eq!(smooth.triangles, [[0, 1, 2]]);
    let flat = mesh(&format!("type flat-mesh name m {numbers}"));
    assert_eq!(flat.normals, VertexData::None);
    assert_eq!(flat.uvs, smooth.uvs);
}

fn transform(text: &str) -> TransformKind {
    let scene = clean(&format!("object {{ shader a transform {text} type sphere }}"));
    scene.objects[0].transform.as_ref().expect("it was written").kind.clone()
}

#[test]
fn transforms_have_four_forms() {
    let ops = transform("{ scaleu 2 rotate 0 0 1 90 translate 1 2 3 }");
    let expected = [Op::ScaleU(2.0), Op::Rotate { axis: [0.0, 0.0, 1.0], angle: 90.0 }, Op::Translate([1.0, 2.0, 3.0])];
    assert_eq!(ops, TransformKind::Ops(expected.to_vec()));
    assert_eq!(transform("{ }"), TransformKind::Ops(Vec::new()));
    let matrix = TransformKind::Matrix([
        [1.0, 2.0, 3.0, 4.0],
        [5.0, 6.0, 7.0, 8.0],
        [9.0, 10.0, 11.0, 12.0],
        [0.0, 0.0, 0.0, 1.0],
    ]);
    assert_eq!(transform("row 1 2 3 4 5 6 7 8 9 10 11 12 0 0 0 1"), matrix);
    assert_eq!(transform("col 1 5 9 0 2 6 10 0 3 7 11 0 4 8 12 1"), matrix);
    let steps = transform("steps 2 times 0 1 { } row 1 2 3 4 5 6 7 8 9 10 11 12 0 0 0 1");
    assert_eq!(steps, TransformKind::Steps { times: [0.0, 1.0], steps: vec![TransformKind::Ops(Vec::new()), matrix] });
}

#[test]
fn a_camera_may_move() {
    let steps = "steps 2 times 0 1 { eye 0 0 5 target 0 0 0 up 0 1 0 } { eye 0 0 6 target 0 0 0 up 0 1 0 }";
    let scene = clean(&format!("camera {{ type pinhole shutter 0 1 {steps} fov 40 aspect 1 }}"));
    let View::Transform(transform) = &scene.cameras[0].view else { panic!("it moves") };
    let TransformKind::Steps { times: [0.0, 1.0], steps } = &transform.kind else { panic!("{transform:?}") };
    let TransformKind::Matrix(matrix) = &steps[1] else { panic!("{steps:?}") };
    assert_eq!(*matrix, [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 6.0], [0.0, 0.0, 0.0, 1.0]]);
    assert_eq!(scene.cameras[0].shutter.map(|shutter| shutter.value), Some([0.0, 1.0]));
}

#[test]
fn options_merge_and_later_values_win() {
    let scene = clean(
        "image { resolution 10 20 aa 0 2 } image { resolution 30 40 } trace-depths { refl 2 } trace-depths { refr 3 }",
    );
    assert_eq!(scene.image.resolution.map(|size| size.value), Some([30, 40]));
    assert_eq!(scene.image.aa.map(|aa| aa.value), Some([0, 2]));
    assert_eq!(scene.trace_depths.diffuse, None);
    assert_eq!(scene.trace_depths.reflection.map(|depth| depth.value), Some(2));
    assert_eq!(scene.trace_depths.refraction.map(|depth| depth.value), Some(3));
}

#[test]
fn instances_of_skipped_objects_are_skipped_with_them() {
    let (scene, diagnostics) = read(
        "object { shader a type janino-tesselatable name pot } instance { name b geometry pot transform { } shader a }
         instance { name c geometry other transform { } shader a }",
    );
    assert_eq!(diagnostics.iter().count(), 1);
    assert_eq!(scene.instances.len(), 1, "what was never declared is left to the renderer");
}

#[test]
fn unknown_blocks_do_not_disturb_their_neighbours() {
    let (scene, diagnostics) = read("wibble { { a b } shader x } object { shader a type box } } gi { type none }");
    assert_eq!(scene.objects.len(), 1);
    assert_eq!(diagnostics.count(Severity::Error), 0);
    assert_eq!(
        messages("wibble wobble { x } light { type sunskz }"),
        ["warning: skipped: unknown keyword `wibble`", "error: unknown light type `sunskz`"]
    );
}

#[test]
fn text_that_is_not_utf8_is_latin1() {
    let (scene, diagnostics) =
        parse(Path::new("a.sc"), *b"shader { name caf\xe9 type constant 1 1 1 }", &MemoryLoader::default());
    assert!(diagnostics.is_empty());
    assert_eq!(scene.shaders[0].name.value, "café");
    assert_eq!(clean("shader { name \"caf\u{e9} noir\" type constant 1 1 1 }").shaders[0].name.value, "café noir");
}

#[test]
fn includes_are_looked_for_beside_every_file_and_on_the_include_path() {
    let object = |name: &str| format!("object {{ shader a type sphere name {name} c 0 0 0 r 1 }}").into_bytes();
    let loader = MemoryLoader::default()
        .with("scenes/sub/one.sc", [b"include two.sc include three.sc ".to_vec(), object("one")].concat())
        .with("scenes/sub/two.sc", object("two"))
        .with("scenes/three.sc", object("three"))
        .with("scenes/parts/four.sc", object("four"))
        .with("/abs/five.sc", object("five"));
    let text = "include \"//sub/one.sc\" includepath parts include four.sc include /abs/five.sc texturepath pictures";
    let (scene, diagnostics) = parse(Path::new("scenes/main.sc"), text.as_bytes(), &loader);
    assert!(diagnostics.is_empty(), "{diagnostics:#?}");
    let names = |scene: &Scene| scene.objects.iter().map(|o| o.name.clone().unwrap().value).collect::<Vec<_>>();
    assert_eq!(names(&scene), ["two", "three", "one", "four", "five"]);
    let folders: Vec<_> = scene.texture_folders.iter().map(|folder| folder.to_str().unwrap()).collect();
    assert_eq!(folders, ["scenes", "scenes/sub", "scenes/parts", "/abs", "scenes/pictures"]);
}

#[test]
fn an_error_in_an_included_file_does_not_end_the_including_one() {
    let loader = MemoryLoader::default().with("bad.sc", *b"object { shader a type sphere c 0 0");
    let (scene, diagnostics) = parse(Path::new("main.sc"), *b"include bad.sc object { shader a type box }", &loader);
    assert_eq!(diagnostics.count(Severity::Error), 1);
    assert_eq!(diagnostics.iter().next().and_then(|diagnostic| diagnostic.span).map(|span| span.file), Some(1));
    assert!(scene.objects.iter().any(|object| matches!(object.geometry, Geometry::Box { .. })));
}
