//! Values that are known from elsewhere, and properties that hold everywhere.

#![allow(clippy::approx_constant, reason = "3.14 is a coordinate of a published check value")]

mod common;

use common::random_bits;
use jaspe_noise::{Basis, Cellular, Combine, Feature, Metric, Noise, Sum};

/// Improved noise as [Perlin 2002] tells it in prose and tables, apart from the crate's code: hashing by a doubled table
/// of the seed's permutation, gradients as vectors.
struct Listing {
    table: Vec<u8>,
}

impl Listing {
    /// The gradients in the order of the hash values: twelve edges, and four of them again.
    const GRADIENTS: [[f64; 3]; 16] = [
        [1.0, 1.0, 0.0],
        [-1.0, 1.0, 0.0],
        [1.0, -1.0, 0.0],
        [-1.0, -1.0, 0.0],
        [1.0, 0.0, 1.0],
        [-1.0, 0.0, 1.0],
        [1.0, 0.0, -1.0],
        [-1.0, 0.0, -1.0],
        [0.0, 1.0, 1.0],
        [0.0, -1.0, 1.0],
        [0.0, 1.0, -1.0],
        [0.0, -1.0, -1.0],
        [1.0, 1.0, 0.0],
        [0.0, -1.0, 1.0],
        [-1.0, 1.0, 0.0],
        [0.0, -1.0, -1.0],
    ];

    fn new() -> Self {
        let text = include_str!("permutation.txt");
        let once: Vec<u8> = text.split_whitespace().map(|number| number.parse().unwrap()).collect();
        assert_eq!(once.len(), 256);
        Listing { table: [once.clone(), once].concat() }
    }

    fn hash(&self, corner: [i64; 3]) -> u8 {
        let [x, y, z] = corner.map(|coordinate| coordinate.rem_euclid(256) as usize);
        let at_x = usize::from(self.table[x]);
        let at_xy = usize::from(self.table[at_x + y]);
        self.table[at_xy + z]
    }

    /// Also tells which gradients took part.
    fn value(&self, point: [f64; 3], seen: &mut [bool; 16]) -> f64 {
        let cell = point.map(|coordinate| coordinate.floor());
        let mut dots = [0.0; 8];
        for (i, dot) in dots.iter_mut().enumerate() {
            let step = [i & 1, i >> 1 & 1, i >> 2 & 1];
            let corner = std::array::from_fn(|axis| cell[axis] as i64 + step[axis] as i64);
            let gradient = usize::from(self.hash(corner) % 16);
            seen[gradient] = true;
            for axis in 0..3 {
                *dot += Self::GRADIENTS[gradient][axis] * (point[axis] - cell[axis] - step[axis] as f64);
            }
        }
        let weight = |axis: usize| {
            let t = point[axis] - cell[axis];
            t * t * t * (t * (t * 6.0 - 15.0) + 10.0)
        };
        // Halve the corners axis by axis.
        let mut count = 8;
        for axis in 0..3 {
            count /= 2;
            for i in 0..count {
                dots[i] = dots[2 * i] + weight(axis) * (dots[2 * i + 1] - dots[2 * i]);
            }
        }
        dots[0]
    }
}

