//! The sections of a report.

use super::Picture;
use super::aggregate::{Overall, bytes_per_object, threads};
use super::charts;
use super::scale::{short, trimmed};
use super::style::Styles;
use super::svg::escape;
use super::table::{Value, figure, table, text};
use harness::record::{Cell, RaysId, Record};
use harness::units;
use std::fmt::Write;

/// A chart with its heading and caption.
fn chart(heading: &str, svg: &str, caption: &str) -> String {
    let caption =
        if caption.is_empty() { String::new() } else { format!("<figcaption>{caption}</figcaption>") };
    format!("<figure><h3>{}</h3>{svg}{caption}</figure>\n", escape(heading))
}

/// Memory against speed, for each ray set.
pub fn memory_and_speed(overall: &[Overall], styles: &Styles) -> String {
    let mut html = String::from("<div class=\"charts\">\n");
    for rays in overall {
        let Some((svg, words)) = charts::pareto(rays, styles) else { continue };
        let mut caption = format!("Geometric means over {} scenes. {}", rays.scenes.len(), escape(&words));
        if !rays.left_out.is_empty() {
            let names: Vec<String> =
                rays.left_out.iter().map(|(name, n)| format!("{} ({n})", escape(name))).collect();
            let _ = write!(caption, " On too few scenes to compare: {}.", names.join(", "));
        }
        html += &chart(rays.rays, &svg, caption.trim_end());
    }
    html + "</div>\n"
}

/// How much longer than the fastest each structure takes, structures by ray sets.
pub fn ranking(overall: &[Overall], styles: &Styles) -> String {
    let mut names: Vec<&str> = Vec::new();
    for row in overall.iter().flat_map(|rays| &rays.rows) {
        if !names.contains(&row.structure) {
            names.push(row.structure);
        }
    }
    let mut html = String::from(
        "<div class=\"scroll\" tabindex=\"0\"><table><thead><tr><th scope=\"col\">structure</th>",
    );
    for rays in overall {
        let _ = write!(html, "<th scope=\"col\" class=\"n\">{}</th>", escape(rays.rays));
    }
    html.push_str("</tr></thead><tbody>\n");
    for name in names {
        let _ = write!(html, "<tr><td><i class=\"swatch {}\"></i>{}</td>", styles.class(name), escape(name));
        for rays in overall {
            let row = rays.rows.iter().find(|row| row.structure == name);
            let _ = match row {
                Some(row) => {
                    let ratio = row.ns / rays.rows[0].ns;
                    let best = if ratio <= 1.0 { " best" } else { "" };
                    write!(html, "<td class=\"n{best}\">{}×</td>", trimmed(ratio))
                }
                None => write!(html, "<td class=\"n\">–</td>"),
            };
        }
        html.push_str("</tr>\n");
    }
    html + "</tbody></table></div>\n"
}

/// A scene's own part: picture, speeds, build against trace.
pub fn scene(record: &Record, id: &str, pictures: &[Picture], styles: &Styles, is_open: bool) -> String {
    let Some(entry) = record.scene(id) else { return String::new() };
    let threads = threads(record);
    let cells: Vec<&Cell> = record.cells.iter().filter(|c| c.scene == id && c.threads == threads).collect();
    let name = escape(id);
    let open = if is_open { " open" } else { "" };
    let mut html = format!(
        "<details id=\"scene-{name}\"{open}><summary>{name} – {} {}</summary>\n<p class=\"note\">{}</p>\n",
        units::count(entry.objects),
        escape(&entry.kind),
        escape(&entry.source)
    );
    if !pictures.is_empty() {
        html.push_str("<div class=\"pictures\">");
        for picture in pictures {
            html += &picture.html();
        }
        html.push_str("</div>\n");
    }
    html.push_str("<div class=\"charts\">\n");
    for rays in record.ray_sets() {
        let of_rays: Vec<&Cell> = cells.iter().copied().filter(|c| c.rays == rays).collect();
        let label = format!("Time per ray of {rays} rays on {id}");
        if let Some(svg) = charts::bars(&of_rays, &label, styles) {
            html += &chart(&format!("{rays}: time per ray"), &svg, "");
        }
    }
    for rays in GROWTH {
        let of_rays: Vec<&Cell> = cells.iter().copied().filter(|c| c.ray_set() == Some(rays)).collect();
        let label = format!("Build and trace time over the number of {rays} rays on {id}");
        if let Some((svg, words)) = charts::growth(&of_rays, &label, styles) {
            html += &chart(&format!("{rays}: build against trace"), &svg, &escape(&words));
        }
    }
    html + "</div></details>\n"
}

/// One image and one list of rays are enough to see what building costs.
const GROWTH: [RaysId; 2] = [RaysId::Perspective, RaysId::Diffuse];

/// ν_mem over N, for each scene that has it.
pub fn memory_ratios(record: &Record) -> Option<String> {
    let mut html = String::from("<div class=\"charts\">\n");
    let before = html.len();
    for scene in &record.scenes {
        let rows: Vec<_> = record.memory.iter().filter(|row| row.scene == scene.id).collect();
        let label = format!("Memory ratio over resolution on {}", scene.id);
        if let Some(svg) = charts::memory_ratio(&rows, &label) {
            html += &chart(&scene.id, &svg, &format!("{} objects", units::count(scene.objects)));
        }
    }
    (html.len() > before).then(|| html + "</div>\n")
}

