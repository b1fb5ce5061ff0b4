//! Scenes so small that their pixel values are known: closed formulas, or measured in Sunflow 0.07.3
//! (the format reference's check values).

use std::path::Path;

use jaspe_render::{CompileOptions, Film, RenderOptions, compile, render};
use jaspe_scene::{MemoryLoader, parse};

const HEAD: &str = "
    image { resolution 64 64 aa 0 0 filter box }
    camera { type pinhole eye 0 0 5 target 0 0 0 up 0 1 0 fov 40 aspect 1 }
";
const PLANE: &str = "object { shader s type plane p 0 0 0 n 0 0 1 }\n";
const DIFFUSE: &str = "shader { name s type diffuse diff 0.5 0.5 0.5 }\n";
const WHITE: &str = "shader { name white type constant color 1 1 1 }\n";

/// A cube of the given half size, wound outwards.
fn cube(shader: &str, r: f32) -> String {
    let corners: String = (0..8)
        .map(|i| {
            let side = |bit: i32| if i >> bit & 1 == 1 { r } else { -r };
            format!("{} {} {}\n", side(0), side(1), side(2))
        })
        .collect();
    format!(
        "object {{ shader {shader} type generic-mesh name cube points 8 {corners} triangles 12
         0 2 1 1 2 3 4 5 6 5 7 6 0 1 4 1 5 4 2 6 3 3 6 7 0 4 2 2 4 6 1 3 5 3 7 5 normals none uvs none }}\n"
    )
}

fn film(text: &str) -> Film {
    let loader = MemoryLoader::default();
    let (scene, diagnostics) = parse(Path::new("micro.sc"), text.as_bytes(), &loader);
    assert!(!diagnostics.has_errors(), "{diagnostics:?}\n{text}");
    let compiled = compile(&scene, &loader, &CompileOptions::default());
    assert!(!compiled.diagnostics.has_errors(), "{:?}", compiled.diagnostics);
    let scene = compiled.scene.expect("no errors");
    render(&scene, &RenderOptions::default(), &()).expect("not cancelled").0
}

#[track_caller]
fn check(film: &Film, [x, y]: [u32; 2], expected: [f32; 3], tolerance: f32) {
    let pixel = film.pixels[(y * film.width + x) as usize];
    let off = (0..3).any(|i| (pixel[i] - expected[i]).abs() > tolerance);
    assert!(!off, "pixel ({x}, {y}) is {pixel:?}, expected {expected:?}");
}

#[track_caller]
fn micro(body: &str, pixel: [u32; 2], expected: [f32; 3], tolerance: f32) {
    check(&film(&format!("{HEAD}{body}")), pixel, expected, tolerance);
}

#[test]
fn point_light_falls_off_with_the_square_of_the_distance() {
    // Half the light over π, of 100 units of power spread over a sphere of radius 2. (Sunflow's own bias makes it
    // 1.999; this renderer has none.)
    let expected = 0.5 / std::f32::consts::PI * 100.0 / (4.0 * std::f32::consts::PI * 4.0);
    let light = "light { type point color 1 1 1 power 100 p 0 0 2 }";
    micro(&format!("{DIFFUSE}{PLANE}{light}"), [31, 32], [expected; 3], 1e-4);
}

#[test]
fn directional_light_fills_a_cylinder() {
    let light = "light { type directional source 0 0 4 target 0 0 0 radius 1 emit 1 0.5 0.25 intensity 2 }";
    let film = film(&format!("{HEAD}{DIFFUSE}{PLANE}{light}"));
    check(&film, [31, 32], [1.0, 0.5, 0.25].map(|x| x * std::f32::consts::FRAC_1_PI), 1e-4);
    check(&film, [31, 10], [0.0; 3], 0.0);
}

#[test]
fn backgrounds_are_seen_by_the_camera_and_not_by_mirrors() {
    let background = "background { color 0.1 0.2 0.3 }\n";
    let film = film(&format!("{HEAD}{background}"));
    check(&film, [31, 32], [0.1, 0.2, 0.3], 0.0);
    assert_eq!(film.pixels[0][3], 1.0);
    let mirror = "shader { name s type mirror refl 1 1 1 }\n";
    micro(&format!("{background}{mirror}{PLANE}"), [31, 32], [0.0; 3], 0.0);
}

#[test]
fn glossy_rays_bring_back_a_white_room() {
    let shader = "shader { name s type phong diff 0 0 0 spec 0.3 0.3 0.3 20 samples 64 }\n";
    micro(&format!("{WHITE}{shader}{}{PLANE}", cube("white", 100.0)), [31, 32], [0.30055; 3], 0.01);
}

#[test]
fn glass_ball_on_a_white_floor() {
    let sphere = "object { shader g type sphere c 0 0 2 r 1 }\n";
    let floor = PLANE.replace("shader s", "shader white");
    let clear = "shader { name g type glass eta 1.5 color 1 1 1 }\n";
    micro(&format!("{WHITE}{clear}{sphere}{floor}"), [31, 32], [0.96 * 0.96; 3], 2e-4);
    let green =
        "shader { name g type glass eta 1.5 color 0.9 0.9 0.9 absorption.distance 2 absorption.color 0.8 0.5 0.2 }\n";
    micro(&format!("{WHITE}{green}{sphere}{floor}"), [31, 32], [0.61124, 0.45289, 0.33556], 2e-3);
}

