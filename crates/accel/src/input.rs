//! Geometry as others hand it over: what it may look like, and what is wrong with it.

use crate::parallel::prelude::*;
use crate::tolerance::{pad_of, reach_of};
use crate::{Aabb, MeshRef, Ray, RayError, Vec3};
use std::borrow::Cow;

/// Why geometry can't be traced.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum InputError {
    /// A triangle names a position that there is not.
    #[error("triangle {triangle} names position {index}, but there are {positions} positions")]
    Index {
        /// The triangle's number, from 0.
        triangle: usize,
        /// What it names.
        index: u32,
        /// How many positions there are.
        positions: usize,
    },
    /// A coordinate is NaN or infinite.
    #[error("position {position} is {value}, which is not finite")]
    Position {
        /// The position's number, from 0.
        position: usize,
        /// Its coordinates.
        value: Vec3,
    },
    /// The box of an object is not finite, or empty.
    #[error("object {object} has a box from {} to {}, which is not finite or is empty", bounds.min, bounds.max)]
    Bounds {
        /// The object's number, from 0.
        object: usize,
        /// Its box.
        bounds: Aabb,
    },
    /// The objects reach farther than 32-bit floats can tell.
    #[error("the objects reach from {} to {}, too far for 32-bit floats", bounds.min, bounds.max)]
    Extent {
        /// The box of all objects.
        bounds: Aabb,
    },
    /// More objects than 32 bits can number.
    #[error("{0} objects are more than the {most} that can be numbered", most = u32::MAX - 1)]
    TooMany(usize),
}

/// A position as others hold it: `[f32; 3]` or [`Vec3`].
pub trait Position: sealed::Sealed + Sized {
    /// The same positions, where they lie.
    fn as_points(positions: &[Self]) -> &[Vec3];
}

impl Position for Vec3 {
    fn as_points(positions: &[Self]) -> &[Vec3] {
        positions
    }
}

impl Position for [f32; 3] {
    fn as_points(positions: &[Self]) -> &[Vec3] {
        bytemuck::cast_slice(positions)
    }
}

mod sealed {
    pub trait Sealed {}
    impl Sealed for super::Vec3 {}
    impl Sealed for [f32; 3] {}
}

/// Elements looked at by one task.
const CHUNK: usize = 1 << 14;

impl<'s> MeshRef<'s> {
    /// Positions and triangles in the caller's buffers, which are read where they lie.
    ///
    /// # Errors
    /// [`InputError`] names the first position that isn't finite, else the first triangle that names a position which there is
    /// not, else says that the mesh reaches too far.
    pub fn new<P: Position>(positions: &'s [P], triangles: &'s [[u32; 3]]) -> Result<Self, InputError> {
        let mesh = Self { positions: P::as_points(positions), triangles };
        if triangles.len() >= u32::MAX as usize {
            return Err(InputError::TooMany(triangles.len()));
        }
        let bad = |point: &Vec3| !point.is_finite();
        if let Some(position) = first(mesh.positions, bad) {
            return Err(InputError::Position { position, value: mesh.positions[position] });
        }
        let positions = mesh.positions.len();
        let missing = |corner: &u32| *corner as usize >= positions;
        if let Some(triangle) = first(triangles, |corners| corners.iter().any(missing)) {
            let index = triangles[triangle].into_iter().find(missing).unwrap_or_default();
            return Err(InputError::Index { triangle, index, positions });
        }
        check_extent(mesh.bounds())?;
        Ok(mesh)
    }
}

/// The first element that is `bad`.
fn first<T: Sync>(elements: &[T], bad: impl Fn(&T) -> bool + Sync) -> Option<usize> {
    let found = elements
        .par_chunks(CHUNK)
        .enumerate()
        .map(|(chunk, elements)| elements.iter().position(&bad).map(|at| chunk * CHUNK + at));
    found.reduce(|| None, |a, b| a.into_iter().chain(b).min())
}

