//! The blocks of light, shading and shape beyond the simplest are read as the format describes them.

mod common;

use common::{REST, clean, messages};
use jaspe_scene::description::{
    BezierNet, Blend, ByteOrder, ColorOrTexture, CornellBox, Geometry, GiKind, Ground, Hair, Lens, LightKind,
    ModifierKind, PointSource, Sampler, ShaderKind, Tessellation, Triangles,
};

fn gi(text: &str) -> GiKind {
    clean(&format!("gi {{ {text} }}")).gi.expect("there is one").kind
}

fn light(text: &str) -> LightKind {
    clean(&format!("light {{ {text} }}")).lights[0].kind.clone()
}

fn shader(text: &str) -> ShaderKind {
    clean(&format!("shader {{ name a {text} }}")).shaders[0].kind.clone()
}

fn object(text: &str) -> Geometry {
    clean(&format!("object {{ shader a {text} }}")).objects[0].geometry.clone()
}

#[test]
fn every_block_is_read_without_remark() {
    let scene = clean(REST);
    assert_eq!((scene.lights.len(), scene.shaders.len(), scene.modifiers.len()), (6, 9, 3));
    assert_eq!((scene.textures.len(), scene.objects.len(), scene.instances.len()), (1, 11, 1));
    assert_eq!(scene.image.sampler.map(|sampler| sampler.value), Some(Sampler::Multipass));
    assert_eq!(scene.image.cache.map(|cache| cache.value), Some(true));
    assert_eq!(scene.image.bucket.map(|size| size.value), Some(64));
    let depths = [scene.trace_depths.diffuse, scene.trace_depths.reflection, scene.trace_depths.refraction];
    assert_eq!(depths.map(|depth| depth.map(|depth| depth.value)), [Some(1), Some(3), Some(0)]);
    assert_eq!(scene.caustics.map(|caustics| (caustics.emit, caustics.gather, caustics.radius)), Some((1000, 50, 0.5)));
    assert!(matches!(scene.gi.expect("the last one").kind, GiKind::Path { samples: 16 }));
    assert!(matches!(scene.cameras[0].lens, Lens::Fisheye));
    assert!(matches!(scene.cameras[1].lens, Lens::Pinhole { shift: [0.5, 0.0], .. }));
    let modifiers =
        |names: &[jaspe_scene::description::Name]| names.iter().map(|n| n.value.clone()).collect::<Vec<_>>();
    assert_eq!(modifiers(&scene.objects[0].modifiers), ["b", "None"]);
    assert_eq!(modifiers(&scene.instances[0].modifiers), ["q"]);
}

#[test]
fn indirect_light_has_five_methods_and_none() {
    let GiKind::IrradianceCache { samples: 256, tolerance: 0.05, spacing: [0.1, 5.0], global: None } =
        gi("type irr-cache samples 256 tolerance 0.05 spacing 0.1 5")
    else {
        panic!("irr-cache")
    };
    for word in ["b", "c"] {
        let text = format!("type igi samples 64 sets 2 {word} 0.5 bias-samples 3");
        assert!(matches!(gi(&text), GiKind::Instant { samples: 64, sets: 2, bias: 0.5, bias_samples: 3 }));
    }
    let GiKind::AmbientOcclusion { bright, dark, samples: 8, max_distance: 0.0 } =
        gi("type ambocc bright 1 1 1 dark 0 0 0.5 samples 8")
    else {
        panic!("ambocc")
    };
    assert_eq!((bright.linear(), dark.linear()), ([1.0; 3], [0.0, 0.0, 0.5]));
    assert!(matches!(gi("type fake up 0 1 0 sky 1 0 0 ground 0 1 0"), GiKind::Fake { up: [0.0, 1.0, 0.0], .. }));
    assert!(clean("gi { type path samples 4 } gi { type none }").gi.is_none());
    assert!(clean("gi { type path samples 4 } gi { type null }").gi.is_none());
}

#[test]
fn photons_may_give_their_number_in_two_places() {
    let old = clean("photons { emit 500 caustics kd 60 0.5 }").caustics;
    let new = clean("photons { caustics 500 kd 60 0.5 }").caustics;
    assert_eq!(old.map(|caustics| caustics.emit), Some(500));
    assert_eq!(new.map(|caustics| (caustics.emit, caustics.gather)), Some((500, 60)));
    assert!(clean("photons { caustics 500 none 0 0 }").caustics.is_none());
    assert_eq!(messages("photons { caustics kd 60 0.5 }"), ["error: `caustics` lacks the number of photons"]);
}

