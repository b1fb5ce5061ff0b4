//! Check values of the format reference (§7.1), and samples held against plain integration.

use glam::Vec2;

use super::*;
use crate::math::sin_cos_degrees;
use crate::picture::{Picture, PicturePixels};

#[track_caller]
fn assert_near(actual: Vec3, expected: [f32; 3], relative: f32) {
    // The expected numbers have five decimals.
    let slack = Vec3::from(expected).abs() * relative + 6e-6;
    let close = (actual - Vec3::from(expected)).abs().cmple(slack).all();
    assert!(close, "{actual} is not {expected:?}");
}

fn mean_of_samples(environment: &Environment, weight: impl Fn(Vec3) -> f32) -> Vec3 {
    let count = 1 << 18;
    let mut sum = glam::DVec3::ZERO;
    for i in 0..count {
        // Evenly spread, and on no grid that could meet that of the cells: steps of the golden section.
        let xi = [(f64::from(i) + 0.5) / f64::from(count), (f64::from(i) * 0.618_033_988_749_894_9).fract()];
        if let Some((direction, weighted)) = environment.sample(xi.map(|xi| xi as f32)) {
            assert!(direction.is_normalized(), "{direction}");
            sum += (weighted * weight(direction)).as_dvec3();
        }
    }
    (sum / f64::from(count)).as_vec3()
}

/// The integral of a radiance over the sphere, in strips about an axis that is none of the environments'.
fn integral(radiance: impl Fn(Vec3) -> Vec3) -> Vec3 {
    let (rows, columns) = (900, 1800);
    let axis = Vec3::new(0.36, 0.48, 0.8);
    let (x, y) = crate::math::basis(axis);
    let mut sum = glam::DVec3::ZERO;
    for row in 0..rows {
        let (sin, cos) = sin_cos_degrees((f64::from(row) + 0.5) * 180.0 / f64::from(rows));
        for column in 0..columns {
            let (s, c) = sin_cos_degrees((f64::from(column) + 0.5) * 360.0 / f64::from(columns));
            let direction = (x * c as f32 + y * s as f32) * sin as f32 + axis * cos as f32;
            sum += radiance(direction).as_dvec3() * sin;
        }
    }
    let area = std::f64::consts::PI / f64::from(rows) * std::f64::consts::TAU / f64::from(columns);
    (sum * area).as_vec3()
}

fn picture(width: u32, height: u32, color: impl Fn(u32, u32) -> [f32; 3]) -> Arc<PictureMap> {
    let pixels = (0..width * height).map(|i| color(i % width, i / width)).collect();
    let picture = Picture { width, height, pixels: PicturePixels::Floats(pixels), grayscale: false };
    Arc::new(PictureMap::linear(picture))
}

#[test]
fn sunlight_agrees_with_the_check_values() {
    let color = |sundir: [f32; 3], turbidity| sun(Vec3::Z, sundir.into(), turbidity).expect("the sun is up").1;
    assert_near(color([0.0, 0.0, 1.0], 2.0), [2.46571, 2.13755, 1.91127], 1e-5);
    assert_near(color([1.0, 1.0, 1.0], 4.0), [1.63572, 1.26608, 0.91855], 1e-5);
    assert_near(color([-1.0, 1.0, 0.2], 2.0), [0.88984, 0.53729, 0.21519], 1e-5);
    assert_near(color([1.0, 0.0, 0.1], 6.0), [0.02634, 0.00659, 0.00003], 1e-5);
}

#[test]
fn a_sun_below_the_horizon_has_set() {
    assert_eq!(sun(Vec3::Z, Vec3::X, 4.0), None);
    assert_eq!(sun(Vec3::Y, Vec3::new(1.0, -0.5, 1.0), 4.0), None);
    let (direction, _) = sun(Vec3::Y, Vec3::new(0.0, 3.0, 4.0), 4.0).expect("the sun is up");
    assert!((direction - Vec3::new(0.0, 0.6, 0.8)).length() < 1e-6);
}

