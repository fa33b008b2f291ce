//! The two trees of obvhs behind one trait.

use accel::vec_bytes;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::{build_bvh2, build_bvh2_from_tris};
use obvhs::cwbvh::CwBvh;
use obvhs::cwbvh::builder::{build_cwbvh, build_cwbvh_from_tris};
use obvhs::ray::{INVALID_ID, Ray, RayHit};
use obvhs::triangle::Triangle;
use obvhs::{BvhBuildParams, aabb::Aabb};
use std::time::Duration;

/// A tree over slots; `order` says which object each slot holds.
pub trait Tree: Sized + Send + Sync {
    /// Over triangles, split beforehand where the parameters say so.
    fn of_triangles(triangles: &[Triangle], parameters: BvhBuildParams) -> Self;

    /// Over boxes.
    fn of_boxes(boxes: &[Aabb], parameters: BvhBuildParams) -> Self;

    /// The object of each slot.
    fn order(&self) -> &[u32];

    /// Bytes of nodes and indices.
    fn bytes(&self) -> [(&'static str, usize); 2];

    /// The nearest hit as t and slot.
    fn closest(&self, ray: Ray, test: impl FnMut(&Ray, usize) -> f32) -> Option<(f32, usize)>;

    /// Whether nothing is hit.
    fn clear(&self, ray: Ray, test: impl FnMut(&Ray, usize) -> f32) -> bool;
}

/// What both trees do alike, by functions of obvhs and methods that they share in name only.
macro_rules! built_and_traced_by {
    ($from_triangles:ident, $from_boxes:ident, $tidy:ident) => {
        fn of_triangles(triangles: &[Triangle], parameters: BvhBuildParams) -> Self {
            $tidy($from_triangles(triangles, parameters, &mut Duration::default()))
        }

        fn of_boxes(boxes: &[Aabb], parameters: BvhBuildParams) -> Self {
            $tidy($from_boxes(boxes, parameters, &mut Duration::default()))
        }

        fn order(&self) -> &[u32] {
            &self.primitive_indices
        }

        #[inline(always)]
        fn closest(&self, ray: Ray, test: impl FnMut(&Ray, usize) -> f32) -> Option<(f32, usize)> {
            let mut hit = RayHit::none();
            self.ray_traverse(ray, &mut hit, test);
            (hit.primitive_id != INVALID_ID).then_some((hit.t, hit.primitive_id as usize))
        }

        #[inline(always)]
        fn clear(&self, ray: Ray, test: impl FnMut(&Ray, usize) -> f32) -> bool {
            self.ray_traverse_miss(ray, test)
        }
    };
}

impl Tree for Bvh2 {
    built_and_traced_by!(build_bvh2_from_tris, build_bvh2, without_spare);

    fn bytes(&self) -> [(&'static str, usize); 2] {
        let indices = [
            &self.primitive_indices,
            &self.primitive_indices_freelist,
            &self.primitives_to_nodes,
            &self.parents,
        ];
        [("nodes", vec_bytes(&self.nodes)), ("indices", indices.into_iter().map(vec_bytes).sum())]
    }
}

/// Gives back what building needed and tracing doesn't.
fn without_spare(mut tree: Bvh2) -> Bvh2 {
    tree.primitives_to_nodes = Vec::new();
    tree.parents = Vec::new();
    tree.primitive_indices_freelist = Vec::new();
    tree.nodes.shrink_to_fit();
    tree.primitive_indices.shrink_to_fit();
    tree
}

impl Tree for CwBvh {
    built_and_traced_by!(build_cwbvh_from_tris, build_cwbvh, shrunk);

    fn bytes(&self) -> [(&'static str, usize); 2] {
        [("nodes", vec_bytes(&self.nodes)), ("indices", vec_bytes(&self.primitive_indices))]
    }
}

/// Gives back spare capacity.
fn shrunk(mut tree: CwBvh) -> CwBvh {
    tree.nodes.shrink_to_fit();
    tree.primitive_indices.shrink_to_fit();
    tree
}
