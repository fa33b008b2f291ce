//! The plot: ns per ray against errors in a million rays, a panel for each scene.

use super::{Row, Trade};
use std::fmt::Write;

const COLUMNS: usize = 3;
const PANEL: (f64, f64) = (330.0, 240.0);
const MARGIN: f64 = 42.0;
const LEGEND: f64 = 60.0;

/// Rows without an error are drawn here, below one in a million rays.
const NONE: f64 = 0.3;

const COLOURS: [&str; 8] =
    ["#1b6ca8", "#d1495b", "#3c8d2f", "#8e44ad", "#c77d0a", "#0f8b8d", "#6b4f3a", "#555555"];

/// The plot as SVG: colours are structures, letters are kernels, filled points form the Pareto front.
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
    let (width, height) = (COLUMNS as f64 * PANEL.0, lines as f64 * PANEL.1 + LEGEND);
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
            colour(&ids, id),
            x + 8.0,
            escape(id)
        );
    }
    let _ = writeln!(
        out,
        "<text x=\"20\" y=\"{}\">kernels: M Möller–Trumbore, B Baldwin–Weber, W watertight, D double, E exact; filled: nothing else is as fast and as right</text>",
        LEGEND - 10.0
    );
    for (i, scene) in scenes.iter().enumerate() {
        let corner = ((i % COLUMNS) as f64 * PANEL.0, LEGEND + (i / COLUMNS) as f64 * PANEL.1);
        let rows: Vec<&Row> = trade.rows.iter().filter(|row| row.scene == *scene).collect();
        panel(&mut out, corner, scene, &rows, &ids);
    }
    out.push_str("</svg>\n");
    out
}

fn family(row: &Row) -> &str {
    row.structure.split(':').next().unwrap_or_default()
}

fn colour(ids: &[&str], id: &str) -> &'static str {
    let place = ids.iter().position(|other| *other == id).unwrap_or(0);
    COLOURS[place % COLOURS.len()]
}

fn letter(row: &Row) -> &'static str {
    match row.kernel.as_str() {
        "moller-trumbore" => "M",
        "baldwin-weber" => "B",
        "watertight" => "W",
        "double" => "D",
        "exact" => "E",
        _ => "",
    }
}

fn panel(out: &mut String, (left, top): (f64, f64), scene: &str, rows: &[&Row], ids: &[&str]) {
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
    for (row, ns, errors) in &points {
        let (x, y, colour) = (x_of(*ns), y_of(*errors), colour(ids, family(row)));
        let fill = if row.front { colour } else { "none" };
        let _ = writeln!(
            out,
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"4\" fill=\"{fill}\" stroke=\"{colour}\"><title>{}: {ns:.0} ns, {errors:.1} in a million</title></circle>\
             <text x=\"{:.1}\" y=\"{:.1}\" fill=\"{colour}\">{}</text>",
            escape(&row.structure),
            x + 5.0,
            y - 4.0,
            letter(row)
        );
    }
}

fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
