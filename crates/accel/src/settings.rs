//! Values of builders' settings, read from text.
//!
//! Every function's error is a text that names the value and says what would do.

use std::fmt::Display;
use std::str::FromStr;

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

/// The one of that name.
///
/// # Errors
/// There is none.
pub fn one_of<T>(
    value: &str,
    known: impl IntoIterator<Item = T>,
    id: impl Fn(&T) -> &'static str,
) -> Result<T, String> {
    let mut ids = Vec::new();
    for one in known {
        if id(&one) == value {
            return Ok(one);
        }
        ids.push(id(&one));
    }
    Err(none_of(value, ids))
}

/// `on` or `off`.
///
/// # Errors
/// It is neither.
pub fn switch(value: &str) -> Result<bool, String> {
    one_of(value, [true, false], |on| if *on { "on" } else { "off" })
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
        assert_eq!((number("7", 1, 7), bytes("123")), (Ok(7), Ok(123)));
        assert_eq!(number("8", 1, 7).unwrap_err(), "'8' is not from 1 to 7");
        assert_eq!((switch("on"), switch("off")), (Ok(true), Ok(false)));
        assert_eq!(switch("yes").unwrap_err(), "'yes' is none of on, off");
        assert!(number("x", 1, 7).unwrap_err().contains("'x'") && bytes("-1").unwrap_err().contains("'-1'"));
    }
}
