//! Where a kernel finds packed triangles.

use accel::{Corners, Vec3};
use lanes::packet::Vec3Lanes;
use lanes::{Row, Simd};

/// One or more triangles of a group: the rows that [`Kernel::pack`](super::Kernel::pack) wrote, and a lane.
#[derive(Clone, Copy, Debug)]
pub struct Packed<'a> {
    /// The rows of the group.
    pub group: &'a [Row],
    /// The lane of the triangle, or of the first of `LANES`.
    pub lane: usize,
}

impl<'a> Packed<'a> {
    /// Those from a lane on.
    #[inline(always)]
    pub fn new(group: &'a [Row], lane: usize) -> Self {
        Self { group, lane }
    }

    /// The corners of one triangle that [`pack_corners`] wrote.
    #[inline(always)]
    pub(crate) fn corners(self) -> Corners {
        let rows = &self.group[..9];
        let corner =
            |k: usize| Vec3::new(rows[k].0[self.lane], rows[k + 1].0[self.lane], rows[k + 2].0[self.lane]);
        [corner(0), corner(3), corner(6)]
    }

    /// The corners of `LANES` triangles.
    #[inline(always)]
    pub(crate) fn load_corners<S: Simd>(self, s: S) -> [Vec3Lanes<S>; 3] {
        let rows = &self.group[..9];
        [load3(s, &rows[..3], self.lane), load3(s, &rows[3..6], self.lane), load3(s, &rows[6..], self.lane)]
    }

    /// The corners of one triangle in all lanes.
    #[inline(always)]
    pub(crate) fn splat_corners<S: Simd>(self, s: S) -> [Vec3Lanes<S>; 3] {
        let rows = &self.group[..9];
        let lane = self.lane;
        [splat_row3(s, &rows[..3], lane), splat_row3(s, &rows[3..6], lane), splat_row3(s, &rows[6..], lane)]
    }
}

/// Writes corners to the first nine rows.
#[inline(always)]
pub(crate) fn pack_corners(corners: &Corners, group: &mut [Row], lane: usize) {
    for (corner, rows) in corners.iter().zip(group.chunks_exact_mut(3)) {
        for (axis, row) in rows.iter_mut().enumerate() {
            row.0[lane] = corner[axis];
        }
    }
}

/// Three packed values of `LANES` triangles from lane `at` on.
#[inline(always)]
pub(crate) fn load3<S: Simd>(s: S, rows: &[Row], at: usize) -> Vec3Lanes<S> {
    [s.load(&rows[0].0[at..]), s.load(&rows[1].0[at..]), s.load(&rows[2].0[at..])]
}

/// Three packed values of one lane in all lanes.
#[inline(always)]
pub(crate) fn splat_row3<S: Simd>(s: S, rows: &[Row], lane: usize) -> Vec3Lanes<S> {
    [s.splat(rows[0].0[lane]), s.splat(rows[1].0[lane]), s.splat(rows[2].0[lane])]
}
