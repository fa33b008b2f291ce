//! Tables: scenes and ray sets down, structures across.

use harness::grouped::Measure;
use harness::record::{Cell, Key, Outcome};
use harness::units;
use std::collections::BTreeMap;
use std::fmt::Write;

/// A table of text.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Table {
    /// Names of the columns.
    pub head: Vec<String>,
    /// Rows, as wide as the head.
    pub rows: Vec<Vec<String>>,
}

impl Table {
    /// With these columns.
    pub fn new(head: impl IntoIterator<Item = impl Into<String>>) -> Self {
        Self { head: head.into_iter().map(Into::into).collect(), rows: Vec::new() }
    }

    /// As Markdown, figures to the right.
    pub fn markdown(&self) -> String {
        let line = |cells: &[String]| {
            let cells: Vec<_> = cells.iter().map(|c| c.replace('|', "\\|")).collect();
            format!("| {} |\n", cells.join(" | "))
        };
        let rule: Vec<_> =
            (0..self.head.len()).map(|i| if i == 0 { "---" } else { "---:" }.to_owned()).collect();
        let mut out = line(&self.head) + &line(&rule);
        self.rows.iter().for_each(|row| out.push_str(&line(row)));
        out
    }

    /// As plain text in columns.
    pub fn text(&self) -> String {
        let width = |i: usize| {
            let column = self.rows.iter().chain([&self.head]).map(|row| row[i].chars().count());
            column.max().unwrap_or(0)
        };
        let widths: Vec<usize> = (0..self.head.len()).map(width).collect();
        let line = |row: &Vec<String>| {
            let mut out = String::new();
            for (i, (cell, width)) in row.iter().zip(&widths).enumerate() {
                let pad = width - cell.chars().count();
                let (left, right) = if i == 0 { (0, pad) } else { (pad + 2, 0) };
                let _ = write!(out, "{:left$}{cell}{:right$}", "", "");
            }
            out.trim_end().to_owned()
        };
        [&self.head].into_iter().chain(&self.rows).map(line).collect::<Vec<_>>().join("\n")
    }
}

/// A figure of every structure for every scene and ray set. What failed says `failed`, what is
/// not there `–`.
pub fn figures(cells: &[Cell], measure: Measure) -> Table {
    let mut structures: Vec<&str> = Vec::new();
    let mut keys: Vec<Key> = Vec::new();
    let mut table: BTreeMap<(Key, &str), String> = BTreeMap::new();
    for cell in cells {
        if !structures.contains(&cell.structure.as_str()) {
            structures.push(&cell.structure);
        }
        if !keys.contains(&cell.key()) {
            keys.push(cell.key());
        }
        table.insert((cell.key(), &cell.structure), entry(cell, measure));
    }
    let threads = keys.iter().any(|key| key.threads != keys[0].threads);
    let mut out = Table::new(["scene, rays"].into_iter().chain(structures.iter().copied()));
    for key in keys {
        let mut name = format!("{} {}", key.scene, key.rays);
        if threads {
            let _ = write!(name, " ×{}", key.threads);
        }
        let figure = |s: &&str| table.get(&(key.clone(), *s)).cloned().unwrap_or_else(|| "–".to_owned());
        out.rows.push(std::iter::once(name).chain(structures.iter().map(figure)).collect());
    }
    out
}

fn entry(cell: &Cell, measure: Measure) -> String {
    match (&cell.outcome, measure.of(cell)) {
        (Outcome::Failed(_), _) => "failed".to_owned(),
        (Outcome::Unsupported(_) | Outcome::Skipped(_), _) | (Outcome::Measured, None) => "–".to_owned(),
        (Outcome::Measured, Some(value)) => match measure {
            Measure::Trace => units::time(value).replace(" ns", ""),
            Measure::Build => units::time(value),
            Measure::Structure | Measure::Bytes => units::bytes(value as u64),
        },
    }
}
