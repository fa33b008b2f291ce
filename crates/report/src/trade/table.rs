//! The trade as a table.

use crate::table::{Table, Value, figure};
use harness::trade::Row;
use harness::units;

/// The table; rows on the front have a star.
pub fn table(rows: &[Row]) -> Table {
    let mut table = Table::new([
        "scene".into(),
        "structure".into(),
        figure("ns/ray"),
        figure("MB"),
        figure("missed/M"),
        figure("false/M"),
        figure("wrong object/M"),
        figure("leaks/M"),
        figure("self-hits/M"),
        figure("t ulp median"),
        figure("99 %"),
        figure("max"),
    ]);
    let number = |value: Option<f64>| Value::figure(value, units::figure);
    for row in rows {
        let star = if row.front { " *" } else { "" };
        let mut cells = vec![Value::text(&row.scene), Value::text(format!("{}{star}", row.structure))];
        cells.extend([number(row.ns_per_ray), number(row.bytes.map(|b| b as f64 / 1e6))]);
        match &row.accuracy {
            None => cells.extend((0..8).map(|_| Value::text("failed"))),
            Some(a) => {
                let million = |n: u64| n as f64 * 1e6 / a.rays.max(1) as f64;
                let wrong = [a.missed, a.false_hits, a.wrong_object].map(million);
                let probes = [a.leaks_per_million(), a.self_hits_per_million()];
                let ulps = [a.t_ulp_median, a.t_ulp_p99, a.t_ulp_max];
                cells.extend(wrong.into_iter().chain(probes).chain(ulps).map(|v| number(Some(v))));
            }
        }
        table.push(cells);
    }
    table
}
