//! Tables as HTML.

use super::{Column, Style, Table, Value};
use maud::{Markup, Render, html};

/// Tables with more rows than this stay off the paper; `page.js` has the same number for what filters leave.
const ON_PAPER: usize = 60;

/// What readers may do with a table.
#[derive(Clone, Copy, Debug)]
pub struct Interactive<'a> {
    /// The table's id on the page.
    pub id: &'a str,
    /// Columns that rows may be chosen by.
    pub choices: &'a [usize],
}

impl Table {
    /// As it is; `emphasise` tells which cells, by column and value, stand out.
    pub fn html(&self, emphasise: impl Fn(f64) -> bool) -> Markup {
        html! {
            div.scroll tabindex="0" {
                table {
                    thead { tr { @for column in &self.head { th scope="col" .n[column.is_figure] { (column.name) } } } }
                    tbody { @for row in &self.rows { (self.row(row, &emphasise)) "\n" } }
                }
            }
        }
    }

    /// With heads that sort, a search field, and filters for some columns.
    pub fn interactive(&self, Interactive { id, choices }: Interactive) -> Markup {
        let rows = self.rows.len();
        html! {
            div.filters data-for=(id) {
                label { "Search " input type="search"; }
                @for column in choices {
                    label { (self.head[*column].name) " " select data-column=(column) { option value="" { "all" } } }
                }
                output aria-live="polite" { (rows) " rows" }
            }
            div.scroll.long[rows > ON_PAPER] tabindex="0" {
                table id=(id) {
                    thead { tr { @for column in &self.head {
                        th scope="col" .n[column.is_figure] { button type="button" { (column.name) } }
                    } } }
                    tbody { @for row in &self.rows { (self.row(row, &|_| false)) "\n" } }
                }
            }
            p.note.paper {
                (rows) " rows: they are in the page itself and in cells.csv. Filter them to " (ON_PAPER)
                " or fewer to have them printed."
            }
        }
    }

    fn row(&self, row: &[Value], emphasise: &impl Fn(f64) -> bool) -> Markup {
        let best = |value: &Value| value.figure.is_some_and(emphasise);
        html! {
            tr { @for (value, Column { is_figure, .. }) in row.iter().zip(&self.head) {
                td .n[*is_figure] .best[best(value)] data-v=[value.figure] { (value) }
            } }
        }
    }
}

impl Render for Value {
    fn render(&self) -> Markup {
        html! {
            @if let Some(class) = &self.swatch { i class={ "swatch " (class) } {} }
            @for (style, text) in &self.spans { @match style {
                Style::Plain => (text),
                Style::Strong => strong { (text) },
                Style::Code => code { (text) },
            } }
        }
    }
}
