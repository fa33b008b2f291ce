//! Each bound as it is loses nothing; one that is too small does.

use super::*;
use crate::dda::Walk;
use crate::grid::Grid;
use crate::{Corners, Projection, Raster, Vec3};
use glam::DVec3;

/// Numbers in [−1, 1) from a fixed seed.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f32 / (1 << 23) as f32 - 1.0
    }

    fn point(&mut self) -> Vec3 {
        Vec3::new(self.next(), self.next(), self.next())
    }
}

/// A ray from within `reach` of the unit cube's half at a triangle in it, with the t of the hit rounded once.
fn hit(numbers: &mut Numbers, reach: f32) -> Option<(Corners, Ray, f32)> {
    let center = numbers.point() * 0.4;
    let mut corners = [0, 1, 2].map(|_| center + numbers.point() * 0.1);
    // Every other one lies in a plane of constant z, where its box is flat.
    if numbers.next() < 0.0 {
        corners = corners.map(|corner| Vec3::new(corner.x, corner.y, center.z));
    }
    let [a, b, c] = corners.map(|corner| corner.as_dvec3());
    let origin = numbers.point() * reach;
    let direction = ((a + b + c) / 3.0 - origin.as_dvec3()).as_vec3();
    let normal = (b - a).cross(c - a);
    let (slope, d) = (normal.dot(direction.as_dvec3()), direction.as_dvec3());
    let t = normal.dot(a - origin.as_dvec3()) / slope;
    let at: DVec3 = origin.as_dvec3() + d * t;
    let inside = |p: DVec3, q: DVec3| normal.dot((q - p).cross(at - p)) >= 0.0;
    (slope.abs() > 1e-4 * normal.length() * d.length() && inside(a, b) && inside(b, c) && inside(c, a))
        .then(|| (corners, Ray { t_min: f32::NEG_INFINITY, ..Ray::new(origin, direction) }, t as f32))
}

/// Hits of 20,000 that break the invariant with these bounds.
fn broken(reach: f32, pad: f32, slack: f64) -> usize {
    let mut numbers = Numbers(1);
    let lost = |_: &usize| {
        hit(&mut numbers, reach).is_some_and(|(corners, ray, t)| {
            let bounds = Aabb::of_points(corners);
            let padded = Aabb { min: bounds.min - pad, max: bounds.max + pad };
            !holds_with(&padded, &ray, t, slack)
        })
    };
    (0..20_000).filter(lost).count()
}

#[test]
fn boxes_that_are_padded_too_little_refuse_hits() {
    assert_eq!(broken(NEAR, PAD, 0.0), 0, "near rays need no slack of t");
    assert!(broken(NEAR, 0.0, 0.0) > 100);
}

#[test]
fn far_away_a_slack_of_t_too_small_refuses_hits() {
    assert_eq!(broken(1e6, PAD, T_SLACK), 0);
    assert!(broken(1e6, PAD, ROUNDING / 64.0) > 100);
}

/// Points of 3,000 rays past corners of a fine grid's cells that lie in no cell visited, the cells made wider by
/// `margin`. They are taken between the planes that meet there, which rounding may put in another order.
fn unvisited(margin: f64) -> usize {
    let grid =
        Grid::new(Aabb { min: Vec3::ZERO, max: Vec3::ONE }, [1 << 12; 3]).expect("a resolution in range");
    let mut numbers = Numbers(2);
    let mut lost = 0;
    for _ in 0..3000 {
        let corner = ((numbers.point() + 1.0) * 2048.0).floor() / 4096.0;
        let origin = numbers.point() * 2.0;
        // The factor leaves a direction that is rounded.
        let ray = Ray::new(origin, (corner - origin) * 0.7);
        let Some(segment) = grid.clip(&ray) else { continue };
        let cells: Vec<_> = Walk::new(&grid, &segment).collect();
        let mut planes = (corner.as_dvec3() - ray.origin.as_dvec3()) / ray.direction.as_dvec3();
        planes.as_mut().sort_by(f64::total_cmp);
        for t in [(planes.x + planes.y) / 2.0, (planes.y + planes.z) / 2.0] {
            let point = ray.origin.as_dvec3() + ray.direction.as_dvec3() * t;
            let holds = |slice: [u32; 3]| {
                (0..3).all(|a| {
                    let (low, high) = (f64::from(slice[a]) / 4096.0, (f64::from(slice[a]) + 1.0) / 4096.0);
                    low - margin <= point[a] && point[a] <= high + margin
                })
            };
            lost += usize::from(!cells.iter().any(|cell| holds(cell.slice)));
        }
    }
    lost
}

