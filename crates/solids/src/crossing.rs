//! Crossings of a ray with a surface.

use accel::{Ray, Surface};

/// Where a ray's line passes through a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Crossing {
    /// The ray's parameter.
    pub t: f64,
    /// Whether the ray goes in there: into a closed object, or through the front of an open one.
    pub enters: bool,
    /// First surface coordinate: of a triangle the weight of its second corner, of most kinds 0.
    pub u: f32,
    /// Second surface coordinate: of a triangle the weight of its third corner, of most kinds 0.
    pub v: f32,
}

impl Crossing {
    /// One of a kind without surface coordinates.
    pub const fn at(t: f64, enters: bool) -> Self {
        Self { t, enters, u: 0.0, v: 0.0 }
    }

    /// As structures report it.
    pub fn surface(&self) -> Surface {
        // Both zeros are one.
        Surface { t: self.t as f32 + 0.0, u: self.u, v: self.v }
    }

    /// Whether it counts for a ray whose t ends there, by its t as it is reported.
    pub fn within(&self, ray: &Ray, t_max: f32) -> bool {
        let t = self.t as f32;
        ray.t_min <= t && t <= t_max
    }
}

/// What every kind can say of a ray.
pub trait Crossings {
    /// Appends every crossing of the ray whose t, rounded to `f32`, is in `[ray.t_min, ray.t_max]`, in order of t. What closed
    /// objects are entered by they are left by: over all t their crossings come in pairs, which are equal where the ray
    /// but touches.
    fn crossings(&self, ray: &Ray, out: &mut Vec<Crossing>);

    /// The first of them with t up to `t_max` in place of the ray's, as a structure reports it.
    fn nearest(&self, ray: &Ray, t_max: f32) -> Option<Surface> {
        let mut all = Vec::new();
        self.crossings(&Ray { t_max, ..*ray }, &mut all);
        all.first().map(Crossing::surface)
    }
}

/// Up to N crossings of a line, in order.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Few<const N: usize> {
    all: [Crossing; N],
    count: usize,
}

impl<const N: usize> Few<N> {
    pub const NONE: Self = Self { all: [Crossing::at(0.0, false); N], count: 0 };

    /// Appends one; there must be room.
    pub fn push(&mut self, crossing: Crossing) {
        self.all[self.count] = crossing;
        self.count += 1;
    }

    /// One way in and one out.
    pub fn chord(enters: f64, leaves: f64) -> Self {
        let mut few = Self::NONE;
        few.push(Crossing::at(enters, true));
        few.push(Crossing::at(leaves, false));
        few
    }

    pub fn as_slice(&self) -> &[Crossing] {
        &self.all[..self.count]
    }

    pub fn append_to(&self, ray: &Ray, out: &mut Vec<Crossing>) {
        out.extend(self.as_slice().iter().filter(|crossing| crossing.within(ray, ray.t_max)));
    }

    pub fn nearest(&self, ray: &Ray, t_max: f32) -> Option<Surface> {
        self.as_slice().iter().find(|crossing| crossing.within(ray, t_max)).map(Crossing::surface)
    }
}

/// A kind whose line has so few crossings that they need no list.
pub(crate) trait FewCrossings<const N: usize> {
    /// All crossings of the ray's line, whatever its range.
    fn few(&self, ray: &Ray) -> Few<N>;
}

/// Implements [`Crossings`] by [`FewCrossings`].
macro_rules! crossings_by_few {
    ($($shape:ty),+) => {$(
        impl $crate::Crossings for $shape {
            fn crossings(&self, ray: &accel::Ray, out: &mut Vec<$crate::Crossing>) {
                $crate::crossing::FewCrossings::few(self, ray).append_to(ray, out);
            }

            fn nearest(&self, ray: &accel::Ray, t_max: f32) -> Option<accel::Surface> {
                $crate::crossing::FewCrossings::few(self, ray).nearest(ray, t_max)
            }
        }
    )+};
}
pub(crate) use crossings_by_few;
