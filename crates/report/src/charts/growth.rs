//! Build against trace: time to an image as rays grow.

use crate::aggregate::envelope;
use crate::chart::palette::Shape;
use crate::chart::{Axis, Line, Mark, Plot, Styles, WIDTH};
use harness::record::Cell;
use harness::units::{self, short};
use maud::Markup;

/// From how few to how many rays.
const RAYS: (f64, f64) = (1e3, 1e9);
/// Points of a line.
const STEPS: u32 = 48;

/// Build and trace time over rays for each cell, with the points where another structure takes
/// the lead; and the same in words. `None` without two cells.
pub fn growth(cells: &[&Cell], label: &str, styles: &Styles) -> Option<(Markup, String)> {
    let timed: Vec<(&Cell, (f64, f64))> =
        cells.iter().filter_map(|cell| Some((*cell, (cell.build()?, cell.ns()?)))).collect();
    if timed.len() < 2 {
        return None;
    }
    let figures: Vec<(f64, f64)> = timed.iter().map(|(_, figures)| *figures).collect();
    let total = |(build, ns): (f64, f64), rays: f64| build + ns * rays;
    // Baselines take hours at many rays: the scale is made for those that ever lead, and a few times worse.
    let least = |rays: f64| figures.iter().map(|line| total(*line, rays)).fold(f64::INFINITY, f64::min);
    let horizontal = Axis::new("rays →", [RAYS.0, RAYS.1], short);
    let (from, to) = horizontal.range();
    let lines = timed.iter().map(|(cell, figures)| {
        let rays = (0..=STEPS).map(|i| from * (to / from).powf(f64::from(i) / f64::from(STEPS)));
        let class = format!("line {}", styles.class(&cell.structure));
        let tip = format!(
            "{}: {} to build, {} for each ray",
            cell.structure,
            units::time(figures.0),
            units::time(figures.1)
        );
        let line = Line::new(rays.map(|rays| (rays, total(*figures, rays))), &class);
        Line { tip: Some(tip), clear: true, ..line }
    });
    let winners = envelope(&figures);
    let crossings = winners.iter().filter(|s| s.from >= from && s.from <= to).map(|s| {
        let name = format!("{}: {}", short(s.from), timed[s.winner].0.structure);
        Mark {
            value: (s.from, total(figures[s.winner], s.from)),
            shape: Shape::Circle,
            class: "crossing".into(),
            tip: format!("first from {} rays on: {}", short(s.from), timed[s.winner].0.structure),
            label: Some(name),
        }
    });
    let plot = Plot {
        name: label.to_owned(),
        size: (WIDTH, 280.0),
        horizontal,
        vertical: Axis::new("↑ build and trace", [least(RAYS.0), least(RAYS.1) * 30.0], units::time),
        lines: lines.collect(),
        marks: crossings.collect(),
    };
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
    Some((plot.svg(), format!("{}.", words.join(", "))))
}
