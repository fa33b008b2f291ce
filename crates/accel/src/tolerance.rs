//! The bounds that together guarantee that no hit is lost, in order, each derived from those before it.
//!
//! What is guaranteed: a hit that an intersector reports, and that satisfies the *hit-in-padded-bounds invariant* of
//! [`crate::Objects`], is found by every structure. ε is 2^-24, by which `f32` rounds relatively; E is the longest
//! extent of the scene. A change of one of them that breaks a link of the chain doesn't compile, or fails a test
//! that plants one that is too small.

use crate::{Aabb, Ray};

/// ε
const ROUNDING: f64 = 1.0 / (1 << 24) as f64;

/// By how much `f64` rounds relatively.
const DOUBLE_ROUNDING: f64 = 1.0 / (1u64 << 53) as f64;

/// **1.** A ray is *near* if its origin is within this many E of the scene's centre, on each axis. Its hits are at
/// most 4.5 E from the origin on each axis; rounding t, the relative origin, the product and the sum moves a hit's
/// position by 15 ε·E in all.
pub const NEAR: f32 = 4.0;

/// **2.** Objects' boxes are padded by this part of E: large against the rounding of a hit's position, small against
/// anything seen in an image. Half of it covers four times the 15 ε·E of near rays (1), so their certain hits satisfy the
/// invariant without a test.
pub const PAD: f32 = 1.0 / (1 << 17) as f32;
const _: () = assert!(4.0 * 15.0 * ROUNDING <= PAD as f64 / 2.0);

/// **3.** A hit's t may lie outside the ray's way through the padded box by this part of itself: 16 times the rounding
/// of t, which is all that there is far away, where it exceeds the padding (2).
pub const T_SLACK: f64 = 1.0 / (1 << 20) as f64;
const _: () = assert!(T_SLACK >= 16.0 * ROUNDING);

/// What a structure adds to the ends of a ray's range of t: the slack of a hit at these ends (3), and what that is
/// rounded by.
pub const RANGE_SLACK: f64 = T_SLACK * (1.0 + ROUNDING);
const _: () = assert!(RANGE_SLACK > T_SLACK);

/// **4.** Structures register padded boxes (2) wider by this part of the grid's extent on each axis. In these units a
/// segment's two ends, its steps and the planes it meets are each off by ε or 2 ε, some eight of them: this is eight
/// times as much, so whatever cell the exact ray meets the box in, the walk visits one in which it is registered.
pub const GRID_MARGIN: f64 = 1.0 / (1 << 18) as f64;
const _: () = assert!(GRID_MARGIN >= 8.0 * 8.0 * ROUNDING);

/// **5.** A component of a segment below this is taken for none, or for this much, so that its reciprocal is finite.
/// That moves points by as much, which the margin (4) covers beside the rounding.
pub const PARALLEL: f64 = 1.0 / (1 << 23) as f64;
const _: () = assert!(PARALLEL + 8.0 * 2.0 * ROUNDING <= GRID_MARGIN / 2.0);

/// **6.** The compact grid maps segments into itself shrunk by this on each side, so that no point lies on an outer
/// plane. It moves points by as much, which the margin (4) covers beside (5) and the rounding.
pub const INSET: f64 = 1.0 / (1 << 20) as f64;
const _: () = assert!(INSET + PARALLEL + 8.0 * 2.0 * ROUNDING <= GRID_MARGIN);

/// **7.** When a hit at t is known, objects that begin behind it by this part of t are still looked at: one slack (3)
/// for an object that is hit before its box begins, and one for the known hit.
pub const LIMIT_T: f64 = 2.0 * T_SLACK;

/// **8.** And on top, in the s of a segment, which runs from 0 to 1: s is off by some ε where it comes from t, and by
/// as much where a box's beginning is computed; the margin (4) many times over.
pub const LIMIT_S: f64 = 4.0 * GRID_MARGIN;
const _: () = assert!(LIMIT_S >= 64.0 * ROUNDING);

/// **9.** In a block's maps, in slices: by how much the far end of each step along a path is shortened, so that
/// rounding never makes a step touch three slices of a short axis. A block has eight slices, so positions in it are off
/// by some eight ε.
pub const TRIM: f32 = 1.0 / 128.0;
const _: () = assert!(TRIM as f64 >= 64.0 * 8.0 * ROUNDING);

/// **10.** In a block's maps, in slices: objects are registered wider by this. It makes up for the trim (9) and for
/// the rounding within the block; that of the scene's unit coordinates is covered by their margin (4), by which the boxes
/// have been widened before.
pub const LOCAL_MARGIN: f32 = 4.0 * TRIM;
const _: () = assert!(LOCAL_MARGIN >= 2.0 * TRIM);

/// **11.** Where a ray is clipped by products with reciprocals, in `f64`, ray and box count as meeting if they miss by this part
/// of t. A difference, a reciprocal and a product are off by 2^-53 each, on either side of the
/// comparison: this is sixteen times as much, and small beside the slack (3) that is granted with it.
pub const TOUCH: f64 = 1.0 / (1u64 << 46) as f64;
const _: () = assert!(TOUCH >= 16.0 * 6.0 * DOUBLE_ROUNDING && TOUCH <= T_SLACK / 1024.0);

