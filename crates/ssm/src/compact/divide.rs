//! Division of cells that hold much into bricks of their own, as often as it pays: the nested
//! grids of D. Jevans and B. Wyvill, *Adaptive Voxel Subdivision for Ray Tracing*, Graphics
//! Interface 1989, in the layout of the grid itself.

use super::field::{BRICK, EDGE, Field, at_level};
use super::order::GROUP;
use super::{BRICK_BYTES, Cells};
use crate::register::Limit;
use accel::parallel::prelude::*;
use accel::{Bounds, BuildError};
use lanes::EMPTY_SLOT;
use std::ops::Range;

/// An object in a cell: its group, and its slices on the finest level.
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

/// Divides the cells for which it spares a ray at least `gain` tests of groups.
///
/// # Errors
/// [`BuildError::TooLarge`] if the result would exceed the limit.
pub(super) fn divide<B: Bounds>(
    cells: Cells,
    field: &mut Field,
    objects: &B,
    order: &[u32],
    gain: f32,
    limit: Limit,
) -> Result<Cells, BuildError> {
    let own = cells.positions.len() - 1;
    if field.levels() == 0 {
        return Ok(cells);
    }
    let least = gain.ceil() as u32 + 1;
    let crowded: Vec<u32> =
        (0..own as u32).into_par_iter().filter(|cell| cells.length(*cell as usize) >= least).collect();
    let trees: Vec<(u32, Tree)> = crowded
        .into_par_iter()
        .filter_map(|cell| {
            let place = field.place(cell);
            let members = members(cells.list(cell as usize), field, objects, order, place);
            let members: Vec<&Member> = members.iter().collect();
            let mut tree = Tree::default();
            tree.grow(&members, place, field.levels(), gain).then_some((cell, tree))
        })
        .collect();
    if trees.is_empty() {
        return Ok(cells);
    }
    let sum = |of: fn(&Tree) -> usize| trees.iter().map(|(_, tree)| of(tree) as u128).sum::<u128>();
    let bricks = field.occupied.len() as u128 + sum(|tree| tree.occupied.len());
    let references = cells.references.len() as u128 + sum(|tree| tree.references.len());
    let bytes = bricks * (BRICK_BYTES + 8) + references * 4;
    let numbered = limit.bytes.min(u128::from(u32::MAX) * 4);
    Limit { bytes: numbered, ..limit }.check(bytes)?;
    Ok(join(&cells, field, trees))
}

/// The objects of these groups that touch the cell at `place`.
fn members<B: Bounds>(
    groups: &[u32],
    field: &Field,
    objects: &B,
    order: &[u32],
    place: [u32; 3],
) -> Vec<Member> {
    let slots = |group: u32| &order[group as usize * GROUP..(group as usize + 1) * GROUP];
    let all = groups.iter().flat_map(|group| slots(*group).iter().map(|object| (*group, *object)));
    let held = all.filter(|(_, object)| *object != EMPTY_SLOT);
    held.map(|(group, object)| Member { group, slices: field.slices(&objects.bounds(object)) })
        .filter(|member| (0..3).all(|a| at_level(&member.slices[a], field.levels()).contains(&place[a])))
        .collect()
}

impl Tree {
    /// Adds a brick for the cell at `place`, `levels` above the finest, if that pays.
    fn grow(&mut self, members: &[&Member], place: [u32; 3], levels: u32, gain: f32) -> bool {
        let mut lists: Vec<Vec<&Member>> = (0..BRICK).map(|_| Vec::new()).collect();
        for member in members {
            let [xs, ys, zs] = [0, 1, 2].map(|a| {
                let slices = at_level(&member.slices[a], levels - 1);
                let first = place[a] * EDGE;
                slices.start.max(first) - first..slices.end.min(first + EDGE) - first
            });
            for z in zs {
                for y in ys.clone() {
                    for x in xs.clone() {
                        lists[(z * 16 + y * 4 + x) as usize].push(member);
                    }
                }
            }
        }
        if spared(members, &lists) < gain {
            return false;
        }
        // Fewer rays come by a smaller cell, and some corners are crowded at any size.
        let gain = 2.0 * gain;
        let brick = self.occupied.len();
        self.occupied.push(0);
        self.divided.push(0);
        let first = self.lengths.len();
        self.lengths.resize(first + BRICK, 0);
        // The children's trees are kept back: all lists of a brick come before those of the next.
        let mut own = Vec::new();
        let mut later = Vec::new();
        for (within, list) in lists.iter().enumerate().filter(|(_, list)| !list.is_empty()) {
            self.occupied[brick] |= 1 << within;
            let mut child = Self::default();
            let at = [within as u32 % EDGE, within as u32 / EDGE % EDGE, within as u32 / (EDGE * EDGE)];
            let at = [0, 1, 2].map(|a| place[a] * EDGE + at[a]);
            if levels > 1 && list.len() > 1 && child.grow(list, at, levels - 1, gain) {
                self.divided[brick] |= 1 << within;
                self.lengths[first + within] = 1;
                later.push((own.len(), child));
                own.push(0);
            } else {
                let start = own.len();
                for member in list {
                    if own[start..].last() != Some(&member.group) {
                        own.push(member.group);
                    }
                }
                self.lengths[first + within] = (own.len() - start) as u32;
            }
        }
        let start = self.references.len();
        self.references.append(&mut own);
        for (place, child) in later {
            self.references[start + place] = self.occupied.len() as u32;
            self.append(child);
        }
        true
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

/// How many tests of groups a ray through the cell is spared by the smaller cells: a group that lies
/// in m of them is met with a probability of m cross-sections out of 16.
fn spared(members: &[&Member], lists: &[Vec<&Member>]) -> f32 {
    let mut groups: Vec<(u32, u32)> = Vec::new();
    for member in members {
        if groups.last().is_none_or(|(group, _)| *group != member.group) {
            groups.push((member.group, 0));
        }
    }
    for list in lists {
        let mut last = u32::MAX;
        for member in list.iter().filter(|member| std::mem::replace(&mut last, member.group) != member.group)
        {
            if let Ok(at) = groups.binary_search_by_key(&member.group, |(group, _)| *group) {
                groups[at].1 += 1;
            }
        }
    }
    groups.iter().map(|(_, cells)| 1.0 - (*cells as f32 / 16.0).min(1.0)).sum()
}

/// The grid's own cells and behind them the bricks of all trees.
fn join(cells: &Cells, field: &mut Field, trees: Vec<(u32, Tree)>) -> Cells {
    let bricks = field.occupied.len();
    let within: usize = trees.iter().map(|(_, tree)| tree.occupied.len()).sum();
    let references: usize = trees.iter().map(|(_, tree)| tree.references.len()).sum();
    let kept: usize = cells.references.len()
        - trees.iter().map(|(cell, _)| cells.length(*cell as usize) as usize - 1).sum::<usize>();
    let mut occupied = Vec::with_capacity(bricks + within);
    let mut divided = Vec::with_capacity(bricks + within);
    let mut joined = Cells {
        positions: Vec::with_capacity((bricks + within) * BRICK + 1),
        references: Vec::with_capacity(kept + references),
    };
    occupied.extend_from_slice(&field.occupied);
    divided.resize(bricks, 0u64);
    let mut own = trees.iter();
    let mut coming = own.next();
    let mut first_brick = bricks as u32;
    for cell in 0..cells.positions.len() - 1 {
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
    field.occupied = occupied.into_boxed_slice();
    field.divided = divided.into_boxed_slice();
    joined
}
