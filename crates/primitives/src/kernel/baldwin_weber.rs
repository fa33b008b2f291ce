//! D. Baldwin, M. Weber, *Fast Ray-Triangle Intersections by Coordinate Transformation*,
//! Journal of Computer Graphics Techniques 5(3), 2016: each triangle stores the affine map that takes
//! it to the unit triangle, so that a test is a few products and one division.

use super::packed::{load3, splat_row3};
use super::{Corners, Kernel, KernelId, Packed, dot3};
use accel::{Ray, Vec3};
use lanes::packet::{Lanes, Packet, Vec3Lanes};
use lanes::{Row, Simd};

/// Baldwin and Weber's test, two-sided. The maps are computed in `f64` and rounded once; a
/// translation far larger than the triangle costs digits, so it suits scenes near the
/// origin. Not watertight.
#[derive(Clone, Copy, Debug, Default)]
pub struct BaldwinWeber;

/// A row of the map: three factors and a translation.
type MapRow<S> = (Vec3Lanes<S>, <S as Simd>::F);

impl Kernel for BaldwinWeber {
    const ID: KernelId = KernelId::BaldwinWeber;
    const ROWS: usize = 12;
    crate::plain_kernel!();
    type One = Ray;

    fn pack(corners: &Corners, group: &mut [Row], lane: usize) {
        for (row, value) in group.iter_mut().zip(map_of(corners).as_flattened()) {
            row.0[lane] = *value as f32;
        }
    }

    #[inline(always)]
    fn corners(_: Packed<'_>) -> Option<Corners> {
        None
    }

    #[inline(always)]
    fn triangles<S: Simd>(s: S, ray: &Ray, packed: Packed<'_>, _: u32, t_max: f32) -> Lanes<S> {
        let (rows, at) = (&packed.group[..12], packed.lane);
        let map = [load_row(s, &rows[..4], at), load_row(s, &rows[4..8], at), load_row(s, &rows[8..], at)];
        test(s, &Packet::splat(s, ray), map, s.splat(t_max))
    }

    #[inline(always)]
    fn rays<S: Simd>(s: S, rays: &Packet<S>, packed: Packed<'_>, t_max: S::F) -> Lanes<S> {
        let (rows, lane) = (&packed.group[..12], packed.lane);
        let map =
            [splat_row(s, &rows[..4], lane), splat_row(s, &rows[4..8], lane), splat_row(s, &rows[8..], lane)];
        test(s, rays, map, t_max)
    }
}

/// The rows of the map to (u, v, height): the inverse of the matrix whose columns are
/// the edges, an axis and the first corner. The axis is that of the normal's largest
/// component, as in the paper (§3). A triangle without area gives infinities or NaN.
fn map_of([a, b, c]: &Corners) -> [[f64; 4]; 3] {
    let wide = |v: Vec3| v.as_dvec3();
    let (a, edge1, edge2) = (wide(*a), wide(*b) - wide(*a), wide(*c) - wide(*a));
    let normal = edge1.cross(edge2);
    let axis = normal.abs().max_position();
    let unit = glam::DVec3::AXES[axis];
    // Cramer's rule: det(edge1, edge2, unit) is one component of the normal.
    let det = normal[axis];
    let rows = [edge2.cross(unit) / det, unit.cross(edge1) / det, normal / det];
    rows.map(|row| [row.x, row.y, row.z, -row.dot(a)])
}

#[inline(always)]
fn load_row<S: Simd>(s: S, rows: &[Row], at: usize) -> MapRow<S> {
    (load3(s, &rows[..3], at), s.load(&rows[3].0[at..]))
}

#[inline(always)]
fn splat_row<S: Simd>(s: S, rows: &[Row], lane: usize) -> MapRow<S> {
    (splat_row3(s, &rows[..3], lane), s.splat(rows[3].0[lane]))
}

/// A ray in the plane has a zero slope: t is then infinite or NaN, and so are u and v.
#[inline(always)]
fn test<S: Simd>(s: S, ray: &Packet<S>, [to_u, to_v, to_height]: [MapRow<S>; 3], t_max: S::F) -> Lanes<S> {
    let (zero, one) = (s.splat(0.0), s.splat(1.0));
    let height = s.add(dot3(s, to_height.0, ray.origin), to_height.1);
    let slope = dot3(s, to_height.0, ray.direction);
    let t = s.div(s.sub(zero, height), slope);
    let [x, y, z] = ray.direction;
    let along = [s.mul(t, x), s.mul(t, y), s.mul(t, z)];
    let [x, y, z] = ray.origin;
    let at = [s.add(x, along[0]), s.add(y, along[1]), s.add(z, along[2])];
    let u = s.add(dot3(s, to_u.0, at), to_u.1);
    let v = s.add(dot3(s, to_v.0, at), to_v.1);
    let inside = s.and(s.and(s.le(zero, u), s.le(zero, v)), s.le(s.add(u, v), one));
    let in_range = s.and(s.le(ray.t_min, t), s.le(t, t_max));
    Lanes { hit: s.and(inside, in_range), t, u, v }
}
