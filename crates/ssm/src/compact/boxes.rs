//! The boxes of groups, and whether it pays to look at them before the objects.

use super::bricks::BrickGrid;
use super::order::GROUP;
use super::segment::UnitBox;
use super::{Cells, ID};
use crate::register::Limit;
use accel::grid::Grid;
use accel::parallel::prelude::*;
use accel::{Aabb, Bounds, BuildError};
use lanes::EMPTY_SLOT;

/// Where a ray that meets a group's cell meets its box more often than this, looking at boxes costs more than it spares: measured
/// on eight scenes, it gains up to 0.50 and loses from 0.63 on (docs/ssm.md).
const WORTHWHILE: f64 = 0.55;

/// Cells looked at to decide.
const SAMPLE: usize = 1 << 12;

/// The boxes of the groups of 16 slots; none where a ray that meets a group's cell mostly meets its box.
///
/// # Errors
/// [`BuildError::TooLarge`] if the limit or the system doesn't give the memory.
pub(super) fn boxes<B: Bounds>(
    objects: &B,
    grid: &Grid,
    bricks: &BrickGrid,
    cells: &Cells,
    slots: &[u32],
    limit: Limit,
) -> Result<Vec<UnitBox>, BuildError> {
    let of_group = |slots: &[u32]| {
        let held = slots.iter().filter(|object| **object != EMPTY_SLOT);
        bricks.unit_box(&held.fold(Aabb::EMPTY, |hull, object| hull.union(objects.bounds(*object))))
    };
    let of_number = |group: u32| of_group(&slots[group as usize * GROUP..][..GROUP]);
    if met(grid, bricks, cells, of_number) > WORTHWHILE {
        return Ok(Vec::new());
    }
    let count = slots.len().div_ceil(GROUP);
    limit.check((count * size_of::<UnitBox>()) as u128)?;
    let mut boxes = accel::reserved(ID, count)?;
    accel::parallel::extend(&mut boxes, slots.par_chunks(GROUP).with_min_len(1 << 8).map(of_group));
    Ok(boxes)
}

/// Of the references in a cell that a ray meets, the part whose boxes it meets too: the mean over cells here and there.
fn met(grid: &Grid, bricks: &BrickGrid, cells: &Cells, box_of: impl Fn(u32) -> UnitBox) -> f64 {
    let count = bricks.count() as usize * super::brick::BRICK;
    let (mut sum, mut references) = (0.0, 0u32);
    for cell in (0..count).step_by((count / SAMPLE).max(1) | 1) {
        if cells.length(cell) == 0 || bricks.divides(cell) {
            continue;
        }
        let slices = bricks.place(cell as u32);
        for group in cells.list(cell) {
            sum += box_of(*group).part_of_cell(slices, grid.resolution());
            references += 1;
        }
    }
    if references == 0 { 0.0 } else { sum / f64::from(references) }
}
