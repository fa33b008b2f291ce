//! Brute force with the exact kernel against the oracle.
#![cfg(feature = "exact")]

#[path = "../../primitives/src/kernel/exact/strategies.rs"]
mod strategies;

use accel::{Builder, Corners, Geometry, Mesh, Ray, RaySet, Scene, Vec3, View, Workload};
use baselines::Brute;
use lanes::ROW;
use oracle::{Oracle, Verdict, classify};
use primitives::KernelId;
use proptest::prelude::*;
use strategies::{aim, corners, lattice, vector, weights};

fn scene(list: &[Corners]) -> Scene {
    let mesh = Mesh {
        positions: list.iter().flatten().copied().collect(),
        triangles: (0..list.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
    };
    let view = View { eye: Vec3::Z, target: Vec3::ZERO, up: Vec3::Y, fov_y_degrees: 45.0 };
    Scene { id: "list".into(), geometry: Geometry::Triangles(mesh), view }
}

/// Brute force with the exact kernel against the oracle: objects and t.
fn compare(list: &[Corners], rays: Vec<Ray>) -> Result<u32, TestCaseError> {
    let scene = scene(list);
    let oracle = Oracle::new(list.iter().copied());
    let brute =
        Brute::new(KernelId::Exact).build(&scene, &Workload::GENERAL).expect("brute force takes any scene");
    let rays = RaySet::List(rays);
    let mut hits = vec![None; rays.len()];
    brute.trace(&rays, &mut hits);
    let mut agreed = 0;
    for (i, hit) in hits.iter().enumerate() {
        let ray = rays.ray(i);
        let exact = oracle.closest(&ray);
        let judgement = classify(*hit, exact.as_ref());
        prop_assert_eq!(judgement.verdict, Verdict::Agree, "{:?}: {:?} but {:?}", ray, hit, exact);
        prop_assert_eq!(hit.map(|h| h.t), exact.map(|(_, h)| h.t.to_f32()));
        agreed += u32::from(hit.is_some());
    }
    Ok(agreed)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn the_nearest_object_is_the_oracles(list in prop::collection::vec(corners(lattice()), 1..30), rays in prop::collection::vec((vector(lattice()), vector(lattice())), ROW)) {
        let rays = rays.into_iter().filter(|(_, d)| *d != Vec3::ZERO).map(|(o, d)| Ray::new(o, d)).collect();
        compare(&list, rays)?;
    }

    /// Copies of a triangle, moved by nothing or by less than t can tell.
    #[test]
    fn nearly_equal_t_are_ordered_as_by_the_oracle(tri in corners(1f32..2.0), moves in prop::collection::vec((0u32..3, 0usize..3), 2..20), o in vector(-9f32..9.0), w in prop::collection::vec(weights(), ROW)) {
        let list: Vec<Corners> = moves.iter().map(|(by, corner)| {
            let mut moved = tri;
            moved[*corner].z = f32::from_bits(moved[*corner].z.to_bits() + by);
            moved
        }).collect();
        let rays = w.into_iter().map(|w| Ray::new(o, aim(&tri, w) - o)).collect();
        compare(&list, rays)?;
    }
}

/// A closed, bumpy ball far from the origin, seen from its inside at faces, edges and corners.
#[test]
fn no_ray_leaves_a_closed_mesh() {
    let (rows, cols) = (12, 24);
    let center = Vec3::new(148_376.0, 1_234.0, -223_423.0);
    let at = |i: usize, j: usize| {
        let (theta, phi) = (
            i as f32 / rows as f32 * std::f32::consts::PI,
            (j % cols) as f32 / cols as f32 * std::f32::consts::TAU,
        );
        let radius = 2.0 + 0.1 * (3.0 * phi).sin() * theta.sin();
        let (ring, height) = if i == 0 {
            (0.0, 1.0)
        } else if i == rows {
            (0.0, -1.0)
        } else {
            (theta.sin(), theta.cos())
        };
        center + Vec3::new(ring * phi.cos(), ring * phi.sin(), height) * radius
    };
    let pole = |i: usize| if i == 0 { at(0, 0) } else { at(rows, 0) };
    let corner = |i: usize, j: usize| if i == 0 || i == rows { pole(i) } else { at(i, j) };
    let mut list = Vec::new();
    for i in 0..rows {
        for j in 0..cols {
            let [a, b, c, d] = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
            list.push([a, b, c]);
            list.push([a, c, d]);
        }
    }
    let mut seed = 1u32;
    let mut random = move || {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (seed >> 8) as f32 / (1 << 24) as f32
    };
    let rays: Vec<Ray> = (0..6000)
        .map(|i| {
            let tri = list[(random() * list.len() as f32) as usize];
            let k = random();
            let weights = [[1.0, 0.0, 0.0], [k, 1.0 - k, 0.0], [k, random(), 1.0]][i % 3];
            let origin = center + Vec3::new(random(), random(), random()) * 1.6 - Vec3::splat(0.8);
            Ray::new(origin, aim(&tri, weights) - origin)
        })
        .collect();
    let count = rays.len() as u32;
    assert_eq!(compare(&list, rays).expect("as the oracle"), count);
}
