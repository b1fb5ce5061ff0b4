//! What every material promises, walked over the list of all.

#![allow(clippy::disallowed_methods, reason = "our functions are held against the platform's")]

use jaspe_noise::Dual;
use jaspe_noise::simd::Level;
use jaspe_texture::declare::{Kind, Value};
use jaspe_texture::{BuildError, Reliefs, Space, Texture};

fn defaults(name: &str) -> Texture {
    Texture::build(name, &[]).unwrap()
}

/// Every material, with its defaults and with each other noise and sum.
fn variants() -> Vec<(String, Texture)> {
    let mut variants = Vec::new();
    for declaration in Texture::ALL {
        for noise in ["improved", "classic", "lattice"] {
            for sum in ["absolute", "plain"] {
                let args = [("noise", Value::Choice(noise)), ("sum", Value::Choice(sum))];
                let texture = Texture::build(declaration.name, &args).unwrap();
                variants.push((format!("{} {noise} {sum}", declaration.name), texture));
            }
        }
    }
    assert_eq!(variants.len(), 36);
    variants
}

/// Numbers in [-1, 1), reproducible.
fn random_numbers() -> impl FnMut() -> f32 {
    let mut state = 88_172_645_463_325_252u64;
    move || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 40) as f32 / (1u64 << 23) as f32 - 1.0
    }
}

/// Three columns of coordinates within ± `scale`.
fn cube(count: usize, scale: f32) -> [Vec<f32>; 3] {
    let mut random = random_numbers();
    std::array::from_fn(|_| (0..count).map(|_| random() * scale).collect())
}

#[test]
fn coefficients_are_finite_and_in_range_near_and_far() {
    for (name, texture) in variants() {
        let [low, high] = texture.coefficient_range();
        for scale in [0.01, 1.0, 50.0, 1e4, 1e7] {
            let [x, y, z] = cube(2000, scale);
            let mut values = vec![f32::NAN; 2000];
            texture.evaluate([&x, &y, &z], &mut values);
            for value in values {
                assert!((low..=high).contains(&value), "{name} within ±{scale}: {value} is not in {low}..{high}");
            }
        }
    }
}

#[test]
fn coefficients_vary() {
    for (name, texture) in variants() {
        let [x, y, z] = cube(2000, 3.0);
        let mut values = vec![0.0; 2000];
        texture.evaluate([&x, &y, &z], &mut values);
        let least = values.iter().copied().fold(f32::MAX, f32::min);
        let most = values.iter().copied().fold(f32::MIN, f32::max);
        assert!(most - least > 0.3, "{name}: {least}..{most}");
    }
}

#[test]
fn coefficients_are_continuous_across_cells_and_at_negative_coordinates() {
    for (name, texture) in variants() {
        let frequency = f64::from(texture.frequencies().local);
        for axis in 0..3 {
            for cell in [-300, -5, -1, 0, 1, 255, 256] {
                for part in [0.0, 0.5, 0.25] {
                    // Just below and just above a face between cells of the first octaves.
                    let value = |step: f64| {
                        let mut point = [0.3, -0.6, 1.7];
                        point[axis] = (f64::from(cell) + part + step) / frequency;
                        texture.value(point)
                    };
                    let jump = (value(1e-9) - value(-1e-9)).abs();
                    let jump = if name.starts_with("wood") { jump.min(1.0 - jump) } else { jump };
                    assert!(jump < 1e-5, "{name}: jumps by {jump} at {cell} along {axis}");
                }
            }
        }
    }
}

#[test]
fn heights_have_no_jumps_and_their_slopes_are_exact() {
    let points = cube(3000, 4.0);
    let [x, y, z] = points.each_ref().map(Vec::as_slice);
    for (name, texture) in variants() {
        let cells = texture.in_cells([5, 7, 3, 0]).unwrap();
        for texture in [texture, cells] {
            let (mut coefficients, mut heights, mut alone) = (vec![0.0; 3000], vec![0.0; 3000], vec![0.0; 3000]);
            let [mut a, mut b, mut c] = [(); 3].map(|()| vec![0.0; 3000]);
            let slopes = [&mut a[..], &mut b[..], &mut c[..]];
            let reliefs = Reliefs { coefficients: &mut coefficients, heights: &mut heights, slopes };
            texture.reliefs([x, y, z], reliefs);
            texture.heights([x, y, z], &mut alone);
            let mut creases = 0;
            for i in 0..3000 {
                let point = [x[i], y[i], z[i]];
                assert_eq!(alone[i], texture.height(point), "{name}");
                assert_eq!(coefficients[i], texture.value(point), "{name}");
                assert!((heights[i] - alone[i]).abs() < 1e-5, "{name}");
                let exact = texture.height(Dual::point(point.map(f64::from)));
                let off = (0..3).map(|k| (exact.gradient[k] - f64::from([a[i], b[i], c[i]][k])).abs());
                // At a crease the last digit says which side a point is on.
                creases += usize::from(off.fold(0.0, f64::max) > 2e-3);
                // A tiny step changes the height by as much as the slope says: at the edges of wood's rings, too.
                let step = 1e-7;
                let moved = texture.height([f64::from(point[0]) + step, f64::from(point[1]), f64::from(point[2])]);
                assert!((moved - exact.value).abs() < 50.0 * step, "{name} jumps at {point:?}");
            }
            assert!(creases < 12, "{name}: {creases}");
        }
    }
}

