//! The table of ν_mem.

use crate::table::{Table, Value, figure};
use harness::record::{Layout, MemoryRow};
use harness::units;

/// ν_mem by scene and N, three ways.
pub fn table(rows: &[MemoryRow]) -> Table {
    let mut out = Table::new([
        "scene".into(),
        figure("N"),
        figure("objects a cell"),
        figure("formula, 2-byte ids"),
        figure("formula, 4-byte ids"),
        figure("paper's layouts built"),
        figure("compact layouts built"),
    ]);
    let number = |value: f64| Value::figure(Some(value), units::figure);
    let ratio = |layout: Option<Layout>| Value::figure(layout.map(|l| l.ratio()), units::figure);
    for row in rows {
        out.push([
            Value::text(&row.scene),
            number(row.resolution.into()),
            number(row.refs_per_cell),
            // Two bytes name 65,536 objects and no more.
            ratio((row.objects <= 1 << 16).then_some(row.formula_2_byte)),
            ratio(Some(row.formula_4_byte)),
            ratio(row.paper_layouts),
            ratio(row.compact_layouts),
        ]);
    }
    out
}
