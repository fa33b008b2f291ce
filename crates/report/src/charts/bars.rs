//! Speed as bars, with the spread of the samples.

use crate::chart::{Anchor, Styles, Svg, WIDTH, width};
use harness::record::Cell;
use harness::units;
use maud::Markup;

/// Bars longer than this many times the shortest are torn off, so that the others can be told apart.
const LONGEST: f64 = 8.0;
const ROW: f64 = 20.0;

/// Time per ray of each cell, the fastest first, with a line from the least to the greatest
/// sample; failed cells say so. `None` if no cell has a time.
pub fn bars(cells: &[&Cell], label: &str, styles: &Styles) -> Option<Markup> {
    let mut timed: Vec<(&Cell, f64)> = cells.iter().filter_map(|cell| Some((*cell, cell.ns()?))).collect();
    timed.sort_by(|a, b| a.1.total_cmp(&b.1));
    let fastest = timed.first()?.1;
    let failed: Vec<&&Cell> = cells.iter().filter(|cell| cell.ns().is_none()).collect();
    let longest = timed.iter().map(|(_, ns)| *ns).fold(0.0, f64::max).min(fastest * LONGEST);
    let names = cells.iter().map(|cell| width(&cell.structure)).fold(40.0, f64::max) + 8.0;
    let figures = timed.iter().map(|(_, ns)| width(&units::time(*ns))).fold(0.0, f64::max) + 8.0;
    let room = WIDTH - names - figures;
    let length = |ns: f64| (ns / longest).min(1.0) * room;
    let size = (WIDTH, (timed.len() + failed.len()) as f64 * ROW + 4.0);
    let mut svg = Svg::default();
    for (i, (cell, ns)) in timed.iter().enumerate() {
        let y = i as f64 * ROW + 3.0;
        let middle = y + 7.0;
        let samples = cell.samples_per_ray();
        let (least, greatest) = samples.iter().fold((*ns, *ns), |(a, b), ns| (a.min(*ns), b.max(*ns)));
        let tip = format!(
            "{}: {} per ray, {} to {} in {} samples; {} times the fastest",
            cell.structure,
            units::time(*ns),
            units::time(least),
            units::time(greatest),
            samples.len(),
            units::figure(ns / fastest)
        );
        svg.tip(&tip, |svg| {
            svg.rect((0.0, y - 3.0), (WIDTH, ROW), "hit");
            svg.text((names - 6.0, y + 11.0), Anchor::End, "label", &cell.structure);
            svg.rect(
                (names, y),
                (length(*ns).max(1.0), 14.0),
                &format!("bar {}", styles.class(&cell.structure)),
            );
            if *ns > longest * 1.001 {
                let torn = names + room - 12.0;
                svg.path(&[(torn, y + 16.0), (torn + 6.0, y - 2.0)], "torn");
            } else {
                svg.line((names + length(least), middle), (names + length(greatest), middle), "spread");
            }
            svg.text((WIDTH - 2.0, y + 11.0), Anchor::End, "figure", &units::time(*ns));
        });
    }
    for (i, cell) in failed.iter().enumerate() {
        let y = (timed.len() + i) as f64 * ROW + 3.0;
        let reason = cell.outcome.reason().unwrap_or("no sample");
        svg.tip(&format!("{}: {reason}", cell.structure), |svg| {
            svg.rect((0.0, y - 3.0), (WIDTH, ROW), "hit");
            svg.text((names - 6.0, y + 11.0), Anchor::End, "label", &cell.structure);
            svg.text((names + 4.0, y + 11.0), Anchor::Start, "failed", "no figure (see the table)");
        });
    }
    Some(svg.finish(size, label))
}
