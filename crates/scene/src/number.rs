//! Numbers as Sunflow's language, Java, spells them.
//!
//! A whole number is decimal with an optional sign. A number may also have a trailing `f` or `d`, hexadecimal digits
//! with a binary exponent, or be one of `NaN` and `Infinity` (format reference, §1.2).

use std::str::FromStr;

/// The number types that are read.
pub(crate) trait Float: FromStr + Copy {
    /// From twice the precision, rounding to nearest.
    fn from_f64(value: f64) -> Self;
    /// Neither infinite nor not a number.
    fn is_finite(self) -> bool;
}

impl Float for f32 {
    fn from_f64(value: f64) -> Self {
        value as f32
    }

    fn is_finite(self) -> bool {
        f32::is_finite(self)
    }
}

impl Float for f64 {
    fn from_f64(value: f64) -> Self {
        value
    }

    fn is_finite(self) -> bool {
        f64::is_finite(self)
    }
}

/// The number written in `bytes`, if all of it is one. Too large becomes infinite, as in Java.
#[inline]
pub(crate) fn float<T: Float>(bytes: &[u8]) -> Option<T> {
    // The standard library knows words that Java does not (`inf`, `nan`); they all end in a letter.
    if let [.., b'0'..=b'9' | b'.'] = bytes
        && let Some(value) = std::str::from_utf8(bytes).ok().and_then(|text| text.parse().ok())
    {
        return Some(value);
    }
    unusual(bytes)
}

#[cold]
fn unusual<T: Float>(bytes: &[u8]) -> Option<T> {
    let (sign, unsigned) = match bytes {
        [b'-', rest @ ..] => (-1.0, rest),
        [b'+', rest @ ..] => (1.0, rest),
        _ => (1.0, bytes),
    };
    match unsigned {
        b"NaN" => return Some(T::from_f64(f64::NAN)),
        b"Infinity" => return Some(T::from_f64(sign * f64::INFINITY)),
        [b'0', b'x' | b'X', digits @ ..] => return hexadecimal(digits).map(|value| T::from_f64(sign * value)),
        _ => {}
    }
    match bytes {
        [number @ .., b'f' | b'F' | b'd' | b'D'] if matches!(number.last(), Some(b'0'..=b'9' | b'.')) => {
            std::str::from_utf8(number).ok()?.parse().ok()
        }
        _ => None,
    }
}

/// `h.hhhp±d`: the exponent is obligatory.
fn hexadecimal(bytes: &[u8]) -> Option<f64> {
    let bytes = match bytes {
        [rest @ .., b'f' | b'F' | b'd' | b'D'] => rest,
        _ => bytes,
    };
    let split = bytes.iter().position(|b| matches!(b, b'p' | b'P'))?;
    let (mantissa, exponent) = (&bytes[..split], &bytes[split + 1..]);
    let (mut value, mut scale, mut digits, mut fraction) = (0.0_f64, 0_i32, 0, false);
    for &byte in mantissa {
        if byte == b'.' && !fraction {
            fraction = true;
            continue;
        }
        value = value * 16.0 + f64::from(char::from(byte).to_digit(16)?);
        scale -= if fraction { 4 } else { 0 };
        digits += 1;
    }
    let exponent: i32 = std::str::from_utf8(exponent).ok()?.parse().ok()?;
    // Beyond a thousand digits the value is infinite anyway.
    (digits > 0 && digits < 1000).then(|| value * 2.0_f64.powi(exponent.saturating_add(scale).clamp(-4000, 4000)))
}

/// The whole number written in `bytes`, if all of it is one.
#[inline]
pub(crate) fn int(bytes: &[u8]) -> Option<i64> {
    if bytes.len() <= 9 && bytes.iter().all(u8::is_ascii_digit) {
        return bytes.iter().map(|b| i64::from(b - b'0')).reduce(|value, digit| value * 10 + digit);
    }
    std::str::from_utf8(bytes).ok()?.parse().ok()
}

/// The index written in `bytes`, if it is one that fits.
#[inline]
pub(crate) fn index(bytes: &[u8]) -> Option<u32> {
    int(bytes).and_then(|value| u32::try_from(value).ok())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_in_java_syntax_are_read() {
        for (text, value) in [
            ("1", 1.0),
            ("-.5", -0.5),
            ("3.", 3.0),
            ("+3", 3.0),
            ("1e-5", 1e-5),
            ("1E+5", 1e5),
            ("1f", 1.0),
            (".5D", 0.5),
            ("1e2d", 100.0),
            ("01.0", 1.0),
            ("0x1.8p1", 3.0),
            ("-0X.8p0f", -0.5),
            ("-0x1p-1", -0.5),
        ] {
            assert_eq!(float::<f32>(text.as_bytes()), Some(value as f32), "{text}");
            assert_eq!(float::<f64>(text.as_bytes()), Some(value), "{text}");
        }
        assert!(float::<f32>(b"NaN").is_some_and(f32::is_nan));
        assert_eq!(float::<f32>(b"-Infinity"), Some(f32::NEG_INFINITY));
        assert_eq!(float::<f32>(b"1e40"), Some(f32::INFINITY));
    }

    #[test]
    fn what_java_refuses_is_refused() {
        for text in ["", "inf", "nan", "infinity", "+inf", "1e", "f", "-", ".", "1,5", "1.0.0", "0x10", "0xp1", "1_0"] {
            assert_eq!(float::<f32>(text.as_bytes()), None, "{text}");
        }
    }

    #[test]
    fn whole_numbers_have_neither_fraction_nor_exponent() {
        assert_eq!(int(b"12"), Some(12));
        assert_eq!(int(b"-12"), Some(-12));
        assert_eq!(int(b"+7"), Some(7));
        assert_eq!(int(b"2000000000"), Some(2_000_000_000));
        for text in ["1.0", "1e3", "", "-", "99999999999999999999", "0x1"] {
            assert_eq!(int(text.as_bytes()), None, "{text}");
        }
        assert_eq!(index(b"-1"), None);
        assert_eq!(index(b"4294967295"), Some(u32::MAX));
    }
}
