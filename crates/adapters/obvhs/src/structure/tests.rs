use super::*;
use accel::testing::{Numbers, scene};
use accel::{Aabb, Mesh, RaySet, Vec3};
use baselines::Brute;
use primitives::KernelId;

fn triangles(count: u32, size: f32) -> Scene {
    let mut numbers = Numbers(1);
    let mut mesh = Mesh::default();
    for i in 0..count {
        let base = numbers.vec3();
        for _ in 0..3 {
            mesh.positions.push(base + numbers.vec3() * size);
        }
        mesh.triangles.push([3 * i, 3 * i + 1, 3 * i + 2]);
    }
    scene(Geometry::Triangles(mesh))
}

fn boxes(count: usize) -> Scene {
    let mut numbers = Numbers(3);
    let mut one = |_| {
        let min = numbers.vec3();
        Aabb { min, max: min + numbers.vec3() * 0.1 }
    };
    scene(Geometry::Boxes((0..count).map(&mut one).collect()))
}

fn rays(count: usize) -> RaySet {
    let mut numbers = Numbers(2);
    let ray = |_| Ray::new(numbers.vec3(), numbers.vec3() - Vec3::splat(0.5));
    RaySet::List((0..count).map(ray).collect())
}

fn all_builders() -> impl Iterator<Item = ObvhsBuilder> {
    Variant::ALL
        .into_iter()
        .flat_map(|variant| Preset::ALL.map(|preset| ObvhsBuilder { preset, ..ObvhsBuilder::new(variant) }))
}

fn hits_of(builder: &dyn Builder, scene: &Scene, rays: &RaySet) -> (Vec<Option<Hit>>, Vec<bool>) {
    let built = builder.build(scene, &Workload::GENERAL).unwrap();
    let (mut hits, mut occluded) = (vec![None; rays.len()], vec![false; rays.len()]);
    built.trace(rays, &mut hits);
    built.trace_occluded(rays, &mut occluded);
    (hits, occluded)
}

/// obvhs brings its own kernel, so a few rays near edges may differ from brute force.
fn nearly_all_as_brute_force(scene: &Scene, rays: &RaySet) {
    let (wanted, _) = hits_of(&Brute::new(KernelId::MollerTrumbore), scene, rays);
    let hit_count = wanted.iter().flatten().count();
    assert!(hit_count > rays.len() / 20, "{hit_count} of {} rays hit", rays.len());
    for builder in all_builders() {
        let (hits, occluded) = hits_of(&builder, scene, rays);
        let mut differences = 0;
        for ((hit, occluded), wanted) in hits.iter().zip(&occluded).zip(&wanted) {
            assert_eq!(*occluded, hit.is_some(), "{builder:?}");
            match (hit, wanted) {
                (Some(hit), Some(wanted)) if hit.object == wanted.object => {
                    let close = (hit.t - wanted.t).abs() <= 1e-4 * wanted.t.abs().max(1.0);
                    assert!(close, "{hit:?} {wanted:?} {builder:?}");
                    assert!((hit.u - wanted.u).abs() < 1e-2 && (hit.v - wanted.v).abs() < 1e-2);
                }
                (None, None) => {}
                _ => differences += 1,
            }
        }
        assert!(differences * 1000 <= rays.len(), "{differences} differences by {builder:?}");
    }
}

#[test]
fn all_trees_agree_with_brute_force_on_small_and_large_triangles() {
    nearly_all_as_brute_force(&triangles(600, 0.1), &rays(3000));
    nearly_all_as_brute_force(&triangles(200, 1.0), &rays(3000));
}

#[test]
fn all_trees_agree_with_brute_force_on_boxes() {
    nearly_all_as_brute_force(&boxes(500), &rays(3000));
}

