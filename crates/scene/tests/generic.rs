//! The generic forms of a scene, `.sca` and `.scb`, give the same description as `.sc`.

mod common;

use std::path::Path;

use jaspe_scene::description::{
    ColorOrTexture, Geometry, GiKind, GlobalPhotons, Lens, LightKind, ModifierKind, PhotonMap, ShaderKind,
    TransformKind, VertexData, View,
};
use jaspe_scene::{Diagnostics, MemoryLoader, Scene, parse};

const TEXT: &str = r#"% a scene of calls
param resolutionX int 320 param resolutionY int 200
p aa.min int 0 p aa.max int 2 p filter string mitchell
p gi.engine string irr-cache p gi.irr-cache.samples int 64 p gi.irr-cache.gmap string kd
p caustics string kd p caustics.emit int 5000 p depths.diffuse int 3
options ::options
param fov float 45 param aspect float 1.5 param transform matrix row 1 0 0 0  0 1 0 0  0 0 1 5  0 0 0 1
camera eye pinhole
param diffuse color "sRGB nonlinear" 0.5 0.5 0.5
shader gray diffuse
param texture string "a b.png" param shiny float 0.25
shd shine textured_shiny_diffuse
param texture string bumps.png param scale float 0.5
modifier bumps bump_map
param triangles int[] 3 0 1 2
param points point[] vertex 3 0 0 0  1 0 0  0 1 0
param normals vector[] vertex 3 0 0 1  0 0 1  0 0 1
param uvs texcoord[] facevarying 3 0 0  1 0  0 1
geometry tri triangle_mesh
param transform.steps int 2 param transform.times float[] none 2 0 1
param transform[0] matrix { translate 0 0 1 } param transform[1] matrix { }
param shaders string[] 2 gray shine param modifiers string[] 1 bumps
instance one tri
param power color "sRGB linear" 10 20 30 param center point 1 2 3
light lamp point
param radiusInner float 0.5
g ring torus
"#;

fn read(name: &str, bytes: &[u8]) -> (Scene, Diagnostics) {
    parse(Path::new(name), bytes, &MemoryLoader::default())
}

fn check(scene: &Scene) {
    assert_eq!(scene.image.resolution.map(|size| size.value), Some([320, 200]));
    let Lens::Pinhole { fov: 45.0, aspect: 1.5, .. } = scene.cameras[0].lens else { panic!("a pinhole") };
    let View::Transform(transform) = &scene.cameras[0].view else { panic!("by a matrix") };
    assert!(matches!(&transform.kind, TransformKind::Matrix(rows) if rows[2][3] == 5.0));
    let Geometry::Mesh(mesh) = &scene.objects[0].geometry else { panic!("a mesh") };
    assert_eq!((mesh.points.len(), mesh.triangles.as_slice()), (3, &[[0, 1, 2]][..]));
    assert!(matches!(&mesh.normals, VertexData::Vertex(normals) if normals[2] == [0.0, 0.0, 1.0]));
    assert!(!scene.objects[0].visible && scene.objects[0].name.as_ref().is_some_and(|name| name.value == "tri"));
    assert_eq!(scene.instances[0].geometry.value, "tri");
    assert_eq!(scene.instances[0].shaders[0].value, "gray");
}

#[test]
fn the_text_form_is_read() {
    let (scene, diagnostics) = read("a.sca", TEXT.as_bytes());
    assert!(diagnostics.is_empty(), "{diagnostics:#?}");
    check(&scene);
    assert_eq!(scene.image.aa.map(|aa| aa.value), Some([0, 2]));
    let Some(GiKind::IrradianceCache { samples: 64, global: Some(global), .. }) = scene.gi.map(|gi| gi.kind) else {
        panic!("a cache")
    };
    assert_eq!(global, GlobalPhotons { emit: 100_000, map: PhotonMap::Kd, gather: 50, radius: 0.5 });
    assert_eq!(scene.caustics.map(|caustics| caustics.emit), Some(5000));
    assert_eq!(scene.trace_depths.diffuse.map(|depth| depth.value), Some(3));
    let ShaderKind::Shiny { diffuse: ColorOrTexture::Texture(file), reflection: 0.25 } = &scene.shaders[1].kind else {
        panic!("shiny")
    };
    assert_eq!(file.value, "a b.png");
    assert!(matches!(scene.modifiers[0].kind, ModifierKind::Bump { scale: 0.5, .. }));
    let transform = scene.instances[0].transform.as_ref().expect("it moves");
    assert!(matches!(&transform.kind, TransformKind::Steps { times: [0.0, 1.0], steps } if steps.len() == 2));
    assert_eq!(scene.instances[0].modifiers[0].value, "bumps");
    let LightKind::Point { color, position: [1.0, 2.0, 3.0], .. } = &scene.lights[0].kind else { panic!("a point") };
    assert_eq!(color.linear(), [10.0, 20.0, 30.0]);
    assert!(matches!(scene.objects[1].geometry, Geometry::Torus { tube: 0.5, ring: 1.0 }));
}

