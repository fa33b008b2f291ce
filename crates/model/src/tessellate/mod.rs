//! Triangles in the place of solids.

mod march;
mod sheet;

use accel::{Mesh, Solid, Vec3};
use glam::DVec3;

/// Triangles, and the solid that each stands for.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tessellation {
    /// The triangles.
    pub mesh: Mesh,
    /// The solid of each triangle, by number.
    pub owner: Vec<u32>,
}

impl Tessellation {
    /// Appends triangles that stand for a solid, without those that are drawn together to less than one.
    fn append(&mut self, owner: u32, points: &[Vec3], triangles: impl IntoIterator<Item = [u32; 3]>) {
        let first = self.mesh.positions.len() as u32;
        self.mesh.positions.extend(points);
        for triangle in triangles {
            let [a, b, c] = triangle.map(|corner| points[corner as usize]);
            if a != b && b != c && c != a {
                self.mesh.triangles.push(triangle.map(|corner| first + corner));
                self.owner.push(owner);
            }
        }
    }
}

/// Edges around a sphere, a cone or a ring at a level, and cells along the longest side of what is marched through.
pub const fn segments(level: u32) -> u32 {
    6 << level
}

/// All solids at a level: each twice as fine as at the level before, and so with four times the triangles.
///
/// Spheres, cones, discs, rings and patches are cut along their parameters; what is given by functions or as a set of solids is
/// marched through in tetrahedra, with corners where its surface meets their edges. All corners lie on the surface.
pub fn tessellate(solids: &[Solid], level: u32) -> Tessellation {
    let mut all = Tessellation::default();
    let n = segments(level);
    for (owner, solid) in (0..).zip(solids) {
        append(&mut all, owner, solid, n);
    }
    all
}

/// Appends a solid with `n` edges around.
fn append(all: &mut Tessellation, owner: u32, solid: &Solid, n: u32) {
    match solid {
        Solid::Triangle(corners) => all.append(owner, corners, [[0, 1, 2]]),
        Solid::Box(bounds) => sheet::block(all, owner, bounds),
        Solid::Sphere(sphere) => sheet::ball(all, owner, sphere, n),
        Solid::Cone(cone) => sheet::cone(all, owner, cone, n),
        Solid::Disc(disc) => {
            sheet::disc(
                all,
                owner,
                disc.center.as_dvec3(),
                disc.normal.as_dvec3(),
                f64::from(disc.radius),
                n,
            );
        }
        Solid::Torus(torus) => sheet::ring(all, owner, torus, n),
        // A patch is about a quarter of what goes around.
        Solid::Patch(patch) => sheet::patch(all, owner, patch, (n / 4).max(1)),
        Solid::Facets(facets) => {
            let mesh = facets.mesh();
            all.append(owner, &mesh.positions, mesh.triangles.iter().copied());
        }
        Solid::Group(group) => group.parts().iter().for_each(|part| append(all, owner, part, n)),
        Solid::Quadric(_) | Solid::Implicit(_) | Solid::Csg(_) => march::solid(all, owner, solid, n),
    }
}

/// Rounds to single precision and turns −0 into 0.
fn round(p: DVec3) -> Vec3 {
    p.as_vec3() + Vec3::ZERO
}

#[cfg(test)]
mod tests;
