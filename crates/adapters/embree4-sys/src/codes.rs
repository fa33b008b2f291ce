//! Enumerations and flags, as numbers with named values.

use std::ffi::c_int;

/// Declares C enumerations. A value without a name here is as good as any other.
macro_rules! codes {
    ($($(#[$doc:meta])* $name:ident { $($(#[$value_doc:meta])* $value:ident = $number:expr,)* })*) => {$(
        $(#[$doc])*
        #[repr(transparent)]
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub struct $name(pub c_int);

        impl $name {
            $($(#[$value_doc])* pub const $value: Self = Self($number);)*
        }
    )*};
}

codes! {
    /// What [`rtcGetDeviceError`](crate::rtcGetDeviceError) returns.
    RTCError {
        /// No call has failed since the last look.
        NONE = 0,
        /// Anything else.
        UNKNOWN = 1,
        /// An argument that makes no sense.
        INVALID_ARGUMENT = 2,
        /// A call that this object doesn't allow.
        INVALID_OPERATION = 3,
        /// No memory left.
        OUT_OF_MEMORY = 4,
        /// The processor lacks what the library needs.
        UNSUPPORTED_CPU = 5,
        /// A monitor function asked for it.
        CANCELLED = 6,
    }

    /// What [`rtcGetDeviceProperty`](crate::rtcGetDeviceProperty) can be asked.
    RTCDeviceProperty {
        /// The version as major · 10000 + minor · 100 + patch.
        VERSION = 0,
    }

    /// Kinds of geometry.
    RTCGeometryType {
        /// Triangles that share corners.
        TRIANGLE = 0,
        /// Cones and cylinders between two points each, with a radius at both.
        CONE_LINEAR_CURVE = 15,
        /// Spheres.
        SPHERE_POINT = 50,
        /// Discs with a normal.
        ORIENTED_DISC_POINT = 52,
        /// Objects with functions of the caller.
        USER = 120,
    }

    /// What a buffer holds.
    RTCBufferType {
        /// Numbers of corners.
        INDEX = 0,
        /// Positions.
        VERTEX = 1,
        /// Normals.
        NORMAL = 3,
    }

    /// How a buffer holds it.
    RTCFormat {
        /// One 32-bit unsigned integer.
        UINT = 0x5001,
        /// Three 32-bit unsigned integers.
        UINT3 = 0x5003,
        /// Three 32-bit floats.
        FLOAT3 = 0x9003,
        /// Four 32-bit floats.
        FLOAT4 = 0x9004,
    }

    /// How much time a build may take.
    RTCBuildQuality {
        /// Morton order.
        LOW = 0,
        /// Surface-area heuristic.
        MEDIUM = 1,
        /// With spatial splits, which robust and compact scenes lose.
        HIGH = 2,
        /// Refits what is there.
        REFIT = 3,
    }

    /// How a scene is built; flags.
    RTCSceneFlags {
        /// None.
        NONE = 0,
        /// For geometry that changes.
        DYNAMIC = 1,
        /// A smaller structure that reads the geometry's own vertices.
        COMPACT = 1 << 1,
        /// Tests that don't miss at shared edges.
        ROBUST = 1 << 2,
        /// Filter functions may come with a query.
        FILTER_FUNCTION_IN_ARGUMENTS = 1 << 3,
    }

    /// What a query may assume; flags.
    RTCRayQueryFlags {
        /// Nothing.
        INCOHERENT = 0,
        /// The rays of a packet go the same way.
        COHERENT = 1 << 16,
    }

    /// What a query must be able to meet; flags. A feature that is left out may be missed in silence.
    RTCFeatureFlags {
        /// Everything.
        ALL = -1,
    }
}

impl std::ops::BitOr for RTCSceneFlags {
    type Output = Self;

    fn bitor(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
}

impl Default for RTCSceneFlags {
    fn default() -> Self {
        Self::NONE
    }
}

impl Default for RTCBuildQuality {
    fn default() -> Self {
        Self::MEDIUM
    }
}

/// Geometry number of a miss.
pub const RTC_INVALID_GEOMETRY_ID: u32 = u32::MAX;
