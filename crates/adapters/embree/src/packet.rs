//! Packets of up to 16 rays in Embree's layout.

use accel::{Hit, Ray};
use embree4_sys::{RTC_INVALID_GEOMETRY_ID, RTCHit16, RTCRay16, RTCRayHit16};

/// Rays that a packet holds.
pub const WIDTH: usize = 16;

/// Which rays of a packet are to be traced: −1 for yes, 0 for no.
#[repr(C, align(64))]
#[derive(Clone, Copy, Debug)]
pub struct Active([i32; WIDTH]);

impl Active {
    /// The first `count` rays of a packet.
    #[inline]
    pub fn first(count: usize) -> Self {
        Self(std::array::from_fn(|lane| if lane < count { -1 } else { 0 }))
    }

    /// What Embree is given.
    #[inline]
    pub const fn as_ptr(&self) -> *const i32 {
        self.0.as_ptr()
    }
}

/// Rays without hits; the lanes behind them start nowhere and reach nothing.
///
/// # Panics
/// If there are more than 16.
#[inline]
pub fn packet(rays: &[Ray]) -> RTCRayHit16 {
    assert!(rays.len() <= WIDTH, "a packet holds 16 rays");
    let mut packet = empty();
    let into = &mut packet.ray;
    for (lane, ray) in rays.iter().enumerate() {
        into.org_x[lane] = ray.origin.x;
        into.org_y[lane] = ray.origin.y;
        into.org_z[lane] = ray.origin.z;
        into.tnear[lane] = ray.t_min;
        into.dir_x[lane] = ray.direction.x;
        into.dir_y[lane] = ray.direction.y;
        into.dir_z[lane] = ray.direction.z;
        into.tfar[lane] = ray.t_max;
    }
    packet
}

/// The hit of one lane.
#[inline]
pub fn hit(packet: &RTCRayHit16, lane: usize) -> Option<Hit> {
    let hit = &packet.hit;
    (hit.geomID[lane] != RTC_INVALID_GEOMETRY_ID).then_some(Hit {
        t: packet.ray.tfar[lane],
        object: hit.primID[lane],
        u: hit.u[lane],
        v: hit.v[lane],
    })
}

/// Lanes that start nowhere and reach nothing.
#[inline]
fn empty() -> RTCRayHit16 {
    let none = [RTC_INVALID_GEOMETRY_ID; WIDTH];
    RTCRayHit16 {
        ray: RTCRay16 {
            dir_x: [1.0; WIDTH],
            tfar: [f32::NEG_INFINITY; WIDTH],
            mask: [u32::MAX; WIDTH],
            ..RTCRay16::default()
        },
        hit: RTCHit16 {
            primID: none,
            geomID: none,
            instID: [none],
            instPrimID: [none],
            ..RTCHit16::default()
        },
    }
}
