//! Criterion benches over the registry of `rayscale`: what they share.

use accel::{Accel, Hit, RaySet, Scene, Workload};
use criterion::{Criterion, Throughput};
use harness::measure::memory_rows;
use harness::record::Layout;
use harness::registry::{self, Choice, StructureSpec};
use scenes::rays::{RaysId, RaysSpec, generate};
use std::hint::black_box;
use std::time::Duration;

/// The small fixed set of scenes.
pub const SCENES: [&str; 2] = ["small-10k", "bumps-20k"];

/// Scenes of the paper's size, for structures whose time grows with the number of objects.
pub const PAPER_SCENES: [&str; 2] = ["boxes-1000-25", "small-1k"];

/// Structures whose time does not grow with the number of objects.
pub fn structures() -> Vec<Choice> {
    all_structures().into_iter().filter(|choice| !choice.entry.traits.linear).collect()
}

/// All structures of the default comparison, `bmssm-dense`, `minmax` and `sphere` among them, and `bmssm-dense` with maps at all
/// levels, which is what to hold the tree of `bmssm` against.
pub fn all_structures() -> Vec<Choice> {
    let levels = StructureSpec::plain("bmssm-dense").with("levels", "on");
    let specs = registry::defaults().into_iter().chain([levels]);
    specs.filter_map(|spec| registry::choose(&spec).ok()).collect()
}

/// A scene of the suite.
///
/// # Panics
/// If there is no such scene.
pub fn scene(id: &str) -> Scene {
    let spec = id.parse().expect("a scene's name");
    scenes::load(&spec).unwrap_or_else(|error| panic!("{error}"))
}

/// A ray set of the scene with `size` × `size` rays.
///
/// # Panics
/// If the scene has no such rays.
pub fn rays(scene: &Scene, id: RaysId, size: u32) -> RaySet {
    let grid = registry::parse("ssm").expect("an entry");
    let tracer = grid.builder.build(scene, &Workload::GENERAL).unwrap_or_else(|error| panic!("{error}"));
    let spec = RaysSpec { id, rows: size, cols: size, seed: 1 };
    generate(scene, &spec, tracer.as_ref()).unwrap_or_else(|error| panic!("{error}"))
}

/// Built for the rays, or `None` where the structure doesn't serve them.
pub fn build<'s>(choice: &Choice, scene: &'s Scene, rays: &RaySet) -> Option<Box<dyn Accel + 's>> {
    harness::registry::keep_to_one_thread();
    choice.builder.build(scene, &Workload::of(rays)).ok()
}

/// Does `work` on one thread.
///
/// # Panics
/// If the system gives no thread.
pub fn on_one_thread<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("one thread");
    pool.install(work)
}

/// Says how large a scene is and what the paper compares: ν_mem, the bytes of the uniform grid over the bytes of the
/// bit maps at the same number of slices.
pub fn introduce(scene: &Scene) {
    let (objects, kind) = (scene.geometry.len(), scene.geometry.kind());
    println!("{}: {objects} {kind}", scene.id);
    for row in memory_rows(scene, &[16, 64], accel::Cancel::NEVER).into_iter().flatten() {
        let built = |layout: Option<Layout>| layout.map_or("–".to_owned(), |l| format!("{:.3}", l.ratio()));
        println!(
            "  ν_mem at N = {}: {:.3} by formula, {} for the paper's layouts as built, {} for the compact ones",
            row.resolution,
            row.formula_4_byte.ratio(),
            built(row.paper_layouts),
            built(row.compact_layouts)
        );
    }
}

/// Benches nearest hits of structures on ray sets of scenes, in rays per second.
///
/// # Panics
/// If a scene has no such rays.
pub fn trace(c: &mut Criterion, scenes: &[&str], sets: &[RaysId], structures: &[Choice]) {
    for id in scenes {
        let scene = scene(id);
        introduce(&scene);
        for set in sets {
            let rays = rays(&scene, *set, 128);
            let mut hits: Vec<Option<Hit>> = vec![None; rays.len()];
            let mut group = c.benchmark_group(format!("{id}/{set}"));
            group.throughput(Throughput::Elements(rays.len() as u64));
            group.sample_size(10);
            group.warm_up_time(Duration::from_millis(300)).measurement_time(Duration::from_secs(1));
            for choice in structures {
                let Some(accel) = build(choice, &scene, &rays) else { continue };
                group.bench_function(choice.spec.to_string(), |b| {
                    on_one_thread(|| b.iter(|| accel.trace(&rays, black_box(&mut hits))));
                });
            }
            group.finish();
        }
    }
}
