//! Memory against speed, with the Pareto front.

use crate::aggregate::{MeanRow, Overall};
use crate::chart::{Axis, Line, Mark, Plot, Styles, WIDTH};
use harness::front::front;
use harness::units::{self, figure, times};
use maud::Markup;

/// Structures that are so many times as slow as the fastest would crowd the others into a corner.
const FAR: f64 = 50.0;

/// A chart of few points needs no more; a point and its label take so much more each.
const HEIGHT: (f64, f64) = (300.0, 9.0);
const FEW: usize = 10;

/// Bytes of structure and geometry copy per object against time relative to the reference, a point for each structure
/// with its settings, those of the front filled; `None` without two points. With it, what is not drawn, in words.
pub fn pareto(overall: &Overall, styles: &Styles) -> Option<(Markup, String)> {
    let reference = overall.reference()?;
    let fastest = overall.rows.first()?.ns;
    let all = overall.rows.iter().filter_map(|row| Some((row, row.bytes?)));
    let (rows, far): (Vec<_>, Vec<_>) = all.partition(|(row, _)| row.ns <= FAR * fastest);
    if rows.len() < 2 {
        return None;
    }
    let far: Vec<String> = far
        .iter()
        .map(|(row, bytes)| {
            format!("{} ({}, {} B)", row.structure, times(row.ns / reference.ns), figure(*bytes))
        })
        .collect();
    let words = match far.len() {
        0 => String::new(),
        _ => format!("Not drawn, over {FAR} times the fastest one's time: {}.", far.join(", ")),
    };
    let points: Vec<(f64, f64)> = rows.iter().map(|(row, bytes)| (*bytes, row.ns / reference.ns)).collect();
    let best = front(&points);
    let mark = |(i, (row, _)): (usize, &(&MeanRow, f64))| {
        let on_front = best.contains(&i);
        Mark {
            value: points[i],
            shape: styles.shape(row.structure),
            class: format!("mark {}{}", if on_front { "" } else { "hollow " }, styles.class(row.structure)),
            tip: tip(row, points[i], reference, on_front, overall),
            label: Some(row.structure.to_owned()),
        }
    };
    let mut marks: Vec<(bool, Mark)> =
        rows.iter().enumerate().map(|it| (best.contains(&it.0), mark(it))).collect();
    // What lies on the front gets the best places for its labels.
    marks.sort_by_key(|(on_front, _)| !on_front);
    let along: Vec<(f64, f64)> = best.iter().map(|i| points[*i]).collect();
    let plot = Plot {
        name: format!("Memory against speed for {}", overall.rays),
        size: (WIDTH, HEIGHT.0 + HEIGHT.1 * rows.len().saturating_sub(FEW) as f64),
        horizontal: Axis::new("structure and copies per object →", points.iter().map(|p| p.0), |bytes| {
            format!("{} B", figure(bytes))
        }),
        vertical: Axis::new(
            &format!("↑ time per ray / {}", reference.structure),
            points.iter().map(|p| p.1),
            times,
        ),
        lines: vec![Line::steps(&along, "front")],
        marks: marks.into_iter().map(|(_, mark)| mark).collect(),
    };
    Some((plot.svg(), words))
}

fn tip(
    row: &MeanRow,
    (bytes, ratio): (f64, f64),
    reference: &MeanRow,
    on_front: bool,
    overall: &Overall,
) -> String {
    let of_memory = match reference.bytes {
        Some(reference) if reference > 0.0 => format!(" ({})", times(bytes / reference)),
        _ => String::new(),
    };
    format!(
        "{}: {} per ray ({} the time of {}), {} bytes per object{of_memory}{} (geometric means over {})",
        row.structure,
        units::time(row.ns),
        times(ratio),
        reference.structure,
        figure(bytes),
        if on_front { ", on the front" } else { "" },
        overall.extent()
    )
}
