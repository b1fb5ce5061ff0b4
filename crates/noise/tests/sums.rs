//! What the sums promise beside the bits.

mod common;

use common::random_bits;
use jaspe_noise::{Basis, Combine, Noise, Sum};

/// Points within ±50, reproducible.
fn points(count: usize) -> Vec<[f64; 3]> {
    let mut bits = random_bits();
    let mut random = || ((bits() >> 11) as f64 / (1u64 << 52) as f64 - 1.0) * 50.0;
    (0..count).map(|_| [random(), random(), random()]).collect()
}

#[test]
fn turbulence_is_the_printed_sum() {
    let noise = Noise::new(Basis::Improved, 0);
    let turbulence = Sum::new(noise.clone(), Combine::Absolute, 4);
    for point in points(1000) {
        let point = point.map(|coordinate| coordinate as f32);
        let octave = |factor: f32| noise.value(point.map(|coordinate| coordinate * factor)).abs();
        let expected = octave(1.0) + 0.5 * octave(2.0) + 0.25 * octave(4.0) + 0.125 * octave(8.0);
        assert_eq!(turbulence.value(point), expected);
    }
}

#[test]
fn a_plain_sum_has_its_lacunarity_and_gain() {
    let noise = Noise::new(Basis::Improved, 0);
    let sum = Sum::new(noise.clone(), Combine::Plain, 3).with_lacunarity(1.9).with_gain(0.7);
    for point in points(1000) {
        let octave = |factor: f64| noise.value(point.map(|coordinate| coordinate * factor));
        let expected = octave(1.0) + 0.7 * octave(1.9) + 0.49 * octave(3.61);
        assert!((sum.value(point) - expected).abs() < 1e-12);
    }
}

#[test]
fn multifractal_sums_follow_musgraves_recurrences() {
    let noise = Noise::new(Basis::Improved, 0);
    let of = |combine| Sum::new(noise.clone(), combine, 2);
    let (ridged, hybrid) = (of(Combine::Ridged), of(Combine::Hybrid));
    for point in points(1000) {
        let octave = |factor: f64| noise.value(point.map(|coordinate| coordinate * factor));
        let (first, second) = (octave(1.0), octave(2.0));
        let ridge = (1.0 - first.abs()).powi(2);
        let expected = ridge + 0.5 * (2.0 * ridge).min(1.0) * (1.0 - second.abs()).powi(2);
        assert!((ridged.value(point) - expected).abs() < 1e-14);
        let height = first + 0.7;
        let expected = height + height.min(1.0) * 0.5 * (second + 0.7);
        assert!((hybrid.value(point) - expected).abs() < 1e-14);
    }
}

#[test]
fn sums_stay_within_their_ranges() {
    for &basis in Basis::ALL {
        for &combine in Combine::ALL {
            let sum = Sum::new(Noise::new(basis, 0), combine, 5);
            let [low, high] = sum.range();
            let values: Vec<f64> = points(5000).into_iter().map(|point| sum.value(point)).collect();
            assert!(values.iter().all(|value| (low..=high).contains(value)), "{basis:?} {combine:?}");
            let least = values.iter().copied().fold(f64::MAX, f64::min);
            let most = values.iter().copied().fold(f64::MIN, f64::max);
            assert!(most - least > 0.2 * (high - low), "{basis:?} {combine:?}: {least}..{most} in {low}..{high}");
        }
    }
}

#[test]
fn octaves_fade_in() {
    let point = [0.3f64, 1.7, -2.4];
    for &combine in Combine::ALL {
        let of = |octaves: f64| Sum::new(Noise::new(Basis::Improved, 0), combine, 0).with_octaves(octaves).value(point);
        assert_eq!(of(0.0), 0.0);
        assert_eq!(of(-3.0), 0.0);
        assert_eq!(of(f64::NAN), 0.0);
        assert_eq!(of(3.0), Sum::new(Noise::new(Basis::Improved, 0), combine, 3).value(point));
        let halfway = (of(2.0) + of(3.0)) / 2.0;
        assert!((of(2.5) - halfway).abs() < 1e-14, "{combine:?}");
        assert!((of(2.000_001) - of(2.0)).abs() < 1e-5, "{combine:?}");
    }
}