#[test]
fn scenes_of_none_one_and_equal_triangles_are_built() {
    let ray = Ray::new(Vec3::new(0.2, 0.2, 1.0), Vec3::new(0.01, 0.02, -1.0));
    let positions = vec![Vec3::ZERO, Vec3::new(1.0, 0.0, 0.3), Vec3::Y];
    for builder in all_builders() {
        for count in [0, 1, 2, 100] {
            let mesh = Mesh { positions: positions.clone(), triangles: vec![[0, 1, 2]; count] };
            let scene = scene(Geometry::Triangles(mesh));
            let built = builder.build(&scene, &Workload::GENERAL).unwrap();
            assert_eq!(built.closest(&ray).is_some(), count > 0, "{builder:?} {count}");
            assert_eq!(built.occluded(&ray), count > 0);
            let short = Ray { t_max: 0.5, ..ray };
            assert_eq!(built.closest(&short), None);
            assert!(!built.occluded(&short));
        }
    }
}

/// Where surface areas overflow, upstream would panic, abort or never end.
#[test]
fn extents_whose_areas_overflow_are_refused_before_obvhs_sees_them() {
    for exponent in [0, 40, 70, 100, 120] {
        let mut scene = triangles(600, 1.0);
        let Geometry::Triangles(mesh) = &mut scene.geometry else { unreachable!("triangles") };
        mesh.positions.iter_mut().for_each(|position| *position *= 2_f32.powi(exponent));
        for builder in all_builders() {
            let built = builder.build(&scene, &Workload::GENERAL);
            assert_eq!(built.is_ok(), exponent <= 40, "{builder:?} 2^{exponent}");
            if let Err(error) = built {
                assert!(error.to_string().contains("out of obvhs' reach"), "{error}");
            }
        }
    }
}

#[test]
fn footprints_hold_nodes_indices_and_triangles() {
    let scene = triangles(1000, 0.05);
    for variant in Variant::ALL {
        let builder = ObvhsBuilder::new(variant);
        assert_eq!(builder.settings(), "build=medium");
        let footprint = builder.build(&scene, &Workload::GENERAL).unwrap().footprint();
        let bytes = |name| footprint.parts.iter().find(|part| part.name == name).map_or(0, |part| part.bytes);
        assert_eq!(bytes("objects"), 64_000, "{variant:?}");
        assert_eq!(bytes("indices"), 4_000, "{variant:?}");
        assert_eq!(bytes("nodes") % if variant == Variant::Bvh2 { 48 } else { 80 }, 0);
        assert!(bytes("nodes") > 5_000, "{variant:?}");
    }
}

/// Compressed triangles are others than the scene's, but not by much, and take 24 bytes.
#[test]
fn compressed_triangles_are_nearly_the_scene() {
    let (scene, rays) = (triangles(600, 0.1), rays(3000));
    for variant in Variant::ALL {
        let full = ObvhsBuilder::new(variant);
        let compressed = ObvhsBuilder { compressed: true, ..full };
        assert_eq!(compressed.settings(), "build=medium triangles=compressed");
        let [(wanted, _), (hits, occluded)] = [full, compressed].map(|b| hits_of(&b, &scene, &rays));
        assert!(hits.iter().zip(&occluded).all(|(hit, occluded)| hit.is_some() == *occluded));
        let object = |hit: &Option<Hit>| hit.map(|hit| hit.object);
        let others = hits.iter().zip(&wanted).filter(|(a, b)| object(a) != object(b)).count();
        assert!(others * 100 <= rays.len(), "{others} differ");
        assert!(hits.iter().zip(&wanted).any(|(a, b)| a != b), "something is lost");
        let footprint = compressed.build(&scene, &Workload::GENERAL).unwrap().footprint();
        assert!(footprint.parts.iter().any(|part| part.name == "objects" && part.bytes == 24 * 600));
    }
}

#[test]
fn presets_are_found_by_name() {
    for preset in Preset::ALL {
        assert_eq!(Preset::from_id(preset.id()), Some(preset));
    }
    assert_eq!(Preset::from_id("slow"), None);
}
