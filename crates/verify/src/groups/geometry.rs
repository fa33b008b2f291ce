//! Geometry that nobody would draw.

use super::group::Group;
use super::subject::{Subject, Verdict};
use crate::cases::{self, CLOSE, Reach, Shape};
use accel::{Geometry, InputError, Mesh, MeshRef, Scene, Vec3};
use primitives::KernelId;
use scenes::Random;

/// A question about scenes of a shape.
macro_rules! shaped {
    ($name:literal, $about:literal, $shape:expr, $reach:expr) => {
        Group { name: $name, about: $about, ask: |s| shape(s, $shape, $reach) }
    };
}

pub(super) const GROUPS: &[Group] = &[
    Group { name: "geometry/empty", about: "no triangle", ask: empty },
    shaped!("geometry/overlapping", "the same triangles many times", Shape::Repeated, CLOSE),
    shaped!("geometry/lattice", "corners and edges that meet in few places", Shape::OnLattice, CLOSE),
    shaped!("geometry/flat", "all in one plane", Shape::Sheet, CLOSE),
    shaped!("geometry/needles", "triangles 100,000 times as long as wide", Shape::Needles, CLOSE),
    shaped!("geometry/sizes", "triangles of sizes from 1 to 2^-19", Shape::Mixed, CLOSE),
    shaped!(
        "geometry/garbage",
        "any bits for coordinates and indices: refused, or as brute force",
        Shape::AnyBits,
        CLOSE
    ),
    Group {
        name: "geometry/not-finite",
        about: "NaN and infinite coordinates are refused by name",
        ask: not_finite,
    },
    shaped!("geometry/small", "a scene 2^-100 across", Shape::Scattered, Reach { scale: -100, ..CLOSE }),
    shaped!("geometry/large", "a scene 2^100 across", Shape::Scattered, Reach { scale: 100, ..CLOSE }),
    shaped!(
        "geometry/offset",
        "a scene 2^20 times its size from the origin of coordinates",
        Shape::Scattered,
        Reach { offset: Some(20), ..CLOSE }
    ),
];

fn empty(subject: &Subject) -> Verdict {
    let scene = scene_of(Mesh::default());
    let rays = cases::rays(&mut Random::new(1), &scene, &CLOSE, 64);
    subject.hits_nothing(&scene, &rays)
}

pub(super) fn scene_of(mesh: Mesh) -> Scene {
    let mut scene =
        cases::scene_of(&mut Random::new(1), Shape::Sheet, &CLOSE, 0).expect("no triangle is sound");
    scene.geometry = Geometry::Triangles(mesh);
    scene
}

/// Twelve scenes of a shape and 256 rays in each; what is refused by name counts as one check.
fn shape(subject: &Subject, shape: Shape, reach: Reach) -> Verdict {
    let none = if subject.is_built_in() {
        Verdict::Passed { checks: 0 }
    } else {
        Verdict::Counted { checks: 0, wrong: 0 }
    };
    (1..=12).fold(none, |verdict, seed| {
        let mut numbers = Random::new(seed);
        let Ok(scene) = cases::scene_of(&mut numbers, shape, &reach, 150) else {
            return verdict;
        };
        let rays = cases::rays(&mut numbers, &scene, &reach, 256);
        let kernel = if seed % 2 == 0 { KernelId::Exact } else { KernelId::Watertight };
        verdict.and(subject.holds(&scene, &rays, kernel))
    })
}

/// What every structure builds from goes through this.
fn not_finite(_: &Subject) -> Verdict {
    let mut checks = 0;
    for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        for corner in 0..3 {
            for axis in 0..3 {
                let mut positions = [Vec3::ZERO, Vec3::X, Vec3::Y];
                positions[corner][axis] = value;
                match MeshRef::new(&positions, &[[0, 1, 2]]) {
                    Err(InputError::Position { position, .. }) if position == corner => checks += 1,
                    other => return Verdict::Wrong { what: format!("{positions:?}: {other:?}") },
                }
            }
        }
    }
    Verdict::Passed { checks }
}
