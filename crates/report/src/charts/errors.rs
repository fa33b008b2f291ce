//! Wrong answers against speed.

use crate::aggregate::{MeanRow, Overall};
use crate::chart::{Axis, Mark, Plot, Styles, WIDTH};
use harness::units::{self, short};
use maud::Markup;

/// The axis of errors is at least so long.
const DECADES: f64 = 100.0;

/// A structure's wrong answers over the scenes of a ray set.
struct Wrong {
    /// Missed, false, and on another object.
    answers: u64,
    rays: u64,
}

impl Wrong {
    /// Those of a structure, if all of its cells were decided.
    fn of(row: &MeanRow) -> Option<Self> {
        let mut sum = Self { answers: 0, rays: 0 };
        for cell in &row.cells {
            let check = cell.check.as_ref()?;
            let errors = check.errors?;
            let answers = [errors.missed, errors.false_hits, errors.wrong_object];
            sum.answers = answers.iter().fold(sum.answers, |sum, n| sum.saturating_add(*n));
            sum.rays = sum.rays.saturating_add(check.rays_checked);
        }
        (sum.rays > 0).then_some(sum)
    }

    /// Wrong answers per million rays. None seen is drawn as half of one: no sample shows that there are none.
    fn rate(&self) -> f64 {
        (self.answers as f64).max(0.5) / self.rays as f64 * 1e6
    }
}

/// Wrong answers per million rays against ns per ray, a point for each structure whose answers were decided; `None`
/// without two points. With it, what the chart can't show, in words.
pub fn errors(overall: &Overall, styles: &Styles) -> Option<(Markup, String)> {
    let rows: Vec<(&MeanRow, Wrong)> =
        overall.rows.iter().filter_map(|row| Some((row, Wrong::of(row)?))).collect();
    if rows.len() < 2 {
        return None;
    }
    let none: Vec<&str> =
        rows.iter().filter(|(_, wrong)| wrong.answers == 0).map(|(row, _)| row.structure).collect();
    let words = match none.len() {
        0 => String::new(),
        _ => format!("None seen, and drawn as half a one: {}.", none.join(", ")),
    };
    let mark = |(row, wrong): &(&MeanRow, Wrong)| Mark {
        value: (wrong.rate(), row.ns),
        shape: styles.shape(row.structure),
        class: format!("mark {}", styles.class(row.structure)),
        tip: format!(
            "{}: {} wrong of {} rays, {} per ray",
            row.structure,
            units::count(wrong.answers),
            units::count(wrong.rays),
            units::time(row.ns)
        ),
        label: Some(row.structure.to_owned()),
    };
    let rates = || rows.iter().map(|(_, wrong)| wrong.rate());
    // Labels need room beside points of equal rates.
    let room = rates().fold(f64::INFINITY, f64::min) * DECADES;
    let plot = Plot {
        name: format!("Wrong answers against time per ray of {} rays", overall.rays),
        size: (WIDTH, 260.0),
        horizontal: Axis::new("wrong answers per million rays →", rates().chain([room]), short),
        vertical: Axis::new("↑ time per ray", rows.iter().map(|(row, _)| row.ns), units::time),
        lines: Vec::new(),
        marks: rows.iter().map(mark).collect(),
    };
    Some((plot.svg(), words))
}
