//! The nearest hit among many triangles, exactly.

use std::cmp::Ordering;

use super::filter::Filter;
use super::intersect::{ExactHit, intersect};
use accel::{Corners, Ray};

/// The nearest exact hit of `ray` among numbered `triangles` in any order; at exactly
/// the same t the lowest number.
///
/// Triangles that are certainly missed, or certainly behind the nearest hit so far,
/// are rejected in `f64` first ([`Filter`]); the answer is that of
/// [`closest_unfiltered`].
pub fn closest(ray: &Ray, triangles: impl IntoIterator<Item = (u32, Corners)>) -> Option<(u32, ExactHit)> {
    let filter = Filter::new(ray);
    let mut nearest = None;
    let mut limit = f64::INFINITY;
    for (object, triangle) in triangles {
        if !filter.rejects(&triangle, limit) && offer(&mut nearest, object, intersect(ray, &triangle)) {
            // Rounded to nearest, so the next number up is not below the true t.
            limit = nearest.as_ref().map_or(limit, |(_, hit)| hit.t.to_f64().next_up());
        }
    }
    nearest
}

/// [`closest`] by integers alone, which is slow: the reference for the filter.
pub fn closest_unfiltered(
    ray: &Ray,
    triangles: impl IntoIterator<Item = (u32, Corners)>,
) -> Option<(u32, ExactHit)> {
    let mut nearest = None;
    for (object, triangle) in triangles {
        offer(&mut nearest, object, intersect(ray, &triangle));
    }
    nearest
}

/// Takes `hit` if it comes before what is there, and says whether it did.
fn offer(nearest: &mut Option<(u32, ExactHit)>, object: u32, hit: Option<ExactHit>) -> bool {
    let Some(hit) = hit else {
        return false;
    };
    let earlier = match nearest {
        None => true,
        Some((first, best)) => match hit.t.cmp(&best.t) {
            Ordering::Less => true,
            Ordering::Equal => object < *first,
            Ordering::Greater => false,
        },
    };
    if earlier {
        *nearest = Some((object, hit));
    }
    earlier
}
