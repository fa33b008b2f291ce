//! The memory ratio of grid and bit maps over the resolution (Skala 1993, §5).

use crate::chart::palette::Shape;
use crate::chart::{Axis, Line, Mark, Plot, WIDTH};
use harness::record::MemoryRow;
use harness::units::{figure, times};
use maud::Markup;

/// Name, look and figures of a line.
type Series<'a> = (&'a str, &'a str, fn(&MemoryRow) -> Option<f64>);

const SERIES: [Series; 4] = [
    ("formula, 2-byte ids", "dash1", |row| Some(row.formula_2_byte.ratio())),
    ("formula, 4-byte ids", "dash2", |row| Some(row.formula_4_byte.ratio())),
    ("paper's layouts", "solid1", |row| Some(row.paper_layouts?.ratio())),
    ("compact layouts", "solid2", |row| Some(row.compact_layouts?.ratio())),
];

/// ν_mem of one scene over N, by the paper's formulas and as built; `None` without two N.
pub fn memory_ratio(rows: &[&MemoryRow], label: &str) -> Option<Markup> {
    let mut rows = rows.to_vec();
    rows.sort_by_key(|row| row.resolution);
    rows.dedup_by_key(|row| row.resolution);
    if rows.len() < 2 {
        return None;
    }
    let usable = |v: &f64| v.is_finite() && *v > 0.0;
    let (mut lines, mut marks) = (vec![Line::level(1.0, "even")], Vec::new());
    for (name, class, ratio) in SERIES {
        let known: Vec<(f64, f64)> = rows
            .iter()
            .filter_map(|row| Some((f64::from(row.resolution), ratio(row).filter(usable)?)))
            .collect();
        marks.extend(known.iter().enumerate().map(|(i, (n, v))| Mark {
            value: (*n, *v),
            shape: Shape::Circle,
            class: format!("nudot {class}"),
            tip: format!("{name}: N = {n}, ratio {}", figure(*v)),
            label: (i == known.len() / 2).then(|| name.to_owned()),
        }));
        lines.push(Line::new(known, &format!("nu {class}")));
    }
    // The line of equal memory is always to be seen.
    let ratios: Vec<f64> = marks.iter().map(|mark| mark.value.1).chain([1.0]).collect();
    let plot = Plot {
        name: label.to_owned(),
        size: (WIDTH, 240.0),
        horizontal: Axis::new(
            "N slices per axis →",
            rows.iter().map(|row| f64::from(row.resolution)),
            figure,
        ),
        vertical: Axis::new("↑ bytes of the grid / bytes of the bit maps", ratios, times),
        lines,
        marks,
    };
    Some(plot.svg())
}