#[test]
fn lights_shine_as_written() {
    let LightKind::Spherical { color, radiance: 10.0, center, radius: 2.0, samples: 16 } =
        light("type spherical color 1 0.5 0 radiance 10 center 1 2 3 radius 2 samples 16")
    else {
        panic!("spherical")
    };
    assert_eq!((color.linear(), center), ([1.0, 0.5, 0.0], [1.0, 2.0, 3.0]));
    let LightKind::Mesh { name, emit, radiance, samples, shape } =
        light("type meshlight name lamp emit 1 1 1 points 3 0 0 0 1 0 0 0 1 0 triangles 1 0 1 2")
    else {
        panic!("meshlight")
    };
    assert_eq!((name.expect("a name").value.as_str(), emit.linear(), radiance, samples), ("lamp", [1.0; 3], 1.0, 1));
    let triangle = Triangles { points: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], triangles: vec![[0, 1, 2]] };
    assert_eq!(shape, triangle);
    let LightKind::Mesh { shape, samples: 7, .. } = light(
        "type mesh name lamp emit 1 1 1 samples 7 3 1 v 0 0 0 9 9 9 9 9 v 1 0 0 9 9 9 9 9 v 0 1 0 9 9 9 9 9 t 0 1 2",
    ) else {
        panic!("mesh")
    };
    assert_eq!(shape, triangle);
}

#[test]
fn the_sky_has_a_ground() {
    let sky = "type sunsky up 0 0 1 east 0 1 0 sundir 1 1 1 turbidity 4";
    let LightKind::SunSky { turbidity: 4.0, samples: 64, ground: Ground::Color(ground), .. } = light(sky) else {
        panic!("a sky")
    };
    assert_eq!(ground.linear(), [0.0; 3]);
    let ground = light(&format!("{sky} samples 8 ground.color 1 2 3"));
    let LightKind::SunSky { samples: 8, ground: Ground::Color(ground), .. } = ground else { panic!("a sky") };
    assert_eq!(ground.linear(), [1.0, 2.0, 3.0]);
    let extended = light(&format!("{sky} ground.extendsky true"));
    assert!(matches!(extended, LightKind::SunSky { ground: Ground::Sky, .. }));
}

/// Sunflow: P11 of the format reference.
#[test]
fn lights_without_samples_ask_the_lightserver() {
    let ibl = "light { type ibl image a.hdr center 0 -1 0 up 0 0 1 lock false }";
    let samples = |text: &str| match &clean(text).lights[0].kind {
        LightKind::Ibl { samples, low_samples, .. } => [*samples, *low_samples],
        other => panic!("{other:?}"),
    };
    assert_eq!(samples(ibl), [1, 1]);
    assert_eq!(samples(&format!("lightserver {{ direct-samples 5 }} {ibl}")), [5, 5]);
    assert_eq!(samples(&ibl.replace("lock false", "lock true samples 9 lowsamples 2")), [9, 2]);
}

#[test]
fn the_cornell_box_is_a_light() {
    let LightKind::CornellBox(CornellBox { corners, left, emit, samples, .. }) = light(
        "type cornellbox corner0 -1 -2 0 corner1 1 2 3 left 0.8 0.25 0.25 right 0.25 0.25 0.8 top 0.7 0.7 0.7
         bottom 0.7 0.7 0.7 back 0.7 0.7 0.7 emit 15 15 15",
    ) else {
        panic!("a box")
    };
    assert_eq!((corners, samples), ([[-1.0, -2.0, 0.0], [1.0, 2.0, 3.0]], 16));
    assert_eq!((left.linear(), emit.linear()), ([0.8, 0.25, 0.25], [15.0; 3]));
}

#[test]
fn shaders_take_their_keywords() {
    let ShaderKind::Shiny { diffuse: ColorOrTexture::Texture(file), reflection: 0.25 } =
        shader("type shiny texture a.png refl 0.25")
    else {
        panic!("shiny")
    };
    assert_eq!(file.value, "a.png");
    let ward = shader("type ward diff 1 1 1 spec 0.5 0.5 0.5 rough 0.2 0.1");
    assert!(matches!(ward, ShaderKind::Ward { roughness: [0.2, 0.1], samples: 4, .. }));
    let ShaderKind::AmbientOcclusion { bright: ColorOrTexture::Color(bright), dark, samples: 32, distance: 0.0 } =
        shader("type amb-occ")
    else {
        panic!("amb-occ")
    };
    assert_eq!((bright.linear(), dark.linear()), ([1.0; 3], [0.0; 3]));
    let occlusion = shader("type amb-occ2 diff 0.5 0.5 0.5 dark 1 0 0 samples 8 dist 3");
    assert!(matches!(occlusion, ShaderKind::AmbientOcclusion { samples: 8, distance: 3.0, .. }));
    let wires = shader("type wireframe width 0.5");
    assert!(matches!(wires, ShaderKind::Wireframe { width: 0.5, .. }));
}