#[test]
fn textures_in_cells_repeat_in_four_dimensions() {
    for (name, texture) in variants() {
        let texture = texture.in_cells([5, 7, 3, 2]).unwrap();
        for i in 0..40 {
            let step = f64::from(i);
            let point = [0.31 * step, 0.47 * step - 9.0, 0.13 * step, 0.71 * step];
            let here: f64 = texture.value(point);
            for (axis, period) in [5.0, 7.0, 3.0, 2.0].into_iter().enumerate() {
                let mut there = point;
                there[axis] += period;
                let off = (texture.value(there) - here).abs();
                let off = if name.starts_with("wood") { off.min(1.0 - off) } else { off };
                assert!(off < 1e-9, "{name} along {axis}: {off}");
            }
        }
        let bands = texture.bands(5.0);
        assert_eq!(bands.is_some(), name.starts_with("marble"));
        assert!(bands.is_none_or(|bands| (bands - 1.0).abs() < 1e-12), "{bands:?}");
    }
}

#[test]
fn finishes_are_within_their_ranges() {
    for declaration in Texture::ALL {
        let finish = defaults(declaration.name).finish();
        assert!(finish.relief > 0.0 && finish.tile > 0.0 && finish.emission >= 0.0);
        assert!(finish.roughness.iter().all(|end| (0.0..=1.0).contains(end)));
    }
}

#[test]
fn every_level_and_length_gives_the_same_bits() {
    let points = cube(700, 20.0);
    for (name, texture) in variants() {
        let expected: Vec<f32> = (0..700).map(|i| texture.value([points[0][i], points[1][i], points[2][i]])).collect();
        let flat: Vec<f32> = (0..700).map(|i| texture.value([points[0][i], points[1][i]])).collect();
        for level in Level::ALL {
            for (start, count) in [(0, 700), (0, 1), (3, 17), (5, 64), (100, 255), (9, 256), (200, 257), (8, 0)] {
                let at = start..start + count;
                let mut values = vec![f32::MAX; count];
                let [x, y, z] = points.each_ref().map(|axis| &axis[at.clone()]);
                texture.evaluate_at(level, [x, y, z], &mut values);
                assert_eq!(values, expected[at.clone()], "{name} at {level:?}, {count} points");
                texture.evaluate_at(level, [x, y], &mut values);
                assert_eq!(values, flat[at], "{name} at {level:?}, {count} points of the plane");
            }
        }
    }
}

#[test]
fn what_is_too_far_to_be_seen_is_the_mean() {
    const COUNT: usize = 20_000;
    for (name, texture) in variants() {
        let [x, y, z] = cube(COUNT, 50.0);
        let points = [&x[..], &y, &z];
        let [mut near, mut sharp, mut far] = [(); 3].map(|()| vec![f32::NAN; COUNT]);
        texture.evaluate(points, &mut near);
        texture.evaluate_seen(points, &[0.0; COUNT], &mut sharp);
        assert!(near.iter().zip(&sharp).all(|(near, sharp)| near.to_bits() == sharp.to_bits()), "{name}");
        texture.evaluate_seen(points, &[1e3; COUNT], &mut far);
        let mean = near.iter().map(|&value| f64::from(value)).sum::<f64>() / COUNT as f64;
        let spread = far.iter().map(|&value| (f64::from(value) - mean).abs()).fold(0.0, f64::max);
        assert!(spread < 0.1, "{name}: up to {spread} off the mean {mean}");
        // What is half seen lies between.
        let cell = 1.0 / texture.frequencies().of(Space::Local);
        let mut seen = vec![f32::NAN; COUNT];
        texture.evaluate_seen(points, &vec![0.3 * cell; COUNT], &mut seen);
        let variance =
            |values: &[f32]| values.iter().map(|&value| (f64::from(value) - mean).powi(2)).sum::<f64>() / COUNT as f64;
        assert!(variance(&seen) < variance(&near), "{name}: {} {}", variance(&seen), variance(&near));
    }
}

