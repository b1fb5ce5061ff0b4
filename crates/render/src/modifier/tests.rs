//! Normals held against known tilts and against differences of heights.

use glam::{DMat4, DVec3};
use jaspe_texture::declare::Value;

use super::*;
use crate::math;
use crate::picture::{Picture, PicturePixels};

fn picture(width: u32, height: u32, color: impl Fn(u32, u32) -> [f32; 3]) -> Arc<PictureMap> {
    let pixels = (0..width * height).map(|i| color(i % width, i / width)).collect();
    let picture = Picture { width, height, pixels: PicturePixels::Floats(pixels), grayscale: false };
    Arc::new(PictureMap::raw(picture))
}

/// A map that stretches, turns and moves.
fn object_from_world() -> Affine {
    let turn = DMat4::from_mat3(glam::DMat3::from_cols(
        DVec3::new(0.6, 0.8, 0.0),
        DVec3::new(-0.8, 0.6, 0.0),
        DVec3::new(0.0, 0.0, 1.0),
    ));
    let stretch = DMat4::from_mat3(glam::DMat3::from_diagonal(DVec3::new(0.5, 1.25, 2.0)));
    Affine::from(DMat4::from_translation(DVec3::new(0.3, -0.2, 0.7)) * stretch * turn)
}

fn place(object_from_world: &Affine, number: usize) -> Place<'_> {
    let t = number as f32;
    let point = Vec3::new(0.31 * t - 3.0, 2.0 - 0.17 * t, 0.057 * t);
    let normal = Vec3::new(0.3 - 0.02 * t, 0.4, 0.1 + 0.03 * t).normalize();
    let (u, v) = math::basis(normal);
    Place { point, normal, tangent: [u, v], uv: Vec2::new(0.013 * t, 0.9 - 0.011 * t), object_from_world }
}

#[track_caller]
fn assert_near(actual: Vec3, expected: Vec3, slack: f32) {
    assert!((actual - expected).length() < slack, "{actual} is not {expected}");
}

#[test]
fn flat_pictures_leave_the_normal() {
    let object_from_world = object_from_world();
    let bump = Modifier::Bump { picture: picture(5, 4, |_, _| [0.7, 0.2, 0.4]), scale: 30.0 };
    let normal_map = Modifier::NormalMap { picture: picture(3, 3, |_, _| [0.5, 0.5, 1.0]) };
    for i in 0..60 {
        let at = place(&object_from_world, i);
        assert_near(bump.normal(&at), at.normal, 1e-5);
        assert_near(normal_map.normal(&at), at.normal, 1e-6);
    }
}

#[test]
fn a_ramp_tilts_the_normal_downhill() {
    let object_from_world = object_from_world();
    let at = Place { uv: Vec2::new(0.5, 0.5), ..place(&object_from_world, 3) };
    let [u, v] = at.tangent;
    // Sampled at texels: of 11 columns, u = 0.5 is the sixth, and 1/11 further lies most of the way to the next one.
    let ramp = picture(11, 11, |x, _| [0.1 * x as f32; 3]);
    let t = 10.0 / 11.0_f32;
    let rise = 0.1 * (t * t * (3.0 - 2.0 * t));
    let tilted = Modifier::Bump { picture: ramp, scale: 4.0 }.normal(&at);
    assert_near(tilted, (at.normal - u * (4.0 * rise)).normalize(), 1e-4);
    // Rows count from the top, v from the bottom.
    let ramp = picture(11, 11, |_, y| [0.1 * y as f32; 3]);
    let tilted = Modifier::Bump { picture: ramp, scale: 4.0 }.normal(&at);
    assert_near(tilted, (at.normal + v * (4.0 * rise)).normalize(), 1e-4);
}

#[test]
fn a_normal_map_gives_directions_in_the_basis() {
    let object_from_world = object_from_world();
    let at = place(&object_from_world, 7);
    let map = picture(1, 1, |_, _| [0.8, 0.1, 0.9]);
    let expected = at.tangent[0] * 0.6 - at.tangent[1] * 0.8 + at.normal * 0.8;
    assert_near(Modifier::NormalMap { picture: map }.normal(&at), expected.normalize(), 1e-6);
}

#[test]
fn modifiers_read_bytes_undecoded_and_brighten_single_channels() {
    let map = |grayscale| {
        let pixels = PicturePixels::Bytes(vec![[50; 3], [189; 3]]);
        PictureMap::raw(Picture { width: 2, height: 1, pixels, grayscale })
    };
    let bytes = |map: PictureMap| [0, 1].map(|column| (map.texel(column, 0) * 255.0).x.round());
    assert_eq!(bytes(map(false)), [50.0, 189.0]);
    assert_eq!(bytes(map(true)), [122.0, 223.0]);
}

