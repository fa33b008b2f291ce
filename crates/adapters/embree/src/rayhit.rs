//! Rays and hits in Embree's layout, with room for every 4.x.
//!
//! Embree 4.3 added `instPrimID` after `instID` and writes it on every hit. Structs made after the
//! headers of 4.2 end before it (the single ray-hit is 80 bytes there and 96 with it), so a hit
//! would be written past their end. These have the field; an older Embree leaves it alone.

/// `RTCRay`.
#[repr(C, align(16))]
#[derive(Clone, Copy, Debug)]
pub struct Ray1 {
    /// Origin.
    pub origin: [f32; 3],
    /// Start of the segment, not below 0.
    pub tnear: f32,
    /// Direction, of any length.
    pub direction: [f32; 3],
    /// Time for motion blur.
    pub time: f32,
    /// End of the segment; set to t on a hit, to −∞ when occluded.
    pub tfar: f32,
    /// Geometry whose mask shares no bit is skipped.
    pub mask: u32,
    /// Not used.
    pub id: u32,
    /// Must be 0.
    pub flags: u32,
}

impl Ray1 {
    /// A ray that sees every geometry.
    #[inline]
    pub const fn new(origin: [f32; 3], direction: [f32; 3], tnear: f32, tfar: f32) -> Self {
        Self { origin, tnear, direction, time: 0.0, tfar, mask: u32::MAX, id: 0, flags: 0 }
    }
}

/// `RTCHit` of Embree 4.3 and later.
#[repr(C, align(16))]
#[derive(Clone, Copy, Debug)]
pub struct Hit1 {
    /// Geometry normal, not normalised.
    pub normal: [f32; 3],
    /// Weight of the second corner.
    pub u: f32,
    /// Weight of the third corner.
    pub v: f32,
    /// Triangle number.
    pub prim: u32,
    /// Geometry number, all ones for a miss.
    pub geom: u32,
    /// Instance number.
    pub inst: [u32; 1],
    /// Number within an instance array, since 4.3.
    pub inst_prim: [u32; 1],
}

/// `RTCRayHit` of Embree 4.3 and later.
#[repr(C, align(16))]
#[derive(Clone, Copy, Debug)]
pub struct RayHit1 {
    /// The ray.
    pub ray: Ray1,
    /// Its hit.
    pub hit: Hit1,
}

impl RayHit1 {
    /// A ray without a hit yet.
    #[inline]
    pub const fn new(ray: Ray1) -> Self {
        let none = u32::MAX;
        let hit = Hit1 {
            normal: [0.0; 3],
            u: 0.0,
            v: 0.0,
            prim: none,
            geom: none,
            inst: [none],
            inst_prim: [none],
        };
        Self { ray, hit }
    }
}

/// Which of 16 rays are to be traced: −1 for yes, 0 for no.
#[repr(C, align(64))]
#[derive(Clone, Copy, Debug)]
pub struct Valid16(pub [i32; 16]);

impl Valid16 {
    /// The first `count` rays of a packet.
    #[inline]
    pub fn first(count: usize) -> Self {
        Self(std::array::from_fn(|lane| if lane < count { -1 } else { 0 }))
    }
}

/// `RTCRay16`: every field for 16 rays.
#[repr(C, align(64))]
#[derive(Clone, Copy, Debug)]
pub struct Ray16 {
    /// Origins: x, y, z.
    pub origin: [[f32; 16]; 3],
    /// Starts of the segments.
    pub tnear: [f32; 16],
    /// Directions: x, y, z.
    pub direction: [[f32; 16]; 3],
    /// Times for motion blur.
    pub time: [f32; 16],
    /// Ends of the segments.
    pub tfar: [f32; 16],
    /// Masks.
    pub mask: [u32; 16],
    /// Not used.
    pub id: [u32; 16],
    /// Must be 0.
    pub flags: [u32; 16],
}

/// `RTCHit16` of Embree 4.3 and later.
#[repr(C, align(64))]
#[derive(Clone, Copy, Debug)]
pub struct Hit16 {
    /// Geometry normals: x, y, z.
    pub normal: [[f32; 16]; 3],
    /// Weights of the second corners.
    pub u: [f32; 16],
    /// Weights of the third corners.
    pub v: [f32; 16],
    /// Triangle numbers.
    pub prim: [u32; 16],
    /// Geometry numbers, all ones for a miss.
    pub geom: [u32; 16],
    /// Instance numbers.
    pub inst: [[u32; 16]; 1],
    /// Numbers within an instance array, since 4.3.
    pub inst_prim: [[u32; 16]; 1],
}

/// `RTCRayHit16` of Embree 4.3 and later.
#[repr(C, align(64))]
#[derive(Clone, Copy, Debug)]
pub struct RayHit16 {
    /// The rays.
    pub ray: Ray16,
    /// Their hits.
    pub hit: Hit16,
}

impl RayHit16 {
    /// 16 rays that start nowhere and reach nothing, without hits.
    pub const fn empty() -> Self {
        let ray = Ray16 {
            origin: [[0.0; 16]; 3],
            tnear: [0.0; 16],
            direction: [[1.0; 16]; 3],
            time: [0.0; 16],
            tfar: [f32::NEG_INFINITY; 16],
            mask: [u32::MAX; 16],
            id: [0; 16],
            flags: [0; 16],
        };
        let none = [u32::MAX; 16];
        let hit = Hit16 {
            normal: [[0.0; 16]; 3],
            u: [0.0; 16],
            v: [0.0; 16],
            prim: none,
            geom: none,
            inst: [none],
            inst_prim: [none],
        };
        Self { ray, hit }
    }

    /// Puts a ray without a hit into one lane.
    ///
    /// # Panics
    /// If `lane` is 16 or more.
    #[inline]
    pub fn set(&mut self, lane: usize, ray: &Ray1) {
        for axis in 0..3 {
            self.ray.origin[axis][lane] = ray.origin[axis];
            self.ray.direction[axis][lane] = ray.direction[axis];
        }
        self.ray.tnear[lane] = ray.tnear;
        self.ray.tfar[lane] = ray.tfar;
        self.hit.geom[lane] = u32::MAX;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sys::QueryArguments;
    use std::mem::{align_of, offset_of};

    /// Sizes and offsets as a C compiler gives them for the headers of Embree 4.3.3 and 4.4.0.
    #[test]
    fn layouts_are_those_of_the_headers() {
        assert_eq!((size_of::<RayHit1>(), align_of::<RayHit1>()), (96, 16));
        assert_eq!((size_of::<Ray1>(), offset_of!(RayHit1, hit)), (48, 48));
        assert_eq!((offset_of!(Ray1, tfar), offset_of!(Hit1, prim)), (32, 20));
        assert_eq!((offset_of!(Hit1, inst), offset_of!(Hit1, inst_prim)), (28, 32));
        assert_eq!((size_of::<RayHit16>(), align_of::<RayHit16>()), (1344, 64));
        assert_eq!((size_of::<Ray16>(), offset_of!(RayHit16, hit)), (768, 768));
        assert_eq!((offset_of!(Ray16, tfar), offset_of!(Hit16, prim)), (512, 320));
        assert_eq!((offset_of!(Hit16, geom), offset_of!(Hit16, inst_prim)), (384, 512));
        assert_eq!(offset_of!(QueryArguments, context), 8);
        assert_eq!(offset_of!(QueryArguments, min_width_distance_factor), 32);
    }
}
