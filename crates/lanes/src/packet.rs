//! Several rays side by side in lanes.

use crate::row::ROW;
use crate::simd::Simd;
use accel::{Aabb, Nearest, Projection, Raster, Ray, Surface, Vec3};

/// Three coordinates of `LANES` vectors.
pub type Vec3Lanes<S> = [<S as Simd>::F; 3];

/// `LANES` rays, coordinate by coordinate.
#[derive(Clone, Copy)]
pub struct Packet<S: Simd> {
    /// Origins.
    pub origin: Vec3Lanes<S>,
    /// Directions.
    pub direction: Vec3Lanes<S>,
    /// Least t of each ray.
    pub t_min: S::F,
    /// Greatest t of each ray; a nearest hit so far may limit it further.
    pub t_max: S::F,
}

impl<S: Simd> Packet<S> {
    /// The same ray in all lanes.
    #[inline(always)]
    pub fn splat(s: S, ray: &Ray) -> Self {
        Self {
            origin: splat3(s, ray.origin),
            direction: splat3(s, ray.direction),
            t_min: s.splat(ray.t_min),
            t_max: s.splat(ray.t_max),
        }
    }

    /// The first `LANES` of `rays`.
    ///
    /// # Panics
    /// If there are fewer.
    #[inline(always)]
    pub fn load(s: S, rays: &[Ray]) -> Self {
        let rays = &rays[..S::LANES];
        let mut rows = [[0.0; ROW]; 8];
        for (lane, ray) in rays.iter().enumerate() {
            for axis in 0..3 {
                rows[axis][lane] = ray.origin[axis];
                rows[3 + axis][lane] = ray.direction[axis];
            }
            rows[6][lane] = ray.t_min;
            rows[7][lane] = ray.t_max;
        }
        Self {
            origin: [s.load(&rows[0]), s.load(&rows[1]), s.load(&rows[2])],
            direction: [s.load(&rows[3]), s.load(&rows[4]), s.load(&rows[5])],
            t_min: s.load(&rows[6]),
            t_max: s.load(&rows[7]),
        }
    }

    /// The rays at the first `LANES` places.
    #[inline(always)]
    pub fn gather(s: S, rays: &[&Ray; ROW]) -> Self {
        let mut half = [&rays[0].quads()[0]; ROW];
        for (half, ray) in half.iter_mut().zip(rays) {
            *half = &ray.quads()[0];
        }
        let [x, y, z, dx] = s.load_quads(&half);
        for (half, ray) in half.iter_mut().zip(rays) {
            *half = &ray.quads()[1];
        }
        let [dy, dz, t_min, t_max] = s.load_quads(&half);
        Self { origin: [x, y, z], direction: [dx, dy, dz], t_min, t_max }
    }

    /// [`Raster::ray`] in lanes, bit for bit, for pixel centres `x` = column + ½ and `y` = row + ½.
    #[inline(always)]
    pub fn of_raster(s: S, raster: &Raster, x: S::F, y: S::F) -> Self {
        // Plain loops: a closure may be compiled without the instruction set.
        let mut origin = splat3(s, raster.origin);
        let mut direction = splat3(s, raster.forward);
        let moved = match raster.projection {
            Projection::Parallel => &mut origin,
            Projection::Perspective => &mut direction,
        };
        for (axis, moved) in moved.iter_mut().enumerate() {
            let right = s.mul(s.splat(raster.right[axis]), x);
            let down = s.mul(s.splat(raster.down[axis]), y);
            *moved = s.add(*moved, s.add(right, down));
        }
        Self { origin, direction, t_min: s.splat(0.0), t_max: s.splat(f32::INFINITY) }
    }

