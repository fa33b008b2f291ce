//! The boxes of all objects, and where their centres lie along a Morton curve.

use crate::id::ID;
use accel::grid::Grid;
use accel::parallel::map_chunks;
use accel::parallel::prelude::*;
use accel::{Aabb, Bounds, BuildError, Cancel, Vec3, filled, morton};
use lanes::split::{Extremes, Item, UnitBox, whole};
use lanes::{Level, Simd, Task};

/// What an order is made of.
pub struct Scene {
    /// One cell over the scene: unit coordinates are 0 at its lower side and 1 at its upper.
    pub frame: Grid,
    /// True extents of the unit coordinates' axes, up to a common factor.
    pub extent: [f32; 3],
    /// The boxes of all objects in unit coordinates, by number.
    pub items: Vec<Item>,
    /// Keys along a Morton curve through their centres, those of large objects after all others, with their numbers.
    pub keys: Vec<u64>,
}

/// The part of the scene's longest side from which on an object is large.
const LARGE: f32 = 0.25;

/// Whether a key is that of a large object. They are kept apart: one of them makes its whole block as large.
#[inline(always)]
pub fn is_large(key: u64) -> bool {
    key >> 63 != 0
}

/// Objects handled by one task.
const CHUNK: usize = 1 << 12;

impl Scene {
    /// Of all objects.
    ///
    /// # Errors
    /// [`BuildError::TooLarge`] if the system doesn't give the memory, and [`BuildError::Cancelled`].
    pub fn new<B: Bounds>(objects: &B, simd: Level, cancel: Cancel) -> Result<Self, BuildError> {
        let mut items = filled(ID, Item(Extremes { low: [0.0; 4], high: [0.0; 4] }), objects.len())?;
        let found = map_chunks(&mut items, CHUNK, &|chunk, items| {
            if cancel.is_asked() {
                return (Extremes::NONE, Spread::default());
            }
            simd.run(Found { objects, first: chunk * CHUNK, items })
        });
        cancel.check(ID)?;
        let (mut all, mut spread) = (Extremes::NONE, Spread::default());
        for (range, part) in &found {
            all.gather_signed(range);
            spread.add(part);
        }
        let UnitBox { min, max } = all.bounds();
        let bounds = Aabb { min: Vec3::from(min), max: Vec3::from(max) };
        let bounds = if bounds.is_empty() { Aabb::of_points([Vec3::ZERO]) } else { bounds };
        let frame = Grid::new(bounds, [1; 3]).expect("one slice is always allowed");
        let extent = bounds.extent();
        let longest = extent.max_element();
        let extent = (if longest > 0.0 { extent / longest } else { extent }).to_array();
        let curve = spread.curve(&frame, extent);
        let mut keys = accel::zeroed(ID, items.len())?;
        let chunks = items.par_chunks_mut(CHUNK).zip(keys.par_chunks_mut(CHUNK));
        chunks.for_each(|(items, keys)| {
            if !cancel.is_asked() {
                simd.run(Unit { frame: &frame, curve, extent, items, keys });
            }
        });
        cancel.check(ID)?;
        Ok(Self { frame, extent, items, keys })
    }
}

/// Boxes as the objects give them.
struct Found<'a, O> {
    objects: &'a O,
    first: usize,
    items: &'a mut [Item],
}

impl<B: Bounds> Task for Found<'_, B> {
    type Out = (Extremes, Spread);

    #[inline(always)]
    fn run<S: Simd>(self, _: S) -> (Extremes, Spread) {
        let (mut all, mut spread) = (Extremes::NONE, Spread::default());
        for (item, id) in self.items.iter_mut().zip(self.first as u32..) {
            let Aabb { min, max } = self.objects.bounds(id);
            *item = Item::new(id, 1, &UnitBox { min: min.to_array(), max: max.to_array() });
            all.gather_signed(&item.extremes());
        }
        for item in self.items.iter().step_by(SPARSE) {
            for axis in 0..3 {
                let center = 0.5 * f64::from(item.0.low[axis]) - 0.5 * f64::from(item.0.high[axis]);
                spread.sum[axis] += center;
                spread.squares[axis] += center * center;
            }
            spread.count += 1;
        }
        (all, spread)
    }
}

/// Of so many objects one is enough to say how they spread; it is odd, as meshes come in pairs and fours.
const SPARSE: usize = 7;

/// Sums over the centres of boxes.
#[derive(Clone, Copy, Default)]
struct Spread {
    count: usize,
    sum: [f64; 3],
    squares: [f64; 3],
}

/// For each axis where the curve begins, and its cells to a unit; in unit coordinates.
type Curve = [(f32, f32); 3];

impl Spread {
    fn add(&mut self, other: &Self) {
        self.count += other.count;
        for axis in 0..3 {
            self.sum[axis] += other.sum[axis];
            self.squares[axis] += other.squares[axis];
        }
    }

    /// A curve over what lies within three standard deviations, so that a few objects far away don't put all
    /// others into a few cells. Cells are as wide as they are long.
    fn curve(&self, frame: &Grid, extent: [f32; 3]) -> Curve {
        let (mut from, mut longest) = ([0.0; 3], 0.0f32);
        for axis in 0..3 {
            let mean = self.sum[axis] / self.count.max(1) as f64;
            let deviation = (self.squares[axis] / self.count.max(1) as f64 - mean * mean).max(0.0).sqrt();
            from[axis] = frame.unit(axis, mean - 3.0 * deviation).clamp(0.0, 1.0) as f32;
            let end = frame.unit(axis, mean + 3.0 * deviation).clamp(0.0, 1.0) as f32;
            longest = longest.max((end - from[axis]) * extent[axis]);
        }
        let cells = if longest > 0.0 { ((1 << morton::BITS) - 1) as f32 / longest } else { 0.0 };
        [0, 1, 2].map(|axis| (from[axis], cells * extent[axis]))
    }
}

/// From the scene's coordinates to unit coordinates and to the curve.
struct Unit<'a> {
    frame: &'a Grid,
    curve: Curve,
    extent: [f32; 3],
    items: &'a mut [Item],
    keys: &'a mut [u64],
}

impl Task for Unit<'_> {
    type Out = ();

    #[inline(always)]
    fn run<S: Simd>(self, _: S) {
        let unit = |axis: usize, value: f32| self.frame.unit(axis, f64::from(value)) as f32;
        let last = ((1 << morton::BITS) - 1) as f32;
        for (item, key) in self.items.iter_mut().zip(self.keys) {
            let mut sum = 0;
            for (axis, (from, cells)) in self.curve.iter().enumerate() {
                item.0.low[axis] = unit(axis, item.0.low[axis]);
                item.0.high[axis] = -unit(axis, -item.0.high[axis]);
                let cell = ((0.5 * item.center(axis) - from) * cells).clamp(0.0, last);
                sum |= morton::spread(whole(cell)) << axis;
            }
            let size = |axis: usize| -(item.0.low[axis] + item.0.high[axis]) * self.extent[axis];
            let large = size(0).max(size(1)).max(size(2)) > LARGE;
            *key = morton::keyed(sum | u32::from(large) << 31, item.number());
        }
    }
}
