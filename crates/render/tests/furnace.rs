//! Energy: what lies in uniform light is as bright as it reflects, and a closed room holds the light that its walls keep.

use std::f32::consts::PI;
use std::io::Cursor;
use std::path::Path;

use image::{DynamicImage, ImageFormat, RgbImage};
use jaspe_render::{CompileOptions, RenderOptions, compile, render};
use jaspe_scene::{MemoryLoader, parse};

/// The mean brightness of the middle of the picture, and its extremes.
fn middle(text: &str) -> [f32; 3] {
    let white = DynamicImage::ImageRgb8(RgbImage::from_pixel(8, 4, image::Rgb([255; 3])));
    let mut bytes = Cursor::new(Vec::new());
    white.write_to(&mut bytes, ImageFormat::Png).expect("a picture in memory");
    let loader = MemoryLoader::default().with("white.png", bytes.into_inner());
    let (scene, diagnostics) = parse(Path::new("furnace.sc"), text.as_bytes(), &loader);
    assert!(!diagnostics.has_errors(), "{diagnostics:?}\n{text}");
    let options = CompileOptions { samples: Some(16), ..CompileOptions::default() };
    let compiled = compile(&scene, &loader, &options);
    let scene = compiled.scene.unwrap_or_else(|| panic!("{:?}", compiled.diagnostics));
    let (film, _) = render(&scene, &RenderOptions::default(), &()).expect("not cancelled");
    let values: Vec<f32> =
        (12..20).flat_map(|y| film.pixels[y * 32 + 12..][..8].iter().map(|pixel| pixel[1])).collect();
    let mean = values.iter().sum::<f32>() / values.len() as f32;
    let extreme = |pick: fn(f32, f32) -> f32| values.iter().copied().reduce(pick).expect("pixels");
    [mean, extreme(f32::min), extreme(f32::max)]
}

/// A ball of a shader in white surroundings.
fn ball(shader: &str, extra: &str) -> [f32; 3] {
    middle(&format!(
        "image {{ resolution 32 32 }}
         camera {{ type pinhole eye 0 0 5 target 0 0 0 up 0 1 0 fov 40 aspect 1 }}
         light {{ type ibl image white.png center 0 0 1 up 0 1 0 lock false samples 64 }}
         shader {{ name s {shader} }}
         {extra}
         object {{ shader s type sphere c 0 0 0 r 1 }}"
    ))
}

#[test]
fn white_balls_vanish_in_white_surroundings() {
    let whites = [
        "type diffuse diff 1 1 1",
        "type diffuse texture white.png",
        "type constant color 1 1 1",
        "type mirror refl 1 1 1",
        "type shiny diff 1 1 1 refl 0",
        "type phong diff 1 1 1 spec 0 0 0 10 samples 4",
        "type ward diff 1 1 1 spec 0 0 0 rough .2 .2 samples 4",
        "type uber diff 1 1 1 spec 0 0 0 glossy 0 samples 4",
        "type amb-occ bright 1 1 1 dark 0 0 0 samples 16 dist 10",
    ];
    for shader in whites {
        let [mean, ..] = ball(shader, "");
        assert!((mean - 1.0).abs() < 0.01, "{shader}: {mean}");
    }
    // A coat gives back no more than it gets, and most of it.
    let coats = [
        "type shiny diff 0.6 0.6 0.6 refl 0.6",
        "type phong diff 0.5 0.5 0.5 spec 0.5 0.5 0.5 20 samples 4",
        "type ward diff 0.5 0.5 0.5 spec 0.5 0.5 0.5 rough .2 .3 samples 4",
    ];
    for shader in coats {
        let [mean, ..] = ball(shader, "");
        assert!((0.85..1.01).contains(&mean), "{shader}: {mean}");
    }
}