/// **12.** A ray of a raster is off by this part of the sum of the sizes of its terms, component by component: a term is
/// multiplied once and added twice, each of which rounds by ε, and the fourth ε is for the products of errors.
pub const RASTER_ROUNDING: f64 = 4.0 * ROUNDING;
const _: () = assert!(RASTER_ROUNDING >= 3.0 * ROUNDING * (1.0 + 3.0 * ROUNDING));

/// **13.** And by this much on top, where its two products are denormal: each is then off by half of the least number
/// above 0, 2^-150, at most. It is 500 times as much, which still is nothing in any scene.
pub const RASTER_UNDERFLOW: f64 = f32::MIN_POSITIVE as f64 / (1 << 14) as f64;
const _: () = assert!(RASTER_UNDERFLOW >= 2.0 * (f32::MIN_POSITIVE as f64 * ROUNDING));

/// **14.** Where boxes are projected to a raster's image in `f64`, what comes of a dot product is off by this part of the sum
/// of the sizes of its terms. A minor of the frame, its quotient by the determinant, the offset of a corner, the product and
/// two sums round by 2^-53 each, about the middle of a box some twice as often: this is 32 of them.
pub const PROJECTION: f64 = 32.0 * DOUBLE_ROUNDING;
const _: () = assert!(PROJECTION >= 2.0 * 8.0 * DOUBLE_ROUNDING);

/// **15.** Where a line's distance from a ball's centre is compared with its radius, in `f64`, the squares may differ by this
/// part of the square of the radius and of the way from the ray's origin to the centre. The foot of the perpendicular comes
/// from a quotient of two dot products, off by some ten roundings of 2^-53, and counts twice in the square; the radius has
/// been rounded up before.
pub const BALL: f64 = 1.0 / (1u64 << 46) as f64;
const _: () = assert!(BALL >= 4.0 * 2.0 * 10.0 * DOUBLE_ROUNDING);

/// **16.** How far a ray's origin may be from the scene's centre on each axis, in E. No arithmetic ends there
/// ([`crate::far`] moves origins without error): it is how far tests go.
pub const FAR: f32 = (1u128 << 100) as f32;

/// **17.** A triangle's edge function is a determinant of a ray's direction, an edge and the way from the ray's origin to a
/// corner. Where such are held against the cells of a raster, they may be wrong by this part of the sums of these
/// vectors' components: a kernel that multiplies differences of corners finds signs that are right but for 64 ε of them
/// (each determinant has some eight roundings, of three of them the sum is taken), the raster's rays are off by (12), and what
/// is computed of sixteen triangles, three of these determinants and their changes across a cell, by some 40 ε.
pub const EDGE: f32 = 128.0 * ROUNDING as f32;
const _: () = assert!(EDGE as f64 >= (64.0 + 40.0) * ROUNDING + RASTER_ROUNDING);

/// **18.** The same for kernels that multiply the ways from the origin to both ends of an edge, after shearing them: four ε
/// of the way each, so 64 ε of the product, and three of those in the sum.
pub const CORNERS: f32 = 512.0 * ROUNDING as f32;
const _: () = assert!(CORNERS as f64 >= (3.0 * 64.0 + 64.0 + 40.0) * ROUNDING + RASTER_ROUNDING);

/// **19.** And by this much, times any of the sizes, where products are denormal: each is then off by 2^-150, as in (13).
pub const EDGE_UNDERFLOW: f32 = 1.0 / (1u128 << 120) as f32;
const _: () = assert!(EDGE_UNDERFLOW as f64 >= 64.0 * f32::MIN_POSITIVE as f64 * ROUNDING);

/// [`FAR`] of a scene with these bounds, which are not empty. A scene without extent counts as long as its coordinates are
/// fine.
pub fn reach_of(bounds: &Aabb) -> f64 {
    let extent = f64::from(bounds.extent().max_element());
    let fine = f64::from(bounds.min.abs().max(bounds.max.abs()).max_element()) * ROUNDING;
    let length = if extent > 0.0 { extent } else { fine };
    if length > 0.0 { length * f64::from(FAR) } else { f64::INFINITY }
}

/// The padding of objects' boxes in a scene with these bounds ([`PAD`]).
pub fn pad_of(bounds: &Aabb) -> f32 {
    if bounds.is_empty() { 0.0 } else { bounds.extent().max_element() * PAD }
}

/// Whether a hit at `t` satisfies the hit-in-padded-bounds invariant for an object with these padded `bounds`: the
/// ray's line meets them, and t lies in the range of that meeting give or take [`T_SLACK`].
#[inline]
pub fn holds(bounds: &Aabb, ray: &Ray, t: f32) -> bool {
    holds_with(bounds, ray, t, T_SLACK)
}

#[inline(always)]
fn holds_with(bounds: &Aabb, ray: &Ray, t: f32, slack: f64) -> bool {
    let Some((near, far)) = bounds.overlap(ray.origin, ray.direction) else {
        return false;
    };
    let t = f64::from(t);
    let slack = slack * t.abs();
    near - slack <= t && t <= far + slack
}

#[cfg(test)]
mod tests;
