//! What the harness adds: `Accel::trace` of a structure against a bare loop around its library's own
//! call, on small-100k/parallel. Pairs take turns; printed is the median of the pairs' ratios.

use accel::{Geometry, Hit, Mesh, RaySet, Scene, Workload};
use benches::{on_one_thread, rays, scene};
use harness::{registry, stats};
use obvhs::cwbvh::builder::build_cwbvh_from_tris;
use obvhs::ray::RayHit;
use obvhs::rt_triangle::RtTriangle;
use obvhs::triangle::Triangle;
use obvhs::{BvhBuildParams, ray};
use scenes::rays::RaysId;
use std::hint::black_box;
use std::time::{Duration, Instant};

const PAIRS: usize = 15;
const SIZE: u32 = 256;

fn main() {
    // `cargo test` runs benches as tests, with this flag missing: one pair shows that they run.
    let pairs = if std::env::args().any(|argument| argument == "--bench") { PAIRS } else { 1 };
    let scene = scene(if pairs == 1 { "small-1k" } else { "small-100k" });
    let rays = rays(&scene, RaysId::Parallel, if pairs == 1 { 16 } else { SIZE });
    let Geometry::Triangles(mesh) = &scene.geometry else { unreachable!("triangles") };
    on_one_thread(|| {
        #[cfg(feature = "embree")]
        embree(&scene, mesh, &rays, pairs);
        obvhs(&scene, mesh, &rays, pairs);
    });
}

#[cfg(feature = "embree")]
fn embree(scene: &Scene, mesh: &Mesh, rays: &RaySet, pairs: usize) {
    use adapter_embree::{Device, EmbreeScene, SceneSettings};
    use embree4_sys::{RTC_INVALID_GEOMETRY_ID, RTCHit, RTCRay, RTCRayHit};
    let settings = SceneSettings::default();
    let device = Device::new(1).expect("a device");
    let bare = EmbreeScene::new(device, mesh, settings).expect("a scene of triangles");
    compare("embree", scene, rays, pairs, |hits| {
        for (i, out) in hits.iter_mut().enumerate() {
            let from = rays.ray(i);
            let (origin, direction) = (from.origin, from.direction);
            let ray = RTCRay {
                org_x: origin.x,
                org_y: origin.y,
                org_z: origin.z,
                tnear: from.t_min,
                dir_x: direction.x,
                dir_y: direction.y,
                dir_z: direction.z,
                tfar: from.t_max,
                ..RTCRay::default()
            };
            let mut rayhit = RTCRayHit { ray, hit: RTCHit::default() };
            bare.intersect1(&mut rayhit);
            let hit = rayhit.hit;
            let found = hit.geomID != RTC_INVALID_GEOMETRY_ID;
            *out = found.then_some(Hit { t: rayhit.ray.tfar, object: hit.primID, u: hit.u, v: hit.v });
        }
    });
}

fn obvhs(scene: &Scene, mesh: &Mesh, rays: &RaySet, pairs: usize) {
    let corners = |i| mesh.corners(i).map(Into::into);
    let triangles: Vec<Triangle> =
        (0..mesh.triangles.len()).map(corners).map(|[v0, v1, v2]| Triangle { v0, v1, v2 }).collect();
    let tree = build_cwbvh_from_tris(&triangles, BvhBuildParams::medium_build(), &mut Duration::default());
    let packed: Vec<RtTriangle> =
        tree.primitive_indices.iter().map(|i| RtTriangle::from(&triangles[*i as usize])).collect();
    compare("obvhs-cwbvh", scene, rays, pairs, |hits| {
        for (i, out) in hits.iter_mut().enumerate() {
            let from = rays.ray(i);
            let ray = ray::Ray::new(from.origin.into(), from.direction.into(), from.t_min, from.t_max);
            let mut hit = RayHit::none();
            let found = tree.ray_traverse(ray, &mut hit, |ray, slot| packed[slot].intersect(ray));
            *out = found.then(|| {
                let slot = hit.primitive_id as usize;
                let (u, v) = packed[slot].compute_barycentric(&ray).into();
                Hit { t: hit.t, object: tree.primitive_indices[slot], u, v }
            });
        }
    });
}

fn compare(id: &str, scene: &Scene, rays: &RaySet, pairs: usize, bare: impl Fn(&mut [Option<Hit>])) {
    let choice = registry::parse(id).expect("an entry");
    let accel = choice.builder.build(scene, &Workload::GENERAL).expect("triangles are served");
    let (mut ours, mut theirs) = (vec![None; rays.len()], vec![None; rays.len()]);
    let time = |work: &mut dyn FnMut()| {
        let start = Instant::now();
        work();
        start.elapsed().as_nanos() as f64
    };
    let harness = |ours: &mut Vec<Option<Hit>>| time(&mut || accel.trace(rays, black_box(ours)));
    let loops = |theirs: &mut Vec<Option<Hit>>| time(&mut || bare(black_box(theirs)));
    harness(&mut ours);
    loops(&mut theirs);
    assert_eq!(ours.iter().flatten().count(), theirs.iter().flatten().count(), "{id}: the same hits");
    let mut ratios = Vec::new();
    for pair in 0..pairs {
        let (a, b) = if pair % 2 == 0 {
            let a = harness(&mut ours);
            (a, loops(&mut theirs))
        } else {
            let b = loops(&mut theirs);
            (harness(&mut ours), b)
        };
        ratios.push(a / b);
        let per_ray = |ns: f64| ns / rays.len() as f64;
        println!("{id}: harness {:.1} ns/ray, bare loop {:.1} ns/ray", per_ray(a), per_ray(b));
    }
    let summary = stats::summary(&ratios).expect("at least one pair");
    println!(
        "{id}: harness / bare loop = {:.3} (median of {pairs} pairs, MAD {:.3})",
        summary.median, summary.mad
    );
}