/// Writes the binary form.
#[derive(Default)]
struct Bytes(Vec<u8>);

impl Bytes {
    fn word(&mut self, word: &str) -> &mut Self {
        self.int(word.len() as i32);
        self.0.extend(word.as_bytes());
        self
    }

    fn int(&mut self, value: i32) -> &mut Self {
        self.0.extend(value.to_le_bytes());
        self
    }

    fn floats(&mut self, values: &[f32]) -> &mut Self {
        self.0.extend(values.iter().flat_map(|value| value.to_le_bytes()));
        self
    }

    fn tag(&mut self, bytes: &[u8]) -> &mut Self {
        self.0.extend(bytes);
        self
    }

    fn parameter(&mut self, name: &str, kind: u8, is_list: bool) -> &mut Self {
        self.tag(b"p").word(name).tag(&[b't', kind, u8::from(is_list)])
    }

    fn declare(&mut self, kind: u8, name: &str, class: &str) -> &mut Self {
        self.tag(&[kind]).word(name).word(class)
    }
}

fn binary() -> Vec<u8> {
    let mut bytes = Bytes::default();
    bytes.parameter("resolutionX", b'i', false).int(320).parameter("resolutionY", b'i', false).int(200);
    bytes.tag(b"o").word("::options");
    bytes.parameter("fov", b'f', false).floats(&[45.0]).parameter("aspect", b'f', false).floats(&[1.5]);
    let matrix = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 5.0, 0.0, 0.0, 0.0, 1.0];
    bytes.parameter("transform", b'm', false).floats(&matrix).declare(b'c', "eye", "pinhole");
    bytes.parameter("diffuse", b'c', false).floats(&[0.5, 0.5, 0.5]).declare(b's', "gray", "diffuse");
    bytes.parameter("triangles", b'i', true).int(3).int(0).int(1).int(2);
    bytes.parameter("points", b'p', true).tag(b"v").int(3).floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
    bytes.parameter("normals", b'v', true).tag(b"v").int(3).floats(&[0.0, 0.0, 1.0].repeat(3));
    bytes.declare(b'g', "tri", "triangle_mesh");
    bytes.parameter("shaders", b's', true).int(1).word("gray").declare(b'i', "one", "tri");
    bytes.0
}

#[test]
fn the_binary_form_is_read() {
    let (scene, diagnostics) = read("a.scb", &binary());
    assert!(diagnostics.is_empty(), "{diagnostics:#?}");
    check(&scene);
}

#[test]
fn either_form_may_be_included() {
    let loader = MemoryLoader::default().with("a.sca", TEXT.as_bytes()).with("b.scb", binary());
    let (scene, diagnostics) = parse(Path::new("main.sc"), *b"include a.sca", &loader);
    assert!(diagnostics.is_empty(), "{diagnostics:#?}");
    check(&scene);
    let (scene, _) = parse(Path::new("main.sca"), *b"include b.scb g ball sphere", &loader);
    check(&scene);
    assert_eq!(scene.objects.len(), 2);
}

#[test]
fn mistakes_have_a_place() {
    let messages = |text: &str| -> Vec<String> {
        read("a.sca", text.as_bytes()).1.iter().map(|diagnostic| diagnostic.message.clone()).collect()
    };
    assert_eq!(messages("parm a int 1"), ["unknown statement `parm`"]);
    assert_eq!(messages("param a flaot 1 shader s diffuse"), ["unknown type of value `flaot`"]);
    assert_eq!(messages("param radius float 1 shader s diffuse"), ["nothing takes the parameter `radius` here"]);
    assert_eq!(messages("shader s difuse"), ["skipped: unknown type `difuse`"]);
    assert_eq!(
        messages("param points point[] vertex 2000000000 0 0 0")[0],
        "`parameter` needs 6000000000 numbers, found 3"
    );
    let bad = "param points point[] vertex 1 0 0 0 param triangles int[] 3 0 0 1 g m triangle_mesh";
    assert_eq!(messages(bad), ["`m` lacks parameters, or they do not fit each other"]);
}

#[test]
fn cut_and_spoilt_files_are_survived() {
    let bytes = binary();
    for end in 0..bytes.len() {
        read("a.scb", &bytes[..end]);
        let mut spoilt = bytes.clone();
        spoilt[end] ^= 0x81;
        read("a.scb", &spoilt);
    }
    assert!(read("a.scb", &bytes[..bytes.len() - 1]).1.has_errors());
    for end in (0..TEXT.len()).filter(|end| TEXT.is_char_boundary(*end)) {
        read("a.sca", &TEXT.as_bytes()[..end]);
        let mut spoilt = TEXT.as_bytes().to_vec();
        spoilt[end] ^= 0x11;
        read("a.sca", &spoilt);
    }
}
