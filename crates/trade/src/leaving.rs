//! Rays that leave surfaces: how many hit the surface that they leave, and how many begin beyond another.

use accel::{Corners, Geometry, Hit, Ray, RaySet, Scene, Workload};
use harness::registry::{self, guarded_build};
use judge::{Bounds, Judge, Spread, Tolerance};
use primitives::KernelId;
use scenes::rays::perspective;
use serde::{Deserialize, Serialize};

/// How rays are kept from the surface that they leave.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Offset {
    /// They begin at the hit point, rounded.
    None,
    /// t begins at 10^-4 of the scene's extent, whatever the ray.
    Constant,
    /// The hit point moves along the normal by 256 units in the last place, near 0 by 2^-16 (Wächter and Binder, A Fast and Robust
    /// Method for Avoiding Self-Intersection, Ray Tracing Gems 2019, chapter 6).
    Floats,
    /// The point is computed from the surface coordinates and moves along the normal by the bound of its error (Pharr, Jakob and
    /// Humphreys, Physically Based Rendering, §6.8.6 in the fourth edition).
    Bound,
}

impl Offset {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::None, Self::Constant, Self::Floats, Self::Bound];

    /// In words.
    pub const fn words(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Constant => "10^-4 of the extent in t",
            Self::Floats => "256 units in the last place",
            Self::Bound => "error bound",
        }
    }
}

/// What became of the rays of a kernel with an offset.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Leaving {
    /// Scene.
    pub scene: String,
    /// The kernel that found the hits and traces the rays on.
    pub kernel: String,
    /// How they are kept from the surface.
    pub offset: Offset,
    /// Rays that leave.
    pub rays: u64,
    /// Of them, those reported to hit the object that they leave.
    pub own: u64,
    /// The 95 % interval of their share.
    pub own_bounds: Bounds,
    /// At what distance from the hit point, in extents.
    pub own_distance: Spread,
    /// Rays that begin beyond another object than the one that they leave.
    pub through: u64,
    /// The 95 % interval of their share.
    pub through_bounds: Bounds,
    /// How far from the hit point rays begin, in extents.
    pub start: Spread,
}

/// Kernels that are looked at, in `ssm`; which structure it is makes no difference to their answers.
const KERNELS: [KernelId; 4] =
    [KernelId::MollerTrumbore, KernelId::Watertight, KernelId::Double, KernelId::Exact];

/// Every kernel and offset on the hits of an image of `size` rows and columns.
pub fn of(scene: &Scene, size: u32) -> Vec<Leaving> {
    let Geometry::Triangles(mesh) = &scene.geometry else { return Vec::new() };
    let judge = Judge::new(scene, Tolerance::VISIBLE);
    let unit = if judge.extent() > 0.0 { judge.extent() } else { 1.0 };
    let image = RaySet::Raster(perspective(&scene.view, size, size));
    let mut all = Vec::new();
    for kernel in KERNELS {
        let Ok(choice) = registry::parse(&format!("ssm:kernel={kernel}")) else { continue };
        let Ok(accel) = guarded_build(&choice, scene, &Workload::GENERAL) else { continue };
        let mut hits = vec![None; image.len()];
        accel.trace(&image, &mut hits);
        let found: Vec<(Ray, Hit)> =
            hits.iter().enumerate().filter_map(|(i, hit)| Some((image.ray(i), (*hit)?))).collect();
        for offset in Offset::ALL {
            let starts: Vec<Start> = found
                .iter()
                .enumerate()
                .map(|(i, (ray, hit))| leave(ray, hit, &mesh.corners(hit.object as usize), offset, unit, i))
                .collect();
            let rays = RaySet::List(starts.iter().map(|start| start.ray).collect());
            let mut hits = vec![None; rays.len()];
            accel.trace(&rays, &mut hits);
            let mut own = Vec::new();
            let mut through = 0;
            let mut far = Vec::new();
            for ((start, hit), (_, left)) in starts.iter().zip(&hits).zip(&found) {
                far.push(start.way.direction.as_dvec3().length() / unit);
                if let Some(hit) = hit.filter(|hit| hit.object == left.object) {
                    let at = start.ray.origin.as_dvec3() + start.ray.direction.as_dvec3() * f64::from(hit.t)
                        - start.way.origin.as_dvec3();
                    own.push(at.length() / unit);
                }
                let crossed =
                    start.way.validate().is_ok().then(|| judge.oracle().closest(&start.way)).flatten();
                through += u64::from(crossed.is_some_and(|(object, hit)| {
                    let t = hit.t.to_f64();
                    object != left.object && t > 0.0 && t < 1.0
                }));
            }
            let (rays, count) = (rays.len() as u64, own.len() as u64);
            all.push(Leaving {
                scene: scene.id.clone(),
                kernel: kernel.id().to_owned(),
                offset,
                rays,
                own: count,
                own_bounds: Bounds::of(count, rays),
                own_distance: Spread::of(&mut own),
                through,
                through_bounds: Bounds::of(through, rays),
                start: Spread::of(&mut far),
            });
        }
    }
    all
}

