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
    part(text, None)
}

/// The picture, or a part of it: x0, y0, x1, y1.
fn part(text: &str, crop: Option<[u32; 4]>) -> Film {
    let loader = MemoryLoader::default();
    let (scene, diagnostics) = parse(Path::new("micro.sc"), text.as_bytes(), &loader);
    assert!(!diagnostics.has_errors(), "{diagnostics:?}\n{text}");
    let compiled = compile(&scene, &loader, &CompileOptions::default());
    assert!(!compiled.diagnostics.has_errors(), "{:?}", compiled.diagnostics);
    let scene = compiled.scene.expect("no errors");
    render(&scene, &RenderOptions { crop, ..RenderOptions::default() }, &()).expect("not cancelled").0
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

#[test]
fn a_shining_sphere_lights_a_floor() {
    let light = "light { type spherical color 1 1 1 radiance 10 center 3 0 3 radius 1 samples 256 }";
    micro(&format!("{DIFFUSE}{PLANE}{light}"), [31, 32], [0.19650; 3], 1e-3);
}

#[test]
fn a_shining_sphere_is_seen_and_does_not_shine_inwards() {
    let light = |z: f32, r: f32| {
        format!("light {{ type spherical color 1 0.5 0.25 radiance 3 center 0 0 {z} radius {r} samples 1 }}")
    };
    micro(&light(0.0, 1.0), [31, 32], [3.0, 1.5, 0.75], 0.0);
    micro(&light(5.0, 2.0), [31, 32], [0.0; 3], 0.0);
}

/// Irradiance, over π, right above the middle of a square of half size `a` at distance `h` that shines with radiance 1.
fn square_light(a: f32, h: f32) -> f32 {
    // Four times the form factor of a square over one of its corners (Howell, A Catalog of Radiation Heat Transfer
    // Configuration Factors, B-3).
    let x = f64::from(a / h);
    let part = x / (1.0 + x * x).sqrt();
    (4.0 * 2.0 / std::f64::consts::TAU * part * angle(part)) as f32
}

/// Arctangent by its series with halved arguments: the tests have no platform functions either.
fn angle(t: f64) -> f64 {
    let half = |t: f64| t / (1.0 + (1.0 + t * t).sqrt());
    let t = half(half(half(t)));
    8.0 * (t - t.powi(3) / 3.0 + t.powi(5) / 5.0 - t.powi(7) / 7.0)
}

#[test]
fn triangles_shine_to_their_front() {
    // A square of half size 2 at a height of 2, wound so that it faces down.
    let light = |triangles: &str| {
        format!(
            "light {{ type meshlight name l emit 1 1 1 radiance 2 samples 64 points 4
             -2 -2 2  2 -2 2  2 2 2  -2 2 2 triangles 2 {triangles} }}
             camera {{ type pinhole eye 0 -5 1 target 0 0 0 up 0 0 1 fov 40 aspect 1 }}"
        )
    };
    let expected = 0.5 * 2.0 * square_light(2.0, 2.0);
    micro(&format!("{DIFFUSE}{PLANE}{}", light("0 2 1 0 3 2")), [31, 32], [expected; 3], 4e-3);
    micro(&format!("{DIFFUSE}{PLANE}{}", light("0 1 2 0 2 3")), [31, 32], [0.0; 3], 0.0);
}

#[test]
fn many_small_triangles_shine_like_few_large_ones() {
    let n = 12;
    let at = |i: u32| -2.0 + 4.0 * i as f32 / n as f32;
    let points: String =
        (0..=n).flat_map(|y| (0..=n).map(move |x| (x, y))).map(|(x, y)| format!("{} {} 2\n", at(x), at(y))).collect();
    let corner = |x: u32, y: u32| y * (n + 1) + x;
    let triangles: String = (0..n)
        .flat_map(|y| (0..n).map(move |x| (x, y)))
        .map(|(x, y)| {
            let [a, b, c, d] = [corner(x, y), corner(x + 1, y), corner(x + 1, y + 1), corner(x, y + 1)];
            format!("{a} {c} {b} {a} {d} {c}\n")
        })
        .collect();
    let light = format!(
        "light {{ type meshlight name l emit 1 1 1 radiance 2 samples 1024 points {} {points} triangles {} {triangles} }}
         camera {{ type pinhole eye 0 -5 1 target 0 0 0 up 0 0 1 fov 40 aspect 1 }}",
        (n + 1) * (n + 1),
        2 * n * n
    );
    micro(&format!("{DIFFUSE}{PLANE}{light}"), [31, 32], [square_light(2.0, 2.0); 3], 4e-3);
}