#[test]
fn procedural_bumps_agree_with_differences_of_the_height() {
    let object_from_world = object_from_world();
    let scale = 0.05;
    for (name, space) in [("marble", "world"), ("stone", "local"), ("organic", "local"), ("water", "world")] {
        let texture = Texture::build(name, &[("space", Value::Choice(space))]).expect("these arguments are right");
        let modifier = Modifier::BumpProcedural { texture: Box::new(texture.clone()), scale };
        let mut off = 0;
        for i in 0..60 {
            let at = place(&object_from_world, i);
            let (point, into) = match space {
                "world" => (at.point, Affine::from(DMat4::IDENTITY)),
                _ => (object_from_world.point(at.point), object_from_world),
            };
            let along = |direction: Vec3| {
                let height = |t: f64| {
                    let moved = point.as_dvec3() + into.vector(direction).as_dvec3() * t;
                    texture.value(moved.to_array())
                };
                ((height(1e-6) - height(-1e-6)) / 2e-6) as f32
            };
            let [u, v] = at.tangent;
            let expected = (at.normal - scale * (u * along(u) + v * along(v))).normalize();
            off += u32::from((modifier.normal(&at) - expected).length() > 4e-3);
        }
        // Sums of absolute values have edges, where differences mean nothing.
        assert!(off <= 3, "{name}: {off}");
    }
}

#[test]
fn textures_in_texture_coordinates_tilt_along_the_basis() {
    let object_from_world = object_from_world();
    let texture = Texture::build("marble", &[("space", Value::Choice("uv"))]).expect("these arguments are right");
    let at = place(&object_from_world, 5);
    let [du, dv] = texture.value(Dual::<f32, 2>::point(at.uv.into())).gradient;
    let expected = (at.normal - 0.1 * (at.tangent[0] * du + at.tangent[1] * dv)).normalize();
    assert_near(Modifier::BumpProcedural { texture: Box::new(texture), scale: 0.1 }.normal(&at), expected, 1e-6);
}

#[test]
fn perlin_turns_the_normal_in_the_space_of_the_object() {
    let object_from_world = object_from_world();
    let world_from_object = DMat4::from_cols_array_2d(&{
        let column = |axis: Vec3| object_from_world.vector(axis).as_dvec3().extend(0.0).to_array();
        [column(Vec3::X), column(Vec3::Y), column(Vec3::Z), [0.0, 0.0, 0.0, 1.0]]
    })
    .inverse();
    let (size, scale) = (1.5, 0.4);
    for function in [0, 1, 2] {
        let modifier = Modifier::Perlin { function, size, scale };
        let mut off = 0;
        for i in 0..60 {
            let at = place(&object_from_world, i);
            // The formula of the format reference, in double precision.
            let q = (object_from_world.point(at.point) * size).as_dvec3();
            let f = |offset: DVec3| perlin::height(function, (q + offset).to_array());
            let difference = |axis: DVec3| (f(axis * 1e-4) - f(DVec3::ZERO)) / 1e-4;
            let gradient = DVec3::new(difference(DVec3::X), difference(DVec3::Y), difference(DVec3::Z));
            let m = world_from_object.transpose().transform_vector3(at.normal.as_dvec3());
            let m = (m - f64::from(scale) * gradient).normalize();
            let expected = object_from_world.transposed(m.as_vec3()).normalize();
            off += u32::from((modifier.normal(&at) - expected).length() > 3e-3);
        }
        // Differences of 1e-4 say little near the edges of turbulence.
        assert!(off <= 2, "function {function}: {off}");
    }
}

#[test]
fn results_are_unit_vectors_whatever_the_input() {
    let singular = Affine::from(DMat4::ZERO);
    let regular = object_from_world();
    let texture = Texture::build("wood", &[]).expect("defaults are right");
    let extremes = [0.0, 1.0, -1e30, f32::INFINITY, f32::NAN];
    for (number, &scale) in extremes.iter().enumerate() {
        let wild = picture(2, 3, |x, y| [1e30 * x as f32, f32::NAN, y as f32]);
        let modifiers = [
            Modifier::Bump { picture: wild.clone(), scale },
            Modifier::NormalMap { picture: wild },
            Modifier::NormalMap { picture: picture(1, 1, |_, _| [0.5; 3]) },
            Modifier::BumpProcedural { texture: Box::new(texture.clone()), scale },
            Modifier::Perlin { function: number as i32 - 1, size: scale, scale },
            Modifier::Perlin { function: 1, size: 1.0, scale },
        ];
        for (modifier, object_from_world) in modifiers.iter().flat_map(|m| [(m, &regular), (m, &singular)]) {
            for &coordinate in &extremes {
                let sound = place(object_from_world, 4);
                let at = Place { point: Vec3::splat(coordinate), uv: Vec2::new(coordinate, 0.2), ..sound };
                assert!(modifier.normal(&at).is_normalized(), "{modifier:?} at {coordinate}");
            }
        }
    }
}
