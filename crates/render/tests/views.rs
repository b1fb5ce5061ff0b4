//! What each camera sees where: scenes of balls in plain colours (the format reference's §3.2 and check values).

use std::path::Path;

use jaspe_render::{CompileOptions, Depth, Encoding, Film, Format, RenderOptions, compile, encode, render};
use jaspe_scene::{MemoryLoader, parse};

const SHADERS: &str = "shader { name red type constant 1 0 0 } shader { name green type constant 0 1 0 }
    shader { name blue type constant 0 0 1 }";

fn film(camera: &str, balls: &str) -> Film {
    film_with(&MemoryLoader::default(), camera, balls)
}

fn film_with(loader: &MemoryLoader, camera: &str, balls: &str) -> Film {
    let text =
        format!("image {{ resolution 64 64 aa 0 0 samples 64 filter box }} {SHADERS} camera {{ {camera} }} {balls}");
    let (scene, diagnostics) = parse(Path::new("view.sc"), text.as_bytes(), loader);
    assert!(diagnostics.is_empty(), "{diagnostics:?}");
    let compiled = compile(&scene, loader, &CompileOptions::default());
    let scene = compiled.scene.expect("no errors");
    render(&scene, &RenderOptions::default(), &()).expect("not cancelled").0
}

/// Without a light: a picture shines by itself, in its own linear colours, and lights what is near where light is traced on.
#[test]
fn a_texture_may_shine() {
    let mut picture = Film::new(2, 2, Encoding::Display);
    picture.pixels.fill([1.0, 128.0 / 255.0, 0.0, 1.0]);
    let loader = MemoryLoader::default().with("embers.png", encode(&picture, Format::Png(Depth::Eight)).expect("PNG"));
    let camera = "type pinhole eye 0 0 5 target 0 0 0 up 0 1 0 fov 40 aspect 1";
    let balls =
        "shader { name embers type constant texture embers.png } object { shader embers type sphere c 0 0 0 r 1 }
        shader { name white type diffuse diff 1 1 1 } object { shader white type plane p 0 -1 0 n 0 1 0 }";
    let shines = [1.0, jaspe_scene::srgb_decode(128.0 / 255.0) as f32, 0.0];
    let alone = film_with(&loader, camera, balls);
    sees(&alone, [32, 32], shines, 1.0);
    sees(&alone, [32, 60], NOTHING, 1.0);
    let lit = film_with(&loader, camera, &format!("gi {{ type path samples 16 }} {balls}"));
    sees(&lit, [32, 32], shines, 1.0);
    let floor = lit.pixels[60 * 64 + 32];
    assert!(floor[0] > 0.05 && (floor[1] / floor[0] - shines[1]).abs() < 1e-3 && floor[2] == 0.0, "{floor:?}");
}

#[track_caller]
fn sees(film: &Film, [x, y]: [u32; 2], color: [f32; 3], alpha: f32) {
    let pixel = film.pixels[(y * film.width + x) as usize];
    let expected = [color[0], color[1], color[2], alpha];
    let is_near = pixel.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1e-3);
    assert!(is_near, "{pixel:?} at ({x}, {y}) is not {expected:?}");
}

const RED: [f32; 3] = [1.0, 0.0, 0.0];
const GREEN: [f32; 3] = [0.0, 1.0, 0.0];
const BLUE: [f32; 3] = [0.0, 0.0, 1.0];
const NOTHING: [f32; 3] = [0.0; 3];

const TWO: &str = "object { shader red type sphere c 1 0 0 r .3 } object { shader green type sphere c 0 1 0 r .3 }";

#[test]
fn right_and_up_are_where_they_should_be() {
    let film = film("type pinhole eye 0 0 5 target 0 0 0 up 0 1 0 fov 40 aspect 1", TWO);
    sees(&film, [50, 32], RED, 1.0);
    sees(&film, [31, 13], GREEN, 1.0);
    sees(&film, [12, 32], NOTHING, 0.0);
}

#[test]
fn a_transform_stands_for_eye_target_and_up() {
    let film = film("type pinhole transform { translate 0 0 5 } fov 40 aspect 1", TWO);
    sees(&film, [50, 32], RED, 1.0);
    sees(&film, [31, 13], GREEN, 1.0);
    let turned = self::film("type pinhole transform { translate 0 0 5 rotatey 180 } fov 40 aspect 1", TWO);
    sees(&turned, [13, 32], RED, 1.0);
}

#[test]
fn a_shift_moves_the_plane_of_the_picture() {
    // tan 20° is 0.364: the view goes from 0 to twice that, and the red ball, at 1/5, stands in its left half.
    let film = film("type pinhole eye 0 0 5 target 0 0 0 up 0 1 0 fov 40 aspect 1 shift 0.364 0", TWO);
    sees(&film, [17, 32], RED, 1.0);
    sees(&film, [0, 13], GREEN, 1.0);
    sees(&film, [50, 32], NOTHING, 0.0);
}

#[test]
fn a_spherical_camera_sees_all_around() {
    let balls = "object { shader red type sphere c 10 0 0 r 3 } object { shader green type sphere c 0 10 0 r 3 }
        object { shader blue type sphere c 0 0 -10 r 3 }";
    let film = film("type spherical eye 0 0 0 target 0 0 -1 up 0 1 0", balls);
    sees(&film, [31, 32], BLUE, 1.0);
    sees(&film, [47, 32], RED, 1.0);
    sees(&film, [31, 1], GREEN, 1.0);
    sees(&film, [15, 32], NOTHING, 0.0);
}