#[test]
fn uber_spreads_its_reflection() {
    let shader = "shader { name s type uber diff 0 0 0 spec 0.3 0.3 0.3 glossy 0.1 samples 64 }\n";
    micro(&format!("{WHITE}{shader}{}{PLANE}", cube("white", 100.0)), [31, 32], [0.30055; 3], 0.01);
}

#[test]
fn ward_highlights_along_its_axes() {
    let shader = "shader { name s type ward diff 0 0 0 spec 0.5 0.5 0.5 rough 0.2 0.1 samples 0 }\n";
    let light = "light { type directional source 1 0 4 target 0 0 0 radius 5 emit 1 1 1 intensity 1 }";
    micro(&format!("{shader}{PLANE}{light}"), [31, 32], [0.43050; 3], 2e-3);
}

#[test]
fn shiny_reflects_in_its_own_colour() {
    let shader = "shader { name s type shiny diff 0.2 0.4 0.6 refl 0.5 }\n";
    micro(&format!("{WHITE}{shader}{}{PLANE}", cube("white", 100.0)), [31, 32], [0.1, 0.2, 0.3], 1e-4);
}

#[test]
fn paths_gather_light_from_a_white_room() {
    let gi = "gi { type path samples 64 }\n";
    micro(&format!("{WHITE}{DIFFUSE}{PLANE}{}{gi}", cube("white", 100.0)), [31, 32], [0.5; 3], 1e-4);
}

#[test]
fn fake_light_follows_the_slope() {
    let gi = "gi { type fake up 0 1 0 sky 1 0 0 ground 0 1 0 }\n";
    micro(&format!("{DIFFUSE}{PLANE}{gi}"), [31, 32], [0.25, 0.25, 0.0], 1e-5);
}

#[test]
fn open_ground_is_bright_unless_a_background_closes_it() {
    let shader = "shader { name s type amb-occ bright 1 1 1 dark 0 0 0 samples 16 dist 0 }\n";
    micro(&format!("{shader}{PLANE}"), [31, 32], [1.0; 3], 1e-5);
    let background = "background { color 0.1 0.2 0.3 }\n";
    micro(&format!("{shader}{PLANE}{background}"), [31, 32], [0.0; 3], 0.0);
}

/// A grey room with a point light in it, seen from inside.
fn room(rest: &str) -> String {
    format!(
        "image {{ resolution 64 64 aa 0 0 filter box }}
         camera {{ type pinhole eye 0 0 5 target 0 5 5 up 0 0 1 fov 40 aspect 1 }}
         {DIFFUSE}{} {rest}",
        cube("s", 6.0)
    )
}

/// The mean of the 5 × 5 pixels around one: what is random about them cancels.
#[track_caller]
fn check_around(text: &str, [x, y]: [u32; 2], expected: f32, tolerance: f32) {
    let film = part(text, Some([x - 2, y - 2, x + 3, y + 3]));
    let mean = film.pixels.iter().map(|pixel| pixel[0]).sum::<f32>() / film.pixels.len() as f32;
    assert!((mean - expected).abs() <= tolerance, "around ({x}, {y}) it is {mean}, expected {expected}");
}

const LAMP: &str = "light { type point color 1 1 1 power 1000 p 0 0 0.3 }\n";
/// The lamp's light from two lamps in the same place.
const LAMPS: &str = "light { type point color 1 1 1 power 500 p 0 0 0.3 }
    light { type point color 1 1 1 power 500 p 0 0 0.3 }\n";

#[test]
fn light_bounces_as_often_as_it_may() {
    let once = room(&format!("{LAMP} trace-depths {{ diff 1 }} gi {{ type path samples 256 }}"));
    check_around(&once, [31, 32], 0.26868, 2e-3);
    let cached = "gi { type irr-cache samples 256 tolerance 0.05 spacing 0.05 5 }";
    check_around(&room(&format!("{LAMP} trace-depths {{ diff 3 }} {cached}")), [31, 32], 0.26868, 2e-3);
    let paths = "trace-depths { diff 6 } gi { type path samples 256 }";
    check_around(&room(&format!("{LAMP} {paths}")), [31, 32], 0.3576, 5e-3);
    check_around(&room(&format!("{LAMPS} {paths}")), [31, 32], 0.3576, 5e-3);
}

