//! Every instruction set, every basis and sum, every length of a batch: the same bits.

use std::time::{Duration, Instant};

use jaspe_noise::simd::{Kernel, Level, deinterleave_at, machine_level, map_at};
use jaspe_noise::{Basis, Cellular, Combine, Feature, Field, Integer, Metric, Noise, Real, Sum, math};

/// Points near and far, on lattice points and beside them, and no numbers at all.
fn coordinates(count: usize, salt: u64) -> Vec<f32> {
    let mut state = 0x9e37_79b9_7f4a_7c15u64.wrapping_mul(salt + 1);
    let special =
        [0.0, -0.0, 1.0, -1.0, 0.5, -1e-10, 255.99, -256.0, 1e9, -3e9, 1e20, f32::MAX, f32::NAN, f32::INFINITY];
    (0..count)
        .map(|i| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let unit = (state >> 40) as f32 / (1 << 23) as f32 - 1.0;
            match (i as u64 + salt) % 19 {
                0 => special[(state >> 20) as usize % special.len()],
                1..=3 => (unit * 1000.0).floor(),
                4..=6 => unit * 1e6,
                _ => unit * 40.0,
            }
        })
        .collect()
}

fn same(a: f32, b: f32) -> bool {
    a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan()
}

/// Runs `fill` at every level and on pieces of many lengths, and holds all results to `expected`.
fn check(name: &str, expected: &[f32], fill: impl Fn(Level, std::ops::Range<usize>, &mut [f32])) {
    for level in Level::ALL {
        let mut values = vec![f32::MAX; expected.len()];
        fill(level, 0..expected.len(), &mut values);
        let wrong = (0..expected.len()).find(|&i| !same(values[i], expected[i]));
        assert_eq!(wrong, None, "{name} at {level:?}: {:?}", wrong.map(|i| (values[i], expected[i])));
        let mut start = 0;
        for length in (0..140).chain([255, 256, 257, 400, 512, 520, 536, 600]) {
            let mut values = vec![f32::MAX; length];
            fill(level, start..start + length, &mut values);
            let wrong = (0..length).find(|&i| !same(values[i], expected[start + i]));
            assert_eq!(wrong, None, "{name} at {level:?}, {length} points");
            start = (start + length) % 3000;
        }
    }
}

#[test]
fn every_basis_and_sum_has_the_same_bits_at_every_level() {
    let [x, y, z] = [1, 2, 3].map(|salt| coordinates(4000, salt));
    for &basis in Basis::ALL {
        for (seed, period) in [(0, [0; 3]), (9, [3, 0, 300])] {
            let Ok(noise) = Noise::new(basis, seed).with_period(period) else { continue };
            let name = format!("{basis:?} {period:?}");
            let expected: Vec<f32> = (0..4000).map(|i| noise.value([x[i], y[i], z[i]])).collect();
            check(&name, &expected, |level, at, values| {
                noise.fill_at(level, [&x[at.clone()], &y[at.clone()], &z[at]], values);
            });
            let expected: Vec<f32> = (0..4000).map(|i| noise.value([x[i], y[i]])).collect();
            check(&name, &expected, |level, at, values| noise.fill_at(level, [&x[at.clone()], &y[at]], values));
            for &combine in Combine::ALL {
                let sum = Sum::new(noise.clone(), combine, 6);
                let expected: Vec<f32> = (0..4000).map(|i| sum.value([x[i], y[i], z[i]])).collect();
                check(&format!("{name} {combine:?}"), &expected, |level, at, values| {
                    sum.fill_at(level, [&x[at.clone()], &y[at.clone()], &z[at]], values);
                });
                let expected: Vec<f32> = (0..4000).map(|i| sum.value([x[i], y[i]])).collect();
                check(&format!("{name} {combine:?}"), &expected, |level, at, values| {
                    sum.fill_at(level, [&x[at.clone()], &y[at]], values);
                });
            }
        }
    }
}

