use super::*;
use crate::WrapperBuilder;
use accel::testing::{Numbers, scene};
use accel::{Aabb, Mesh, Projection, Vec3};
use baselines::Brute;
use primitives::KernelId;

fn small_triangles(count: u32) -> Scene {
    let mut numbers = Numbers(1);
    let mut mesh = Mesh::default();
    for i in 0..count {
        let base = numbers.vec3();
        for _ in 0..3 {
            mesh.positions.push(base + numbers.vec3() * 0.1);
        }
        mesh.triangles.push([3 * i, 3 * i + 1, 3 * i + 2]);
    }
    scene(Geometry::Triangles(mesh))
}

fn raster(rows: u32, cols: u32) -> Raster {
    Raster {
        projection: Projection::Parallel,
        rows,
        cols,
        origin: Vec3::new(-0.05, -0.05, 2.0),
        forward: Vec3::new(0.01, 0.02, -1.0),
        right: Vec3::X * (1.2 / cols as f32),
        down: Vec3::Y * (1.2 / rows as f32),
    }
}

fn list(count: usize) -> RaySet {
    let mut numbers = Numbers(2);
    let ray = |_| Ray::new(numbers.vec3(), numbers.vec3() - Vec3::splat(0.5));
    RaySet::List((0..count).map(ray).collect())
}

fn hits_of(builder: &dyn Builder, scene: &Scene, rays: &RaySet) -> (Vec<Option<Hit>>, Vec<bool>) {
    let built = builder.build(scene, &Workload::of(rays)).unwrap();
    let (mut hits, mut occluded) = (vec![None; rays.len()], vec![false; rays.len()]);
    built.trace(rays, &mut hits);
    built.trace_occluded(rays, &mut occluded);
    (hits, occluded)
}

/// Embree brings its own kernel, so a few rays near edges may differ from brute force.
fn nearly_all_as_brute_force(builder: &dyn Builder, scene: &Scene, rays: &RaySet) {
    let (wanted, _) = hits_of(&Brute::new(KernelId::MollerTrumbore), scene, rays);
    let (hits, occluded) = hits_of(builder, scene, rays);
    let hit_count = wanted.iter().flatten().count();
    assert!(hit_count > rays.len() / 20, "{hit_count} of {} rays hit", rays.len());
    let mut differences = 0;
    for ((hit, occluded), wanted) in hits.iter().zip(&occluded).zip(&wanted) {
        assert_eq!(*occluded, hit.is_some(), "{}", builder.id());
        match (hit, wanted) {
            (Some(hit), Some(wanted)) if hit.object == wanted.object => {
                assert!((hit.t - wanted.t).abs() <= 1e-4 * wanted.t.abs().max(1.0), "{hit:?} {wanted:?}");
                assert!((hit.u - wanted.u).abs() < 1e-2 && (hit.v - wanted.v).abs() < 1e-2);
            }
            (None, None) => {}
            _ => differences += 1,
        }
    }
    assert!(
        differences * 1000 <= rays.len(),
        "{differences} differences by {} {}",
        builder.id(),
        builder.settings()
    );
}

#[test]
fn all_variants_agree_with_brute_force_on_rasters_of_odd_sizes() {
    let scene = small_triangles(500);
    for (rows, cols) in [(64, 64), (33, 61), (1, 50), (50, 1), (3, 2)] {
        let rays = RaySet::Raster(raster(rows, cols));
        for variant in Variant::ALL {
            for denormals in [Denormals::Keep, Denormals::Flush] {
                let builder = EmbreeBuilder { denormals, ..EmbreeBuilder::new(variant) };
                if rows * cols > 1000 {
                    nearly_all_as_brute_force(&builder, &scene, &rays);
                } else {
                    assert_eq!(hits_of(&builder, &scene, &rays).0.len(), rays.len());
                }
            }
        }
    }
}

#[test]
fn packets_put_every_hit_in_its_place() {
    let scene = small_triangles(500);
    let rays = RaySet::Raster(raster(37, 53));
    let (single, _) = hits_of(&EmbreeBuilder::new(Variant::Plain), &scene, &rays);
    let (packets, _) = hits_of(&EmbreeBuilder::new(Variant::Packet), &scene, &rays);
    let objects = |hits: &[Option<Hit>]| hits.iter().map(|h| h.map(|h| h.object)).collect::<Vec<_>>();
    let (single, packets) = (objects(&single), objects(&packets));
    let differences = single.iter().zip(&packets).filter(|(a, b)| a != b).count();
    assert!(differences <= 2, "{differences} differences");
}

#[test]
fn all_variants_agree_with_brute_force_on_lists() {
    let scene = small_triangles(500);
    let rays = list(3001);
    for variant in Variant::ALL {
        for quality in [Quality::Low, Quality::Medium, Quality::High] {
            let builder = EmbreeBuilder { quality, ..EmbreeBuilder::new(variant) };
            nearly_all_as_brute_force(&builder, &scene, &rays);
        }
        let flush = EmbreeBuilder { denormals: Denormals::Flush, ..EmbreeBuilder::new(variant) };
        nearly_all_as_brute_force(&flush, &scene, &rays);
        let narrow = EmbreeBuilder { isa: Some(Isa::Sse2), ..EmbreeBuilder::new(variant) };
        nearly_all_as_brute_force(&narrow, &scene, &rays);
    }
    nearly_all_as_brute_force(&WrapperBuilder, &scene, &rays);
}

