//! The plot: ns per ray against errors in a million rays, a panel for each scene.

use crate::html::escape;
use crate::palette;
use harness::record::{Intersector, id_of};
use harness::trade::{Row, Trade};
use primitives::KernelId;
use std::fmt::Write;

const COLUMNS: usize = 3;
const PANEL: (f64, f64) = (330.0, 240.0);
const MARGIN: f64 = 42.0;
const LEGEND: f64 = 90.0;
/// Room on the right for half of a figure.
const EDGE: f64 = 10.0;

/// Rows without an error are drawn here, below one in a million rays.
const NONE: f64 = 0.3;

/// The shapes of points: one for each kernel in their order, the last for external intersectors.
const SHAPES: [&str; KernelId::ALL.len() + 1] = [
    "M-4,0A4,4 0 1 0 4,0A4,4 0 1 0 -4,0Z",
    "M-3.5,-3.5H3.5V3.5H-3.5Z",
    "M0,-4.5L4.5,3.5H-4.5Z",
    "M0,-5L4.5,0L0,5L-4.5,0Z",
    "M0,-6L1.6,-2L6,-1.6L2.6,1.2L3.8,5.4L0,3L-3.8,5.4L-2.6,1.2L-6,-1.6L-1.6,-2Z",
    "M-1.5,-5H1.5V-1.5H5V1.5H1.5V5H-1.5V1.5H-5V-1.5H-1.5Z",
    "M-5,-2.5H5V2.5H-5Z",
    "M-4,-4L0,-1.5L4,-4L1.5,0L4,4L0,1.5L-4,4L-1.5,0Z",
];

/// The plot as SVG: colours are structures, shapes are kernels, filled points form the Pareto front.
pub fn svg(trade: &Trade) -> String {
    let mut ids: Vec<&str> = Vec::new();
    for row in &trade.rows {
        let id = family(row);
        if !ids.contains(&id) {
            ids.push(id);
        }
    }
    let scenes: Vec<&str> = trade.scenes.iter().map(|scene| scene.id.as_str()).collect();
    let lines = scenes.len().div_ceil(COLUMNS).max(1);
    let (width, height) = (COLUMNS as f64 * PANEL.0 + EDGE, lines as f64 * PANEL.1 + LEGEND);
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" font-family=\"sans-serif\" font-size=\"10\">\n\
         <rect width=\"{width}\" height=\"{height}\" fill=\"white\"/>\n"
    );
    for (i, id) in ids.iter().enumerate() {
        let (x, y) = (20.0 + 160.0 * (i % 6) as f64, 16.0 + 14.0 * (i / 6) as f64);
        let _ = writeln!(
            out,
            "<circle cx=\"{x}\" cy=\"{}\" r=\"4\" fill=\"{}\"/><text x=\"{}\" y=\"{y}\">{}</text>",
            y - 3.0,
            palette::of(id).light,
            x + 8.0,
            escape(id)
        );
    }
    let kernels = KernelId::ALL.map(Intersector::BuiltIn).into_iter().chain([Intersector::External]);
    for (i, kernel) in kernels.enumerate() {
        let (x, y) = (20.0 + 160.0 * (i % 6) as f64, LEGEND - 42.0 + 14.0 * (i / 6) as f64);
        point(&mut out, (x, y - 3.0), &kernel, "#333", false, "");
        let name = match &kernel {
            Intersector::External => "an external structure's own",
            kernel => kernel.name(),
        };
        let _ = writeln!(out, "<text x=\"{}\" y=\"{y}\">{name}</text>", x + 8.0);
    }
    let _ = writeln!(
        out,
        "<text x=\"20\" y=\"{}\">colour: structure; shape: ray-triangle test; filled: nothing else of the scene is as fast and as right</text>",
        LEGEND - 10.0
    );
    for (i, scene) in scenes.iter().enumerate() {
        let corner = ((i % COLUMNS) as f64 * PANEL.0, LEGEND + (i / COLUMNS) as f64 * PANEL.1);
        let rows: Vec<&Row> = trade.rows.iter().filter(|row| row.scene == *scene).collect();
        panel(&mut out, corner, scene, &rows);
    }
    out.push_str("</svg>\n");
    out
}

fn family(row: &Row) -> &str {
    id_of(&row.structure)
}

/// The shape of a kernel's points.
fn shape(kernel: &Intersector) -> &'static str {
    let place = match kernel {
        Intersector::BuiltIn(kernel) => KernelId::ALL.iter().position(|known| known == kernel),
        Intersector::External | Intersector::Unknown(_) => None,
    };
    SHAPES[place.unwrap_or(SHAPES.len() - 1)]
}

/// A point with a title that shows under the pointer.
fn point(
    out: &mut String,
    (x, y): (f64, f64),
    kernel: &Intersector,
    colour: &str,
    filled: bool,
    title: &str,
) {
    let shape = shape(kernel);
    let fill = if filled { colour } else { "none" };
    // Writing to a string does not fail.
    let _ = writeln!(
        out,
        "<path d=\"{shape}\" transform=\"translate({x:.1} {y:.1})\" fill=\"{fill}\" stroke=\"{colour}\"><title>{}</title></path>",
        escape(title)
    );
}

