//! Tables as CSV.

use super::Table;
use std::io::{self, Write};

impl Table {
    /// With a head, figures as they are and not as they are shown, and empty fields for what there is none of.
    ///
    /// Text that a spreadsheet would take for a formula gets an apostrophe in front
    /// (<https://owasp.org/www-community/attacks/CSV_Injection>).
    ///
    /// # Errors
    /// Errors of `out`.
    pub fn csv(&self, out: impl Write) -> io::Result<()> {
        let mut csv = csv::Writer::from_writer(out);
        csv.write_record(self.head.iter().map(|column| column.name.as_str()))?;
        for row in &self.rows {
            csv.write_record(row.iter().map(|value| match value.figure {
                Some(figure) => figure.to_string(),
                None => no_formula(value.plain()),
            }))?;
        }
        csv.flush()
    }
}

fn no_formula(text: String) -> String {
    if text.starts_with(['=', '+', '-', '@', '\t', '\r']) { format!("'{text}") } else { text }
}
