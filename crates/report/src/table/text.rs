//! Tables as plain text.

use super::Table;
use std::borrow::Cow;
use unicode_width::UnicodeWidthStr;

/// No cell is shown wider than this: one long name would push all else out of sight.
const WIDEST: usize = 100;

impl Table {
    /// In columns, two blanks apart; texts longer than 100 letters are cut in all columns but the last.
    pub fn text(&self) -> String {
        let head = self.head.iter().map(|column| column.name.clone()).collect();
        let rows = self.rows.iter().map(|row| {
            let cells = row.iter().zip(&self.head).map(|(value, column)| match value.plain() {
                text if text.is_empty() => Self::nothing(column).to_owned(),
                text => text,
            });
            cells.collect()
        });
        let lines: Vec<Vec<String>> = std::iter::once(head).chain(rows).collect();
        let figures: Vec<bool> = self.head.iter().map(|column| column.is_figure).collect();
        in_columns(&lines, &figures)
    }
}

/// Lines in columns, two blanks apart, those of figures to the right. Cells are cut at 100 letters, but for text in the
/// last column, which pushes nothing away.
pub fn in_columns(lines: &[Vec<String>], figures: &[bool]) -> String {
    let whole = |column: usize| column + 1 == figures.len() && !figures[column];
    let one_line = |text: &str| printable(text).replace(['\n', '\t'], " ");
    let cell = |(column, text): (usize, &String)| match one_line(text) {
        text if whole(column) => text,
        text => short(text),
    };
    let lines: Vec<Vec<String>> =
        lines.iter().map(|line| line.iter().enumerate().map(cell).collect()).collect();
    let width = |column: usize| lines.iter().filter_map(|line| Some(line.get(column)?.width())).max();
    let widths: Vec<usize> = (0..figures.len()).map(|column| width(column).unwrap_or(0)).collect();
    let line = |cells: &Vec<String>| {
        let mut out = String::new();
        for ((i, cell), (width, is_figure)) in cells.iter().enumerate().zip(widths.iter().zip(figures)) {
            let pad = " ".repeat(width.saturating_sub(cell.width()));
            let gap = if i == 0 { "" } else { "  " };
            out.extend(if *is_figure { [gap, &pad, cell] } else { [gap, cell, &pad] });
        }
        out.trim_end().to_owned()
    };
    lines.iter().map(line).collect::<Vec<_>>().join("\n")
}

/// No longer than [`WIDEST`].
fn short(text: String) -> String {
    match text.char_indices().nth(WIDEST) {
        None => text,
        Some(_) => text.chars().take(WIDEST - 1).chain(['…']).collect(),
    }
}

/// The text with what a terminal takes for commands made visible: control characters but line ends and tabs, and those that
/// turn the direction of writing, as `\u001b`.
pub fn printable(text: &str) -> Cow<'_, str> {
    let commands = |c: char| {
        (c.is_control() && c != '\n' && c != '\t')
            || matches!(c, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
    };
    if !text.contains(commands) {
        return Cow::Borrowed(text);
    }
    let shown =
        text.chars().map(|c| if commands(c) { format!("\\u{:04x}", c as u32) } else { c.to_string() });
    Cow::Owned(shown.collect())
}
