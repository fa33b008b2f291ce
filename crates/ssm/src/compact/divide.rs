//! Division of cells that hold much into bricks of their own, as often as it pays: the nested
//! grids of D. Jevans and B. Wyvill, *Adaptive Voxel Subdivision for Ray Tracing*, Graphics
//! Interface 1989, in the layout of the grid itself.

use super::bricks::{BRICK, BrickGrid, EDGE, at_level, places};
use super::order::GROUP;
use super::{BRICK_BYTES, Cells};
use crate::register::Limit;
use accel::grid::Grid;
use accel::parallel::prelude::*;
use accel::{Bounds, BuildError, Cancel};
use lanes::EMPTY_SLOT;
use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};

/// An object in a cell: its group, and its slices on the finest level.
#[derive(PartialEq)]
struct Member {
    group: u32,
    slices: [Range<u32>; 3],
}

/// Bricks within one cell of the grid. References of divided cells count from this tree's first brick.
#[derive(Default)]
struct Tree {
    occupied: Vec<u64>,
    divided: Vec<u64>,
    /// Length of each cell's list.
    lengths: Vec<u32>,
    references: Vec<u32>,
}

/// What dividing is allowed.
struct Allowance<'c> {
    /// Bytes that all trees may take, and those that they take by now.
    bytes: u128,
    taken: AtomicU64,
    cancel: Cancel<'c>,
}

impl Allowance<'_> {
    /// Whether it is over: what has been grown is dropped.
    fn is_over(&self) -> bool {
        u128::from(self.taken.load(Relaxed)) > self.bytes || self.cancel.is_asked()
    }

    fn take(&self, bytes: u64) {
        self.taken.fetch_add(bytes, Relaxed);
    }
}

/// Divides the cells for which it spares a ray at least `gain` tests of groups.
///
/// # Errors
/// [`BuildError::TooLarge`] if the way to the result would exceed the limit, [`BuildError::Cancelled`].
pub(super) fn divide<B: Bounds>(
    cells: Cells,
    bricks: &mut BrickGrid,
    objects: &B,
    order: &[u32],
    gain: f32,
    (limit, cancel): (Limit, Cancel),
) -> Result<Cells, BuildError> {
    let own = cells.positions.len() - 1;
    if bricks.levels() == 0 {
        return Ok(cells);
    }
    let least = gain.ceil() as u32 + 1;
    let crowded: Vec<u32> =
        (0..own as u32).into_par_iter().filter(|cell| cells.length(*cell as usize) >= least).collect();
    if crowded.is_empty() {
        return Ok(cells);
    }
    let held = limit.less(order.len() as u128 * size_of::<Slices>() as u128)?;
    let slices = Slices::of_all(bricks, objects, order, (limit, cancel))?;
    // In the end there are the undivided cells, the trees, and both of them joined.
    let undivided = bricks.occupied.len() as u128 * (BRICK_BYTES + 8) + cells.references.len() as u128 * 4;
    let bytes = held.bytes.saturating_sub(2 * undivided) / 2;
    let allowance = Allowance { bytes, taken: AtomicU64::new(0), cancel };
    let trees: Vec<(u32, Tree)> = crowded
        .into_par_iter()
        .filter_map(|cell| {
            if allowance.is_over() {
                return None;
            }
            let (place, groups) = (bricks.place(cell), cells.list(cell as usize));
            if !is_worth(groups, &slices, place, bricks.levels(), gain) {
                return None;
            }
            let members = members(groups, &slices, place, bricks.levels());
            let members: Vec<&Member> = members.iter().collect();
            let mut tree = Tree::default();
            let grown = tree.grow(&members, place, bricks.levels(), gain, &allowance);
            grown.then(|| (cell, tree.trimmed()))
        })
        .collect();
    cancel.check(limit.structure)?;
    let taken = u128::from(allowance.taken.into_inner());
    if taken > 0 {
        held.check(2 * (undivided + taken))?;
    }
    if trees.is_empty() {
        return Ok(cells);
    }
    let sum = |of: fn(&Tree) -> usize| trees.iter().map(|(_, tree)| of(tree) as u128).sum::<u128>();
    let references = cells.references.len() as u128 + sum(|tree| tree.references.len());
    // Positions have 32 bits.
    let numbered = Limit { bytes: limit.bytes.min(u128::from(u32::MAX) * 4), ..limit };
    numbered.check(references * 4)?;
    join(&cells, bricks, trees, (limit, cancel))
}

/// Where an object lies, in slices of the finest level, of which there are no more than 16 bits number; nowhere in an empty slot.
#[derive(Clone, Copy, Default)]
struct Slices([[u16; 2]; 3]);