/// Wrong answers against speed, for each ray set; empty where nothing was decided.
pub fn errors_and_speed(overall: &[Overall], styles: &Styles) -> String {
    let all = overall.iter().filter_map(|rays| {
        let (svg, words) = charts::errors(rays, styles)?;
        let caption = format!("Over {} scenes. {}", rays.scenes.len(), escape(&words));
        Some(chart(rays.rays, &svg, caption.trim_end()))
    });
    let all: String = all.collect();
    if all.is_empty() { all } else { format!("<div class=\"charts\">\n{all}</div>\n") }
}

/// Wrong answers beside speed, for every structure and ray set whose errors were decided.
pub fn errors(record: &Record, styles: &Styles) -> Option<String> {
    let rows: Vec<Vec<Value>> = record
        .cells
        .iter()
        .filter_map(|cell| {
            let check = cell.check.as_ref()?;
            let errors = check.errors?;
            let rate = |n: u64| Some(n as f64 / check.rays_checked.max(1) as f64 * 1e6);
            Some(vec![
                Value::structure(&cell.structure, &styles.class(&cell.structure)),
                Value::text(&cell.scene),
                Value::text(&cell.rays),
                Value::figure(cell.ns(), units::time),
                Value::figure(rate(errors.missed), trimmed),
                Value::figure(rate(errors.false_hits), trimmed),
                Value::figure(rate(errors.wrong_object), trimmed),
                Value::figure(Some(errors.t_ulp_p99), trimmed),
                Value::figure(Some(errors.t_ulp_max), short),
                Value::figure(Some(check.rays_checked as f64), |n| units::count(n as u64)),
            ])
        })
        .collect();
    let columns = [
        text("structure"),
        text("scene"),
        text("rays"),
        figure("time per ray"),
        figure("missed per million"),
        figure("false per million"),
        figure("wrong object per million"),
        figure("t: 99 % within (ulp)"),
        figure("t: worst (ulp)"),
        figure("rays checked"),
    ];
    (!rows.is_empty()).then(|| table("errors-table", &columns, &[0, 1, 2], &rows))
}

/// Every cell of the record.
pub fn all_cells(record: &Record, styles: &Styles) -> String {
    let columns = [
        text("scene"),
        text("rays"),
        text("structure"),
        text("kernel"),
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
        text("remark"),
    ];
    let count = |n: f64| units::count(n as u64);
    let bytes = |n: f64| units::bytes(n as u64);
    let row = |cell: &Cell| {
        let timing = cell.ns_per_ray.filter(|_| cell.ns().is_some());
        let memory = cell.bytes.as_ref();
        let peak = memory.and_then(|b| b.peak_build);
        vec![
            Value::text(&cell.scene),
            Value::text(&cell.rays),
            Value::structure(&cell.structure, &styles.class(&cell.structure)),
            Value::text(cell.kernel.name()),
            Value::figure(Some(cell.threads as f64), count),
            Value::figure(timing.map(|t| t.median), units::time),
            Value::figure(timing.map(|t| t.mad), units::time),
            Value::figure(timing.map(|t| t.min), units::time),
            Value::figure(cell.build(), units::time),
            Value::figure(memory.map(|b| b.structure as f64), bytes),
            Value::figure(memory.map(|b| b.geometry_copy as f64), bytes),
            Value::figure(bytes_per_object(record, cell), trimmed),
            Value::figure(peak.map(|n| n as f64), bytes),
            Value::figure(Some(cell.ray_count as f64), count),
            Value::figure(Some(cell.hits as f64), count),
            Value::figure(cell.check.as_ref().map(|c| c.differences as f64), count),
            Value::text(cell.outcome.reason().unwrap_or(&cell.plan)),
        ]
    };
    let rows: Vec<Vec<Value>> = record.cells.iter().map(row).collect();
    table("cells", &columns, &[0, 1, 2, 4], &rows)
}

/// The structures with their colours and settings.
pub fn structures(record: &Record, styles: &Styles) -> String {
    let columns = [text("structure"), text("version"), text("settings"), text("what it is")];
    let rows: Vec<Vec<Value>> = record
        .structures
        .iter()
        .map(|s| {
            vec![
                Value::structure(&s.id, &styles.class(&s.id)),
                Value::text(&s.version),
                Value::text(&s.settings),
                Value::text(&s.description),
            ]
        })
        .collect();
    table("structures", &columns, &[], &rows)
}

/// Where and how it was measured, and how to do it again.
pub fn machine(record: &Record) -> String {
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
    let mut html = String::from("<dl>\n");
    for (name, value) in facts.iter().filter(|(_, value)| !value.trim().is_empty()) {
        let _ = writeln!(html, "<dt>{name}</dt><dd>{}</dd>", escape(value));
    }
    html + "</dl>\n"
}
