//! The boxes of all objects, and where their centres lie along a Morton curve.

use crate::id::ID;
use accel::grid::Grid;
use accel::parallel::prelude::*;
use accel::{Aabb, Bounds, BuildError, Cancel, Vec3, filled, morton, zeroed};
use lanes::split::{Extremes, Item, UnitBox, whole};
use lanes::{Level, ROW, Simd, Task};

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

/// Objects whose boxes are computed at a time.
const PIECE: usize = 64;

impl Scene {
    /// Of all objects.
    ///
    /// # Errors
    /// [`BuildError::TooLarge`] if the system doesn't give the memory, and [`BuildError::Cancelled`].
    pub fn new<B: Bounds>(objects: &B, simd: Level, cancel: Cancel) -> Result<Self, BuildError> {
        let bounds = objects.hull();
        let bounds = if bounds.is_empty() { Aabb::of_points([Vec3::ZERO]) } else { bounds };
        let frame = Grid::new(bounds, [1; 3]).expect("one slice is always allowed");
        let extent = bounds.extent();
        let longest = extent.max_element();
        let extent = (if longest > 0.0 { extent / longest } else { extent }).to_array();
        cancel.check(ID)?;
        let spread = Spread::of(objects);
        let curve = spread.curve(&frame, extent);
        let unit = Unit { objects, frame: &frame, curve, extent };
        let (mut items, mut keys) = (filled(ID, Item::EMPTY, objects.len())?, zeroed(ID, objects.len())?);
        let chunks = items.par_chunks_mut(CHUNK).zip(keys.par_chunks_mut(CHUNK)).enumerate();
        chunks.for_each(|(chunk, (items, keys))| {
            if !cancel.is_asked() {
                simd.run(Make { unit: &unit, first: chunk * CHUNK, items, keys });
            }
        });
        cancel.check(ID)?;
        Ok(Self { frame, extent, items, keys })
    }
}

/// About so many objects say how all spread.
const SAMPLE: usize = 1 << 12;

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
    /// That of a sample, at odd steps, as meshes come in pairs and fours.
    fn of<B: Bounds>(objects: &B) -> Self {
        let mut spread = Self::default();
        for id in (0..objects.len()).step_by((objects.len() / SAMPLE) | 1) {
            let Aabb { min, max } = objects.bounds(id as u32);
            for axis in 0..3 {
                let center = 0.5 * f64::from(min[axis]) + 0.5 * f64::from(max[axis]);
                spread.sum[axis] += center;
                spread.squares[axis] += center * center;
            }
            spread.count += 1;
        }
        spread
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
struct Unit<'a, B> {
    objects: &'a B,
    frame: &'a Grid,
    curve: Curve,
    extent: [f32; 3],
}

/// Makes the items and keys of consecutive objects.
struct Make<'a, B> {
    unit: &'a Unit<'a, B>,
    first: usize,
    items: &'a mut [Item],
    keys: &'a mut [u64],
}

impl<B: Bounds> Task for Make<'_, B> {
    type Out = ();

    #[inline(always)]
    fn run<S: Simd>(self, s: S) {
        let pieces = self.items.chunks_mut(PIECE).zip(self.keys.chunks_mut(PIECE));
        for ((items, keys), first) in pieces.zip((self.first..).step_by(PIECE)) {
            self.unit.piece(s, first as u32, items, keys);
        }
    }
}

