//! Surfaces along two parameters.

use super::{Tessellation, round};
use accel::solid::{Cone, Patch, Sphere, Torus};
use accel::{Aabb, Vec3};
use glam::DVec3;
use std::f64::consts::{PI, TAU};

/// A place of the unit circle.
fn circle(i: u32, n: u32) -> (f64, f64) {
    let (sin, cos) = libm::sincos(TAU * f64::from(i) / f64::from(n));
    (cos, sin)
}

/// A grid of `n` × `m` cells; where it goes around, its last line is its first. Its front is on the side of along × across.
fn sheet(
    all: &mut Tessellation,
    owner: u32,
    [n, m]: [u32; 2],
    around: [bool; 2],
    at: impl Fn(u32, u32) -> DVec3,
) {
    let [columns, rows] = [n + u32::from(!around[0]), m + u32::from(!around[1])];
    let points: Vec<Vec3> =
        (0..rows).flat_map(|j| (0..columns).map(move |i| (i, j))).map(|(i, j)| round(at(i, j))).collect();
    let corner = |i: u32, j: u32| (j % rows) * columns + i % columns;
    let cell = |i: u32, j: u32| {
        let [a, b, c, d] = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
        [[a, b, c], [a, c, d]]
    };
    all.append(
        owner,
        &points,
        (0..m).flat_map(|j| (0..n).map(move |i| (i, j))).flat_map(|(i, j)| cell(i, j)),
    );
}

pub fn block(all: &mut Tessellation, owner: u32, bounds: &Aabb) {
    let ends = [bounds.min, bounds.max];
    let points: Vec<Vec3> =
        (0..8).map(|i| Vec3::new(ends[i & 1].x, ends[i >> 1 & 1].y, ends[i >> 2].z)).collect();
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    all.append(owner, &points, faces.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]));
}

pub fn ball(all: &mut Tessellation, owner: u32, sphere: &Sphere, n: u32) {
    let (center, radius) = (sphere.center.as_dvec3(), f64::from(sphere.radius));
    let rows = (n / 2).max(2);
    sheet(all, owner, [n, rows], [true, false], |i, j| {
        let (x, y) = circle(i, n);
        let (sin, cos) = libm::sincos(PI * (f64::from(j) / f64::from(rows) - 0.5));
        // The poles are points.
        let ring = if j == 0 || j == rows { 0.0 } else { cos };
        center + DVec3::new(x * ring, y * ring, sin) * radius
    });
}

pub fn cone(all: &mut Tessellation, owner: u32, cone: &Cone, n: u32) {
    let ends = [cone.base.as_dvec3(), cone.top.as_dvec3()];
    let radii = [cone.base_radius, cone.top_radius].map(f64::from);
    let Some(axis) = (ends[1] - ends[0]).try_normalize() else { return };
    let [x, y] = across(axis);
    sheet(all, owner, [n, 1], [true, false], |i, j| {
        let (cos, sin) = circle(i, n);
        ends[j as usize] + (x * cos + y * sin) * radii[j as usize]
    });
    // The mantle's own corners, so that no ray slips between.
    for end in [0, 1] {
        if radii[end] > 0.0 {
            fan(all, owner, ends[end], [x, y], radii[end], n, end == 0);
        }
    }
}

pub fn disc(all: &mut Tessellation, owner: u32, center: DVec3, normal: DVec3, radius: f64, n: u32) {
    let [x, y] = across(normal.normalize_or(DVec3::Z));
    fan(all, owner, center, [x, y], radius, n, false);
}

/// Two directions perpendicular to a third, in the order that turns counterclockwise about it.
fn across(axis: DVec3) -> [DVec3; 2] {
    let (x, y) = axis.any_orthonormal_pair();
    if x.cross(y).dot(axis) > 0.0 { [x, y] } else { [y, x] }
}

/// A regular polygon, counterclockwise from x to y, or turned over.
fn fan(
    all: &mut Tessellation,
    owner: u32,
    center: DVec3,
    [x, y]: [DVec3; 2],
    radius: f64,
    n: u32,
    turned: bool,
) {
    let corner = |i: u32| {
        let (cos, sin) = circle(i, n);
        round(center + (x * cos + y * sin) * radius)
    };
    let points: Vec<Vec3> = (0..n).map(corner).collect();
    all.append(owner, &points, (2..n).map(|i| if turned { [0, i, i - 1] } else { [0, i - 1, i] }));
}

pub fn ring(all: &mut Tessellation, owner: u32, torus: &Torus, n: u32) {
    let Some(axis) = torus.axis.as_dvec3().try_normalize() else { return };
    let [x, y] = across(axis);
    let (major, minor) = (f64::from(torus.major), f64::from(torus.minor));
    sheet(all, owner, [n, (n / 2).max(3)], [true, true], |i, j| {
        let (cos, sin) = circle(i, n);
        let (out, up) = circle(j, (n / 2).max(3));
        let outward = x * cos + y * sin;
        torus.center.as_dvec3() + outward * (major + minor * out) + axis * (minor * up)
    });
}

pub fn patch(all: &mut Tessellation, owner: u32, patch: &Patch, n: u32) {
    let place = |i: u32| f64::from(i) / f64::from(n);
    sheet(all, owner, [n, n], [false, false], |i, j| patch.at(place(i), place(j)));
}
