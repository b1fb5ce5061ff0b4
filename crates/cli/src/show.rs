//! Results as people and programs read them.

use std::time::Duration;

/// All digits that are needed to read the same number back, and no more.
pub fn shortest(value: f64) -> String {
    // Very small ones would be mostly zeros.
    if value != 0.0 && value.abs() < 1e-5 { format!("{value:e}") } else { value.to_string() }
}

/// A duration with three digits: `640 ms`, `1.25 s`, `2 min 05 s`.
pub fn duration(duration: Duration) -> String {
    let seconds = duration.as_secs_f64();
    if seconds < 0.01 {
        format!("{:.1} ms", seconds * 1e3)
    } else if seconds < 0.9995 {
        format!("{:.0} ms", seconds * 1e3)
    } else if seconds < 99.95 {
        format!("{seconds:.2} s")
    } else {
        let whole = seconds.round() as u64;
        format!("{} min {:02} s", whole / 60, whole % 60)
    }
}

/// A file size: `517 bytes`, `21.3 kB`, `4.0 MB`.
pub fn size(bytes: usize) -> String {
    match bytes {
        0..1_000 => format!("{bytes} bytes"),
        1_000..999_950 => format!("{:.1} kB", bytes as f64 / 1e3),
        _ => format!("{:.1} MB", bytes as f64 / 1e6),
    }
}

/// A value as indented JSON, its fields in the order of their declaration.
pub fn json_text(value: &impl serde::Serialize) -> String {
    serde_json::to_string_pretty(value).expect("plain data can be written as JSON")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_exact() {
        assert_eq!(shortest(-0.262939453125), "-0.262939453125");
        assert_eq!(shortest(0.14208000000000043), "0.14208000000000043");
        assert_eq!(shortest(0.0), "0");
        assert_eq!(shortest(1.5e-9), "1.5e-9");
    }

    #[test]
    fn durations_and_sizes_have_units() {
        assert_eq!(duration(Duration::from_micros(3_210)), "3.2 ms");
        assert_eq!(duration(Duration::from_millis(640)), "640 ms");
        assert_eq!(duration(Duration::from_millis(1_254)), "1.25 s");
        assert_eq!(duration(Duration::from_secs(125)), "2 min 05 s");
        assert_eq!(size(517), "517 bytes");
        assert_eq!(size(21_349), "21.3 kB");
        assert_eq!(size(4_000_000), "4.0 MB");
    }
}
