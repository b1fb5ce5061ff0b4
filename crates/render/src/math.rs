//! Numbers that must agree on every platform: no platform trigonometry, no fused multiply-add.

use glam::Vec3;
use jaspe_noise::math::{exp, ln};

/// Sine and cosine of an angle in degrees; exact at multiples of 90°.
pub(crate) fn sin_cos_degrees(degrees: f64) -> (f64, f64) {
    let quarter = (degrees / 90.0).round();
    let rest = (degrees - quarter * 90.0).to_radians();
    // Taylor series on ±π/4: the first term left out is below 1e-17.
    let x2 = rest * rest;
    let sin_terms = [
        1.0,
        -1.0 / 6.0,
        1.0 / 120.0,
        -1.0 / 5040.0,
        1.0 / 362_880.0,
        -1.0 / 39_916_800.0,
        1.0 / 6_227_020_800.0,
        -1.0 / 1_307_674_368_000.0,
    ];
    let cos_terms = [
        1.0,
        -0.5,
        1.0 / 24.0,
        -1.0 / 720.0,
        1.0 / 40_320.0,
        -1.0 / 3_628_800.0,
        1.0 / 479_001_600.0,
        -1.0 / 87_178_291_200.0,
    ];
    let series = |terms: [f64; 8]| terms.iter().rev().fold(0.0, |sum, term| sum * x2 + term);
    let (sin, cos) = (rest * series(sin_terms), series(cos_terms));
    match (quarter.rem_euclid(4.0)) as u8 {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

/// Sine and cosine of an angle in turns, from -64 to 64; errors below 2e-7 (coefficients of [Moshier 1989] Cephes, `sinf`
/// and `cosf`).
#[inline(always)]
pub(crate) fn sin_cos_turns(turns: f32) -> (f32, f32) {
    // To the nearest quarter: adding 1.5 · 2²³ leaves no room for a fraction.
    const SHIFT: f32 = 12_582_912.0;
    let shifted = turns * 4.0 + SHIFT;
    let quarter = shifted.to_bits();
    let x = (turns * 4.0 - (shifted - SHIFT)) * std::f32::consts::FRAC_PI_2;
    let x2 = x * x;
    let sin = x + x * x2 * (-1.666_665_5e-1 + x2 * (8.332_161e-3 + x2 * -1.951_529_6e-4));
    let cos = 1.0 - 0.5 * x2 + x2 * x2 * (4.166_664_6e-2 + x2 * (-1.388_731_6e-3 + x2 * 2.443_315_7e-5));
    let (sin, cos) = if quarter & 1 == 0 { (sin, cos) } else { (cos, -sin) };
    if quarter & 2 == 0 { (sin, cos) } else { (-sin, -cos) }
}

/// The direction that a circle around `w` has at `turn` of a full turn: `sine` away from it, `cosine` along it.
#[inline(always)]
pub(crate) fn around(w: Vec3, turn: f32, sine: f32, cosine: f32) -> Vec3 {
    let (u, v) = basis(w);
    let (sin, cos) = sin_cos_turns(turn);
    u * (sine * cos) + v * (sine * sin) + w * cosine
}

/// A direction of the hemisphere around `normal`, its density proportional to the cosine.
#[inline(always)]
pub(crate) fn cosine_hemisphere(normal: Vec3, [u, v]: [f32; 2]) -> Vec3 {
    around(normal, u, v.sqrt(), (1.0 - v).sqrt())
}

/// Arctangent of y/x in the right quadrant, -π to π; error below 3e-7.
pub(crate) fn atan2(y: f32, x: f32) -> f32 {
    let (ax, ay) = (f64::from(x.abs()), f64::from(y.abs()));
    if ax == 0.0 && ay == 0.0 {
        return 0.0;
    }
    let steep = ay > ax;
    let angle = atan_unit(if steep { ax / ay } else { ay / ax });
    let angle = if steep { std::f64::consts::FRAC_PI_2 - angle } else { angle };
    let angle = if x.is_sign_negative() { std::f64::consts::PI - angle } else { angle };
    (if y.is_sign_negative() { -angle } else { angle }) as f32
}

/// Arctangent on 0 to 1: half the angle twice (tan(θ/2) = t / (1 + √(1 + t²))), then the series.
fn atan_unit(t: f64) -> f64 {
    let half = |t: f64| t / (1.0 + (1.0 + t * t).sqrt());
    let t = half(half(t));
    let t2 = t * t;
    // |t| ≤ tan(π/16) ≈ 0.199: the first term left out is below 1e-13.
    let series = (0..8).rev().fold(0.0, |sum, k| {
        let term = 1.0 / f64::from(2 * k + 1);
        sum * t2 + if k % 2 == 0 { term } else { -term }
    });
    4.0 * t * series
}

/// Arccosine, 0 to π, of a number from -1 to 1; error below 5e-7 ([Abramowitz, Stegun 1964] 4.4.46).
#[inline(always)]
pub(crate) fn acos(x: f32) -> f32 {
    let a = x.abs();
    let terms = [
        std::f32::consts::FRAC_PI_2,
        -0.214_598_8,
        0.088_978_99,
        -0.050_174_305,
        0.030_891_88,
        -0.017_088_126,
        0.006_670_09,
        -0.001_262_491_1,
    ];
    let angle = (1.0 - a).max(0.0).sqrt() * terms.iter().rev().fold(0.0, |sum, term| sum * a + term);
    if x < 0.0 { std::f32::consts::PI - angle } else { angle }
}

/// Tangent of an angle in radians within ±π/2.
pub(crate) fn tan_degrees(degrees: f64) -> f64 {
    let (sin, cos) = sin_cos_degrees(degrees);
    sin / cos
}

/// The unit normal (b-a)×(c-a), also of triangles so small that its square underflows.
pub(crate) fn unit_normal(a: Vec3, b: Vec3, c: Vec3) -> Vec3 {
    let (ab, ac) = (b - a, c - a);
    let n = ab.cross(ac);
    if n.length_squared() > 1e-30 {
        return n.normalize();
    }
    ab.as_dvec3().cross(ac.as_dvec3()).normalize_or(glam::DVec3::Z).as_vec3()
}

/// A vector of unit length at a right angle to `w`, and the third one: (u, v) with w = u × v
/// ([Duff et al. 2017] "Building an Orthonormal Basis, Revisited").
#[inline(always)]
pub(crate) fn basis(w: Vec3) -> (Vec3, Vec3) {
    let sign = 1.0f32.copysign(w.z);
    let a = -1.0 / (sign + w.z);
    let b = w.x * w.y * a;
    (Vec3::new(1.0 + sign * w.x * w.x * a, sign * b, -sign * w.x), Vec3::new(b, sign + w.y * w.y * a, -w.y))
}

/// Axes of a surface: two along it, the second as near to `along` as can be, and its normal. Without `along` the choice is
/// Sunflow's (format reference, §0: `basisW`, `basisWV`).
pub(crate) fn frame(w: Vec3, along: Option<Vec3>) -> [Vec3; 3] {
    if let Some(u) = along.and_then(|v| v.cross(w).try_normalize()) {
        return [u, w.cross(u), w];
    }
    let a = w.abs();
    let v = if a.x < a.y && a.x < a.z {
        Vec3::new(0.0, w.z, -w.y)
    } else if a.y < a.z {
        Vec3::new(w.z, 0.0, -w.x)
    } else {
        Vec3::new(w.y, -w.x, 0.0)
    };
    let v = v.normalize_or(Vec3::X);
    [v.cross(w), v, w]
}

/// `point`, moved off its surface along `side` by a few units in the last place of its coordinates, so that a ray
/// from there does not meet the surface again ([Wächter, Binder 2019] "A Fast and Robust Method for Avoiding
/// Self-Intersection", Ray Tracing Gems, ch. 6).
pub(crate) fn offset(point: Vec3, side: Vec3) -> Vec3 {
    let shift = |p: f32, n: f32| {
        if p.abs() < 1.0 / 32.0 {
            return p + n / 65536.0;
        }
        let step = (n * 256.0) as i32;
        let bits = p.to_bits() as i32;
        f32::from_bits(if p < 0.0 { bits - step } else { bits + step } as u32)
    };
    Vec3::new(shift(point.x, side.x), shift(point.y, side.y), shift(point.z, side.z))
}

/// `base` to the power of `exponent`, for a base from 0 to 1 and any exponent of 0 or more.
pub(crate) fn pow(base: f32, exponent: f32) -> f32 {
    if exponent == 0.0 {
        return 1.0;
    }
    if base < f32::MIN_POSITIVE {
        return 0.0;
    }
    exp(f64::from(exponent) * ln(f64::from(base))) as f32
}

#[cfg(test)]
#[allow(clippy::disallowed_methods, reason = "our functions are held against the platform's")]
mod tests {
    use super::*;

    #[test]
    fn turns_are_degrees() {
        for i in -4000..=4000 {
            let turns = i as f32 / 1000.0;
            let (sin, cos) = sin_cos_turns(turns);
            let (exact_sin, exact_cos) = sin_cos_degrees(f64::from(turns) * 360.0);
            assert!((f64::from(sin) - exact_sin).abs() < 2e-7 && (f64::from(cos) - exact_cos).abs() < 2e-7, "{turns}");
        }
        assert_eq!((sin_cos_turns(0.25), sin_cos_turns(0.5)), ((1.0, 0.0), (0.0, -1.0)));
    }

    #[test]
    fn trigonometry_is_exact_at_quarter_turns_and_close_elsewhere() {
        assert_eq!(sin_cos_degrees(90.0), (1.0, 0.0));
        assert_eq!(sin_cos_degrees(-180.0), (0.0, -1.0));
        assert_eq!(sin_cos_degrees(270.0), (-1.0, 0.0));
        for i in -2000..2000 {
            let angle = f64::from(i) * 0.37;
            let (sin, cos) = sin_cos_degrees(angle);
            let (s, c) = angle.to_radians().sin_cos();
            assert!((sin - s).abs() < 1e-14 && (cos - c).abs() < 1e-14, "{angle}");
            let (y, x) = (s as f32, c as f32);
            assert!((atan2(y, x) - y.atan2(x)).abs() < 5e-7, "{angle}");
            assert!((f64::from(acos(x)) - f64::from(x).acos()).abs() < 5e-7, "{angle}: {} {}", acos(x), x.acos());
        }
    }

    #[test]
    fn exponentials_and_logarithms_are_close() {
        for i in -300..300 {
            let x = f64::from(i) * 0.21;
            assert!((exp(x) / x.exp() - 1.0).abs() < 2e-15, "{x}");
            assert!((ln(x.exp()) - x).abs() < 1e-14 * x.abs().max(1.0), "{x}");
        }
        assert!((pow(0.93, 50.0) - 0.93f32.powf(50.0)).abs() < 1e-7);
        assert_eq!(pow(0.0, 50.0), 0.0);
        assert_eq!(pow(0.5, 0.0), 1.0);
    }

    #[test]
    fn a_basis_is_orthonormal_and_right_handed() {
        for w in [Vec3::X, Vec3::NEG_Z, Vec3::new(0.6, -0.64, 0.48), Vec3::Z] {
            let (u, v) = basis(w);
            assert!((u.cross(v) - w).length() < 1e-6, "{w}");
        }
    }
}
