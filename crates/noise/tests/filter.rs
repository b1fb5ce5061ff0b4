//! The band limit: filtered sums against averages over the footprint.

mod common;

use common::random_bits;
use jaspe_noise::simd::Level;
use jaspe_noise::{Basis, Combine, Noise, Sum};

/// Numbers in [-1, 1), reproducible.
fn random_numbers() -> impl FnMut() -> f32 {
    let mut bits = random_bits();
    move || (bits() >> 40) as f32 / (1u64 << 23) as f32 - 1.0
}

/// The root mean square of the difference between the filtered sum, and the faded one, and the average of 1024 samples over the
/// footprint.
fn difference(sum: &Sum, footprint: f32) -> [f32; 2] {
    const FOOTPRINTS: usize = 200;
    const SAMPLES: usize = 1024;
    let mut random = random_numbers();
    let mut squares = [0.0; 2];
    for _ in 0..FOOTPRINTS {
        let centre = [random() * 100.0, random() * 100.0, random() * 100.0];
        let samples: [Vec<f32>; 3] =
            centre.map(|coordinate| (0..SAMPLES).map(|_| coordinate + 0.5 * footprint * random()).collect());
        let mut values = vec![0.0; SAMPLES];
        sum.fill(samples.each_ref().map(Vec::as_slice), &mut values);
        let average = values.iter().sum::<f32>() / SAMPLES as f32;
        for (square, value) in
            squares.iter_mut().zip([sum.value_filtered(centre, footprint), sum.value_faded(centre, footprint)])
        {
            *square += (value - average).powi(2) / FOOTPRINTS as f32;
        }
    }
    squares.map(f32::sqrt)
}

#[test]
fn filtered_sums_are_near_the_average_over_the_footprint() {
    for combine in [Combine::Plain, Combine::Absolute] {
        let sum = Sum::new(Noise::new(Basis::Improved, 0), combine, 5);
        for footprint in [0.03, 0.1, 0.3, 0.7, 1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0, 30.0] {
            let [filtered, faded] = difference(&sum, footprint);
            assert!(filtered < 0.02, "{combine:?} at {footprint}: {filtered}");
            assert!(faded < 0.08, "{combine:?} at {footprint}, faded: {faded}");
        }
    }
}

#[test]
fn without_a_footprint_nothing_is_lost_and_with_a_large_one_the_mean_remains() {
    let mut random = random_numbers();
    for &basis in Basis::ALL {
        for &combine in Combine::ALL {
            let sum = Sum::new(Noise::new(basis, 0), combine, 4);
            const COUNT: usize = 20_000;
            let columns: [Vec<f32>; 3] = std::array::from_fn(|_| (0..COUNT).map(|_| random() * 100.0).collect());
            let columns = columns.each_ref().map(Vec::as_slice);
            let [mut values, mut sharp, mut even, mut faded] = [(); 4].map(|()| vec![0.0; COUNT]);
            sum.fill(columns, &mut values);
            sum.fill_filtered(columns, &[0.0; COUNT], &mut sharp);
            sum.fill_filtered(columns, &[1e4; COUNT], &mut even);
            assert!((0..COUNT).all(|i| sharp[i].to_bits() == values[i].to_bits()), "{basis:?} {combine:?}");
            assert!((0..COUNT).all(|i| (even[i] - even[0]).abs() < 1e-6), "{basis:?} {combine:?}");
            sum.fill_faded(columns, &[1e4; COUNT], &mut faded);
            assert_eq!(faded, even, "{basis:?} {combine:?}");
            sum.fill_faded(columns, &[0.0; COUNT], &mut faded);
            assert!((0..COUNT).all(|i| faded[i].to_bits() == values[i].to_bits()), "{basis:?} {combine:?}");
            let mean = values.iter().map(|&value| f64::from(value)).sum::<f64>() / COUNT as f64;
            if matches!(combine, Combine::Plain | Combine::Absolute) {
                let even = f64::from(even[0]);
                assert!((even - mean).abs() < 0.03, "{basis:?} {combine:?}: {even}, mean {mean}");
            }
        }
    }
}

#[test]
fn filtered_sums_have_the_same_bits_at_every_level() {
    let mut random = random_numbers();
    let mut column = |scale: f32| -> Vec<f32> { (0..99).map(|_| random() * scale).collect() };
    let (x, y, z, footprints) = (column(40.0), column(40.0), column(40.0), column(2.0));
    for &basis in Basis::ALL {
        for &combine in Combine::ALL {
            let sum = Sum::new(Noise::new(basis, 1), combine, 5);
            let space: Vec<f32> = (0..99).map(|i| sum.value_filtered([x[i], y[i], z[i]], footprints[i])).collect();
            let plane: Vec<f32> = (0..99).map(|i| sum.value_filtered([x[i], y[i]], footprints[i])).collect();
            let faded: Vec<f32> = (0..99).map(|i| sum.value_faded([x[i], y[i], z[i]], footprints[i])).collect();
            for level in Level::ALL {
                let mut values = vec![0.0; 99];
                sum.fill_filtered_at(level, [&x, &y, &z], &footprints, &mut values);
                assert_eq!(values, space, "{basis:?} {combine:?} at {level:?}");
                sum.fill_filtered_at(level, [&x, &y], &footprints, &mut values);
                assert_eq!(values, plane, "{basis:?} {combine:?} at {level:?}");
                sum.fill_faded_at(level, [&x, &y, &z], &footprints, &mut values);
                assert_eq!(values, faded, "{basis:?} {combine:?} at {level:?}, faded");
                let [mut gx, mut gy, mut gz] = [(); 3].map(|()| vec![0.0; 99]);
                let gradient = [&mut gx[..], &mut gy[..], &mut gz[..]];
                sum.fill_filtered_with_gradient_at(level, [&x, &y, &z], &footprints, &mut values, gradient);
                for i in 0..99 {
                    let expected = sum.value_and_gradient_filtered([x[i], y[i], z[i]], footprints[i]);
                    assert_eq!((values[i], [gx[i], gy[i], gz[i]]), expected, "{basis:?} {combine:?} at {level:?}, {i}");
                }
            }
        }
    }
}

#[test]
fn gradients_of_filtered_sums_equal_central_differences() {
    let mut random = random_numbers();
    for combine in [Combine::Plain, Combine::Absolute, Combine::Ridged] {
        let sum = Sum::new(Noise::new(Basis::Improved, 0), combine, 4);
        for footprint in [0.0, 0.05, 0.3, 1.0, 20.0] {
            for _ in 0..50 {
                let point: [f64; 3] = std::array::from_fn(|_| f64::from(random()) * 30.0);
                let (value, gradient) = sum.value_and_gradient_filtered(point, footprint);
                assert_eq!(value, sum.value_filtered(point, footprint));
                for axis in 0..3 {
                    const STEP: f64 = 1e-5;
                    let at = |step: f64| {
                        let mut moved = point;
                        moved[axis] += step;
                        sum.value_filtered(moved, footprint)
                    };
                    let difference = (at(STEP) - at(-STEP)) / (2.0 * STEP);
                    let kinked = combine != Combine::Plain && (difference - gradient[axis]).abs() > 1e-5;
                    // (Where an octave passes zero, its absolute value has a kink: the two sides differ.)
                    let one_side = (at(STEP) - at(0.0)) / STEP;
                    let near = (difference - gradient[axis]).abs() < 1e-5 * (1.0 + difference.abs());
                    assert!(
                        near || kinked && (one_side - difference).abs() > 1e-4,
                        "{combine:?} at {point:?}, {footprint}"
                    );
                }
            }
        }
    }
}
