//! The part of Embree's C interface that the adapter uses, as `embree4/rtcore_*.h` declare it
//! (Embree 4.0 to 4.4, <https://github.com/RenderKit/embree>). It is written out here, rather than
//! generated from headers, so that no build needs libclang or the headers, and so that ray-hits
//! have room for the field that Embree 4.3 added (see [`crate::rayhit`]).

use std::ffi::{c_char, c_int, c_uint, c_void};

use crate::rayhit::{Ray1, Ray16, RayHit1, RayHit16, Valid16};

/// Declares handles: pointers to types that only Embree knows.
macro_rules! handles {
    ($($(#[$doc:meta])* $name:ident)*) => {$(
        $(#[$doc])*
        #[repr(C)]
        pub struct $name {
            _opaque: [u8; 0],
        }
    )*};
}

handles! {
    /// `RTCDevice` is a pointer to this.
    RTCDeviceTy
    /// `RTCScene` is a pointer to this.
    RTCSceneTy
    /// `RTCGeometry` is a pointer to this.
    RTCGeometryTy
}

/// `RTCError`: `RTC_ERROR_NONE`.
pub const RTC_ERROR_NONE: c_int = 0;
/// `RTCDeviceProperty`: the version as major · 10000 + minor · 100 + patch.
pub const RTC_DEVICE_PROPERTY_VERSION: c_int = 0;
/// `RTCGeometryType`.
pub const RTC_GEOMETRY_TYPE_TRIANGLE: c_int = 0;
/// `RTCBufferType`.
pub const RTC_BUFFER_TYPE_INDEX: c_int = 0;
/// `RTCBufferType`.
pub const RTC_BUFFER_TYPE_VERTEX: c_int = 1;
/// `RTCFormat`: three 32-bit unsigned integers.
pub const RTC_FORMAT_UINT3: c_int = 0x5003;
/// `RTCFormat`: three 32-bit floats.
pub const RTC_FORMAT_FLOAT3: c_int = 0x9003;
/// `RTCSceneFlags`: a smaller structure that reads the scene's own vertices.
pub const RTC_SCENE_FLAG_COMPACT: c_int = 1 << 1;
/// `RTCSceneFlags`: tests that don't miss at shared edges.
pub const RTC_SCENE_FLAG_ROBUST: c_int = 1 << 2;
/// `RTCRayQueryFlags`.
pub const RTC_RAY_QUERY_FLAG_INCOHERENT: c_int = 0;
/// `RTCRayQueryFlags`: traversal made for rays that go the same way.
pub const RTC_RAY_QUERY_FLAG_COHERENT: c_int = 1 << 16;
/// `RTCFeatureFlags`: everything.
pub const RTC_FEATURE_FLAG_ALL: c_int = -1;
/// Geometry number of a miss.
pub const RTC_INVALID_GEOMETRY_ID: u32 = u32::MAX;

/// `RTCErrorFunction`.
pub type ErrorFunction = unsafe extern "C" fn(*mut c_void, c_int, *const c_char);
/// `RTCMemoryMonitorFunction`.
pub type MemoryMonitorFunction = unsafe extern "C" fn(*mut c_void, isize, bool) -> bool;

/// `RTCIntersectArguments` and `RTCOccludedArguments`, which differ only in the type of a function
/// that is not used here; without `RTC_MIN_WIDTH`, which no distribution sets.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct QueryArguments {
    /// `RTCRayQueryFlags`.
    pub flags: c_int,
    /// `RTCFeatureFlags`.
    pub feature_mask: c_int,
    /// `RTCRayQueryContext*`, null for none.
    pub context: *mut c_void,
    /// Filter function, null for none.
    pub filter: *const c_void,
    /// User geometry function, null for none.
    pub callback: *const c_void,
    /// Read only by an Embree built with `EMBREE_MIN_WIDTH`; room for it costs nothing.
    pub min_width_distance_factor: f32,
}

// SAFETY: all pointers are null, and Embree only reads the arguments.
unsafe impl Sync for QueryArguments {}

impl QueryArguments {
    /// What `rtcInitIntersectArguments` and `rtcInitOccludedArguments` set, with these flags.
    pub const fn new(flags: c_int) -> Self {
        Self {
            flags,
            feature_mask: RTC_FEATURE_FLAG_ALL,
            context: std::ptr::null_mut(),
            filter: std::ptr::null(),
            callback: std::ptr::null(),
            min_width_distance_factor: 0.0,
        }
    }
}

#[allow(missing_docs)] // The C interface is documented by Embree.
unsafe extern "C" {
    pub fn rtcNewDevice(config: *const c_char) -> *mut RTCDeviceTy;
    pub fn rtcReleaseDevice(device: *mut RTCDeviceTy);
    pub fn rtcGetDeviceProperty(device: *mut RTCDeviceTy, property: c_int) -> isize;
    pub fn rtcGetDeviceError(device: *mut RTCDeviceTy) -> c_int;
    pub fn rtcSetDeviceErrorFunction(
        device: *mut RTCDeviceTy,
        function: Option<ErrorFunction>,
        user: *mut c_void,
    );
    pub fn rtcSetDeviceMemoryMonitorFunction(
        device: *mut RTCDeviceTy,
        function: Option<MemoryMonitorFunction>,
        user: *mut c_void,
    );

    pub fn rtcNewGeometry(device: *mut RTCDeviceTy, kind: c_int) -> *mut RTCGeometryTy;
    pub fn rtcReleaseGeometry(geometry: *mut RTCGeometryTy);
    pub fn rtcSetSharedGeometryBuffer(
        geometry: *mut RTCGeometryTy,
        kind: c_int,
        slot: c_uint,
        format: c_int,
        data: *const c_void,
        byte_offset: usize,
        byte_stride: usize,
        item_count: usize,
    );
    pub fn rtcSetGeometryBuildQuality(geometry: *mut RTCGeometryTy, quality: c_int);
    pub fn rtcCommitGeometry(geometry: *mut RTCGeometryTy);

    pub fn rtcNewScene(device: *mut RTCDeviceTy) -> *mut RTCSceneTy;
    pub fn rtcReleaseScene(scene: *mut RTCSceneTy);
    pub fn rtcSetSceneFlags(scene: *mut RTCSceneTy, flags: c_int);
    pub fn rtcSetSceneBuildQuality(scene: *mut RTCSceneTy, quality: c_int);
    pub fn rtcAttachGeometry(scene: *mut RTCSceneTy, geometry: *mut RTCGeometryTy) -> c_uint;
    pub fn rtcCommitScene(scene: *mut RTCSceneTy);

    pub fn rtcIntersect1(scene: *mut RTCSceneTy, rayhit: *mut RayHit1, arguments: *const QueryArguments);
    pub fn rtcOccluded1(scene: *mut RTCSceneTy, ray: *mut Ray1, arguments: *const QueryArguments);
    pub fn rtcIntersect16(
        valid: *const Valid16,
        scene: *mut RTCSceneTy,
        rayhit: *mut RayHit16,
        arguments: *const QueryArguments,
    );
    pub fn rtcOccluded16(
        valid: *const Valid16,
        scene: *mut RTCSceneTy,
        ray: *mut Ray16,
        arguments: *const QueryArguments,
    );
}
