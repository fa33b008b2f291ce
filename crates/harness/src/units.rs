//! Times, bytes and counts for people; files hold them raw.

use std::time::Duration;

/// `12.3 ns`, `4.56 ms`, `1.20 s`: three digits that count.
pub fn time(ns: f64) -> String {
    scaled(ns, 1000.0, &["ns", "µs", "ms", "s"])
}

/// `512 B`, `4.10 MiB`: three digits that count.
pub fn bytes(bytes: u64) -> String {
    if bytes < 1024 {
        return format!("{bytes} B");
    }
    scaled(bytes as f64, 1024.0, &["B", "KiB", "MiB", "GiB", "TiB"])
}

/// A duration as people write it: `540` or `540s`, `9m`, `1h30m`, `500ms`.
///
/// # Errors
/// What is none, with an example.
pub fn duration(text: &str) -> Result<Duration, String> {
    let wrong = || "must be a duration such as 90s, 10m or 1h30m".to_owned();
    let mut rest = text.trim();
    let mut seconds = 0.0;
    while !rest.is_empty() {
        let digits = rest.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(rest.len());
        let (number, tail) = rest.split_at(digits);
        let letters = tail.find(|c: char| !c.is_ascii_alphabetic()).unwrap_or(tail.len());
        let (unit, tail) = tail.split_at(letters);
        let scale = match unit {
            "" | "s" => 1.0,
            "ms" => 1e-3,
            "m" | "min" => 60.0,
            "h" => 3600.0,
            _ => return Err(wrong()),
        };
        seconds += scale * number.parse::<f64>().map_err(|_| wrong())?;
        rest = tail.trim_start();
    }
    Duration::try_from_secs_f64(seconds).ok().filter(|d| !d.is_zero()).ok_or_else(wrong)
}

/// `66,450`
pub fn count(n: u64) -> String {
    let digits = n.to_string();
    let mut text = String::with_capacity(digits.len() + digits.len() / 3);
    for (i, digit) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// `0.05`, `1.5`, `1234`: so many digits that count, without zeros behind the point; powers of ten where a figure is
/// below 10⁻⁴ or from 10⁶ on.
pub fn significant(value: f64, digits: usize) -> String {
    let size = value.abs();
    if !value.is_finite() {
        return NONE.into();
    }
    if size == 0.0 {
        return "0".into();
    }
    let last = digits.max(1) - 1;
    if !(1e-4..1e6).contains(&size) {
        return format!("{value:.last$e}");
    }
    let behind = (last as i32 - size.log10().floor() as i32).max(0) as usize;
    let text = format!("{value:.behind$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// Three digits that count, without zeros behind the point.
pub fn figure(value: f64) -> String {
    significant(value, 3)
}

/// `950`, `1.5k`, `2M`, `1.23G`: three digits that count and what they count.
pub fn short(value: f64) -> String {
    let (value, unit) = match value {
        v if v >= 1e9 => (v / 1e9, "G"),
        v if v >= 1e6 => (v / 1e6, "M"),
        v if v >= 1e3 => (v / 1e3, "k"),
        v => (v, ""),
    };
    format!("{}{unit}", figure(value))
}

/// `1.5×`: so many times as much.
pub fn times(ratio: f64) -> String {
    format!("{}×", figure(ratio))
}

/// `0.872`: a ratio with three digits behind the point, to be read in columns.
pub fn ratio(value: f64) -> String {
    if value.abs() < 1e6 { format!("{value:.3}") } else { figure(value) }
}

/// What stands for a figure that there is none of.
const NONE: &str = "–";

fn scaled(mut value: f64, step: f64, units: &[&str]) -> String {
    if !value.is_finite() {
        return NONE.into();
    }
    let mut unit = 0;
    // Rounding to three digits must not print 1000 of a unit that has a next one.
    while value.abs() >= step - 0.5 && unit + 1 < units.len() {
        value /= step;
        unit += 1;
    }
    let digits = match value.abs() {
        // Neither hundreds of digits nor zeros alone say how much it is.
        v if v >= 1e6 || (v > 0.0 && v < 0.005) => return format!("{value:.2e} {}", units[unit]),
        v if v >= 99.95 => 0,
        v if v >= 9.995 => 1,
        _ => 2,
    };
    format!("{value:.digits$} {}", units[unit])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_digits_that_count() {
        for (ns, text) in [
            (0.0, "0.00 ns"),
            (12.34, "12.3 ns"),
            (999.4, "999 ns"),
            (999.7, "1.00 µs"),
            (1.5e6, "1.50 ms"),
            (61e9, "61.0 s"),
            (1e308, "1.00e299 s"),
            (5e-324, "4.94e-324 ns"),
            (f64::NAN, "–"),
        ] {
            assert_eq!(time(ns), text);
        }
        for (n, text) in [(0, "0 B"), (1023, "1023 B"), (4 << 20, "4.00 MiB"), ((1 << 30) - 1, "1.00 GiB")] {
            assert_eq!(bytes(n), text);
        }
        assert_eq!(count(66_450), "66,450");
        assert_eq!(count(7), "7");
        assert_eq!(count(1_234_567), "1,234,567");
    }

    #[test]
    fn figures_are_short() {
        for (v, text) in [
            (0.05, "0.05"),
            (1.0, "1"),
            (20.0, "20"),
            (0.123_45, "0.123"),
            (1234.5, "1234"),
            (-9.996, "-10"),
            (2.5e-7, "2.50e-7"),
            (1e308, "1.00e308"),
            (f64::INFINITY, "–"),
        ] {
            assert_eq!(figure(v), text);
        }
        assert_eq!(significant(0.123_45, 4), "0.1235");
        for (v, text) in [(1500.0, "1.5k"), (2e6, "2M"), (1.234e9, "1.23G"), (950.0, "950")] {
            assert_eq!(short(v), text);
        }
        assert_eq!(
            (times(1.5), ratio(0.5), ratio(1e300)),
            ("1.5×".into(), "0.500".into(), "1.00e300".into())
        );
    }

    #[test]
    fn durations_are_read_as_written() {
        for (text, ms) in
            [("540", 540_000), ("90s", 90_000), ("1h30m", 5_400_000), ("1m 0.5s", 60_500), ("500ms", 500)]
        {
            assert_eq!(duration(text), Ok(Duration::from_millis(ms)), "{text}");
        }
        for text in ["", "0", "m", "-1s", "5 parsec", "1..2s", "inf", "1e9", "99999999999999999999s"] {
            assert!(duration(text).is_err(), "{text}");
        }
    }
}