    /// The ray of one lane. For paths that are taken rarely.
    #[inline(always)]
    pub fn ray(&self, s: S, lane: usize) -> Ray {
        let [x, y, z] = self.origin;
        let [dx, dy, dz] = self.direction;
        Ray {
            origin: Vec3::new(lane_of(s, x, lane), lane_of(s, y, lane), lane_of(s, z, lane)),
            direction: Vec3::new(lane_of(s, dx, lane), lane_of(s, dy, lane), lane_of(s, dz, lane)),
            t_min: lane_of(s, self.t_min, lane),
            t_max: lane_of(s, self.t_max, lane),
        }
    }
}

impl<S: Simd> Packet<S> {
    /// The rays in the lanes whose numbers `at` holds.
    #[inline(always)]
    pub fn permuted(&self, s: S, at: S::U) -> Self {
        Self {
            origin: permute3(s, self.origin, at),
            direction: permute3(s, self.direction, at),
            t_min: s.permute(self.t_min, at),
            t_max: s.permute(self.t_max, at),
        }
    }
}

/// The rays of a packet in memory.
#[derive(Clone, Copy, Debug)]
pub struct RayRows {
    rows: [[f32; ROW]; 8],
}

impl RayRows {
    /// Those of a packet.
    #[inline(always)]
    pub fn of<S: Simd>(s: S, rays: &Packet<S>) -> Self {
        let mut rows = [[0.0; ROW]; 8];
        s.store(rays.origin[0], &mut rows[0]);
        s.store(rays.origin[1], &mut rows[1]);
        s.store(rays.origin[2], &mut rows[2]);
        s.store(rays.direction[0], &mut rows[3]);
        s.store(rays.direction[1], &mut rows[4]);
        s.store(rays.direction[2], &mut rows[5]);
        s.store(rays.t_min, &mut rows[6]);
        s.store(rays.t_max, &mut rows[7]);
        Self { rows }
    }

    /// One lane's ray.
    #[inline(always)]
    pub fn ray(&self, lane: usize) -> Ray {
        let rows = &self.rows;
        Ray {
            origin: Vec3::new(rows[0][lane], rows[1][lane], rows[2][lane]),
            direction: Vec3::new(rows[3][lane], rows[4][lane], rows[5][lane]),
            t_min: rows[6][lane],
            t_max: rows[7][lane],
        }
    }
}

/// Rays and objects of one block to be tested with each other. There are as many places of both as is a multiple of
/// [`ROW`], but only the first `len` count.
#[derive(Clone, Copy)]
pub struct Pairs<'a, S: Simd> {
    /// The block that holds the objects.
    pub block: usize,
    /// The rays.
    pub packet: &'a Packet<S>,
    /// Places of rays in the packet.
    pub rays: &'a [u8],
    /// Places of objects in their block; there is an object in each.
    pub slots: &'a [u8],
    /// How many pairs there are.
    pub len: usize,
    /// Whether a ray is done with its first hit, whichever it is.
    pub any: bool,
}

/// A vector in all lanes.
#[inline(always)]
pub fn splat3<S: Simd>(s: S, v: Vec3) -> Vec3Lanes<S> {
    [s.splat(v.x), s.splat(v.y), s.splat(v.z)]
}

/// The vectors in the lanes whose numbers `at` holds.
#[inline(always)]
pub fn permute3<S: Simd>(s: S, [x, y, z]: Vec3Lanes<S>, at: S::U) -> Vec3Lanes<S> {
    [s.permute(x, at), s.permute(y, at), s.permute(z, at)]
}

/// One lane's value.
#[inline(always)]
pub fn lane_of<S: Simd>(s: S, v: S::F, lane: usize) -> f32 {
    let mut lanes = [0.0; ROW];
    s.store(v, &mut lanes);
    lanes[lane]
}

/// The outcome of `LANES` tests at once.
#[derive(Clone, Copy)]
pub struct Lanes<S: Simd> {
    /// Which lanes hit within their range of t; the others hold anything.
    pub hit: S::M,
    /// The rays' parameters.
    pub t: S::F,
    /// First surface coordinates.
    pub u: S::F,
    /// Second surface coordinates.
    pub v: S::F,
}

