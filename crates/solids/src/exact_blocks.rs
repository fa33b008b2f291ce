//! Spheres in blocks, tested exactly: single precision rules out what is missed for certain, sixteen at a time.

use crate::blocks::{ManyRays, OneRay, SolidBlocks, precedes};
use crate::exact::{estimate, nearest, undecided};
use crate::group::{Part, Slot};
use crate::rows::{Spheres, load, splat};
use accel::solid::Sphere;
use accel::{Nearest, Surface, Vec3};
use lanes::packet::{Lanes, NearestPacket, RayRows};
use lanes::{ROW, Simd, ones};

/// Centre and radius of the sphere in each lane.
pub type SphereRows = [[f32; ROW]; 4];

/// The sphere in a lane.
#[inline(always)]
fn sphere([x, y, z, radius]: [&[f32; ROW]; 4], lane: usize) -> Sphere {
    Sphere { center: Vec3::new(x[lane], y[lane], z[lane]), radius: radius[lane] }
}

/// Where the rays of all lanes meet the spheres of theirs.
pub struct Met {
    /// Where those do that hit.
    pub t: [f32; ROW],
    /// The wanted lanes that hit.
    pub hits: u32,
}

impl Met {
    /// By [`estimate`] in all lanes, and by integers in the wanted ones that it leaves open.
    #[inline(always)]
    pub fn of<S: Simd>(spheres: &SphereRows, rays: &RayRows, wanted: u32) -> Self {
        let (mut t, mut hit, mut open) = ([0.0; ROW], [0; ROW], [0; ROW]);
        let [x, y, z, radius] = spheres;
        for lane in 0..S::LANES {
            let told = estimate([x[lane], y[lane], z[lane]], radius[lane], &rays.ray(lane));
            (t[lane], hit[lane], open[lane]) = (told.t, u32::from(told.hit), u32::from(told.open));
        }
        let mut met = Self { t, hits: bits(&hit) & wanted };
        for lane in ones(u64::from(bits(&open) & wanted)) {
            if let Some(t) = undecided(&sphere(spheres.each_ref(), lane), &rays.ray(lane)) {
                met.t[lane] = t;
                met.hits |= 1 << lane;
            }
        }
        met
    }
}

/// A bit for each lane that is not 0.
#[inline(always)]
fn bits(lanes: &[u32; ROW]) -> u32 {
    lanes.iter().enumerate().fold(0, |bits, (lane, value)| bits | value << lane)
}

impl SolidBlocks<'_> {
    /// The sphere in a slot against the near ones of `LANES` rays.
    #[inline(always)]
    pub(crate) fn exact_packed<S: Simd>(
        &self,
        s: S,
        slot: Slot<'_>,
        rays: &ManyRays<S>,
        best: &mut NearestPacket<S>,
    ) {
        let values = splat::<Spheres, S>(s, slot.rows, slot.lane());
        let bounds = Spheres::bounds(s, &rays.prepared, &values, best.t);
        let maybe = s.and(bounds.maybe, rays.near);
        let maybe = s.bits(maybe);
        if maybe == 0 {
            return;
        }
        let mut spheres = [[0.0; ROW]; 4];
        for (row, value) in spheres.iter_mut().zip(values) {
            s.store(value, row);
        }
        let rows = RayRows::of(s, &rays.rays);
        let Met { t: places, mut hits } = Met::of::<S>(&spheres, &rows, maybe);
        let t = s.load(&places);
        hits &= s.bits(s.le(t, best.t));
        let object = self.ids.get(slot.slot);
        let unsure = hits & !s.bits(Spheres::is_plain(s, &rays.prepared, &values, t));
        hits &= !self.beside(object, unsure, &rows, &places);
        let zero = s.splat(0.0);
        best.offer(s, object, &Lanes { hit: s.mask(hits), t, u: zero, v: zero });
    }

    /// The wanted spheres of a part of a row against one near ray.
    #[inline(always)]
    pub(crate) fn exact_part<S: Simd>(&self, s: S, part: &Part<'_>, ray: &OneRay, best: &mut Nearest) {
        let values = load::<Spheres, S>(s, part.rows, part.lane);
        let bounds = Spheres::bounds(s, &ray.prepared.splat(s), &values, s.splat(best.t));
        let mut maybe = s.bits(bounds.maybe) & part.wanted;
        if maybe == 0 {
            return;
        }
        let infinity = s.splat(f32::INFINITY);
        let certain = s.and(bounds.certain, s.mask(maybe));
        let limit = s.least(s.select(certain, bounds.high, infinity));
        maybe &= s.bits(s.le(bounds.low, s.splat(limit)));
        for at in ones(maybe.into()) {
            let sphere = sphere([0, 1, 2, 3].map(|i| &part.rows[i].0), part.lane + at);
            let Some(t) = nearest(&sphere, &ray.ray, best.t) else { continue };
            let object = self.ids.get(part.slot + at);
            if precedes(t, object, best) && self.solids.holds(object, &ray.ray, t) {
                best.offer(object, Surface { t, u: 0.0, v: 0.0 });
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use accel::Ray;
    use accel::testing::spheres_and_rays;

    /// Rays about a sphere that single precision rules out are missed for certain.
    #[test]
    fn what_is_ruled_out_is_missed() {
        use crate::rows::{MAX_ROWS, Prepared};
        use lanes::Scalar;
        use lanes::packet::Packet;
        let (mut out, mut hit, mut certain) = (0, 0, 0);
        for (sphere, ray) in spheres_and_rays(6000) {
            let size = sphere.radius + ray.origin.distance(sphere.center);
            if !(1e-8..1e8).contains(&size) || size > 1e4 * sphere.radius {
                continue;
            }
            let mut values = [0.0; MAX_ROWS];
            values[..3].copy_from_slice(&sphere.center.to_array());
            values[3] = sphere.radius;
            let prepared = Prepared::of(Scalar, &Packet::splat(Scalar, &ray), 0.0);
            let t = nearest(&sphere, &ray, ray.t_max);
            let limit = t.unwrap_or(ray.t_max);
            let bounds = Spheres::bounds(Scalar, &prepared, &values, limit);
            let maybe = bounds.maybe;
            assert!(maybe || t.is_none(), "{sphere:?} {ray:?}: {t:?}");
            let within = |t: f32| bounds.low <= t && (!bounds.certain || t <= bounds.high);
            assert!(t.is_none_or(within) && (t.is_some() || !bounds.certain || ray.t_max < bounds.high));
            certain += usize::from(bounds.certain);
            out += usize::from(!maybe);
            hit += usize::from(t.is_some());
        }
        assert!(out > 500 && hit > 500 && certain > 200, "{out} ruled out, {hit} hit, {certain} for certain");
    }

    #[test]
    fn lanes_are_the_rays() {
        let (sphere, _) = spheres_and_rays(3).nth(2).unwrap();
        let rays = spheres_and_rays(ROW as u32).map(|(_, ray)| ray).collect::<Vec<Ray>>();
        let rows = RayRows::of(lanes::Scalar, &lanes::packet::Packet::splat(lanes::Scalar, &rays[3]));
        let [x, y, z] = sphere.center.to_array();
        let met = Met::of::<lanes::Scalar>(&[x, y, z, sphere.radius].map(|number| [number; ROW]), &rows, 1);
        let found = nearest(&sphere, &rays[3], rays[3].t_max);
        assert_eq!((met.hits == 1).then_some(met.t[0]), found);
    }
}
