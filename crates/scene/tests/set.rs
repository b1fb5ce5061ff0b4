//! `NAME.KEY=VALUE` changes one keyword of one shader.

mod common;

use common::clean;
use jaspe_scene::description::{ColorOrTexture, ColorSpec, SettingValue, ShaderKind};
use jaspe_scene::{Parameter, Scene, parameters, set};

fn scene() -> Scene {
    clean(
        "shader { name floor type marble depth 4 scale 2 }
         shader { name Sphere.001 type phong diff 1 1 1 spec 1 1 1 50 }
         shader { name g type glass eta 1.5 color 1 1 1 }
         shader { name d type diffuse texture a.png }
         shader { name m type mirror refl 1 1 1 }
         shader { name c type constant 1 1 1 }",
    )
}

fn kind(scene: &Scene, name: &str) -> ShaderKind {
    scene.shaders.iter().find(|shader| shader.name.value == name).expect("it is there").kind.clone()
}

#[track_caller]
fn changed(assignment: &str) -> Scene {
    let mut scene = scene();
    set(&mut scene, assignment).expect(assignment);
    scene
}

#[test]
fn declared_parameters_are_set() {
    let scene = changed("floor.depth=9");
    let ShaderKind::Procedural { settings, .. } = kind(&scene, "floor") else { panic!("marble") };
    let values: Vec<_> = settings.iter().map(|setting| (setting.name, setting.value.clone())).collect();
    assert_eq!(values, [("scale", SettingValue::Float(2.0)), ("depth", SettingValue::Int(9))]);
    let scene = changed("floor.noise=lattice");
    let ShaderKind::Procedural { settings, .. } = kind(&scene, "floor") else { panic!("marble") };
    assert_eq!(settings[2].value, SettingValue::Choice("lattice"));
}

#[test]
fn colours_are_written_in_several_ways() {
    for (value, spec) in [
        ("1 0.5 0", ColorSpec::Linear([1.0, 0.5, 0.0])),
        ("1,0.5,0", ColorSpec::Linear([1.0, 0.5, 0.0])),
        ("1, 0.5, 0", ColorSpec::Linear([1.0, 0.5, 0.0])),
        ("#ff8000", ColorSpec::SrgbNonlinear([1.0, 128.0 / 255.0, 0.0])),
        ("{ \"sRGB nonlinear\" 1 0.5 0 }", ColorSpec::SrgbNonlinear([1.0, 0.5, 0.0])),
    ] {
        let scene = changed(&format!("floor.diffuse_final={value}"));
        let ShaderKind::Procedural { settings, .. } = kind(&scene, "floor") else { panic!("marble") };
        let SettingValue::Color(color) = &settings.last().expect("just set").value else { panic!("a colour") };
        assert_eq!(color.spec, spec, "{value}");
    }
}

#[test]
fn plain_shaders_are_set_by_their_keywords() {
    let ShaderKind::Phong { power, samples, .. } = kind(&changed("Sphere.001.spec=1,1,1 90"), "Sphere.001") else {
        panic!("phong")
    };
    assert_eq!((power, samples), (90.0, 4));
    let ShaderKind::Glass { absorption_distance, eta, .. } = kind(&changed("g.absorption.distance=3"), "g") else {
        panic!("glass")
    };
    assert_eq!((absorption_distance, eta), (3.0, 1.5));
    let ShaderKind::Diffuse { diffuse } = kind(&changed("d.diff=#ffffff"), "d") else { panic!("diffuse") };
    assert!(matches!(diffuse, ColorOrTexture::Color(_)));
    let ShaderKind::Mirror { color } = kind(&changed("m.refl=0.5 0.5 0.5"), "m") else { panic!("mirror") };
    assert_eq!(color.linear(), [0.5; 3]);
    let ShaderKind::Constant { color } = kind(&changed("c.color=0 0 0"), "c") else { panic!("constant") };
    assert!(matches!(color, ColorOrTexture::Color(color) if color.linear() == [0.0; 3]));
    let ShaderKind::Constant { color } = kind(&changed("c.texture=a.png"), "c") else { panic!("constant") };
    assert!(matches!(color, ColorOrTexture::Texture(name) if name.value == "a.png"));
}

#[test]
fn the_assignment_becomes_a_source() {
    let scene = changed("floor.depth=9");
    let ShaderKind::Procedural { settings, .. } = kind(&scene, "floor") else { panic!("marble") };
    let span = settings[1].span;
    let bytes = &scene.sources.file(span.file).expect("a source").bytes;
    assert_eq!(&bytes[span.start as usize..span.end as usize], b"depth=9");
}

