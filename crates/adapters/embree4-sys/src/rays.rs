//! Rays and hits, alone and in packets of 16, with room for every Embree 4.
//!
//! Embree 4.3 added `instPrimID` behind `instID` and writes it at every hit. A single hit has no such field here,
//! because `embree4-rs` fills hits in field by field; [`RTCRayHit`] ends in padding that takes the write. Packets,
//! which `embree4-rs` doesn't use, have the field. An older Embree leaves both alone.

use crate::RTC_INVALID_GEOMETRY_ID;

/// One ray.
#[repr(C, align(16))]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RTCRay {
    /// Origin, x.
    pub org_x: f32,
    /// Origin, y.
    pub org_y: f32,
    /// Origin, z.
    pub org_z: f32,
    /// Start of the segment, not below 0.
    pub tnear: f32,
    /// Direction, of any length, x.
    pub dir_x: f32,
    /// Direction, y.
    pub dir_y: f32,
    /// Direction, z.
    pub dir_z: f32,
    /// Time for motion blur.
    pub time: f32,
    /// End of the segment; set to t by a hit, to −∞ where something is in the way.
    pub tfar: f32,
    /// Geometry whose mask shares no bit is passed by.
    pub mask: u32,
    /// The caller's.
    pub id: u32,
    /// Must be 0.
    pub flags: u32,
}

impl Default for RTCRay {
    fn default() -> Self {
        Self {
            org_x: 0.0,
            org_y: 0.0,
            org_z: 0.0,
            tnear: 0.0,
            dir_x: 0.0,
            dir_y: 0.0,
            dir_z: 0.0,
            time: 0.0,
            tfar: f32::INFINITY,
            mask: u32::MAX,
            id: 0,
            flags: 0,
        }
    }
}

/// One hit, as far as Embree 4.2 knows it.
#[repr(C, align(16))]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RTCHit {
    /// Geometry normal, not normalised, x.
    pub Ng_x: f32,
    /// Geometry normal, y.
    pub Ng_y: f32,
    /// Geometry normal, z.
    pub Ng_z: f32,
    /// Weight of the second corner.
    pub u: f32,
    /// Weight of the third corner.
    pub v: f32,
    /// Number of the object within its geometry.
    pub primID: u32,
    /// Number of the geometry, all ones for a miss.
    pub geomID: u32,
    /// Number of the instance.
    pub instID: [u32; 1],
}

impl Default for RTCHit {
    fn default() -> Self {
        Self {
            Ng_x: 0.0,
            Ng_y: 0.0,
            Ng_z: 0.0,
            u: 0.0,
            v: 0.0,
            primID: RTC_INVALID_GEOMETRY_ID,
            geomID: RTC_INVALID_GEOMETRY_ID,
            instID: [RTC_INVALID_GEOMETRY_ID],
        }
    }
}

/// One ray and its hit: 80 bytes of fields in a struct of 96. Embree 4.3 and later write 4 bytes at offset 80.
#[repr(C, align(32))]
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RTCRayHit {
    /// The ray.
    pub ray: RTCRay,
    /// Its hit.
    pub hit: RTCHit,
}

/// 16 rays.
#[repr(C, align(64))]
#[derive(Clone, Copy, Debug, Default)]
pub struct RTCRay16 {
    /// Origins, x.
    pub org_x: [f32; 16],
    /// Origins, y.
    pub org_y: [f32; 16],
    /// Origins, z.
    pub org_z: [f32; 16],
    /// Starts of the segments.
    pub tnear: [f32; 16],
    /// Directions, x.
    pub dir_x: [f32; 16],
    /// Directions, y.
    pub dir_y: [f32; 16],
    /// Directions, z.
    pub dir_z: [f32; 16],
    /// Times for motion blur.
    pub time: [f32; 16],
    /// Ends of the segments.
    pub tfar: [f32; 16],
    /// Masks.
    pub mask: [u32; 16],
    /// The caller's.
    pub id: [u32; 16],
    /// Must be 0.
    pub flags: [u32; 16],
}

/// 16 hits, as Embree 4.3 and later have them.
#[repr(C, align(64))]
#[derive(Clone, Copy, Debug, Default)]
pub struct RTCHit16 {
    /// Geometry normals, x.
    pub Ng_x: [f32; 16],
    /// Geometry normals, y.
    pub Ng_y: [f32; 16],
    /// Geometry normals, z.
    pub Ng_z: [f32; 16],
    /// Weights of the second corners.
    pub u: [f32; 16],
    /// Weights of the third corners.
    pub v: [f32; 16],
    /// Numbers of the objects within their geometries.
    pub primID: [u32; 16],
    /// Numbers of the geometries, all ones for a miss.
    pub geomID: [u32; 16],
    /// Numbers of the instances.
    pub instID: [[u32; 16]; 1],
    /// Numbers within arrays of instances, since 4.3.
    pub instPrimID: [[u32; 16]; 1],
}

/// 16 rays and their hits.
#[repr(C, align(64))]
#[derive(Clone, Copy, Debug)]
pub struct RTCRayHit16 {
    /// The rays.
    pub ray: RTCRay16,
    /// Their hits.
    pub hit: RTCHit16,
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::mem::{align_of, offset_of};

    /// Sizes and offsets as a C compiler gives them for the headers of Embree 4.3.3 and 4.4.0.
    #[test]
    fn layouts_are_those_of_the_headers() {
        assert_eq!((size_of::<RTCRay>(), align_of::<RTCRay>()), (48, 16));
        assert_eq!((offset_of!(RTCRay, dir_x), offset_of!(RTCRay, tfar)), (16, 32));
        assert_eq!((offset_of!(RTCHit, primID), offset_of!(RTCHit, instID)), (20, 28));
        assert_eq!((size_of::<RTCRayHit16>(), align_of::<RTCRayHit16>()), (1344, 64));
        assert_eq!((size_of::<RTCRay16>(), offset_of!(RTCRayHit16, hit)), (768, 768));
        assert_eq!((offset_of!(RTCRay16, tfar), offset_of!(RTCHit16, primID)), (512, 320));
        assert_eq!((offset_of!(RTCHit16, geomID), offset_of!(RTCHit16, instPrimID)), (384, 512));
    }

    /// `instPrimID` lies at 80 in the headers of 4.3; the struct goes on to 96, as it does there.
    #[test]
    fn a_single_ray_hit_has_room_behind_its_fields() {
        assert_eq!(offset_of!(RTCRayHit, hit) + size_of::<RTCHit>(), 80);
        assert_eq!((size_of::<RTCRayHit>(), align_of::<RTCRayHit>()), (96, 32));
    }
}
