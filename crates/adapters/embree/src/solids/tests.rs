use super::SolidKinds;
use crate::{EmbreeBuilder, Variant};
use accel::testing::{KINDS, rays, solids};
use accel::{Accel, Builder, Hit, RaySet, Scene, Workload};
use baselines::Brute;
use primitives::KernelId;

fn traced(structure: &dyn Accel, rays: &RaySet) -> (Vec<Option<Hit>>, Vec<bool>) {
    let (mut hits, mut occluded) = (vec![None; rays.len()], vec![false; rays.len()]);
    structure.trace(rays, &mut hits);
    structure.trace_occluded(rays, &mut occluded);
    (hits, occluded)
}

/// How many of the rays are answered otherwise than by brute force: t by more than a ten-thousandth, or another object at another t.
fn differences(scene: &Scene, variant: Variant, kinds: SolidKinds) -> (usize, usize) {
    let rays = RaySet::List(rays(3, 3000));
    let builder = EmbreeBuilder { solids: kinds, ..EmbreeBuilder::new(variant) };
    let embree = builder.build(scene, &Workload::GENERAL).unwrap();
    let brute = Brute::new(KernelId::MollerTrumbore).build(scene, &Workload::GENERAL).unwrap();
    let ((found, shadows), (expected, shadowed)) = (traced(&*embree, &rays), traced(&*brute, &rays));
    let close = |a: &Option<Hit>, b: &Option<Hit>| match (a, b) {
        (Some(a), Some(b)) => (a.t - b.t).abs() <= 1e-4 * b.t.abs().max(1e-2),
        (a, b) => a.is_none() && b.is_none(),
    };
    let hits = found.iter().zip(&expected).filter(|(a, b)| !close(a, b)).count();
    let any = shadows.iter().zip(&shadowed).filter(|(a, b)| a != b).count();
    assert!(expected.iter().flatten().count() > 300);
    (hits, any)
}

#[test]
fn user_geometry_finds_what_brute_force_does() {
    for kinds in [&["sphere"][..], &["cone"], &KINDS] {
        let scene = solids(51, kinds, 300, 0.15);
        for variant in [Variant::Plain, Variant::Packet] {
            let (hits, any) = differences(&scene, variant, SolidKinds::User);
            // Embree's own boxes are tested in another precision.
            assert!(hits <= 3 && any <= 3, "{kinds:?} {variant:?}: {hits} and {any}");
        }
    }
}

/// Embree's own spheres and discs are those of the scene but for rounding.
#[test]
fn native_geometry_is_the_same_but_for_rounding() {
    for kinds in [&["sphere"][..], &["disc"], &["triangle", "torus", "sphere"]] {
        let scene = solids(53, kinds, 300, 0.15);
        for variant in [Variant::Plain, Variant::Packet] {
            let (hits, any) = differences(&scene, variant, SolidKinds::Native);
            assert!(hits <= 15 && any <= 15, "{kinds:?} {variant:?}: {hits} and {any}");
        }
    }
}
