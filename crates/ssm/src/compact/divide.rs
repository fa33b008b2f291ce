//! Division of cells that hold much into bricks of their own, as often as it pays: the nested
//! grids of D. Jevans and B. Wyvill, *Adaptive Voxel Subdivision for Ray Tracing*, Graphics
//! Interface 1989, in the layout of the grid itself.

use super::brick::{BRICK, cell_of};
use super::bricks::{BrickGrid, at_level, places};
use super::order::GROUP;
use super::{BRICK_BYTES, Cells, ID};
use crate::register::Limit;
use accel::grid::Grid;
use accel::parallel::prelude::*;
use accel::{Bounds, BuildError, Cancel, append, make_room, reserved};
use lanes::EMPTY_SLOT;
use std::ops::Range;
use std::sync::OnceLock;
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
    /// Why a tree could not be grown.
    failed: OnceLock<BuildError>,
    cancel: Cancel<'c>,
}

impl Allowance<'_> {
    /// Whether it is over: what has been grown is dropped.
    fn is_over(&self) -> bool {
        let taken = u128::from(self.taken.load(Relaxed));
        taken > self.bytes || self.failed.get().is_some() || self.cancel.is_asked()
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
    let is_crowded = |cell: &u32| cells.length(*cell as usize) >= least;
    let all = 0..own as u32;
    let count = all.clone().into_par_iter().map(|cell| usize::from(is_crowded(&cell))).sum();
    if count == 0 {
        return Ok(cells);
    }
    let held = limit.less((order.len() * size_of::<Slices>() + count * size_of::<u32>()) as u128)?;
    let mut crowded = reserved(ID, count)?;
    crowded.extend(all.filter(is_crowded));
    let slices = Slices::of_all(bricks, objects, order, (limit, cancel))?;
    crowded.par_iter_mut().for_each(|cell| {
        let (place, groups) = (bricks.place(*cell), cells.list(*cell as usize));
        if !cancel.is_asked() && !is_worth(groups, &slices, place, bricks.levels(), gain) {
            *cell = NONE;
        }
    });
    cancel.check(ID)?;
    crowded.retain(|cell| *cell != NONE);
    let held = held.less(crowded.len() as u128 * size_of::<(u32, Tree)>() as u128)?;
    let mut trees = reserved(ID, crowded.len())?;
    trees.extend(crowded.into_iter().map(|cell| (cell, Tree::default())));
    // In the end there are the undivided cells, the trees, and both of them joined.
    let undivided = bricks.occupied.len() as u128 * (BRICK_BYTES + 8) + cells.references.len() as u128 * 4;
    let bytes = held.bytes.saturating_sub(2 * undivided) / 2;
    let allowance = Allowance { bytes, taken: AtomicU64::new(0), failed: OnceLock::new(), cancel };
    trees.par_iter_mut().for_each(|(cell, tree)| {
        if allowance.is_over() {
            return;
        }
        let (place, groups) = (bricks.place(*cell), cells.list(*cell as usize));
        match Tree::of_cell(groups, &slices, place, bricks.levels(), gain, &allowance) {
            Ok(grown) => *tree = grown,
            // Where another thread failed first, its error is as good.
            Err(error) => drop(allowance.failed.set(error)),
        }
    });
    trees.retain(|(_, tree)| !tree.occupied.is_empty());
    cancel.check(ID)?;
    if let Some(error) = allowance.failed.into_inner() {
        return Err(error);
    }
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
    join(&cells, bricks, trees, cancel)
}

/// In the place of a cell that is not to be divided; there are fewer cells.
const NONE: u32 = u32::MAX;

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
fn members(
    groups: &[u32],
    slices: &[Slices],
    place: [u32; 3],
    levels: u32,
) -> Result<Vec<Member>, BuildError> {
    let mut members = Vec::new();
    for group in groups {
        for slices in slices[slots(*group)].iter().filter(|slices| slices.places(place, levels - 1) != 0) {
            let member = Member { group: *group, slices: slices.ranges() };
            if members.last() != Some(&member) {
                append(ID, &mut members, member)?;
            }
        }
    }
    Ok(members)
}

/// Bytes of a brick in a tree.
const TREE_BRICK: u64 = 4 * BRICK as u64 + 16;

impl Tree {
    /// The tree of a cell that holds these groups; without a brick where dividing does not pay or is not allowed.
    fn of_cell(
        groups: &[u32],
        slices: &[Slices],
        place: [u32; 3],
        levels: u32,
        gain: f32,
        allowance: &Allowance,
    ) -> Result<Self, BuildError> {
        let members = members(groups, slices, place, levels)?;
        let mut all = reserved(ID, members.len())?;
        all.extend(&members);
        let mut tree = Self::default();
        tree.grow(&all, place, levels, gain, allowance)?;
        Ok(tree.trimmed())
    }

