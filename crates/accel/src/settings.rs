//! Values of builders' settings, read from text.
//!
//! Every function's error is a text that names the value and says what would do.

use crate::KernelId;
use crate::simd::Level;
use std::fmt::Display;
use std::str::FromStr;

/// A ray-triangle test by its id.
///
/// # Errors
/// There is none of that id.
pub fn kernel(value: &str) -> Result<KernelId, String> {
    KernelId::from_id(value).ok_or_else(|| none_of(value, KernelId::ALL.map(KernelId::id)))
}

/// An instruction set by its id.
///
/// # Errors
/// There is none of that id, or this machine does not have it.
pub fn simd(value: &str) -> Result<Level, String> {
    let level = Level::from_id(value).filter(|level| level.available());
    level.ok_or_else(|| none_of(value, Level::here().map(Level::id)))
}

/// A whole number from `least` to `most`.
///
/// # Errors
/// It is no number, or beyond these.
pub fn number<T: FromStr + PartialOrd + Display>(value: &str, least: T, most: T) -> Result<T, String> {
    match value.parse() {
        Ok(number) if (&least..=&most).contains(&&number) => Ok(number),
        Ok(_) => Err(format!("'{value}' is not from {least} to {most}")),
        Err(_) => Err(format!("'{value}' is not a whole number")),
    }
}

/// A number of bytes.
///
/// # Errors
/// It is no whole number.
pub fn bytes(value: &str) -> Result<u128, String> {
    value.parse().map_err(|_| format!("'{value}' is not a number of bytes"))
}

/// Says that a value is none of those known.
pub fn none_of<'a>(value: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    let known: Vec<_> = known.into_iter().collect();
    format!("'{value}' is none of {}", known.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_read_or_named() {
        assert_eq!(kernel("watertight"), Ok(KernelId::Watertight));
        assert_eq!(simd("portable"), Ok(Level::Portable));
        assert_eq!((number("7", 1, 7), bytes("123")), (Ok(7), Ok(123)));
        assert_eq!(number("8", 1, 7).unwrap_err(), "'8' is not from 1 to 7");
        assert!(number("x", 1, 7).unwrap_err().contains("'x'") && bytes("-1").unwrap_err().contains("'-1'"));
        assert!(kernel("tight").unwrap_err().contains("moller-trumbore"));
        assert!(simd("mmx").unwrap_err().contains("portable"));
    }
}