#[test]
fn the_sky_agrees_with_the_check_values() {
    let sky = Environment::sky(Vec3::Y, Vec3::Z, Vec3::ONE, 4.0, Some(Vec3::ZERO));
    let color = |x: f32, y: f32, z: f32| {
        // The frame of this sky: U = −X, V = Z, W = Y.
        sky.radiance(Vec3::new(-x, z, y).normalize())
    };
    assert_near(color(0.0, 0.0, 1.0), [0.49949, 0.79371, 1.42883], 1e-5);
    assert_near(color(1.0, 0.0, 0.2), [0.58893, 0.68277, 0.80381], 1e-5);
    assert_near(color(0.0, 1.0, 0.2), [1.26145, 1.19568, 1.27166], 1e-5);
    assert_near(color(-1.0, 0.0, 0.5), [1.13513, 1.31204, 1.78859], 1e-5);
}

#[test]
fn sun_and_sky_light_a_plane_as_in_the_reference() {
    // Check 6: a matte plane of albedo one half, facing up.
    let sky = Environment::sky(Vec3::Z, Vec3::Y, Vec3::ONE, 4.0, Some(Vec3::ZERO));
    let (direction, irradiance) = sun(Vec3::Z, Vec3::ONE, 4.0).expect("the sun is up");
    let total = mean_of_samples(&sky, |direction| direction.z.max(0.0)) + irradiance * direction.z;
    assert_near(total * (0.5 / std::f32::consts::PI), [0.5275, 0.6081, 0.8264], 5e-3);
}

#[test]
fn samples_of_a_sky_add_up_to_its_light() {
    let up = Vec3::new(0.2, -0.3, 1.0);
    for ground in [None, Some(Vec3::new(0.1, 0.2, 0.3)), Some(Vec3::ZERO)] {
        for (sundir, turbidity) in [(Vec3::new(1.0, 0.5, 0.4), 3.0), (Vec3::new(-0.3, 0.2, 1.0), 8.0)] {
            let environment = Environment::sky(up, Vec3::Y, sundir, turbidity, ground);
            // In gamut, where what is seen is what shines: the test compares those two.
            let expected = integral(|direction| environment.radiance(direction));
            assert_near(mean_of_samples(&environment, |_| 1.0), expected.into(), 1e-3);
        }
    }
}

#[test]
fn samples_of_a_picture_add_up_to_its_light() {
    // A dim gradient, and a sun of one pixel, whose black neighbours it lights by smoothing.
    let gradient = |x: u32, y: u32| [0.01 * x as f32, 0.02 * y as f32, 0.05];
    let with_sun = picture(24, 12, |x, y| if (x, y) == (17, 3) { [900.0, 700.0, 500.0] } else { gradient(x, y) });
    let only_sun = picture(24, 12, |x, y| if (x, y) == (3, 9) { [900.0, 700.0, 500.0] } else { [0.0; 3] });
    let single = picture(1, 1, |_, _| [0.3, 0.2, 0.1]);
    let column = picture(1, 7, |_, y| [y as f32; 3]);
    for map in [with_sun, only_sun, single, column, picture(9, 1, |x, _| gradient(x, x))] {
        let environment = Environment::picture(map, Vec3::new(1.0, -2.0, 0.3), Vec3::new(0.1, 0.2, 1.0));
        let expected = integral(|direction| environment.radiance(direction));
        assert_near(mean_of_samples(&environment, |_| 1.0), expected.into(), 1e-3);
    }
}

