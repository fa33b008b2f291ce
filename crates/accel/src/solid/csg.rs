//! Solids combined from closed solids: constructive solid geometry.

use super::away::away;
use super::{Shape, Solid, SolidError};
use crate::Aabb;
use glam::DVec3;

/// How two closed objects are one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Combination {
    /// What is in either.
    Union,
    /// What is in both.
    Intersection,
    /// What is in the first and not in the second.
    Difference,
}

impl Combination {
    /// Whether a point is inside, told of both parts.
    #[inline]
    pub const fn holds(self, [first, second]: [bool; 2]) -> bool {
        match self {
            Self::Union => first || second,
            Self::Intersection => first && second,
            Self::Difference => first && !second,
        }
    }

    /// Name as used in scene files.
    pub const fn id(self) -> &'static str {
        match self {
            Self::Union => "union",
            Self::Intersection => "intersection",
            Self::Difference => "difference",
        }
    }

    /// The combination of this name.
    pub fn parse(name: &str) -> Option<Self> {
        [Self::Union, Self::Intersection, Self::Difference].into_iter().find(|known| known.id() == name)
    }
}

/// A tree of closed solids.
#[derive(Clone, Debug, PartialEq)]
pub struct Csg {
    /// How the parts are combined.
    pub combination: Combination,
    /// Two closed solids, which may be such trees themselves.
    pub parts: Box<[Solid; 2]>,
}

/// Trees within each other, so that none fills the stack.
const DEEPEST: u32 = 64;

impl Csg {
    /// Both as one.
    pub fn new(combination: Combination, first: Solid, second: Solid) -> Self {
        Self { combination, parts: Box::new([first, second]) }
    }

    /// Several as one, the first with all others, as halves of halves so that the tree is low.
    ///
    /// `None` if there is none.
    pub fn of(combination: Combination, mut solids: Vec<Solid>) -> Option<Solid> {
        if combination == Combination::Difference && solids.len() > 2 {
            let first = solids.remove(0);
            let rest = Self::of(Combination::Union, solids)?;
            return Some(Solid::Csg(Self::new(combination, first, rest)));
        }
        while solids.len() > 1 {
            let mut halved = Vec::with_capacity(solids.len().div_ceil(2));
            let mut all = solids.into_iter();
            while let Some(first) = all.next() {
                halved.push(match all.next() {
                    Some(second) => Solid::Csg(Self::new(combination, first, second)),
                    None => first,
                });
            }
            solids = halved;
        }
        solids.pop()
    }

    fn depth(&self) -> u32 {
        let of = |part: &Solid| if let Solid::Csg(tree) = part { tree.depth() } else { 0 };
        1 + self.parts.iter().map(of).max().unwrap_or(0)
    }

    /// The part whose surface is nearest to a point, how far that is, and whether it is turned inside out.
    pub(super) fn nearest(&self, point: DVec3) -> Option<(&Solid, f64, bool)> {
        let of = |i: usize| {
            let turned = i == 1 && self.combination == Combination::Difference;
            match &self.parts[i] {
                Solid::Csg(tree) => {
                    tree.nearest(point).map(|(part, away, other)| (part, away, other != turned))
                }
                part => away(part, point).map(|away| (part, away, turned)),
            }
        };
        let found = [of(0), of(1)].into_iter().flatten();
        found.min_by(|a, b| a.1.total_cmp(&b.1))
    }
}

/// Why a solid has no inside, if it has none.
fn openness(solid: &Solid) -> Option<&'static str> {
    match solid {
        Solid::Triangle(_) | Solid::Disc(_) | Solid::Patch(_) => {
            Some("is no closed object: it has no inside")
        }
        Solid::Group(_) => Some("may be open: it has no inside, as a union has"),
        _ => None,
    }
}

impl Shape for Csg {
    const KIND: &'static str = "csg";

    fn bounds(&self) -> Aabb {
        let [first, second] = [self.parts[0].bounds(), self.parts[1].bounds()];
        match self.combination {
            Combination::Union => first.union(second),
            Combination::Difference => first,
            Combination::Intersection => {
                let both = Aabb { min: first.min.max(second.min), max: first.max.min(second.max) };
                // Nothing is inside, but there is a box.
                if both.is_empty() { Aabb::of_points([first.center()]) } else { both }
            }
        }
    }

    fn normal(&self, point: DVec3) -> Option<DVec3> {
        let (part, _, turned) = self.nearest(point)?;
        part.normal(point).map(|normal| if turned { -normal } else { normal })
    }

    fn moved(&self, scale: f64, offset: DVec3) -> Self {
        let [first, second] = &*self.parts;
        Self::new(self.combination, first.moved(scale, offset), second.moved(scale, offset))
    }

    fn numbers(&self, see: &mut dyn FnMut(f32)) {
        see(match self.combination {
            Combination::Union => 1.0,
            Combination::Intersection => 2.0,
            Combination::Difference => 3.0,
        });
        for part in &*self.parts {
            part.kind().bytes().map(f32::from).for_each(&mut *see);
            part.numbers(see);
        }
    }

    fn validate(&self) -> Result<(), SolidError> {
        let refuse = |reason: String| Err(SolidError::new(Self::KIND, "parts", reason));
        if self.depth() > DEEPEST {
            return refuse(format!("are more than {DEEPEST} levels deep"));
        }
        for part in &*self.parts {
            if let Some(reason) = openness(part) {
                return refuse(format!("hold a {}, which {reason}", part.kind()));
            }
            part.validate()?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Disc, Sphere};
    use super::*;
    use crate::Vec3;

    fn ball(x: f32) -> Solid {
        Solid::Sphere(Sphere { center: Vec3::X * x, radius: 1.0 })
    }

    #[test]
    fn open_parts_are_refused_at_any_depth() {
        let disc = Solid::Disc(Disc { center: Vec3::ZERO, normal: Vec3::Z, radius: 1.0 });
        let inner = Solid::Csg(Csg::new(Combination::Union, ball(0.0), disc));
        let outer = Csg::new(Combination::Difference, ball(1.0), inner);
        assert!(outer.validate().unwrap_err().to_string().contains("disc"));
        assert!(Csg::new(Combination::Difference, ball(0.0), ball(1.0)).validate().is_ok());
    }

    #[test]
    fn many_are_a_low_tree() {
        let Some(Solid::Csg(all)) =
            Csg::of(Combination::Difference, (0..100).map(|i| ball(i as f32)).collect())
        else {
            panic!("a tree")
        };
        assert_eq!(all.depth(), 8);
        assert_eq!(all.bounds(), ball(0.0).bounds());
        assert_eq!(Csg::of(Combination::Union, Vec::new()), None);
    }

    #[test]
    fn a_cavity_has_its_normals_turned() {
        let shell = Csg::new(
            Combination::Difference,
            ball(0.0),
            Solid::Sphere(Sphere { center: Vec3::ZERO, radius: 0.5 }),
        );
        assert_eq!(shell.normal(DVec3::new(0.0, 0.99, 0.0)), Some(DVec3::Y));
        assert_eq!(shell.normal(DVec3::new(0.0, 0.51, 0.0)), Some(DVec3::NEG_Y));
    }
}
