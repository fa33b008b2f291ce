//! Handles and functions.

use std::ffi::{c_char, c_int, c_uint, c_void};

use crate::{
    RTCBounds, RTCBoundsFunction, RTCBufferType, RTCBuildQuality, RTCDeviceProperty, RTCError, RTCFormat,
    RTCGeometryType, RTCIntersectArguments, RTCIntersectFunctionN, RTCOccludedArguments, RTCRay, RTCRay16,
    RTCRayHit, RTCRayHit16, RTCSceneFlags,
};

/// Declares handles: pointers to types that only Embree knows.
macro_rules! handles {
    ($($(#[$doc:meta])* $name:ident, $target:ident;)*) => {$(
        $(#[$doc])*
        #[repr(C)]
        #[derive(Debug)]
        pub struct $target {
            _opaque: [u8; 0],
        }

        $(#[$doc])*
        pub type $name = *mut $target;
    )*};
}

handles! {
    /// A device: configuration, errors and memory.
    RTCDevice, RTCDeviceTy;
    /// A scene: geometry and the structure over it.
    RTCScene, RTCSceneTy;
    /// A geometry: objects of one kind.
    RTCGeometry, RTCGeometryTy;
}

/// Called with the data given for it, a code and Embree's own words. The code is a number here, whatever it is.
pub type RTCErrorFunction =
    Option<unsafe extern "C" fn(user: *mut c_void, code: RTCError, text: *const c_char)>;
/// Called with the data given for it, bytes (below 0 for a release), and whether it has happened already; false
/// cancels a build.
pub type RTCMemoryMonitorFunction =
    Option<unsafe extern "C" fn(user: *mut c_void, bytes: isize, post: bool) -> bool>;

unsafe extern "C" {
    /// A device made from a configuration that ends in NUL (null for none); null where that fails.
    pub fn rtcNewDevice(config: *const c_char) -> RTCDevice;
    /// Gives a reference back.
    pub fn rtcReleaseDevice(device: RTCDevice);
    /// A property's value.
    pub fn rtcGetDeviceProperty(device: RTCDevice, property: RTCDeviceProperty) -> isize;
    /// The first error of this thread on this device (null: on making one) since the last look.
    pub fn rtcGetDeviceError(device: RTCDevice) -> RTCError;
    /// Sets the function that is told of errors.
    pub fn rtcSetDeviceErrorFunction(device: RTCDevice, function: RTCErrorFunction, user: *mut c_void);
    /// Sets the function that is told of memory.
    pub fn rtcSetDeviceMemoryMonitorFunction(
        device: RTCDevice,
        function: RTCMemoryMonitorFunction,
        user: *mut c_void,
    );

    /// A geometry of a kind; null where that fails.
    pub fn rtcNewGeometry(device: RTCDevice, kind: RTCGeometryType) -> RTCGeometry;
    /// Gives a reference back.
    pub fn rtcReleaseGeometry(geometry: RTCGeometry);
    /// Has Embree read a buffer of the caller's, which must stay and go on for 16 bytes from its last item's start.
    pub fn rtcSetSharedGeometryBuffer(
        geometry: RTCGeometry,
        kind: RTCBufferType,
        slot: c_uint,
        format: RTCFormat,
        data: *const c_void,
        byte_offset: usize,
        byte_stride: usize,
        item_count: usize,
    );
    /// A buffer of Embree's own, to be filled in.
    pub fn rtcSetNewGeometryBuffer(
        geometry: RTCGeometry,
        kind: RTCBufferType,
        slot: c_uint,
        format: RTCFormat,
        byte_stride: usize,
        item_count: usize,
    ) -> *mut c_void;
    /// How much time its part of a build may take.
    pub fn rtcSetGeometryBuildQuality(geometry: RTCGeometry, quality: RTCBuildQuality);
    /// How many objects user geometry has.
    pub fn rtcSetGeometryUserPrimitiveCount(geometry: RTCGeometry, count: c_uint);
    /// What its functions are given.
    pub fn rtcSetGeometryUserData(geometry: RTCGeometry, data: *mut c_void);
    /// The function for bounds of user geometry.
    pub fn rtcSetGeometryBoundsFunction(
        geometry: RTCGeometry,
        function: RTCBoundsFunction,
        user: *mut c_void,
    );
    /// The function for intersection with user geometry.
    pub fn rtcSetGeometryIntersectFunction(geometry: RTCGeometry, function: RTCIntersectFunctionN);
    /// The function for occlusion by user geometry; it is given rays where that for intersection is given rays with hits.
    pub fn rtcSetGeometryOccludedFunction(geometry: RTCGeometry, function: RTCIntersectFunctionN);
    /// Ends the changes to a geometry.
    pub fn rtcCommitGeometry(geometry: RTCGeometry);

    /// A scene without geometry; null where that fails.
    pub fn rtcNewScene(device: RTCDevice) -> RTCScene;
    /// Gives a reference back.
    pub fn rtcReleaseScene(scene: RTCScene);
    /// How it is to be built.
    pub fn rtcSetSceneFlags(scene: RTCScene, flags: RTCSceneFlags);
    /// How much time building may take.
    pub fn rtcSetSceneBuildQuality(scene: RTCScene, quality: RTCBuildQuality);
    /// Adds a geometry, to which the scene keeps a reference, and returns its number.
    pub fn rtcAttachGeometry(scene: RTCScene, geometry: RTCGeometry) -> c_uint;
    /// Builds.
    pub fn rtcCommitScene(scene: RTCScene);
    /// The bounds of a committed scene.
    pub fn rtcGetSceneBounds(scene: RTCScene, bounds: *mut RTCBounds);

    /// The nearest hit of a ray. Null for arguments means the defaults.
    pub fn rtcIntersect1(scene: RTCScene, rayhit: *mut RTCRayHit, arguments: *mut RTCIntersectArguments);
    /// Whether a ray hits anything.
    pub fn rtcOccluded1(scene: RTCScene, ray: *mut RTCRay, arguments: *mut RTCOccludedArguments);
    /// The nearest hits of the rays of a packet for which `valid`, aligned to 64 bytes, says −1.
    pub fn rtcIntersect16(
        valid: *const c_int,
        scene: RTCScene,
        rayhit: *mut RTCRayHit16,
        arguments: *mut RTCIntersectArguments,
    );
    /// Whether they hit anything.
    pub fn rtcOccluded16(
        valid: *const c_int,
        scene: RTCScene,
        ray: *mut RTCRay16,
        arguments: *mut RTCOccludedArguments,
    );
}
