//! Corners on a grid of 2^16 places an axis.

use super::{Kernel, Storage};
use accel::{Aabb, Corners, Vec3};
use lanes::{ROW, Row, Simd};

/// The last place.
const LAST: f32 = u16::MAX as f32;

/// Evenly spaced places over a scene's bounds, on each axis with a spacing of its own.
#[derive(Clone, Copy, Debug)]
pub struct QuantisationGrid {
    low: Vec3,
    step: Vec3,
    /// Reciprocals of the steps, 0 on an axis without extent.
    inverse: [f64; 3],
}

/// The corners of 16 triangles, coordinate by coordinate.
type ShortRows = [[u16; ROW]; ROWS];

/// One for each coordinate of the corners.
const ROWS: usize = 9;

impl QuantisationGrid {
    /// The nearest place on each axis.
    #[inline(always)]
    fn index(&self, point: Vec3) -> [u16; 3] {
        let mut index = [0; 3];
        for (axis, index) in index.iter_mut().enumerate() {
            let from_low = f64::from(point[axis]) - f64::from(self.low[axis]);
            // The conversion ends at 0 and at the last place.
            *index = (from_low * self.inverse[axis] + 0.5) as u16;
        }
        index
    }
}

impl Storage for QuantisationGrid {
    type Unit = ShortRows;
    const EMPTY: ShortRows = [[0; ROW]; ROWS];
    const UNPACKED_ROWS: usize = ROWS;

    #[inline(always)]
    fn units<K: Kernel>() -> usize {
        const { assert!(K::ROWS == ROWS, "the kernel packs corners") };
        1
    }

    fn over(bounds: &Aabb) -> Self {
        if bounds.is_empty() {
            return Self { low: Vec3::ZERO, step: Vec3::ZERO, inverse: [0.0; 3] };
        }
        // In `f64`, for the extent of finite corners may be beyond `f32`; the last place is not.
        let extent = bounds.max.as_dvec3() - bounds.min.as_dvec3();
        let step = (extent / f64::from(LAST)).as_vec3().min(Vec3::splat(f32::MAX / (LAST + 1.0)));
        let inverse = |axis: usize| if step[axis] > 0.0 { 1.0 / f64::from(step[axis]) } else { 0.0 };
        Self { low: bounds.min, step, inverse: [0, 1, 2].map(inverse) }
    }

    #[inline(always)]
    fn place(&self, corner: Vec3) -> Vec3 {
        let [x, y, z] = self.index(corner);
        self.low + self.step * Vec3::new(x.into(), y.into(), z.into())
    }

    #[inline(always)]
    fn pack<K: Kernel>(&self, corners: &Corners, _: f32, group: &mut [ShortRows], lane: usize) {
        for (corner, rows) in corners.iter().zip(group[0].chunks_exact_mut(3)) {
            for (row, index) in rows.iter_mut().zip(self.index(*corner)) {
                row[lane] = index;
            }
        }
    }

    #[inline(always)]
    fn kept(_: &[ShortRows]) -> Option<&[Row]> {
        None
    }

    #[inline(always)]
    fn rows<'a, S: Simd>(
        &self,
        s: S,
        group: &'a [ShortRows],
        at: usize,
        scale: f32,
        scratch: &'a mut [Row],
    ) -> &'a [Row] {
        for (k, (from, to)) in group[0].iter().zip(&mut *scratch).enumerate() {
            let from_low = s.mul(s.splat(self.step[k % 3]), s.load_short(&from[at..]));
            let mut value = s.add(s.splat(self.low[k % 3]), from_low);
            if scale != 1.0 {
                value = s.mul(value, s.splat(scale));
            }
            s.store(value, &mut to.0[at..]);
        }
        scratch
    }
}

#[cfg(test)]
mod tests {
    use super::super::Quantised;
    use super::*;
    use lanes::{Level, Task};
    use proptest::prelude::*;

    struct Unpack<'a>(&'a QuantisationGrid, &'a ShortRows);

    impl Task for Unpack<'_> {
        type Out = [Row; 9];

        #[inline(always)]
        fn run<S: Simd>(self, s: S) -> Self::Out {
            let mut rows = [Row([0.0; ROW]); 9];
            for at in (0..ROW).step_by(S::LANES) {
                self.0.rows(s, std::slice::from_ref(self.1), at, 1.0, &mut rows);
            }
            rows
        }
    }

    fn point() -> impl Strategy<Value = Vec3> {
        prop::array::uniform3(-1f32..1.0).prop_map(Vec3::from_array)
    }

    proptest! {
        /// No point moves by more than half a step and what `f32` rounds, and lanes hold the same bits.
        #[test]
        fn points_move_by_half_a_step_at_most(points in prop::collection::vec(point(), 3 * ROW), scale in -100i32..100, offset in prop_oneof![Just(0f32), Just(7.0), Just(1e5)], flat in prop::option::of(0usize..3)) {
            let place = |p: &Vec3| {
                let mut p = *p;
                if let Some(axis) = flat { p[axis] = 0.25; }
                (p + Vec3::splat(offset)) * 2f32.powi(scale)
            };
            let points: Vec<Vec3> = points.iter().map(place).collect();
            let bounds = Aabb::of_points(points.iter().copied());
            let grid = QuantisationGrid::over(&bounds);
            let extent = bounds.extent();
            let most = bounds.min.abs().max(bounds.max.abs());
            let mut rows = [[0; ROW]; 9];
            for (lane, corners) in points.chunks_exact(3).enumerate() {
                let corners = [corners[0], corners[1], corners[2]];
                grid.pack::<Quantised>(&corners, 1.0, std::slice::from_mut(&mut rows), lane);
            }
            for level in Level::here() {
                let unpacked = level.run(Unpack(&grid, &rows));
                for (i, point) in points.iter().enumerate() {
                    let snapped = grid.place(*point);
                    let step = extent / LAST;
                    let bound = step * 0.51 + (most + extent) * f32::EPSILON;
                    prop_assert!(((snapped - *point).abs().cmple(bound)).all(), "{point} {snapped}");
                    for axis in 0..3 {
                        let lane = unpacked[i % 3 * 3 + axis].0[i / 3];
                        prop_assert_eq!(lane.to_bits(), snapped[axis].to_bits());
                    }
                }
            }
        }
    }

    #[test]
    fn the_order_of_coordinates_stays() {
        let grid = QuantisationGrid::over(&Aabb { min: Vec3::splat(-3.0), max: Vec3::splat(5.0) });
        let at = |i: i32| grid.place(Vec3::splat(i as f32 * 1e-5 - 3.0)).x;
        assert!((0..100_000).all(|i| at(i) <= at(i + 1)));
        assert_eq!(at(0), -3.0);
        let flat = QuantisationGrid::over(&Aabb { min: Vec3::ONE, max: Vec3::ONE });
        assert_eq!(flat.place(Vec3::ONE), Vec3::ONE);
        let widest = Aabb { min: Vec3::splat(f32::MIN), max: Vec3::splat(f32::MAX) };
        assert!(QuantisationGrid::over(&widest).place(widest.max).is_finite());
    }
}
