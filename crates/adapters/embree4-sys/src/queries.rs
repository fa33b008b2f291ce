//! What goes with a query, and what functions of user geometry are called with.

use std::ffi::{c_int, c_void};

use crate::{RTC_INVALID_GEOMETRY_ID, RTCFeatureFlags, RTCRayQueryFlags};

/// A bounding box.
#[repr(C, align(16))]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RTCBounds {
    /// Lower corner, x.
    pub lower_x: f32,
    /// Lower corner, y.
    pub lower_y: f32,
    /// Lower corner, z.
    pub lower_z: f32,
    /// Not used.
    pub align0: f32,
    /// Upper corner, x.
    pub upper_x: f32,
    /// Upper corner, y.
    pub upper_y: f32,
    /// Upper corner, z.
    pub upper_z: f32,
    /// Not used.
    pub align1: f32,
}

/// What a query carries to its functions.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct RTCRayQueryContext {
    /// The instances that the query is inside.
    pub instID: [u32; 1],
}

impl Default for RTCRayQueryContext {
    fn default() -> Self {
        Self { instID: [RTC_INVALID_GEOMETRY_ID] }
    }
}

/// Filter function of a query. Its arguments aren't declared, as nothing here uses them.
pub type RTCFilterFunctionN = Option<unsafe extern "C" fn(arguments: *const c_void)>;
/// Bounds of an object of user geometry.
pub type RTCBoundsFunction = Option<unsafe extern "C" fn(arguments: *const RTCBoundsFunctionArguments)>;
/// Intersection with an object of user geometry.
pub type RTCIntersectFunctionN =
    Option<unsafe extern "C" fn(arguments: *const RTCIntersectFunctionNArguments)>;

/// Declares the arguments of a kind of query, without `RTC_MIN_WIDTH`, which no distribution sets.
macro_rules! arguments {
    ($($(#[$doc:meta])* $name:ident, $callback:ident;)*) => {$(
        $(#[$doc])*
        #[repr(C)]
        #[derive(Clone, Copy, Debug)]
        pub struct $name {
            /// What the query may assume.
            pub flags: RTCRayQueryFlags,
            /// What it must be able to meet.
            pub feature_mask: RTCFeatureFlags,
            /// Null for none.
            pub context: *mut RTCRayQueryContext,
            /// Called for every hit.
            pub filter: RTCFilterFunctionN,
            /// Called for user geometry.
            pub $callback: RTCIntersectFunctionN,
            /// Read only by an Embree built with `EMBREE_MIN_WIDTH`; room for it costs nothing.
            pub minWidthDistanceFactor: f32,
        }

        impl $name {
            /// With these flags, every feature and nothing else.
            pub const fn new(flags: RTCRayQueryFlags) -> Self {
                Self {
                    flags,
                    feature_mask: RTCFeatureFlags::ALL,
                    context: std::ptr::null_mut(),
                    filter: None,
                    $callback: None,
                    minWidthDistanceFactor: 0.0,
                }
            }
        }

        impl Default for $name {
            fn default() -> Self {
                Self::new(RTCRayQueryFlags::INCOHERENT)
            }
        }

        // SAFETY: Embree only reads the arguments; whoever puts in a context answers for it in the unsafe call.
        unsafe impl Send for $name {}
        // SAFETY: as above.
        unsafe impl Sync for $name {}
    )*};
}

arguments! {
    /// For the nearest hit.
    RTCIntersectArguments, intersect;
    /// For any hit. The function is called with arguments that differ in type only by what they point to.
    RTCOccludedArguments, occluded;
}

/// What a function for bounds is called with.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct RTCBoundsFunctionArguments {
    /// The data of the geometry.
    pub geometryUserPtr: *mut c_void,
    /// Number of the object.
    pub primID: u32,
    /// Number of the time step.
    pub timeStep: u32,
    /// Where the bounds go.
    pub bounds_o: *mut RTCBounds,
}

/// N rays and their hits, field by field.
#[repr(C)]
#[derive(Debug)]
pub struct RTCRayHitN {
    _opaque: [u8; 0],
}

/// What a function for intersection is called with.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct RTCIntersectFunctionNArguments {
    /// −1 for each ray to be tested, 0 for others.
    pub valid: *mut c_int,
    /// The data of the geometry.
    pub geometryUserPtr: *mut c_void,
    /// Number of the object.
    pub primID: u32,
    /// What the query carries.
    pub context: *mut RTCRayQueryContext,
    /// The rays.
    pub rayhit: *mut RTCRayHitN,
    /// How many they are.
    pub N: u32,
    /// Number of the geometry.
    pub geomID: u32,
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::mem::offset_of;

    #[test]
    fn layouts_are_those_of_the_headers() {
        assert_eq!(offset_of!(RTCIntersectArguments, context), 8);
        assert_eq!(offset_of!(RTCOccludedArguments, minWidthDistanceFactor), 32);
        assert_eq!(size_of::<RTCBounds>(), 32);
        assert_eq!(offset_of!(RTCBoundsFunctionArguments, bounds_o), 16);
        assert_eq!(size_of::<RTCIntersectFunctionNArguments>(), 48);
        assert_eq!(offset_of!(RTCIntersectFunctionNArguments, N), 40);
    }
}
