//! Keeping Embree's task scheduler to the calling thread.

/// Has Embree build on the calling thread alone, in this process from now on. To be called before anything else
/// here; later it changes nothing.
///
/// A device for one thread is not enough: the task scheduler (oneTBB 2021.12) then holds a worker back, which
/// goes on asking for work without a pause, takes half of a core with two threads from whatever is measured beside it,
/// and counts as time of the process. The scheduler looks once at how many processors it may
/// use, so it is shown only one. Linux only; elsewhere this does nothing.
pub fn keep_to_one_thread() {
    #[cfg(target_os = "linux")]
    {
        static ONCE: std::sync::Once = std::sync::Once::new();
        ONCE.call_once(on_linux);
    }
}

#[cfg(target_os = "linux")]
fn on_linux() {
    use crate::{Device, EmbreeScene, SceneSettings};
    use accel::{Mesh, Vec3};
    use rustix::process::getpid;
    use rustix::thread::{CpuSet, sched_getaffinity, sched_setaffinity};

    // The scheduler asks for the process, which is its first thread.
    let process = Some(getpid());
    let Ok(before) = sched_getaffinity(process) else { return };
    let Some(first) = (0..CpuSet::MAX_CPU).find(|cpu| before.is_set(*cpu)) else { return };
    let mut one = CpuSet::new();
    one.set(first);
    if sched_setaffinity(process, &one).is_err() {
        return;
    }
    // Only a build wakes the scheduler. A library that can't build says so where it is used.
    let corners = [Vec3::ZERO, Vec3::X, Vec3::Y].to_vec();
    let mesh = Mesh { positions: corners, triangles: vec![[0, 1, 2]] };
    if let Ok(device) = Device::new(1) {
        let _ = EmbreeScene::new(device, &mesh, SceneSettings::default());
    }
    let _ = sched_setaffinity(process, &before);
}
