//! The page: the record as Markdown.

use super::facets::Facets;
use super::memory::{Crossing, Point};
use super::{Paper, Table};
use harness::units;
use report::table::{Table as Columns, Value, figure};
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
         processor time. {} Headings name the place in `paper.json` in brackets. ν is the time of the reference \
         over the time of BMSSM.\n\n\
         The paper doesn't say how its boxes lie. Here they lie so that the means of Table 6 come out (`experiment.rs`), so that Table 6 is no test of \
         the reproduction: of the two tables of candidates Table 7, the largest numbers, alone is independent.\n",
        paper.version,
        paper.machine,
        effort.seeds,
        effort.rounds,
        match (effort.images, effort.image_step) {
            (0, _) => "Tables 2 to 5 repeat single rows of an image.".to_owned(),
            (rounds, 1) => format!(
                "Tables 2 to 5 trace whole images, as the paper did, {rounds} times, the times of a cell minutes apart."
            ),
            (rounds, step) => format!("Tables 2 to 5 trace one row in {step} of an image, {rounds} times."),
        }
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
    let mut times = Columns::of_figures(
        "time",
        [
            ":= < ± × ÷",
            "printed",
            "by the printed costs",
            "ours by latency",
            "ours by throughput",
            "measured",
        ],
    );
    for e in &model.estimates {
        let operations = e.operations.map(|n| units::significant(n, DIGITS)).join(" ");
        let ns = [e.by_printed_costs, e.by_our_latency_ns, e.by_our_throughput_ns].map(number);
        let cells = [Value::text(&e.name), operations.into(), number(e.printed)];
        let measured = Value::figure(e.measured_ns, |ns| units::significant(ns, DIGITS));
        times.push(cells.into_iter().chain(ns).chain([measured]));
    }
    writeln!(out, "{}", times.markdown())?;
    let mut ratios = Columns::of_figures(
        "ν where every object is a candidate",
        ["printed", "by the printed times", "predicted by latency", "predicted by throughput", "measured"],
    );
    for r in &model.ratios {
        let all =
            [r.printed, r.by_printed_times, r.predicted_by_latency, r.predicted_by_throughput, r.measured];
        ratios.push([Value::text(&r.name)].into_iter().chain(all.map(number)));
    }
    writeln!(out, "{}", ratios.markdown())?;
    writeln!(
        out,
        "A model that adds up operations fits a machine that does one after the other. Today's runs several at once and \
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
        ("setup", None),
        ("depth", None),
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
    if table.printed.iter().flatten().any(Option::is_some) {
        let pair = |row: usize, col: usize| {
            let printed =
                table.printed[row][col].map_or_else(|| "–".into(), |v| units::significant(v, DIGITS));
            let ours = units::significant(table.ours[row][col], DIGITS);
            Value::text(format!("{printed} / ")).and_strong(ours)
        };
        body(out, table, "printed / **ours**", pair)?;
    } else {
        body(out, table, "ours", |row, col| number(table.ours[row][col]))?;
    }
    for (name, values) in &table.variants {
        body(out, table, name, |row, col| number(values[row][col]))?;
    }
    Ok(())
}

fn body(out: &mut String, table: &Table, name: &str, value: impl Fn(usize, usize) -> Value) -> Written {
    let mut columns = Columns::of_figures(&format!("{} \\ {}", table.row_name, table.col_name), &table.cols);
    for (row, row_name) in table.rows.iter().enumerate() {
        let values = (0..table.cols.len()).map(|col| value(row, col));
        columns.push([Value::text(row_name)].into_iter().chain(values));
    }
    writeln!(out, "\n{name}:\n\n{}", columns.markdown().trim_end())
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
        let mut sizes = Columns::new(
            [
                "p",
                "N",
                "r",
                "q",
                "p(r+1)³/N³",
                "pr³/N³",
                "M_SSM",
                "4-byte",
                "as built",
                "M_BMSSM",
                "as built",
                "ν_mem",
                "4-byte",
                "as built",
                "special case",
            ]
            .map(figure),
        );
        paper.memory.points.iter().filter(|point| point.case == case).for_each(|point| {
            sizes.push(memory_row(point));
        });
        writeln!(out, "{}", sizes.markdown())?;
    }
    let mut crossings = Columns::of_figures("case", ["p", "formula", "4-byte ids", "as built"]);
    for Crossing { case, p, formula, formula_4, built } in &paper.memory.crossings {
        let built = built.map_or_else(|| Value::text("outside of the N built"), number);
        crossings.push([
            Value::text(case),
            Value::count(u64::from(*p)),
            number(*formula),
            number(*formula_4),
            built,
        ]);
    }
    writeln!(out, "### The N at which ν_mem is 1\n\n{}", crossings.markdown())?;
    writeln!(
        out,
        "With many small objects maps win only at high N: a million of them want N above about 250, or 177 with honest ids.\n"
    )
}

