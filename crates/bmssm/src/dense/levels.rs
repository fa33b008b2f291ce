//! Maps above maps: which words of the level below hold any bit (an addition to Skala 1993, who has one level).

use super::{Axis, SpaceMaps};
use accel::Count;
use lanes::next_bit;

/// More levels than any number of objects has: each has a 64th of the words of the one below.
const MAX: usize = 6;

/// The words of a cell that may hold candidates, found from the highest level down.
///
/// A word of ⁱR & ʲS & ᵏT is looked at only if the three bits above it are set, so that a cell costs as many words as have candidates in each map, and
/// a few, instead of a word for each 64 objects of the scene.
pub struct Descent<'a> {
    maps: &'a SpaceMaps,
    slice: [u32; 3],
    /// Of each level: the word's place, and the bits that are left of it.
    place: [usize; MAX],
    bits: [u64; MAX],
    level: usize,
}

impl<'a> Descent<'a> {
    /// The words of a cell; `maps` must have levels.
    #[inline(always)]
    pub fn new(maps: &'a SpaceMaps, slice: [u32; 3], count: &mut impl Count) -> Self {
        let level = maps.above.len();
        let mut descent = Self { maps, slice, place: [0; MAX], bits: [0; MAX], level };
        descent.look(0, count);
        descent
    }

    /// Combines the maps of the level at a word.
    #[inline(always)]
    fn look(&mut self, place: usize, count: &mut impl Count) {
        let axes: &[Axis; 3] = &self.maps.above[self.level - 1];
        self.place[self.level - 1] = place;
        count.words(3);
        self.bits[self.level - 1] = axes[0].slice(self.slice[0])[place]
            & axes[1].slice(self.slice[1])[place]
            & axes[2].slice(self.slice[2])[place];
    }

    /// The place of the next word of the lowest level.
    #[inline(always)]
    pub fn next(&mut self, count: &mut impl Count) -> Option<usize> {
        loop {
            let Some(bit) = next_bit(&mut self.bits[self.level - 1]) else {
                if self.level == self.maps.above.len() {
                    return None;
                }
                self.level += 1;
                continue;
            };
            let below = self.place[self.level - 1] * 64 + bit;
            if self.level == 1 {
                return Some(below);
            }
            self.level -= 1;
            self.look(below, count);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use accel::grid::Grid;
    use accel::{Aabb, NoCount, Vec3};
    use primitives::Boxes;

    /// Two levels above the words: every word with a candidate is found, once and in order.
    #[test]
    fn every_word_with_candidates_is_found_from_above() {
        let boxes: Vec<Aabb> = (0..9000)
            .map(|i| Vec3::new((i * 37 % 101) as f32, (i * 53 % 97) as f32, (i / 300) as f32))
            .map(|min| Aabb { min, max: min + 2.5 })
            .collect();
        let objects = Boxes::new(&boxes);
        let grid = Grid::new(accel::Bounds::hull(&objects), [9, 8, 7]).unwrap();
        let maps = SpaceMaps::new(&objects, grid).with_levels().unwrap();
        assert_eq!(maps.above.len(), 2);
        for cell in (0..9 * 8 * 7).map(|i| [i % 9, i / 9 % 8, i / 72]) {
            let [r, s, t] = maps.cell(cell);
            let wanted: Vec<usize> = (0..r.len()).filter(|i| r[*i] & s[*i] & t[*i] != 0).collect();
            let mut descent = Descent::new(&maps, cell, &mut NoCount);
            let found: Vec<usize> = std::iter::from_fn(|| descent.next(&mut NoCount))
                .filter(|i| r[*i] & s[*i] & t[*i] != 0)
                .collect();
            assert_eq!(found, wanted, "{cell:?}");
        }
    }
}
