//! Hits written as CSV.

use accel::Hit;
use std::io::{self, Write};

/// Writes `ray,object,t,u,v`: a header and one line a ray, numbered from 0 in the rays' order.
/// On a miss the fields after the ray are empty.
///
/// # Errors
/// Whatever `out` answers.
pub fn write_hits(mut out: impl Write, hits: &[Option<Hit>]) -> io::Result<()> {
    writeln!(out, "ray,object,t,u,v")?;
    for (ray, hit) in hits.iter().enumerate() {
        match hit {
            Some(hit) => write_hit(&mut out, ray, hit)?,
            None => writeln!(out, "{ray},,,,")?,
        }
    }
    Ok(())
}

/// Writes `ray,object,t,u,v`: a header and a line for each crossing, ray by ray, or one without the fields after the ray for a
/// ray that crosses nothing.
///
/// # Errors
/// Whatever `out` answers.
pub fn write_all_hits(mut out: impl Write, rays: &[Vec<Hit>]) -> io::Result<()> {
    writeln!(out, "ray,object,t,u,v")?;
    for (ray, hits) in rays.iter().enumerate() {
        for hit in hits {
            write_hit(&mut out, ray, hit)?;
        }
        if hits.is_empty() {
            writeln!(out, "{ray},,,,")?;
        }
    }
    Ok(())
}

fn write_hit(out: &mut impl Write, ray: usize, Hit { t, object, u, v }: &Hit) -> io::Result<()> {
    writeln!(out, "{ray},{object},{},{},{}", shortest(*t), shortest(*u), shortest(*v))
}

/// The shortest decimal form that reads back to the same bits; without an exponent where that is
/// no longer.
fn shortest(value: f32) -> String {
    let (plain, scientific) = (format!("{value}"), format!("{value:e}"));
    if scientific.len() < plain.len() { scientific } else { plain }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn floats_read_back_the_same(bits: u32) {
            let value = f32::from_bits(bits);
            prop_assume!(!value.is_nan());
            prop_assert_eq!(shortest(value).parse::<f32>().unwrap().to_bits(), bits);
        }
    }

    #[test]
    fn misses_are_empty() {
        let hits = [Some(Hit { t: 0.1, object: 7, u: -0.0, v: 1e30 }), None];
        let mut out = Vec::new();
        write_hits(&mut out, &hits).unwrap();
        assert_eq!(String::from_utf8(out).unwrap(), "ray,object,t,u,v\n0,7,0.1,-0,1e30\n1,,,,\n");
        let second = Hit { t: 2.0, ..hits[0].unwrap() };
        let mut out = Vec::new();
        write_all_hits(&mut out, &[Vec::new(), vec![hits[0].unwrap(), second]]).unwrap();
        assert_eq!(
            String::from_utf8(out).unwrap(),
            "ray,object,t,u,v\n0,,,,\n1,7,0.1,-0,1e30\n1,7,2,-0,1e30\n"
        );
    }
}