/// A ray that leaves, and the way from the hit point to where it begins, at t = 1.
struct Start {
    ray: Ray,
    way: Ray,
}

/// The ray number `i` that leaves a hit, into the hemisphere that the first ray came from.
fn leave(ray: &Ray, hit: &Hit, corners: &Corners, offset: Offset, extent: f64, i: usize) -> Start {
    let [a, b, c] = *corners;
    let normal = (b - a).as_dvec3().cross((c - a).as_dvec3()).normalize_or_zero();
    let towards = -ray.direction.as_dvec3().normalize_or_zero();
    let normal = if normal.dot(towards) < 0.0 { -normal } else { normal }.as_vec3();
    let direction = {
        // Evenly over the sphere by golden angles (Vogel 1979), then towards the normal: by the cosine.
        let z = 1.0 - 2.0 * ((i as f64 * 0.754_877_666_246_692_8).fract());
        let angle = i as f64 * 2.399_963_229_728_653;
        let ring = (1.0 - z * z).sqrt();
        let around = accel::Vec3::new((ring * angle.cos()) as f32, (ring * angle.sin()) as f32, z as f32);
        let sum = normal + around;
        if sum.length() > 1e-3 { sum.normalize() } else { normal }
    };
    let plain = ray.at(hit.t);
    let (point, t_min, origin) = match offset {
        Offset::None => (plain, 0.0, plain),
        Offset::Constant => (plain, (1e-4 * extent) as f32, plain),
        Offset::Floats => (plain, 0.0, by_floats(plain, normal)),
        Offset::Bound => {
            let w = 1.0 - hit.u - hit.v;
            let point = a * w + b * hit.u + c * hit.v;
            let size = (a * w).abs() + (b * hit.u).abs() + (c * hit.v).abs();
            (point, 0.0, by_bound(point, size * gamma(7), normal))
        }
    };
    let begin = if t_min > 0.0 { origin + direction * t_min } else { origin };
    Start {
        ray: Ray { t_min, ..Ray::new(origin, direction) },
        way: Ray { t_max: 1.0, ..Ray::new(point, begin - point) },
    }
}

/// The bound of the relative error of n roundings.
fn gamma(n: u32) -> f32 {
    let unit = f64::from(f32::EPSILON) * 0.5 * f64::from(n);
    (unit / (1.0 - unit)) as f32
}

fn by_floats(p: accel::Vec3, normal: accel::Vec3) -> accel::Vec3 {
    const NEAR: f32 = 1.0 / 32.0;
    let one = |p: f32, n: f32| {
        if p.abs() < NEAR {
            return p + n / 65536.0;
        }
        let units = (256.0 * n) as i32;
        f32::from_bits((p.to_bits() as i32 + if p < 0.0 { -units } else { units }) as u32)
    };
    accel::Vec3::new(one(p.x, normal.x), one(p.y, normal.y), one(p.z, normal.z))
}

fn by_bound(p: accel::Vec3, error: accel::Vec3, normal: accel::Vec3) -> accel::Vec3 {
    let off = normal * normal.abs().dot(error);
    let one = |p: f32, off: f32| match p + off {
        moved if off > 0.0 => moved.next_up(),
        moved if off < 0.0 => moved.next_down(),
        moved => moved,
    };
    accel::Vec3::new(one(p.x, off.x), one(p.y, off.y), one(p.z, off.z))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rays_without_offset_hit_what_they_leave_and_bounds_keep_them_from_it() {
        let scene = scenes::load(&"bumps-1k".parse().unwrap()).unwrap();
        let all = of(&scene, 48);
        assert_eq!(all.len(), KERNELS.len() * Offset::ALL.len());
        let sum = |offset| all.iter().filter(|row| row.offset == offset).map(|row| row.own).sum::<u64>();
        assert!(all.iter().all(|row| row.rays > 500));
        assert!(sum(Offset::None) > 0);
        assert_eq!((sum(Offset::Bound), sum(Offset::Constant)), (0, 0));
        let start = |offset| all.iter().find(|row| row.offset == offset).unwrap().start.median;
        assert!(start(Offset::None) == 0.0 && start(Offset::Bound) < start(Offset::Constant));
    }

    #[test]
    fn a_wall_nearer_than_the_offset_is_slipped_through() {
        let square =
            |z: f32| [(-1.0, -1.0), (3.0, -1.0), (-1.0, 3.0)].map(|(x, y)| accel::Vec3::new(x, y, z));
        let corners = square(0.0);
        let ray = Ray::new(accel::Vec3::new(0.1, 0.1, 1e-5), accel::Vec3::NEG_Z);
        let hit = Hit { t: 1e-5, object: 0, u: 0.25, v: 0.25 };
        for (offset, beyond) in [(Offset::None, false), (Offset::Constant, true), (Offset::Bound, false)] {
            let start = leave(&ray, &hit, &corners, offset, 4.0, 0);
            let begin = start.way.origin + start.way.direction;
            assert_eq!(begin.z > 2e-5, beyond, "{offset:?}: {begin}");
        }
    }
}
