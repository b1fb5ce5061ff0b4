//! The display curve of sRGB, with Sunflow's constants (format reference, §3.1), by arithmetic and square roots alone, so
//! that every platform agrees to the bit.

/// Where the curve's straight foot ends.
const FOOT: f64 = 0.00304;
/// Slope of the foot.
const FOOT_SLOPE: f64 = 12.923057;
const SCALE: f64 = 1.0550005;
const OFFSET: f64 = 0.05500052;

/// Linear light to display value, clamped to 0…1.
pub fn srgb_encode(linear: f64) -> f64 {
    if linear >= 1.0 {
        1.0
    } else if linear > FOOT {
        // v^(1/2.4) = v^(1/4) · v^(1/6)
        SCALE * (linear.sqrt().sqrt() * cube_root(linear).sqrt()) - OFFSET
    } else if linear > 0.0 {
        FOOT_SLOPE * linear
    } else {
        0.0
    }
}

/// Display value to linear light, clamped to 0…1.
pub fn srgb_decode(display: f64) -> f64 {
    if display >= 1.0 {
        1.0
    } else if display > FOOT * FOOT_SLOPE {
        let x = (display + OFFSET) / SCALE;
        let root = fifth_root(x);
        x * x * (root * root) // x^2.4
    } else if display > 0.0 {
        display / FOOT_SLOPE
    } else {
        0.0
    }
}

/// The cube root of a number between 0.003 and 1, to the last bit or two.
fn cube_root(x: f64) -> f64 {
    // A third of the exponent is a guess within 6 %; each of Halley's steps then triples the number of digits.
    let mut y = f64::from_bits(x.to_bits() / 3 + (715_094_163 << 32));
    for _ in 0..3 {
        let cube = y * y * y;
        y *= (cube + x + x) / (cube + cube + x);
    }
    y
}

/// The fifth root of a number between 0.08 and 1, to the last bit or two.
fn fifth_root(x: f64) -> f64 {
    // Newton from the middle of the range of roots, 0.6 to 1: five steps suffice, one is spare.
    let mut y = 0.8;
    for _ in 0..6 {
        let square = y * y;
        y = (4.0 * y + x / (square * square)) * 0.2;
    }
    y
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[allow(clippy::disallowed_methods, reason = "our curve is held against the platform's power function")]
    fn curve_agrees_with_the_platform_power_function() {
        for i in 0..=100_000 {
            let v = f64::from(i) / 100_000.0;
            let expected = if v <= FOOT { FOOT_SLOPE * v } else { SCALE * v.powf(1.0 / 2.4) - OFFSET };
            assert!((srgb_encode(v) - expected).abs() < 1e-7 * f64::from(u8::from(v == 1.0)) + 1e-14, "at {v}");
            let back = if v <= FOOT * FOOT_SLOPE { v / FOOT_SLOPE } else { ((v + OFFSET) / SCALE).powf(2.4) };
            assert!((srgb_decode(v) - back).abs() < 1e-7 * f64::from(u8::from(v == 1.0)) + 1e-14, "at {v}");
        }
    }

    #[test]
    fn encoding_and_decoding_are_inverse() {
        for i in 0..=1000 {
            let value = f64::from(i) / 1000.0;
            assert!((srgb_decode(srgb_encode(value)) - value).abs() < 1e-6, "{value}");
        }
    }
}