#[test]
fn glass_loses_what_it_reflects_inside_and_nothing_else() {
    // Sunflow: nothing is reflected inside but total reflection (R7). Head-on, 4 % come back and 0.96² pass.
    let [mean, least, most] = ball("type glass eta 1.5 color 1 1 1", "");
    assert!((mean - 0.9616).abs() < 0.002 && least > 0.95 && most <= 1.0, "{mean} {least} {most}");
    let [same, ..] = ball("type glass eta 1 color 1 1 1", "");
    assert!((same - 1.0).abs() < 1e-3, "{same}");
}

#[test]
fn indirect_light_adds_nothing_to_a_ball_alone() {
    for gi in [
        "type path samples 16",
        "type irr-cache samples 64 tolerance 0.01 spacing 0.05 5.0",
        "type igi samples 16 sets 1 b 0.01 bias-samples 4",
    ] {
        let [mean, ..] = ball("type diffuse diff 1 1 1", &format!("gi {{ {gi} }}"));
        assert!((mean - 1.0).abs() < 0.01, "{gi}: {mean}");
    }
}

/// Reflectance of the walls of the round room, and its radius.
const WALL: (f32, f32) = (0.5, 2.0);

/// The wall of a round room with a light in its centre.
fn room(light: &str, gi: &str, bounces: u32) -> f32 {
    let (reflectance, radius) = WALL;
    let [mean, ..] = middle(&format!(
        "image {{ resolution 32 32 }}
         trace-depths {{ diff {bounces} refl 4 refr 4 }}
         camera {{ type pinhole eye 0.4 0 0 target 1 0 0 up 0 1 0 fov 60 aspect 1 }}
         light {{ {light} }}
         {gi}
         shader {{ name wall type diffuse diff {reflectance} {reflectance} {reflectance} }}
         object {{ shader wall type sphere c 0 0 0 r {radius} }}"
    ));
    mean
}

#[test]
fn a_closed_room_holds_the_light_that_its_walls_keep() {
    let (reflectance, radius) = WALL;
    let flux = 100.0;
    let shining = 0.1f32;
    let lights = [
        format!("type point color 1 1 1 power {flux} p 0 0 0"),
        format!(
            "type spherical color 1 1 1 radiance {} center 0 0 0 radius {shining} samples 4",
            flux / (4.0 * PI * PI * shining * shining)
        ),
    ];
    // Every point of the wall gets the same light from all the others.
    let direct = reflectance / PI * flux / (4.0 * PI * radius * radius);
    for light in &lights {
        for (gi, bounces, counted) in [
            ("", 3, 0),
            ("gi { type path samples 16 }", 1, 1),
            ("gi { type path samples 16 }", 4, 4),
            ("gi { type irr-cache samples 64 tolerance 0.01 spacing 0.05 5.0 }", 4, 1),
        ] {
            let expected = direct * (0..=counted).map(|bounce| reflectance.powi(bounce)).sum::<f32>();
            let found = room(light, gi, bounces);
            // The light is black to what the walls send: a 400th of the room.
            assert!((found / expected - 1.0).abs() < 0.015, "{light} {gi}: {found}, expected {expected}");
        }
        let closed = "gi { type ambocc bright 1 1 1 dark 0.25 0.25 0.25 samples 16 maxdist 0 }";
        let (found, expected) = (room(light, closed, 1), direct + 0.25 * reflectance);
        assert!((found / expected - 1.0).abs() < 0.01, "{light}: {found}, expected {expected}");
    }
}

#[test]
fn short_rays_give_back_what_the_limit_of_virtual_lights_takes() {
    // With so strict a limit, virtual lights alone give next to nothing; all light then comes by the short rays.
    let light = "type point color 1 1 1 power 100 p 0 0 0";
    let without = room(light, "gi { type igi samples 64 sets 1 b 0.000001 bias-samples 0 }", 1);
    let with = room(light, "gi { type igi samples 64 sets 1 b 0.000001 bias-samples 16 }", 1);
    let paths = room(light, "gi { type path samples 16 }", 1);
    let direct = room(light, "", 1);
    assert!((without / direct - 1.0).abs() < 0.01, "{without} {direct}");
    assert!((with / paths - 1.0).abs() < 0.02, "{with} {paths}");
}
