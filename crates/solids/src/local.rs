//! A ray's line as a solid sees it.

use accel::far::Line;
use accel::{Aabb, Ray};
use glam::DVec3;

/// The line of a ray in coordinates about a solid's middle, in `f64`, seen from close by where that matters.
#[derive(Clone, Copy, Debug)]
pub struct Local {
    /// A point of the line.
    pub origin: DVec3,
    /// As long as the ray's.
    pub direction: DVec3,
    /// The ray's t at `origin`; all others are counted from there.
    pub moved: f64,
    /// Where the line enters the solid's box.
    pub near: f64,
    /// Where it leaves it.
    pub far: f64,
}

impl Local {
    /// `None` where the line passes by the box.
    #[inline(always)]
    pub fn of(bounds: &Aabb, center: DVec3, ray: &Ray) -> Option<Self> {
        let line = Line::through([bounds.min, bounds.max], ray.origin, ray.direction);
        let Line { origin, moved, near, far, .. } = line;
        let origin = DVec3::from_array(origin) - center;
        (near <= far).then_some(Self { origin, direction: ray.direction.as_dvec3(), moved, near, far })
    }

    /// The line from its point next to the middle on: then the roots of a polynomial along it are as large as the solid, however far
    /// away the ray begins, and cancel no digits (E. Haines, J. Günther, T. Akenine-Möller 2019, "Precision Improvements for
    /// Ray/Sphere Intersection", Ray Tracing Gems, ch. 7, do so with balls).
    #[inline(always)]
    pub fn centered(self) -> Self {
        self.from(-self.origin.dot(self.direction) / self.direction.dot(self.direction))
    }

    /// The line from its point at `step` on.
    #[inline(always)]
    pub fn from(self, step: f64) -> Self {
        let Self { origin, direction, .. } = self;
        Self {
            origin: origin + direction * step,
            direction,
            moved: self.moved + step,
            near: self.near - step,
            far: self.far - step,
        }
    }
}
