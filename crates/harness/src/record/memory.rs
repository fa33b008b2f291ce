//! Memory of the uniform grid against bit maps, at equal resolution.

use serde::{Deserialize, Serialize};

/// ν_mem of a scene at N slices per axis, three ways (Skala 1993, §5).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MemoryRow {
    /// Scene.
    pub scene: String,
    /// Number of objects, p.
    pub objects: u64,
    /// Slices per axis, N.
    pub resolution: u32,
    /// Mean number of objects per cell, q, as registered in the grid.
    pub refs_per_cell: f64,
    /// The paper's formulas with its 2-byte ids, which can't name more than 65,536 objects.
    pub formula_2_byte: Layout,
    /// The paper's formulas with 4-byte counters, pointers and ids.
    pub formula_4_byte: Layout,
    /// The paper's layouts as built: `ssm-list` and `bmssm-dense`.
    #[serde(default)]
    pub paper_layouts: Option<Layout>,
    /// The compact layouts as built: `ssm` and `bmssm`.
    #[serde(default)]
    pub compact_layouts: Option<Layout>,
    /// Why a layout is absent.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub error: Option<String>,
}

/// Bytes of the grid and of the bit maps.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Layout {
    /// Uniform grid.
    pub ssm: f64,
    /// Bit maps.
    pub bmssm: f64,
}

impl Layout {
    /// ν_mem: the grid's bytes over the bit maps'.
    pub fn ratio(&self) -> f64 {
        self.ssm / self.bmssm
    }
}

impl MemoryRow {
    /// The row by the paper's formulas alone: M_SSM = N³(c + c + q·c) with c bytes a number,
    /// M_BMSSM = 3·N·p bits.
    pub fn by_formula(scene: &str, objects: u64, resolution: u32, refs_per_cell: f64) -> Self {
        let n = f64::from(resolution);
        let layout = |c: f64| Layout {
            ssm: c * n.powi(3) * (refs_per_cell + 2.0),
            bmssm: 3.0 / 8.0 * n * objects as f64,
        };
        Self {
            scene: scene.to_owned(),
            objects,
            resolution,
            refs_per_cell,
            formula_2_byte: layout(2.0),
            formula_4_byte: layout(4.0),
            paper_layouts: None,
            compact_layouts: None,
            error: None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formulas_follow_the_paper() {
        // ν_mem = (16/3)·((q+2)/p)·N²: one object a cell gives 16·N²/p.
        let row = MemoryRow::by_formula("s", 1000, 32, 1.0);
        assert!((row.formula_2_byte.ratio() - 16.0 * 32.0 * 32.0 / 1000.0).abs() < 1e-9);
        assert!((row.formula_4_byte.ratio() / row.formula_2_byte.ratio() - 2.0).abs() < 1e-12);
        assert_eq!(row.formula_2_byte.bmssm, 12_000.0);
        assert_eq!(row.formula_2_byte.ssm, 2.0 * 32_768.0 * 3.0);
    }
}
