//! The page: the record as Markdown.

use super::memory::{Crossing, Point};
use super::{Paper, Table};
use harness::units::{bytes, count};
use std::fmt::Write;

/// The page of a record. Every number on it stands in the record.
pub fn markdown(paper: &Paper) -> String {
    let mut out = String::new();
    // Writing to a string does not fail.
    let _ = head(&mut out, paper)
        .and_then(|()| cost_model(&mut out, paper))
        .and_then(|()| tables(&mut out, paper))
        .and_then(|()| memory(&mut out, paper))
        .and_then(|()| consistency(&mut out, paper))
        .and_then(|()| split(&mut out, paper))
        .and_then(|()| slips(&mut out, paper));
    out
}

type Written = std::fmt::Result;

fn head(out: &mut String, paper: &Paper) -> Written {
    let effort = &paper.effort;
    writeln!(
        out,
        "# Skala 1993, reproduced\n\nV. Skala, *Memory saving technique for space subdivision technique*, Machine \
         GRAPHICS and VISION 2(3), 1993, pp. 237–250. Every table and formula of the paper beside today's figure.\n\n\
         Made by `rayscale paper` (version {}) on {}, one thread: {} seeds, medians of {} interleaved rounds of \
         processor time, each over another row of the image. Headings name the place in `paper.json` in brackets. ν is the time of the reference \
         over the time of BMSSM.\n",
        paper.version, paper.machine, effort.seeds, effort.rounds
    )
}

fn cost_model(out: &mut String, paper: &Paper) -> Written {
    let model = &paper.cost_model;
    if let Some(table) = paper.tables.get("1") {
        write_table(out, "1", table)?;
    }
    writeln!(
        out,
        "\n## Cost model, §3 and §4 [`cost_model`]\n\nOur cycle takes {:.3} ns, our T_BMSSM (the appendix loop, all bits set) \
         {:.3} ns an object. Estimates by our costs are in ns.\n",
        model.cycle_ns, model.bmssm_ns
    )?;
    writeln!(
        out,
        "| time | := < ± × ÷ | printed | by the printed costs | ours by latency | ours by throughput | measured |"
    )?;
    writeln!(out, "|---|---|---|---|---|---|---|")?;
    for e in &model.estimates {
        let operations = e.operations.map(number).join(" ");
        let measured = e.measured_ns.map_or("–".into(), |ns| format!("{ns:.3}"));
        writeln!(
            out,
            "| {} | {operations} | {} | {:.1} | {:.3} | {:.3} | {measured} |",
            e.name, e.printed, e.by_printed_costs, e.by_our_latency_ns, e.by_our_throughput_ns
        )?;
    }
    writeln!(
        out,
        "\n| ν where every object is a candidate | printed | by the printed times | predicted by latency | predicted by throughput | measured |\n|---|---|---|---|---|---|"
    )?;
    for r in &model.ratios {
        writeln!(
            out,
            "| {} | {} | {:.2} | {:.2} | {:.2} | {:.2} |",
            r.name,
            r.printed,
            r.by_printed_times,
            r.predicted_by_latency,
            r.predicted_by_throughput,
            r.measured
        )?;
    }
    writeln!(
        out,
        "\nA model that adds up operations fits a machine that does one after the other. Today's runs several at once and \
         guesses branches, so that the measured ratio lies where neither sum puts it; and where few objects are \
         candidates, BMSSM passes over 32 or 64 of them with one operation, which is what Tables 2–5 show.\n"
    )
}

fn tables(out: &mut String, paper: &Paper) -> Written {
    for (key, picture) in [
        ("2", Some("nu.svg")),
        ("3", None),
        ("4", None),
        ("5", None),
        ("6", None),
        ("7", Some("candidates.svg")),
        ("secondary", None),
    ] {
        if let Some(table) = paper.tables.get(key) {
            write_table(out, key, table)?;
        }
        if let Some(picture) = picture {
            writeln!(out, "\n![]({picture})")?;
        }
    }
    Ok(())
}

