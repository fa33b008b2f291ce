//! Rays read from CSV.

use accel::{Ray, RayError, Vec3};
use std::io::{self, BufRead, Read};

/// The fields of a line, in order. `t_max` may be `inf`.
pub const FIELDS: [&str; 8] = ["ox", "oy", "oz", "dx", "dy", "dz", "t_min", "t_max"];

/// Why a file holds no rays. Lines count from 1, a header included.
#[derive(Debug, thiserror::Error)]
pub enum RaysCsvError {
    /// A first line that is neither numbers nor the names of the fields.
    #[error("line {line}: the header must be `{}`, not `{found}`", FIELDS.join(","))]
    Header {
        /// The line.
        line: u64,
        /// What is there.
        found: String,
    },
    /// Too few or too many fields.
    #[error("line {line}: {found} fields where a ray has 8 ({})", FIELDS.join(","))]
    Count {
        /// The line.
        line: u64,
        /// Fields found.
        found: usize,
    },
    /// A field that is no number.
    #[error("line {line}, field `{field}`: `{value}` is not a number")]
    Number {
        /// The line.
        line: u64,
        /// The field's name.
        field: &'static str,
        /// What is there.
        value: String,
    },
    /// Numbers that make no ray.
    #[error("line {line}, {}: {source}", place(*.source))]
    Ray {
        /// The line.
        line: u64,
        /// Why not.
        source: RayError,
    },
    /// A line that no eight numbers need.
    #[error("line {line}: more than {LONGEST} bytes in one line: these are not rays")]
    Long {
        /// The line.
        line: u64,
    },
    /// A file that can't be read.
    #[error(transparent)]
    Read(#[from] io::Error),
}

const fn place(error: RayError) -> &'static str {
    match error {
        RayError::Origin(_) | RayError::Far(_) => "fields `ox`, `oy`, `oz`",
        RayError::Direction(_) | RayError::ZeroDirection => "fields `dx`, `dy`, `dz`",
        RayError::Range(..) => "fields `t_min`, `t_max`",
    }
}

/// Bytes that a line may have.
const LONGEST: u64 = 4096;

/// Reads rays: one a line, [`FIELDS`] in this order, with or without a header that names them.
/// Blanks and quotes around fields and empty lines don't count.
///
/// The lines are split here and not by a general CSV reader, which counts lines otherwise than
/// editors do where some are empty.
///
/// # Errors
/// The first line that is no ray, with its number and field.
pub fn read_rays(mut input: impl BufRead) -> Result<Vec<Ray>, RaysCsvError> {
    let mut rays = Vec::new();
    let mut text = Vec::new();
    let mut is_first = true;
    for line in 1.. {
        text.clear();
        if Read::by_ref(&mut input).take(LONGEST).read_until(b'\n', &mut text)? == 0 {
            break;
        }
        if text.len() as u64 == LONGEST {
            return Err(RaysCsvError::Long { line });
        }
        if text.trim_ascii().is_empty() {
            continue;
        }
        let fields: Vec<&[u8]> = text.split(|b| *b == b',').map(bare).collect();
        if !(std::mem::take(&mut is_first) && header(&fields, line)?) {
            rays.push(ray(&fields, line)?);
        }
    }
    Ok(rays)
}

/// Whether these fields of the first line are a header.
fn header(fields: &[&[u8]], line: u64) -> Result<bool, RaysCsvError> {
    if fields == FIELDS.map(str::as_bytes) {
        return Ok(true);
    }
    // A line with a number in it is a ray with a slip rather than another header.
    if fields.iter().any(|field| number(field).is_some()) {
        return Ok(false);
    }
    Err(RaysCsvError::Header { line, found: show(&fields.join(&b',')) })
}

/// A field without what is around it.
fn bare(field: &[u8]) -> &[u8] {
    let field = field.trim_ascii();
    field.strip_prefix(b"\"").and_then(|f| f.strip_suffix(b"\"")).unwrap_or(field).trim_ascii()
}

