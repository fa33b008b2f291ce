//! Signs of edge functions without error: in `f64` where its error bound allows, by [`Expansion`]s elsewhere.
//!
//! Crates of geometric predicates take differences of points only; a ray's direction is none.

use accel::expansion::{Expansion, MINORS, sign, triple, two_product, two_sum};
use accel::{Corners, Ray, Vec3};
use std::cmp::Ordering;

/// Differences and partial products of one edge function: 3 minors of 2 products, each in 2 parts, times a
/// component in 2 parts.
const TERMS: usize = 24;

/// Those of an edge function of coordinates themselves: three triple products of six products in two parts each.
const FAR_TERMS: usize = 36;

/// Above any error of a computed edge function, relative to the sum of its absolute products: seven roundings.
const BOUND: f64 = 16.0 * f64::EPSILON / 2.0;

/// Where a line meets a triangle's plane relative to the triangle, without error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    /// Outside, or the line is parallel to the plane.
    Outside,
    /// Inside or on the border. The flags tell which edges it is on: those opposite to the first, second and third corner.
    Inside([bool; 3]),
}

/// The place of the ray's line.
pub(super) fn place(ray: &Ray, corners: &Corners) -> Place {
    let [a, b, c] = *corners;
    let signs = match corners.map(|corner| difference(corner, ray.origin)) {
        [Some(a), Some(b), Some(c)] => {
            let direction = ray.direction.to_array().map(f64::from);
            [(c, b), (a, c), (b, a)].map(|(p, q)| edge_sign(direction, p, q))
        }
        _ => [(c, b), (a, c), (b, a)].map(|(p, q)| far_edge_sign(ray, p, q)),
    };
    let (less, greater) = (signs.contains(&Ordering::Less), signs.contains(&Ordering::Greater));
    if less == greater {
        // Both signs, or all zero: the line lies in the plane.
        return Place::Outside;
    }
    Place::Inside(signs.map(Ordering::is_eq))
}

/// Whether hits of the same line at these places of two triangles are certainly one point, because they are on the same
/// edge or corner.
pub(super) fn same_point(a: (&Corners, [bool; 3]), b: (&Corners, [bool; 3])) -> bool {
    let holds = |(corners, on): (&Corners, [bool; 3]), point: Vec3| {
        corners.iter().zip(on).any(|(corner, opposite)| !opposite && *corner == point)
    };
    // The corners of the least face that holds the hit are those that it isn't opposite of.
    let shares = |x: (&Corners, [bool; 3]), y| {
        x.0.iter().zip(x.1).filter(|(_, opposite)| !opposite).all(|(corner, _)| holds(y, *corner))
    };
    let proper = a.1.contains(&true) && b.1.contains(&true);
    proper && shares(a, b) && shares(b, a)
}

/// Whether both triangles lie in one plane that is perpendicular to an axis, as a box and the floor it stands on do: a
/// line that isn't in that plane meets both at one point.
pub(super) fn in_one_slice_plane(a: &Corners, b: &Corners) -> bool {
    (0..3).any(|axis| a.iter().chain(b).all(|corner| corner[axis] == a[0][axis]))
}

/// Whether the ray's line certainly passes through a corner.
pub(super) fn meets_corner(ray: &Ray, corners: &Corners) -> bool {
    corners.iter().any(|corner| passes(ray, *corner))
}

/// Whether the ray's line certainly passes through a corner that both triangles have. If it is in neither's plane, that corner is where it
/// hits both.
pub(super) fn meet_at_corner(ray: &Ray, a: &Corners, b: &Corners) -> bool {
    a.iter().any(|corner| b.contains(corner) && passes(ray, *corner))
}

/// Whether the line certainly passes through a point: (p − o) × d = 0.
fn passes(ray: &Ray, point: Vec3) -> bool {
    let d = ray.direction.to_array().map(f64::from);
    let Some(p) = difference(point, ray.origin) else { return false };
    let equal = |[_, j, k]: [usize; 3]| {
        p[j] * d[k] == p[k] * d[j] && two_product(p[j], d[k]).1 == two_product(p[k], d[j]).1
    };
    MINORS.into_iter().all(equal)
}

