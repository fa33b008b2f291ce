//! The page of a trade, and its summary for a README.

use super::conclusions::conclusions;
use super::table;
use crate::table::{code, escape};
use harness::units;
use std::fmt::Write;
use trade::Trade;

/// What the sections are about.
const ORDINARY: &str = "Images, ambient occlusion, reflected light.";
const HUNTING: &str = "Through random points, at edges and corners, from surfaces and from inside: far above what an image shows.";
const CURVE: &str = "Errors are of ordinary rays. A time in brackets is that over the rounded scene in `f32`: unpacking such corners is not in \
             it. *Grown*: each triangle made larger by what rounding moves it. Stars: nothing else of the structure and \
             scene is as small, as fast and as right.";
const LEAVING: &str = "Hits of an image, each with one ray into the hemisphere before it, by `ssm`. Distances are in extents of the scene.";

/// The report as Markdown: conclusions first, then every table that the record has figures for.
pub fn page(trade: &Trade) -> String {
    let mut out = String::from("# Accuracy and its cost\n\n");
    let m = &trade.machine;
    // Writing to a string does not fail.
    let _ = writeln!(out, "Made by {} on {} ({}).\n", code(&trade.command), escape(&m.cpu), escape(&m.isa));
    let Some(found) = conclusions(trade) else {
        out.push_str(
            "A record of old: its rates are of ordinary rays and such as hunt for errors together, and *swapped* is any other object.\n\n",
        );
        out.push_str(&table::hunting(&trade.rows).markdown());
        return out;
    };
    out.push_str("## Conclusions\n\n");
    for sentence in &found.sentences {
        let _ = writeln!(out, "- {sentence}");
    }
    let _ = writeln!(
        out,
        "\nTimes and bytes are relative to the kernel `moller-trumbore` in the same structure, geometric means over the scenes that both \
         were measured on; errors are of ordinary rays, all scenes together.\n\n{}",
        found.kernels.markdown()
    );
    let _ = writeln!(out, "## What counts\n\n{}\n", kinds(trade));
    section(&mut out, "Ordinary rays", ORDINARY, &table::ordinary(&trade.rows));
    section(&mut out, "Rays that hunt for errors", HUNTING, &table::hunting(&trade.rows));
    if !trade.curve.is_empty() {
        section(&mut out, "The curve of precision", CURVE, &table::curve(&trade.curve));
    }
    if !trade.extremes.is_empty() {
        let _ = writeln!(out, "## Extremes\n\n{}\n", extremes(trade));
    }
    if !trade.leaving.is_empty() {
        section(&mut out, "Rays that leave surfaces", LEAVING, &table::leaving(&trade.leaving));
    }
    if !trade.skipped.is_empty() {
        out.push_str("## Left out\n\n");
        for skipped in &trade.skipped {
            let _ = writeln!(out, "- {}: {}", escape(&skipped.id), escape(&skipped.reason));
        }
    }
    out
}

fn section(out: &mut String, title: &str, note: &str, table: &crate::table::Table) {
    let _ = writeln!(out, "## {title}\n\n{note}\n\n{}", table.markdown());
}

fn kinds(trade: &Trade) -> String {
    format!(
        "The tolerance is {} of the scene's extent. A *hole*: the nearest surface is missed. A *phantom*: a hit where there is none, or \
         nearer. *Displaced*: the right surface, off by more than the tolerance. These three are *visible*. *Swapped*: another object \
         in the right place. A *tie*: another object at exactly the same t. Rates are in a million rays (M); bounds are 95 % \
         intervals, the rule of three where none was seen. *Off by* is the distance from the true place along the ray in extents; \
         units in the last place of t are given where t is ordinary.",
        units::figure(trade.tolerance.fraction())
    )
}

/// The table of extremes; empty where the record has none.
pub fn extremes(trade: &Trade) -> String {
    let mut out = String::new();
    if !trade.extremes.is_empty() {
        let left_out: u64 = trade.extremes.iter().map(|extreme| extreme.left_out).sum();
        let note = format!(
            "Holes / phantoms of so many rays. Left out: {} rays whose true t is not zero and below the least normal `f32`.",
            units::count(left_out)
        );
        let _ = writeln!(out, "{note}\n\n{}", table::extremes(&trade.extremes).markdown());
        for (extreme, answer) in trade.extremes.iter().flat_map(|e| e.answers.iter().map(move |a| (e, a))) {
            if let Err(reason) = &answer.found {
                let _ = writeln!(out, "- Refused: {}: {}", escape(&extreme.name), escape(reason));
            }
        }
    }
    out
}

/// Three lines and a chart for a README, which lies where the chart is reached at `chart`.
pub fn summary(trade: &Trade, chart: &str) -> Option<String> {
    let found = conclusions(trade)?;
    let lines: Vec<String> = found.summary.iter().map(|line| format!("- {line}")).collect();
    Some(format!(
        "{}\n\n![Visible errors against bytes a triangle, by bits of a coordinate]({chart})",
        lines.join("\n")
    ))
}
