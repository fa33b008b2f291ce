//! Memory against speed, with the Pareto front.

use super::super::aggregate::{Overall, front};
use super::super::labels::{line, place};
use super::super::scale::{short, trimmed};
use super::super::style::Styles;
use super::super::svg::Anchor;
use super::frame::{Axis, Frame};
use harness::units;

/// Structures that are so many times as slow as the fastest would crowd the others into a corner.
const FAR: f64 = 50.0;

/// Bytes per object against ns per ray, a point for each structure; `None` without two points. With it, what is not
/// drawn, in words.
pub fn pareto(overall: &Overall, styles: &Styles) -> Option<(String, String)> {
    let all = overall.rows.iter().filter_map(|row| Some((row, row.bytes?)));
    let fastest = overall.rows.first()?.ns;
    let (rows, far): (Vec<_>, Vec<_>) = all.partition(|(row, _)| row.ns <= FAR * fastest);
    if rows.len() < 2 {
        return None;
    }
    let far: Vec<String> = far
        .iter()
        .map(|(row, bytes)| {
            format!("{} ({}×, {} B)", row.structure, short(row.ns / fastest), trimmed(*bytes))
        })
        .collect();
    let words = match far.len() {
        0 => String::new(),
        _ => format!("Not drawn, over {FAR} times the fastest one's time: {}.", far.join(", ")),
    };
    let figures: Vec<(f64, f64)> = rows.iter().map(|(row, bytes)| (*bytes, row.ns)).collect();
    let (bytes, ns): (Vec<f64>, Vec<f64>) = figures.iter().copied().unzip();
    let label = |bytes: f64| format!("{} B", trimmed(bytes));
    let horizontal = Axis { title: "memory per object →", values: &bytes, label: &label };
    let vertical = Axis { title: "↑ time per ray", values: &ns, label: &units::time };
    let Frame { mut svg, x, y, area } = Frame::new(300.0, &horizontal, &vertical);
    let points: Vec<(f64, f64)> = figures.iter().map(|(b, t)| (x.at(*b), y.at(*t))).collect();
    let best = front(&figures);
    let mut steps = Vec::new();
    for pair in best.windows(2) {
        let (from, to) = (points[pair[0]], points[pair[1]]);
        steps.extend([from, (to.0, from.1), to]);
    }
    if !steps.is_empty() {
        svg.path(&steps, "front");
    }
    let names: Vec<&str> = rows.iter().map(|(row, _)| row.structure).collect();
    let labels = place(&points, &names, area, steps.windows(2).map(|pair| line(pair[0], pair[1])));
    for (i, ((row, bytes), point)) in rows.iter().zip(&points).enumerate() {
        let note = if best.contains(&i) { ", on the front" } else { "" };
        let tip = format!(
            "{}: {} per ray, {} bytes per object{note} (geometric means over {} scenes)",
            row.structure,
            units::time(row.ns),
            trimmed(*bytes),
            overall.scenes.len()
        );
        svg.tip(&tip, |svg| {
            if let Some(end) = labels[i].and_then(|label| label.leader) {
                svg.line(*point, end, "leader");
            }
            svg.marker(*point, styles.shape(row.structure), &format!("mark {}", styles.class(row.structure)));
            if let Some(label) = labels[i] {
                svg.text(label.at, Anchor::Start, "label", row.structure);
            }
        });
    }
    Some((svg.finish(&format!("Memory against speed for {} rays", overall.rays)), words))
}
