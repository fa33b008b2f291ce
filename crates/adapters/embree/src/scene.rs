//! Scenes and the queries on them.

use std::borrow::Cow;
use std::ptr::NonNull;

use accel::{Hit, Mesh, Ray, Solid, Vec3, vec_bytes};

use embree4_sys::{
    self as sys, RTC_INVALID_GEOMETRY_ID, RTCBufferType, RTCBuildQuality, RTCFormat, RTCGeometryType, RTCHit,
    RTCIntersectArguments, RTCOccludedArguments, RTCRay, RTCRayHit, RTCRayQueryFlags, RTCSceneFlags,
};

use crate::device::{Device, EmbreeError, MemoryUse, no_handle};
use crate::packet::{self, Active, packet};
use crate::solids::{Attached, SolidKinds};

/// How much time a build may take.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Quality {
    /// `RTC_BUILD_QUALITY_LOW`: Morton order.
    Low,
    /// `RTC_BUILD_QUALITY_MEDIUM`: surface-area heuristic.
    #[default]
    Medium,
    /// `RTC_BUILD_QUALITY_HIGH`: with spatial splits, which robust and compact scenes lose.
    High,
}

impl Quality {
    /// All of them, the fastest to build first.
    pub const ALL: [Self; 3] = [Self::Low, Self::Medium, Self::High];

    /// Its name as a setting.
    pub const fn id(self) -> &'static str {
        match self {
            Self::Low => "low",
            Self::Medium => "medium",
            Self::High => "high",
        }
    }

    const fn code(self) -> RTCBuildQuality {
        match self {
            Self::Low => RTCBuildQuality::LOW,
            Self::Medium => RTCBuildQuality::MEDIUM,
            Self::High => RTCBuildQuality::HIGH,
        }
    }
}

/// How a scene is built.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SceneSettings {
    /// Time allowed for the build.
    pub quality: Quality,
    /// `RTC_SCENE_FLAG_ROBUST`: no misses at shared edges.
    pub robust: bool,
    /// `RTC_SCENE_FLAG_COMPACT`: less memory; reads the scene's own vertices.
    pub compact: bool,
}

/// What Embree may assume of the rays of a packet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coherence {
    /// Nothing: `RTC_RAY_QUERY_FLAG_INCOHERENT`.
    Incoherent,
    /// They go the same way: `RTC_RAY_QUERY_FLAG_COHERENT`. It decides no more than the time, and which of hits at
    /// the same distance is found.
    Coherent,
}

/// Arguments of queries.
struct Arguments {
    intersect: RTCIntersectArguments,
    occluded: RTCOccludedArguments,
}

impl Arguments {
    const fn new(flags: RTCRayQueryFlags) -> Self {
        Self { intersect: RTCIntersectArguments::new(flags), occluded: RTCOccludedArguments::new(flags) }
    }
}

static INCOHERENT: Arguments = Arguments::new(RTCRayQueryFlags::INCOHERENT);
static COHERENT: Arguments = Arguments::new(RTCRayQueryFlags::COHERENT);

impl Coherence {
    const fn arguments(self) -> &'static Arguments {
        match self {
            Self::Incoherent => &INCOHERENT,
            Self::Coherent => &COHERENT,
        }
    }
}

/// A committed scene: one triangle mesh, whose buffers it reads where they lie, or solids.
///
/// Rays: t_min below 0 counts as 0, and a hit at t_min itself is no hit (Embree's ranges are open
/// at their start); a triangle with a coordinate beyond 1.8e18 is left out by Embree.
pub struct EmbreeScene<'m> {
    handle: NonNull<sys::RTCSceneTy>,
    /// Released after the scene.
    device: Device,
    /// What Embree reads; borrowed where the last position can be read with 16 bytes.
    positions: Cow<'m, [Vec3]>,
    positions_copied: usize,
    _triangles: &'m [[u32; 3]],
    /// What Embree calls back for solids, and their numbers.
    solids: Option<Attached<'m>>,
}

// SAFETY: a committed scene is only read by queries, which Embree allows from any thread and from
// several at once; the buffers are only read.
unsafe impl Send for EmbreeScene<'_> {}
// SAFETY: as above.
unsafe impl Sync for EmbreeScene<'_> {}

impl<'m> EmbreeScene<'m> {
    /// Builds with as many threads as `device` was made with. The device serves this scene alone, so
    /// that its memory is the scene's.
    ///
    /// The mesh's buffers are shared with Embree. Embree reads 16 bytes at each position, so 4 bytes
    /// past the last: where the vector of positions has no spare capacity, they are copied.
    ///
    /// # Errors
    /// If a triangle names a position that there is not, or Embree fails.
    pub fn new(device: Device, mesh: &'m Mesh, settings: SceneSettings) -> Result<Self, EmbreeError> {
        check_indices(mesh)?;
        let mut scene = Self::begin(device, settings)?;
        (scene.positions, scene.positions_copied) = readable_by_16_bytes(&mesh.positions);
        scene._triangles = mesh.triangles.as_slice();
        if !mesh.triangles.is_empty() {
            scene.attach(&mesh.triangles, settings.quality)?;
        }
        scene.commit()
    }