fn write_table(out: &mut String, key: &str, table: &Table) -> Written {
    let name = if key.len() == 1 { format!("Table {key}: ") } else { String::new() };
    writeln!(out, "\n## {name}{} [`tables.\"{key}\"`]\n", table.title)?;
    for remark in &table.remarks {
        writeln!(out, "- {remark}")?;
    }
    let printed: Vec<Vec<String>> =
        table.printed.iter().map(|row| row.iter().map(|v| v.map_or("–".into(), number)).collect()).collect();
    let ours = texts(&table.ours);
    if table.printed.iter().flatten().any(Option::is_some) {
        let pairs = |row: usize| -> Vec<String> {
            printed[row].iter().zip(&ours[row]).map(|(p, o)| format!("{p} / **{o}**")).collect()
        };
        body(out, table, "printed / **ours**", &(0..table.rows.len()).map(pairs).collect::<Vec<_>>())?;
    } else {
        body(out, table, "ours", &ours)?;
    }
    for (name, values) in &table.variants {
        body(out, table, name, &texts(values))?;
    }
    Ok(())
}

fn texts(values: &[Vec<f64>]) -> Vec<Vec<String>> {
    values.iter().map(|row| row.iter().map(|v| number(*v)).collect()).collect()
}

fn body(out: &mut String, table: &Table, name: &str, values: &[Vec<String>]) -> Written {
    writeln!(out, "\n{name}:\n\n| {} \\ {} | {} |", table.row_name, table.col_name, table.cols.join(" | "))?;
    writeln!(out, "|---|{}", "---|".repeat(table.cols.len()))?;
    for (row, values) in table.rows.iter().zip(values) {
        writeln!(out, "| {row} | {} |", values.join(" | "))?;
    }
    Ok(())
}

fn memory(out: &mut String, paper: &Paper) -> Written {
    writeln!(
        out,
        "\n## Memory, §5 [`memory`]\n\nM_SSM = 2N³(q+2) bytes, M_BMSSM = 3Np bits, ν_mem = (16/3)·((q+2)/p)·N². With ids, counters \
         and pointers of 4 bytes M_SSM and ν_mem double. Built are `bmssm-dense` and `ssm-list` (counter and ids of 2 \
         bytes where they can name all objects, else 4; positions always of 4); rows marked *model* were too large to \
         build and hold the same layouts by formula. q is measured where built. An object of edge r cells touches (r+1)³ \
         cells, so that p·r³/N³ is far too low for small objects.\n\n![](memory.svg)\n"
    )?;
    for case in super::memory::CASES {
        let law = match case {
            "large" => "objects as large as the scene, q → p: (16/3)·N²",
            "one a cell" => "q ≈ 1: 16·N²/p",
            _ => "q → 0: (32/3)·N²/p",
        };
        writeln!(out, "### {case}: {law}\n")?;
        writeln!(
            out,
            "| p | N | r | q | p(r+1)³/N³ | pr³/N³ | M_SSM | 4-byte | as built | M_BMSSM | as built | ν_mem | 4-byte | as built | special case |"
        )?;
        writeln!(out, "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|")?;
        for point in paper.memory.points.iter().filter(|point| point.case == case) {
            writeln!(out, "{}", memory_row(point))?;
        }
        writeln!(out)?;
    }
    writeln!(
        out,
        "### The N at which ν_mem is 1\n\n| case | p | formula | 4-byte ids | as built |\n|---|---|---|---|---|"
    )?;
    for Crossing { case, p, formula, formula_4, built } in &paper.memory.crossings {
        let built = built.map_or("outside of the N built".into(), |n| format!("{n:.1}"));
        writeln!(out, "| {case} | {} | {formula:.1} | {formula_4:.1} | {built} |", count((*p).into()))?;
    }
    writeln!(
        out,
        "\nWith many small objects maps win only at high N: a million of them want N above about 250, or 177 with honest ids.\n"
    )
}

