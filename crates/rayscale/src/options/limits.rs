//! The options that say what errors are put up with.

use clap::Args;
use harness::judge::{Counted, Limits};

/// Limits of errors.
#[derive(Clone, Copy, Debug, Default, PartialEq, Args)]
pub struct LimitOptions {
    /// Errors that may be made in a million rays: holes, phantoms, and hits off by more than 10^-5 of the scene's extent
    #[arg(long, value_name = "PER MILLION", value_parser = per_million)]
    pub max_error: Option<f64>,
    /// Holes that may be left in a million rays: the nearest surface is missed
    #[arg(long, value_name = "PER MILLION", value_parser = per_million)]
    pub max_holes: Option<f64>,
    /// How far a hit of the right surface may be from its place, as a fraction of the scene's extent
    #[arg(long, value_name = "FRACTION", value_parser = fraction)]
    pub max_displacement: Option<f64>,
    /// Count hits of another object in the same place as errors too
    #[arg(long)]
    pub identity: bool,
}

impl LimitOptions {
    /// The option given first, if any is.
    pub const fn given(&self) -> Option<&'static str> {
        match self {
            Self { max_error: Some(_), .. } => Some("--max-error"),
            Self { max_holes: Some(_), .. } => Some("--max-holes"),
            Self { max_displacement: Some(_), .. } => Some("--max-displacement"),
            Self { identity: true, .. } => Some("--identity"),
            _ => None,
        }
    }

    /// What is asked for; nothing where no limit is given.
    pub const fn limits(&self) -> Limits {
        let counted = if self.identity { Counted::Identity } else { Counted::Visible };
        Limits { errors: self.max_error, holes: self.max_holes, displacement: self.max_displacement, counted }
    }

    /// The same, or one error in a million where no limit is given.
    pub fn limits_or_default(&self) -> Limits {
        let limits = self.limits();
        if limits.any() { limits } else { Limits { counted: limits.counted, ..Limits::default() } }
    }
}

/// A number of errors in a million rays.
fn per_million(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|rate| (0.0..=1e6).contains(rate));
    number.ok_or_else(|| "must be a number of errors in a million rays, from 0 to 1000000".to_owned())
}

/// A distance in extents.
fn fraction(text: &str) -> Result<f64, String> {
    let number = text.parse().ok().filter(|fraction: &f64| *fraction >= 0.0 && fraction.is_finite());
    number.ok_or_else(|| "must be a fraction of the scene's extent, such as 1e-4".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_are_numbers() {
        assert!(per_million("-1").is_err() && per_million("NaN").is_err() && per_million("0.5") == Ok(0.5));
        assert!(fraction("-1").is_err() && fraction("inf").is_err() && fraction("1e-4") == Ok(1e-4));
        let holes = LimitOptions { max_holes: Some(0.0), ..LimitOptions::default() };
        assert_eq!(holes.limits_or_default(), Limits { holes: Some(0.0), ..Limits::NONE });
        assert_eq!(LimitOptions::default().limits_or_default(), Limits::default());
    }
}