/// Holds the box of all objects against what padded boxes can be.
///
/// # Errors
/// [`InputError::Extent`]
pub fn check_extent(bounds: Aabb) -> Result<(), InputError> {
    let padded = bounds.padded(pad_of(&bounds));
    if bounds.is_empty() || (padded.min.is_finite() && padded.max.is_finite() && padded.extent().is_finite())
    {
        return Ok(());
    }
    Err(InputError::Extent { bounds })
}

/// Whether structures promise the right answer for this ray in a scene with these bounds: it is one, and does not begin farther
/// away than [`crate::tolerance::FAR`].
///
/// # Errors
/// Says which part of the ray is unusable.
pub fn check_ray(scene: &Aabb, ray: &Ray) -> Result<(), RayError> {
    ray.validate()?;
    let away = (ray.origin.as_dvec3() - scene.center().as_dvec3()).abs().max_element();
    if !scene.is_empty() && away > reach_of(scene) {
        return Err(RayError::Far(ray.origin));
    }
    Ok(())
}

/// Rays that structures accept: those that are none (see [`Ray::validate`]) have become one that hits nothing.
pub fn traceable(rays: &[Ray]) -> Cow<'_, [Ray]> {
    let sound = |ray: &Ray| ray.validate().is_ok();
    if rays.iter().all(sound) {
        return Cow::Borrowed(rays);
    }
    let nowhere = Ray { t_max: -1.0, ..Ray::new(Vec3::ZERO, Vec3::X) };
    Cow::Owned(rays.iter().map(|ray| if sound(ray) { *ray } else { nowhere }).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: [[f32; 3]; 3] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

    #[test]
    fn a_sound_mesh_is_read_in_place() {
        let triangles = [[0, 1, 2]];
        let mesh = MeshRef::new(&CORNERS, &triangles).unwrap();
        assert_eq!(mesh.corners(0), CORNERS.map(Vec3::from));
        assert_eq!(mesh.positions.as_ptr().cast(), CORNERS.as_ptr());
        MeshRef::new::<Vec3>(&[], &[]).unwrap();
    }

    #[test]
    fn what_is_wrong_is_named() {
        let far: Vec<[u32; 3]> =
            (0..3 * CHUNK as u32).map(|i| if i >= 20_000 { [0, 7, 9] } else { [0, 1, 2] }).collect();
        let error = MeshRef::new(&CORNERS, &[[0, 1, 2], [2, 1, 3]]).unwrap_err();
        assert_eq!(error, InputError::Index { triangle: 1, index: 3, positions: 3 });
        let error = MeshRef::new(&CORNERS, &far).unwrap_err();
        assert_eq!(error, InputError::Index { triangle: 20_000, index: 7, positions: 3 });
        let error = MeshRef::new(&[CORNERS[0], [0.0, f32::NAN, 0.0]], &[]).unwrap_err();
        assert!(matches!(error, InputError::Position { position: 1, .. }), "{error}");
        let error = MeshRef::new(&[Vec3::splat(-3e38), Vec3::splat(3e38)], &[[0, 1, 1]]).unwrap_err();
        assert!(matches!(error, InputError::Extent { .. }), "{error}");
    }

    #[test]
    fn rays_that_are_none_hit_nothing() {
        let rays = [Ray::new(Vec3::ZERO, Vec3::Y), Ray::new(Vec3::NAN, Vec3::Y)];
        assert!(matches!(traceable(&rays[..1]), Cow::Borrowed(_)));
        let traceable = traceable(&rays);
        assert_eq!(traceable[0], rays[0]);
        assert!(traceable[1].validate().is_ok() && traceable[1].t_max < traceable[1].t_min);
    }

    #[test]
    fn origins_too_far_from_a_scene_are_named() {
        let scene = Aabb { min: Vec3::splat(-1e-20), max: Vec3::splat(1e-20) };
        let from = |x: f32| check_ray(&scene, &Ray::new(Vec3::X * x, Vec3::NEG_X));
        assert_eq!((from(1e9), from(1e12)), (Ok(()), Err(RayError::Far(Vec3::X * 1e12))));
        assert_eq!(check_ray(&Aabb::EMPTY, &Ray::new(Vec3::X * f32::MAX, Vec3::NEG_X)), Ok(()));
    }
}