/// p − q if that is exact.
fn difference(p: Vec3, q: Vec3) -> Option<[f64; 3]> {
    let mut result = [0.0; 3];
    for axis in 0..3 {
        let (high, low) = two_sum(f64::from(p[axis]), -f64::from(q[axis]));
        if low != 0.0 || !high.is_finite() {
            return None;
        }
        result[axis] = high;
    }
    Some(result)
}

/// The minor whose factor is the only one that isn't zero: rays along an axis meet corners and edges most often.
fn only_minor(d: [f64; 3]) -> Option<[usize; 3]> {
    MINORS.into_iter().find(|[i, j, k]| d[*i] != 0.0 && d[*j] == 0.0 && d[*k] == 0.0)
}

/// The sign of d·(p×q).
fn edge_sign(d: [f64; 3], p: [f64; 3], q: [f64; 3]) -> Ordering {
    let (mut value, mut size) = (0.0, 0.0);
    for [i, j, k] in MINORS {
        let (x, y) = (p[j] * q[k], p[k] * q[j]);
        value += d[i] * (x - y);
        size += d[i].abs() * (x.abs() + y.abs());
    }
    if value.abs() > size * BOUND {
        return sign(value);
    }
    if let Some([i, j, k]) = only_minor(d) {
        let (x, y) = (two_product(p[j], q[k]), two_product(p[k], q[j]));
        // Rounding keeps order, so the errors decide between products that are rounded to the same.
        let order = sign(x.0 - y.0).then(sign(x.1 - y.1));
        return if d[i] < 0.0 { order.reverse() } else { order };
    }
    let mut sum = Expansion::<TERMS>::ZERO;
    for [i, j, k] in MINORS {
        for (x, y, factor) in [(p[j], q[k], d[i]), (p[k], q[j], -d[i])] {
            if x == 0.0 || y == 0.0 || factor == 0.0 {
                continue;
            }
            let (high, low) = two_product(x, y);
            sum.add_product(high, factor);
            sum.add_product(low, factor);
        }
    }
    sum.sign()
}

/// The sign of d·((p−o)×(q−o)) where a difference needs more digits than `f64` has.
#[cold]
fn far_edge_sign(ray: &Ray, p: Vec3, q: Vec3) -> Ordering {
    let (o, d) = (ray.origin, ray.direction);
    let mut sum = Expansion::<FAR_TERMS>::ZERO;
    triple(&mut sum, d, p, q);
    triple(&mut sum, d, p, -o);
    triple(&mut sum, d, -o, q);
    sum.sign()
}

#[cfg(test)]
mod tests {
    use super::*;
    use oracle::intersect;
    use proptest::prelude::*;

    /// Numbers of a few digits at scales so different that sums need many parts.
    fn number() -> impl Strategy<Value = f32> + Clone {
        (-9i8..=9, prop::sample::select(vec![-60, -25, -9, 0, 0, 0, 3, 20]))
            .prop_map(|(m, e)| f32::from(m) * 2f32.powi(e))
    }

    fn vector() -> impl Strategy<Value = Vec3> {
        [number(), number(), number()].prop_map(Vec3::from)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]

        #[test]
        fn places_are_those_of_integers(o in vector(), d in vector(), axis in prop::option::of(0usize..3), corners in [vector(), vector(), vector()]) {
            let d = axis.map_or(d, |axis| Vec3::AXES[axis] * d);
            let ray = Ray { t_min: f32::NEG_INFINITY, ..Ray::new(o, d) };
            let exact = intersect(&ray, &corners);
            if let Some(hit) = exact.as_ref().filter(|_| meets_corner(&ray, &corners)) {
                let weights = [hit.u.to_f64(), hit.v.to_f64()];
                prop_assert!([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].contains(&weights));
            }
            let place = place(&ray, &corners);
            prop_assert!(!(meets_corner(&ray, &corners) && place == Place::Outside && exact.is_some()));
            prop_assert_eq!(place != Place::Outside, exact.is_some());
            if let (Place::Inside(on), Some(hit)) = (place, exact) {
                // u is the weight of the second corner, v of the third.
                prop_assert_eq!(on[1], hit.u.to_f64() == 0.0);
                prop_assert_eq!(on[2], hit.v.to_f64() == 0.0);
            }
        }