/// Numbers in [-1, 1), reproducible.
fn random_numbers() -> impl FnMut() -> f64 {
    let mut bits = random_bits();
    move || (bits() >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

#[test]
fn improved_noise_has_the_published_values() {
    let noise = Noise::new(Basis::Improved, 0);
    assert_eq!(noise.value([0.5, 0.25, 0.5]), -0.262939453125);
    assert_eq!(noise.value([3.14, 42.0, 7.0]), 0.13691995878400012);
    assert_eq!(noise.value([-4.20, 10.0, 6.0]), 0.14208000000000043);
    assert_eq!(noise.value([0.5f32, 0.25, 0.5]), -0.262_939_45);
}

#[test]
fn improved_noise_equals_an_independent_listing() {
    let (listing, noise) = (Listing::new(), Noise::new(Basis::Improved, 0));
    let mut random = random_numbers();
    let mut seen = [false; 16];
    let mut worst = 0.0f64;
    for i in 0..10_000 {
        let scale = [4.0, 300.0, 1e5, 1e9][i % 4];
        let point: [f64; 3] = std::array::from_fn(|_| random() * scale);
        let expected = listing.value(point, &mut seen);
        assert_eq!(noise.value(point), expected, "at {point:?}");
        // Single precision: against the same point, exactly representable.
        let single = point.map(|coordinate| coordinate as f32);
        let expected = listing.value(single.map(f64::from), &mut seen);
        worst = worst.max((f64::from(noise.value(single)) - expected).abs());
    }
    assert!(worst < 2e-6, "{worst}");
    assert_eq!(seen, [true; 16]);
}

/// Improved noise of four dimensions as Perlin's `ImprovedNoise4D` tells it, apart from the crate's code.
fn listing_of_four(table: &[u8], point: [f64; 4], seen: &mut [bool; 32]) -> f64 {
    let cell = point.map(|coordinate| coordinate.floor());
    let mut dots = [0.0; 16];
    for (i, dot) in dots.iter_mut().enumerate() {
        let corner: [i64; 4] = std::array::from_fn(|axis| cell[axis] as i64 + (i >> axis & 1) as i64);
        let hash = corner.iter().fold(0, |hash, c| usize::from(table[hash + c.rem_euclid(256) as usize])) % 32;
        seen[hash] = true;
        let [x, y, z, w] = std::array::from_fn(|axis| point[axis] - corner[axis] as f64);
        let [a, b, c] = [[y, z, w], [w, x, y], [z, w, x], [y, z, w]][hash / 8];
        let signed = |bit: usize, part: f64| if hash & bit == 0 { -part } else { part };
        *dot = signed(4, a) + signed(2, b) + signed(1, c);
    }
    for axis in 0..4 {
        let t = point[axis] - cell[axis];
        let weight = t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
        for i in 0..8 >> axis {
            dots[i] = dots[2 * i] + weight * (dots[2 * i + 1] - dots[2 * i]);
        }
    }
    dots[0]
}

#[test]
fn improved_noise_of_four_dimensions_equals_an_independent_listing() {
    let (listing, noise) = (Listing::new(), Noise::new(Basis::Improved, 0));
    let (mut random, mut seen) = (random_numbers(), [false; 32]);
    for i in 0..5_000 {
        let scale = [4.0, 300.0, 1e5, 1e9][i % 4];
        let point: [f64; 4] = std::array::from_fn(|_| random() * scale);
        assert_eq!(noise.value(point), listing_of_four(&listing.table, point, &mut seen), "at {point:?}");
    }
    assert_eq!(seen, [true; 32]);
}

#[test]
fn periods_repeat_to_the_bit_in_one_and_four_dimensions() {
    let mut random = random_numbers();
    for &basis in Basis::ALL {
        for period in [1u32, 2, 5, 300] {
            let line = Noise::new(basis, 0).with_period([period]).unwrap();
            let four = Noise::new(basis, 0).with_period([period; 4]).unwrap();
            for _ in 0..100 {
                let point: [f32; 4] = std::array::from_fn(|_| (random() * 1000.0).floor() as f32 / 64.0);
                let moved = point.map(|coordinate| coordinate + period as f32);
                assert_eq!(line.value([point[0]]).to_bits(), line.value([moved[0]]).to_bits(), "{basis:?} {period}");
                assert_eq!(four.value(point).to_bits(), four.value(moved).to_bits(), "{basis:?} {period}");
            }
        }
    }
}

#[test]
fn gradient_noises_vanish_at_lattice_points() {
    for basis in [Basis::Improved, Basis::Classic] {
        let noise = Noise::new(basis, 0);
        for i in -300..300 {
            let point = [f64::from(i), f64::from(i * 7 % 31), f64::from(-i)];
            assert_eq!(noise.value(point).to_bits(), 0, "{basis:?} at {point:?}");
        }
    }
}

#[test]
fn lattice_noise_has_the_tables_values_at_lattice_points() {
    let (listing, noise) = (Listing::new(), Noise::new(Basis::Lattice, 0));
    for i in -300..300i64 {
        let corner = [i, i * 7 % 31, -i];
        let expected = f64::from(listing.hash(corner)) * (2.0 / 255.0) - 1.0;
        assert_eq!(noise.value(corner.map(|coordinate| coordinate as f64)), expected);
    }
}

#[test]
fn two_dimensions_are_the_slice_at_zero() {
    let mut random = random_numbers();
    for &basis in Basis::ALL {
        let noise = Noise::new(basis, 3);
        for _ in 0..1000 {
            let (x, y) = ((random() * 50.0) as f32, (random() * 50.0) as f32);
            if basis == Basis::Cellular {
                continue;
            }
            assert_eq!(noise.value([x, y]).to_bits(), noise.value([x, y, 0.0]).to_bits(), "{basis:?}");
        }
    }
}

#[test]
fn gradients_equal_central_differences() {
    let mut random = random_numbers();
    let step = 1e-5;
    for &basis in Basis::ALL {
        for combine in Combine::ALL {
            let sum = Sum::new(Noise::new(basis, 5), *combine, 3);
            for _ in 0..500 {
                let point: [f64; 3] = std::array::from_fn(|_| random() * 20.0);
                let (value, gradient) = sum.value_and_gradient(point);
                assert_eq!(value, sum.value(point));
                for axis in 0..3 {
                    let moved = |by: f64| {
                        let mut moved = point;
                        moved[axis] += by;
                        sum.value(moved)
                    };
                    let (left, right) = (moved(-step), moved(step));
                    // Within a step of a crease the difference says nothing.
                    let bend = (left + right - 2.0 * value).abs() / step;
                    let difference = (right - left) / (2.0 * step);
                    assert!((difference - gradient[axis]).abs() < 1e-6 + bend, "{basis:?} {combine:?} {point:?}");
                }
            }
        }
    }
}

/// Gradients of a noise in D dimensions against central differences.
fn check_gradients<const D: usize>(sum: &Sum) {
    let mut random = random_numbers();
    let (step, mut compared) = (1e-5, 0);
    for _ in 0..300 {
        let point: [f64; D] = std::array::from_fn(|_| random() * 20.0);
        let (value, gradient) = sum.value_and_gradient(point);
        for axis in 0..D {
            let moved = |by: f64| {
                let mut moved = point;
                moved[axis] += by;
                sum.value(moved)
            };
            let difference = |step: f64| (moved(step) - moved(-step)) / (2.0 * step);
            // Beside a crease or a step the difference says nothing: there it depends on its width.
            let (wide, narrow) = (difference(2.0 * step), difference(step));
            if (wide - narrow).abs() < 1e-7 * (1.0 + narrow.abs()) {
                compared += 1;
                let error = (narrow - gradient[axis]).abs();
                assert!(error < 1e-6 * (1.0 + narrow.abs()), "{sum:?} in {D} at {point:?}: {narrow}, {gradient:?}");
            }
        }
        assert_eq!(value, sum.value(point));
    }
    assert!(compared > 200 * D, "{sum:?} in {D}: {compared}");
}

#[test]
fn gradients_equal_central_differences_in_every_number_of_dimensions() {
    for &basis in Basis::ALL {
        for &combine in Combine::ALL {
            let sum = Sum::new(Noise::new(basis, 6), combine, 2);
            check_gradients::<1>(&sum);
            check_gradients::<2>(&sum);
            check_gradients::<3>(&sum);
            check_gradients::<4>(&sum);
        }
    }
}

#[test]
fn periods_repeat_to_the_bit() {
    let mut random = random_numbers();
    for &basis in Basis::ALL {
        for period in [[1, 1, 1], [3, 5, 7], [256, 255, 257], [1000, 4, 0], [0, 6, 1 << 21]] {
            let noise = Noise::new(basis, 0).with_period(period).unwrap();
            let sum = Sum::new(noise.clone(), Combine::Absolute, 3);
            let mut differ = false;
            for _ in 0..300 {
                // Multiples of 1/64, so that adding a period rounds nothing.
                let point: [f32; 3] = std::array::from_fn(|_| (random() * 1000.0).floor() as f32 / 64.0);
                for axis in 0..3 {
                    let cells = if period[axis] == 0 { 256 } else { period[axis] };
                    let hashed = matches!(basis, Basis::Value | Basis::Simplex | Basis::Cellular | Basis::White);
                    if cells > 1000 || hashed && period[axis] == 0 {
                        continue;
                    }
                    let mut moved = point;
                    moved[axis] += cells as f32;
                    assert_eq!(noise.value(point).to_bits(), noise.value(moved).to_bits(), "{basis:?} {period:?}");
                    assert_eq!(sum.value(point).to_bits(), sum.value(moved).to_bits(), "{basis:?} {period:?}");
                    moved[axis] += 0.5;
                    differ |= noise.value(point) != noise.value(moved);
                }
            }
            // (With one cell for all, the noises of values are constant.)
            assert!(differ || period == [1; 3]);
        }
    }
}

#[test]
fn a_period_of_256_changes_nothing_and_longer_ones_are_refused() {
    let noise = Noise::new(Basis::Improved, 0);
    let periodic = noise.clone().with_period([256; 3]).unwrap();
    assert_eq!(noise.value([-3.3, 700.2, 12.9]), periodic.value([-3.3, 700.2, 12.9]));
    let error = noise.with_period([1, u32::MAX, 1]).unwrap_err();
    assert_eq!(error.to_string(), "expected a period up to 16777216 along y, found 4294967295");
}

#[test]
fn any_input_has_a_value() {
    for &basis in Basis::ALL {
        for period in [[0; 3], [7; 3]] {
            let Ok(noise) = Noise::new(basis, 0).with_period(period) else { continue };
            let largest = noise.range()[1];
            for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
                assert!(noise.value([0.5, bad, 0.5]).is_nan());
                assert!(noise.value([0.5, f64::from(bad), 0.5]).is_nan());
            }
            for far in [3e9f32, -3e9, 1e19, -1e19, f32::MAX, f32::MIN] {
                if basis == Basis::Simplex && far.abs() > 1e37 {
                    continue;
                }
                assert!(f64::from(noise.value([0.5, far, 0.25]).abs()) <= largest, "{basis:?} at {far}");
                assert!(noise.value([0.5, f64::from(far), 0.25]).abs() <= largest, "{basis:?} at {far}");
            }
        }
    }
}

/// Means of the absolute value in space and in the plane, and of the value: basis by basis.
const MEANS: [(Basis, f64, f64, f64); 7] = [
    (Basis::Improved, 0.220, 0.204, 0.0),
    (Basis::Classic, 0.148, 0.139, 0.0),
    (Basis::Lattice, 0.303, 0.356, 0.0),
    (Basis::Value, 0.327, 0.372, 0.0),
    (Basis::Simplex, 0.315, 0.315, 0.0),
    (Basis::Cellular, 0.52, 0.43, 0.52),
    (Basis::White, 0.5, 0.5, 0.0),
];

#[test]
fn means_and_ranges_are_as_documented() {
    assert_eq!(MEANS.map(|(basis, ..)| basis), Basis::ALL);
    let mut random = random_numbers();
    for (basis, in_space, in_plane, mean) in MEANS {
        const COUNT: usize = 200_000;
        let (mut space, mut plane, mut signed) = (0.0, 0.0, 0.0);
        let noises: Vec<Noise> = (0..50).map(|seed| Noise::new(basis, seed)).collect();
        let [low, high] = noises[0].range();
        for i in 0..COUNT {
            let point: [f32; 3] = std::array::from_fn(|_| random() as f32 * 128.0);
            let noise = &noises[i % noises.len()];
            let value = f64::from(noise.value(point));
            assert!((low..=high).contains(&value), "{basis:?} is {value} at {point:?}");
            space += value.abs() / COUNT as f64;
            signed += value / COUNT as f64;
            plane += f64::from(noise.value([point[0], point[1]]).abs()) / COUNT as f64;
        }
        assert!((space - in_space).abs() < 0.01, "{basis:?} in space: {space}");
        assert!((plane - in_plane).abs() < 0.01, "{basis:?} in the plane: {plane}");
        assert!((signed - mean).abs() < 0.01, "{basis:?}: {signed}");
    }
}

#[test]
fn cellular_distances_are_ordered_and_have_unit_slope() {
    let mut random = random_numbers();
    for metric in [Metric::Euclidean, Metric::Manhattan, Metric::Chebyshev] {
        let of = |feature, jitter| Noise::new(Basis::Cellular, 4).with_cellular(Cellular { metric, feature, jitter });
        let [first, second, difference] = [Feature::First, Feature::Second, Feature::Difference].map(|f| of(f, 1.0));
        let centred = of(Feature::First, 0.0);
        for _ in 0..2000 {
            let point: [f64; 3] = std::array::from_fn(|_| random() * 30.0);
            let (near, slope) = first.value_and_gradient(point);
            let far = second.value(point);
            assert!(near <= far);
            assert_eq!(difference.value(point), far - near);
            // Distances grow by one per unit of the metric, straight away from the feature point.
            let length = match metric {
                Metric::Euclidean => slope.iter().map(|s| s * s).sum::<f64>(),
                Metric::Manhattan => slope.iter().map(|s| s.abs()).fold(0.0, f64::max),
                Metric::Chebyshev => slope.iter().map(|s| s.abs()).sum::<f64>(),
            };
            assert!((length - 1.0).abs() < 1e-9, "{metric:?} at {point:?}: {slope:?}");
            // Without jitter the feature points are the centres of the cells.
            let offset = point.map(|coordinate| (coordinate - coordinate.floor() - 0.5).abs());
            let expected = match metric {
                Metric::Euclidean => offset.iter().map(|o| o * o).sum::<f64>().sqrt(),
                Metric::Manhattan => offset.iter().sum(),
                Metric::Chebyshev => offset.iter().copied().fold(0.0, f64::max),
            };
            assert!((centred.value(point) - expected).abs() < 1e-12);
        }
    }
}

#[test]
fn simplex_noise_is_smooth_with_and_without_periods() {
    let mut random = random_numbers();
    for period in [[0; 3], [1; 3], [2, 3, 4], [7, 0, 5], [300, 100, 31]] {
        let noise = Noise::new(Basis::Simplex, 0).with_period(period).unwrap();
        // How much cells are stretched, at most: three to a period of one.
        let steepest = if period.contains(&1) { 6e-5 } else { 3e-5 };
        for _ in 0..500 {
            // A short walk through many tetrahedra: no step is larger than the steepest slope allows.
            let start: [f64; 3] = std::array::from_fn(|_| random() * 50.0);
            let along: [f64; 3] = std::array::from_fn(|_| random());
            let at = |t: f64| noise.value([start[0] + t * along[0], start[1] + t * along[1], start[2] + t * along[2]]);
            for step in 0..20 {
                let t = f64::from(step) * 0.1;
                assert!((at(t + 1e-6) - at(t)).abs() < steepest, "{period:?}");
            }
        }
        // And over the edge of the first period.
        for axis in 0..3 {
            for _ in 0..200 {
                let mut point: [f64; 3] = std::array::from_fn(|_| random() * 5.0);
                let mut at = |x: f64| {
                    point[axis] = x;
                    noise.value(point)
                };
                assert!((at(1e-6) - at(-1e-6)).abs() < 2.0 * steepest, "{period:?}");
            }
        }
    }
}

#[test]
fn periodic_simplex_noise_of_four_dimensions_is_smooth_and_within_its_range() {
    let mut random = random_numbers();
    let noise = Noise::new(Basis::Simplex, 0).with_period([4, 8, 5, 7]).unwrap();
    let mut largest = 0.0f64;
    for _ in 0..200_000 {
        let point: [f64; 4] = std::array::from_fn(|_| random() * 20.0);
        let moved = point.map(|coordinate| coordinate + 1e-6);
        let (value, next) = (noise.value(point), noise.value(moved));
        assert!((value - next).abs() < 4e-5, "{point:?}");
        largest = largest.max(value.abs());
    }
    assert!((0.6..1.0).contains(&largest), "{largest}");
}

#[test]
fn white_noise_is_constant_in_a_cell_and_differs_between_cells() {
    let noise = Noise::new(Basis::White, 0);
    assert_eq!(noise.value([-0.1, 5.2, 3.0]), noise.value([-0.9, 5.9, 3.5]));
    assert_ne!(noise.value([-0.1, 5.2, 3.0]), noise.value([0.1, 5.2, 3.0]));
    assert_ne!(noise.value([0.5, 5.2, 3.0]), noise.value([256.5, 5.2, 3.0]));
}
