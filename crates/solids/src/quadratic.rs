//! Where a polynomial of the second degree is not above 0.

/// Where a·t² + 2·b·t + c ≤ 0: up to two closed ranges of t, in order, which may be empty (first above second) or infinite.
///
/// The larger root comes from a sum of equal signs and the smaller one from the product of both, so that neither loses digits
/// (G. Forsythe 1970, "Pitfalls in Computation").
pub fn ranges_below(a: f64, b: f64, c: f64) -> [(f64, f64); 2] {
    const EMPTY: (f64, f64) = (f64::INFINITY, f64::NEG_INFINITY);
    const ALL: (f64, f64) = (f64::NEG_INFINITY, f64::INFINITY);
    let square = b * b - a * c;
    if square < 0.0 || (a == 0.0 && b == 0.0) {
        return [if a < 0.0 || (a == 0.0 && c <= 0.0) { ALL } else { EMPTY }, EMPTY];
    }
    let q = -(b + square.sqrt().copysign(b));
    if a == 0.0 {
        // 2·b·t + c, whose root is c/q.
        let root = c / q;
        return [if b > 0.0 { (ALL.0, root) } else { (root, ALL.1) }, EMPTY];
    }
    let (one, other) = (q / a, if q == 0.0 { 0.0 } else { c / q });
    let (low, high) = (one.min(other), one.max(other));
    if a > 0.0 { [(low, high), EMPTY] } else { [(ALL.0, low), (high, ALL.1)] }
}

/// The step to the vertex of a·t² + 2·b·t + c, or 0 where that is farther than `reach` away. From there the discriminant cancels no
/// digits; from far away two roots cannot be close to each other.
pub fn to_vertex(a: f64, b: f64, reach: f64) -> f64 {
    if b.abs() < a.abs() * reach { -b / a } else { 0.0 }
}

/// The part of a range within another.
pub fn clipped((low, high): (f64, f64), (near, far): (f64, f64)) -> (f64, f64) {
    (low.max(near), high.min(far))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn each_form_has_its_ranges() {
        let none = |(low, high): (f64, f64)| low > high;
        assert_eq!(ranges_below(1.0, 0.0, -4.0)[0], (-2.0, 2.0));
        assert!(none(ranges_below(1.0, 0.0, 4.0)[0]));
        assert_eq!(ranges_below(0.0, 2.0, -4.0)[0], (f64::NEG_INFINITY, 1.0));
        assert_eq!(ranges_below(0.0, -2.0, -4.0)[0], (-1.0, f64::INFINITY));
        let [low, high] = ranges_below(-1.0, 0.0, 4.0);
        assert_eq!((low.1, high.0), (-2.0, 2.0));
        assert_eq!(ranges_below(-1.0, 0.0, -4.0)[0], (f64::NEG_INFINITY, f64::INFINITY));
        assert!(none(ranges_below(0.0, 0.0, 1.0)[0]) && !none(ranges_below(0.0, 0.0, -1.0)[0]));
        assert_eq!(ranges_below(1.0, -3.0, 9.0)[0], (3.0, 3.0));
    }

    proptest! {
        #[test]
        fn between_the_ends_the_polynomial_is_not_above_zero(
            a in -4.0..4.0f64, b in -4.0..4.0f64, c in -4.0..4.0f64, t in -9.0..9.0f64,
        ) {
            let value = a * t * t + 2.0 * b * t + c;
            let inside = ranges_below(a, b, c).iter().any(|(low, high)| *low <= t && t <= *high);
            prop_assert!(value.abs() < 1e-12 || inside == (value < 0.0), "{value}");
        }
    }
}