    /// Adds a brick for the cell at `place`, `levels` above the finest, if that pays and is allowed; says whether it did.
    fn grow(
        &mut self,
        members: &[&Member],
        place: [u32; 3],
        levels: u32,
        gain: f32,
        allowance: &Allowance,
    ) -> Result<bool, BuildError> {
        let mut masks = reserved(ID, members.len())?;
        masks.extend(
            members
                .iter()
                .map(|member| places(&member.slices.each_ref().map(|r| at_level(r, levels - 1)), place)),
        );
        let groups = by_group(members, &masks)?;
        if spared(&groups) < gain || allowance.is_over() {
            return Ok(false);
        }
        allowance.take(TREE_BRICK);
        // Fewer rays come by a smaller cell, and some corners are crowded at any size.
        let gain = 2.0 * gain;
        let brick = self.occupied.len();
        append(ID, &mut self.occupied, groups.iter().fold(0, |all, (_, cells)| all | cells))?;
        append(ID, &mut self.divided, 0)?;
        let first = self.lengths.len();
        make_room(ID, &mut self.lengths, BRICK)?;
        self.lengths.resize(first + BRICK, 0);
        // The children's trees are kept back: all lists of a brick come before those of the next.
        let mut own = Vec::new();
        let mut later = Vec::new();
        for within in (0..BRICK).filter(|within| self.occupied[brick] >> within & 1 != 0) {
            let here = |cells: u64| cells >> within & 1 != 0;
            let start = own.len();
            for (group, _) in groups.iter().filter(|(_, cells)| here(*cells)) {
                append(ID, &mut own, *group)?;
            }
            let mut child = Self::default();
            // No more tests can be spared than there are.
            if levels > 1 && (own.len() - start) as f32 >= gain {
                let mut list = Vec::new();
                for (member, _) in members.iter().zip(&masks).filter(|(_, cells)| here(**cells)) {
                    append(ID, &mut list, *member)?;
                }
                let at = cell_of(place, within as u32);
                if child.grow(&list, at, levels - 1, gain, allowance)? {
                    self.divided[brick] |= 1 << within;
                    own.truncate(start);
                    append(ID, &mut later, (start, child))?;
                    append(ID, &mut own, 0)?;
                }
            }
            self.lengths[first + within] = (own.len() - start) as u32;
        }
        allowance.take(4 * own.len() as u64);
        let start = self.references.len();
        make_room(ID, &mut self.references, own.len())?;
        self.references.append(&mut own);
        for (place, child) in later {
            self.references[start + place] = self.occupied.len() as u32;
            self.append(child)?;
        }
        Ok(true)
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
    fn append(&mut self, mut other: Self) -> Result<(), BuildError> {
        let moved = self.occupied.len() as u32;
        other.renumber(moved);
        make_room(ID, &mut self.occupied, other.occupied.len())?;
        make_room(ID, &mut self.divided, other.divided.len())?;
        make_room(ID, &mut self.lengths, other.lengths.len())?;
        make_room(ID, &mut self.references, other.references.len())?;
        self.occupied.append(&mut other.occupied);
        self.divided.append(&mut other.divided);
        self.lengths.append(&mut other.lengths);
        self.references.append(&mut other.references);
        Ok(())
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
fn by_group(members: &[&Member], masks: &[u64]) -> Result<Vec<(u32, u64)>, BuildError> {
    let mut groups: Vec<(u32, u64)> = Vec::new();
    for (member, cells) in members.iter().zip(masks) {
        match groups.last_mut() {
            Some((group, all)) if *group == member.group => *all |= cells,
            _ => append(ID, &mut groups, (member.group, *cells))?,
        }
    }
    Ok(groups)
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
    cancel: Cancel,
) -> Result<Cells, BuildError> {
    let own_bricks = bricks.occupied.len();
    let within: usize = trees.iter().map(|(_, tree)| tree.occupied.len()).sum();
    let references: usize = trees.iter().map(|(_, tree)| tree.references.len()).sum();
    let kept: usize = cells.references.len()
        - trees.iter().map(|(cell, _)| cells.length(*cell as usize) as usize - 1).sum::<usize>();
    let (mut occupied, mut divided) =
        (reserved(ID, own_bricks + within)?, reserved(ID, own_bricks + within)?);
    let mut joined = Cells {
        positions: reserved(ID, (own_bricks + within) * BRICK + 1)?,
        references: reserved(ID, kept + references)?,
    };
    occupied.extend_from_slice(&bricks.occupied);
    divided.resize(own_bricks, 0u64);
    let mut own = trees.iter();
    let mut coming = own.next();
    let mut first_brick = own_bricks as u32;
    for cell in 0..cells.positions.len() - 1 {
        if cell % SOME == 0 {
            cancel.check(ID)?;
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
