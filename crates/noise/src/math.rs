//! Elementary functions over any [`Real`], the same bits on every machine.
//!
//! Platform libraries disagree in the last digits, so nothing that reaches a pixel may call them. Error bounds here are
//! for single precision / double precision, and tested. Reductions and single-precision polynomials after S. Moshier,
//! Cephes (`sinf.c`, `expf.c`); double precision has Taylor polynomials and the split constants of fdlibm.

use crate::number::{Integer, Real};

/// The sine of an angle in radians: absolute error below 1.2e-7 / 3e-16 for |x| up to 8000. The error grows with |x| past
/// that; the result stays within ±1.0000001 for every finite angle. NaN where the angle is not finite.
#[inline(always)]
pub fn sin<R: Real>(x: R) -> R {
    let (quarter, r) = reduce(x);
    turn(quarter, r)
}

/// The cosine of an angle in radians. Errors as for [`sin`].
#[inline(always)]
pub fn cos<R: Real>(x: R) -> R {
    let (quarter, r) = reduce(x);
    turn(quarter + R::Int::constant(1), r)
}

/// The number of quarter turns nearest to `x`, and what is left, from −π/4 to π/4. (Far out, where the rest is lost, it is
/// clamped there.)
#[inline(always)]
fn reduce<R: Real>(x: R) -> (R::Int, R) {
    // π/2 in three parts; the first ones have so few bits that their products with a small whole number are exact.
    let parts = if R::DOUBLE {
        [1.570_796_326_734_125_6, 6.077_100_506_303_966e-11, 2.022_266_248_795_950_6e-21]
    } else {
        [1.570_312_5, 4.837_512_969_970_703e-4, 7.549_789_954_891_882e-8]
    };
    let turns = (x * R::constant(std::f64::consts::FRAC_2_PI) + R::constant(0.5)).floor();
    let mut rest = x;
    for part in parts {
        rest = rest - turns * R::constant(part);
    }
    let limit = R::constant(std::f64::consts::FRAC_PI_4 * 1.002);
    // The limit first: a NaN in the second place survives.
    let rest = R::select(limit.less(rest), limit, rest);
    let rest = R::select(rest.less(-limit), -limit, rest);
    (turns.to_int(), rest)
}

/// The sine of `r` plus so many quarter turns, for |r| ≤ π/4.
#[inline(always)]
fn turn<R: Real>(quarter: R::Int, r: R) -> R {
    let square = r * r;
    let (sine, cosine) = if R::DOUBLE {
        let sine = polynomial(
            square,
            [
                1.0,
                -1.0 / 6.0,
                1.0 / 120.0,
                -1.0 / 5_040.0,
                1.0 / 362_880.0,
                -1.0 / 39_916_800.0,
                1.0 / 6_227_020_800.0,
                -1.0 / 1_307_674_368_000.0,
                1.0 / 355_687_428_096_000.0,
            ],
        );
        let cosine = polynomial(
            square,
            [
                1.0,
                -1.0 / 2.0,
                1.0 / 24.0,
                -1.0 / 720.0,
                1.0 / 40_320.0,
                -1.0 / 3_628_800.0,
                1.0 / 479_001_600.0,
                -1.0 / 87_178_291_200.0,
                1.0 / 20_922_789_888_000.0,
            ],
        );
        (sine * r, cosine)
    } else {
        let sine = polynomial(square, [-1.666_665_461_1e-1, 8.332_160_873_6e-3, -1.951_529_589_1e-4]);
        let cosine = polynomial(
            square,
            [1.0, -0.5, 4.166_664_568_298_827e-2, -1.388_731_625_493_765e-3, 2.443_315_711_809_948e-5],
        );
        (sine * square * r + r, cosine)
    };
    let zero = R::Int::constant(0);
    let value = R::select((quarter & R::Int::constant(1)).equals(zero), sine, cosine);
    R::select((quarter & R::Int::constant(2)).equals(zero), value, -value)
}

