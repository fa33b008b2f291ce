//! Triangles as one kind among others.

use super::error::Fields;
use super::{Shape, SolidError, placed};
use crate::{Aabb, Corners};
use glam::DVec3;

impl Shape for Corners {
    const KIND: &'static str = "triangle";

    fn bounds(&self) -> Aabb {
        Aabb::of_points(*self)
    }

    fn normal(&self, _: DVec3) -> Option<DVec3> {
        let [a, b, c] = self.map(|corner| corner.as_dvec3());
        // Scaled by the largest edge, so that tiny and huge ones have a normal too.
        let (ab, ac) = (b - a, c - a);
        let size = ab.abs().max(ac.abs()).max_element();
        (size > 0.0).then(|| (ab / size).cross(ac / size)).and_then(DVec3::try_normalize)
    }

    fn moved(&self, scale: f64, offset: DVec3) -> Self {
        self.map(|corner| placed(corner, scale, offset))
    }

    fn numbers(&self, see: &mut dyn FnMut(f32)) {
        self.iter().flat_map(|corner| corner.to_array()).for_each(see);
    }

    fn validate(&self) -> Result<(), SolidError> {
        self.iter().try_for_each(|corner| Fields(Self::KIND).finite("corners", &corner.to_array()))
    }
}
