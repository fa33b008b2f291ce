//! The order of objects: by size class, then by Morton code of column, row and depth.

use super::{Settings, THICKNESS};
use crate::id::ID;
use accel::image_space::{ImageSpace, Pixels};
use accel::morton::{self, BITS, spread};
use accel::parallel::prelude::*;
use accel::parallel::{extend, map_tasks};
use accel::{Aabb, Bounds, BuildError, Cancel, Projection, Raster, concatenated};
use lanes::{Level, Simd, Task};

/// Where the image shows an object.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Shown {
    /// The object.
    pub id: u32,
    /// First and last slice of rows.
    pub rows: [u32; 2],
    /// First and last slice of columns.
    pub cols: [u32; 2],
    /// Lower bound of t.
    pub depth: f32,
}

/// Objects projected side by side.
const LANES: usize = 8;

/// Objects handled by one task.
const CHUNK: usize = 1 << 14;

/// The objects that both a row plane and a column plane touch, task by task.
pub(super) fn shown<B: Bounds + Copy>(
    objects: B,
    raster: &Raster,
    simd: Level,
    cancel: Cancel,
) -> Result<Vec<Vec<Shown>>, BuildError> {
    let space = ImageSpace::new(raster);
    let of = |first: usize| {
        cancel.check(ID)?;
        simd.run(Projected { objects, space: &space, first })
    };
    map_tasks(objects.len().div_ceil(CHUNK), &|i| of(i * CHUNK)).into_iter().collect()
}

/// Those of all tasks.
pub(super) fn joined(mut shown: Vec<Vec<Shown>>) -> Result<Vec<Shown>, BuildError> {
    if shown.len() > 1 { concatenated(ID, &shown) } else { Ok(shown.pop().unwrap_or_default()) }
}

/// The objects shown of [`CHUNK`] objects.
struct Projected<'a, O> {
    objects: O,
    space: &'a ImageSpace,
    first: usize,
}

impl<B: Bounds> Task for Projected<'_, B> {
    type Out = Result<Vec<Shown>, BuildError>;

    #[inline(always)]
    fn run<S: Simd>(self, _: S) -> Self::Out {
        let end = self.objects.len().min(self.first + CHUNK);
        let mut shown = accel::reserved(ID, end - self.first)?;
        for first in (self.first..end).step_by(LANES) {
            let mut bounds = [Aabb::EMPTY; LANES];
            for (lane, bounds) in bounds.iter_mut().enumerate() {
                *bounds = self.objects.bounds((first + lane).min(end - 1) as u32);
            }
            let pixels = self.space.pixels_of(&bounds);
            for lane in 0..LANES.min(end - first) {
                let seen = pixels.lane(lane);
                if !seen.is_empty() {
                    let Pixels { rows, cols, near } = seen;
                    shown.push(Shown {
                        id: (first + lane) as u32,
                        rows: [rows.start / THICKNESS, (rows.end - 1) / THICKNESS],
                        cols: [cols.start / THICKNESS, (cols.end - 1) / THICKNESS],
                        depth: near,
                    });
                }
            }
        }
        Ok(shown)
    }
}

/// The places of `shown` in the order of blocks, each in the lower half of its key.
pub(super) fn sorted(shown: &[Shown], raster: &Raster, settings: &Settings) -> Result<Vec<u64>, BuildError> {
    let side = raster.rows.max(raster.cols).div_ceil(THICKNESS).max(1);
    // Code units: the image's longer side has 2^BITS of them, so a slice has `slice`.
    let slice = (1 << BITS) as f32 / side as f32;
    // Counted from the far end: what has no room in a code is next to the eye, and little.
    let far = shown.par_iter().with_min_len(CHUNK).map(|s| s.depth).reduce(|| 0.0, f32::max);
    // A block is as deep as it is wide where a unit of depth is as long as a unit of the image: everywhere for
    // parallel projection, and by the logarithm for perspective.
    let pixel = raster.right.length().max(f32::MIN_POSITIVE) / raster.forward.length();
    let unit = slice / THICKNESS as f32 / pixel / (1 << settings.depth_bits) as f32;
    let deep = |depth: f32| match raster.projection {
        Projection::Parallel => (far - depth) * unit,
        Projection::Perspective => (far / depth).ln() * unit,
    };
    let large = settings.large;
    let last = ((1 << BITS) - 1) as f32;
    let code = |s: &Shown| {
        let middle = |[a, b]: [u32; 2]| (((a + b) as f32 * 0.5 * slice) as u32).min((1 << BITS) - 1);
        let size = (s.rows[1] - s.rows[0]).max(s.cols[1] - s.cols[0]) + 1;
        let class = u32::from(size > large) + u32::from(size > 4 * large) + u32::from(size > 16 * large);
        let z = (last - deep(s.depth)).clamp(0.0, last) as u32;
        class << (3 * BITS) | spread(middle(s.cols)) << 2 | spread(middle(s.rows)) << 1 | spread(z)
    };
    let keyed = |i| morton::keyed(code(&shown[i]), i as u32);
    let mut keys = accel::reserved(ID, shown.len())?;
    extend(&mut keys, (0..shown.len()).into_par_iter().with_min_len(CHUNK).map(keyed));
    accel::keys::sort(ID, keys)
}
