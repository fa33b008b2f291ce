//! The table of ν_mem.

use super::table::Table;
use harness::record::{Layout, MemoryRow};

/// ν_mem by scene and N, three ways.
pub fn table(rows: &[MemoryRow]) -> Table {
    let mut out = Table::new([
        "scene",
        "N",
        "objects a cell",
        "formula, 2-byte ids",
        "formula, 4-byte ids",
        "paper's layouts built",
        "compact layouts built",
    ]);
    for row in rows {
        let built = |layout: &Option<Layout>| layout.map_or_else(|| "–".to_owned(), |l| number(l.ratio()));
        // Two bytes name 65,536 objects and no more.
        let two = if row.objects <= 1 << 16 { number(row.formula_2_byte.ratio()) } else { "–".to_owned() };
        out.rows.push(vec![
            row.scene.clone(),
            row.resolution.to_string(),
            number(row.refs_per_cell),
            two,
            number(row.formula_4_byte.ratio()),
            built(&row.paper_layouts),
            built(&row.compact_layouts),
        ]);
    }
    out
}

fn number(value: f64) -> String {
    match value {
        v if !v.is_finite() => "–".to_owned(),
        v if v >= 100.0 => format!("{v:.0}"),
        v if v >= 10.0 => format!("{v:.1}"),
        v if v >= 0.01 || v == 0.0 => format!("{v:.2}"),
        v => format!("{v:.1e}"),
    }
}
