//! The report as Markdown.

use crate::cells::figures;
use crate::memory;
use crate::table::{Table, Value, code, escape, figure};
use harness::grouped::{Measure, Ranking, rank};
use harness::record::{Cell, Errors, Record};
use harness::units;
use std::fmt::Write;

/// The whole report.
pub fn markdown(record: &Record) -> String {
    let mut out = String::from("# Acceleration structures compared\n\n");
    run(&mut out, record);
    ranking(&mut out, record);
    section(
        &mut out,
        "Time per ray",
        "Median ns per ray, or µs where said.",
        figures(&record.cells, Measure::Trace),
    );
    section(&mut out, "Build time", "Median.", figures(&once(&record.cells), Measure::Build));
    let says = "What the method adds to the scene; copied geometry not included.";
    section(&mut out, "Structure bytes", says, figures(&once(&record.cells), Measure::Structure));
    let says = "What the method adds and what it copies of the scene for speed.";
    section(&mut out, "All bytes", says, figures(&once(&record.cells), Measure::Bytes));
    section(&mut out, "Correctness", CORRECTNESS, checks(record));
    if !record.memory.is_empty() {
        section(
            &mut out,
            "Memory of the grid over memory of bit maps",
            NU_MEM,
            memory::table(&record.memory),
        );
    }
    left_out(&mut out, record);
    out
}

const CORRECTNESS: &str = "Structures that use the suite's kernels are compared with brute force by the same kernel: \
every answer must be equal bit for bit. Structures with a ray-triangle test of their own are judged by exact \
arithmetic on the rays where they differ from brute force and on a sample of the rest; what brute force itself \
gets wrong is not counted against them.";

const NU_MEM: &str = "ν_mem at N slices per axis (Skala 1993, §5), above 1 where bit maps take less: by the paper's \
formulas, for the paper's layouts as built (`ssm-list`, `bmssm-dense`), and for the compact layouts as built \
(`ssm` at N; `bmssm`, whose plan has no N, as it is). Two-byte ids name at most 65,536 objects.";

fn run(out: &mut String, record: &Record) {
    let m = &record.machine;
    let s = &record.suite;
    let mut table = Table::new(["", ""]);
    let mode = |on: bool| if on { "on" } else { "off" };
    table.push(["command".into(), Value::code(&record.command)]);
    for (name, value) in [
        ("suite", format!("rayscale {} {} ({}, {})", s.version, s.git, s.profile, s.rustc)),
        ("compiler flags", if s.rustflags.is_empty() { "none".to_owned() } else { s.rustflags.clone() }),
        ("processor", format!("{}, {} threads, {}", m.cpu, m.cores, m.isa)),
        ("system", format!("{}, {} of memory", m.os, units::bytes(m.memory_bytes))),
        ("denormals", format!("FTZ {}, DAZ {}", mode(m.flush_to_zero), mode(m.denormals_are_zero))),
    ] {
        table.push([name, &value]);
    }
    let _ = writeln!(out, "{}", table.markdown());
    let mut table = Table::new(["structure", "version", "settings", "what it is"]);
    for s in &record.structures {
        table.push([&s.id, &s.version, &s.settings, &s.description]);
    }
    let _ = writeln!(out, "{}", table.markdown());
    let mut table = Table::new(["scene".into(), figure("objects"), "kind".into(), "source".into()]);
    for s in &record.scenes {
        table.push([(&s.id).into(), Value::count(s.objects), (&s.kind).into(), (&s.source).into()]);
    }
    let _ = writeln!(out, "{}", table.markdown());
}

/// Rankings of rasters and of lists, to the first of some structures that is there.
fn ranking(out: &mut String, record: &Record) {
    out.push_str("## Ranking\n\n");
    for (title, raster) in [("Rasters", true), ("Lists of rays", false)] {
        if let Some(table) = ranked(record, raster) {
            let _ = writeln!(out, "{title}: {}\n\n{}", table.0, table.1.markdown());
        }
    }
}

