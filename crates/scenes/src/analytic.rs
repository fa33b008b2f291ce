//! The solids of procedural scenes as they are, without tessellation.

use crate::solid::{Solid, round};
use accel::solid::{Cone, Sphere};

/// Spheres, capped cones and cylinders, and the triangles of what is plane, in order.
pub fn analytic(solids: &[Solid]) -> Vec<accel::Solid> {
    let mut all = Vec::with_capacity(solids.len());
    for solid in solids {
        match solid {
            Solid::Sphere { center, radius } => {
                all.push(accel::Solid::Sphere(Sphere { center: round(*center), radius: *radius as f32 }));
            }
            Solid::Cone { base, base_radius, apex, apex_radius } => {
                all.push(accel::Solid::Cone(Cone {
                    base: round(*base),
                    base_radius: *base_radius as f32,
                    top: round(*apex),
                    top_radius: *apex_radius as f32,
                }));
            }
            Solid::Polygon { corners, triangles } => {
                let corner = |i: u32| round(corners[i as usize]);
                all.extend(triangles.iter().map(|t| accel::Solid::Triangle(t.map(corner))));
            }
        }
    }
    all
}
