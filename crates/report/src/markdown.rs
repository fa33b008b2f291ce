//! The report as Markdown.

use super::memory;
use super::table::{Table, figures};
use harness::grouped::{Measure, rank};
use harness::record::{Cell, Record};
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
    for (name, value) in [
        ("command", format!("`{}`", record.command)),
        ("suite", format!("rayscale {} {} ({}, {})", s.version, s.git, s.profile, s.rustc)),
        ("compiler flags", if s.rustflags.is_empty() { "none".to_owned() } else { s.rustflags.clone() }),
        ("processor", format!("{}, {} threads, {}", m.cpu, m.cores, m.isa)),
        ("system", format!("{}, {} of memory", m.os, units::bytes(m.memory_bytes))),
        ("denormals", format!("FTZ {}, DAZ {}", mode(m.flush_to_zero), mode(m.denormals_are_zero))),
    ] {
        table.rows.push(vec![name.to_owned(), value]);
    }
    let _ = writeln!(out, "{}", table.markdown());
    let mut table = Table::new(["structure", "version", "settings", "what it is"]);
    for s in &record.structures {
        table.rows.push(vec![s.id.clone(), s.version.clone(), s.settings.clone(), s.description.clone()]);
    }
    let _ = writeln!(out, "{}", table.markdown());
    let mut table = Table::new(["scene", "objects", "kind", "source"]);
    for s in &record.scenes {
        table.rows.push(vec![s.id.clone(), units::count(s.objects), s.kind.clone(), s.source.clone()]);
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
    let mut table = Table::new(["structure", "time per ray", "build time", "structure bytes", "all bytes"]);
    for place in &trace.places {
        let other = |ranking: &Option<harness::grouped::Ranking>| {
            let place =
                ranking.as_ref().and_then(|r| r.places.iter().find(|p| p.structure == place.structure));
            place.map_or_else(|| "–".to_owned(), |place| format!("{:.3}", place.ratio))
        };
        let mut row = vec![place.structure.clone(), format!("{:.3}", place.ratio)];
        row.extend([&build, &structure, &all].map(other));
        table.rows.push(row);
    }
    let line = format!(
        "geometric means of ratios to `{to}` over the {} cells that all share ({} left out).",
        trace.shared, trace.left_out
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
    let head = [
        "structure",
        "rays",
        "differences",
        "judged exactly",
        "missed",
        "false",
        "wrong object",
        "t ulp (max)",
    ];
    let mut table = Table::new(head);
    for structure in &record.structures {
        let checks =
            record.cells.iter().filter(|c| c.structure == structure.id).filter_map(|c| c.check.as_ref());
        let (mut rays, mut differences) = (0, 0);
        let mut sum: Option<harness::record::Errors> = None;
        for check in checks {
            rays += check.rays_checked;
            differences += check.differences;
            if let Some(e) = &check.errors {
                let sum = sum.get_or_insert_default();
                sum.rays_exact += e.rays_exact;
                sum.missed += e.missed;
                sum.false_hits += e.false_hits;
                sum.wrong_object += e.wrong_object;
                sum.t_ulp_max = sum.t_ulp_max.max(e.t_ulp_max);
            }
        }
        let mut row = vec![structure.id.clone(), units::count(rays), units::count(differences)];
        match sum {
            None => row.extend(["–"; 5].map(str::to_owned)),
            Some(e) => {
                row.extend([e.rays_exact, e.missed, e.false_hits, e.wrong_object].map(units::count));
                row.push(format!("{:.1}", e.t_ulp_max));
            }
        }
        table.rows.push(row);
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
        let _ = writeln!(out, "- `{}` was left out: {}", skipped.id, skipped.reason);
    }
    let mut said: Vec<(&str, &str, String)> = Vec::new();
    for cell in failed {
        let error = cell.outcome.reason().unwrap_or_default().to_owned();
        if !said.contains(&(&cell.scene, &cell.structure, error.clone())) {
            let _ = writeln!(out, "- `{}` on {} {}: {error}", cell.structure, cell.scene, cell.rays);
            said.push((&cell.scene, &cell.structure, error));
        }
    }
}
