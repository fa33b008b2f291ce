//! Wrong answers against speed.

use super::super::aggregate::Overall;
use super::super::labels::place;
use super::super::scale::short;
use super::super::style::Styles;
use super::super::svg::Anchor;
use super::frame::{Axis, Frame};
use harness::units;

/// The axis of errors is at least so long.
const DECADES: f64 = 100.0;

/// A structure's wrong answers over the scenes of a ray set.
struct Wrong {
    /// Missed, false, and on another object.
    answers: u64,
    rays: u64,
}

impl Wrong {
    /// Wrong answers per million rays. None seen is drawn as half of one: no sample shows that there are none.
    fn rate(&self) -> f64 {
        (self.answers as f64).max(0.5) / self.rays as f64 * 1e6
    }
}

/// Wrong answers per million rays against ns per ray, a point for each structure whose answers were decided; `None`
/// without two points. With it, what the chart can't show, in words.
pub fn errors(overall: &Overall, styles: &Styles) -> Option<(String, String)> {
    let decided = overall.rows.iter().filter_map(|row| {
        let checks = row.cells.iter().map(|cell| {
            let check = cell.check.as_ref()?;
            let errors = check.errors?;
            Some((errors.missed + errors.false_hits + errors.wrong_object, check.rays_checked))
        });
        let checks: Option<Vec<(u64, u64)>> = checks.collect();
        let (answers, rays) = checks?.into_iter().fold((0, 0), |(a, b), (c, d)| (a + c, b + d));
        (rays > 0).then_some((row, Wrong { answers, rays }))
    });
    let rows: Vec<_> = decided.collect();
    if rows.len() < 2 {
        return None;
    }
    let none: Vec<&str> =
        rows.iter().filter(|(_, wrong)| wrong.answers == 0).map(|(row, _)| row.structure).collect();
    let words = match none.len() {
        0 => String::new(),
        _ => format!("None seen, and drawn as half a one: {}.", none.join(", ")),
    };
    let (rates, ns): (Vec<f64>, Vec<f64>) = rows.iter().map(|(row, wrong)| (wrong.rate(), row.ns)).unzip();
    // Labels need room beside points of equal rates.
    let least = rates.iter().copied().fold(f64::INFINITY, f64::min);
    let range: Vec<f64> = rates.iter().copied().chain([least * DECADES]).collect();
    let horizontal = Axis { title: "wrong answers per million rays →", values: &range, label: &short };
    let vertical = Axis { title: "↑ time per ray", values: &ns, label: &units::time };
    let Frame { mut svg, x, y, area } = Frame::new(260.0, &horizontal, &vertical);
    let points: Vec<(f64, f64)> = rates.iter().zip(&ns).map(|(rate, ns)| (x.at(*rate), y.at(*ns))).collect();
    let names: Vec<&str> = rows.iter().map(|(row, _)| row.structure).collect();
    let labels = place(&points, &names, area, []);
    for (((row, wrong), name), (point, label)) in rows.iter().zip(&names).zip(points.iter().zip(labels)) {
        let tip = format!(
            "{}: {} wrong of {} rays, {} per ray",
            row.structure,
            units::count(wrong.answers),
            units::count(wrong.rays),
            units::time(row.ns)
        );
        svg.tip(&tip, |svg| {
            if let Some(end) = label.and_then(|label| label.leader) {
                svg.line(*point, end, "leader");
            }
            svg.marker(*point, styles.shape(row.structure), &format!("mark {}", styles.class(row.structure)));
            if let Some(label) = label {
                svg.text(label.at, Anchor::Start, "label halo", name);
            }
        });
    }
    let label = format!("Wrong answers against time per ray of {} rays", overall.rays);
    Some((svg.finish(&label), words))
}