#[test]
fn virtual_lights_add_what_they_add_in_sunflow() {
    let gi = "trace-depths { diff 6 } gi { type igi samples 8192 sets 1 c 1000 bias-samples 0 }";
    check_around(&room(&format!("{LAMP} {gi}")), [31, 32], 0.506, 0.03);
    check_around(&room(&format!("{LAMPS} {gi}")), [31, 32], 0.338, 0.03);
}

#[test]
fn a_glass_ball_gathers_light_below_it() {
    let scene = format!(
        "image {{ resolution 64 64 aa 0 0 filter box }}
         camera {{ type pinhole eye 0 -80 3.5 target 0 0 0 up 0 0 1 fov 40 aspect 1 }}
         {DIFFUSE} shader {{ name g type glass eta 1.5 color 1 1 1 }}
         object {{ shader s type generic-mesh name floor points 4 -40 -40 0 40 -40 0 40 40 0 -40 40 0
                  triangles 2 0 1 2 0 2 3 normals none uvs none }}
         object {{ shader g type sphere c 0 0 15 r 10 }}
         light {{ type spherical color 1 1 1 radiance 100 center 0 0 60 radius 2 samples 16 }}
         photons {{ caustics 200000 kd 100 5 }}"
    );
    let pixel = |x: u32, y: u32| part(&scene, Some([x, y, x + 1, y + 1])).pixels[0][0];
    // 4.70 by tracing rays from the middle of the floor back to the light. (Sunflow's own map blurs it to 2.7.)
    let bright = pixel(31, 32);
    assert!((bright - 4.70).abs() < 0.4, "{bright}");
    let dark = pixel(34, 32);
    assert!((dark - 0.099).abs() < 0.03, "{dark}");
}

#[test]
fn samplers_choose_the_number_of_samples() {
    let count = |image: &str| {
        let text = format!(
            "image {{ resolution 8 8 aa 1 2 {image} }} {DIFFUSE}{PLANE}
             camera {{ type pinhole eye 0 0 5 target 0 0 0 up 0 1 0 fov 40 aspect 1 }}"
        );
        let (scene, _) = parse(Path::new("samplers.sc"), text.as_bytes(), &MemoryLoader::default());
        let scene = compile(&scene, &MemoryLoader::default(), &CompileOptions::default()).scene.expect("no errors");
        render(&scene, &RenderOptions::default(), &()).expect("not cancelled").1.samples / 64
    };
    assert_eq!(count("sampler fast"), 1);
    assert_eq!(count("sampler ipr"), 1);
    assert_eq!(count("sampler multipass"), 16);
    assert_eq!(count("sampler multipass samples 5"), 5);
    assert_eq!(count("sampler bucket"), 4);
}

#[test]
fn crops_are_parts_of_the_whole_after_any_number_of_passes() {
    for aa in ["0 1", "0 2", "0 3", "1 3"] {
        let text = format!(
            "image {{ resolution 60 44 aa {aa} filter gaussian }}
            camera {{ type pinhole eye 0 0 5 target 0 0 0 up 0 1 0 fov 50 aspect 1.3636 }}
            light {{ type spherical color 1 1 1 radiance 9 center 2 4 4 radius 1 samples 8 }}
            gi {{ type ambocc bright 1 1 1 dark 0 0 0 samples 8 maxdist 3 }}
            shader {{ name grey type diffuse diff .6 .5 .4 }} shader {{ name mirror type mirror refl .9 .9 .9 }}
            object {{ shader grey type plane p 0 -1 0 n 0.1 1 0.2 }}
            object {{ shader grey type sphere c -.8 -.1 0 r .9 }} object {{ shader mirror type sphere c 1 0 0 r .8 }}"
        );
        let whole = film(&text);
        let [x0, y0, x1, y1] = [9, 6, 41, 37];
        let crop = part(&text, Some([x0, y0, x1, y1]));
        for y in y0..y1 {
            let row = |film: &Film, x: u32, y: u32| {
                film.pixels[(y * film.width + x) as usize..][..(x1 - x0) as usize].to_vec()
            };
            assert_eq!(row(&crop, 0, y - y0), row(&whole, x0, y), "aa {aa}, row {y}");
        }
    }
}
