use super::*;
use accel::solid::{Combination, Cone, Csg, Expression, Facets, Implicit, Patch, Shape, Sphere, Torus};
use accel::{Aabb, Ray};
use solids::Crossings;
use std::sync::Arc;

fn ball() -> Solid {
    Solid::Sphere(Sphere { center: Vec3::new(0.1, 0.2, 0.3), radius: 1.0 })
}

fn gyroid() -> Solid {
    let function = Expression::parse("sin(4*x)*cos(4*y) + sin(4*y)*cos(4*z) + sin(4*z)*cos(4*x)").unwrap();
    Solid::Implicit(Implicit::new(Arc::new(function), Aabb { min: Vec3::NEG_ONE, max: Vec3::ONE }))
}

fn part() -> Solid {
    let plate = Solid::Box(Aabb { min: Vec3::new(-1.0, -1.0, -0.2), max: Vec3::new(1.0, 1.0, 0.2) });
    let bore = Cone { base: Vec3::Z * -1.0, base_radius: 0.5, top: Vec3::Z, top_radius: 0.5 };
    Solid::Csg(Csg::new(Combination::Difference, plate, Solid::Cone(bore)))
}

#[test]
fn closed_solids_become_closed_meshes() {
    let cone = Cone { base: Vec3::ZERO, base_radius: 1.0, top: Vec3::new(0.3, 0.2, 2.0), top_radius: 0.5 };
    let tip = Cone { top_radius: 0.0, ..cone };
    let torus = Torus { center: Vec3::ZERO, axis: Vec3::new(1.0, 2.0, 3.0), major: 1.0, minor: 0.3 };
    let block = Aabb { min: Vec3::ZERO, max: Vec3::ONE };
    for solid in [
        ball(),
        Solid::Cone(cone),
        Solid::Cone(tip),
        Solid::Torus(torus),
        Solid::Box(block),
        gyroid(),
        part(),
    ] {
        for level in [0, 1, 2] {
            let Tessellation { mesh, owner } = tessellate(std::slice::from_ref(&solid), level);
            assert_eq!(owner.len(), mesh.triangles.len());
            assert_eq!(Facets::new(Arc::new(mesh)).validate(), Ok(()), "{} at level {level}", solid.kind());
        }
    }
}

#[test]
fn corners_lie_on_the_surface_and_normals_point_outward() {
    for solid in [ball(), gyroid(), part()] {
        let Tessellation { mesh, .. } = tessellate(std::slice::from_ref(&solid), 2);
        let mut outward = 0;
        for i in 0..mesh.triangles.len() {
            let corners = mesh.corners(i);
            let center = (corners[0] + corners[1] + corners[2]) / 3.0;
            let (Some(facet), Some(normal)) =
                (corners.normal(center.as_dvec3()), solid.normal(center.as_dvec3()))
            else {
                continue;
            };
            outward += usize::from(facet.dot(normal) > 0.0);
            // Along some axis through a corner, the surface is crossed there.
            let crossed = |axis: Vec3| {
                let mut found = Vec::new();
                solid.crossings(&Ray::new(corners[0] - axis * 0.25, axis * 0.25), &mut found);
                found.iter().any(|crossing| (crossing.t - 1.0).abs() < 1e-4)
            };
            assert!(Vec3::AXES.into_iter().any(crossed), "{} at {}", solid.kind(), corners[0]);
        }
        assert!(outward * 100 > mesh.triangles.len() * 97, "{} of {}", outward, mesh.triangles.len());
    }
}

#[test]
fn owners_are_named_and_points_are_no_triangles() {
    let fan: [[Vec3; 4]; 4] = [
        [Vec3::ZERO; 4],
        [0.0, 1.0, 2.0, 3.0].map(|y| Vec3::new(1.0, y, 0.0)),
        [0.0, 1.0, 2.0, 3.0].map(|y| Vec3::new(2.0, y, 1.0)),
        [0.0, 1.0, 2.0, 3.0].map(|y| Vec3::new(3.0, y, 0.0)),
    ];
    let solids = [ball(), Solid::Patch(Patch::new(fan)), ball()];
    let Tessellation { mesh, owner } = tessellate(&solids, 2);
    assert!(owner.is_sorted() && owner.contains(&1) && owner.last() == Some(&2));
    // 6 × 6 cells of two triangles, less one for each cell of the row that is drawn together.
    assert_eq!(owner.iter().filter(|owner| **owner == 1).count(), 72 - 6);
    assert!((0..mesh.triangles.len()).all(|i| {
        let [a, b, c] = mesh.corners(i);
        a != b && b != c && c != a
    }));
}
