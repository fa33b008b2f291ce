//! Objects that hold other objects.

use super::away::away;
use super::facets::distance;
use super::{Disc, Shape, Solid, SolidError};
use crate::{Aabb, tolerance};
use glam::DVec3;

/// Objects of any kinds as one: a structure sees their box, and what is in it is their own affair (Skala 1993, §7, a hierarchy
/// of solids). Groups may hold groups; each has its box tested before its parts.
#[derive(Clone, Debug, PartialEq)]
pub struct Group {
    parts: Box<[Solid]>,
    bounds: Aabb,
}

/// Groups within each other, so that none fills the stack.
const DEEPEST: u32 = 64;

impl Group {
    /// Of objects, of which there have to be some for it to be valid.
    pub fn new(parts: Vec<Solid>) -> Self {
        let bounds = parts.iter().fold(Aabb::EMPTY, |all, part| all.union(part.bounds()));
        Self { parts: parts.into(), bounds }
    }

    /// The objects.
    pub fn parts(&self) -> &[Solid] {
        &self.parts
    }

    /// A box that every line through a part goes through, wider by more than a test of it is off by.
    pub fn surroundings(&self) -> Aabb {
        self.bounds.padded(tolerance::pad_of(&self.bounds))
    }

    fn depth(&self) -> u32 {
        let of = |part: &Solid| if let Solid::Group(group) = part { group.depth() } else { 0 };
        1 + self.parts.iter().map(of).max().unwrap_or(0)
    }

    /// The part, at any depth, whose surface is nearest to a point, and about how far that is.
    pub(super) fn nearest(&self, point: DVec3) -> Option<(&Solid, f64)> {
        let found = self.parts.iter().filter_map(|part| nearest(part, point));
        found.min_by(|a, b| a.1.total_cmp(&b.1))
    }
}

/// An object, or of a group the part, and about how far its surface is from a point.
fn nearest(part: &Solid, point: DVec3) -> Option<(&Solid, f64)> {
    let away = match part {
        Solid::Group(group) => return group.nearest(point),
        Solid::Triangle(corners) => distance(corners.map(|corner| corner.as_dvec3()), point),
        Solid::Disc(disc) => of_disc(disc, point)?,
        Solid::Patch(patch) => {
            let [u, v] = patch.nearest(point);
            patch.at(u, v).distance(point)
        }
        closed => away(closed, point)?,
    };
    Some((part, away))
}

fn of_disc(disc: &Disc, point: DVec3) -> Option<f64> {
    let normal = disc.normal.as_dvec3().try_normalize()?;
    let from = point - disc.center.as_dvec3();
    let height = from.dot(normal);
    let beyond = (from - normal * height).length() - f64::from(disc.radius);
    Some(height.hypot(beyond.max(0.0)))
}

impl Shape for Group {
    const KIND: &'static str = "group";

    fn bounds(&self) -> Aabb {
        self.bounds
    }

    fn normal(&self, point: DVec3) -> Option<DVec3> {
        self.nearest(point)?.0.normal(point)
    }

    fn moved(&self, scale: f64, offset: DVec3) -> Self {
        Self::new(self.parts.iter().map(|part| part.moved(scale, offset)).collect())
    }

    fn numbers(&self, see: &mut dyn FnMut(f32)) {
        for part in &self.parts {
            part.kind().bytes().map(f32::from).for_each(&mut *see);
            part.numbers(see);
        }
        // What follows belongs to the group's own neighbours.
        see(self.parts.len() as f32);
    }

    fn validate(&self) -> Result<(), SolidError> {
        let refuse = |reason: String| Err(SolidError::new(Self::KIND, "parts", reason));
        if self.parts.is_empty() {
            return refuse("are none".into());
        }
        if self.depth() > DEEPEST {
            return refuse(format!("are more than {DEEPEST} levels deep"));
        }
        self.parts.iter().try_for_each(Solid::validate)
    }
}

#[cfg(test)]
mod tests {
    use super::super::Sphere;
    use super::*;
    use crate::Vec3;

    fn ball(x: f32, radius: f32) -> Solid {
        Solid::Sphere(Sphere { center: Vec3::X * x, radius })
    }

    #[test]
    fn groups_hold_groups_and_open_objects() {
        let disc = Solid::Disc(Disc { center: Vec3::Z * 3.0, normal: Vec3::Z, radius: 1.0 });
        let inner = Group::new(vec![disc, ball(4.0, 1.0)]);
        let outer = Group::new(vec![Solid::Group(inner), ball(0.0, 1.0)]);
        assert_eq!(outer.validate(), Ok(()));
        assert_eq!(outer.bounds().max.x, ball(4.0, 1.0).bounds().max.x);
        assert_eq!(outer.normal(DVec3::new(0.2, 0.0, 3.0)), Some(DVec3::Z));
        assert_eq!(outer.normal(DVec3::X * 5.0), Some(DVec3::X));
        assert_eq!(outer.moved(2.0, DVec3::ZERO).bounds().max.x, ball(8.0, 2.0).bounds().max.x);
    }

    #[test]
    fn what_is_wrong_with_a_part_or_with_their_number_is_told() {
        assert!(Group::new(Vec::new()).validate().unwrap_err().to_string().contains("none"));
        assert!(Group::new(vec![ball(0.0, -1.0)]).validate().unwrap_err().to_string().contains("radius"));
        let deep = (0..70).fold(ball(0.0, 1.0), |inner, _| Solid::Group(Group::new(vec![inner])));
        assert!(deep.validate().unwrap_err().to_string().contains("levels"));
    }
}