#[test]
fn a_margin_too_small_puts_boxes_where_no_walk_comes() {
    assert_eq!(unvisited(GRID_MARGIN), 0);
    assert!(unvisited(0.0) > 0);
}

/// Boxes whose beginning lies behind the limit of a hit that they may precede.
fn behind(limit_t: f64, limit_s: f64) -> usize {
    let grid = Grid::new(Aabb { min: Vec3::ZERO, max: Vec3::ONE }, [1; 3]).expect("a resolution in range");
    let mut numbers = Numbers(3);
    let mut lost = 0;
    for _ in 0..20_000 {
        let ray = Ray::new(numbers.point() * 1e3, numbers.point());
        let ray = Ray { direction: Vec3::splat(0.5) + ray.direction * 0.4 - ray.origin, ..ray };
        let Some(segment) = grid.clip(&ray) else { continue };
        let (near, far) = grid.bounds().overlap(ray.origin, ray.direction).expect("it has been clipped");
        let near = near.max(0.0);
        // The known hit is reported at the t at which another box begins, rounded down.
        let begins = near + (far - near) * f64::from(numbers.next().abs());
        let t = (begins as f32).next_down();
        let s = ((begins - near) / (far - near)) as f32;
        lost += usize::from(s > segment.limit_with(t, limit_t, limit_s));
    }
    lost
}

#[test]
fn a_limit_too_small_ends_before_an_object_that_comes_first() {
    assert_eq!(behind(LIMIT_T, LIMIT_S), 0);
    assert!(behind(0.0, 0.0) > 0);
}

/// Rays through the edge of a box that count as missing it, of 20,000. All numbers are integers, so that the two planes
/// which meet in the edge are met at the same t exactly.
fn untouched(touch: f64) -> usize {
    let mut numbers = Numbers(4);
    let mut integer = |to: f32| f64::from((numbers.next() * to).abs().floor()) + 1.0;
    let mut lost = 0;
    for _ in 0..20_000 {
        let (t, direction) = (integer(1e3), [integer(1e3), integer(1e3)]);
        let at = direction.map(|d| (d * t) * (1.0 / d));
        let (enters, leaves) = (at[0], at[1]);
        lost += usize::from(enters > leaves + touch * enters.max(leaves));
    }
    lost
}

#[test]
fn rays_that_touch_a_box_are_lost_without_a_tolerance() {
    assert_eq!(untouched(TOUCH), 0);
    assert!(untouched(0.0) > 100);
}

/// Components of rays of 5,000 images of about this size that are farther off than they may be.
fn off(size: f32, rounding: f64, underflow: f64) -> usize {
    let mut numbers = Numbers(5);
    let mut off = 0;
    for _ in 0..5000 {
        let mut vector = || numbers.point() * size;
        let raster = Raster {
            projection: Projection::Parallel,
            rows: 1000,
            cols: 1000,
            origin: vector() * 500.0,
            forward: Vec3::Z,
            right: vector(),
            down: vector(),
        };
        let (row, col) = (numbers.next().abs() * 1000.0, numbers.next().abs() * 1000.0);
        let (row, col) = (row as u32, col as u32);
        let ray = raster.ray(row, col);
        for axis in 0..3 {
            let term = |v: Vec3, n: f64| f64::from(v[axis]) * n;
            let [base, right, down] = [
                term(raster.origin, 1.0),
                term(raster.right, f64::from(col) + 0.5),
                term(raster.down, f64::from(row) + 0.5),
            ];
            let allowed = (base.abs() + right.abs() + down.abs()) * rounding + underflow;
            off += usize::from((f64::from(ray.origin[axis]) - (base + right + down)).abs() > allowed);
        }
    }
    off
}