fn memory_row(point: &Point) -> String {
    let size = |v: f64| bytes(v as u64);
    let model = if point.built { "" } else { " *model*" };
    format!(
        "| {} | {} | {} | {} | {} | {} | {} | {} | {}{model} | {} | {}{model} | {} | {} | {} | {} |",
        count(point.p.into()),
        point.n,
        number(point.r),
        number(point.q),
        number(point.q_touched),
        number(point.q_formula),
        size(point.ssm_formula),
        size(point.ssm_formula_4),
        size(point.ssm_built),
        size(point.bmssm_formula),
        size(point.bmssm_built),
        number(point.nu_formula),
        number(point.nu_formula_4),
        number(point.nu_built),
        number(point.nu_case),
    )
}

fn consistency(out: &mut String, paper: &Paper) -> Written {
    writeln!(out, "\n## Image consistency, §2 [`consistency`]\n")?;
    let Some(shown) = &paper.consistency else {
        return writeln!(out, "No scene could be had to show it.");
    };
    writeln!(
        out,
        "`{}`, {} objects. A 0 in V (W) says that no row (column) plane meets the object's box: no ray can hit it. V and W \
         prove objects lost; an object that they let pass may be hidden or missed all the same.\n\n\
         | image | 0 in V | 0 in W | no ray can hit | hit first by some ray | visible at {}² and lost | first lost |\n|---|---|---|---|---|---|---|",
        shown.scene,
        count(shown.objects as u64),
        shown.resolutions.first().map_or(0, |r| r.pixels)
    )?;
    for r in &shown.resolutions {
        let first: Vec<String> = r.first_unseen.iter().map(ToString::to_string).collect();
        writeln!(
            out,
            "| {0} × {0} | {1} | {2} | {3} | {4} | {5} | {6} … |",
            r.pixels,
            count(r.no_row as u64),
            count(r.no_column as u64),
            count(r.unseen as u64),
            count(r.visible as u64),
            count(r.visible_lost as u64),
            first.join(" ")
        )?;
    }
    writeln!(
        out,
        "\nIn red the objects that no ray of the image of {0} × {0} can hit ({1} pixels of the picture):\n\n\
         ![](consistency.png)\n\n![](consistency.svg)\n",
        shown.marked_at,
        count(shown.marked_pixels as u64)
    )
}

fn split(out: &mut String, paper: &Paper) -> Written {
    writeln!(
        out,
        "\n## Large objects split, §2 [`split`]\n\n`stadium`: a teapot in a hall of 12 large triangles, split until no edge is longer \
         than the bound. Primary rays {0} × {0}; general rays at N = {1}, candidates counted in every cell. The walls lie along the \
         axes, so that their boxes are thin already: a split of them takes bits from slices, but adds objects.\n",
        super::facets::IMAGE,
        super::facets::RESOLUTION
    )?;
    writeln!(
        out,
        "| longest edge | objects | R & S: candidates | ns a ray | bytes | R & S & T: candidates | ns a ray | bytes |\n|---|---|---|---|---|---|---|---|"
    )?;
    for f in &paper.split {
        writeln!(
            out,
            "| {} | {} | {} | {} | {} | {} | {} | {} |",
            f.longest.map_or("as it is".into(), number),
            count(f.objects as u64),
            number(f.primary_candidates),
            number(f.primary_ns),
            bytes(f.primary_bytes as u64),
            number(f.general_candidates),
            number(f.general_ns),
            bytes(f.general_bytes as u64)
        )?;
    }
    Ok(())
}

fn slips(out: &mut String, paper: &Paper) -> Written {
    writeln!(
        out,
        "\n## Where the print is wrong [`slips`]\n\n| place | printed | arithmetic | reading |\n|---|---|---|---|"
    )?;
    for s in &paper.slips {
        writeln!(out, "| {} | {} | {} | {} |", s.place, s.printed, s.arithmetic, s.reading)?;
    }
    Ok(())
}

/// Four digits that count.
fn number(value: f64) -> String {
    let size = value.abs();
    let text = match size {
        0.0 => return "0".into(),
        s if !(1e-4..1e6).contains(&s) => return format!("{value:.2e}"),
        s if s >= 1000.0 => format!("{value:.0}"),
        s if s >= 100.0 => format!("{value:.1}"),
        s if s >= 1.0 => format!("{value:.2}"),
        _ => format!("{value:.4}"),
    };
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}
