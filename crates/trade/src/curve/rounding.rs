//! Corners with fewer bits.

use accel::{Aabb, Corners, Mesh, Vec3, morton};

/// Triangles that share a grid of their own.
const BLOCK: usize = 64;

/// A triangle is grown by at most so many steps at a corner: one as thin as a needle would reach through the whole scene.
const MAX_GROWN: f64 = 16.0;

/// How corners are rounded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rounding {
    /// To a grid of 2^bits places an axis over the scene.
    Scene(u32),
    /// To one over each block of 64 triangles that lie beside each other.
    Block(u32),
    /// As over the scene, and each triangle grown by the step, so that what rounding uncovers is covered again unless it is seen edge-on.
    Grown(u32),
    /// To half floats, from the scene's centre in its half extents.
    Half,
}

impl Rounding {
    /// All that the curve has.
    pub fn all() -> Vec<Self> {
        let scene = [6, 8, 10, 12, 14, 18, 21].map(Self::Scene);
        let block = [6, 8, 10, 12, 16, 21].map(Self::Block);
        let grown = [8, 12, 16, 21].map(Self::Grown);
        scene.into_iter().chain(block).chain(grown).chain([Self::Half]).collect()
    }

    /// Its name in tables.
    pub fn name(self) -> String {
        match self {
            Self::Scene(bits) => format!("{bits} bits over the scene"),
            Self::Block(bits) => format!("{bits} bits over a block"),
            Self::Grown(bits) => format!("{bits} bits over the scene, grown"),
            Self::Half => "half floats".to_owned(),
        }
    }

    /// Bits of a coordinate.
    pub const fn bits(self) -> u32 {
        match self {
            Self::Scene(bits) | Self::Block(bits) | Self::Grown(bits) => bits,
            Self::Half => 16,
        }
    }

    /// Bytes a triangle of what its block keeps beside the corners: where its grid begins, and three steps.
    pub const fn header(self) -> f64 {
        match self {
            Self::Block(_) => 24.0 / BLOCK as f64,
            _ => 0.0,
        }
    }

    /// The mesh with its corners rounded.
    pub fn apply(self, mesh: &Mesh) -> Mesh {
        let bounds = mesh.bounds();
        if bounds.is_empty() {
            return mesh.clone();
        }
        match self {
            Self::Scene(bits) => {
                let grid = QuantisationGrid::over(&bounds, bits);
                each(mesh, |p| grid.snap(p))
            }
            Self::Half => {
                let (low, high) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
                let (centre, half) = ((low + high) * 0.5, (high - low).max_element() * 0.5);
                each(mesh, |p| (((p.as_dvec3() - centre) / half).map(half_float) * half + centre).as_vec3())
            }
            Self::Block(bits) => blocks(mesh, bits),
            Self::Grown(bits) => {
                let grid = QuantisationGrid::over(&bounds, bits);
                apart(mesh, |corners| grow(corners.map(|p| grid.snap(p)), grid.diagonal()))
            }
        }
    }
}

fn each(mesh: &Mesh, place: impl Fn(Vec3) -> Vec3) -> Mesh {
    Mesh { positions: mesh.positions.iter().map(|p| place(*p)).collect(), triangles: mesh.triangles.clone() }
}