#[test]
fn bytes_hardly_show_the_octaves_that_are_left_out() {
    for declaration in Texture::ALL {
        for sum in ["absolute", "plain"] {
            let whole =
                Texture::build(declaration.name, &[("depth", Value::Int(20)), ("sum", Value::Choice(sum))]).unwrap();
            let seen = whole.clone().in_bytes();
            let octaves = seen.sum().octaves();
            let is_wood = declaration.name == "wood";
            assert!(
                if is_wood { octaves == 20 } else { (7..12).contains(&octaves) },
                "{}: {octaves}",
                declaration.name
            );
            let mut number = random_numbers();
            for _ in 0..2000 {
                let point = [number(), number(), number()];
                let [a, b] = [&whole, &seen].map(|texture| texture.color(texture.value(point)));
                let difference = a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
                assert!(difference <= 1.0 / 255.0, "{}: {difference}", declaration.name);
            }
            // What is of few octaves stays as it is.
            let few = defaults(declaration.name);
            assert_eq!(few.clone().in_bytes(), few);
        }
    }
}

#[test]
fn the_shapes_are_those_of_the_figures() {
    let point = [0.31f32, -0.52, 0.77];
    for declaration in Texture::ALL {
        for (sum_name, plain) in [("absolute", false), ("plain", true)] {
            let args = [("sum", Value::Choice(sum_name)), ("space", Value::Choice("local"))];
            let moved = Texture::build(declaration.name, &args).unwrap();
            let offset = if declaration.name == "wood" { 0.0 } else { 1.0 / 3.0 };
            for (texture, offset) in [(moved.clone().in_figure_space(), 0.0), (moved, offset)] {
                let scaled = point.map(|coordinate| coordinate * texture.frequencies().local);
                let sum = f64::from(texture.sum().value(scaled.map(|coordinate| coordinate + offset)));
                let along = f64::from(scaled[0]) + sum;
                let expected = match (declaration.name, plain) {
                    ("marble", false) => along.cos(),
                    ("marble", true) => along.sin(),
                    ("wood", _) => (15.0 * sum).rem_euclid(1.0),
                    _ => sum,
                };
                let found = f64::from(texture.value(point));
                assert!((found - expected).abs() < 2e-6, "{} {sum_name}: {found}, {expected}", declaration.name);
            }
        }
    }
}

/// On a plane of its lattice, gradient noise runs in streaks along the axes. A floor at y = 0 must not show them: its
/// mean is that of any other plane, and so is the share of points where the noise vanishes.
#[test]
fn a_plane_through_the_origin_is_like_any_other() {
    let statistics = |y: f32| {
        let texture = Texture::build("organic", &[("scale", Value::Float(0.37))]).unwrap();
        let coordinates: Vec<[f32; 2]> =
            (0..40_000).map(|i| [(i % 200) as f32 * 0.0731, (i / 200) as f32 * 0.0731]).collect();
        let axis = |k: usize| coordinates.iter().map(|c| c[k]).collect::<Vec<f32>>();
        let mut values = vec![0.0; coordinates.len()];
        texture.evaluate([&axis(0), &vec![y; coordinates.len()], &axis(1)], &mut values);
        let mean = values.iter().sum::<f32>() / values.len() as f32;
        [mean, values.iter().filter(|value| **value < 0.1).count() as f32 / values.len() as f32]
    };
    let [mean, veins] = statistics(0.0);
    let [other_mean, other_veins] = statistics(0.519);
    assert!((mean - other_mean).abs() < 0.02, "{mean}, {other_mean}");
    assert!((veins - other_veins).abs() < 0.006, "{veins}, {other_veins}");
}

/// The distributions over a sphere that the reference description of the original system states: material, octaves, mean,
/// standard deviation, and how much the mean moves from table to table.
const DISTRIBUTIONS: [(&str, i64, f64, f64, f64); 10] = [
    ("fire", 4, 0.386, 0.173, 0.016),
    ("fire", 5, 0.399, 0.173, 0.016),
    ("fire", 9, 0.411, 0.173, 0.016),
    ("water", 4, 0.386, 0.173, 0.016),
    ("water", 5, 0.399, 0.173, 0.016),
    ("stone", 4, 0.412, 0.180, 0.005),
    ("stone", 9, 0.439, 0.181, 0.005),
    ("organic", 9, 0.439, 0.181, 0.020),
    ("marble", 5, -0.049, 0.715, 0.006),
    ("wood", 5, 0.500, 0.289, 0.004),
];

