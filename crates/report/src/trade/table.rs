//! The trade as a table.

use crate::table::Table;
use harness::trade::Row;

/// The table; rows on the front have a star.
pub fn table(rows: &[Row]) -> Table {
    let mut table = Table::new([
        "scene",
        "structure",
        "ns/ray",
        "MB",
        "missed/M",
        "false/M",
        "wrong object/M",
        "leaks/M",
        "self-hits/M",
        "t ulp median",
        "99 %",
        "max",
    ]);
    let figure = |value: f64| match value {
        0.0 => "0".to_owned(),
        v if v >= 1e6 => format!("{v:.1e}"),
        v if v >= 100.0 => format!("{v:.0}"),
        v => format!("{v:.2}"),
    };
    for row in rows {
        let star = if row.front { " *" } else { "" };
        let mut cells = vec![row.scene.clone(), format!("{}{star}", row.structure)];
        cells.push(row.ns_per_ray.map_or("–".to_owned(), figure));
        cells.push(row.bytes.map_or("–".to_owned(), |b| figure(b as f64 / 1e6)));
        match &row.accuracy {
            None => cells.extend((0..8).map(|_| "failed".to_owned())),
            Some(a) => {
                let million = |n: u64| figure(n as f64 * 1e6 / a.rays.max(1) as f64);
                cells.extend([million(a.missed), million(a.false_hits), million(a.wrong_object)]);
                cells.extend([a.leaks_per_million(), a.self_hits_per_million()].map(figure));
                cells.extend([a.t_ulp_median, a.t_ulp_p99, a.t_ulp_max].map(figure));
            }
        }
        table.rows.push(cells);
    }
    table
}
