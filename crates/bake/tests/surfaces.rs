//! Surfaces other than the plane: solid material, cut and unrolled.

#![allow(clippy::disallowed_methods, reason = "our functions are held against the platform's")]

use std::path::Path;
use std::sync::Arc;

use jaspe_bake::{Arrays, Bake, BakeError, Map, Model, ModelError, Settings, Surface};
use jaspe_noise::Dual;
use jaspe_texture::Texture;

fn bake(name: &str, surface: Surface, size: u32) -> Bake {
    let texture = Texture::build(name, &[]).unwrap();
    Bake::new(texture, Settings { size, surface, maps: Map::ALL.to_vec(), ..Settings::default() }).unwrap()
}

fn pixel(arrays: &Arrays, map: usize, x: u32, y: u32) -> &[f32] {
    let channels = arrays.maps[map].map.declaration().channels;
    &arrays.maps[map].values[channels * (y as usize * arrays.width as usize + x as usize)..][..channels]
}

fn apart(a: &[f32], b: &[f32]) -> f32 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

#[test]
fn a_ball_closes_behind() {
    for name in ["organic", "marble", "fire"] {
        for surface in [Surface::Sphere, Surface::Cylinder] {
            let bake = bake(name, surface, 256);
            assert_eq!([bake.width(), bake.height()], [256, 128]);
            let arrays = bake.arrays(0, &()).unwrap();
            // Along u, tangents turn with the surface; so all maps but normals are compared.
            for map in [0, 1, 3, 4] {
                let mean = |pairs: &mut dyn Iterator<Item = (u32, u32, u32)>| {
                    let steps: Vec<f32> =
                        pairs.map(|(a, b, y)| apart(pixel(&arrays, map, a, y), pixel(&arrays, map, b, y))).collect();
                    steps.iter().sum::<f32>() / steps.len() as f32
                };
                let within = mean(&mut (20..108).flat_map(|y| (0..8).chain(247..255).map(move |x| (x, x + 1, y))));
                let across = mean(&mut (20..108).map(|y| (255, 0, y)));
                assert!(across < 1.5 * within + 1e-4, "{name} {map}: {across} and {within}");
            }
        }
    }
}

#[test]
fn heights_and_normals_on_a_ball_are_those_of_the_solid() {
    let bake = bake("organic", Surface::Sphere, 96);
    let arrays = bake.arrays(0, &()).unwrap();
    let radius = 0.5 * bake.cells();
    for y in [5, 24, 40] {
        for x in [0, 17, 48, 95] {
            let point = bake.point(i64::from(x), i64::from(y));
            let length = point.iter().map(|part| part * part).sum::<f64>().sqrt();
            assert!((length - radius).abs() < 1e-12 * radius.max(1.0));
            // The direction, from angles.
            let longitude = std::f64::consts::TAU * ((f64::from(x) + 0.5) / 96.0 - 0.5);
            let latitude = std::f64::consts::PI * (0.5 - (f64::from(y) + 0.5) / 48.0);
            let (a, b) = (longitude.sin_cos(), latitude.sin_cos());
            assert!((point[0] - radius * a.0 * b.1).abs() < 1e-9 && (point[1] - radius * b.0).abs() < 1e-9);
            let gradient = bake.shown().height(Dual::point(point.map(|part| part as f32))).gradient;
            let along = |direction: [f64; 3]| (0..3).map(|k| direction[k] * f64::from(gradient[k])).sum::<f64>();
            let (east, north) = (along([a.1, 0.0, -a.0]), along([-b.0 * a.0, b.1, -b.0 * a.1]));
            let expected = [-east, -north, 1.0].map(|part| part / (east * east + north * north + 1.0).sqrt());
            let found = pixel(&arrays, 2, x, y);
            for k in 0..3 {
                assert!((f64::from(2.0 * found[k] - 1.0) - expected[k]).abs() < 1e-3, "{found:?} {expected:?}");
            }
        }
    }
}

