//! Alone in its process, as the task scheduler looks only once at what it may use.
#![cfg(target_os = "linux")]

use accel::{Mesh, Vec3};
use adapter_embree::{Device, EmbreeScene, SceneSettings, keep_to_one_thread};
use rustix::process::getpid;
use rustix::thread::sched_getaffinity;

fn threads() -> usize {
    std::fs::read_dir("/proc/self/task").unwrap().count()
}

#[test]
fn no_worker_starts_and_the_processors_come_back() {
    let processors = sched_getaffinity(Some(getpid())).unwrap();
    keep_to_one_thread();
    assert_eq!(sched_getaffinity(Some(getpid())).unwrap(), processors);
    let before = threads();
    let side = 300;
    let positions = (0..side * side).map(|i| Vec3::new((i % side) as f32, (i / side) as f32, 0.0)).collect();
    let triangles = (0..side * (side - 1) - 1).map(|i| [i, i + 1, i + side]).collect();
    let mesh = Mesh { positions, triangles };
    for _ in 0..3 {
        EmbreeScene::new(Device::new(1).unwrap(), &mesh, SceneSettings::default()).unwrap();
    }
    assert!(threads() <= before, "the scheduler started a worker");
}
