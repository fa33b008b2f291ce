//! Changes to a scene that a definition or an id asks for: transform and split.
//!
//! An id takes modifiers after `@`: `sponza@scale=-20`, `bumps-20k@offset=1e5,0,0`,
//! `stadium@split=0.5@scale=10`, `model.obj@up=z`.

use crate::camera::{self, Camera};
use crate::split::Split;
use accel::{Aabb, Geometry, Vec3, View};
use glam::DVec3;
use serde::Deserialize;

/// `p ↦ 2^scale_exponent · p + offset`, in double precision, rounded once.
#[derive(Clone, Copy, Debug, Default, Deserialize, PartialEq)]
#[serde(deny_unknown_fields, default)]
pub struct Transform {
    /// Coordinates are scaled by this power of two.
    pub scale_exponent: i32,
    /// Added after scaling.
    pub offset: [f64; 3],
}

impl Transform {
    /// # Errors
    /// In words, a number out of range.
    pub fn validate(&self) -> Result<(), String> {
        if self.scale_exponent.unsigned_abs() > 200 {
            return Err(format!("the scale's exponent must be in −200…200, not {}", self.scale_exponent));
        }
        if !DVec3::from_array(self.offset).is_finite() {
            return Err("the offset must be finite".into());
        }
        Ok(())
    }

    fn point(&self, p: Vec3) -> Vec3 {
        let scaled = p.as_dvec3() * libm::ldexp(1.0, self.scale_exponent);
        (scaled + DVec3::from_array(self.offset)).as_vec3() + Vec3::ZERO
    }

    /// Moves every coordinate of the geometry and the camera with it.
    pub fn apply(&self, geometry: &mut Geometry, view: &mut View) {
        if *self == Self::default() {
            return;
        }
        match geometry {
            Geometry::Solids(solids) => {
                let scale = libm::ldexp(1.0, self.scale_exponent);
                let offset = DVec3::from_array(self.offset);
                solids.iter_mut().for_each(|solid| *solid = solid.moved(scale, offset));
            }
            Geometry::Triangles(mesh) => mesh.positions.iter_mut().for_each(|p| *p = self.point(*p)),
            Geometry::Boxes(boxes) => {
                for b in boxes {
                    *b = Aabb { min: self.point(b.min), max: self.point(b.max) };
                }
            }
        }
        view.eye = self.point(view.eye);
        view.target = self.point(view.target);
    }
}

/// What an id asks for after its `@`s.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Modifiers {
    /// Transform on top of the definition's.
    pub transform: Transform,
    /// Split in place of the definition's.
    pub split: Option<f64>,
    /// Camera in place of the scene's, in coordinates as they are after all else.
    pub camera: Camera,
}

impl Modifiers {
    /// Reads the modifiers of a suffix such as `@scale=3@up=y`.
    ///
    /// # Errors
    /// In words, a modifier that makes no sense.
    pub fn parse(suffix: &str) -> Result<Self, String> {
        let mut modifiers = Self::default();
        for part in suffix.split('@').skip(1) {
            let (name, value) = part.split_once('=').unwrap_or((part, ""));
            let bad = |what: &str| format!("`@{part}`: {what}");
            match name {
                "scale" => {
                    modifiers.transform.scale_exponent = value
                        .parse()
                        .map_err(|_| bad("expected a power of two's exponent, as in `@scale=-20`"))?;
                }
                "offset" => {
                    let numbers: Vec<f64> = value.split(',').map_while(|n| n.trim().parse().ok()).collect();
                    modifiers.transform.offset = numbers
                        .try_into()
                        .map_err(|_| bad("expected three numbers, as in `@offset=1e5,0,0`"))?;
                }
                "split" => {
                    let length =
                        value.parse().ok().filter(|length: &f64| *length > 0.0 && length.is_finite());
                    modifiers.split =
                        Some(length.ok_or_else(|| bad("expected a positive length, as in `@split=0.5`"))?);
                }
                "up" => modifiers.camera.up = Some(camera::up(value).map_err(|what| bad(&what))?),
                "eye" => modifiers.camera.eye = Some(camera::point(value).map_err(|what| bad(&what))?),
                "target" => modifiers.camera.target = Some(camera::point(value).map_err(|what| bad(&what))?),
                "fov" => modifiers.camera.fov = Some(camera::fov(value).map_err(|what| bad(&what))?),
                _ => {
                    let known = "`scale`, `offset`, `split`, `up`, `eye`, `target` and `fov`";
                    return Err(bad(&format!("the modifiers are {known}")));
                }
            }
        }
        modifiers.transform.validate()?;
        Ok(modifiers)
    }
}

/// Splits the triangles of `geometry`, if it has any, and returns each facet's original
/// triangle.
///
/// # Errors
/// In words, when the facets would be too many.
pub fn split(geometry: &mut Geometry, longest: f64) -> Result<Option<Vec<u32>>, String> {
    let Geometry::Triangles(mesh) = geometry else { return Ok(None) };
    let Split { mesh: facets, original } = crate::split::split(mesh, longest)?;
    *mesh = facets;
    Ok(Some(original))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::Up;

    #[test]
    fn modifiers_are_read_and_slips_explained() {
        let modifiers =
            Modifiers::parse("@scale=-20@offset=1,2e3,-3@split=0.5@up=-y@eye=1,2,3@target=0,0,1@fov=30")
                .unwrap();
        assert_eq!(modifiers.transform, Transform { scale_exponent: -20, offset: [1.0, 2000.0, -3.0] });
        assert_eq!(modifiers.split, Some(0.5));
        assert_eq!(modifiers.camera.up.map(Up::vector), Some(Vec3::NEG_Y));
        let Camera { eye, target, fov, .. } = modifiers.camera;
        assert_eq!((eye, target, fov), (Some([1.0, 2.0, 3.0]), Some([0.0, 0.0, 1.0]), Some(30.0)));
        for bad in [
            "@",
            "@scale=x",
            "@offset=1,2",
            "@split=0",
            "@split=nan",
            "@bogus=1",
            "@scale=999",
            "@up=w",
            "@eye=1,2",
            "@target=inf,0,0",
            "@fov=180",
        ] {
            assert!(Modifiers::parse(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn powers_of_two_keep_every_bit() {
        let scaled = Transform { scale_exponent: 100, offset: [0.0; 3] }.point(Vec3::new(0.1, 0.2, -0.3));
        let back = Transform { scale_exponent: -100, offset: [0.0; 3] }.point(scaled);
        assert_eq!(back, Vec3::new(0.1, 0.2, -0.3));
    }
}