    /// Of solids: as user geometry, or as geometry of Embree's own where it has the kind.
    ///
    /// # Errors
    /// If Embree fails.
    pub fn of_solids(
        device: Device,
        solids: &'m [Solid],
        kinds: SolidKinds,
        settings: SceneSettings,
    ) -> Result<Self, EmbreeError> {
        let mut scene = Self::begin(device, settings)?;
        // SAFETY: device and scene are live, and what is attached is kept as long as the scene.
        let attached = unsafe { Attached::to(&scene.device, scene.handle.as_ptr(), solids, kinds) }?;
        scene.solids = Some(attached);
        scene.commit()
    }

    /// A scene without geometry.
    fn begin(device: Device, settings: SceneSettings) -> Result<Self, EmbreeError> {
        // SAFETY: the device is live.
        let handle = unsafe { sys::rtcNewScene(device.handle()) };
        let Some(handle) = NonNull::new(handle) else {
            device.check("making a scene")?;
            return Err(no_handle("making a scene"));
        };
        let positions = Cow::Borrowed([].as_slice());
        let scene = Self { handle, device, positions, positions_copied: 0, _triangles: &[], solids: None };
        let flag = |flag, set| if set { flag } else { RTCSceneFlags::NONE };
        let flags =
            flag(RTCSceneFlags::ROBUST, settings.robust) | flag(RTCSceneFlags::COMPACT, settings.compact);
        // SAFETY: the handle is live.
        unsafe {
            sys::rtcSetSceneFlags(scene.handle.as_ptr(), flags);
            sys::rtcSetSceneBuildQuality(scene.handle.as_ptr(), settings.quality.code());
        }
        scene.device.check("setting up a scene")?;
        Ok(scene)
    }

    fn commit(self) -> Result<Self, EmbreeError> {
        // SAFETY: the handle is live, and every index was checked.
        unsafe { sys::rtcCommitScene(self.handle.as_ptr()) };
        self.device.check("building a scene")?;
        Ok(self)
    }

    fn attach(&self, triangles: &[[u32; 3]], quality: Quality) -> Result<(), EmbreeError> {
        // SAFETY: the device is live.
        let geometry = unsafe { sys::rtcNewGeometry(self.device.handle(), RTCGeometryType::TRIANGLE) };
        if geometry.is_null() {
            self.device.check("making a geometry")?;
            return Err(no_handle("making a geometry"));
        }
        // SAFETY: the geometry is live. Both buffers hold as many items as is said, stay where they
        // are and unchanged while the scene lives (they are borrowed or owned by it), and the last
        // position is followed by at least 4 bytes of the same allocation. The scene keeps a
        // reference to the geometry, so ours is released.
        unsafe {
            sys::rtcSetSharedGeometryBuffer(
                geometry,
                RTCBufferType::VERTEX,
                0,
                RTCFormat::FLOAT3,
                self.positions.as_ptr().cast(),
                0,
                size_of::<Vec3>(),
                self.positions.len(),
            );
            sys::rtcSetSharedGeometryBuffer(
                geometry,
                RTCBufferType::INDEX,
                0,
                RTCFormat::UINT3,
                triangles.as_ptr().cast(),
                0,
                size_of::<[u32; 3]>(),
                triangles.len(),
            );
            sys::rtcSetGeometryBuildQuality(geometry, quality.code());
            sys::rtcCommitGeometry(geometry);
            sys::rtcAttachGeometry(self.handle.as_ptr(), geometry);
            sys::rtcReleaseGeometry(geometry);
        }
        self.device.check("attaching triangles")
    }

    /// The nearest hit of one ray (`rtcIntersect1`).
    #[inline]
    pub fn closest(&self, ray: &Ray) -> Option<Hit> {
        let mut rayhit = RTCRayHit { ray: single(ray), hit: RTCHit::default() };
        self.intersect1(&mut rayhit);
        if rayhit.hit.geomID == RTC_INVALID_GEOMETRY_ID {
            return None;
        }
        let mut hit = found(&rayhit);
        if let Some(solids) = &self.solids {
            hit.object = solids.object(rayhit.hit.geomID, hit.object);
        }
        Some(hit)
    }

    /// `rtcIntersect1` as it is, for those who keep rays in Embree's layout.
    #[inline]
    pub fn intersect1(&self, rayhit: &mut RTCRayHit) {
        // SAFETY: the scene is committed; the ray-hit has the alignment and the room that Embree 4.0 to 4.4 write to;
        // the arguments are only read.
        unsafe {
            sys::rtcIntersect1(self.handle.as_ptr(), rayhit, (&raw const INCOHERENT.intersect).cast_mut())
        };
    }