impl Slices {
    const NOWHERE: Self = Self([[0; 2]; 3]);

    /// Those of the object in each slot of `order`.
    fn of_all<B: Bounds>(
        bricks: &BrickGrid,
        objects: &B,
        order: &[u32],
        (limit, cancel): (Limit, Cancel),
    ) -> Result<Vec<Self>, BuildError> {
        const { assert!(Grid::MAX_SLICES <= u16::MAX as u32) };
        let of = |object: &u32| match *object {
            EMPTY_SLOT => Self::NOWHERE,
            object => Self(bricks.slices(&objects.bounds(object)).map(|r| [r.start as u16, r.end as u16])),
        };
        let mut all: Vec<Self> = limit.blank(order.len(), cancel)?;
        all.par_iter_mut().zip(order).with_min_len(1 << 12).for_each(|(slices, object)| *slices = of(object));
        Ok(all)
    }

    fn ranges(&self) -> [Range<u32>; 3] {
        self.0.map(|[start, end]| u32::from(start)..u32::from(end))
    }

    /// The cells of a brick that it touches, whose cells are `levels` above the finest.
    fn places(&self, brick: [u32; 3], levels: u32) -> u64 {
        if self.0[0][1] == 0 {
            return 0;
        }
        places(&self.ranges().map(|r| at_level(&r, levels)), brick)
    }
}

/// The slots of a group.
fn slots(group: u32) -> Range<usize> {
    group as usize * GROUP..(group as usize + 1) * GROUP
}

/// Whether dividing the cell at `place` spares so much ([`spared`]), found out without a list.
fn is_worth(groups: &[u32], slices: &[Slices], place: [u32; 3], levels: u32, gain: f32) -> bool {
    let mut most = groups.len() as f32;
    groups.iter().all(|group| {
        let mut cells = 0u64;
        for slices in &slices[slots(*group)] {
            cells |= slices.places(place, levels - 1);
            if cells.count_ones() >= 16 {
                break;
            }
        }
        most -= (cells.count_ones() as f32 / 16.0).min(1.0);
        most >= gain
    })
}

/// The objects of these groups that touch the cell at `place`; of a group's objects in the same slices one is enough.
fn members(groups: &[u32], slices: &[Slices], place: [u32; 3], levels: u32) -> Vec<Member> {
    let all = groups.iter().flat_map(|group| slices[slots(*group)].iter().map(|slices| (*group, slices)));
    let touching = all.filter(|(_, slices)| slices.places(place, levels - 1) != 0);
    let mut members: Vec<Member> =
        touching.map(|(group, slices)| Member { group, slices: slices.ranges() }).collect();
    members.dedup();
    members
}

/// Bytes of a brick in a tree.
const TREE_BRICK: u64 = 4 * BRICK as u64 + 16;

impl Tree {
    /// Adds a brick for the cell at `place`, `levels` above the finest, if that pays and is allowed.
    fn grow(
        &mut self,
        members: &[&Member],
        place: [u32; 3],
        levels: u32,
        gain: f32,
        allowance: &Allowance,
    ) -> bool {
        let masks: Vec<u64> = members
            .iter()
            .map(|member| places(&member.slices.each_ref().map(|r| at_level(r, levels - 1)), place))
            .collect();
        let groups = by_group(members, &masks);
        if spared(&groups) < gain || allowance.is_over() {
            return false;
        }
        allowance.take(TREE_BRICK);
        // Fewer rays come by a smaller cell, and some corners are crowded at any size.
        let gain = 2.0 * gain;
        let brick = self.occupied.len();
        self.occupied.push(groups.iter().fold(0, |all, (_, cells)| all | cells));
        self.divided.push(0);
        let first = self.lengths.len();
        self.lengths.resize(first + BRICK, 0);
        // The children's trees are kept back: all lists of a brick come before those of the next.
        let mut own = Vec::new();
        let mut later = Vec::new();
        for within in (0..BRICK).filter(|within| self.occupied[brick] >> within & 1 != 0) {
            let here = |cells: u64| cells >> within & 1 != 0;
            let start = own.len();
            own.extend(groups.iter().filter(|(_, cells)| here(*cells)).map(|(group, _)| *group));
            let mut child = Self::default();
            // No more tests can be spared than there are.
            if levels > 1 && (own.len() - start) as f32 >= gain {
                let list: Vec<&Member> =
                    members.iter().zip(&masks).filter(|(_, cells)| here(**cells)).map(|(m, _)| *m).collect();
                let at = [within as u32 % EDGE, within as u32 / EDGE % EDGE, within as u32 / (EDGE * EDGE)];
                let at = [0, 1, 2].map(|a| place[a] * EDGE + at[a]);
                if child.grow(&list, at, levels - 1, gain, allowance) {
                    self.divided[brick] |= 1 << within;
                    own.truncate(start);
                    later.push((start, child));
                    own.push(0);
                }
            }
            self.lengths[first + within] = (own.len() - start) as u32;
        }
        allowance.take(4 * own.len() as u64);
        let start = self.references.len();
        self.references.append(&mut own);
        for (place, child) in later {
            self.references[start + place] = self.occupied.len() as u32;
            self.append(child);
        }
        true
    }

