//! The one table: columns of text and of figures, as Markdown, HTML, CSV and plain text.

mod csv;
mod html;
mod markdown;
#[cfg(test)]
mod tests;
mod text;

pub use html::Interactive;
pub use markdown::{code, escape};
pub use text::{in_columns, printable};

/// A column's head.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Column {
    name: String,
    is_figure: bool,
}

impl From<&str> for Column {
    /// A column of text.
    fn from(name: &str) -> Self {
        Self { name: name.to_owned(), is_figure: false }
    }
}

/// A column of figures: they end together and go by size.
pub fn figure(name: impl Into<String>) -> Column {
    Column { name: name.into(), is_figure: true }
}

/// How a piece of a cell's text is set.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Style {
    Plain,
    Strong,
    Code,
}

/// What stands in a cell: text, or a figure with the form it is shown in.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Value {
    spans: Vec<(Style, String)>,
    figure: Option<f64>,
    swatch: Option<String>,
}

impl Value {
    /// Text.
    pub fn text(text: impl Into<String>) -> Self {
        Self { spans: vec![(Style::Plain, text.into())], ..Self::default() }
    }

    /// Text of a computer's language.
    pub fn code(text: impl Into<String>) -> Self {
        Self { spans: vec![(Style::Code, text.into())], ..Self::default() }
    }

    /// Text that stands out.
    pub fn strong(text: impl Into<String>) -> Self {
        Self::default().and_strong(text)
    }

    /// With text behind it that stands out.
    #[must_use]
    pub fn and_strong(mut self, text: impl Into<String>) -> Self {
        self.spans.push((Style::Strong, text.into()));
        self
    }

    /// A figure with the form it is shown in; an empty cell for `None`.
    pub fn figure(value: Option<f64>, show: impl FnOnce(f64) -> String) -> Self {
        value.map_or_else(Self::default, |v| Self { figure: Some(v), ..Self::text(show(v)) })
    }

    /// A number of things; an empty cell for `None`.
    pub fn count(value: impl Into<Option<u64>>) -> Self {
        Self::figure(value.into().map(|n| n as f64), |n| harness::units::count(n as u64))
    }

    /// With the mark of a structure, by its class, where there are colours.
    #[must_use]
    pub fn with_swatch(mut self, class: String) -> Self {
        self.swatch = Some(class);
        self
    }

    /// The text without its style.
    pub fn plain(&self) -> String {
        self.spans.iter().map(|(_, text)| text.as_str()).collect()
    }
}

impl<T: Into<String>> From<T> for Value {
    fn from(text: T) -> Self {
        Self::text(text)
    }
}

/// A table.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    head: Vec<Column>,
    rows: Vec<Vec<Value>>,
}

impl Table {
    /// With these columns.
    pub fn new(head: impl IntoIterator<Item = impl Into<Column>>) -> Self {
        Self { head: head.into_iter().map(Into::into).collect(), rows: Vec::new() }
    }

    /// With a column of text and then columns of figures.
    pub fn of_figures(first: &str, others: impl IntoIterator<Item = impl Into<String>>) -> Self {
        let others = others.into_iter().map(|name| figure(name));
        Self { head: [first.into()].into_iter().chain(others).collect(), rows: Vec::new() }
    }

    /// Adds a row. Cells that are missing at its end are empty, those beyond the head are left out.
    pub fn push(&mut self, row: impl IntoIterator<Item = impl Into<Value>>) {
        let mut row: Vec<Value> = row.into_iter().map(Into::into).collect();
        row.resize(self.head.len(), Value::default());
        self.rows.push(row);
    }

    /// Number of rows.
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// What an empty cell of a column shows where there is nothing else to tell it.
    const fn nothing(column: &Column) -> &'static str {
        if column.is_figure { "–" } else { "" }
    }
}