/// Geometric means of ratios for rasters or for lists, with a line that says of what.
pub fn ranked(record: &Record, raster: bool) -> Option<(String, Table)> {
    let cells = || record.cells.iter().filter(|cell| cell.is_image() == raster);
    let present = |id: &&str| cells().any(|cell| cell.structure == **id && cell.ns().is_some());
    let to = ["embree", "obvhs-cwbvh", "ssm", "minmax"].into_iter().find(present);
    let to = to.or_else(|| cells().find(|cell| cell.ns().is_some()).map(|cell| cell.structure.as_str()))?;
    let by = |measure| rank(cells(), to, measure).ok();
    let trace = by(Measure::Trace)?;
    let (build, structure, all) = (by(Measure::Build), by(Measure::Structure), by(Measure::Bytes));
    let columns = ["time per ray", "build time", "structure bytes", "all bytes"];
    let mut table = Table::of_figures("structure", columns);
    for place in &trace.places {
        let other = |ranking: &Option<Ranking>| {
            let mut places = ranking.iter().flat_map(|r| &r.places);
            let place = places.find(|p| p.structure == place.structure);
            Value::figure(place.map(|place| place.ratio), units::ratio)
        };
        let time = Value::figure(Some(place.ratio), units::ratio);
        table.push(
            [Value::text(&place.structure), time].into_iter().chain([&build, &structure, &all].map(other)),
        );
    }
    let line = format!(
        "geometric means of ratios to {} over the {} cells that all share ({} left out).",
        code(to),
        trace.shared,
        trace.left_out
    );
    Some((line, table))
}

fn section(out: &mut String, title: &str, says: &str, table: Table) {
    let _ = writeln!(out, "## {title}\n\n{says}\n\n{}", table.markdown());
}

/// One cell for every build: structures that serve all ray sets by one build have the same figures in all.
fn once(cells: &[Cell]) -> Vec<Cell> {
    let mut out: Vec<Cell> = Vec::new();
    for cell in cells {
        let rays = if cell.is_image() { cell.rays.as_str() } else { "lists" };
        let same = |c: &&mut Cell| (c.scene == cell.scene) && c.rays == rays && c.structure == cell.structure;
        match out.iter_mut().find(same) {
            // A set that failed says nothing of the build that served the others.
            Some(known) if !known.outcome.is_measured() => {
                *known = Cell { rays: rays.to_owned(), ..cell.clone() }
            }
            Some(_) => {}
            None => out.push(Cell { rays: rays.to_owned(), ..cell.clone() }),
        }
    }
    out
}

fn checks(record: &Record) -> Table {
    let columns = ["rays", "differences", "judged exactly", "missed", "false", "wrong object", "t ulp (max)"];
    let mut table = Table::of_figures("structure", columns);
    for structure in &record.structures {
        let cells = record.cells.iter().filter(|c| c.structure == structure.id);
        let (mut rays, mut differences) = (0u64, 0u64);
        let mut sum: Option<Errors> = None;
        for check in cells.filter_map(|c| c.check.as_ref()) {
            rays = rays.saturating_add(check.rays_checked);
            differences = differences.saturating_add(check.differences);
            if let Some(e) = &check.errors {
                let sum = sum.get_or_insert_default();
                sum.rays_exact = sum.rays_exact.saturating_add(e.rays_exact);
                sum.missed = sum.missed.saturating_add(e.missed);
                sum.false_hits = sum.false_hits.saturating_add(e.false_hits);
                sum.wrong_object = sum.wrong_object.saturating_add(e.wrong_object);
                sum.t_ulp_max = sum.t_ulp_max.max(e.t_ulp_max);
            }
        }
        let count = |of: fn(Errors) -> u64| Value::count(sum.map(of));
        table.push([
            Value::text(&structure.id),
            Value::count(rays),
            Value::count(differences),
            count(|e| e.rays_exact),
            count(|e| e.missed),
            count(|e| e.false_hits),
            count(|e| e.wrong_object),
            Value::figure(sum.map(|e| e.t_ulp_max), units::figure),
        ]);
    }
    table
}

fn left_out(out: &mut String, record: &Record) {
    let failed: Vec<&Cell> = record.cells.iter().filter(|cell| !cell.outcome.is_measured()).collect();
    if failed.is_empty() && record.skipped.is_empty() {
        return;
    }
    out.push_str("## Failed and left out\n\n");
    for skipped in &record.skipped {
        let _ = writeln!(out, "- {} was left out: {}", code(&skipped.id), escape(&skipped.reason));
    }
    let mut said: Vec<(&str, &str, String)> = Vec::new();
    for cell in failed {
        let error = cell.outcome.reason().unwrap_or_default().to_owned();
        if !said.contains(&(&cell.scene, &cell.structure, error.clone())) {
            let [scene, rays, reason] = [&cell.scene, &cell.rays, &error].map(|text| escape(text));
            let _ = writeln!(out, "- {} on {scene} {rays}: {reason}", name(&cell.structure));
            said.push((&cell.scene, &cell.structure, error));
        }
    }
}

/// A structure's name as code, or as text where it holds what not every reader of Markdown leaves alone in code.
fn name(name: &str) -> String {
    if name.contains(['<', '>', '|']) { escape(name) } else { code(name) }
}