fn memory_row(point: &Point) -> [Value; 15] {
    let as_built = |v: f64| match bytes(v) {
        value if point.built => value,
        value => Value::text(format!("{} model", value.plain())),
    };
    [
        Value::count(u64::from(point.p)),
        Value::count(u64::from(point.n)),
        number(point.r),
        number(point.q),
        number(point.q_touched),
        number(point.q_formula),
        bytes(point.ssm_formula),
        bytes(point.ssm_formula_4),
        as_built(point.ssm_built),
        bytes(point.bmssm_formula),
        as_built(point.bmssm_built),
        number(point.nu_formula),
        number(point.nu_formula_4),
        number(point.nu_built),
        number(point.nu_case),
    ]
}

fn consistency(out: &mut String, paper: &Paper) -> Written {
    writeln!(out, "\n## Image consistency, §2 [`consistency`]\n")?;
    let Some(shown) = &paper.consistency else {
        return writeln!(out, "No scene could be had to show it.");
    };
    writeln!(
        out,
        "`{}`, {} objects. A 0 in V (W) says that no row (column) plane meets the object's box: no ray can hit it. V and W \
         prove objects lost; an object that they let pass may be hidden or missed all the same.\n",
        shown.scene,
        units::count(shown.objects as u64),
    )?;
    let first = shown.resolutions.first().map_or(0, |r| r.pixels);
    let lost = format!("visible at {first}² and lost");
    let mut images = Columns::of_figures(
        "image",
        ["0 in V", "0 in W", "no ray can hit", "hit first by some ray", &lost, "first lost"],
    );
    for r in &shown.resolutions {
        let first: Vec<String> = r.first_unseen.iter().map(ToString::to_string).collect();
        let counts = [r.no_row, r.no_column, r.unseen, r.visible, r.visible_lost];
        let counts = counts.map(|n| Value::count(n as u64));
        let image = Value::text(format!("{0} × {0}", r.pixels));
        images.push([image].into_iter().chain(counts).chain([format!("{} …", first.join(" ")).into()]));
    }
    writeln!(out, "{}", images.markdown())?;
    writeln!(
        out,
        "In red the objects that no ray of the image of {0} × {0} can hit ({1} pixels of the picture):\n\n\
         ![](consistency.png)\n\n![](consistency.svg)\n",
        shown.marked_at,
        units::count(shown.marked_pixels as u64)
    )
}

fn split(out: &mut String, paper: &Paper) -> Written {
    writeln!(
        out,
        "\n## Large objects split, §2 [`split`]\n\nTriangles split until no edge is longer than the bound. Primary rays {0} × {0}; general \
         rays at N = {1}, candidates counted in every cell.\n",
        super::facets::IMAGE,
        super::facets::RESOLUTION
    )?;
    for facets in paper.split.chunk_by(|a, b| a.scene == b.scene) {
        scene_split(out, facets)?;
    }
    Ok(())
}

fn scene_split(out: &mut String, all: &[Facets]) -> Written {
    let [Some(whole), Some(least)] =
        [all.first(), all.iter().min_by(|a, b| a.general_candidates.total_cmp(&b.general_candidates))]
    else {
        return Ok(());
    };
    let helps = least.general_candidates < 0.95 * whole.general_candidates;
    let says = if helps {
        let bound = least.longest.map_or_else(String::new, |longest| units::significant(longest, DIGITS));
        format!(
            "splitting lowers the candidates: with edges up to {bound} a general ray meets {} instead of {}, a primary ray {} instead of {}. \
             The maps have a bit for each part, and a general ray takes {} ns instead \
             of {}",
            units::significant(least.general_candidates, DIGITS),
            units::significant(whole.general_candidates, DIGITS),
            units::significant(least.primary_candidates, DIGITS),
            units::significant(whole.primary_candidates, DIGITS),
            units::significant(least.general_ns, DIGITS),
            units::significant(whole.general_ns, DIGITS),
        )
    } else {
        "splitting doesn't help: large triangles along the axes have boxes that are as thin as themselves, and parts of them add objects"
            .to_owned()
    };
    writeln!(out, "`{}`: {says}.\n", whole.scene)?;
    let mut facets = Columns::of_figures(
        "longest edge",
        ["objects", "R & S: candidates", "ns a ray", "bytes", "R & S & T: candidates", "ns a ray", "bytes"],
    );
    for f in all {
        facets.push([
            f.longest.map_or_else(|| Value::text("as it is"), number),
            Value::count(f.objects as u64),
            number(f.primary_candidates),
            number(f.primary_ns),
            bytes(f.primary_bytes as f64),
            number(f.general_candidates),
            number(f.general_ns),
            bytes(f.general_bytes as f64),
        ]);
    }
    writeln!(out, "{}", facets.markdown())
}

fn slips(out: &mut String, paper: &Paper) -> Written {
    let mut slips = Columns::new(["place", "printed", "arithmetic", "reading"]);
    for s in &paper.slips {
        slips.push([&s.place, &s.printed, &s.arithmetic, &s.reading]);
    }
    writeln!(out, "\n## Where the print is wrong [`slips`]\n\n{}", slips.markdown().trim_end())
}

/// Digits that count in a table.
const DIGITS: usize = 4;

fn number(value: f64) -> Value {
    Value::figure(Some(value), |v| units::significant(v, DIGITS))
}

fn bytes(value: f64) -> Value {
    Value::figure(Some(value), |v| units::bytes(v as u64))
}