#[test]
fn a_fisheye_sees_half_of_it_in_a_disk() {
    let balls = "object { shader red type sphere c 10 0 -4 r 3 } object { shader green type sphere c 0 7 -7 r 1 }
        object { shader blue type sphere c 0 0 -10 r 3 }";
    let film = film("type fisheye eye 0 0 0 target 0 0 -1 up 0 1 0", balls);
    sees(&film, [31, 32], BLUE, 1.0);
    sees(&film, [61, 31], RED, 1.0);
    // Half way between the axis and up: at sin 45° of the radius.
    sees(&film, [32, 9], GREEN, 1.0);
    sees(&film, [1, 1], NOTHING, 0.0);
}

#[test]
fn a_lens_is_sharp_at_its_distance_and_blurs_as_its_shape_says() {
    let lens = "type thinlens eye 0 0 5 target 0 0 0 up 0 1 0 fov 40 aspect 1 fdist 5 lensr 0.5";
    let near = "object { shader red type sphere c 0 0 0 r .1 }";
    let sharp = film(lens, near);
    sees(&sharp, [31, 32], RED, 1.0);
    sees(&sharp, [38, 32], NOTHING, 0.0);
    let spread = |lens: &str| {
        let film = film(lens, "object { shader red type sphere c 0 0 3 r .05 }");
        film.pixels.iter().filter(|pixel| pixel[0] > 0.0).count()
    };
    let (round, square) = (spread(lens), spread(&format!("{lens} sides 4 rotation 45")));
    // A square in a circle has 2/π of its area.
    assert!(round > square && square * 3 > round, "{round} {square}");
}

#[test]
fn a_moving_camera_blurs() {
    let steps = "steps 2 times 0 1 { eye -1 0 5 target -1 0 0 up 0 1 0 } { eye 1 0 5 target 1 0 0 up 0 1 0 }";
    let ball = "object { shader red type sphere c 0 0 0 r .2 }";
    let blurred = film(&format!("type pinhole shutter 0 1 {steps} fov 40 aspect 1"), ball);
    let row = |film: &Film| (0..64).filter(|x| film.pixels[32 * 64 + x][0] > 0.0).count();
    // The ball is 7 pixels wide and passes over 35.
    assert!((36..=46).contains(&row(&blurred)), "{}", row(&blurred));
    let still = film(&format!("type pinhole {steps} fov 40 aspect 1"), ball);
    assert!((6..=10).contains(&row(&still)) && still.pixels[32 * 64 + 49][0] == 1.0, "as at time 0, at the left");
}

#[test]
fn what_moves_is_blurred() {
    let row = |film: &Film| (0..64).filter(|x| film.pixels[32 * 64 + x][0] > 0.0).count();
    let view = "eye 0 0 5 target 0 0 0 up 0 1 0 fov 40 aspect 1";
    let steps = |scale: &str| {
        format!(
            "transform steps 3 times 0 1 {{ {scale} translate -1 0 0 }} {{ {scale} }} {{ {scale} translate 1 0 0 }}"
        )
    };
    let shapes = [
        format!("{} type sphere", steps("scaleu 0.2")),
        format!("{} type cylinder name pipe", steps("scaleu 0.2 rotatex 90")),
        format!("{} type box name crate", steps("scaleu 0.2")),
        format!("{} type sphereflake name flake level 0", steps("scaleu 0.2")),
        format!("{} type torus name ring r 0.1 0.1", steps("scaleu 1")),
    ];
    for shape in shapes {
        let object = format!("object {{ shader red {shape} }}");
        // It is 7 pixels wide (the torus 5) and passes over 35.
        let blurred = film(&format!("type pinhole shutter 0 1 {view}"), &object);
        assert!((34..=46).contains(&row(&blurred)), "{shape}: {}", row(&blurred));
        let still = film(&format!("type pinhole {view}"), &object);
        assert!((4..=12).contains(&row(&still)), "{shape}: {}", row(&still));
        assert_eq!(still.pixels[32 * 64 + 14][0], 1.0, "{shape}: as at time 0, at the left");
    }
    // The middle of the exposure counts most.
    let moving =
        "object { shader red transform steps 3 times -1 1 { translate -1 0 0 } { } { translate 1 0 0 } type sphere }";
    let shown = film("type pinhole eye 0 0 50 target 0 0 0 up 0 1 0 fov 40 aspect 1", moving);
    assert!(shown.pixels[32 * 64 + 31][0] > 0.9, "time 0 is the middle step");
}

#[test]
fn stone_far_away_is_an_even_grey_at_one_sample() {
    let floor = |target: &str| {
        let text = format!(
            "image {{ resolution 64 64 aa 0 0 filter box }}
             camera {{ type pinhole eye 0 0 {target} target 0 0 0 up 0 1 0 fov 40 aspect 1 }}
             light {{ type directional source 0 0 1e4 target 0 0 0 radius 1e5 emit 3 3 3 }}
             shader {{ name granite type stone }}
             object {{ shader granite type plane p 0 0 0 n 0 0 1 }}"
        );
        let loader = MemoryLoader::default();
        let (scene, _) = parse(Path::new("floor.sc"), text.as_bytes(), &loader);
        let scene = compile(&scene, &loader, &CompileOptions::default()).scene.expect("no errors");
        let (film, _) = render(&scene, &RenderOptions::default(), &()).expect("not cancelled");
        let values: Vec<f32> = film.pixels.iter().map(|pixel| pixel[0]).collect();
        let mean = values.iter().sum::<f32>() / values.len() as f32;
        let deviation = values.iter().map(|value| (value - mean).powi(2)).sum::<f32>() / values.len() as f32;
        (mean, deviation.sqrt() / mean)
    };
    let ((near, speckled), (far, even)) = (floor("0.3"), floor("100"));
    assert!(speckled > 0.15 && even < 0.01, "{speckled} {even}");
    assert!((far / near - 1.0).abs() < 0.1, "as bright as from near: {far} {near}");
}