        #[test]
        fn one_point_has_one_t(o in vector(), target in vector(), a in vector(), b in vector(), c in vector(), d in vector(), turn in 0usize..3) {
            let ray = Ray { t_min: f32::NEG_INFINITY, ..Ray::new(o, target - o) };
            let mut second = [a, b, d];
            second.rotate_left(turn);
            let first = [c, a, b];
            let t = |corners| intersect(&ray, corners).map(|hit| hit.t);
            if let (true, Some(x), Some(y)) = (meet_at_corner(&ray, &first, &second), t(&first), t(&second)) {
                prop_assert_eq!(x, y);
            }
            if let (Place::Inside(x), Place::Inside(y)) = (place(&ray, &first), place(&ray, &second))
                && same_point((&first, x), (&second, y))
            {
                prop_assert_eq!(t(&first), t(&second));
            }
        }
    }

    /// A line that passes an edge by so little that `f64` sees it on neither side, and one that meets it.
    #[test]
    fn the_least_difference_is_seen() {
        let (big, unit) = (16_777_215.0, 2f32.powi(-20));
        for side in [1.0, -1.0] {
            let corners = [Vec3::ZERO, Vec3::new(big, big - 1.0, big) * unit, Vec3::new(-side, side, 0.0)];
            let through =
                |p: Vec3| Ray { t_min: f32::NEG_INFINITY, ..Ray::new(p * unit, Vec3::new(big, 3.0, 7.0)) };
            let places =
                [Vec3::new(big - 1.0, big - 2.0, big - 1.0), Vec3::new(big, big - 1.0, big)].map(|p| {
                    let found = place(&through(p), &corners);
                    assert_eq!(found != Place::Outside, intersect(&through(p), &corners).is_some());
                    found
                });
            assert!(matches!(places[1], Place::Inside(on) if on.contains(&true)), "{places:?}");
        }
    }

    #[test]
    fn triangles_of_one_slice_plane_are_told() {
        let [a, b, c] = [Vec3::Z, Vec3::Z + Vec3::X, Vec3::Z + Vec3::Y];
        let (apart, tilted) = ([a, b, c].map(|corner| corner + 9.0 * Vec3::X), [a, b, c + Vec3::Z]);
        assert!(in_one_slice_plane(&[a, b, c], &apart));
        assert!(!in_one_slice_plane(&[a, b, c], &tilted));
        assert!(!in_one_slice_plane(&[a, b, c], &[a, b, c].map(|corner| corner + Vec3::Z)));
        let ray = Ray::new(Vec3::new(0.1, 0.3, -0.7), Vec3::new(0.1, 0.0, 0.9));
        let wide = [a - 9.0 * Vec3::X, b + 9.0 * Vec3::X, c + 9.0 * Vec3::Y];
        let t = |corners| intersect(&ray, corners).map(|hit| hit.t);
        assert!(in_one_slice_plane(&wide, &[a, b, c]) && t(&wide).is_some() && t(&wide) == t(&[a, b, c]));
    }

    #[test]
    fn hits_of_one_edge_or_corner_are_one_point() {
        let [a, b, c, d] = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::new(1.0, -1.0, 2.0)];
        let at = |point: Vec3| Ray::new(point - Vec3::Z, Vec3::Z);
        let same = |ray: &Ray, x: &Corners, y: &Corners| match (place(ray, x), place(ray, y)) {
            (Place::Inside(p), Place::Inside(q)) => same_point((x, p), (y, q)),
            places => panic!("{places:?}"),
        };
        let (first, second) = ([a, b, c], [b, d, a]);
        assert!(same(&at(Vec3::new(0.5, 0.0, 0.0)), &first, &second), "an edge");
        assert!(same(&at(b), &first, &second), "a corner");
        assert!(meets_corner(&at(b), &first) && meet_at_corner(&at(b), &first, &second));
        assert!(!meets_corner(&at(Vec3::new(0.5, 0.0, 0.0)), &first));
        let flat = [a, b, Vec3::new(1.0, 1.0, 0.0)];
        assert!(!same(&at(Vec3::new(0.5, 0.25, 0.0)), &first, &flat), "insides are not compared");
    }
}
