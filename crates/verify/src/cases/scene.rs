//! Scenes, small ones of which much goes wrong.

use super::{Reach, lattice, point};
use crate::Numbers;
use accel::input::check_extent;
use accel::{Aabb, Geometry, InputError, Mesh, MeshRef, Scene, Vec3, View};
use serde::{Deserialize, Serialize};

/// How the corners of triangles lie to each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
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
    /// A closed mesh, a ball of rough skin: its triangles share all their corners.
    Closed,
    /// No triangles but boxes, some of them flat.
    Boxes,
}

/// All there are.
pub const SHAPES: [Shape; 9] = [
    Shape::Scattered,
    Shape::OnLattice,
    Shape::Needles,
    Shape::Sheet,
    Shape::Repeated,
    Shape::Mixed,
    Shape::AnyBits,
    Shape::Closed,
    Shape::Boxes,
];

/// A scene of at most `most` objects, and what shape it has.
///
/// # Errors
/// [`InputError`] where the numbers make what has to be refused.
pub fn scene(numbers: &mut impl Numbers, reach: &Reach, most: u32) -> Result<(Shape, Scene), InputError> {
    let shape = numbers.one_of(&SHAPES);
    Ok((shape, scene_of(numbers, shape, reach, most)?))
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
    let geometry = match shape {
        Shape::Boxes => Geometry::Boxes(boxes(numbers, reach, count)?),
        Shape::Closed => {
            let mesh = closed(numbers, count);
            Geometry::Triangles(placed(numbers, reach, mesh)?)
        }
        _ => {
            let mesh = triangles(numbers, shape, count);
            Geometry::Triangles(if shape == Shape::AnyBits {
                sound(mesh)?
            } else {
                placed(numbers, reach, mesh)?
            })
        }
    };
    let view = View { eye: Vec3::Z, target: Vec3::ZERO, up: Vec3::Y, fov_y_degrees: 45.0 };
    Ok(Scene { id: "case".into(), geometry, view })
}

fn sound(mesh: Mesh) -> Result<Mesh, InputError> {
    MeshRef::new(&mesh.positions, &mesh.triangles)?;
    Ok(mesh)
}

/// The mesh where and as large as wanted.
fn placed(numbers: &mut impl Numbers, reach: &Reach, mut mesh: Mesh) -> Result<Mesh, InputError> {
    let offset = offset(numbers, reach);
    mesh.positions.iter_mut().for_each(|p| *p = (*p + offset) * reach.size());
    sound(mesh)
}

fn offset(numbers: &mut impl Numbers, reach: &Reach) -> Vec3 {
    reach.offset.map_or(Vec3::ZERO, |power| point(numbers) * 2f32.powi(power))
}

fn boxes(numbers: &mut impl Numbers, reach: &Reach, count: u32) -> Result<Vec<Aabb>, InputError> {
    let offset = offset(numbers, reach);
    let mut boxes = Vec::with_capacity(count as usize);
    for _ in 0..count {
        let corner = match numbers.below(3) {
            0 => lattice(numbers),
            _ => point(numbers),
        };
        let mut size = point(numbers).abs() * 2f32.powi(-(numbers.below(12) as i32));
        if numbers.below(4) == 0 {
            size[numbers.below(3) as usize] = 0.0;
        }
        let place = |p: Vec3| (p + offset) * reach.size();
        boxes.push(Aabb { min: place(corner), max: place(corner + size) });
    }
    check_extent(boxes.iter().fold(Aabb::EMPTY, |all, one| all.union(*one)))?;
    Ok(boxes)
}

/// A closed mesh: rough rings between two poles, about so many triangles.
pub fn closed(numbers: &mut impl Numbers, count: u32) -> Mesh {
    let around = 3 + (f64::from(count).sqrt() as u32) / 2;
    let rings = 1 + count / (2 * around);
    let mut mesh = Mesh { positions: vec![Vec3::Y, Vec3::NEG_Y], triangles: Vec::new() };
    for ring in 0..rings {
        let up = std::f32::consts::PI * (ring + 1) as f32 / (rings + 1) as f32;
        for place in 0..around {
            let turn = std::f32::consts::TAU * place as f32 / around as f32;
            let rough = 1.0 + 0.1 * numbers.unit();
            mesh.positions.push(Vec3::new(turn.cos() * up.sin(), up.cos(), turn.sin() * up.sin()) * rough);
        }
    }
    let at = |ring: u32, place: u32| 2 + ring * around + place % around;
    for place in 0..around {
        mesh.triangles.push([0, at(0, place + 1), at(0, place)]);
        for ring in 1..rings {
            let [a, b] = [at(ring - 1, place), at(ring - 1, place + 1)];
            let [c, d] = [at(ring, place), at(ring, place + 1)];
            mesh.triangles.extend([[a, b, d], [a, d, c]]);
        }
        mesh.triangles.push([1, at(rings - 1, place), at(rings - 1, place + 1)]);
    }
    mesh
}

fn triangles(numbers: &mut impl Numbers, shape: Shape, count: u32) -> Mesh {
    let mut mesh = Mesh::default();
    for i in 0..count {
        let corners = match shape {
            Shape::Scattered => {
                let center = point(numbers);
                [(); 3].map(|()| center + point(numbers) * 0.2)
            }
            Shape::OnLattice | Shape::Closed | Shape::Boxes => [(); 3].map(|()| lattice(numbers)),
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
    mesh
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