impl<B: Bounds> Unit<'_, B> {
    /// Makes up to [`PIECE`] items and keys. One step is done for all before the next, as the steps of one object wait for each other.
    #[inline(always)]
    fn piece<S: Simd>(&self, s: S, first: u32, items: &mut [Item], keys: &mut [u64]) {
        for (item, id) in items.iter_mut().zip(first..) {
            let Aabb { min, max } = self.objects.bounds(id);
            *item = Item::new(0, 0, &UnitBox { min: min.to_array(), max: max.to_array() });
        }
        let (origin, inverse) = self.frame.to_unit();
        let both = |[x, y, z]: [f64; 3], sign: f64| [x, y, z, 0.0, sign * x, sign * y, sign * z, 0.0];
        let (origin, inverse) = (both(origin, -1.0), both(inverse, 1.0));
        for Item(Extremes { low, high }) in &mut *items {
            for lane in 0..4 {
                low[lane] = ((f64::from(low[lane]) - origin[lane]) * inverse[lane]) as f32;
                high[lane] = ((f64::from(high[lane]) - origin[lane + 4]) * inverse[lane + 4]) as f32;
            }
        }
        let (mut cells, mut large) = ([[0.0; PIECE]; 3], [0; PIECE / ROW]);
        for (at, items) in (0..).step_by(S::LANES).zip(items.chunks(S::LANES)) {
            let (mut lows, mut highs) = ([&items[0].0.low; ROW], [&items[0].0.high; ROW]);
            for (lane, Item(Extremes { low, high })) in items.iter().enumerate() {
                (lows[lane], highs[lane]) = (low, high);
            }
            let (lows, highs) = (s.load_quads(&lows), s.load_quads(&highs));
            let mut size = s.splat(0.0);
            for (axis, (from, per_unit)) in self.curve.iter().enumerate() {
                let (low, high) = (lows[axis], highs[axis]);
                let center = s.mul(s.splat(0.5), s.sub(low, high));
                let cell = s.mul(s.sub(center, s.splat(*from)), s.splat(*per_unit));
                s.store(s.min(s.max(cell, s.splat(0.0)), s.splat(LAST_CELL)), &mut cells[axis][at..]);
                let side = s.sub(s.sub(s.splat(0.0), low), high);
                size = s.max(size, s.mul(side, s.splat(self.extent[axis])));
            }
            large[at / ROW] |= s.bits(s.lt(s.splat(LARGE), size)) << (at % ROW);
        }
        let mut codes = [0; PIECE];
        for (axis, cells) in cells.iter().enumerate() {
            for (code, cell) in codes.iter_mut().zip(cells) {
                *code |= morton::spread(whole(*cell)) << axis;
            }
        }
        for (i, (item, key)) in items.iter_mut().zip(keys).enumerate() {
            let id = first + i as u32;
            (item.0.low[3], item.0.high[3]) = (f32::from_bits(id), f32::from_bits(1));
            *key = morton::keyed(codes[i] | (large[i / ROW] >> (i % ROW) & 1) << 31, id);
        }
    }
}

/// The last cell of the curve on an axis.
const LAST_CELL: f32 = ((1 << morton::BITS) - 1) as f32;

#[cfg(test)]
mod tests {
    use super::*;
    use primitives::Boxes;

    /// Boxes of many sizes far from the origin.
    fn boxes(count: usize) -> Vec<Aabb> {
        let mut numbers = accel::testing::Numbers(count as u64);
        let mut one = |i: usize| {
            let scale = if i % 50 == 7 { 60.0 } else { 0.5f32.powi(i as i32 % 12) };
            let (min, size) = (numbers.vec3() * 100.0 + 1e4, (0.5 + numbers.vec3()) * scale);
            Aabb { min, max: min + size }
        };
        (0..count).map(&mut one).collect()
    }

    #[test]
    fn items_and_keys_are_those_of_each_object_alone() {
        for count in [0, 1, 15, 64, 65, 200, CHUNK + 70] {
            let boxes = boxes(count);
            let objects = Boxes::new(&boxes);
            for level in Level::here() {
                let scene = Scene::new(&objects, level, Cancel::NEVER).unwrap();
                let curve = Spread::of(&objects).curve(&scene.frame, scene.extent);
                assert_eq!((scene.items.len(), scene.keys.len()), (count, count));
                for (id, (item, key)) in scene.items.iter().zip(&scene.keys).enumerate() {
                    let bounds = Bounds::bounds(&objects, id as u32);
                    let unit = |corner: Vec3| {
                        [0, 1, 2].map(|axis| scene.frame.unit(axis, f64::from(corner[axis])) as f32)
                    };
                    let (min, max) = (unit(bounds.min), unit(bounds.max));
                    assert_eq!(item.bounds(), UnitBox { min, max });
                    assert_eq!((item.number(), item.weight()), (id as u32, 1));
                    let mut code = 0;
                    for (axis, (from, cells)) in curve.iter().enumerate() {
                        let cell = (0.5 * (min[axis] + max[axis]) - from) * cells;
                        code |= morton::spread(whole(cell.clamp(0.0, LAST_CELL))) << axis;
                    }
                    let size = (0..3).map(|axis| (max[axis] - min[axis]) * scene.extent[axis]);
                    let large = size.fold(0.0, f32::max) > LARGE;
                    assert_eq!(*key, morton::keyed(code | u32::from(large) << 31, id as u32));
                    assert_eq!(is_large(*key), large);
                }
                assert!(count < 200 || scene.keys.iter().any(|key| is_large(*key)));
            }
        }
    }
}
