//! Rasters, in rays per second.

use accel::Hit;
use benches::{SCENES, build, on_one_thread, rays, scene, structures};
use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use rayscale::rays::RaysId;
use std::hint::black_box;
use std::time::Duration;

fn primary(c: &mut Criterion) {
    for id in SCENES {
        let scene = scene(id);
        for set in [RaysId::Parallel, RaysId::Perspective] {
            let rays = rays(&scene, set, 128);
            let mut hits: Vec<Option<Hit>> = vec![None; rays.len()];
            let mut group = c.benchmark_group(format!("{id}/{set}"));
            group.throughput(Throughput::Elements(rays.len() as u64));
            group.sample_size(10);
            group.warm_up_time(Duration::from_millis(300)).measurement_time(Duration::from_secs(1));
            for choice in structures() {
                let Some(accel) = build(&choice, &scene, &rays) else { continue };
                group.bench_function(choice.spec.to_string(), |b| {
                    on_one_thread(|| b.iter(|| accel.trace(&rays, black_box(&mut hits))));
                });
            }
            group.finish();
        }
    }
}

criterion_group!(benches, primary);
criterion_main!(benches);