#[test]
fn what_is_wrong_is_told_and_nothing_changes() {
    for (assignment, message, hint) in [
        ("floor.depht=9", "unknown keyword `depht`", "did you mean `depth`?"),
        ("floot.depth=9", "there is no shader `floot`", "did you mean `floor`?"),
        ("floor.depth=99", "`depth` must be from 0 to 32, and is 99", ""),
        ("floor.depth=", "`depth` expects a whole number, found nothing", ""),
        ("floor.depth=1 2", "`depth` takes no further value, found `2`", ""),
        ("floor.diffuse_final=#ff80", "`diffuse_final` expects a colour like `#ff8000`, found `#ff80`", ""),
        ("floor.type=wood", "unknown keyword `type`", ""),
        ("floor.depth", "expected `NAME.KEY=VALUE`", "for example `floor.depth=5`"),
        ("floor=3", "there is no shader `floor`", ""),
        ("", "expected `NAME.KEY=VALUE`", ""),
    ] {
        let mut scene = scene();
        let before = format!("{:?}", scene.shaders);
        let diagnostics = set(&mut scene, assignment).expect_err(assignment);
        let diagnostic = diagnostics.iter().next().expect("a reason");
        assert_eq!(diagnostic.message, message, "{assignment}");
        if !hint.is_empty() {
            assert_eq!(diagnostic.hints, [hint], "{assignment}");
        }
        assert_eq!(format!("{:?}", scene.shaders), before, "{assignment}");
    }
}

#[test]
fn any_text_is_survived() {
    for text in
        ["=", ".", ".=", "floor.=", "floor.depth=\u{0}", "\"=\"", "é.é=é", "floor.diffuse_final={", "floor.scale=/*"]
    {
        assert!(set(&mut scene(), text).is_err(), "{text}");
    }
}

#[test]
fn textures_are_set_like_shaders() {
    let mut scene = clean("texture { name veins type marble depth 4 } shader { name s type diffuse texture veins }");
    set(&mut scene, "veins.depth=9").expect("it has a depth");
    assert_eq!(scene.textures[0].settings[0].value, SettingValue::Int(9));
    let refused = set(&mut scene, "vein.depth=9").expect_err("there is none of that name");
    assert_eq!(refused.iter().next().expect("a message").hints, ["did you mean `veins`?"]);
}

/// The value as it is written after `=`.
fn text(value: &Parameter) -> String {
    let numbers = |numbers: &[f64]| numbers.iter().map(f64::to_string).collect::<Vec<_>>().join(" ");
    match value {
        Parameter::Int(value) => value.to_string(),
        Parameter::Float(value) => value.to_string(),
        Parameter::Floats(values) => numbers(values),
        Parameter::Color(color) => numbers(color),
        Parameter::Word(word) => word.clone(),
        Parameter::Auto => unreachable!("it cannot be written"),
    }
}

#[test]
fn parameters_are_read_as_they_are_set() {
    let mut scene = clean(
        "texture { name t type wood depth 3 }
         shader { name floor type marble scale 2 diffuse_initial { \"sRGB nonlinear\" 1 0.5 0 } }
         shader { name p type phong diff 1 1 1 spec 1 0.5 1 50 samples 3 }
         shader { name g type glass eta 1.3 color 1 1 0.1 }
         shader { name d type diffuse texture a.png }
         shader { name m type mirror refl 1 1 1 }
         shader { name c type constant 1 1 1 }
         shader { name s type shiny diff 0.1 0.2 0.3 refl 0.5 }
         shader { name w type ward diff 0.1 0.2 0.3 spec 1 1 1 rough 0.1 0.2 samples 2 }
         shader { name a type amb-occ bright 1 1 1 dark 0 0 0 samples 8 dist 3 }
         shader { name u type uber diff 1 1 1 diff.texture b.png diff.blend 0.25 refl 1 1 1 glossy 0.1 samples 2 }
         shader { name l type wireframe line 1 0 0 fill 0 0 1 width 0.01 }
         shader { name i type id }",
    );
    let names: Vec<String> = scene.shaders.iter().map(|shader| shader.name.value.clone()).collect();
    let mut count = 0;
    for name in names.iter().map(String::as_str).chain(["t"]) {
        let before = parameters(&scene, name).expect("it is there");
        for (key, value) in before.iter().filter(|(_, value)| *value != Parameter::Auto) {
            set(&mut scene, &format!("{name}.{key}={}", text(value))).expect("it takes what it had");
            count += 1;
        }
        assert_eq!(parameters(&scene, name), Some(before), "{name}");
    }
    assert_eq!(count, 7 + 7 + 3 + 4 + 1 + 1 + 1 + 2 + 4 + 4 + 7 + 3);
    assert_eq!(parameters(&scene, "nobody"), None);
    let floor = parameters(&scene, "floor").expect("it is there");
    assert!(floor.contains(&("scale", Parameter::Float(2.0))) && floor.contains(&("depth", Parameter::Int(5))));
    let glass = parameters(&scene, "g").expect("it is there");
    assert_eq!(glass[..2], [("eta", Parameter::Float(1.3)), ("color", Parameter::Color([1.0, 1.0, 0.1]))]);
    assert_eq!(
        parameters(&scene, "p").expect("it is there")[1],
        ("spec", Parameter::Floats(vec![1.0, 0.5, 1.0, 50.0]))
    );
}
