//! S. Woop, C. Benthin, I. Wald, *Watertight Ray/Triangle Intersection*, Journal of
//! Computer Graphics Techniques 2(1), 2013: the ray is sheared onto an axis, edge functions
//! are evaluated in the plane, and a zero edge function is evaluated again in `f64`.

use super::{
    EdgeError, Floats, InPairs, Kernel, KernelId, Packed, Paired, Permuted, RayForm, Unprepared, det2, dot3,
    sub3,
};
use accel::{Ray, Vec3};
use lanes::packet::{Lanes, Packet, Vec3Lanes, splat3};
use lanes::{ROW, Simd, next_lane};

/// Woop, Benthin and Wald's test, two-sided: a ray through a closed mesh never slips
/// between two triangles that share an edge or a corner.
#[derive(Clone, Copy, Debug, Default)]
pub struct Watertight;

/// A ray sheared so that its direction is the unit vector of its dominant axis.
#[derive(Clone, Copy, Debug)]
pub struct Sheared {
    ray: Ray,
    dominant: usize,
    shear: [f32; 3],
}

/// [`Sheared`] in lanes; the dominant axis may differ from ray to ray.
#[derive(Clone, Copy)]
pub struct ShearedLanes<S: Simd> {
    origin: Vec3Lanes<S>,
    t_min: S::F,
    dominant: Dominant<S>,
    shear: Vec3Lanes<S>,
}

/// Which axis is dominant in each lane.
#[derive(Clone, Copy)]
enum Dominant<S: Simd> {
    /// The same everywhere.
    Same(usize),
    /// x or z where the masks say so, y elsewhere. The axes' numbers are kept beside them, as numbers can be permuted.
    Mixed { x: S::M, z: S::M, axes: S::F },
}

impl<S: Simd> Dominant<S> {
    /// Those of the lanes whose numbers `at` holds.
    #[inline(always)]
    fn permuted(&self, s: S, at: S::U) -> Self {
        match *self {
            Self::Same(axis) => Self::Same(axis),
            Self::Mixed { axes, .. } => Self::mixed(s, s.permute(axes, at)),
        }
    }

    /// Given the number of each lane's axis.
    #[inline(always)]
    fn mixed(s: S, axes: S::F) -> Self {
        let one = s.splat(1.0);
        Self::Mixed { x: s.lt(axes, one), z: s.lt(one, axes), axes }
    }

    /// As [`rotate`].
    #[inline(always)]
    fn rotate(&self, s: S, v: Vec3Lanes<S>) -> Vec3Lanes<S> {
        match *self {
            Self::Same(axis) => rotate(v, axis),
            Self::Mixed { x, z, .. } => {
                [s.select(x, v[1], v[0]), s.select(z, v[1], v[2]), s.select(x, v[0], s.select(z, v[2], v[1]))]
            }
        }
    }
}

/// The coordinates with the dominant one last and the others in their order. Where that mirrors them, all edge functions have the
/// other sign, which a two-sided test doesn't mind.
#[inline(always)]
fn rotate<T: Copy>(v: [T; 3], dominant: usize) -> [T; 3] {
    match dominant {
        0 => [v[1], v[2], v[0]],
        1 => [v[0], v[2], v[1]],
        _ => v,
    }
}

#[inline(always)]
fn shear<S: Simd>(s: S, [x, y, z]: Vec3Lanes<S>) -> Vec3Lanes<S> {
    [s.div(x, z), s.div(y, z), s.div(s.splat(1.0), z)]
}

impl RayForm for Sheared {
    type Many<S: Simd> = ShearedLanes<S>;

    #[inline(always)]
    fn one(ray: &Ray) -> Self {
        let size = ray.direction.abs();
        let dominant = if size.x >= size.y && size.x >= size.z {
            0
        } else if size.y >= size.z {
            1
        } else {
            2
        };
        let direction = rotate(ray.direction.to_array(), dominant);
        Sheared { ray: *ray, dominant, shear: shear(lanes::Scalar, direction) }
    }

    #[inline(always)]
    fn many<S: Simd>(s: S, rays: &Packet<S>) -> ShearedLanes<S> {
        let [x, y, z] = rays.direction;
        let size = [s.abs(x), s.abs(y), s.abs(z)];
        let x = s.and(s.le(size[1], size[0]), s.le(size[2], size[0]));
        let y = s.le(size[2], size[1]);
        let all = u32::MAX >> (32 - S::LANES);
        let (bits_x, bits_y) = (s.bits(x), s.bits(y));
        let dominant = if bits_x == all {
            Dominant::Same(0)
        } else if bits_x == 0 && bits_y == all {
            Dominant::Same(1)
        } else if bits_x | bits_y == 0 {
            Dominant::Same(2)
        } else {
            let other = s.select(y, s.splat(1.0), s.splat(2.0));
            Dominant::mixed(s, s.select(x, s.splat(0.0), other))
        };
        let direction = dominant.rotate(s, rays.direction);
        ShearedLanes { origin: rays.origin, t_min: rays.t_min, dominant, shear: shear(s, direction) }
    }
}

impl Kernel for Watertight {
    const ID: KernelId = KernelId::Watertight;
    type Preparation = Unprepared;
    type Search = InPairs;
    type Storage = Floats;
    type One = Sheared;
    const EDGE_ERROR: Option<EdgeError> = Some(EdgeError::Corners);

    #[inline(always)]
    fn triangles<S: Simd>(s: S, ray: &Sheared, packed: Packed<'_>, _: u32, t_max: f32) -> Lanes<S> {
        let lanes = ShearedLanes {
            origin: splat3(s, ray.ray.origin),
            t_min: s.splat(ray.ray.t_min),
            dominant: Dominant::Same(ray.dominant),
            shear: splat3(s, Vec3::from_array(ray.shear)),
        };
        test(s, &lanes, packed.load_corners(s), s.splat(t_max))
    }