fn panel(out: &mut String, (left, top): (f64, f64), scene: &str, rows: &[&Row]) {
    let points: Vec<(&Row, f64, f64)> =
        rows.iter().filter_map(|row| row.point().map(|(ns, errors)| (*row, ns, errors))).collect();
    let decade = |pick: fn(f64, f64) -> f64, start: f64| points.iter().map(|p| p.1).fold(start, pick).log10();
    let (low, high) = (decade(f64::min, 1e9).floor(), decade(f64::max, 1.0).ceil());
    let (low, high) = if points.is_empty() { (0.0, 1.0) } else { (low, high.max(low + 1.0)) };
    let (inner_width, inner_height) = (PANEL.0 - MARGIN - 10.0, PANEL.1 - MARGIN - 14.0);
    let x_of = |ns: f64| left + MARGIN + (ns.log10() - low) / (high - low) * inner_width;
    let (bottom, decades) = (NONE.log10(), 6.0 - NONE.log10());
    let y_of =
        |errors: f64| top + 14.0 + inner_height * (1.0 - (errors.max(NONE).log10() - bottom) / decades);
    let _ = writeln!(
        out,
        "<text x=\"{}\" y=\"{}\" font-weight=\"bold\">{}</text>\n\
         <rect x=\"{}\" y=\"{}\" width=\"{inner_width}\" height=\"{inner_height}\" fill=\"none\" stroke=\"#999\"/>",
        left + MARGIN,
        top + 10.0,
        escape(scene),
        left + MARGIN,
        top + 14.0
    );
    for (errors, label) in [(NONE, "none"), (1.0, "1"), (1e2, "100"), (1e4, "10⁴"), (1e6, "10⁶")] {
        let _ = writeln!(
            out,
            "<text x=\"{}\" y=\"{}\" text-anchor=\"end\" fill=\"#555\">{label}</text>",
            left + MARGIN - 4.0,
            y_of(errors) + 3.0
        );
    }
    for step in low as i32..=high as i32 {
        let ns = 10f64.powi(step);
        let _ = writeln!(
            out,
            "<text x=\"{}\" y=\"{}\" text-anchor=\"middle\" fill=\"#555\">{ns}</text>",
            x_of(ns),
            top + inner_height + 26.0
        );
    }
    let _ = writeln!(
        out,
        "<text x=\"{}\" y=\"{}\" fill=\"#555\">ns per ray; wrong answers in a million rays</text>",
        left + MARGIN,
        top + inner_height + 38.0
    );
    // The front last, so that nothing covers it.
    for front in [false, true] {
        for (row, ns, errors) in points.iter().filter(|(row, ..)| row.front == front) {
            let title = format!("{}: {ns:.0} ns, {errors:.1} in a million", row.structure);
            let place = (x_of(*ns), y_of(*errors));
            point(out, place, &row.kernel, palette::of(family(row)).light, front, &title);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use harness::machine::Machine;
    use harness::record::{Outcome, SceneEntry, Suite};
    use harness::trade::Accuracy;

    fn trade(scenes: usize, structures: usize) -> Trade {
        let mut trade = Trade {
            command: String::new(),
            suite: Suite::this(),
            machine: Machine::here(),
            scenes: Vec::new(),
            rows: Vec::new(),
            skipped: Vec::new(),
        };
        for scene in 0..scenes {
            let id = format!("a-scene-of-some-length-{scene}");
            for structure in 0..structures {
                trade.rows.push(Row {
                    scene: id.clone(),
                    structure: format!("structure-{structure}:kernel=exact"),
                    kernel: Intersector::BuiltIn(KernelId::ALL[structure % KernelId::ALL.len()]),
                    kernel_reason: String::new(),
                    ns_per_ray: Some(3.0 * 7f64.powi(structure as i32 % 6)),
                    bytes: None,
                    accuracy: Some(Accuracy { rays: 1000, missed: structure as u64, ..Accuracy::default() }),
                    front: structure == 0,
                    outcome: Outcome::Measured,
                });
            }
            trade.scenes.push(SceneEntry {
                id,
                objects: 1,
                kind: "triangles".into(),
                source: String::new(),
                checksum: String::new(),
            });
        }
        trade
    }

    /// Left, right and baseline of every text, its letters taken for 5.6 units wide.
    fn texts(image: &str) -> Vec<(f64, f64, f64)> {
        let tags = image.split("<text ").skip(1);
        let texts = tags.map(|tag| {
            let number = |name: &str| -> f64 {
                let rest = tag.split(&format!("{name}=\"")).nth(1).unwrap();
                rest.split('"').next().unwrap().parse().unwrap()
            };
            let (head, rest) = tag.split_once('>').unwrap();
            let width = rest.split('<').next().unwrap().chars().count() as f64 * 5.6;
            let shift = if head.contains("\"end\"") {
                1.0
            } else if head.contains("\"middle\"") {
                0.5
            } else {
                0.0
            };
            let left = number("x") - width * shift;
            (left, left + width, number("y"))
        });
        texts.collect()
    }

    #[test]
    fn no_text_covers_another_or_leaves_the_picture() {
        for (scenes, structures) in [(1, 3), (9, 12), (14, 10)] {
            let image = svg(&trade(scenes, structures));
            let all = texts(&image);
            assert!(all.len() > scenes * 7 + structures);
            let (width, height) = (3.0 * PANEL.0 + EDGE, scenes.div_ceil(COLUMNS) as f64 * PANEL.1 + LEGEND);
            for (i, a) in all.iter().enumerate() {
                assert!(a.0 >= 0.0 && a.1 <= width && a.2 > 8.0 && a.2 < height, "{a:?} leaves the picture");
                for b in &all[..i] {
                    let beside = a.1 <= b.0 || b.1 <= a.0;
                    assert!(beside || (a.2 - b.2).abs() >= 8.0, "{a:?} covers {b:?}");
                }
            }
            assert_eq!(image.matches("<path ").count(), scenes * structures + SHAPES.len());
        }
    }
}
