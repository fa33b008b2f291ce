//! Maps of space: R, S and T for slices along x, y and z (Skala 1993, §5).

use super::Axis;
use accel::grid::Grid;
use accel::{Bounds, BuildError};
use lanes::ones;

/// The bit maps of a grid: ⁱR & ʲS & ᵏT are the candidates of cell (i, j, k).
#[derive(Clone, Debug)]
pub struct SpaceMaps {
    /// The slices; its bounds hold all objects' boxes.
    pub grid: Grid,
    /// R, S and T.
    pub axes: [Axis; 3],
    /// Maps above these, level by level up to one word a slice; none in the paper.
    pub above: Vec<[Axis; 3]>,
}

impl SpaceMaps {
    /// Maps the boxes of `objects`, which must lie in the grid's bounds.
    ///
    /// # Panics
    /// If memory doesn't hold the maps.
    pub fn new<B: Bounds>(objects: &B, grid: Grid) -> Self {
        Self::try_new(objects, grid).unwrap_or_else(|error| panic!("{error}"))
    }

    /// As [`SpaceMaps::new`].
    ///
    /// # Errors
    /// [`BuildError::TooLarge`] if memory doesn't hold the maps.
    pub fn try_new<B: Bounds>(objects: &B, grid: Grid) -> Result<Self, BuildError> {
        let axis = |a: usize| Axis::try_new(grid.resolution()[a] as usize, objects.len());
        let mut axes = [axis(0)?, axis(1)?, axis(2)?];
        for id in 0..objects.len() as u32 {
            let bounds = objects.bounds(id);
            for (axis, maps) in axes.iter_mut().enumerate() {
                maps.touch(grid.slices(axis, &bounds), id);
            }
        }
        Ok(Self { grid, axes, above: Vec::new() })
    }

    /// With maps above maps, until a slice has no more than one word.
    ///
    /// # Errors
    /// [`BuildError::TooLarge`] if memory doesn't hold them.
    pub fn with_levels(mut self) -> Result<Self, BuildError> {
        loop {
            let [x, y, z] = self.above.last().unwrap_or(&self.axes);
            if x.words() <= 1 {
                return Ok(self);
            }
            let above = [x.above()?, y.above()?, z.above()?];
            self.above.push(above);
        }
    }

    /// Bytes of the maps of [`SpaceMaps::with_levels`].
    pub fn bytes_of_levels(resolution: [u32; 3], objects: usize) -> u128 {
        let above = objects.div_ceil(64);
        let more = if above > 1 { Self::bytes_of_levels(resolution, above) } else { 0 };
        Self::bytes_of(resolution, objects) + more
    }

    /// Bytes of the maps of so many objects: M_BMSSM.
    pub fn bytes_of(resolution: [u32; 3], objects: usize) -> u128 {
        resolution.map(|n| Axis::bytes_of(n as usize, objects)).iter().sum()
    }

    /// Bytes held.
    pub fn bytes(&self) -> usize {
        let maps: usize = self.above.iter().flatten().chain(&self.axes).map(Axis::bytes).sum();
        maps + accel::vec_bytes(&self.above)
    }

    /// The maps of the three slices that meet in a cell.
    #[inline]
    pub fn cell(&self, slice: [u32; 3]) -> [&[u64]; 3] {
        [0, 1, 2].map(|axis| self.axes[axis].slice(slice[axis]))
    }

    /// Sum of the candidates of all cells, counting each object by the slices it touches: q·N³.
    pub fn references(&self) -> u64 {
        let mut touched = vec![[0u64; 3]; self.axes[0].objects()];
        for (axis, maps) in self.axes.iter().enumerate() {
            for slice in 0..maps.len() as u32 {
                for (word, bits) in maps.slice(slice).iter().copied().enumerate() {
                    ones(bits).for_each(|bit| touched[word * 64 + bit][axis] += 1);
                }
            }
        }
        touched.iter().map(|[x, y, z]| x * y * z).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use accel::{Aabb, Vec3};
    use primitives::Boxes;

    /// Skala 1993, §5: M_BMSSM = 3·N·p bits.
    #[test]
    fn a_cell_holds_what_touches_it_and_the_maps_take_3np_bits() {
        let boxes: Vec<Aabb> = (0..128)
            .map(|i| Vec3::new(i as f32, (i % 8) as f32 * 16.0, 64.0))
            .map(|min| Aabb { min, max: min + 0.5 })
            .collect();
        let objects = Boxes::new(&boxes);
        let grid = Grid::new(Bounds::hull(&objects), [8; 3]).unwrap();
        let maps = SpaceMaps::new(&objects, grid);
        assert_eq!(maps.bytes() * 8, 3 * 8 * 128);
        assert_eq!(maps.bytes() as u128, SpaceMaps::bytes_of([8; 3], 128));
        let mut references = 0;
        for cell in (0..512).map(|i| [i % 8, i / 8 % 8, i / 64]) {
            let [r, s, t] = maps.cell(cell);
            for id in 0..128u32 {
                let word = id as usize / 64;
                let bit = (r[word] & s[word] & t[word]) >> (id % 64) & 1 == 1;
                let touches = (0..3).all(|axis| grid.slices(axis, &objects.bounds(id)).contains(&cell[axis]));
                assert_eq!(bit, touches);
                references += u64::from(bit);
            }
        }
        assert_eq!(maps.references(), references);
        let levels = maps.with_levels().unwrap();
        let list = accel::vec_bytes(&levels.above);
        assert_eq!((levels.bytes() - list) as u128, SpaceMaps::bytes_of_levels([8; 3], 128));
    }
}
