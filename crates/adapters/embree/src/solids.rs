//! Solids in Embree: as user geometry, whose test is the suite's, or as geometry of Embree's own.

use std::ffi::{c_int, c_void};

use accel::{Aabb, Objects, Ray, Solid, Vec3, vec_bytes};
use embree4_sys::{
    self as sys, RTCBoundsFunctionArguments, RTCBufferType, RTCFormat, RTCGeometry, RTCGeometryType,
    RTCIntersectFunctionNArguments,
};
use solids::Solids;

use crate::device::{Device, EmbreeError, no_handle};

/// How solids are given to Embree.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SolidKinds {
    /// All as user geometry: Embree's tree over the suite's tests.
    #[default]
    User,
    /// Triangles, spheres, discs and the mantles of cones as Embree's own; what it has no kind for as user geometry.
    Native,
}

impl SolidKinds {
    /// Both.
    pub const ALL: [Self; 2] = [Self::User, Self::Native];

    /// Its name as a setting.
    pub const fn id(self) -> &'static str {
        match self {
            Self::User => "user",
            Self::Native => "native",
        }
    }

    fn of(self, solid: &Solid) -> Kind {
        match (self, solid) {
            (Self::Native, Solid::Triangle(_)) => Kind::Triangles,
            (Self::Native, Solid::Sphere(_)) => Kind::Spheres,
            (Self::Native, Solid::Disc(_)) => Kind::Discs,
            (Self::Native, Solid::Cone(_)) => Kind::Cones,
            _ => Kind::User,
        }
    }
}

/// A geometry each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Triangles,
    Spheres,
    Discs,
    Cones,
    User,
}

impl Kind {
    const ALL: [Self; 5] = [Self::Triangles, Self::Spheres, Self::Discs, Self::Cones, Self::User];

    const fn geometry(self) -> RTCGeometryType {
        match self {
            Self::Triangles => RTCGeometryType::TRIANGLE,
            Self::Spheres => RTCGeometryType::SPHERE_POINT,
            Self::Discs => RTCGeometryType::ORIENTED_DISC_POINT,
            Self::Cones => RTCGeometryType::CONE_LINEAR_CURVE,
            Self::User => RTCGeometryType::USER,
        }
    }
}

/// The solids that a scene calls back for.
struct User<'s> {
    solids: Solids<'s>,
    numbers: Vec<u32>,
}

/// Solids attached to a scene.
pub struct Attached<'s> {
    /// Where it is must not change: Embree has its address.
    _user: Box<User<'s>>,
    /// By geometry, the numbers of its objects.
    numbers: Vec<Vec<u32>>,
}

impl<'s> Attached<'s> {
    /// Attaches solids to a scene of this device.
    ///
    /// # Safety
    /// Device and scene are live, and what is returned is kept as long as the scene is asked.
    pub unsafe fn to(
        device: &Device,
        scene: sys::RTCScene,
        solids: &'s [Solid],
        kinds: SolidKinds,
    ) -> Result<Self, EmbreeError> {
        let of = |kind| -> Vec<u32> {
            (0..solids.len() as u32).filter(|id| kinds.of(&solids[*id as usize]) == kind).collect()
        };
        let user = Box::new(User { solids: Solids::new(solids), numbers: of(Kind::User) });
        let mut numbers = Vec::new();
        for kind in Kind::ALL {
            let ids = of(kind);
            if ids.is_empty() {
                continue;
            }
            // SAFETY: the device is live.
            let geometry = unsafe { sys::rtcNewGeometry(device.handle(), kind.geometry()) };
            if geometry.is_null() {
                device.check("making a geometry")?;
                return Err(no_handle("making a geometry"));
            }
            let objects = ids.iter().map(|id| &solids[*id as usize]);
            match kind {
                Kind::User => {
                    let data = std::ptr::from_ref(&*user).cast_mut().cast::<c_void>();
                    // SAFETY: the geometry is live; the functions match what is declared of them and only read the data,
                    // which is of the type that they take it for and outlives the scene.
                    unsafe {
                        sys::rtcSetGeometryUserPrimitiveCount(geometry, ids.len() as u32);
                        sys::rtcSetGeometryUserData(geometry, data);
                        sys::rtcSetGeometryBoundsFunction(geometry, Some(bounds), std::ptr::null_mut());
                        sys::rtcSetGeometryIntersectFunction(geometry, Some(intersect));
                        sys::rtcSetGeometryOccludedFunction(geometry, Some(occluded));
                    }
                }
                _ => fill(geometry, kind, objects),
            }
            // SAFETY: geometry and scene are live. The scene keeps a reference to the geometry, so ours is released.
            let number = unsafe {
                sys::rtcCommitGeometry(geometry);
                let number = sys::rtcAttachGeometry(scene, geometry);
                sys::rtcReleaseGeometry(geometry);
                number as usize
            };
            device.check("attaching solids")?;
            numbers.resize(numbers.len().max(number + 1), Vec::new());
            numbers[number] = ids;
        }
        Ok(Self { _user: user, numbers })
    }