#[test]
fn the_sides_of_a_cube_meet() {
    let bake = bake("organic", Surface::Cube, 128);
    assert_eq!([bake.width(), bake.height()], [128, 96]);
    let arrays = bake.arrays(0, &()).unwrap();
    // Pairs of pixels that touch along an edge, on the cross and around it.
    let mut pairs = Vec::new();
    for i in 0..32 {
        pairs.push(((31, 32 + i), (32, 32 + i))); // −x and +z
        pairs.push(((32 + i, 31), (32 + i, 32))); // +y and +z
        pairs.push(((32 + i, 63), (32 + i, 64))); // +z and −y
        pairs.push(((127, 32 + i), (0, 32 + i))); // −z and −x
        pairs.push(((63, 31 - i), (64 + i, 32))); // +y and +x
    }
    for ((a, b), (c, d)) in pairs {
        let distance: f64 =
            bake.point(a, b).iter().zip(bake.point(c, d)).map(|(p, q)| (p - q) * (p - q)).sum::<f64>().sqrt();
        let step = bake.cells() / 32.0;
        assert!(distance < 0.75 * step, "{a},{b} {c},{d}: {distance}, {step}");
        let (p, q) = (pixel(&arrays, 0, a as u32, b as u32), pixel(&arrays, 0, c as u32, d as u32));
        assert!(apart(p, q) < 0.5, "{p:?} {q:?}");
    }
}

/// A unit square in the plane z = 0.25, its chart in the middle of the map, mirrored or not.
fn square(mirrored: bool) -> Model {
    let u = if mirrored { [0.75, 0.25] } else { [0.25, 0.75] };
    let text = format!(
        "v 0 0 0.25\nv 1 0 0.25\nv 1 1 0.25\nv 0 1 0.25\nvt {0} 0.25\nvt {1} 0.25\nvt {1} 0.75\nvt {0} 0.75\n\
         f 1/1 2/2 3/3 4/4\n",
        u[0], u[1]
    );
    Model::from_mesh_file(text.as_bytes(), Path::new("square.obj")).unwrap()
}

#[test]
fn a_mesh_is_baked_into_its_layout_and_padded() {
    let bake = bake("organic", Surface::Mesh(Arc::new(square(false))), 64);
    let arrays = bake.arrays(0, &()).unwrap();
    let unit = bake.cells();
    assert!((bake.tile() - 1.0).abs() < 1e-12);
    for (x, y) in [(16, 16), (47, 47), (20, 31)] {
        let point = bake.point(x, y);
        let expected = [(x as f64 + 0.5 - 16.0) / 32.0, (47.5 - y as f64) / 32.0, 0.25].map(|part| part * unit);
        assert!((0..3).all(|k| (point[k] - expected[k]).abs() < 1e-9), "{point:?} {expected:?}");
    }
    // Past the seam, the material goes on: steps are no larger than within.
    let step = |x: u32| apart(pixel(&arrays, 0, x, 30), pixel(&arrays, 0, x + 1, 30));
    let within = (17..46).map(step).fold(0.0, f32::max);
    assert!(step(47) <= 1.5 * within && step(15) <= 1.5 * within);
}

#[test]
fn mirrored_charts_mirror_their_normals() {
    let plain = bake("organic", Surface::Mesh(Arc::new(square(false))), 64).arrays(0, &()).unwrap();
    let mirrored = bake("organic", Surface::Mesh(Arc::new(square(true))), 64).arrays(0, &()).unwrap();
    for (x, y) in [(20, 20), (33, 41), (47, 16)] {
        let (a, b) = (pixel(&plain, 2, x, y), pixel(&mirrored, 2, 63 - x, y));
        assert!(apart(&[1.0 - a[0], a[1], a[2]], b) < 1e-3, "{a:?} {b:?}");
        assert!(apart(pixel(&plain, 0, x, y), pixel(&mirrored, 0, 63 - x, y)) < 1e-4);
    }
}

#[test]
fn meshes_without_a_layout_are_refused() {
    let read = |text: &str| Model::from_mesh_file(text.as_bytes(), Path::new("a.obj"));
    assert_eq!(read("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), Err(ModelError::NoLayout));
    assert_eq!(read("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n"), Err(ModelError::NoLayout));
    assert!(matches!(read("v 0 0 zero\n"), Err(ModelError::File(_))));
    assert!(matches!(Model::from_mesh_file(b"", Path::new("a.fbx")), Err(ModelError::File(_))));
    // A chart smaller than a pixel.
    let tiny = read("v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1e-5 0\nvt 0 1e-5\nf 1/1 2/2 3/3\n").unwrap();
    let texture = Texture::build("wood", &[]).unwrap();
    let settings = Settings { size: 8, surface: Surface::Mesh(Arc::new(tiny)), ..Settings::default() };
    assert!(matches!(Bake::new(texture, settings).err(), Some(BakeError::NoLayout | BakeError::TooFine { .. })));
}
