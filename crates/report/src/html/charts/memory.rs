//! The memory ratio of grid and bit maps over the resolution (Skala 1993, §5).

use super::super::labels::place;
use super::super::scale::trimmed;
use super::super::svg::Anchor;
use super::frame::{Axis, Frame};
use harness::record::MemoryRow;

/// ν_mem of one scene over N, by the paper's formulas and as built; `None` without two N.
pub fn memory_ratio(rows: &[&MemoryRow], label: &str) -> Option<String> {
    let mut rows = rows.to_vec();
    rows.sort_by_key(|row| row.resolution);
    rows.dedup_by_key(|row| row.resolution);
    if rows.len() < 2 {
        return None;
    }
    let series: [(&str, &str, Vec<Option<f64>>); 4] = [
        ("formula, 2-byte ids", "dash1", rows.iter().map(|r| Some(r.formula_2_byte.ratio())).collect()),
        ("formula, 4-byte ids", "dash2", rows.iter().map(|r| Some(r.formula_4_byte.ratio())).collect()),
        ("paper's layouts", "solid1", rows.iter().map(|r| r.paper_layouts.map(|l| l.ratio())).collect()),
        ("compact layouts", "solid2", rows.iter().map(|r| r.compact_layouts.map(|l| l.ratio())).collect()),
    ];
    let n: Vec<f64> = rows.iter().map(|row| f64::from(row.resolution)).collect();
    let usable = |v: &f64| v.is_finite() && *v > 0.0;
    let mut ratios: Vec<f64> =
        series.iter().flat_map(|(_, _, v)| v.iter().flatten().copied()).filter(usable).collect();
    // The line of equal memory is always to be seen.
    ratios.push(1.0);
    let times = |v: f64| format!("{}×", trimmed(v));
    let horizontal = Axis { title: "N slices per axis →", values: &n, label: &trimmed };
    let vertical =
        Axis { title: "↑ bytes of the grid / bytes of the bit maps", values: &ratios, label: &times };
    let Frame { mut svg, x, y, area } = Frame::new(240.0, &horizontal, &vertical);
    let even = y.at(1.0);
    svg.line((area.x, even), (area.x + area.width, even), "even");
    let (mut ends, mut names) = (Vec::new(), Vec::new());
    for (name, class, values) in &series {
        let known: Vec<(f64, f64)> =
            n.iter().zip(values).filter_map(|(n, v)| Some((*n, v.filter(usable)?))).collect();
        let points: Vec<(f64, f64)> = known.iter().map(|(n, v)| (x.at(*n), y.at(*v))).collect();
        if points.len() > 1 {
            svg.path(&points, &format!("nu {class}"));
        }
        for ((n, v), point) in known.iter().zip(&points) {
            svg.tip(&format!("{name}: N = {n}, ratio {}", trimmed(*v)), |svg| {
                svg.marker(*point, crate::palette::Shape::Circle, &format!("nudot {class}"));
            });
        }
        if let Some(end) = points.get(points.len() / 2) {
            ends.push(*end);
            names.push(*name);
        }
    }
    for ((end, name), label) in ends.iter().zip(&names).zip(place(&ends, &names, area, [])) {
        let Some(label) = label else { continue };
        if let Some(to) = label.leader {
            svg.line(*end, to, "leader");
        }
        svg.text(label.at, Anchor::Start, "label halo", name);
    }
    Some(svg.finish(label))
}