fn ray(fields: &[&[u8]], line: u64) -> Result<Ray, RaysCsvError> {
    if fields.len() != FIELDS.len() {
        return Err(RaysCsvError::Count { line, found: fields.len() });
    }
    let mut values = [0.0; FIELDS.len()];
    for ((value, text), field) in values.iter_mut().zip(fields).zip(FIELDS) {
        *value = number(text).ok_or_else(|| RaysCsvError::Number { line, field, value: show(text) })?;
    }
    let [ox, oy, oz, dx, dy, dz, t_min, t_max] = values;
    let ray = Ray { origin: Vec3::new(ox, oy, oz), direction: Vec3::new(dx, dy, dz), t_min, t_max };
    ray.validate().map_err(|source| RaysCsvError::Ray { line, source })?;
    Ok(ray)
}

fn number(text: &[u8]) -> Option<f32> {
    std::str::from_utf8(text).ok()?.parse().ok()
}

/// Text for a message: printable and short.
fn show(text: &[u8]) -> String {
    const MAX: usize = 60;
    let printable = text.iter().take(MAX).flat_map(|b| std::ascii::escape_default(*b)).map(char::from);
    let mut shown: String = printable.collect();
    if text.len() > MAX {
        shown.push('…');
    }
    shown
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEADER: &str = "ox,oy,oz,dx,dy,dz,t_min,t_max\n";

    #[test]
    fn rays_are_read_with_and_without_header() {
        let line = "0, -0.0,\"1e-3\",0,0,-1,0,inf\n\n1,2,3,1,0,0,0.5,7\r\n";
        let with = read_rays(format!("{HEADER}{line}").as_bytes()).unwrap();
        let without = read_rays(line.as_bytes()).unwrap();
        assert_eq!(with, without);
        assert_eq!(with.len(), 2);
        assert_eq!(with[0].t_max, f32::INFINITY);
        assert_eq!(with[0].origin.y.to_bits(), (-0.0f32).to_bits());
        assert_eq!(with[1].t_min, 0.5);
        assert!(read_rays(HEADER.as_bytes()).unwrap().is_empty());
        assert!(read_rays(&b""[..]).unwrap().is_empty());
    }

    #[test]
    fn slips_are_named_with_line_and_field() {
        let good = "0,0,0,0,0,1,0,inf\n";
        for (text, message) in [
            (format!("{HEADER}{good}0,0,0,0,zero,1,0,inf\n"), "line 3, field `dy`: `zero` is not a number"),
            (format!("{good}\n0,0,0,0,0,1,0\n"), "line 3: 7 fields"),
            (format!("{good}0,0,0,0,0,1,0,1,2\n"), "line 2: 9 fields"),
            (
                format!("{good}0,0,0,0,0,-0,0,inf\n"),
                "line 2, fields `dx`, `dy`, `dz`: the ray's direction is zero",
            ),
            (format!("{good}nan,0,0,0,0,1,0,inf\n"), "line 2, fields `ox`, `oy`, `oz`"),
            (format!("{good}0,0,0,1e39,0,1,0,inf\n"), "line 2, fields `dx`, `dy`, `dz`"),
            (format!("{good}0,0,0,0,0,1,0,NaN\n"), "line 2, fields `t_min`, `t_max`"),
            ("x,0,0,0,0,1,0,inf\n".to_owned(), "line 1, field `ox`: `x` is not a number"),
            (format!("{good}{}", "1".repeat(5000)), "line 2: more than 4096 bytes"),
            ("a,b,c\n".to_owned(), "line 1: the header must be"),
            ("\u{1}\u{2}PNG\u{0}\n".to_owned(), "line 1: the header must be"),
        ] {
            let error = read_rays(text.as_bytes()).unwrap_err().to_string();
            assert!(error.starts_with(message), "{text:?}: {error}");
        }
    }
}
