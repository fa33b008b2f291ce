//! A report as one HTML file that needs nothing else: made from a record alone, it opens from
//! disk, sends no request, and reads in light and dark, on a phone and on paper.

mod sections;
mod summary;
#[cfg(test)]
mod tests;

use crate::aggregate;
use crate::chart::{RULES, Styles};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use harness::record::Record;
use maud::{DOCTYPE, Markup, PreEscaped, Render, html as markup};
use std::collections::BTreeMap;
use time::OffsetDateTime;

/// A picture of a scene.
#[derive(Clone, Debug)]
pub struct Picture {
    /// PNG.
    pub png: Vec<u8>,
    /// What it shows.
    pub caption: String,
}

impl Render for Picture {
    fn render(&self) -> Markup {
        let source = format!("data:image/png;base64,{}", STANDARD.encode(&self.png));
        markup! {
            figure {
                img.picture alt=(self.caption) src=(source);
                figcaption { (self.caption) }
            }
        }
    }
}

/// Pictures of a report.
#[derive(Clone, Debug, Default)]
pub struct Pictures {
    /// By scene.
    pub scenes: BTreeMap<String, Vec<Picture>>,
    /// The places where structures are most wrong, enlarged.
    pub worst: Vec<Picture>,
}

impl Pictures {
    /// None.
    pub fn new() -> Self {
        Self::default()
    }
}

impl<const N: usize> From<[(String, Vec<Picture>); N]> for Pictures {
    fn from(scenes: [(String, Vec<Picture>); N]) -> Self {
        Self { scenes: scenes.into(), worst: Vec::new() }
    }
}

/// No request can leave the page, whatever it holds.
const POLICY: &str =
    "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src data:";

/// A part of the page.
struct Section {
    id: &'static str,
    title: &'static str,
    body: Markup,
}

/// The report of a record, with pictures of its scenes if there are any.
pub fn html(record: &Record, pictures: &Pictures) -> String {
    let threads = aggregate::threads(record);
    let overall = aggregate::overall(record, threads);
    let kinds = aggregate::by_kind(record, threads);
    let styles =
        Styles::new(record.cells.iter().map(|cell| cell.structure.as_str()).chain(record.structure_ids()));
    let section = |id, title, body| Some(Section { id, title, body });
    let sections = [
        section("summary", "Summary", summary::summary(record, &overall, threads)),
        section(
            "speed",
            "Time relative to the fastest",
            markup! {
                p.note {
                    "Geometric mean over the scenes that all structures of a column share; 1× is the fastest. "
                    @if threads == 1 { "One thread." } @else { (threads) " threads." }
                }
                (sections::ranking(&overall, &styles))
            },
        ),
        section(
            "memory",
            "Memory against speed",
            markup! {
                p.note {
                    "Down and left is better. Filled points along the dashed line are the Pareto front: nothing measured \
                     of these is both smaller and faster. Memory is the structure and its copy of the geometry."
                }
                @if let Some(charts) = sections::memory_and_speed(kinds.iter().chain(&overall), &styles) { (charts) }
            },
        ),
        section("scenes", "Scene by scene", scenes(record, pictures, &styles)),
        sections::memory_ratios(record).and_then(|charts| {
            section(
                "ratio",
                "Grid against bit maps",
                markup! {
                    p.note {
                        "ν_mem: bytes of the uniform grid over bytes of the bit maps at the same N (Skala 1993, §5). Above \
                         the dotted line the bit maps are smaller."
                    }
                    (charts)
                },
            )
        }),
        sections::errors(record, &styles).and_then(|table| {
            section(
                "errors",
                "Errors beside speed",
                markup! {
                    p.note {
                        "Structures with a ray-triangle test of their own, judged by exact arithmetic, per million rays \
                         checked. Down and left is better. The suite's own structures answer as brute force with the same \
                         test does; " code { "rayscale trade" } " compares those tests."
                    }
                    @if let Some(charts) = sections::errors_and_speed(&overall, &styles) { (charts) }
                    (table)
                },
            )
        }),
        worst(pictures),
        section("all", "Everything measured", sections::all_cells(record, &styles)),
        section("structures-section", "Structures", sections::structures(record, &styles)),
        section("machine", "Machine, settings, and how to reproduce", sections::machine(record)),
    ];
    page(record, &styles, &sections.into_iter().flatten().collect::<Vec<_>>()).into_string()
}

/// Where images are wrong, enlarged.
fn worst(pictures: &Pictures) -> Option<Section> {
    let body = || {
        markup! {
            p.note {
                "Images judged by exact arithmetic. Each row: as the structure sees it, as it is, and what is wrong, vermilion for \
                 holes, blue for phantoms, sky blue for hits that are displaced, orange for another object in the same place, \
                 which nobody sees."
            }
            @for picture in &pictures.worst { (picture) }
        }
    };
    let section = || Section { id: "worst", title: "Where images are wrong", body: body() };
    (!pictures.worst.is_empty()).then(section)
}

fn scenes(record: &Record, pictures: &Pictures, styles: &Styles) -> Markup {
    let of = |scene: &str| pictures.scenes.get(scene).map_or(&[][..], Vec::as_slice);
    markup! {
        p.note {
            "Bars show medians; the line on a bar goes from the least to the greatest sample; torn bars are longer than \
             there is room for. Build against trace counts one build and so many rays; rings mark where another structure \
             takes the lead."
        }
        @for (i, scene) in record.scenes.iter().enumerate() {
            (sections::scene(record, scene, of(&scene.id), styles, i == 0))
        }
    }
}

fn page(record: &Record, styles: &Styles, sections: &[Section]) -> Markup {
    let made = day(record.started_unix);
    let css = [include_str!("page.css"), RULES, &styles.css()].concat();
    let short = |title: &'static str| title.split(',').next().unwrap_or(title);
    markup! {
        (DOCTYPE) "\n"
        html lang="en" {
            head {
                meta charset="utf-8";
                meta http-equiv="Content-Security-Policy" content=(POLICY);
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { "rayscale report, " (made) }
                style { (PreEscaped(css)) }
            }
            "\n"
            body {
                header {
                    h1 { "Acceleration structures compared" }
                    p.soft {
                        (made) " · " (record.machine.cpu) " · " (record.scenes.len()) " scenes, "
                        (record.structures.len()) " structures, " (record.cells.len()) " cells"
                    }
                }
                nav aria-label="Sections" {
                    ul { @for Section { id, title, .. } in sections { li { a href={ "#" (id) } { (short(title)) } } } }
                }
                main { @for Section { id, title, body } in sections {
                    "\n" section id=(id) { h2 { (title) } "\n" (body) }
                } }
                footer { p.soft { "rayscale " (record.suite.version) } }
                div #tooltip role="status" hidden {}
                script { (PreEscaped(include_str!("page.js"))) }
            }
        }
        "\n"
    }
}

/// The day of a moment in seconds since 1970, as `2024-02-29` (UTC).
fn day(unix: u64) -> String {
    let moment = i64::try_from(unix).ok().and_then(|unix| OffsetDateTime::from_unix_timestamp(unix).ok());
    moment.map_or_else(|| "on an unknown day".to_owned(), |moment| moment.date().to_string())
}
