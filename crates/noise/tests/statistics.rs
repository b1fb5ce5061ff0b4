//! What the declarations say of minimum, maximum, mean and variance, measured.

use jaspe_noise::{Basis, Cellular, Combine, Declaration, Feature, Metric, Noise, Statistics, Sum};

/// So many points are measured in space; a tenth of them in the other dimensions.
const POINTS: usize = 10_000_000;

/// The statistics of these sums, in turn, at so many points within ±128.
fn measure<const D: usize>(sums: &[Sum], points: usize) -> Statistics {
    const CHUNK: usize = 1 << 14;
    let mut state = 7u64;
    let mut column = || -> Vec<f32> {
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            ((state >> 40) as f32 / (1 << 23) as f32 - 1.0) * 128.0
        };
        (0..CHUNK).map(|_| next()).collect()
    };
    let mut values = vec![0.0; CHUNK];
    let (mut least, mut largest, mut sum, mut squares) = (f64::MAX, f64::MIN, 0.0, 0.0);
    let chunks = points.div_ceil(CHUNK);
    for chunk in 0..chunks {
        let columns: [Vec<f32>; D] = std::array::from_fn(|_| column());
        sums[chunk % sums.len()].fill(columns.each_ref().map(Vec::as_slice), &mut values);
        for value in values.iter().map(|&value| f64::from(value)) {
            (least, largest) = (least.min(value), largest.max(value));
            (sum, squares) = (sum + value, squares + value * value);
        }
    }
    let count = (chunks * CHUNK) as f64;
    Statistics { least, largest, mean: sum / count, variance: squares / count - (sum / count).powi(2) }
}

/// Holds the statistics of sums, seed by seed, to those that are declared.
fn check(name: &str, declared: [Statistics; 4], sum: impl Fn(u64) -> Sum) {
    let sums: Vec<Sum> = (0..64).map(sum).collect();
    let measured = [
        measure::<1>(&sums, POINTS / 10),
        measure::<2>(&sums, POINTS / 10),
        measure::<3>(&sums, POINTS),
        measure::<4>(&sums, POINTS / 10),
    ];
    for (dimension, (declared, measured)) in declared.iter().zip(measured).enumerate() {
        let say = format!("{name} in {}: declared {declared:?}, measured {measured:?}", dimension + 1);
        assert!(measured.least >= declared.least && measured.largest <= declared.largest, "{say}");
        let spread = declared.largest - declared.least;
        assert!(measured.largest - measured.least > 0.3 * spread, "{say}");
        // The mean of so many points wanders as far as few lattice points, or one seed, can carry it.
        let tolerance = if dimension == 0 { 0.05 } else { 0.02 };
        let deviation = declared.variance.sqrt();
        assert!((measured.mean - declared.mean).abs() < tolerance * deviation, "{say}");
        assert!((measured.variance / declared.variance - 1.0).abs() < 2.0 * tolerance, "{say}");
    }
}

#[test]
fn noises_are_as_declared() {
    for &basis in Basis::ALL {
        let Declaration { name, statistics, .. } = *basis.declaration();
        check(name, statistics, |seed| Sum::new(Noise::new(basis, seed), Combine::Plain, 1));
    }
}

#[test]
fn sums_are_as_declared() {
    for &combine in Combine::ALL {
        let Declaration { name, statistics, .. } = *combine.declaration();
        check(name, statistics, |seed| Sum::new(Noise::new(Basis::Improved, seed), combine, 5));
    }
}

#[test]
fn every_cellular_noise_is_within_its_range() {
    for metric in [Metric::Euclidean, Metric::Manhattan, Metric::Chebyshev] {
        for feature in [Feature::First, Feature::Second, Feature::Difference, Feature::Cell] {
            let cellular = Cellular { metric, feature, jitter: 1.0 };
            let noise = Noise::new(Basis::Cellular, 5).with_cellular(cellular);
            let [low, high] = noise.range();
            let measured = measure::<3>(&[Sum::new(noise, Combine::Plain, 1)], 500_000);
            assert!(measured.least >= low && measured.largest <= high, "{cellular:?}: {measured:?}");
            assert!(measured.largest - measured.least > 0.45 * (high - low), "{cellular:?}: {measured:?}");
        }
    }
}

#[test]
fn declarations_are_complete() {
    for declaration in Basis::ALL.iter().map(|basis| basis.declaration()) {
        assert_eq!(Basis::from_name(declaration.name), Some(declaration.of));
        assert!(declaration.sentence.ends_with('.') && !declaration.formula.is_empty(), "{declaration:?}");
    }
    for declaration in Combine::ALL.iter().map(|combine| combine.declaration()) {
        assert_eq!(Combine::from_name(declaration.name), Some(declaration.of));
        assert!(declaration.sentence.ends_with('.') && !declaration.formula.is_empty(), "{declaration:?}");
    }
}