    /// Whether one ray hits anything (`rtcOccluded1`).
    #[inline]
    pub fn occluded(&self, ray: &Ray) -> bool {
        let mut ray = single(ray);
        // SAFETY: as for `intersect1`.
        unsafe {
            sys::rtcOccluded1(self.handle.as_ptr(), &raw mut ray, (&raw const INCOHERENT.occluded).cast_mut())
        };
        ray.tfar == f32::NEG_INFINITY
    }

    /// The nearest hits of up to 16 rays (`rtcIntersect16`).
    ///
    /// # Panics
    /// If there are more than 16 rays, or fewer places for hits than rays.
    #[inline]
    pub fn closest16(&self, rays: &[Ray], coherence: Coherence, hits: &mut [Option<Hit>]) {
        let mut packet = packet(rays);
        let active = Active::first(rays.len());
        let arguments = (&raw const coherence.arguments().intersect).cast_mut();
        // SAFETY: as for `intersect1`, with the layout of 16; the mask is aligned to 64 bytes.
        unsafe { sys::rtcIntersect16(active.as_ptr(), self.handle.as_ptr(), &raw mut packet, arguments) };
        for (lane, hit) in hits[..rays.len()].iter_mut().enumerate() {
            *hit = packet::hit(&packet, lane);
            if let (Some(solids), Some(hit)) = (&self.solids, hit) {
                hit.object = solids.object(packet.hit.geomID[lane], hit.object);
            }
        }
    }

    /// Whether up to 16 rays hit anything (`rtcOccluded16`).
    ///
    /// # Panics
    /// If there are more than 16 rays, or fewer places than rays.
    #[inline]
    pub fn occluded16(&self, rays: &[Ray], coherence: Coherence, occluded: &mut [bool]) {
        let mut packet = packet(rays).ray;
        let active = Active::first(rays.len());
        let arguments = (&raw const coherence.arguments().occluded).cast_mut();
        // SAFETY: as for `closest16`.
        unsafe { sys::rtcOccluded16(active.as_ptr(), self.handle.as_ptr(), &raw mut packet, arguments) };
        for (lane, occluded) in occluded[..rays.len()].iter_mut().enumerate() {
            *occluded = packet.tfar[lane] == f32::NEG_INFINITY;
        }
    }

    /// What Embree holds for this scene and held at most while building it, by its memory monitor.
    pub fn memory(&self) -> MemoryUse {
        self.device.memory()
    }

    /// Bytes of positions that were copied because they could not be shared; mostly 0.
    pub fn copied_bytes(&self) -> usize {
        self.positions_copied
    }

    /// Bytes of what Embree calls back for solids, and of their numbers.
    pub fn solid_bytes(&self) -> usize {
        self.solids.as_ref().map_or(0, Attached::bytes)
    }

    /// Version of Embree: major, minor, patch.
    pub fn version(&self) -> (u32, u32, u32) {
        self.device.version()
    }

    #[cfg(test)]
    pub(crate) fn handle(&self) -> *mut sys::RTCSceneTy {
        self.handle.as_ptr()
    }
}

impl Drop for EmbreeScene<'_> {
    fn drop(&mut self) {
        // SAFETY: the handle is live and this is its only reference; device and buffers go after it.
        unsafe { sys::rtcReleaseScene(self.handle.as_ptr()) };
    }
}

/// Embree trusts indices; a wrong one would be read out of bounds.
pub(crate) fn check_indices(mesh: &Mesh) -> Result<(), EmbreeError> {
    let positions = mesh.positions.len();
    for (triangle, corners) in mesh.triangles.iter().enumerate() {
        if let Some(&position) = corners.iter().find(|&&corner| corner as usize >= positions) {
            return Err(EmbreeError::Index { triangle, position, positions });
        }
    }
    Ok(())
}

/// The positions in memory that goes on for at least one more, and the bytes copied for it.
fn readable_by_16_bytes(positions: &Vec<Vec3>) -> (Cow<'_, [Vec3]>, usize) {
    if positions.capacity() > positions.len() {
        return (Cow::Borrowed(positions), 0);
    }
    let mut padded = Vec::with_capacity(positions.len() + 1);
    padded.extend_from_slice(positions);
    let bytes = vec_bytes(&padded);
    (Cow::Owned(padded), bytes)
}

/// A ray that sees every geometry.
#[inline]
pub(crate) fn single(ray: &Ray) -> RTCRay {
    RTCRay {
        org_x: ray.origin.x,
        org_y: ray.origin.y,
        org_z: ray.origin.z,
        tnear: ray.t_min,
        dir_x: ray.direction.x,
        dir_y: ray.direction.y,
        dir_z: ray.direction.z,
        tfar: ray.t_max,
        ..RTCRay::default()
    }
}

/// The hit of a ray that hit something.
#[inline]
pub(crate) fn found(rayhit: &RTCRayHit) -> Hit {
    Hit { t: rayhit.ray.tfar, object: rayhit.hit.primID, u: rayhit.hit.u, v: rayhit.hit.v }
}

#[cfg(test)]
mod tests;
