//! The oracle over a whole scene.

use super::closest::closest;
use super::intersect::ExactHit;
use accel::{Corners, Ray, Vec3};

/// Triangles in a leaf.
const LEAF: usize = 4;

/// Twice the relative error of a slab's t in `f64`: a difference and a quotient of
/// `f32` values are off by at most 2^-53 each and don't under- or overflow.
const SLACK: f64 = 4.0 * f64::EPSILON;

/// All triangles of a scene in a plain binary tree of boxes, so that millions of rays
/// can be judged. It shares no code with the structures that it judges.
#[derive(Debug)]
pub struct Oracle {
    nodes: Vec<Node>,
    triangles: Vec<(u32, Corners)>,
}

/// A box and what is in it: a leaf's triangles `first..first + count`, or, with a count
/// of 0, the next node and the node `first`.
#[derive(Debug)]
struct Node {
    min: Vec3,
    max: Vec3,
    first: u32,
    count: u32,
}

impl Oracle {
    /// An oracle for `triangles`, numbered in their order. Those with a NaN or
    /// infinite coordinate are left out, for they are never hit.
    ///
    /// # Panics
    /// With 2^31 triangles or more.
    pub fn new(triangles: impl IntoIterator<Item = Corners>) -> Self {
        let mut list = Vec::new();
        for (id, triangle) in triangles.into_iter().enumerate() {
            if triangle.iter().all(|corner| corner.is_finite()) {
                list.push((u32::try_from(id).expect("fewer than 2^31 triangles"), triangle));
            }
        }
        let mut nodes = Vec::new();
        if !list.is_empty() {
            split(&mut nodes, &mut list, 0);
        }
        Self { nodes, triangles: list }
    }

    /// The nearest exact hit; at exactly the same t the lowest number.
    pub fn closest(&self, ray: &Ray) -> Option<(u32, ExactHit)> {
        let mut nearest: Option<(u32, ExactHit)> = None;
        let mut stack = Vec::with_capacity(64);
        if !self.nodes.is_empty() {
            stack.push(0u32);
        }
        let mut limit = f64::from(ray.t_max);
        while let Some(index) = stack.pop() {
            let node = &self.nodes[index as usize];
            if !node.may_hold(ray, limit) {
                continue;
            }
            if node.count == 0 {
                stack.extend([index + 1, node.first]);
                continue;
            }
            let (first, count) = (node.first as usize, node.count as usize);
            let leaf = self.triangles[first..first + count].iter().copied();
            let Some(found) = closest(ray, leaf) else {
                continue;
            };
            if nearest.as_ref().is_none_or(|best| (&found.1.t, found.0) < (&best.1.t, best.0)) {
                limit = limit.min(found.1.t.to_f64().next_up());
                nearest = Some(found);
            }
        }
        nearest
    }
}

impl Node {
    /// Whether the ray may meet the box at a t in [`t_min`, `limit`].
    fn may_hold(&self, ray: &Ray, limit: f64) -> bool {
        let (mut near, mut far) = (f64::from(ray.t_min), limit);
        for axis in 0..3 {
            let (o, d) = (f64::from(ray.origin[axis]), f64::from(ray.direction[axis]));
            let (low, high) = (f64::from(self.min[axis]) - o, f64::from(self.max[axis]) - o);
            if d == 0.0 {
                if low > 0.0 || high < 0.0 {
                    return false;
                }
                continue;
            }
            let (a, b) = (low / d, high / d);
            near = near.max(a.min(b));
            far = far.min(a.max(b));
        }
        // NaN, from a ray that is not one, goes on to the triangles, which refuse it.
        let missed = near - near.abs() * SLACK > far + far.abs() * SLACK;
        !missed
    }
}

/// Appends the tree over `list`, which is the part of all triangles from `offset` on,
/// and sorts it into leaves: halves by the centre along the longest axis.
fn split(nodes: &mut Vec<Node>, list: &mut [(u32, Corners)], offset: usize) {
    let corners = || list.iter().flat_map(|(_, triangle)| *triangle);
    let min = corners().fold(Vec3::INFINITY, Vec3::min);
    let max = corners().fold(Vec3::NEG_INFINITY, Vec3::max);
    let index = nodes.len();
    let narrow = |n: usize| u32::try_from(n).expect("fewer than 2^31 triangles");
    nodes.push(Node { min, max, first: narrow(offset), count: narrow(list.len()) });
    if list.len() <= LEAF {
        return;
    }
    // Halved, for the extent of finite floats may be infinite.
    let extent = max * 0.5 - min * 0.5;
    let axis = if extent.x >= extent.y && extent.x >= extent.z {
        0
    } else if extent.y >= extent.z {
        1
    } else {
        2
    };
    let half = list.len() / 2;
    let centre = |triangle: &Corners| triangle.iter().map(|corner| f64::from(corner[axis])).sum::<f64>();
    list.select_nth_unstable_by(half, |a, b| centre(&a.1).total_cmp(&centre(&b.1)));
    let (left, right) = list.split_at_mut(half);
    split(nodes, left, offset);
    nodes[index].first = narrow(nodes.len());
    nodes[index].count = 0;
    split(nodes, right, offset + half);
}

#[cfg(test)]
mod tests {
    use super::super::closest_unfiltered;
    use super::*;
    use proptest::prelude::*;

    fn coordinate() -> impl Strategy<Value = f32> {
        prop_oneof![2 => (-3i8..=3).prop_map(f32::from), 1 => -3f32..3.0]
    }

    fn corner() -> impl Strategy<Value = Vec3> {
        [coordinate(), coordinate(), coordinate()].prop_map(Vec3::from)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(300))]

        #[test]
        fn the_tree_changes_no_answer(list in prop::collection::vec([corner(), corner(), corner()], 0..40), rays in prop::collection::vec((corner(), corner(), coordinate()), 10), e in -100i32..100) {
            let scale = 2f64.powi(e) as f32;
            let scaled: Vec<Corners> = list.iter().map(|t| t.map(|v| v * scale)).collect();
            let oracle = Oracle::new(scaled.iter().copied());
            for (origin, direction, t_min) in rays {
                let ray = Ray { t_min, ..Ray::new(origin * scale, direction) };
                let all = scaled.iter().enumerate().map(|(id, t)| (id as u32, *t));
                prop_assert_eq!(oracle.closest(&ray), closest_unfiltered(&ray, all));
            }
        }
    }

    #[test]
    fn numbers_stay_when_triangles_are_left_out() {
        let good = [Vec3::ZERO, Vec3::X, Vec3::Y];
        let oracle = Oracle::new([[Vec3::NAN; 3], good, good]);
        let ray = Ray::new(Vec3::new(0.2, 0.2, 1.0), Vec3::NEG_Z);
        assert_eq!(oracle.closest(&ray).map(|(id, _)| id), Some(1));
        assert_eq!(oracle.closest(&Ray { t_max: f32::NAN, ..ray }), None);
        assert_eq!(Oracle::new([]).closest(&ray), None);
    }
}