    /// Without room for more.
    fn trimmed(mut self) -> Self {
        self.occupied.shrink_to_fit();
        self.divided.shrink_to_fit();
        self.lengths.shrink_to_fit();
        self.references.shrink_to_fit();
        self
    }

    /// Puts another tree's bricks behind this one's.
    fn append(&mut self, mut other: Self) {
        let moved = self.occupied.len() as u32;
        other.renumber(moved);
        self.occupied.append(&mut other.occupied);
        self.divided.append(&mut other.divided);
        self.lengths.append(&mut other.lengths);
        self.references.append(&mut other.references);
    }

    /// Counts bricks from `moved` on.
    fn renumber(&mut self, moved: u32) {
        let mut at = 0;
        for (cell, length) in self.lengths.iter().enumerate() {
            if self.divided[cell / BRICK] >> (cell % BRICK) & 1 != 0 {
                self.references[at] += moved;
            }
            at += *length as usize;
        }
    }
}

/// Each group with the smaller cells that any of its members reaches.
fn by_group(members: &[&Member], masks: &[u64]) -> Vec<(u32, u64)> {
    let mut groups: Vec<(u32, u64)> = Vec::new();
    for (member, cells) in members.iter().zip(masks) {
        match groups.last_mut() {
            Some((group, all)) if *group == member.group => *all |= cells,
            _ => groups.push((member.group, *cells)),
        }
    }
    groups
}

/// How many tests of groups a ray through the cell is spared by the smaller cells: a group that lies
/// in m of them is met with a probability of m cross-sections out of 16.
fn spared(groups: &[(u32, u64)]) -> f32 {
    groups.iter().map(|(_, cells)| 1.0 - (cells.count_ones() as f32 / 16.0).min(1.0)).sum()
}

/// The grid's own cells and behind them the bricks of all trees.
fn join(
    cells: &Cells,
    bricks: &mut BrickGrid,
    trees: Vec<(u32, Tree)>,
    (limit, cancel): (Limit, Cancel),
) -> Result<Cells, BuildError> {
    let own_bricks = bricks.occupied.len();
    let within: usize = trees.iter().map(|(_, tree)| tree.occupied.len()).sum();
    let references: usize = trees.iter().map(|(_, tree)| tree.references.len()).sum();
    let kept: usize = cells.references.len()
        - trees.iter().map(|(cell, _)| cells.length(*cell as usize) as usize - 1).sum::<usize>();
    let id = limit.structure;
    let (mut occupied, mut divided) =
        (accel::reserved(id, own_bricks + within)?, accel::reserved(id, own_bricks + within)?);
    let mut joined = Cells {
        positions: accel::reserved(id, (own_bricks + within) * BRICK + 1)?,
        references: accel::reserved(id, kept + references)?,
    };
    occupied.extend_from_slice(&bricks.occupied);
    divided.resize(own_bricks, 0u64);
    let mut own = trees.iter();
    let mut coming = own.next();
    let mut first_brick = own_bricks as u32;
    for cell in 0..cells.positions.len() - 1 {
        if cell % SOME == 0 {
            cancel.check(id)?;
        }
        joined.positions.push(joined.references.len() as u32);
        match coming {
            Some((divided_cell, tree)) if *divided_cell as usize == cell => {
                divided[cell / BRICK] |= 1 << (cell % BRICK);
                joined.references.push(first_brick);
                first_brick += tree.occupied.len() as u32;
                coming = own.next();
            }
            _ => joined.references.extend_from_slice(cells.list(cell)),
        }
    }
    for (_, mut tree) in trees {
        tree.renumber(occupied.len() as u32);
        let mut position = joined.references.len() as u32;
        for length in &tree.lengths {
            joined.positions.push(position);
            position += length;
        }
        occupied.append(&mut tree.occupied);
        divided.append(&mut tree.divided);
        joined.references.append(&mut tree.references);
    }
    joined.positions.push(joined.references.len() as u32);
    bricks.occupied = occupied.into_boxed_slice();
    bricks.divided = divided.into_boxed_slice();
    Ok(joined)
}

/// Cells after which it is asked whether to go on.
const SOME: usize = 1 << 16;
