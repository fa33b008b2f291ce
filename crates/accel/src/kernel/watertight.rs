//! S. Woop, C. Benthin, I. Wald, *Watertight Ray/Triangle Intersection*, Journal of
//! Computer Graphics Techniques 2(1), 2013: the ray is sheared onto an axis, edge functions
//! are evaluated in the plane, and a zero edge function is evaluated again in `f64`.

use super::{Kernel, KernelId, load_corners, splat_corners, sub3};
use crate::Ray;
use crate::packet::{Lanes, Packet, Vec3Lanes, splat3};
use crate::simd::{ROW, Row, Simd};

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
    /// x or y where the masks say so, z elsewhere.
    Mixed { x: S::M, y: S::M },
}

impl<S: Simd> Dominant<S> {
    /// The coordinates in the order: next after the dominant axis, the one after, dominant.
    #[inline(always)]
    fn rotate(&self, s: S, v: Vec3Lanes<S>) -> Vec3Lanes<S> {
        match *self {
            Self::Same(axis) => rotate(v, axis),
            Self::Mixed { x, y } => {
                let pick = |if_x, if_y, if_z| s.select(x, if_x, s.select(y, if_y, if_z));
                [pick(v[1], v[2], v[0]), pick(v[2], v[0], v[1]), pick(v[0], v[1], v[2])]
            }
        }
    }
}

/// Cyclic, so that the handedness stays.
#[inline(always)]
fn rotate<T: Copy>(v: [T; 3], dominant: usize) -> [T; 3] {
    match dominant {
        0 => [v[1], v[2], v[0]],
        1 => [v[2], v[0], v[1]],
        _ => v,
    }
}

#[inline(always)]
fn shear<S: Simd>(s: S, [x, y, z]: Vec3Lanes<S>) -> Vec3Lanes<S> {
    [s.div(x, z), s.div(y, z), s.div(s.splat(1.0), z)]
}

impl Kernel for Watertight {
    const ID: KernelId = KernelId::Watertight;
    type One = Sheared;
    type Many<S: Simd> = ShearedLanes<S>;

    #[inline(always)]
    fn one(ray: &Ray) -> Sheared {
        let size = ray.direction.abs();
        let dominant = if size.x >= size.y && size.x >= size.z {
            0
        } else if size.y >= size.z {
            1
        } else {
            2
        };
        let direction = rotate(ray.direction.to_array(), dominant);
        Sheared { ray: *ray, dominant, shear: shear(crate::simd::Scalar, direction) }
    }

    #[inline(always)]
    fn many<S: Simd>(s: S, rays: &Packet<S>) -> ShearedLanes<S> {
        let size = rays.direction.map(|d| s.abs(d));
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
            Dominant::Mixed { x, y }
        };
        let direction = dominant.rotate(s, rays.direction);
        ShearedLanes { origin: rays.origin, t_min: rays.t_min, dominant, shear: shear(s, direction) }
    }

    #[inline(always)]
    fn triangles<S: Simd>(s: S, ray: &Sheared, group: &[Row], at: usize, t_max: f32) -> Lanes<S> {
        let lanes = ShearedLanes {
            origin: splat3(s, ray.ray.origin),
            t_min: s.splat(ray.ray.t_min),
            dominant: Dominant::Same(ray.dominant),
            shear: ray.shear.map(|v| s.splat(v)),
        };
        test(s, &lanes, load_corners(s, group, at), s.splat(t_max))
    }

    #[inline(always)]
    fn rays<S: Simd>(s: S, rays: &ShearedLanes<S>, group: &[Row], lane: usize, t_max: S::F) -> Lanes<S> {
        test(s, rays, splat_corners(s, group, lane), t_max)
    }
}

#[inline(always)]
fn test<S: Simd>(s: S, ray: &ShearedLanes<S>, corners: [Vec3Lanes<S>; 3], t_max: S::F) -> Lanes<S> {
    let zero = s.splat(0.0);
    let [shear_x, shear_y, shear_z] = ray.shear;
    let [a, b, c] = corners.map(|corner| {
        let [x, y, z] = ray.dominant.rotate(s, sub3(s, corner, ray.origin));
        [s.sub(x, s.mul(shear_x, z)), s.sub(y, s.mul(shear_y, z)), z]
    });
    let edge = |p: Vec3Lanes<S>, q: Vec3Lanes<S>| s.sub(s.mul(p[0], q[1]), s.mul(p[1], q[0]));
    let mut edges = [edge(c, b), edge(a, c), edge(b, a)];
    let on_edge = s.or(s.or(s.eq(edges[0], zero), s.eq(edges[1], zero)), s.eq(edges[2], zero));
    let on_edge = s.bits(on_edge);
    if on_edge != 0 {
        edges = in_double(s, edges, [a, b, c], on_edge);
    }
    let [ea, eb, ec] = edges;
    let all = |le: &dyn Fn(S::F) -> S::M| s.and(s.and(le(ea), le(eb)), le(ec));
    let inside = s.or(all(&|e| s.le(zero, e)), all(&|e| s.le(e, zero)));
    let det = s.add(s.add(ea, eb), ec);
    let scaled = |e: S::F, z: S::F| s.mul(e, s.mul(shear_z, z));
    let t = s.add(s.add(scaled(ea, a[2]), scaled(eb, b[2])), scaled(ec, c[2]));
    let reciprocal = s.div(s.splat(1.0), det);
    let t = s.mul(t, reciprocal);
    // A zero determinant makes t NaN or infinite; only the infinite one needs refusing.
    let finite = s.lt(s.abs(reciprocal), s.splat(f32::INFINITY));
    let in_range = s.and(s.and(s.le(ray.t_min, t), s.le(t, t_max)), finite);
    Lanes { hit: s.and(inside, in_range), t, u: s.mul(eb, reciprocal), v: s.mul(ec, reciprocal) }
}

/// Edge functions of the lanes `on_edge` in `f64`, where products of two `f32` are exact.
#[inline(always)]
fn in_double<S: Simd>(
    s: S,
    edges: Vec3Lanes<S>,
    corners: [Vec3Lanes<S>; 3],
    mut on_edge: u32,
) -> Vec3Lanes<S> {
    let rows = |v: S::F| {
        let mut row = [0.0; ROW];
        s.store(v, &mut row);
        row
    };
    let mut e = edges.map(rows);
    let xy = corners.map(|[x, y, _]| [rows(x), rows(y)]);
    while on_edge != 0 {
        let lane = on_edge.trailing_zeros() as usize;
        on_edge &= on_edge - 1;
        let at = |corner: usize| xy[corner].map(|row| f64::from(row[lane]));
        let edge = |p: [f64; 2], q: [f64; 2]| (p[0] * q[1] - p[1] * q[0]) as f32;
        let [a, b, c] = [at(0), at(1), at(2)];
        (e[0][lane], e[1][lane], e[2][lane]) = (edge(c, b), edge(a, c), edge(b, a));
    }
    e.map(|row| s.load(&row))
}