impl<S: Simd> Lanes<S> {
    /// The lanes as rows, to be read one by one.
    #[inline(always)]
    pub fn rows(&self, s: S) -> LaneRows {
        let mut rows = LaneRows { t: [0.0; ROW], u: [0.0; ROW], v: [0.0; ROW] };
        s.store(self.t, &mut rows.t);
        s.store(self.u, &mut rows.u);
        s.store(self.v, &mut rows.v);
        rows
    }
}

/// [`Lanes`] in memory.
#[derive(Clone, Copy, Debug)]
pub struct LaneRows {
    /// The rays' parameters.
    pub t: [f32; ROW],
    u: [f32; ROW],
    v: [f32; ROW],
}

impl LaneRows {
    /// What one lane hit.
    #[inline(always)]
    pub fn surface(&self, lane: usize) -> Surface {
        Surface { t: self.t[lane], u: self.u[lane], v: self.v[lane] }
    }
}

/// What is known of `LANES` tests before they are decided.
#[derive(Clone, Copy)]
pub struct Bounds<S: Simd> {
    /// Which lanes may hit within their range of t.
    pub undecided: S::M,
    /// Which of them certainly hit, at a normal t above the ray's `t_min`.
    pub certain: S::M,
    /// What hits does so at this t or above.
    pub low: S::F,
    /// What hits does so at this t or below.
    pub high: S::F,
}

impl<S: Simd> Bounds<S> {
    /// All lanes may hit at any t.
    #[inline(always)]
    pub fn unknown(s: S) -> Self {
        let (low, high) = (s.splat(f32::NEG_INFINITY), s.splat(f32::INFINITY));
        Self { undecided: s.mask(u32::MAX), certain: s.mask(0), low, high }
    }
}

/// The nearest hits so far of `LANES` rays; see [`Nearest`].
#[derive(Clone, Copy)]
pub struct NearestPacket<S: Simd> {
    /// Each hit's t, or the ray's `t_max` (−∞ switches a lane off).
    pub t: S::F,
    /// Each hit's object, or [`Nearest::NONE`].
    pub object: S::U,
    /// First surface coordinates.
    pub u: S::F,
    /// Second surface coordinates.
    pub v: S::F,
}

impl<S: Simd> NearestPacket<S> {
    /// No hits yet.
    #[inline(always)]
    pub fn new(s: S, t_max: S::F) -> Self {
        Self { t: t_max, object: s.splat_u(Nearest::NONE), u: s.splat(0.0), v: s.splat(0.0) }
    }

    /// Takes the hits on `object` that come before what is here.
    #[inline(always)]
    pub fn offer(&mut self, s: S, object: u32, lanes: &Lanes<S>) {
        let id = s.splat_u(object);
        let tie = s.and(s.eq(lanes.t, self.t), s.lt_u(id, self.object));
        let wins = s.and(lanes.hit, s.or(s.lt(lanes.t, self.t), tie));
        self.take(s, wins, object, lanes);
    }

    /// The lanes where `lanes` hits at the same t as another object before.
    #[inline(always)]
    pub fn ties(&self, s: S, object: u32, lanes: &Lanes<S>) -> S::M {
        let id = s.splat_u(object);
        let other = s.or(s.lt_u(id, self.object), s.lt_u(self.object, id));
        let taken = s.lt_u(self.object, s.splat_u(Nearest::NONE));
        s.and(s.and(lanes.hit, s.eq(lanes.t, self.t)), s.and(other, taken))
    }

    /// Takes the hits on `object` of the lanes `wins` over what is here.
    #[inline(always)]
    pub fn take(&mut self, s: S, wins: S::M, object: u32, lanes: &Lanes<S>) {
        let id = s.splat_u(object);
        self.t = s.select(wins, lanes.t, self.t);
        self.u = s.select(wins, lanes.u, self.u);
        self.v = s.select(wins, lanes.v, self.v);
        self.object = s.select_u(wins, id, self.object);
    }

