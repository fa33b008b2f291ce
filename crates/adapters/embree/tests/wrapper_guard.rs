//! embree4-rs gives Embree a struct on its stack: nothing behind it may be written.
//!
//! The test puts itself between the two. It has the name of the function that embree4-rs calls, passes each call on
//! with a copy of the ray-hit that words of its own follow, and looks at these words afterwards.
#![cfg(target_os = "linux")]

use std::ffi::{CStr, c_char, c_void};
use std::sync::Mutex;

use embree4_rs::geometry::TriangleMeshGeometry;
use embree4_rs::{Device, Scene, SceneOptions};
use embree4_sys::{RTCIntersectArguments, RTCRay, RTCRayHit, RTCScene};

const GUARD: [u32; 16] = [0x5afe_c0de; 16];

/// As long as the struct of the headers before 4.3.
#[repr(C, align(16))]
#[derive(Clone, Copy)]
struct Short([u32; 20]);

#[repr(C)]
struct Guarded<T> {
    inner: T,
    guard: [u32; 16],
}

/// The guards after each call: behind embree4-rs' struct, and behind one of the old length.
static SEEN: Mutex<Vec<[[u32; 16]; 2]>> = Mutex::new(Vec::new());

type Intersect1 = unsafe extern "C" fn(RTCScene, *mut c_void, *mut RTCIntersectArguments);

unsafe extern "C" {
    fn dlsym(library: *mut c_void, name: *const c_char) -> *mut c_void;
}

/// The function of that name in the library, which this program's own hides.
fn of_embree(name: &CStr) -> Intersect1 {
    /// `RTLD_NEXT`: the libraries behind the caller.
    const NEXT: *mut c_void = usize::MAX as *mut c_void;
    // SAFETY: a valid handle and name.
    let found = unsafe { dlsym(NEXT, name.as_ptr()) };
    assert!(!found.is_null(), "{name:?}");
    // SAFETY: the symbol is `rtcIntersect1`, which has this type but for what its second argument points to.
    unsafe { std::mem::transmute::<*mut c_void, Intersect1>(found) }
}

/// # Safety
/// As for Embree's.
#[unsafe(no_mangle)]
unsafe extern "C" fn rtcIntersect1(
    scene: RTCScene,
    rayhit: *mut RTCRayHit,
    arguments: *mut RTCIntersectArguments,
) {
    let embree = of_embree(c"rtcIntersect1");
    // SAFETY: the caller's struct, whose first 80 bytes are fields.
    let (whole, short) = unsafe { (*rayhit, *rayhit.cast::<Short>()) };
    let mut whole = Guarded { inner: whole, guard: GUARD };
    let mut short = Guarded { inner: short, guard: GUARD };
    // SAFETY: the caller's scene and arguments, and structs followed by 64 bytes that may be written.
    unsafe {
        embree(scene, (&raw mut whole).cast(), arguments);
        embree(scene, (&raw mut short).cast(), arguments);
        *rayhit = whole.inner;
    }
    SEEN.lock().unwrap().push([whole.guard, short.guard]);
}

#[test]
fn embree4_rs_gives_embree_the_room_that_it_writes_to() {
    let device = Device::try_new(Some("threads=1\0")).unwrap();
    let scene = Scene::try_new(device, SceneOptions::default()).unwrap();
    let corners = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)];
    let triangles = TriangleMeshGeometry::try_new(&scene.device, &corners, &[(0, 1, 2)]).unwrap();
    scene.attach_geometry(&triangles).unwrap();
    let scene = scene.commit().unwrap();
    let ray = |x| RTCRay { org_x: x, org_y: 0.25, org_z: 3.0, dir_z: -2.0, ..RTCRay::default() };
    let hit = scene.intersect_1(ray(0.25), None).unwrap().unwrap();
    assert_eq!((hit.hit.geomID, hit.hit.primID), (0, 0));
    // How Embree divides depends on the instruction set it chooses.
    assert!((hit.ray.tfar - 1.5).abs() < 1e-6);
    assert_eq!(scene.intersect_1(ray(2.0), None).unwrap(), None);

    let seen = SEEN.lock().unwrap();
    assert_eq!(seen.len(), 2, "both calls came by");
    assert!(seen.iter().all(|[whole, _]| *whole == GUARD), "{seen:x?}");
    // The same call with the struct of the headers before 4.3: what the padding is for.
    let (_, minor, _) = adapter_embree::version().unwrap();
    let [_, behind_short] = seen[0];
    assert_eq!(behind_short[0] != GUARD[0], minor >= 3, "{behind_short:x?}");
    assert_eq!(behind_short[1..], GUARD[1..]);
}