/// Single rays and packets round differently where Embree's tests do, so near edges a few may differ.
#[test]
fn packets_answer_lists_of_any_length_as_single_rays_do() {
    let scene = small_triangles(500);
    for count in [0, 1, 15, 16, 17, 4095, 4097, 9000] {
        let rays = list(count);
        let (single, _) = hits_of(&EmbreeBuilder::new(Variant::Plain), &scene, &rays);
        for coherent in PacketFlag::ALL {
            let builder = EmbreeBuilder { coherent, ..EmbreeBuilder::new(Variant::Packet) };
            let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build().unwrap();
            let (one, _) = hits_of(&builder, &scene, &rays);
            let (two, _) = pool.install(|| hits_of(&builder, &scene, &rays));
            assert_eq!(one, two, "{count} {coherent:?}");
            let same = |(a, b): &(&Option<Hit>, &Option<Hit>)| match (a, b) {
                (Some(a), Some(b)) => a.object == b.object && (a.t - b.t).abs() <= 1e-5 * a.t.max(1.0),
                (a, b) => a.is_none() && b.is_none(),
            };
            let differences = single.iter().zip(&one).filter(|pair| !same(pair)).count();
            assert!(differences <= count / 1000, "{differences} of {count} differ, {coherent:?}");
        }
    }
}

#[test]
fn coherence_changes_no_answer() {
    let scene = small_triangles(500);
    let pictures = RaySet::Raster(raster(37, 53));
    for rays in [list(3001), pictures] {
        let answers = PacketFlag::ALL.map(|coherent| {
            hits_of(&EmbreeBuilder { coherent, ..EmbreeBuilder::new(Variant::Packet) }, &scene, &rays)
        });
        assert_eq!(answers[0], answers[1]);
        assert_eq!(answers[0], answers[2]);
    }
    assert_eq!(PacketFlag::Rasters.of(&list(1)), Coherence::Incoherent);
    assert_eq!(PacketFlag::Rasters.of(&RaySet::Raster(raster(1, 1))), Coherence::Coherent);
    assert!(PacketFlag::ALL.into_iter().all(|flag| PacketFlag::from_id(flag.id()) == Some(flag)));
}

/// The same scene by the same library: what differs is the path to it.
#[test]
fn the_wrapper_answers_as_single_rays_do() {
    let scene = small_triangles(500);
    for rays in [list(3001), RaySet::Raster(raster(37, 53))] {
        let plain = hits_of(&EmbreeBuilder::new(Variant::Plain), &scene, &rays);
        assert_eq!(hits_of(&WrapperBuilder, &scene, &rays), plain);
    }
}

#[test]
fn the_wrapper_refuses_what_would_be_read_out_of_bounds() {
    let mut scene = small_triangles(2);
    let Geometry::Triangles(mesh) = &mut scene.geometry else { unreachable!("triangles") };
    mesh.triangles.push([0, 1, 6]);
    let error = WrapperBuilder.build(&scene, &Workload::GENERAL).err().unwrap().to_string();
    assert!(error.contains("triangle 2 names position 6 of 6"), "{error}");
}

#[test]
fn the_wrapper_s_footprint_is_a_twin_s_and_its_copies() {
    let scene = small_triangles(2000);
    let plain = EmbreeBuilder::new(Variant::Plain).build(&scene, &Workload::GENERAL).unwrap().footprint();
    let wrapped = WrapperBuilder.build(&scene, &Workload::GENERAL).unwrap();
    let structure = |footprint: &Footprint| footprint.bytes(accel::Group::Structure);
    assert_eq!(structure(&wrapped.footprint()), structure(&plain));
    assert_eq!(wrapped.footprint().bytes(accel::Group::GeometryCopy), 2000 * (3 * 12 + 12));
    assert!(wrapped.plan().starts_with("Embree 4."), "{}", wrapped.plan());
}

#[test]
fn what_embree_does_not_serve_is_refused_with_a_reason() {
    let boxes = scene(Geometry::Boxes(vec![Aabb { min: Vec3::ZERO, max: Vec3::ONE }]));
    let error = EmbreeBuilder::new(Variant::Plain).build(&boxes, &Workload::GENERAL).err();
    assert_eq!(error.unwrap().to_string(), "embree does not serve boxes: Embree has triangles");
    let error = WrapperBuilder.build(&boxes, &Workload::GENERAL).err();
    assert_eq!(error.unwrap().to_string(), "embree-rs does not serve boxes: Embree has triangles");
}

#[test]
fn the_footprint_is_the_monitor_s_and_the_plan_names_the_version() {
    let scene = small_triangles(2000);
    let builder = EmbreeBuilder::new(Variant::Plain);
    assert_eq!((builder.id(), builder.settings().as_str()), ("embree", "quality=medium denormals=keep"));
    let narrow = EmbreeBuilder { isa: Some(Isa::Avx2), ..EmbreeBuilder::new(Variant::Packet) };
    assert_eq!(narrow.settings(), "quality=medium denormals=keep isa=avx2 coherent=rasters");
    let built = builder.build(&scene, &Workload::GENERAL).unwrap();
    let bytes = built.footprint().total();
    assert!(bytes > 2000 * 20 && bytes < 2000 * 400, "{bytes}");
    assert!(built.plan().starts_with("Embree 4."), "{}", built.plan());
}