/// Every triangle with corners of its own.
fn apart(mesh: &Mesh, place: impl Fn(Corners) -> Corners) -> Mesh {
    let positions = (0..mesh.triangles.len()).flat_map(|i| place(mesh.corners(i))).collect();
    let triangles = (0..mesh.triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    Mesh { positions, triangles }
}

fn blocks(mesh: &Mesh, bits: u32) -> Mesh {
    let bounds = mesh.bounds();
    let grid = QuantisationGrid::over(&bounds, morton::BITS);
    let key = |i: usize| {
        let [a, b, c] = mesh.corners(i).map(|p| p.as_dvec3());
        let [x, y, z] = grid.index(((a + b + c) / 3.0).as_vec3()).map(|i| morton::spread(i as u32));
        morton::keyed(x << 2 | y << 1 | z, i as u32)
    };
    let keys = (0..mesh.triangles.len()).map(key).collect();
    let order = accel::keys::sort("rounding", keys).expect("memory for the keys of a mesh twice");
    let mut positions = vec![Vec3::ZERO; 3 * mesh.triangles.len()];
    for block in order.chunks(BLOCK) {
        let numbers = block.iter().map(|key| *key as u32 as usize);
        let grid =
            QuantisationGrid::over(&Aabb::of_points(numbers.clone().flat_map(|i| mesh.corners(i))), bits);
        for i in numbers {
            positions[3 * i..3 * i + 3].copy_from_slice(&mesh.corners(i).map(|p| grid.snap(p)));
        }
    }
    let triangles = (0..mesh.triangles.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    Mesh { positions, triangles }
}

/// Evenly spaced places on each axis.
struct QuantisationGrid {
    low: [f64; 3],
    step: [f64; 3],
    last: f64,
}

impl QuantisationGrid {
    fn over(bounds: &Aabb, bits: u32) -> Self {
        let last = f64::from((1u32 << bits) - 1);
        let (low, high) = (bounds.min.as_dvec3(), bounds.max.as_dvec3());
        Self { low: low.to_array(), step: ((high - low) / last).to_array(), last }
    }

    fn index(&self, p: Vec3) -> [f64; 3] {
        [0, 1, 2].map(|axis| {
            let (low, step) = (self.low[axis], self.step[axis]);
            if step > 0.0 { ((f64::from(p[axis]) - low) / step).round().clamp(0.0, self.last) } else { 0.0 }
        })
    }

    fn snap(&self, p: Vec3) -> Vec3 {
        let index = self.index(p);
        Vec3::from_array([0, 1, 2].map(|axis| (self.low[axis] + self.step[axis] * index[axis]) as f32))
    }

    /// Half the diagonal of a cell: no point moves farther.
    fn diagonal(&self) -> f64 {
        0.5 * self.step.iter().map(|step| step * step).sum::<f64>().sqrt()
    }
}

/// Moves the edges outwards by `by` in the triangle's plane: stretched about the centre of its incircle.
fn grow(corners: Corners, by: f64) -> Corners {
    let [a, b, c] = corners.map(|p| p.as_dvec3());
    let (x, y, z) = ((b - c).length(), (c - a).length(), (a - b).length());
    let around = x + y + z;
    let radius = (b - a).cross(c - a).length() / around;
    if radius.is_nan() || radius <= 0.0 {
        return corners;
    }
    let centre = (a * x + b * y + c * z) / around;
    corners.map(|p| {
        let out = p.as_dvec3() - centre;
        let far = (out * (by / radius)).clamp_length_max(MAX_GROWN * by);
        (p.as_dvec3() + far).as_vec3()
    })
}

/// The nearest number with a half float's eleven digits and exponents from 2^-14 on, below which all are spaced alike (IEEE 754).
fn half_float(x: f64) -> f64 {
    if x == 0.0 {
        return x;
    }
    let exponent = x.abs().log2().floor().max(-14.0);
    let spacing = (exponent - 10.0).exp2();
    (x / spacing).round_ties_even() * spacing
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mesh() -> Mesh {
        let scene = scenes::load(&"bumps-1k".parse().unwrap()).unwrap();
        let accel::Geometry::Triangles(mesh) = scene.geometry else { unreachable!() };
        mesh
    }

    #[test]
    fn no_corner_moves_farther_than_its_bits_allow() {
        let mesh = mesh();
        let extent = f64::from(mesh.bounds().extent().max_element());
        for rounding in Rounding::all() {
            let rounded = rounding.apply(&mesh);
            assert_eq!(rounded.triangles.len(), mesh.triangles.len());
            let moved = (0..mesh.triangles.len())
                .flat_map(|i| mesh.corners(i).into_iter().zip(rounded.corners(i)))
                .map(|(a, b)| f64::from((a - b).length()))
                .fold(0.0, f64::max);
            let step = match rounding {
                Rounding::Half => extent / 2048.0,
                _ => extent * 2f64.powi(-(rounding.bits() as i32)),
            };
            let most = if matches!(rounding, Rounding::Grown(_)) { (1.0 + MAX_GROWN) * step } else { step };
            assert!(moved <= most + extent * 1e-6 && moved > 0.0, "{rounding:?}: {moved}");
        }
    }

    #[test]
    fn grown_triangles_hold_the_true_ones_seen_from_the_front() {
        let corners = [Vec3::ZERO, Vec3::X * 4.0, Vec3::Y * 3.0];
        let grown = grow(corners, 0.5);
        assert!(grown[0].x <= -0.5 && grown[0].y <= -0.5 && grown.iter().all(|p| p.z == 0.0));
        assert_eq!(grow([Vec3::ONE; 3], 0.5), [Vec3::ONE; 3]);
    }

    #[test]
    fn half_floats_are_those_of_the_standard() {
        for (x, half) in [
            (1.0, 1.0),
            (1.0 / 3.0, 0.333_251_953_125),
            (-0.1, -0.099_975_585_937_5),
            (1e-8, 0.0),
            (6e-8, 5.960_464_477_539_063e-8),
        ] {
            assert_eq!(half_float(x), half);
        }
    }
}
