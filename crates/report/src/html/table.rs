//! Tables that sort and filter.

use super::svg::escape;
use std::fmt::Write;

/// A column's head.
#[derive(Clone, Copy, Debug)]
pub struct Column {
    /// What it is called.
    pub name: &'static str,
    /// Whether its figures go by size instead of by the alphabet.
    pub is_figure: bool,
}

/// A text column.
pub const fn text(name: &'static str) -> Column {
    Column { name, is_figure: false }
}

/// A column of figures.
pub const fn figure(name: &'static str) -> Column {
    Column { name, is_figure: true }
}

/// What stands in a cell.
#[derive(Clone, Debug)]
pub struct Value {
    html: String,
    sort: Option<f64>,
}

impl Value {
    /// Text.
    pub fn text(text: &str) -> Self {
        Self { html: escape(text), sort: None }
    }

    /// A figure with the form it is shown in; nothing for `None`.
    pub fn figure(value: Option<f64>, show: impl FnOnce(f64) -> String) -> Self {
        Self { html: value.map_or_else(String::new, |v| escape(&show(v))), sort: value }
    }

    /// A name with its mark.
    pub fn structure(name: &str, class: &str) -> Self {
        Self { html: format!("<i class=\"swatch {class}\"></i>{}", escape(name)), sort: None }
    }
}

/// Tables with more rows than this stay off the paper; `page.js` has the same number for what filters leave.
const ON_PAPER: usize = 60;

/// A table with filters for the columns of `choices` and a search field.
pub fn table(id: &str, columns: &[Column], choices: &[usize], rows: &[Vec<Value>]) -> String {
    let mut html = String::new();
    // Writing to a string does not fail.
    let _ = write!(
        html,
        "<div class=\"filters\" data-for=\"{id}\"><label>Search <input type=\"search\"></label>"
    );
    for column in choices {
        let name = escape(columns[*column].name);
        let _ = write!(
            html,
            "<label>{name} <select data-column=\"{column}\"><option value=\"\">all</option></select></label>"
        );
    }
    let _ = writeln!(html, "<output aria-live=\"polite\">{} rows</output></div>", rows.len());
    let long = if rows.len() > ON_PAPER { " long" } else { "" };
    let _ = write!(html, "<div class=\"scroll{long}\" tabindex=\"0\"><table id=\"{id}\"><thead><tr>");
    for Column { name, is_figure } in columns {
        let class = if *is_figure { " class=\"n\"" } else { "" };
        let _ =
            write!(html, "<th scope=\"col\"{class}><button type=\"button\">{}</button></th>", escape(name));
    }
    html.push_str("</tr></thead><tbody>\n");
    for row in rows {
        html.push_str("<tr>");
        for (value, column) in row.iter().zip(columns) {
            let class = if column.is_figure { " class=\"n\"" } else { "" };
            let sort = value.sort.map_or_else(String::new, |v| format!(" data-v=\"{v}\""));
            let _ = write!(html, "<td{class}{sort}>{}</td>", value.html);
        }
        html.push_str("</tr>\n");
    }
    let _ = writeln!(
        html,
        "</tbody></table></div>\n<p class=\"note paper\">{} rows: they are in the page itself and in cells.csv. Filter \
         them to {ON_PAPER} or fewer to have them printed.</p>",
        rows.len()
    );
    html
}
