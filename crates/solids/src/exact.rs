//! Spheres with every decision the true one.
//!
//! Bounds of the rounding errors in `f64` decide nearly always; where they don't, integers do. The number of bits is not limited: every
//! `f32` is an integer in units of the least one that a ray and a sphere have.

mod estimate;

pub(crate) use estimate::estimate;

use accel::Ray;
use accel::solid::Sphere;
use num_bigint::BigInt;
use std::cmp::Ordering;

/// The first t of the sphere with its true value in the ray's range, rounded correctly, if that is `t_max` at most.
///
/// Whether a hit comes before `t_max`, which may be another hit's t, is decided by what is told of both: so the nearest of many does
/// not depend on the order in which they are tested.
pub fn nearest(sphere: &Sphere, ray: &Ray, t_max: f32) -> Option<f32> {
    let told = estimate(sphere.center.to_array(), sphere.radius, ray);
    let t = if told.open { undecided(sphere, ray)? } else { told.hit.then_some(told.t)? };
    (t <= t_max).then_some(t)
}

/// The same of what bounds of errors can't decide, within the ray's own range.
#[cold]
pub(crate) fn undecided(sphere: &Sphere, ray: &Ray) -> Option<f32> {
    Integers::of(sphere, ray)?.crossings(ray).into_iter().flatten().next()
}

/// Where the ray enters and leaves, as far as that is in its range: each rounded correctly.
pub fn crossings(sphere: &Sphere, ray: &Ray) -> [Option<f32>; 2] {
    Integers::of(sphere, ray).map_or([None; 2], |integers| integers.crossings(ray))
}

/// The equation a·t² − 2·b·t + c = 0 in integers, for t in units of 2^exponent.
struct Integers {
    a: BigInt,
    b: BigInt,
    square: BigInt,
    exponent: i32,
}

/// A number as an integer and a power of two.
fn parts(value: f32) -> (i64, i32) {
    let bits = value.to_bits();
    let (exponent, fraction) = ((bits >> 23 & 0xff) as i32, i64::from(bits & 0x7f_ffff));
    let (size, exponent) =
        if exponent == 0 { (fraction, -149) } else { (fraction | 1 << 23, exponent - 150) };
    (if value.is_sign_negative() { -size } else { size }, exponent)
}

/// Numbers in units of the least of their powers of two.
fn integers<const N: usize>(values: [f32; N]) -> ([BigInt; N], i32) {
    let parts = values.map(parts);
    let unit = parts.iter().filter(|(size, _)| *size != 0).map(|(_, e)| *e).min().unwrap_or(0);
    let integer =
        |(size, e): (i64, i32)| if size == 0 { BigInt::ZERO } else { BigInt::from(size) << (e - unit) };
    (parts.map(integer), unit)
}

impl Integers {
    /// `None` where the line misses, or is none.
    fn of(sphere: &Sphere, ray: &Ray) -> Option<Self> {
        ray.validate().ok()?;
        let ([x, y, z], [p, q, s]) = (ray.origin.to_array(), sphere.center.to_array());
        let ([x, y, z, p, q, s, r], place) = integers([x, y, z, p, q, s, sphere.radius]);
        let ([u, v, w], direction) = integers(ray.direction.to_array());
        let (fx, fy, fz) = (x - p, y - q, z - s);
        let a = &u * &u + &v * &v + &w * &w;
        let b = -(&fx * &u + &fy * &v + &fz * &w);
        let c = &fx * &fx + &fy * &fy + &fz * &fz - &r * &r;
        let square = &b * &b - &a * &c;
        (square >= BigInt::ZERO).then_some(Self { a, b, square, exponent: place - direction })
    }

    /// Both roots, as far as they are in the ray's range.
    fn crossings(&self, ray: &Ray) -> [Option<f32>; 2] {
        [false, true].map(|far| {
            let after = ray.t_min == f32::NEG_INFINITY || self.against(far, ray.t_min, 0) != Ordering::Less;
            let before = ray.t_max == f32::INFINITY || self.against(far, ray.t_max, 0) != Ordering::Greater;
            (after && before).then(|| self.rounded(far))
        })
    }

    /// A root against `value`, or against the middle between it and the next number up if `half` is 1.
    fn against(&self, far: bool, value: f32, half: i32) -> Ordering {
        let (size, exponent) = parts(value);
        let (next, next_exponent) = parts(value.next_up());
        // Twice the middle, in the finer unit of both.
        let unit = if half == 0 { exponent } else { exponent.min(next_exponent) };
        let twice = match half {
            0 => BigInt::from(size) << 1,
            _ => (BigInt::from(size) << (exponent - unit)) + (BigInt::from(next) << (next_exponent - unit)),
        };
        // ±√square against a·value − b, all doubled.
        let (mut left, mut right) = (BigInt::from(2), &self.a * twice);
        let shift = unit - self.exponent;
        if shift >= 0 {
            right <<= shift
        } else {
            left <<= -shift
        }
        let rest = right - &self.b * &left;
        let squares = (&self.square * &left * &left).cmp(&(&rest * &rest));
        match (far, rest.sign()) {
            (true, num_bigint::Sign::Minus) => Ordering::Greater,
            (true, _) => squares,
            (false, num_bigint::Sign::Plus) => Ordering::Less,
            (false, _) => squares.reverse(),
        }
    }

    /// The nearest number, ties to even: by bisection of the numbers in their order.
    fn rounded(&self, far: bool) -> f32 {
        // Bits as integers that are ordered as the numbers are.
        let number = |key: i32| f32::from_bits((key ^ (key >> 31 & i32::MAX)) as u32);
        let key = |number: f32| {
            let bits = number.to_bits() as i32;
            bits ^ (bits >> 31 & i32::MAX)
        };
        let (mut low, mut high) = (key(f32::MIN), key(f32::MAX));
        if self.against(far, f32::MIN, 0) == Ordering::Less {
            return f32::NEG_INFINITY;
        }
        // The greatest number that is not above the root.
        while low < high {
            let middle = (i64::from(low) + i64::from(high) + 1).div_euclid(2) as i32;
            if self.against(far, number(middle), 0) == Ordering::Less {
                high = middle - 1
            } else {
                low = middle
            }
        }
        let below = number(low);
        if below == f32::MAX {
            return if self.against(far, f32::MAX, 0) == Ordering::Equal { f32::MAX } else { f32::INFINITY };
        }
        let up = match self.against(far, below, 1) {
            Ordering::Less => false,
            Ordering::Greater => true,
            Ordering::Equal => below.to_bits() & 1 == 1,
        };
        (if up { below.next_up() } else { below }) + 0.0
    }
}

#[cfg(test)]
mod tests;