/// Holds values and gradients over slices to the evaluation one by one, in any number of dimensions, at every level.
fn check_dimensions<const D: usize>(basis: Basis) {
    let columns: [Vec<f32>; D] = std::array::from_fn(|axis| coordinates(700, 20 + axis as u64));
    let points = columns.each_ref().map(Vec::as_slice);
    for period in [[0; D], std::array::from_fn(|axis| [3, 0, 300, 7][axis])] {
        let Ok(noise) = Noise::new(basis, 4).with_period(period) else { continue };
        for combine in [None].into_iter().chain(Combine::ALL.iter().copied().map(Some)) {
            // Without a combination, the noise alone.
            let sum = Sum::new(noise.clone(), combine.unwrap_or(Combine::Plain), 3).with_lacunarity(1.9);
            let one_by_one: Vec<(f32, [f32; D])> = (0..700)
                .map(|i| {
                    let point = columns.each_ref().map(|axis| axis[i]);
                    let value = if combine.is_none() { noise.value(point) } else { sum.value(point) };
                    let with_gradient =
                        if combine.is_none() { noise.value_and_gradient(point) } else { sum.value_and_gradient(point) };
                    assert!(same(value, with_gradient.0), "{basis:?} {combine:?} in {D}: {with_gradient:?}, {value}");
                    with_gradient
                })
                .collect();
            for level in Level::ALL {
                let name = format!("{basis:?} {period:?} {combine:?} at {level:?}");
                let (mut values, mut slopes) = (vec![1.0; 700], [(); D].map(|()| vec![1.0; 700]));
                let gradient = slopes.each_mut().map(Vec::as_mut_slice);
                if combine.is_none() {
                    noise.fill_with_gradient_at(level, points, &mut values, gradient);
                } else {
                    sum.fill_with_gradient_at(level, points, &mut values, gradient);
                }
                let mut alone = vec![1.0; 700];
                if combine.is_none() {
                    noise.fill_at(level, points, &mut alone);
                } else {
                    sum.fill_at(level, points, &mut alone);
                }
                for (i, (value, slope)) in one_by_one.iter().enumerate() {
                    assert!(same(alone[i], *value), "{name}, point {i}: {} {value}", alone[i]);
                    assert!(same(values[i], *value), "{name}, point {i}");
                    assert!((0..D).all(|axis| same(slopes[axis][i], slope[axis])), "{name}, point {i}: {slope:?}");
                }
            }
        }
    }
}

#[test]
fn gradients_have_the_same_bits_at_every_level_in_every_number_of_dimensions() {
    for &basis in Basis::ALL {
        check_dimensions::<1>(basis);
        check_dimensions::<2>(basis);
        check_dimensions::<3>(basis);
        check_dimensions::<4>(basis);
    }
}

/// One of the elementary functions, by its place in a list.
struct Function(usize);

impl Kernel<2> for Function {
    #[inline(always)]
    fn run<R: Real>(&self, [x, y]: [R; 2]) -> R {
        match self.0 {
            0 => math::sin(x),
            1 => math::cos(x),
            2 => math::exp(x),
            3 => math::ln(x),
            4 => math::pow(x, y),
            5 => x.abs().sqrt(),
            6 => x.min(y) - x.max(y) * x / y,
            7 => R::select(!x.less(y) & x.less(R::constant(9.0)) | y.less(x), -x, y),
            _ => {
                let bounded =
                    R::select(x.abs().less(R::constant(1e9)), x, y.min(R::constant(1e9)).max(R::constant(-1e9)));
                let (a, b) = (bounded.floor().to_int(), R::Int::constant(0x2545_f491));
                let mixed = (a * b) ^ (a - b).shift_right(7) ^ (a | b).shift_left(3);
                R::from_int(mixed & R::Int::constant(0x00ff_ffff))
            }
        }
    }
}

#[test]
fn numbers_and_elementary_functions_have_the_same_bits_at_every_level() {
    let [x, y] = [4, 5].map(|salt| coordinates(4000, salt));
    for index in 0..9 {
        let function = Function(index);
        let expected: Vec<f32> = (0..4000).map(|i| function.run([x[i], y[i]])).collect();
        check(&format!("function {index}"), &expected, |level, at, values| {
            map_at(level, &function, [&x[at.clone()], &y[at]], values);
        });
    }
}

#[test]
fn any_lacunarity_gain_and_fraction_has_the_same_bits_at_every_level() {
    let [x, y, z] = [12, 13, 14].map(|salt| coordinates(4000, salt));
    for basis in [Basis::Improved, Basis::Value] {
        for combine in Combine::ALL {
            for octaves in [0.0, 0.3, 1.0, 1.7, 4.6] {
                let sum = Sum::new(Noise::new(basis, 3), *combine, 0);
                let sum = sum.with_octaves(octaves).with_lacunarity(2.17).with_gain(0.61);
                let expected: Vec<f32> = (0..4000).map(|i| sum.value([x[i], y[i], z[i]])).collect();
                check(&format!("{sum:?}"), &expected, |level, at, values| {
                    sum.fill_at(level, [&x[at.clone()], &y[at.clone()], &z[at]], values);
                });
                assert!((0..300).all(|i| same(sum.at([x[i], y[i], z[i]]), expected[i])));
            }
        }
    }
}

