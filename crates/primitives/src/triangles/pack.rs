//! Packing triangles in an order.

use super::{TriangleBlocks, Triangles};
use crate::Kernel;
use crate::kernel::Storage;
use accel::parallel::for_each_chunk;
use accel::{BuildError, MeshRef, filled};
use lanes::Ids;
use lanes::{BLOCK, EMPTY_SLOT, ROW, prefetch};

/// Groups by which memory is asked for before it is needed; twice as many for what says where.
const AHEAD: usize = 2;

/// Groups packed by one task.
const TASK: usize = 512;

/// Slot i holds triangle `order[i]`, or nothing for [`EMPTY_SLOT`].
pub(super) fn blocks<'s, K: Kernel>(
    triangles: &Triangles<'s, K>,
    structure: &str,
    order: &[u32],
) -> Result<TriangleBlocks<'s, K>, BuildError> {
    let groups = order.len().div_ceil(BLOCK) * (BLOCK / ROW);
    let (shape, scale, each) = (triangles.shape, triangles.frame.scale, K::Storage::units::<K>());
    let mut units = filled(structure, K::Storage::EMPTY, groups * each)?;
    for_each_chunk(&mut units, TASK * each, &|task, units| {
        for (group, units) in (task * TASK..).zip(units.chunks_exact_mut(each)) {
            ask_ahead(shape.mesh, order, group);
            for (lane, id) in taken(order, group) {
                let corners = shape.mesh.corners(id as usize);
                shape.storage.pack::<K>(&corners, scale, units, lane);
            }
        }
    });
    Ok(TriangleBlocks { triangles: *triangles, units, ids: Ids::new(structure, order)?, in_place: false })
}

/// Slot i holds triangle `order[i]`, of which nothing is copied.
pub(super) fn blocks_in_place<'s, K: Kernel>(
    triangles: &Triangles<'s, K>,
    structure: &str,
    order: &[u32],
) -> Result<TriangleBlocks<'s, K>, BuildError> {
    let ids = Ids::new(structure, order)?;
    Ok(TriangleBlocks { triangles: *triangles, units: Vec::new(), ids, in_place: true })
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
