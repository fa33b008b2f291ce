//! Every footprint is held to what the allocator saw.

use accel::{Projection, Raster, Scene, Vec3, Workload};
use harness::registry;

#[global_allocator]
static ALLOCATOR: heap::Counting = heap::Counting;

fn workloads(scene: &Scene) -> [Workload; 2] {
    let bounds = scene.geometry.bounds();
    let extent = bounds.extent();
    let raster = Raster {
        projection: Projection::Parallel,
        rows: 96,
        cols: 128,
        origin: Vec3::new(bounds.min.x, bounds.max.y, bounds.max.z + 1.0),
        forward: Vec3::NEG_Z,
        right: Vec3::X * (extent.x / 128.0),
        down: Vec3::NEG_Y * (extent.y / 96.0),
    };
    [Workload::GENERAL, Workload::raster(raster)]
}

/// Alone in its file: other tests' allocations would count as well.
#[test]
fn footprints_are_what_was_allocated() {
    heap::start_counting();
    let mut wrong = Vec::new();
    for id in ["small-10k", "boxes-1000-40", "bumps-2k"] {
        let scene = scenes::load(&id.parse().unwrap()).unwrap();
        for spec in registry::with_variants(|entry| entry.traits.counted) {
            let choice = registry::choose(&spec).unwrap();
            for workload in workloads(&scene) {
                // What a library or the thread pool allocates once, at its first use, belongs to no structure;
                // threads that begin to work late do so in a later build.
                let observed = (0..4).filter_map(|_| {
                    let (built, used) = heap::observe(|| choice.builder.build(&scene, &workload));
                    let used = used.expect("counting");
                    Some((built.ok()?.footprint().total() as i64, used))
                });
                let off = |(said, used): &(i64, heap::Use)| (said - used.left).abs();
                let Some((said, used)) = observed.min_by_key(off) else { continue };
                let slack = (used.left / 100).max(4096);
                if (said - used.left).abs() > slack || used.peak < used.left as u64 {
                    let what = if workload.general { "general" } else { "raster" };
                    wrong.push(format!("{spec} on {id}, {what}: says {said}, allocated {}", used.left));
                }
            }
        }
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
    let (kept, used) = heap::observe(|| {
        drop(vec![0u8; 1 << 20]);
        vec![0u8; 1 << 10]
    });
    assert_eq!(kept.len(), 1 << 10);
    assert_eq!(used, Some(heap::Use { left: 1 << 10, peak: 1 << 20 }));
}
