//! Scenes, rays and settings from numbers: anything that the suite accepts, and much that it has to refuse.

use crate::Numbers;
use accel::input::check_ray;
use accel::{Geometry, InputError, Mesh, MeshRef, Ray, Scene, Vec3, View};
use lanes::Level;
use primitives::KernelId;
use serde::{Deserialize, Serialize};

/// Where and how large a scene is.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Reach {
    /// Its size is about two to this.
    pub scale: i32,
    /// How far it is from the origin of coordinates: about two to this times its size; none for no offset.
    pub offset: Option<i32>,
    /// How far rays begin: about two to this times its size.
    pub origins: i32,
}

/// Largest exponents of [`Reach`], which a run has been through.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Bounds {
    /// Least and greatest scale.
    pub scale: [i32; 2],
    /// Greatest offset.
    pub offset: i32,
    /// Greatest distance of rays' origins.
    pub origins: i32,
}

/// What the marathon runs over.
pub const WIDE: Bounds = Bounds { scale: [-100, 100], offset: 22, origins: 60 };

impl Reach {
    /// One within these bounds; half of all are of usual size, near the origin of coordinates, with rays from near.
    pub fn new(numbers: &mut impl Numbers, within: &Bounds) -> Self {
        let up_to = |numbers: &mut dyn FnMut(u32) -> u32, most: i32| numbers(most.unsigned_abs() + 1) as i32;
        let mut below = |end: u32| numbers.below(end);
        let [least, most] = within.scale;
        let scale = if below(2) == 0 { 0 } else { least + up_to(&mut below, most - least) };
        let offset = (below(4) == 0).then(|| up_to(&mut below, within.offset));
        let origins = if below(4) == 0 { up_to(&mut below, within.origins) } else { 1 };
        Self { scale, offset, origins }
    }

    fn size(&self) -> f32 {
        2f32.powi(self.scale)
    }
}

/// How the corners of triangles lie to each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// Small triangles anywhere.
    Scattered,
    /// Corners on few places, so that much meets in points and edges.
    OnLattice,
    /// Long and thin.
    Needles,
    /// All in one plane.
    Sheet,
    /// Many times the same.
    Repeated,
    /// Of sizes from 1 to 2^-19.
    Mixed,
    /// Any bits for numbers, and indices that name nothing.
    AnyBits,
}

const SHAPES: [Shape; 7] = [
    Shape::Scattered,
    Shape::OnLattice,
    Shape::Needles,
    Shape::Sheet,
    Shape::Repeated,
    Shape::Mixed,
    Shape::AnyBits,
];

fn point(numbers: &mut impl Numbers) -> Vec3 {
    Vec3::new(numbers.unit(), numbers.unit(), numbers.unit())
}

fn lattice(numbers: &mut impl Numbers) -> Vec3 {
    let mut at = || (numbers.below(9) as f32 - 4.0) / 4.0;
    Vec3::new(at(), at(), at())
}

/// A scene of at most `most` triangles.
///
/// # Errors
/// [`InputError`] where the numbers make what has to be refused.
pub fn scene(numbers: &mut impl Numbers, reach: &Reach, most: u32) -> Result<Scene, InputError> {
    let shape = numbers.one_of(&SHAPES);
    scene_of(numbers, shape, reach, most)
}

/// [`scene`] of one shape.
///
/// # Errors
/// Those of [`scene`].
pub fn scene_of(
    numbers: &mut impl Numbers,
    shape: Shape,
    reach: &Reach,
    most: u32,
) -> Result<Scene, InputError> {
    let count = numbers.below(most + 1);
    let mut mesh = Mesh::default();
    for i in 0..count {
        let corners = match shape {
            Shape::Scattered => {
                let center = point(numbers);
                [(); 3].map(|()| center + point(numbers) * 0.2)
            }
            Shape::OnLattice => [(); 3].map(|()| lattice(numbers)),
            Shape::Needles => {
                let (from, to) = (point(numbers), point(numbers));
                [from, to, from + point(numbers) * 1e-5]
            }
            Shape::Sheet => [(); 3].map(|()| Vec3 { z: 0.25, ..point(numbers) }),
            Shape::Repeated if i > 0 && numbers.below(3) > 0 => {
                let again = numbers.below(i);
                mesh.corners(again as usize)
            }
            Shape::Repeated => [(); 3].map(|()| lattice(numbers)),
            Shape::Mixed => {
                let size = 2f32.powi(-(numbers.below(20) as i32));
                let center = point(numbers);
                [(); 3].map(|()| center + point(numbers) * size)
            }
            Shape::AnyBits => [(); 3].map(|()| {
                Vec3::new(numbers.bits_of_float(), numbers.bits_of_float(), numbers.bits_of_float())
            }),
        };
        mesh.positions.extend(corners);
        // A corner that two triangles share, and indices that name nothing where bits are anything.
        let first = 3 * i;
        let shared = if i > 0 && numbers.below(4) == 0 { numbers.below(first) } else { first };
        let wild = shape == Shape::AnyBits && numbers.below(64) == 0;
        mesh.triangles.push([if wild { numbers.bits() } else { shared }, first + 1, first + 2]);
    }
    if shape != Shape::AnyBits {
        let offset = reach.offset.map_or(Vec3::ZERO, |power| point(numbers) * 2f32.powi(power));
        mesh.positions.iter_mut().for_each(|p| *p = (*p + offset) * reach.size());
    }
    MeshRef::new(&mesh.positions, &mesh.triangles)?;
    let view = View { eye: Vec3::Z, target: Vec3::ZERO, up: Vec3::Y, fov_y_degrees: 45.0 };
    Ok(Scene { id: "case".into(), geometry: Geometry::Triangles(mesh), view })
}

