//! Tables as Markdown, and text that is safe in it.

use super::{Style, Table, Value, text::printable};

impl Table {
    /// With figures to the right. What cells hold stays text.
    pub fn markdown(&self) -> String {
        let line = |cells: Vec<String>| format!("| {} |\n", cells.join(" | "));
        let head = line(self.head.iter().map(|column| escape(&column.name)).collect());
        let rule = |is_figure| if is_figure { "---:" } else { "---" }.to_owned();
        let rule = line(self.head.iter().map(|column| rule(column.is_figure)).collect());
        let rows = self.rows.iter().map(|row| {
            let cells = row.iter().zip(&self.head).map(|(value, column)| match markdown(value) {
                text if text.is_empty() => Self::nothing(column).to_owned(),
                text => text,
            });
            line(cells.collect())
        });
        [head, rule].into_iter().chain(rows).collect()
    }
}

fn markdown(value: &Value) -> String {
    let spans = value.spans.iter().filter(|(_, text)| !text.is_empty()).map(|(style, text)| match style {
        Style::Plain => escape(text),
        Style::Strong => format!("**{}**", escape(text)),
        // A cell ends at a bar even within code.
        Style::Code => code(text).replace('|', "\\|"),
    });
    spans.collect()
}

/// Text that Markdown shows as it is, on one line, HTML and markers in comments included.
pub fn escape(text: &str) -> String {
    let text = printable(text);
    let mut out = String::with_capacity(text.len());
    let mut before = ' ';
    let mut letters = text.chars().peekable();
    while let Some(c) = letters.next() {
        let after = letters.peek().copied().unwrap_or(' ');
        match c {
            '\n' | '\t' => out.push(' '),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '&' => out.push_str("&amp;"),
            // Within a word it is none of Markdown's.
            '_' if before.is_alphanumeric() && after.is_alphanumeric() => out.push(c),
            '~' if before != '~' && after != '~' => out.push(c),
            '\\' | '`' | '*' | '_' | '[' | ']' | '|' | '~' | '$' => out.extend(['\\', c]),
            c => out.push(c),
        }
        before = c;
    }
    out
}

/// Text as code, between as many backticks as it needs.
pub fn code(text: &str) -> String {
    let text = printable(text).replace(['\n', '\t'], " ");
    let longest = text.split(|c| c != '`').map(str::len).max().unwrap_or(0);
    let fence = "`".repeat(longest + 1);
    let pad = if text.starts_with('`') || text.ends_with('`') || text.is_empty() { " " } else { "" };
    format!("{fence}{pad}{text}{pad}{fence}")
}