    /// Takes the hits of the lanes `wins`, each on its own object.
    #[inline(always)]
    pub fn take_each(&mut self, s: S, wins: S::M, objects: &[u32], lanes: &Lanes<S>) {
        self.object = s.select_u(wins, s.load_u(objects), self.object);
        self.t = s.select(wins, lanes.t, self.t);
        self.u = s.select(wins, lanes.u, self.u);
        self.v = s.select(wins, lanes.v, self.v);
    }

    /// The first `LANES` of a row of results.
    #[inline(always)]
    pub fn load(s: S, from: &[Nearest; ROW]) -> Self {
        let (mut t, mut u, mut v) = ([0.0; ROW], [0.0; ROW], [0.0; ROW]);
        let mut object = [0; ROW];
        for (lane, nearest) in from.iter().enumerate() {
            (t[lane], u[lane], v[lane], object[lane]) = (nearest.t, nearest.u, nearest.v, nearest.object);
        }
        Self { t: s.load(&t), object: s.load_u(&object), u: s.load(&u), v: s.load(&v) }
    }

    /// Each lane's result, in the order of lanes.
    #[inline(always)]
    pub fn store(&self, s: S, to: &mut [Nearest]) {
        let mut objects = [0; ROW];
        s.store_u(self.object, &mut objects);
        let quads = s.store_quads([self.t, s.load(&objects.map(f32::from_bits)), self.u, self.v]);
        for (nearest, quad) in to.iter_mut().zip(&quads[..S::LANES]) {
            *nearest = Nearest::of_quad(*quad);
        }
    }
}

/// Up to 16 rays coordinate by coordinate; where there are fewer, the first stands in for the others.
///
/// # Panics
/// If there is none.
#[inline(always)]
pub fn rows<S: Simd>(s: S, rays: &[Ray]) -> accel::grid::RayRows<ROW> {
    let mut chosen = [&rays[0]; ROW];
    for (chosen, ray) in chosen.iter_mut().zip(rays) {
        *chosen = ray;
    }
    let zero = [0.0; ROW];
    let mut rows = accel::grid::RayRows { origin: [zero; 3], direction: [zero; 3], t_min: zero, t_max: zero };
    for at in (0..ROW).step_by(S::LANES) {
        let mut here = chosen;
        here[..S::LANES].copy_from_slice(&chosen[at..at + S::LANES]);
        let packet = Packet::gather(s, &here);
        for axis in 0..3 {
            s.store(packet.origin[axis], &mut rows.origin[axis][at..]);
            s.store(packet.direction[axis], &mut rows.direction[axis][at..]);
        }
        s.store(packet.t_min, &mut rows.t_min[at..]);
        s.store(packet.t_max, &mut rows.t_max[at..]);
    }
    rows
}

/// The part of each ray's way that lies between planes: of those across all three axes, what is within a box.
#[derive(Clone, Copy)]
pub struct Overlap<S: Simd> {
    enter: S::F,
    exit: S::F,
}

impl<S: Simd> Overlap<S> {
    /// The way up to `limit`.
    #[inline(always)]
    pub fn up_to(s: S, limit: S::F) -> Self {
        Self { enter: s.splat(0.0), exit: limit }
    }

    /// Leaves what lies between two planes across an axis, in either order; a ray meets a plane at (plane − `start`) · `inverse`.
    #[inline(always)]
    pub fn cut(&mut self, s: S, planes: [S::F; 2], start: S::F, inverse: S::F) {
        let a = s.mul(s.sub(planes[0], start), inverse);
        let b = s.mul(s.sub(planes[1], start), inverse);
        self.enter = s.max(self.enter, s.min(a, b));
        self.exit = s.min(self.exit, s.max(a, b));
    }

    /// The lanes where anything is left, be it a point.
    #[inline(always)]
    pub fn lanes(&self, s: S) -> S::M {
        s.le(self.enter, self.exit)
    }
}