#[test]
fn distributions_over_a_sphere_are_those_of_the_reference() {
    const COUNT: usize = 4000;
    let mut random = random_numbers();
    let mut directions: [Vec<f32>; 3] = Default::default();
    while directions[0].len() < COUNT {
        let v = [random(), random(), random()];
        let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
        if (0.01..=1.0).contains(&length) {
            (0..3).for_each(|axis| directions[axis].push(v[axis] / length));
        }
    }
    for (name, depth, mean, deviation, moves) in DISTRIBUTIONS {
        let (mut sum, mut squares) = (0.0, 0.0);
        const SEEDS: i64 = 30;
        for seed in 1..=SEEDS {
            let args = [("depth", Value::Int(depth)), ("seed", Value::Int(seed))];
            let texture = Texture::build(name, &args).unwrap().in_figure_space();
            let mut values = vec![0.0; COUNT];
            match texture.space() {
                Space::Uv => {
                    // The original's map of a sphere: u = (x + 1) / 4, v = acos(y) / π.
                    let u: Vec<f32> = directions[0].iter().map(|x| (x + 1.0) / 4.0).collect();
                    let v: Vec<f32> = directions[1].iter().map(|y| y.acos() / std::f32::consts::PI).collect();
                    texture.evaluate([&u, &v], &mut values);
                }
                Space::Local => texture.evaluate(directions.each_ref().map(Vec::as_slice), &mut values),
                Space::World => {
                    // Organic's figures: a sphere of the radius 1.5 somewhere.
                    let offset = [1.3 * seed as f32, 0.7, -2.1];
                    let points: [Vec<f32>; 3] =
                        std::array::from_fn(|i| directions[i].iter().map(|c| 1.5 * c + offset[i]).collect());
                    texture.evaluate(points.each_ref().map(Vec::as_slice), &mut values);
                }
            }
            sum += values.iter().map(|&v| f64::from(v)).sum::<f64>();
            squares += values.iter().map(|&v| f64::from(v) * f64::from(v)).sum::<f64>();
        }
        let count = COUNT as f64 * SEEDS as f64;
        let found = sum / count;
        let spread = (squares / count - found * found).sqrt();
        assert!((found - mean).abs() < 3.0 * moves, "{name} {depth}: mean {found}, expected {mean}");
        assert!((spread - deviation).abs() < 0.02, "{name} {depth}: deviation {spread}, expected {deviation}");
    }
}

#[test]
fn colors_mix_initial_and_final_and_are_clamped() {
    let texture = defaults("marble");
    assert_eq!(texture.color(1.0), [0.466_667, 0.34, 0.066_666]);
    assert_eq!(texture.color(0.0), [0.913_725_5, 0.705_882_4, 0.633_333_3]);
    let beyond = texture.color(-1.0);
    assert_eq!((beyond[0], beyond[1], beyond[2]), (1.0, 1.0, 1.0));
    assert_eq!(texture.color(100.0), [0.0; 3]);
    assert_eq!(texture.color(f32::NAN), [0.0; 3]);
}

#[test]
fn colors_follow_the_coefficients() {
    for declaration in Texture::ALL {
        let texture = defaults(declaration.name);
        let [x, y, z] = cube(600, 2.0);
        let (mut coefficients, mut colors) = (vec![0.0; 600], vec![[0.0; 3]; 600]);
        texture.evaluate([&x, &y, &z], &mut coefficients);
        texture.colors([&x, &y, &z], &mut colors);
        let expected: Vec<[f32; 3]> = coefficients.iter().map(|&w| texture.color(w)).collect();
        assert_eq!(colors, expected);
    }
}

#[test]
fn scale_and_space_change_the_size() {
    let point = [0.4f32, 0.8, -1.2];
    for declaration in Texture::ALL {
        let plain = defaults(declaration.name);
        let twice = Texture::build(declaration.name, &[("scale", Value::Float(2.0))]).unwrap();
        assert_eq!(twice.value(point.map(|c| 2.0 * c)), plain.value(point), "{}", declaration.name);
        for &space in Space::ALL {
            let there = Texture::build(declaration.name, &[("space", Value::Choice(space.name()))]).unwrap();
            assert_eq!((there.space(), there.written_space()), (space, Some(space)));
            assert_eq!(there.clone().in_figure_space().space(), space);
            let ratio = there.frequencies().of(space) / there.frequencies().local;
            let close = there.value(point.map(|c| f64::from(c / ratio))) - plain.value(point.map(f64::from));
            assert!(close.abs() < 1e-3 || declaration.name == "wood", "{} in {space:?}", declaration.name);
        }
        assert_eq!(plain.space(), Space::Local);
        assert_eq!(plain.clone().in_figure_space().space(), plain.figure_space());
    }
}