#[test]
fn every_cellular_noise_has_the_same_bits_at_every_level() {
    let [x, y, z] = [9, 10, 11].map(|salt| coordinates(1000, salt));
    for metric in [Metric::Euclidean, Metric::Manhattan, Metric::Chebyshev] {
        for feature in [Feature::First, Feature::Second, Feature::Difference, Feature::Cell] {
            let cellular = Cellular { metric, feature, jitter: 0.7 };
            let noise = Noise::new(Basis::Cellular, 1).with_cellular(cellular);
            let expected: Vec<f32> = (0..1000).map(|i| noise.value([x[i], y[i], z[i]])).collect();
            for level in Level::ALL {
                let mut values = vec![0.0; 1000];
                noise.fill_at(level, [&x, &y, &z], &mut values);
                assert!((0..1000).all(|i| same(values[i], expected[i])), "{cellular:?} at {level:?}");
            }
        }
    }
}

#[test]
fn single_points_have_the_bits_of_batches() {
    let [x, y, z] = [6, 7, 8].map(|salt| coordinates(2000, salt));
    for &basis in Basis::ALL {
        for period in [[0; 3], [5, 0, 9]] {
            let Ok(noise) = Noise::new(basis, 2).with_period(period) else { continue };
            let octaves = |combine| if combine == Combine::Absolute { 20 } else { 5 };
            let sums = Combine::ALL.iter().map(|&combine| Sum::new(noise.clone(), combine, octaves(combine)));
            let sums: Vec<Sum> = sums.collect();
            for i in 0..2000 {
                let point = [x[i], y[i], z[i]];
                assert!(same(noise.at(point), noise.value(point)), "{basis:?} at {point:?}");
                assert!(same(noise.at([x[i], y[i]]), noise.value([x[i], y[i]])), "{basis:?} at {point:?}");
                assert!(same(noise.at([x[i]]), noise.value([x[i]])), "{basis:?} at {}", x[i]);
                for sum in &sums {
                    assert!(same(sum.at(point), sum.value(point)), "{sum:?} at {point:?}");
                    assert!(same(sum.at([x[i], y[i]]), sum.value([x[i], y[i]])), "{sum:?} at {point:?}");
                    assert!(same(sum.at([x[i]]), sum.value([x[i]])), "{sum:?} at {}", x[i]);
                    let four = [x[i], y[i], z[i], x[1999 - i]];
                    assert!(same(sum.at(four), sum.value(four)), "{sum:?} at {four:?}");
                }
            }
        }
    }
}

#[test]
fn single_points_have_the_bits_of_batches_at_every_level() {
    for level in Level::ALL {
        let mut test = std::process::Command::new(std::env::current_exe().unwrap());
        test.args(["--exact", "single_points_have_the_bits_of_batches"]).env("JASPE_SIMD", level.name());
        let output = test.output().unwrap();
        assert!(output.status.success(), "{level:?}: {}", String::from_utf8_lossy(&output.stdout));
        assert!(String::from_utf8_lossy(&output.stdout).contains("1 passed"), "the test is there");
    }
}

/// The least time that a noise takes for values and gradients at some points.
fn least_time<const D: usize>(noise: &Noise, level: Level) -> Duration {
    let columns: [Vec<f32>; D] = std::array::from_fn(|axis| coordinates(256, 30 + axis as u64));
    let points = columns.each_ref().map(Vec::as_slice);
    let mut values = vec![0.0; 256];
    let mut gradient: [Vec<f32>; D] = std::array::from_fn(|_| vec![0.0; 256]);
    let times = (0..20).map(|_| {
        let start = Instant::now();
        noise.fill_at(level, points, &mut values);
        noise.fill_with_gradient_at(level, points, &mut values, gradient.each_mut().map(Vec::as_mut_slice));
        start.elapsed()
    });
    times.min().unwrap()
}

