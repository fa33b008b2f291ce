//! The sections of a report.

use super::Picture;
use crate::aggregate::{Overall, bytes_per_object, threads};
use crate::chart::Styles;
use crate::charts;
use crate::table::{Interactive, Table, Value, figure};
use harness::record::{Cell, RaysId, Record, SceneEntry};
use harness::units::{self, short, times};
use maud::{Markup, html};

/// A chart with its heading and caption.
fn chart(heading: &str, svg: &Markup, caption: &str) -> Markup {
    html! {
        figure {
            h3 { (heading) }
            (svg)
            @if !caption.is_empty() { figcaption { (caption) } }
        }
        "\n"
    }
}

/// Charts beside each other; `None` if there is none.
fn charts(all: Vec<Markup>) -> Option<Markup> {
    (!all.is_empty()).then(|| html! { div.charts { "\n" @for chart in &all { (chart) } } "\n" })
}

/// Memory against speed: for images, for lists of rays, and for each set.
pub fn memory_and_speed<'a, 'r: 'a>(
    all: impl Iterator<Item = &'a Overall<'r>>,
    styles: &Styles,
) -> Option<Markup> {
    let drawn = all.filter_map(|rays| {
        let (svg, words) = charts::pareto(rays, styles)?;
        let mut caption = format!("Geometric means over {}. {words}", rays.extent());
        if !rays.left_out.is_empty() {
            let names: Vec<String> = rays.left_out.iter().map(|(name, n)| format!("{name} ({n})")).collect();
            caption += &format!(" On too few of them to compare: {}.", names.join(", "));
        }
        Some(chart(rays.rays, &svg, caption.trim_end()))
    });
    charts(drawn.collect())
}

/// How much longer than the fastest each structure takes, structures by ray sets.
pub fn ranking(overall: &[Overall], styles: &Styles) -> Markup {
    let mut names: Vec<&str> = Vec::new();
    for row in overall.iter().flat_map(|rays| &rays.rows) {
        if !names.contains(&row.structure) {
            names.push(row.structure);
        }
    }
    let mut table = Table::of_figures("structure", overall.iter().map(|rays| rays.rays));
    for name in names {
        let ratio = |rays: &Overall| {
            let row = rays.rows.iter().find(|row| row.structure == name);
            match row.map(|row| row.ns / rays.rows[0].ns) {
                Some(ratio) => Value::figure(Some(ratio), times),
                None => Value::text("–"),
            }
        };
        table.push([structure(name, styles)].into_iter().chain(overall.iter().map(ratio)));
    }
    table.html(|ratio| ratio <= 1.0)
}

fn structure(name: &str, styles: &Styles) -> Value {
    Value::text(name).with_swatch(styles.class(name))
}

/// A scene's own part: picture, speeds, build against trace.
pub fn scene(
    record: &Record,
    scene: &SceneEntry,
    pictures: &[Picture],
    styles: &Styles,
    is_open: bool,
) -> Markup {
    let id = &scene.id;
    let threads = threads(record);
    let cells: Vec<&Cell> = record.cells.iter().filter(|c| c.scene == *id && c.threads == threads).collect();
    let of = |rays: &str| -> Vec<&Cell> { cells.iter().copied().filter(|c| c.rays == rays).collect() };
    let speeds = record.ray_sets().into_iter().filter_map(|rays| {
        let svg = charts::bars(&of(rays), &format!("Time per ray of {rays} rays on {id}"), styles)?;
        Some(chart(&format!("{rays}: time per ray"), &svg, ""))
    });
    let growth = GROWTH.into_iter().filter_map(|rays| {
        let label = format!("Build and trace time over the number of {rays} rays on {id}");
        let (svg, words) = charts::growth(&of(rays.name()), &label, styles)?;
        Some(chart(&format!("{rays}: build against trace"), &svg, &words))
    });
    html! {
        details id={ "scene-" (id) } open[is_open] {
            summary { (id) " – " (units::count(scene.objects)) " " (scene.kind) }
            p.note { (scene.source) }
            @if !pictures.is_empty() { div.pictures { @for picture in pictures { (picture) } } }
            @if let Some(charts) = charts(speeds.chain(growth).collect()) { (charts) }
        }
        "\n"
    }
}

/// One image and one list of rays are enough to see what building costs.
const GROWTH: [RaysId; 2] = [RaysId::Perspective, RaysId::Diffuse];

/// ν_mem over N, for each scene that has it.
pub fn memory_ratios(record: &Record) -> Option<Markup> {
    let drawn = record.scenes.iter().filter_map(|scene| {
        let rows: Vec<_> = record.memory.iter().filter(|row| row.scene == scene.id).collect();
        let svg = charts::memory_ratio(&rows, &format!("Memory ratio over resolution on {}", scene.id))?;
        Some(chart(&scene.id, &svg, &format!("{} objects", units::count(scene.objects))))
    });
    charts(drawn.collect())
}