    #[inline(always)]
    fn rays<S: Simd>(s: S, rays: &ShearedLanes<S>, packed: Packed<'_>, t_max: S::F) -> Lanes<S> {
        test(s, rays, packed.splat_corners(s), t_max)
    }
}

impl Permuted for Watertight {
    #[inline(always)]
    fn permuted<S: Simd>(s: S, rays: &ShearedLanes<S>, at: S::U) -> ShearedLanes<S> {
        let ([x, y, z], [sx, sy, sz]) = (rays.origin, rays.shear);
        ShearedLanes {
            origin: [s.permute(x, at), s.permute(y, at), s.permute(z, at)],
            t_min: s.permute(rays.t_min, at),
            dominant: rays.dominant.permuted(s, at),
            shear: [s.permute(sx, at), s.permute(sy, at), s.permute(sz, at)],
        }
    }
}

impl Paired for Watertight {
    #[inline(always)]
    fn each<S: Simd>(s: S, rays: &ShearedLanes<S>, corners: [Vec3Lanes<S>; 3], t_max: S::F) -> Lanes<S> {
        test(s, rays, corners, t_max)
    }
}

#[inline(always)]
fn sheared<S: Simd>(s: S, ray: &ShearedLanes<S>, corner: Vec3Lanes<S>) -> Vec3Lanes<S> {
    let [x, y, z] = ray.dominant.rotate(s, sub3(s, corner, ray.origin));
    [s.sub(x, s.mul(ray.shear[0], z)), s.sub(y, s.mul(ray.shear[1], z)), z]
}

#[inline(always)]
fn edge<S: Simd>(s: S, p: Vec3Lanes<S>, q: Vec3Lanes<S>) -> S::F {
    det2(s, p[0], p[1], q[0], q[1])
}

#[inline(always)]
fn all3<S: Simd>(s: S, a: S::M, b: S::M, c: S::M) -> S::M {
    s.and(s.and(a, b), c)
}

#[inline(always)]
fn test<S: Simd>(s: S, ray: &ShearedLanes<S>, corners: [Vec3Lanes<S>; 3], t_max: S::F) -> Lanes<S> {
    let zero = s.splat(0.0);
    let [a, b, c] = corners;
    let (a, b, c) = (sheared(s, ray, a), sheared(s, ray, b), sheared(s, ray, c));
    let mut edges = [edge(s, c, b), edge(s, a, c), edge(s, b, a)];
    let on_edge = s.or(s.or(s.eq(edges[0], zero), s.eq(edges[1], zero)), s.eq(edges[2], zero));
    let on_edge = s.bits(on_edge);
    if on_edge != 0 {
        edges = in_double(s, edges, [a, b, c], on_edge);
    }
    let [ea, eb, ec] = edges;
    let left = all3(s, s.le(zero, ea), s.le(zero, eb), s.le(zero, ec));
    let right = all3(s, s.le(ea, zero), s.le(eb, zero), s.le(ec, zero));
    let inside = s.or(left, right);
    let det = s.add(s.add(ea, eb), ec);
    let along = [s.mul(ray.shear[2], a[2]), s.mul(ray.shear[2], b[2]), s.mul(ray.shear[2], c[2])];
    let t = dot3(s, edges, along);
    let reciprocal = s.div(s.splat(1.0), det);
    let t = s.mul(t, reciprocal);
    // A zero determinant makes t NaN or infinite; only the infinite one needs refusing.
    let finite = s.lt(s.abs(reciprocal), s.splat(f32::INFINITY));
    let in_range = s.and(s.and(s.le(ray.t_min, t), s.le(t, t_max)), finite);
    Lanes { hit: s.and(inside, in_range), t, u: s.mul(eb, reciprocal), v: s.mul(ec, reciprocal) }
}

/// Edge functions of the lanes `on_edge` in `f64`, where products of two `f32` are exact.
#[inline(always)]
fn in_double<S: Simd>(s: S, edges: Vec3Lanes<S>, corners: [Vec3Lanes<S>; 3], on_edge: u32) -> Vec3Lanes<S> {
    let mut rows = [[0.0; ROW]; 9];
    let [a, b, c] = corners;
    s.store(edges[0], &mut rows[0]);
    s.store(edges[1], &mut rows[1]);
    s.store(edges[2], &mut rows[2]);
    s.store(a[0], &mut rows[3]);
    s.store(a[1], &mut rows[4]);
    s.store(b[0], &mut rows[5]);
    s.store(b[1], &mut rows[6]);
    s.store(c[0], &mut rows[7]);
    s.store(c[1], &mut rows[8]);
    edges_in_double(&mut rows, on_edge);
    [s.load(&rows[0]), s.load(&rows[1]), s.load(&rows[2])]
}

/// Writes edge functions to rows 0 to 2 from the x and y of three corners in rows 3 to 8.
#[cold]
fn edges_in_double(rows: &mut [[f32; ROW]; 9], mut on_edge: u32) {
    while let Some(lane) = next_lane(&mut on_edge) {
        let at = |row: usize| [f64::from(rows[row][lane]), f64::from(rows[row + 1][lane])];
        let edge = |p: [f64; 2], q: [f64; 2]| (p[0] * q[1] - p[1] * q[0]) as f32;
        let (a, b, c) = (at(3), at(5), at(7));
        let edges = [edge(c, b), edge(a, c), edge(b, a)];
        for (row, edge) in rows.iter_mut().zip(edges) {
            row[lane] = edge;
        }
    }
}
