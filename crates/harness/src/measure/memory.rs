//! ν_mem of a scene by resolution, three ways.

use crate::record::{Layout, MemoryRow};
use crate::registry::{self, guarded_build_unless};
use accel::{Cancel, Footprint, Group, Scene, Workload};

/// The resolutions of reports.
pub const RESOLUTIONS: [u32; 5] = [8, 16, 32, 64, 128];

/// Bytes that a structure may take for a row: with objects as large as the scene a grid of resolution 128 takes as much as
/// the machine has, for a figure that nobody needs so exactly.
const MAX: u64 = 2 << 30;

/// A row for each resolution: the paper's formulas for the references that a grid registers, its
/// layouts as built, and the compact layouts as built. None if `cancel` was asked for before all were there.
pub fn memory_rows(scene: &Scene, resolutions: &[u32], cancel: Cancel) -> Option<Vec<MemoryRow>> {
    // It has no N: its plan chooses, and is the same at all.
    let sparse = footprint(scene, "bmssm", cancel);
    let row = |n: &u32| {
        let row = row(scene, *n, &sparse, cancel);
        (!cancel.is_asked()).then_some(row)
    };
    resolutions.iter().map(row).collect()
}

fn row(scene: &Scene, n: u32, sparse: &Result<Footprint, String>, cancel: Cancel) -> MemoryRow {
    let objects = scene.geometry.len() as u64;
    let cells = f64::from(n).powi(3);
    let built = |id: &str| footprint(scene, &format!("{id}:resolution={n},memory={MAX}"), cancel);
    let (list, dense) = (built("ssm-list"), built("bmssm-dense"));
    let compact = built("ssm");
    // The compact grid may share a reference between objects, so the lists say how many there are.
    let bytes_each = if objects <= 1 << 16 { 2.0 } else { 4.0 };
    let references = list.as_ref().map_or(0.0, |list| part(list, "ids") / bytes_each);
    let mut row = MemoryRow::by_formula(&scene.id, objects, n, references / cells);
    let layout = |grid: &Result<Footprint, String>, maps: &Result<Footprint, String>| match (grid, maps) {
        (Ok(grid), Ok(maps)) => Some(Layout { ssm: added(grid), bmssm: added(maps) }),
        _ => None,
    };
    row.paper_layouts = layout(&list, &dense);
    row.compact_layouts = layout(&compact, sparse);
    row.error = [&list, &dense, &compact, sparse].into_iter().find_map(|built| built.as_ref().err().cloned());
    row
}

fn footprint(scene: &Scene, spec: &str, cancel: Cancel) -> Result<Footprint, String> {
    let choice = registry::parse(spec).map_err(|error| error.to_string())?;
    let built = guarded_build_unless(&choice, scene, &Workload::GENERAL, cancel);
    built.map(|accel| accel.footprint()).map_err(|failure| failure.to_string())
}

fn added(footprint: &Footprint) -> f64 {
    footprint.bytes(Group::Structure) as f64
}

fn part(footprint: &Footprint, name: &str) -> f64 {
    footprint.parts.iter().filter(|part| part.name == name).map(|part| part.bytes as f64).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;

    #[test]
    fn the_layouts_as_built_follow_the_formulas() {
        let (scene, _) = testing::cloud(2000, 1);
        for row in memory_rows(&scene, &[8, 16], Cancel::NEVER).unwrap() {
            let built = row.paper_layouts.unwrap();
            // The list's pointers have 4 bytes where the formula has 2.
            let cells = f64::from(row.resolution).powi(3);
            assert_eq!(built.ssm, row.formula_2_byte.ssm + 2.0 * cells, "N = {}", row.resolution);
            let maps = built.bmssm / row.formula_2_byte.bmssm;
            assert!((1.0..1.2).contains(&maps), "whole words: {maps}");
            assert!(row.refs_per_cell > 0.0);
        }
    }

    #[test]
    fn an_interruption_leaves_no_rows() {
        let (scene, _) = testing::cloud(2000, 1);
        assert_eq!(memory_rows(&scene, &RESOLUTIONS, Cancel::when(&|| true)), None);
    }
}
