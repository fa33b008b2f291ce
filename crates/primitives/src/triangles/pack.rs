//! Packing triangles in an order.

use super::{CORNER_ROWS, Kernel, TriangleBlocks, Triangles};
use accel::parallel::for_each_chunk;
use accel::{MeshRef, filled};
use lanes::Ids;
use lanes::{BLOCK, EMPTY_SLOT, ROW, Row, prefetch};

/// Groups by which memory is asked for before it is needed; twice as many for what says where.
const AHEAD: usize = 2;

/// Groups packed by one task.
const TASK: usize = 512;

/// Slot i holds triangle `order[i]`, or nothing for [`EMPTY_SLOT`].
pub(super) fn blocks<'s, K: Kernel>(triangles: &Triangles<'s, K>, order: &[u32]) -> TriangleBlocks<'s, K> {
    let groups = order.len().div_ceil(BLOCK) * (BLOCK / ROW);
    let (mut rows, mut short) = (Vec::new(), Vec::new());
    if K::QUANTISED {
        short = filled([[0; ROW]; CORNER_ROWS], groups);
        for_each_chunk(&mut short, TASK, &|task, groups| {
            for (group, rows) in (task * TASK..).zip(groups) {
                ask_ahead(triangles.mesh, order, group);
                for (lane, id) in taken(order, group) {
                    triangles.lattice.pack(&triangles.mesh.corners(id as usize), rows, lane);
                }
            }
        });
    } else {
        rows = filled(Row([f32::NAN; ROW]), groups * K::ROWS);
        for_each_chunk(&mut rows, TASK * K::ROWS, &|task, rows| {
            for (group, rows) in (task * TASK..).zip(rows.chunks_exact_mut(K::ROWS)) {
                ask_ahead(triangles.mesh, order, group);
                for (lane, id) in taken(order, group) {
                    K::pack(&triangles.frame.corners(&triangles.corners(id)), rows, lane);
                }
            }
        });
    }
    TriangleBlocks { triangles: *triangles, rows, short, ids: Ids::new(order), in_place: false }
}

/// Slot i holds triangle `order[i]`, of which nothing is copied.
pub(super) fn blocks_in_place<'s, K: Kernel>(
    triangles: &Triangles<'s, K>,
    order: &[u32],
) -> TriangleBlocks<'s, K> {
    let ids = Ids::new(order);
    TriangleBlocks { triangles: *triangles, rows: Vec::new(), short: Vec::new(), ids, in_place: true }
}

fn slots(order: &[u32], group: usize) -> impl Iterator<Item = u32> {
    order.iter().skip(group * ROW).take(ROW).copied()
}

/// The triangles of a group with their lanes.
fn taken(order: &[u32], group: usize) -> impl Iterator<Item = (usize, u32)> {
    slots(order, group).enumerate().filter(|(_, id)| *id != EMPTY_SLOT)
}

/// Triangles lie anywhere in memory, their corners anywhere else: both are asked for some groups ahead.
fn ask_ahead(mesh: MeshRef<'_>, order: &[u32], group: usize) {
    for id in slots(order, group + 2 * AHEAD) {
        mesh.triangles.get(id as usize).map(prefetch);
    }
    for id in slots(order, group + AHEAD) {
        for corner in mesh.triangles.get(id as usize).into_iter().flatten() {
            mesh.positions.get(*corner as usize).map(prefetch);
        }
    }
}
