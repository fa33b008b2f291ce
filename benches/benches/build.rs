//! Time to build for rays of any kind, in objects per second.

use accel::Workload;
use benches::{PAPER_SCENES, SCENES, all_structures, on_one_thread, scene, structures};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use std::hint::black_box;
use std::time::Duration;

fn build(c: &mut Criterion) {
    let large = SCENES.map(|id| (id, structures()));
    let small = PAPER_SCENES.map(|id| (id, all_structures()));
    for (id, structures) in large.into_iter().chain(small) {
        let scene = scene(id);
        let mut group = c.benchmark_group(format!("build/{id}"));
        group.throughput(Throughput::Elements(scene.geometry.len() as u64));
        group
            .sample_size(10)
            .warm_up_time(Duration::from_millis(300))
            .measurement_time(Duration::from_secs(1));
        for choice in structures {
            if choice.builder.build(&scene, &Workload::GENERAL).is_ok() {
                group.bench_function(choice.spec.to_string(), |b| {
                    on_one_thread(|| {
                        b.iter_with_large_drop(|| {
                            black_box(choice.builder.build(&scene, &Workload::GENERAL).ok())
                        })
                    });
                });
            }
        }
        group.finish();
    }
}

criterion_group!(benches, build);
criterion_main!(benches);