    /// The number of an object of a geometry.
    #[inline]
    pub fn object(&self, geometry: u32, primitive: u32) -> u32 {
        self.numbers[geometry as usize][primitive as usize]
    }

    /// Bytes on the heap.
    pub fn bytes(&self) -> usize {
        let numbers: usize = self.numbers.iter().map(vec_bytes).sum();
        numbers + vec_bytes(&self.numbers) + size_of::<User<'_>>() + vec_bytes(&self._user.numbers)
    }
}

/// Fills buffers of Embree's own with objects of a kind that it has.
fn fill<'a>(geometry: RTCGeometry, kind: Kind, objects: impl Iterator<Item = &'a Solid>) {
    // Normals take 16 bytes each, for Embree reads as many, and makes no room behind the last as it does behind corners.
    let (mut points, mut normals): (Vec<[f32; 4]>, Vec<[f32; 4]>) = (Vec::new(), Vec::new());
    let with = |p: Vec3, radius: f32| [p.x, p.y, p.z, radius];
    for solid in objects {
        match solid {
            Solid::Triangle(corners) => points.extend(corners.map(|corner| with(corner, 0.0))),
            Solid::Sphere(sphere) => points.push(with(sphere.center, sphere.radius)),
            Solid::Disc(disc) => {
                points.push(with(disc.center, disc.radius));
                normals.push(with(disc.normal, 0.0));
            }
            Solid::Cone(cone) => {
                points.extend([with(cone.base, cone.base_radius), with(cone.top, cone.top_radius)]);
            }
            _ => {}
        }
    }
    match kind {
        Kind::Triangles => {
            let corners: Vec<[f32; 3]> = points.iter().map(|[x, y, z, _]| [*x, *y, *z]).collect();
            let indices: Vec<[u32; 3]> =
                (0..corners.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
            buffer(geometry, RTCBufferType::VERTEX, RTCFormat::FLOAT3, &corners);
            buffer(geometry, RTCBufferType::INDEX, RTCFormat::UINT3, &indices);
        }
        Kind::Cones => {
            let first: Vec<u32> = (0..points.len() as u32 / 2).map(|i| 2 * i).collect();
            buffer(geometry, RTCBufferType::VERTEX, RTCFormat::FLOAT4, &points);
            buffer(geometry, RTCBufferType::INDEX, RTCFormat::UINT, &first);
        }
        Kind::Discs => {
            buffer(geometry, RTCBufferType::VERTEX, RTCFormat::FLOAT4, &points);
            buffer(geometry, RTCBufferType::NORMAL, RTCFormat::FLOAT3, &normals);
        }
        Kind::Spheres => buffer(geometry, RTCBufferType::VERTEX, RTCFormat::FLOAT4, &points),
        Kind::User => {}
    }
}

fn buffer<T: Copy>(geometry: RTCGeometry, kind: RTCBufferType, format: RTCFormat, items: &[T]) {
    // SAFETY: the geometry is live, and was made by the caller.
    let room = unsafe {
        sys::rtcSetNewGeometryBuffer(geometry, kind, 0, format, size_of::<T>(), items.len()).cast::<T>()
    };
    if !room.is_null() {
        // SAFETY: Embree has made room for so many items of this size, aligned to 16 bytes, which nobody else knows of.
        unsafe { room.copy_from_nonoverlapping(items.as_ptr(), items.len()) };
    }
}

/// # Safety
/// Called by Embree with the data of a geometry made by [`Attached::to`].
unsafe extern "C" fn bounds(arguments: *const RTCBoundsFunctionArguments) {
    // SAFETY: Embree gives arguments that are live for the call, with the data that was set and room for bounds.
    let (user, arguments, out) = unsafe {
        let arguments = &*arguments;
        (&*arguments.geometryUserPtr.cast::<User<'_>>(), arguments, &mut *arguments.bounds_o)
    };
    let Aabb { min, max } = user.solids.bounds(user.numbers[arguments.primID as usize]);
    (out.lower_x, out.lower_y, out.lower_z) = (min.x, min.y, min.z);
    (out.upper_x, out.upper_y, out.upper_z) = (max.x, max.y, max.z);
}

/// Where fields of N rays and their hits begin, in units of N words.
mod field {
    pub const ORIGIN: usize = 0;
    pub const NEAR: usize = 3;
    pub const DIRECTION: usize = 4;
    pub const FAR: usize = 8;
    pub const U: usize = 15;
    pub const V: usize = 16;
    pub const PRIMITIVE: usize = 17;
    pub const GEOMETRY: usize = 18;
}

/// Calls `found` with the words, the lane and the hit of every ray that meets the object.
///
/// # Safety
/// As for [`bounds`], with N rays or rays with hits in words.
#[inline(always)]
unsafe fn each_hit(
    arguments: *const RTCIntersectFunctionNArguments,
    found: impl Fn(*mut f32, usize, usize, accel::Surface),
) {
    // SAFETY: Embree gives arguments that are live for the call, with the data that was set.
    let (user, arguments) = unsafe {
        let arguments = &*arguments;
        (&*arguments.geometryUserPtr.cast::<User<'_>>(), arguments)
    };
    let (count, words) = (arguments.N as usize, arguments.rayhit.cast::<f32>());
    let object = user.numbers[arguments.primID as usize];
    for lane in 0..count {
        // SAFETY: there are N entries of `valid`, and N of each field.
        let (valid, ray): (c_int, Ray) = unsafe {
            let at = |field: usize| *words.add(field * count + lane);
            let three = |field: usize| Vec3::new(at(field), at(field + 1), at(field + 2));
            let ray = Ray {
                origin: three(field::ORIGIN),
                direction: three(field::DIRECTION),
                t_min: at(field::NEAR),
                t_max: at(field::FAR),
            };
            (*arguments.valid.add(lane), ray)
        };
        if valid != 0
            && let Some(surface) = user.solids.intersect(object, &ray, ray.t_max)
        {
            found(words, count, lane, surface);
        }
    }
}

/// # Safety
/// As for [`bounds`], with N rays with hits.
unsafe extern "C" fn intersect(arguments: *const RTCIntersectFunctionNArguments) {
    // SAFETY: as the caller says; there are N of each field of the hits, which are written whole.
    unsafe {
        let (primitive, geometry) = ((*arguments).primID, (*arguments).geomID);
        each_hit(arguments, |words, count, lane, surface| {
            *words.add(field::FAR * count + lane) = surface.t;
            *words.add(field::U * count + lane) = surface.u;
            *words.add(field::V * count + lane) = surface.v;
            *words.add(field::PRIMITIVE * count + lane).cast::<u32>() = primitive;
            *words.add(field::GEOMETRY * count + lane).cast::<u32>() = geometry;
        });
    }
}

/// # Safety
/// As for [`bounds`], with N rays.
unsafe extern "C" fn occluded(arguments: *const RTCIntersectFunctionNArguments) {
    // SAFETY: as the caller says.
    unsafe {
        each_hit(arguments, |words, count, lane, _| {
            *words.add(field::FAR * count + lane) = f32::NEG_INFINITY;
        });
    }
}

#[cfg(test)]
mod tests;