#[test]
fn samples_of_a_picture_tell_what_is_seen_there() {
    let map = picture(16, 8, |x, y| [x as f32, y as f32, 1.0]);
    let environment = Environment::picture(map, Vec3::X, Vec3::Z);
    let Surroundings::Panorama(panorama) = &environment.surroundings else { panic!("a picture was asked for") };
    for i in 0..400 {
        let uv = [(i % 20) as f32 / 20.0 + 0.013, (i / 20) as f32 / 20.0 + 0.021];
        let sight = panorama.unfold(uv);
        let seen = environment.radiance(sight.direction);
        assert!((seen - sight.radiance).abs().max_element() < 1e-3, "{uv:?}: {seen} and {}", sight.radiance);
    }
}

#[test]
fn a_picture_lies_with_its_middle_at_center_and_its_left_half_at_up_times_center() {
    // Columns in red, rows from the top in green.
    let map = picture(101, 51, |x, y| [x as f32 / 100.0, y as f32 / 50.0, 0.0]);
    // `up` needs not be at a right angle to `center`.
    let environment = Environment::picture(map.clone(), Vec3::new(0.0, -3.0, 0.0), Vec3::new(0.0, -1.0, 2.0));
    let (center, top) = (Vec3::NEG_Y, Vec3::Z);
    let left = top.cross(center);
    assert_near(environment.radiance(center), [0.5, 0.5, 0.0], 1e-3);
    assert_near(environment.radiance(left), [0.25, 0.5, 0.0], 1e-3);
    assert_near(environment.radiance(-left), [0.75, 0.5, 0.0], 1e-3);
    let near_top = (top + 0.01 * center).normalize();
    assert!(environment.radiance(near_top).y < 0.01 && environment.radiance(-near_top).y > 0.99);
    assert!(environment.radiance(top).y < 0.001, "the top edge does not wrap to the bottom");
    assert_eq!(map.smooth(Vec2::new(0.5, 0.0)).y, 1.0, "v = 0 is the bottom edge");
}

#[test]
fn degenerate_surroundings_do_not_panic_and_are_finite() {
    let directions = [Vec3::X, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z, Vec3::ZERO, Vec3::NAN, Vec3::INFINITY];
    let check = |environment: Environment| {
        for direction in directions {
            assert!(environment.radiance(direction).is_finite(), "{environment:?} {direction}");
        }
        for xi in [[0.0, 0.0], [1.0, 1.0], [0.5, 0.999_999_94], [f32::NAN, 0.3]] {
            if let Some((direction, weighted)) = environment.sample(xi) {
                assert!(direction.is_normalized() && weighted.is_finite(), "{direction} {weighted}");
            }
        }
    };
    let bad = [Vec3::ZERO, Vec3::NAN, Vec3::INFINITY, Vec3::splat(1e-30), Vec3::Z];
    for (i, vector) in bad.into_iter().enumerate() {
        let other = bad[(i + 1) % bad.len()];
        check(Environment::sky(vector, other, vector, 4.0, None));
        check(Environment::picture(picture(1, 1, |_, _| [1.0; 3]), vector, other));
        let _ = sun(vector, other, 4.0);
    }
    for turbidity in [f32::NAN, f32::INFINITY, -5.0, 0.0, 1.0, 113.0, 1e30] {
        for sundir in [Vec3::Z, Vec3::X, Vec3::NEG_Z] {
            check(Environment::sky(Vec3::Z, Vec3::Y, sundir, turbidity, None));
            let light = sun(Vec3::Z, sundir, turbidity);
            assert!(light.is_none_or(|(_, irradiance)| irradiance.is_finite()));
        }
    }
    check(Environment::picture(picture(4, 2, |_, _| [0.0; 3]), Vec3::X, Vec3::Z));
    check(Environment::picture(picture(2, 2, |x, _| [f32::MAX * x as f32, 0.0, 0.0]), Vec3::X, Vec3::Z));
}

#[test]
fn a_black_picture_sends_no_samples() {
    let environment = Environment::picture(picture(4, 2, |_, _| [0.0; 3]), Vec3::X, Vec3::Z);
    assert!((0..100).all(|i| environment.sample([0.01 * i as f32, 0.3]).is_none()));
}