#[test]
fn rays_of_an_image_are_off_by_more_than_a_bound_too_small() {
    assert_eq!(off(1.0, RASTER_ROUNDING, RASTER_UNDERFLOW), 0);
    assert!(off(1.0, ROUNDING / 4.0, RASTER_UNDERFLOW) > 100);
}

#[test]
fn rays_of_a_tiny_image_are_off_by_more_than_any_part_of_their_terms() {
    let size = f32::MIN_POSITIVE / (1 << 12) as f32;
    assert_eq!(off(size, RASTER_ROUNDING, RASTER_UNDERFLOW), 0);
    assert!(off(size, RASTER_ROUNDING, 0.0) > 100);
}

/// Points of 20,000 whose coordinate in a frame, computed in `f64`, is farther off than it may be. Integers give the
/// exact one.
fn displaced(rounding: f64) -> usize {
    let mut numbers = Numbers(6);
    let mut integer = || f64::from((numbers.next() * 4096.0).floor());
    let mut lost = 0;
    for _ in 0..20_000 {
        let mut vector = || DVec3::new(integer(), integer(), integer());
        let (forward, right, down, point) = (vector(), vector(), vector(), vector());
        let normal = right.cross(down);
        let determinant = forward.dot(normal);
        if determinant == 0.0 {
            continue;
        }
        let form = normal / determinant;
        let size = (form * point).abs().element_sum();
        // What is left over of the products, exact in integers of this size.
        let exact = normal.dot(point);
        let computed = form.dot(point) * determinant;
        lost += usize::from((computed - exact).abs() > size * rounding * determinant.abs());
    }
    lost
}

#[test]
fn projections_are_off_by_more_than_a_bound_too_small() {
    assert_eq!(displaced(PROJECTION), 0);
    assert!(displaced(DOUBLE_ROUNDING / 4.0) > 100);
}

/// Segments whose reciprocal isn't finite, of those with a component of 2^-e that is taken for this much at least.
fn without_end(least: f32) -> usize {
    let components = (100..149).map(|e| 2f64.powi(-e) as f32);
    components.filter(|c| !(1.0 / c.max(least) * c.max(least)).is_finite()).count()
}

#[test]
fn components_too_small_have_no_reciprocal() {
    assert_eq!(without_end(PARALLEL as f32), 0);
    assert!(without_end(0.0) > 0);
}

/// Lines that touch a ball and count as missing it, of 20,000. The distance is that of a multiple of (−4, 3) from lines
/// along a multiple of (3, 4), so all numbers are integers.
fn balls_missed(tolerance: f64) -> usize {
    let mut numbers = Numbers(7);
    let mut integer = |to: f32| f64::from((numbers.next() * to).floor());
    let mut lost = 0;
    for _ in 0..20_000 {
        let (along, aside, length) = (integer(1e3), integer(1e3), integer(50.0) + 0.5);
        let d = DVec3::new(3.0, 4.0, 0.0) * length;
        let c = DVec3::new(3.0, 4.0, 0.0) * along + DVec3::new(-4.0, 3.0, 0.0) * aside;
        let r2 = 25.0 * aside * aside;
        let foot = c.dot(d) / d.length_squared();
        lost += usize::from((c - d * foot).length_squared() > r2 + tolerance * (r2 + c.length_squared()));
    }
    lost
}

#[test]
fn lines_that_touch_a_ball_are_lost_without_a_tolerance() {
    assert_eq!(balls_missed(BALL), 0);
    assert!(balls_missed(0.0) > 100);
}
