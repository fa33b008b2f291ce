//! Build against trace: time to an image as rays grow.

use super::super::aggregate::envelope;
use super::super::labels::{line, place};
use super::super::scale::short;
use super::super::style::Styles;
use super::super::svg::Anchor;
use super::frame::{Axis, Frame};
use harness::record::Cell;
use harness::units;

/// From how few to how many rays.
const RAYS: (f64, f64) = (1e3, 1e9);

/// Build and trace time over rays for each cell, with the points where another structure takes
/// the lead; and the same in words. `None` without two cells.
pub fn growth(cells: &[&Cell], label: &str, styles: &Styles) -> Option<(String, String)> {
    let timed: Vec<(&Cell, (f64, f64))> =
        cells.iter().filter_map(|cell| Some((*cell, (cell.build()?, cell.ns()?)))).collect();
    if timed.len() < 2 {
        return None;
    }
    let lines: Vec<(f64, f64)> = timed.iter().map(|(_, line)| *line).collect();
    let total = |(build, ns): (f64, f64), rays: f64| build + ns * rays;
    let winners = envelope(&lines);
    // Baselines take hours at many rays: the scale is made for those that ever lead, and a few times worse.
    let least = lines.iter().map(|line| total(*line, RAYS.0)).fold(f64::INFINITY, f64::min);
    let most = lines.iter().map(|line| total(*line, RAYS.1)).fold(f64::INFINITY, f64::min) * 30.0;
    let horizontal = Axis { title: "rays →", values: &[RAYS.0, RAYS.1], label: &short };
    let vertical = Axis { title: "↑ build and trace", values: &[least, most], label: &units::time };
    let Frame { mut svg, x, y, area } = Frame::new(280.0, &horizontal, &vertical);
    let (from, to) = x.range();
    let mut drawn = Vec::new();
    for (cell, figures) in &timed {
        let steps = 48;
        let rays = (0..=steps).map(|i| from * (to / from).powf(f64::from(i) / f64::from(steps)));
        let visible = rays.map(|rays| (rays, total(*figures, rays))).take_while(|(_, ns)| *ns <= y.range().1);
        let points: Vec<(f64, f64)> = visible.map(|(rays, ns)| (x.at(rays), y.at(ns))).collect();
        let tip = format!(
            "{}: {} to build, {} for each ray",
            cell.structure,
            units::time(figures.0),
            units::time(figures.1)
        );
        drawn.extend(points.iter().map(|point| line(*point, *point)));
        if points.len() > 1 {
            svg.tip(&tip, |svg| svg.path(&points, &format!("line {}", styles.class(&cell.structure))));
        }
    }
    let crossings: Vec<_> = winners.iter().filter(|s| s.from >= from && s.from <= to).collect();
    let spots: Vec<(f64, f64)> =
        crossings.iter().map(|s| (x.at(s.from), y.at(total(lines[s.winner], s.from)))).collect();
    let names: Vec<String> =
        crossings.iter().map(|s| format!("{}: {}", short(s.from), timed[s.winner].0.structure)).collect();
    let texts: Vec<&str> = names.iter().map(String::as_str).collect();
    for ((spot, name), label) in spots.iter().zip(&texts).zip(place(&spots, &texts, area, drawn)) {
        svg.marker(*spot, crate::palette::Shape::Circle, "crossing");
        let Some(label) = label else { continue };
        if let Some(end) = label.leader {
            svg.line(*spot, end, "leader");
        }
        svg.text(label.at, Anchor::Start, "label halo", name);
    }
    let mut words: Vec<String> = Vec::new();
    for (i, stretch) in winners.iter().enumerate() {
        let name = &timed[stretch.winner].0.structure;
        let until = winners.get(i + 1).map_or(f64::INFINITY, |next| next.from);
        // Nobody builds anything for fewer rays than the chart begins with.
        match (stretch.from <= RAYS.0, until) {
            _ if until <= RAYS.0 => {}
            (true, f64::INFINITY) => words.push(format!("{name} is first for any number of rays")),
            (true, _) => words.push(format!("{name} is first up to {} rays", short(until))),
            (false, _) => words.push(format!("{name} from {} on", short(stretch.from))),
        }
    }
    Some((svg.finish(label), format!("{}.", words.join(", "))))
}
