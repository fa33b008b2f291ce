//! The committed reproduction of the paper, held to the print. Times are not measured here: the
//! trends are those of the record in reports/paper.

use paper::{Paper, Table, page, plots};

fn folder() -> std::path::PathBuf {
    std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../reports/paper")
}

fn record() -> Paper {
    let text = std::fs::read_to_string(folder().join("paper.json")).expect("the committed record");
    serde_json::from_str(&text).expect("a record of `rayscale paper`")
}

/// Pairs of printed and our values, where the print has one.
fn pairs(table: &Table) -> (Vec<f64>, Vec<f64>) {
    let printed = table.printed.iter().flatten();
    printed.zip(table.ours.iter().flatten()).filter_map(|(p, o)| Some(((*p)?, *o))).unzip()
}

#[test]
fn speed_ratios_follow_the_trends_of_the_print() {
    let paper = record();
    for (key, cells) in [("2", 42), ("3", 42), ("4", 21), ("5", 21)] {
        let table = &paper.tables[key];
        assert_eq!(pairs(table).0.len(), cells, "table {key}");
        let [found, ..] = table.trends();
        assert!(found >= 0.9, "table {key}: rank correlation {found}");
    }
}

#[test]
fn candidates_are_those_of_the_print() {
    let paper = record();
    assert!(paper.effort.seeds >= 200);
    let (printed, ours) = pairs(&paper.tables["6"]);
    assert_eq!(printed.len(), 42);
    assert!(printed.iter().zip(ours).all(|(p, o)| (o / p - 1.0).abs() < 0.02));
    let inside: f64 =
        paper.tables["7"].variants["printed value inside the 99 % range"].iter().flatten().sum();
    assert!(inside >= 40.0);
}

#[test]
fn every_table_has_all_its_cells() {
    let paper = record();
    for (key, rows, cols) in [("1", 2, 5), ("2", 7, 6), ("5", 7, 6), ("7", 7, 6), ("secondary", 7, 6)] {
        let table = &paper.tables[key];
        for values in std::iter::once(&table.ours).chain(table.variants.values()) {
            assert_eq!(values.len(), rows, "table {key}");
            assert!(values.iter().all(|row| row.len() == cols && row.iter().all(|v| v.is_finite())));
        }
    }
}

#[test]
fn the_page_and_plots_are_those_of_the_record() {
    let paper = record();
    let read = |name: &str| std::fs::read_to_string(folder().join(name)).expect(name);
    assert_eq!(read("paper.md"), page::markdown(&paper));
    for (name, svg) in plots::all(&paper) {
        assert_eq!(read(name), svg, "{name}");
    }
    for slip in &paper.slips {
        assert!(read("paper.md").contains(&report::table::escape(&slip.arithmetic)), "{}", slip.place);
    }
    assert_eq!(paper.slips, paper::slips::all());
}
