//! What bounds of errors in `f64` tell of a ray and a sphere.

use accel::Ray;

/// By how much `f64` rounds.
const ROUNDING: f64 = 1.0 / (1u64 << 53) as f64;

/// Squares that are computed with the errors that are reckoned with.
const USUAL: std::ops::RangeInclusive<f64> = 1e-140..=1e140;

/// What is known.
#[derive(Clone, Copy, Debug)]
pub struct Told {
    /// A hit, for certain.
    pub hit: bool,
    /// Nothing is certain.
    pub open: bool,
    /// Where a hit is, rounded correctly.
    pub t: f32,
}

/// Without branches, so that a loop over rays becomes one over lanes.
///
/// With f from the centre to the origin, the discriminant is a·r² − |f × d|². A difference of two coordinates is off by one rounding,
/// a product or sum by one more each: every component of the cross product by 4 roundings of the sum of its terms' sizes at
/// most, the dot products by 5.
#[inline(always)]
pub fn estimate(center: [f32; 3], radius: f32, ray: &Ray) -> Told {
    let [x, y, z] = [
        f64::from(ray.origin.x) - f64::from(center[0]),
        f64::from(ray.origin.y) - f64::from(center[1]),
        f64::from(ray.origin.z) - f64::from(center[2]),
    ];
    let [u, v, w] = [f64::from(ray.direction.x), f64::from(ray.direction.y), f64::from(ray.direction.z)];
    let r = f64::from(radius);
    let a = u * u + v * v + w * w;
    let (bx, by, bz) = (x * u, y * v, z * w);
    let b = -(bx + by + bz);
    let b_off = 6.0 * ROUNDING * (bx.abs() + by.abs() + bz.abs());
    let (cx, cy, cz) = (y * w - z * v, z * u - x * w, x * v - y * u);
    let (sx, sy, sz) =
        ((y * w).abs() + (z * v).abs(), (z * u).abs() + (x * w).abs(), (x * v).abs() + (y * u).abs());
    let aside = cx * cx + cy * cy + cz * cz;
    let twice = cx.abs() * sx + cy.abs() * sy + cz.abs() * sz;
    let sizes = sx * sx + sy * sy + sz * sz;
    let full = a * (r * r);
    let square = full - aside;
    let off = 6.0 * ROUNDING * (2.0 * twice + 6.0 * ROUNDING * sizes) + 8.0 * ROUNDING * (full + aside);
    // Where squares leave the range of normal numbers nothing is certain; the largest here has some 2^512 at most.
    let usual = USUAL.contains(&a) & USUAL.contains(&full) & (off < f64::INFINITY);
    let (missed, met) = (square < -off, square > 4.0 * off);
    let root = (if met { square } else { full }).sqrt();
    // The root's slope is at most that at the lower end, three quarters of the square.
    let root_off = off / root + 2.0 * ROUNDING * root;
    let inverse = 1.0 / a;
    let t_off = (1.5 * (b_off + root_off) + 16.0 * ROUNDING * (b.abs() + root)) * inverse;
    let (enters, leaves) = ((b - root) * inverse, (b + root) * inverse);
    let (t_min, t_max) = (f64::from(ray.t_min), f64::from(ray.t_max));
    let first = Root::of(enters, t_off, t_min, t_max);
    let second = Root::of(leaves, t_off, t_min, t_max);
    let of_first = !first.outside;
    let t = if of_first { enters } else { leaves };
    let decided = if of_first { first.certain } else { second.certain | second.outside };
    let hit = if of_first { first.certain } else { second.certain };
    let open = !usual | (!missed & !(met & decided));
    Told { hit: usual & met & hit, open, t: t as f32 + 0.0 }
}

/// A root within bounds.
#[derive(Clone, Copy)]
struct Root {
    /// Out of range for certain.
    outside: bool,
    /// In range for certain, and rounded the same wherever it is.
    certain: bool,
}

impl Root {
    #[inline(always)]
    fn of(t: f64, off: f64, t_min: f64, t_max: f64) -> Self {
        let (low, high) = (t - off, t + off);
        let outside = (high < t_min) | (low > t_max);
        let certain = (low > t_min) & (high < t_max) & (low as f32 == high as f32);
        Self { outside, certain }
    }
}