/// Sunflow: R11 of the format reference.
#[test]
fn the_specular_part_of_uber_blends_as_the_diffuse_one() {
    let blends = |text: &str| match shader(text) {
        ShaderKind::Uber { diffuse: Blend { blend: a, texture, .. }, specular: Blend { blend: b, .. }, .. } => {
            (a, b, texture.map(|name| name.value))
        }
        other => panic!("{other:?}"),
    };
    assert_eq!(blends("type uber"), (1.0, 1.0, None));
    assert_eq!(blends("type uber diff.blend 0.25"), (0.25, 0.25, None));
    assert_eq!(blends("type uber diff.blend 0.25 spec.blend 0.5"), (0.25, 0.5, None));
    assert_eq!(blends("type uber texture a.png 0.75"), (0.75, 0.75, Some("a.png".to_owned())));
}

#[test]
fn modifiers_and_textures_are_declared() {
    let scene = clean(
        "modifier { name b type bump texture a.png scale 0.02 } modifier { name p type perlin function 7 size 2 scale 3 }
         texture { name veins type marble depth 3 } shader { name s type diffuse texture veins }",
    );
    let ModifierKind::Bump { texture, scale: 0.02 } = &scene.modifiers[0].kind else { panic!("a bump") };
    assert_eq!(texture.value, "a.png");
    assert!(matches!(scene.modifiers[1].kind, ModifierKind::Perlin { function: 7, size: 2.0, scale: 3.0 }));
    assert_eq!((scene.textures[0].declaration.name, scene.textures[0].settings.len()), ("marble", 1));
    assert_eq!(
        messages("modifier { name a type normalmap texture b } modifier { name a type normalmap texture c }"),
        ["warning: there is already a modifier `a`; names find the first one"]
    );
    assert_eq!(messages("texture { name a type diffuse }"), ["error: unknown texture type `diffuse`"]);
}

#[test]
fn patches_say_how_they_are_cut() {
    let pot = object("type teapot");
    assert!(matches!(pot, Geometry::Teapot(Tessellation { subdivs: 8, smooth: true })));
    let points = "0 0 0 1 0 0 1 1 0 0 0 1 1 0 1 1 1 1 0 0 2 1 0 2 1 1 2 0 0 3 1 0 3 1 1 3";
    let Geometry::BezierMesh { net, tessellation } =
        object(&format!("type bezier-mesh n 3 4 wrap true false points {points} subdivs 2 smooth false"))
    else {
        panic!("patches")
    };
    assert_eq!(tessellation, Tessellation { subdivs: 2, smooth: false });
    assert_eq!((net.size, net.wrap, net.points.len(), net.patches()), ([3, 4], [true, false], 12, [1, 1]));
    let net = BezierNet { size: [10, 9], wrap: [false, true], points: Vec::new() };
    assert_eq!(net.patches(), [3, 3]);
}

#[test]
fn other_shapes_take_their_numbers() {
    assert!(matches!(object("type torus r 0.25 1"), Geometry::Torus { tube: 0.25, ring: 1.0 }));
    assert!(matches!(
        object("type julia"),
        Geometry::Julia { c: [-0.4, 0.2, 0.3, -0.2], iterations: 15, epsilon: 1e-5 }
    ));
    assert!(matches!(
        object("type sphereflake level 3"),
        Geometry::SphereFlake { level: 3, axis: [0.0, 0.0, 1.0], radius: 1.0 }
    ));
    let Geometry::Hair(hair) = object("type hair segments 1 width 0.1 points 6 0 0 0 0 0 1") else { panic!("hair") };
    assert_eq!(hair, Hair { segments: 1, width: 0.1, points: vec![[0.0; 3], [0.0, 0.0, 1.0]] });
    let Geometry::Particles { points: PointSource::File { file, order }, count, radius } =
        object("type particles filename p.dat little_endian num 5 radius 0.5")
    else {
        panic!("particles")
    };
    assert_eq!((file.value.as_str(), order, count, radius), ("p.dat", ByteOrder::LittleEndian, Some(5), 0.5));
    let Geometry::FileMesh { file, smooth_normals: false } = object("type file-mesh filename a.obj") else {
        panic!("a file")
    };
    assert_eq!(file.value, "a.obj");
}
