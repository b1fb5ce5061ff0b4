//! The error bounds that `math` documents.

#![allow(clippy::disallowed_methods, reason = "our functions are held against the platform's")]

use jaspe_noise::math;

/// Evenly spaced numbers from `low` to `high`.
fn walk(low: f64, high: f64) -> impl Iterator<Item = f64> {
    const COUNT: u32 = 200_000;
    (0..=COUNT).map(move |i| low + (high - low) * f64::from(i) / f64::from(COUNT))
}

#[test]
fn sine_and_cosine_are_within_their_bounds() {
    let mut worst = [0.0f64; 2];
    for x in walk(-8000.0, 8000.0).chain(walk(-7.0, 7.0)) {
        let single = x as f32;
        let exact = f64::from(single);
        let errors = [f64::from(math::sin(single)) - exact.sin(), f64::from(math::cos(single)) - exact.cos()];
        worst[0] = errors.iter().fold(worst[0], |worst, error| worst.max(error.abs()));
        let errors = [math::sin(x) - x.sin(), math::cos(x) - x.cos()];
        worst[1] = errors.iter().fold(worst[1], |worst, error| worst.max(error.abs()));
    }
    assert!(worst[0] < 1.2e-7 && worst[1] < 3e-16, "{worst:?}");
}

#[test]
fn far_angles_stay_in_range() {
    for x in [1e5f32, 1e9, -3e9, 1e20, f32::MAX, f32::MIN] {
        assert!(math::sin(x).abs() <= 1.000_000_1 && math::cos(x).abs() <= 1.000_000_1, "{x}");
    }
    assert!(math::sin(f32::NAN).is_nan() && math::cos(f32::INFINITY).is_nan() && math::cos(f64::NEG_INFINITY).is_nan());
}

#[test]
fn exponential_is_within_its_bounds() {
    let mut worst = [0.0f64; 2];
    for x in walk(-87.0, 88.0).chain(walk(-1.0, 1.0)) {
        let exact = f64::from(x as f32).exp();
        worst[0] = worst[0].max((f64::from(math::exp(x as f32)) / exact - 1.0).abs());
        worst[1] = worst[1].max((math::exp(x) / x.exp() - 1.0).abs());
    }
    assert!(worst[0] < 2e-7 && worst[1] < 5e-16, "{worst:?}");
    assert_eq!((math::exp(200.0f32), math::exp(-200.0f32)), (f32::INFINITY, 0.0));
    assert_eq!((math::exp(f64::INFINITY), math::exp(f64::NEG_INFINITY)), (f64::INFINITY, 0.0));
    assert!(math::exp(f32::NAN).is_nan());
}

#[test]
fn logarithm_is_within_its_bounds() {
    let mut worst = [0.0f64; 2];
    for exponent in walk(-120.0, 120.0).chain(walk(-0.7, 0.7)) {
        let x = exponent.exp2();
        let single = x as f32;
        let exact = f64::from(single).ln();
        worst[0] = worst[0].max((f64::from(math::ln(single)) - exact).abs() / exact.abs().max(1.0));
        worst[1] = worst[1].max((math::ln(x) - x.ln()).abs() / x.ln().abs().max(1.0));
    }
    assert!(worst[0] < 2e-7 && worst[1] < 5e-16, "{worst:?}");
    assert_eq!((math::ln(0.0f32), math::ln(f32::INFINITY)), (f32::NEG_INFINITY, f32::INFINITY));
    assert!(math::ln(-1.0f32).is_nan() && math::ln(f64::NAN).is_nan() && math::ln(f32::NEG_INFINITY).is_nan());
    let subnormal = f32::from_bits(1);
    assert!((f64::from(math::ln(subnormal)) - f64::from(subnormal).ln()).abs() < 1e-5);
}

#[test]
fn power_is_within_its_bounds() {
    for x in walk(0.01, 30.0).step_by(97) {
        for y in [-3.0, -0.5, 0.5, 1.0, 2.2, 7.0] {
            let (x32, y32) = (x as f32, y as f32);
            let exact = f64::from(x32).powf(f64::from(y32));
            let scale = 1.0 + (y * x.ln()).abs();
            assert!((f64::from(math::pow(x32, y32)) / exact - 1.0).abs() < scale * 3e-7, "{x} {y}");
            assert!((math::pow(x, y) / x.powf(y) - 1.0).abs() < scale * 1e-15, "{x} {y}");
        }
    }
}