#[test]
fn vectors_take_less_time_than_numbers_one_by_one() {
    // (A call that is left in a kernel costs more than its arithmetic: all registers go through memory. In four dimensions
    // closures were such calls, and vectors took four times as long as numbers one by one.)
    let wide = Level::ALL.into_iter().filter(|&level| level >= Level::Avx2 && level <= machine_level());
    let wide: Vec<Level> = wide.collect();
    for &basis in Basis::ALL {
        let noise = Noise::new(basis, 0);
        let times = |level| {
            [
                least_time::<1>(&noise, level),
                least_time::<2>(&noise, level),
                least_time::<3>(&noise, level),
                least_time::<4>(&noise, level),
            ]
        };
        let one_by_one = times(Level::Scalar);
        for &level in &wide {
            for (dimensions, (vectors, numbers)) in (1..).zip(times(level).into_iter().zip(one_by_one)) {
                let name = format!("{basis:?} in {dimensions} dimensions at {level:?}");
                assert!(vectors < numbers, "{name}: {vectors:?}, {numbers:?} one by one");
            }
        }
    }
}

#[test]
fn levels_have_names_and_stay_within_the_machines() {
    for level in Level::ALL {
        assert_eq!(Level::from_name(level.name()), Some(level));
    }
    assert!(jaspe_noise::simd::level() <= machine_level());
}

#[test]
#[should_panic(expected = "all slices have the same length")]
fn slices_of_different_lengths_are_refused() {
    Noise::new(Basis::Improved, 0).fill([&[0.0; 3], &[0.0; 2]], &mut [0.0; 3]);
}

#[test]
fn points_are_taken_apart_at_every_level() {
    for count in (0..140).chain([1000]) {
        let points: Vec<[f32; 3]> = (0..count).map(|i| [0.0, 0.25, 0.5].map(|part| i as f32 + part)).collect();
        for level in Level::ALL {
            let mut columns = [vec![-1.0; count], vec![-1.0; count], vec![-1.0; count]];
            deinterleave_at(level, &points, columns.each_mut().map(Vec::as_mut_slice));
            for (axis, column) in columns.iter().enumerate() {
                let wrong = (0..count).find(|&i| column[i] != points[i][axis]);
                assert_eq!(wrong, None, "{level:?}, axis {axis} of {count} points");
            }
        }
    }
}

#[test]
fn points_that_lie_one_after_the_other_have_the_same_values() {
    let points: Vec<[f32; 3]> = (0..1000).map(|i| [0.37, -1.13, 0.71].map(|step| i as f32 * step - 99.0)).collect();
    let columns: [Vec<f32>; 3] = std::array::from_fn(|axis| points.iter().map(|point| point[axis]).collect());
    let improved = Noise::new(Basis::Improved, 3);
    let fields = [
        Field::from(improved.clone()),
        Field::from(improved.clone().with_period([5, 0, 0]).expect("a short period")),
        Field::from(Noise::new(Basis::Simplex, 0)),
        Field::from(Sum::new(improved, Combine::Absolute, 3)),
    ];
    for field in &fields {
        for level in Level::ALL {
            for count in (0..140).chain([577, 1000]) {
                let (mut values, mut expected) = (vec![-9.0; count], vec![9.0; count]);
                field.fill_points_at(level, &points[..count], &mut values);
                field.fill_at(level, columns.each_ref().map(|column| &column[..count]), &mut expected);
                assert_eq!(values, expected, "{field:?} at {level:?}, {count} points");
            }
        }
    }
}

/// Slices that do not fit the caches go another way.
#[test]
fn a_million_points_have_the_same_bits() {
    let count = (1 << 20) + 1234;
    let [x, y, z] = [1, 2, 3].map(|salt| coordinates(count, salt));
    for combine in [Combine::Plain, Combine::Absolute] {
        let sum = Sum::new(Noise::new(Basis::Improved, 0), combine, 2);
        for level in Level::ALL {
            let mut values = [vec![0.0; count], vec![0.0; count]];
            let [whole, pieces] = &mut values;
            sum.fill_at(level, [&x, &y, &z], whole);
            for (piece, start) in pieces.chunks_mut(1000).zip((0..).step_by(1000)) {
                let at = start..start + piece.len();
                sum.fill_at(level, [&x[at.clone()], &y[at.clone()], &z[at]], piece);
            }
            assert!(whole.iter().zip(pieces.iter()).all(|(a, b)| same(*a, *b)), "{combine:?} at {level:?}");
        }
    }
}