#[test]
fn seeds_give_other_pieces_and_the_same_seed_the_same() {
    for declaration in Texture::ALL {
        let of = |seed| Texture::build(declaration.name, &[("seed", Value::Int(seed))]).unwrap();
        let point = [0.137f32, 0.521, 0.733];
        assert_ne!(of(1).value(point), of(2).value(point));
        assert_eq!(of(7).value(point), of(7).value(point));
    }
}

#[test]
fn declarations_are_complete_and_their_defaults_are_within_their_ranges() {
    let names: Vec<&str> = Texture::ALL.iter().map(|declaration| declaration.name).collect();
    assert_eq!(names, ["fire", "water", "organic", "wood", "marble", "stone"]);
    for declaration in Texture::ALL {
        assert!(declaration.summary.ends_with('.'));
        for parameter in declaration.parameters {
            assert!(parameter.summary.ends_with('.'), "{}", parameter.name);
            if parameter.default == Value::Auto {
                assert_eq!(parameter.name, "space");
            } else {
                assert_eq!(parameter.check(parameter.default), Ok(parameter.default));
                assert_eq!(parameter.parse(&parameter.default.to_string()), Ok(parameter.default));
            }
            if let Kind::Choice(words) = parameter.kind {
                for word in words {
                    let texture = Texture::build(declaration.name, &[(parameter.name, Value::Choice(word))]).unwrap();
                    let written = match parameter.name {
                        "noise" => texture.sum().noise().basis().name(),
                        "sum" => texture.sum().combine().name(),
                        _ => texture.space().name(),
                    };
                    assert_eq!(written, *word);
                }
            }
        }
    }
    assert_eq!((defaults("wood").reflection(), defaults("water").reflection()), (0.1, 0.2));
    assert_eq!(defaults("stone").reflection(), 0.0);
}

#[test]
fn wrong_arguments_are_told() {
    let message = |name: &str, args: &[(&str, Value)]| Texture::build(name, args).unwrap_err().to_string();
    assert_eq!(message("jade", &[]), "unknown texture `jade`");
    assert_eq!(message("wood", &[("dept", Value::Int(3))]), "`wood` has no parameter `dept`");
    assert_eq!(message("wood", &[("depth", Value::Int(99))]), "`depth` takes a whole number from 0 to 32, found 99");
    assert_eq!(
        message("wood", &[("scale", Value::Float(f64::NAN))]),
        "`scale` takes a number from 0.000001 to 1000000, found NaN"
    );
    assert_eq!(
        message("wood", &[("diffuse_initial", Value::Color([0.0, 2.0, 0.0]))]),
        "`diffuse_initial` takes a colour of three components from 0 to 1, found 0 2 0"
    );
    assert_eq!(
        message("wood", &[("space", Value::Choice("moon"))]),
        "`space` takes one of `local`, `world`, `uv`, found moon"
    );
    assert_eq!(
        message("wood", &[("seed", Value::Auto)]),
        "`seed` takes a whole number from 0 to 9223372036854775807, found auto"
    );
}

#[test]
fn text_is_read_as_the_parameter_takes_it() {
    let declaration = Texture::ALL[0];
    let parse = |name: &str, text: &str| declaration.parameter(name).unwrap().parse(text);
    assert_eq!(parse("depth", "7"), Ok(Value::Int(7)));
    assert_eq!(parse("scale", "0.5"), Ok(Value::Float(0.5)));
    assert_eq!(parse("diffuse_final", "1, 0.5 0"), Ok(Value::Color([1.0, 0.5, 0.0])));
    assert_eq!(parse("noise", "classic"), Ok(Value::Choice("classic")));
    for (name, text) in
        [("depth", "7.5"), ("depth", "-1"), ("scale", "inf"), ("diffuse_final", "1 1"), ("noise", "pink")]
    {
        let error = parse(name, text).unwrap_err();
        assert!(matches!(&error, BuildError::Refused { found, .. } if *found == format!("`{text}`")), "{error}");
    }
}
