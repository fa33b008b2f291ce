//! A report as one HTML file that needs nothing else: made from a record alone, it opens from
//! disk, sends no request, and reads in light and dark, on a phone and on paper.

mod aggregate;
mod charts;
mod labels;
mod scale;
mod sections;
mod style;
mod summary;
mod svg;
mod table;
#[cfg(test)]
mod tests;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use harness::record::Record;
use std::collections::BTreeMap;
use std::fmt::Write;
use style::Styles;
pub(crate) use svg::escape;

/// A picture of a scene.
#[derive(Clone, Debug)]
pub struct Picture {
    /// PNG.
    pub png: Vec<u8>,
    /// What it shows.
    pub caption: String,
}

impl Picture {
    fn html(&self) -> String {
        let (data, caption) = (STANDARD.encode(&self.png), escape(&self.caption));
        format!(
            "<figure><img class=\"picture\" alt=\"{caption}\" src=\"data:image/png;base64,{data}\">\
             <figcaption>{caption}</figcaption></figure>"
        )
    }
}

/// Pictures by scene.
pub type Pictures = BTreeMap<String, Vec<Picture>>;

/// No request can leave the page, whatever it holds.
const POLICY: &str =
    "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src data:";

/// The report of a record, with pictures of its scenes if there are any.
pub fn html(record: &Record, pictures: &Pictures) -> String {
    let threads = aggregate::threads(record);
    let overall = aggregate::overall(record, threads);
    let styles =
        Styles::new(record.cells.iter().map(|cell| cell.structure.as_str()).chain(record.structure_ids()));
    let mut page = Page::default();
    page.section(
        "summary",
        "Summary",
        &format!("<ul class=\"summary\">{}</ul>", summary::summary(record, &overall, threads)),
    );
    page.section(
        "speed",
        "Time relative to the fastest",
        &format!(
            "<p class=\"note\">Geometric mean over the scenes that all structures of a column share; 1× is the \
             fastest. {}</p>{}",
            threads_in_words(threads),
            sections::ranking(&overall, &styles)
        ),
    );
    page.section(
        "memory",
        "Memory against speed",
        &format!(
            "<p class=\"note\">Down and left is better. The dashed line is the Pareto front: nothing measured of these is \
             both smaller and faster. Memory is the structure and its copy of the geometry.</p>{}",
            sections::memory_and_speed(&overall, &styles)
        ),
    );
    let mut scenes = String::from(
        "<p class=\"note\">Bars show medians; the line on a bar goes from the least to the greatest sample; torn bars \
         are longer than there is room for. Build against trace counts one build and so many rays; rings mark where \
         another structure takes the lead.</p>",
    );
    let nothing = Vec::new();
    for (i, scene) in record.scenes.iter().enumerate() {
        let pictures = pictures.get(&scene.id).unwrap_or(&nothing);
        scenes += &sections::scene(record, &scene.id, pictures, &styles, i == 0);
    }
    page.section("scenes", "Scene by scene", &scenes);
    if let Some(charts) = sections::memory_ratios(record) {
        let note = "<p class=\"note\">ν_mem: bytes of the uniform grid over bytes of the bit maps at the same N (Skala \
                    1993, §5). Above the dotted line the bit maps are smaller.</p>";
        page.section("ratio", "Grid against bit maps", &format!("{note}{charts}"));
    }
    if let Some(table) = sections::errors(record, &styles) {
        let note = "<p class=\"note\">Structures with a ray-triangle test of their own, judged by exact arithmetic, \
                    per million rays checked. Down and left is better. The suite's own structures answer as brute \
                    force with the same test does; <code>rayscale trade</code> compares those tests.</p>";
        let charts = sections::errors_and_speed(&overall, &styles);
        page.section("errors", "Errors beside speed", &format!("{note}{charts}{table}"));
    }
    page.section("all", "Everything measured", &sections::all_cells(record, &styles));
    page.section("structures-section", "Structures", &sections::structures(record, &styles));
    page.section(
        "machine",
        "Machine, settings, and how to reproduce",
        &format!(
            "{}<p>Made by</p><pre>{}</pre><p>Then, for this page:</p><pre>rayscale report record.json</pre>",
            sections::machine(record),
            escape(&record.command)
        ),
    );
    page.finish(record, &styles)
}

fn threads_in_words(threads: usize) -> String {
    if threads == 1 { "One thread.".to_owned() } else { format!("{threads} threads.") }
}

/// The page under way.
#[derive(Default)]
struct Page {
    navigation: String,
    body: String,
}

impl Page {
    fn section(&mut self, id: &str, title: &str, html: &str) {
        // Writing to a string does not fail.
        let short = title.split(',').next().unwrap_or(title);
        let _ = writeln!(self.navigation, "<li><a href=\"#{id}\">{}</a></li>", escape(short));
        let _ = writeln!(self.body, "<section id=\"{id}\"><h2>{}</h2>\n{html}</section>", escape(title));
    }

    fn finish(self, record: &Record, styles: &Styles) -> String {
        let Self { navigation, body } = self;
        let (css, colours, js) = (include_str!("page.css"), styles.css(), include_str!("page.js"));
        let made = date(record.started_unix);
        let cpu = escape(&record.machine.cpu);
        let (cells, scenes) = (record.cells.len(), record.scenes.len());
        format!(
            "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n\
             <meta http-equiv=\"Content-Security-Policy\" content=\"{POLICY}\">\n\
             <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
             <title>rayscale report, {made}</title>\n<style>{css}{colours}</style></head>\n<body>\n\
             <header><h1>Acceleration structures compared</h1>\n<p class=\"soft\">{made} · {cpu} · {scenes} scenes, \
             {structures} structures, {cells} cells</p></header>\n<nav aria-label=\"Sections\"><ul>{navigation}</ul></nav>\n\
             <main>\n{body}</main>\n<footer><p class=\"soft\">rayscale {version}</p></footer>\n\
             <div id=\"tooltip\" role=\"status\" hidden></div>\n<script>{js}</script>\n</body></html>\n",
            structures = record.structures.len(),
            version = escape(&record.suite.version),
        )
    }
}

/// The day of a moment in seconds since 1970, as `2024-02-29` (UTC), by days from the civil
/// calendar (H. Hinnant, <https://howardhinnant.github.io/date_algorithms.html>).
fn date(unix: u64) -> String {
    let days = unix / 86_400 + 719_468;
    let era = days / 146_097;
    let day = days % 146_097;
    let year = (day - day / 1460 + day / 36_524 - day / 146_096) / 365;
    let of_year = day - (365 * year + year / 4 - year / 100);
    let month = (5 * of_year + 2) / 153;
    let of_month = of_year - (153 * month + 2) / 5 + 1;
    let (month, next) = if month < 10 { (month + 3, 0) } else { (month - 9, 1) };
    format!("{:04}-{month:02}-{of_month:02}", year + era * 400 + next)
}