/// The rays that begin in a box, as bits.
#[inline(always)]
pub fn begun_within<S: Simd>(s: S, rays: &accel::grid::RayRows<ROW>, Aabb { min, max }: &Aabb) -> u32 {
    let mut within = 0;
    for at in (0..ROW).step_by(S::LANES) {
        let mut here = s.mask(u32::MAX);
        for axis in 0..3 {
            let origin = s.load(&rays.origin[axis][at..]);
            let below = s.le(origin, s.splat(max[axis]));
            here = s.and(here, s.and(below, s.le(s.splat(min[axis]), origin)));
        }
        within |= s.bits(here) << at;
    }
    within
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simd::{Level, Task};

    struct Begun<'a>(&'a [Ray], Aabb);

    impl Task for Begun<'_> {
        type Out = u32;

        #[inline(always)]
        fn run<S: Simd>(self, s: S) -> u32 {
            begun_within(s, &rows(s, self.0), &self.1)
        }
    }

    /// The rays of up to 16 that meet a box at a t up to `limit`.
    struct Met<'a>(&'a [Ray], Aabb, f32);

    impl Task for Met<'_> {
        type Out = u32;

        #[inline(always)]
        fn run<S: Simd>(self, s: S) -> u32 {
            let Self(rays, Aabb { min, max }, limit) = self;
            let (rays, mut met) = (rows(s, rays), 0);
            for at in (0..ROW).step_by(S::LANES) {
                let mut overlap = Overlap::up_to(s, s.splat(limit));
                for axis in 0..3 {
                    let start = s.load(&rays.origin[axis][at..]);
                    let inverse = s.div(s.splat(1.0), s.load(&rays.direction[axis][at..]));
                    overlap.cut(s, [s.splat(min[axis]), s.splat(max[axis])], start, inverse);
                }
                met |= s.bits(overlap.lanes(s)) << at;
            }
            met
        }
    }

    #[test]
    fn boxes_are_met_from_either_side_up_to_the_limit_and_not_from_behind() {
        let bounds = Aabb { min: Vec3::new(2.0, -1.0, -1.0), max: Vec3::new(3.0, 1.0, 1.0) };
        let aslant = Vec3::new(1.0, 0.25, -0.25);
        let mut rays = [Ray::new(Vec3::ZERO, -aslant); ROW];
        rays[1] = Ray::new(Vec3::ZERO, aslant);
        rays[2] = Ray::new(Vec3::X * 5.0, -aslant);
        rays[3] = Ray::new(Vec3::X * 2.5, aslant);
        rays[4] = Ray::new(Vec3::Y * 2.0, aslant);
        // Ends at the side, and before it.
        rays[5] = Ray::new(Vec3::X * -0.5, aslant);
        rays[6] = Ray::new(Vec3::X * -0.75, aslant);
        for level in Level::here() {
            assert_eq!(level.run(Met(&rays, bounds, 2.5)), 0b10_1110, "{level:?}");
        }
    }

    #[test]
    fn rays_that_begin_in_a_box_or_on_its_sides_are_told() {
        let bounds = Aabb { min: Vec3::new(-1.0, 0.0, 2.0), max: Vec3::new(1.0, 3.0, 4.0) };
        let ray = |i: u8| {
            let at = |from: f32, place: u8| from + f32::from(place % 3);
            Ray::new(Vec3::new(at(-2.0, i), at(-1.0, i / 3), at(2.0, i / 2)), Vec3::X)
        };
        let rays: Vec<Ray> = (0..16).map(ray).collect();
        let inside = |ray: &Ray| ray.origin.cmpge(bounds.min).all() && ray.origin.cmple(bounds.max).all();
        let expected = rays.iter().zip(0..).fold(0, |bits, (ray, i)| bits | u32::from(inside(ray)) << i);
        assert!(expected != 0 && expected != 0xffff);
        for level in Level::here() {
            assert_eq!(level.run(Begun(&rays, bounds)), expected, "{level:?}");
        }
    }
}