/// Wrong answers against speed, for each ray set; `None` where nothing was decided.
pub fn errors_and_speed(overall: &[Overall], styles: &Styles) -> Option<Markup> {
    let drawn = overall.iter().filter_map(|rays| {
        let (svg, words) = charts::errors(rays, styles)?;
        Some(chart(rays.rays, &svg, format!("Over {}. {words}", rays.extent()).trim_end()))
    });
    charts(drawn.collect())
}

/// Wrong answers beside speed, for every structure and ray set whose errors were decided.
pub fn errors(record: &Record, styles: &Styles) -> Option<Markup> {
    let mut table = Table::new([
        "structure".into(),
        "scene".into(),
        "rays".into(),
        figure("time per ray"),
        figure("missed per million"),
        figure("false per million"),
        figure("wrong object per million"),
        figure("t: 99 % within (ulp)"),
        figure("t: worst (ulp)"),
        figure("rays checked"),
    ]);
    for cell in &record.cells {
        let Some((check, errors)) = cell.check.as_ref().and_then(|c| Some((c, c.errors?))) else { continue };
        let rate = |n: u64| Some(n as f64 / check.rays_checked.max(1) as f64 * 1e6);
        table.push([
            structure(&cell.structure, styles),
            Value::text(&cell.scene),
            Value::text(&cell.rays),
            Value::figure(cell.ns(), units::time),
            Value::figure(rate(errors.missed), units::figure),
            Value::figure(rate(errors.false_hits), units::figure),
            Value::figure(rate(errors.wrong_object), units::figure),
            Value::figure(Some(errors.t_ulp_p99), units::figure),
            Value::figure(Some(errors.t_ulp_max), short),
            Value::count(check.rays_checked),
        ]);
    }
    (!table.is_empty()).then(|| table.interactive(Interactive { id: "errors-table", choices: &[0, 1, 2] }))
}

/// Every cell of the record.
pub fn all_cells(record: &Record, styles: &Styles) -> Markup {
    let mut table = Table::new([
        "scene".into(),
        "rays".into(),
        "structure".into(),
        "kernel".into(),
        figure("threads"),
        figure("time per ray"),
        figure("± MAD"),
        figure("least"),
        figure("build"),
        figure("structure"),
        figure("geometry copy"),
        figure("bytes per object"),
        figure("peak of build"),
        figure("rays"),
        figure("hits"),
        figure("differences"),
        "remark".into(),
    ]);
    let bytes = |n: Option<u64>| Value::figure(n.map(|n| n as f64), |n| units::bytes(n as u64));
    for cell in &record.cells {
        let timing = cell.ns_per_ray.filter(|_| cell.ns().is_some());
        let memory = cell.bytes.as_ref();
        table.push([
            Value::text(&cell.scene),
            Value::text(&cell.rays),
            structure(&cell.structure, styles),
            Value::text(cell.kernel.name()),
            Value::count(cell.threads as u64),
            Value::figure(timing.map(|t| t.median), units::time),
            Value::figure(timing.map(|t| t.mad), units::time),
            Value::figure(timing.map(|t| t.min), units::time),
            Value::figure(cell.build(), units::time),
            bytes(memory.map(|b| b.structure)),
            bytes(memory.map(|b| b.geometry_copy)),
            Value::figure(bytes_per_object(record, cell), units::figure),
            bytes(memory.and_then(|b| b.peak_build)),
            Value::count(cell.ray_count),
            Value::count(cell.hits),
            Value::count(cell.check.as_ref().map(|c| c.differences)),
            Value::text(cell.outcome.reason().unwrap_or(&cell.plan)),
        ]);
    }
    table.interactive(Interactive { id: "cells", choices: &[0, 1, 2, 4] })
}

/// The structures with their colours and settings.
pub fn structures(record: &Record, styles: &Styles) -> Markup {
    let mut table = Table::new(["structure", "version", "settings", "what it is"]);
    for s in &record.structures {
        let texts = [&s.version, &s.settings, &s.description].map(Value::text);
        table.push([structure(&s.id, styles)].into_iter().chain(texts));
    }
    table.interactive(Interactive { id: "structures", choices: &[] })
}

/// Where and how it was measured, and how to do it again.
pub fn machine(record: &Record) -> Markup {
    let (machine, suite) = (&record.machine, &record.suite);
    let mode = |on: bool| if on { "on" } else { "off" };
    let facts = [
        ("processor", machine.cpu.clone()),
        ("instruction set", machine.isa.clone()),
        ("cores", machine.cores.to_string()),
        ("memory", units::bytes(machine.memory_bytes)),
        ("system", machine.os.clone()),
        (
            "denormals",
            format!(
                "flush to zero {}, denormals are zero {}",
                mode(machine.flush_to_zero),
                mode(machine.denormals_are_zero)
            ),
        ),
        ("program", format!("rayscale {} {}, {} build", suite.version, suite.git, suite.profile)),
        ("compiler", format!("{} {}", suite.rustc, suite.rustflags)),
    ];
    html! {
        dl { @for (name, value) in facts.iter().filter(|(_, value)| !value.trim().is_empty()) {
            dt { (name) } dd { (value) } "\n"
        } }
        p { "Made by" }
        pre { (record.command) }
        p { "Then, for this page:" }
        pre { "rayscale report record.json" }
    }
}
