//! Objects that are solids rather than facets: what they are, without any test of a ray.
//!
//! Skala's scene "consists of all kinds of objects, like polyhedrons, solids given by implicit functions, parametrically
//! defined patches, CSG trees etc." (1993, §1). A kind is a file here with its data, its box, its normal and what it may
//! look like, and a file of the crate `solids` with its crossings.

mod away;
mod block;
mod cone;
mod csg;
mod disc;
mod error;
mod expression;
mod facets;
mod group;
mod implicit;
mod patch;
mod quadric;
mod sphere;
mod torus;
mod triangle;

pub use cone::Cone;
pub use csg::{Combination, Csg};
pub use disc::Disc;
pub use error::SolidError;
pub use expression::{Arithmetic, Expression, Gradient, ParseError};
pub use facets::Facets;
pub use group::Group;
pub use implicit::Implicit;
pub use patch::{Net, Patch};
pub use quadric::Quadric;
pub use sphere::Sphere;
pub use torus::Torus;

use crate::{Aabb, Corners, Vec3};
use glam::DVec3;

/// An object of any kind.
#[derive(Clone, Debug, PartialEq)]
pub enum Solid {
    /// A triangle, seen from both sides; its front is where its corners run counter-clockwise.
    Triangle(Corners),
    /// A box along the axes.
    Box(Aabb),
    /// A ball.
    Sphere(Sphere),
    /// A cone, cut off and capped, or a cylinder.
    Cone(Cone),
    /// A flat disc, seen from both sides.
    Disc(Disc),
    /// The inside of a quadric within a box.
    Quadric(Quadric),
    /// A ring of circular section.
    Torus(Torus),
    /// Where F(x, y, z) < 0 within a box.
    Implicit(Implicit),
    /// A bicubic Bézier patch, seen from both sides.
    Patch(Patch),
    /// A closed mesh as one object.
    Facets(Facets),
    /// Closed solids combined.
    Csg(Csg),
    /// Objects of any kinds as one.
    Group(Group),
}

/// What is asked of every kind. Places are in `f64`: a point of a surface that is rounded to `f32` lies beside it.
pub trait Shape {
    /// The kind's name in scene files.
    const KIND: &'static str;

    /// The smallest box about it, or one that is little larger; coordinates are rounded outward.
    fn bounds(&self) -> Aabb;

    /// The outward unit normal at a point of the surface, or of the nearest place on it; `None` where there is none.
    fn normal(&self, point: DVec3) -> Option<DVec3>;

    /// Itself under `p ↦ scale·p + offset`, each number being rounded once.
    #[must_use]
    fn moved(&self, scale: f64, offset: DVec3) -> Self;

    /// Every number that it is made of, in order: for checksums.
    fn numbers(&self, see: &mut dyn FnMut(f32));

    /// Whether it can be traced.
    ///
    /// # Errors
    /// Names the field and what is wrong with it.
    fn validate(&self) -> Result<(), SolidError>;
}

/// What is done with a [`Solid`], whichever kind it is; `as make` names what makes a solid of one of its kind.
#[macro_export]
macro_rules! of_solid {
    ($solid:expr, $shape:ident => $does:expr) => {
        $crate::of_solid!($solid, $shape as _ => $does)
    };
    ($solid:expr, $shape:ident as $make:pat_param => $does:expr) => {
        $crate::of_solid!(
            $solid, $shape as $make => $does;
            Triangle Box Sphere Cone Disc Quadric Torus Implicit Patch Facets Csg Group
        )
    };
    ($solid:expr, $shape:ident as $make:pat_param => $does:expr; $($kind:ident)*) => {
        match $solid {
            $($crate::Solid::$kind($shape) => {
                let $make = $crate::Solid::$kind;
                $does
            })*
        }
    };
}

impl Solid {
    /// [`Shape::KIND`]
    pub fn kind(&self) -> &'static str {
        fn of<S: Shape>(_: &S) -> &'static str {
            S::KIND
        }
        of_solid!(self, shape => of(shape))
    }

    /// [`Shape::bounds`]
    pub fn bounds(&self) -> Aabb {
        of_solid!(self, shape => shape.bounds())
    }

    /// [`Shape::normal`]
    pub fn normal(&self, point: DVec3) -> Option<DVec3> {
        of_solid!(self, shape => shape.normal(point))
    }

    /// [`Shape::moved`]
    #[must_use]
    pub fn moved(&self, scale: f64, offset: DVec3) -> Self {
        of_solid!(self, shape as make => make(shape.moved(scale, offset)))
    }

    /// [`Shape::numbers`]
    pub fn numbers(&self, see: &mut dyn FnMut(f32)) {
        of_solid!(self, shape => shape.numbers(see));
    }

    /// [`Shape::validate`]
    ///
    /// # Errors
    /// Names the field and what is wrong with it.
    pub fn validate(&self) -> Result<(), SolidError> {
        of_solid!(self, shape => shape.validate())
    }
}

/// `p ↦ scale·p + offset`
fn placed(p: Vec3, scale: f64, offset: DVec3) -> Vec3 {
    (p.as_dvec3() * scale + offset).as_vec3()
}

fn scaled(length: f32, scale: f64) -> f32 {
    (f64::from(length) * scale) as f32
}

/// The box between two points in `f64`, rounded outward.
fn outward(min: DVec3, max: DVec3) -> Aabb {
    Aabb { min: min.as_vec3(), max: max.as_vec3() }.padded(0.0)
}

/// The box of a disc, widened on every side.
fn around_disc(center: Vec3, normal: Vec3, radius: f32, margin: f32) -> Aabb {
    let center = center.as_dvec3();
    let around = reach(unit(normal).unwrap_or(DVec3::Z)) * f64::from(radius) + f64::from(margin);
    outward(center - around, center + around)
}

/// How far a disc of radius 1 with this unit normal reaches along each axis.
fn reach(normal: DVec3) -> DVec3 {
    let [x, y, z] = normal.to_array();
    DVec3::new((y * y + z * z).sqrt(), (x * x + z * z).sqrt(), (x * x + y * y).sqrt())
}

/// A vector of any length made one of length 1, without overflow.
fn unit(v: Vec3) -> Option<DVec3> {
    v.as_dvec3().try_normalize()
}