trait Floats: Numbers {
    /// Any bits, often of a number of usual size.
    fn bits_of_float(&mut self) -> f32 {
        match self.below(4) {
            0 => f32::from_bits(self.bits()),
            1 => self.below(5) as f32 - 2.0,
            _ => self.unit(),
        }
    }
}

impl<N: Numbers> Floats for N {}

/// So many rays for the scene, all of which structures accept.
pub fn rays(numbers: &mut impl Numbers, scene: &Scene, reach: &Reach, count: usize) -> Vec<Ray> {
    let Geometry::Triangles(mesh) = &scene.geometry else { return Vec::new() };
    let bounds = mesh.bounds();
    let (center, size) = (bounds.center(), bounds.extent().max_element());
    let mut all = Vec::with_capacity(count);
    // Numbers that only make unusable rays have an end.
    for _ in 0..2 * count {
        if all.len() == count {
            break;
        }
        let ray = match mesh.triangles.len() as u32 {
            0 => Ray::new(point(numbers), point(numbers)),
            triangles => {
                let corners = mesh.corners(numbers.below(triangles) as usize);
                let target = target(numbers, corners);
                let ray = toward(numbers, target, center, size, reach);
                ranged(numbers, ray)
            }
        };
        if check_ray(&bounds, &ray).is_ok() {
            all.push(ray);
        }
    }
    all
}

/// A point of a triangle: a corner, on an edge, inside, or nearby.
fn target(numbers: &mut impl Numbers, [a, b, c]: [Vec3; 3]) -> Vec3 {
    match numbers.below(4) {
        0 => a,
        1 => a + (b - a) * numbers.unit().abs(),
        2 => (a + b + c) / 3.0,
        _ => a + (b - a) * numbers.unit() + (c - a) * numbers.unit(),
    }
}

fn toward(numbers: &mut impl Numbers, target: Vec3, center: Vec3, size: f32, reach: &Reach) -> Ray {
    let away = size * 2f32.powi(reach.origins);
    match numbers.below(6) {
        // Along an axis, through the target on the others.
        0 => {
            let axis = numbers.below(3) as usize;
            let mut direction = Vec3::ZERO;
            direction[axis] = if numbers.below(2) == 0 { 1.0 } else { -1.0 };
            let mut origin = target;
            origin[axis] -= direction[axis] * away;
            Ray::new(origin, direction)
        }
        // Through the target without rounding, as far as the direction's few bits reach.
        1 => {
            let direction = lattice(numbers) * size;
            Ray::new(target - direction * 2f32.powi(reach.origins), direction)
        }
        // From inside.
        2 => {
            let origin = center + point(numbers) * size * 0.5;
            Ray::new(origin, target - origin)
        }
        // Anywhere.
        3 => Ray::new(center + point(numbers) * away, point(numbers)),
        _ => {
            let origin = center + point(numbers) * away;
            Ray::new(origin, target - origin)
        }
    }
}

/// The ray with another range now and then.
fn ranged(numbers: &mut impl Numbers, ray: Ray) -> Ray {
    match numbers.below(8) {
        0 => Ray { t_max: 1.0, ..ray },
        1 => Ray { t_min: 1.0, ..ray },
        2 => Ray { t_min: -1e30, ..ray },
        3 => Ray { t_min: numbers.unit() * 2.0, t_max: numbers.unit() * 2.0, ..ray },
        _ => ray,
    }
}

/// A structure with settings and a kernel, as the command line takes them.
pub fn structure(numbers: &mut impl Numbers) -> String {
    let kernel = numbers.one_of(&KernelId::ALL);
    let resolution = match numbers.below(4) {
        0 => String::new(),
        1 => format!(",resolution={}", 1 + numbers.below(20)),
        2 => {
            format!(",resolution={}x{}x{}", 1 + numbers.below(9), 1 + numbers.below(9), 1 + numbers.below(40))
        }
        _ => format!(",resolution={}", numbers.one_of(&[1, 2, 64])),
    };
    let levels: Vec<Level> = Level::ALL.into_iter().filter(|level| level.available()).collect();
    let level = numbers.one_of(&levels).id();
    let simd = if numbers.below(2) == 0 { format!(",simd={level}") } else { String::new() };
    match numbers.below(8) {
        0 => format!("minmax:kernel={kernel}"),
        1 => format!("sphere:kernel={kernel}"),
        2 => format!("bmssm-dense:kernel={kernel}{simd}{resolution}"),
        3 => format!("ssm-list:kernel={kernel}{simd}{resolution}"),
        4 | 5 => {
            let divide = numbers.one_of(&["", ",divide=off", ",divide=0.5", ",divide=3"]);
            format!("ssm:kernel={kernel}{simd}{resolution}{divide}")
        }
        _ => {
            let stretch = numbers.one_of(&["", ",stretch=64", ",stretch=256"]);
            let geometry = numbers.one_of(&["", ",geometry=scene", ",geometry=rows"]);
            format!("bmssm:kernel={kernel}{simd}{stretch}{geometry}")
        }
    }
}