/// e to the `x`: relative error below 2e-7 / 5e-16. Infinite or zero beyond the range of the number type.
#[inline(always)]
pub fn exp<R: Real>(x: R) -> R {
    let limit = if R::DOUBLE { 1000.0 } else { 150.0 };
    let x = R::select(R::constant(limit).less(x), R::constant(limit), x);
    let x = R::select(x.less(R::constant(-limit)), R::constant(-limit), x);
    let [high, low] = ln_2::<R>();
    let power = (x * R::constant(std::f64::consts::LOG2_E) + R::constant(0.5)).floor();
    let r = x - power * high - power * low;
    let factor = if R::DOUBLE { exp_polynomial::<R, 14>(r) } else { exp_polynomial::<R, 7>(r) };
    // In two steps, so that each stays within the normal exponents.
    let half = (power * R::constant(0.5)).floor();
    factor.times_power_of_two(half.to_int()).times_power_of_two((power - half).to_int())
}

/// Taylor's polynomial of the exponential function, of degree `DEGREE`, for |r| ≤ ln 2 / 2.
#[inline(always)]
fn exp_polynomial<R: Real, const DEGREE: usize>(r: R) -> R {
    let mut sum = R::constant(1.0);
    // Counted up, the loop is unrolled, and its divisions are constants.
    for n in 0..DEGREE {
        sum = sum * r * R::constant(1.0 / (DEGREE - n) as f64) + R::constant(1.0);
    }
    sum
}

/// The natural logarithm: error below 2e-7 / 5e-16, relative or (near x = 1, where the result vanishes) absolute. Minus
/// infinity at 0, NaN below 0, infinity at infinity.
#[inline(always)]
pub fn ln<R: Real>(x: R) -> R {
    let (zero, one) = (R::constant(0.0), R::constant(1.0));
    // Numbers below the normal ones are brought among them.
    let tiny = x.less(R::constant(if R::DOUBLE { f64::MIN_POSITIVE } else { f64::from(f32::MIN_POSITIVE) }));
    let normal = R::select(tiny, x * R::constant(18_446_744_073_709_551_616.0), x);
    let (mantissa, exponent) = normal.split_exponent();
    let exponent = R::select(tiny, exponent - R::constant(64.0), exponent);
    let upper = R::constant(std::f64::consts::SQRT_2).less(mantissa);
    let mantissa = R::select(upper, mantissa * R::constant(0.5), mantissa);
    let exponent = R::select(upper, exponent + one, exponent);
    // ln m = 2 artanh((m − 1) / (m + 1))
    let ratio = (mantissa - one) / (mantissa + one);
    let square = ratio * ratio;
    let series = if R::DOUBLE { artanh_series::<R, 11>(square) } else { artanh_series::<R, 4>(square) };
    let [high, low] = ln_2::<R>();
    let double = ratio + ratio;
    let result = exponent * high + (double + (double * series + exponent * low));
    // NaN stays NaN; −1/0 is minus infinity.
    let result = R::select(zero.less(x), result + x * zero, (x.abs() - one) / zero);
    let result = R::select(x.less(zero), R::constant(f64::NAN), result);
    let infinite = R::constant(if R::DOUBLE { f64::MAX } else { f64::from(f32::MAX) }).less(x);
    R::select(infinite, x, result)
}

/// artanh(r) / r − 1 by its Taylor polynomial with so many terms, for the square of r.
#[inline(always)]
fn artanh_series<R: Real, const TERMS: u32>(square: R) -> R {
    let mut series = R::constant(0.0);
    for n in 0..TERMS {
        series = (series + R::constant(1.0 / f64::from(2 * (TERMS - n) + 1))) * square;
    }
    series
}

/// `x` to the power `y`, for positive `x`: relative error below (1 + |y ln x|) · 3e-7 / 1e-15.
#[inline(always)]
pub fn pow<R: Real>(x: R, y: R) -> R {
    exp(y * ln(x))
}

/// ln 2 in two parts, the first with few bits.
#[inline(always)]
fn ln_2<R: Real>() -> [R; 2] {
    let parts = if R::DOUBLE {
        [0.693_147_180_369_123_8, 1.908_214_929_270_587_7e-10]
    } else {
        [0.693_359_375, -2.121_944_4e-4]
    };
    [R::constant(parts[0]), R::constant(parts[1])]
}

/// Horner's scheme; the constant term first.
#[inline(always)]
fn polynomial<R: Real, const N: usize>(x: R, coefficients: [f64; N]) -> R {
    let mut sum = R::constant(coefficients[N - 1]);
    for &coefficient in coefficients[..N - 1].iter().rev() {
        sum = sum * x + R::constant(coefficient);
    }
    sum
}