#[test]
fn x_is_right_and_y_is_up() {
    let film = film(&format!(
        "{HEAD}
         shader {{ name red type constant color 1 0 0 }} shader {{ name green type constant color 0 1 0 }}
         object {{ shader red type sphere c 1 0 0 r .3 }} object {{ shader green type sphere c 0 1 0 r .3 }}"
    ));
    check(&film, [50, 32], [1.0, 0.0, 0.0], 0.0);
    check(&film, [31, 13], [0.0, 1.0, 0.0], 0.0);
    check(&film, [12, 32], [0.0; 3], 0.0);
    assert_eq!(film.pixels[32 * 64 + 12][3], 0.0);
}

#[test]
fn spherical_camera_looks_everywhere() {
    let film = film(
        "image { resolution 64 64 aa 0 0 }
         camera { type spherical eye 0 0 0 target 0 0 -1 up 0 1 0 }
         shader { name red type constant color 1 0 0 } shader { name green type constant color 0 1 0 }
         shader { name blue type constant color 0 0 1 }
         object { shader red type sphere c 10 0 0 r 3 } object { shader green type sphere c 0 10 0 r 3 }
         object { shader blue type sphere c 0 0 -10 r 3 }",
    );
    check(&film, [31, 32], [0.0, 0.0, 1.0], 0.0);
    check(&film, [47, 32], [1.0, 0.0, 0.0], 0.0);
    check(&film, [31, 1], [0.0, 1.0, 0.0], 0.0);
}

#[test]
fn a_mirror_shows_what_stands_before_it() {
    // Head-on, Schlick's term adds nothing: the tint is the mirror's own colour.
    let body = "
        shader { name s type mirror refl 0.8 0.4 0.2 }
        shader { name white type constant color 1 1 1 }
        object { shader white type sphere c 0 0 20 r 4 }
        ";
    micro(&format!("{body}{PLANE}"), [31, 32], [0.8, 0.4, 0.2], 1e-4);
}

#[test]
fn faces_choose_among_the_shaders_of_a_mesh() {
    let body = "
        shader { name red type constant color 1 0 0 } shader { name green type constant color 0 1 0 }
        object { shaders 2 red green type generic-mesh name quad
            points 4 -1 -1 0  1 -1 0  1 1 0  -1 1 0
            triangles 2 0 1 2 0 2 3 normals none uvs none face_shaders 0 1 }";
    let film = film(&format!("{HEAD}{body}"));
    check(&film, [40, 36], [1.0, 0.0, 0.0], 0.0);
    check(&film, [24, 28], [0.0, 1.0, 0.0], 0.0);
}

#[test]
fn instances_stand_where_their_transform_puts_them() {
    // The same square as one object and as two instances, one of them under a map that is no similarity.
    let body = "
        shader { name red type constant color 1 0 0 } shader { name green type constant color 0 1 0 }
        object { noinstance type generic-mesh name quad points 4 -1 -1 0  1 -1 0  1 1 0  -1 1 0
            triangles 2 0 1 2 0 2 3 normals none uvs none }
        instance { name a geometry quad transform { scale 0.5 1 1 translate 1 0 0 } shader red }
        instance { name b geometry quad transform row 0.25 0 0 -1  0 0.25 0 0  0 0 1 0  0 0 0 1 shader green }";
    let film = film(&format!("{HEAD}{body}"));
    let columns = |row: usize, channel: usize| {
        (0..64).filter(|x| film.pixels[row * 64 + x][channel] == 1.0).collect::<Vec<usize>>()
    };
    // One world unit is 63 / (2 · 5 · tan 20°) = 17.3 pixels; the axis is at column 31.
    assert_eq!((columns(32, 0).len(), columns(32, 0)[0]), (17, 40));
    assert_eq!((columns(32, 1).len(), columns(32, 1)[0]), (9, 10));
}

#[test]
fn depth_of_field_blurs_what_is_out_of_focus() {
    let scene = |lens: &str| {
        film(&format!(
            "image {{ resolution 64 64 aa 2 2 }}
             camera {{ type thinlens eye 0 0 5 target 0 0 0 up 0 1 0 fov 40 aspect 1 {lens} }}
             shader {{ name white type constant color 1 1 1 }}
             object {{ shader white type sphere c 0 0 0 r 1 }}"
        ))
    };
    let partial = |film: &Film| film.pixels.iter().filter(|p| p[0] > 0.02 && p[0] < 0.98).count();
    let (sharp, blurred) = (scene("fdist 4.8 lensr 0.0"), scene("fdist 2 lensr 0.2"));
    assert!(partial(&blurred) > 3 * partial(&sharp), "{} against {}", partial(&blurred), partial(&sharp));
    let total = |film: &Film| film.pixels.iter().map(|p| p[0]).sum::<f32>();
    assert!((total(&blurred) / total(&sharp) - 1.0).abs() < 0.1);
}
