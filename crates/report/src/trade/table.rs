//! The trade as tables.

use crate::table::{Table, Value, figure};
use harness::units;
use judge::{Counts, Kind};
use trade::curve::Precise;
use trade::extremes::Extreme;
use trade::leaving::Leaving;
use trade::{Judged, TradeRow};

/// Time, memory and errors on ordinary rays; rows on the front have a star.
pub fn ordinary(rows: &[TradeRow]) -> Table {
    judged(rows, |row| row.ordinary.as_ref())
}

/// The same with errors on rays that hunt for them.
pub fn hunting(rows: &[TradeRow]) -> Table {
    judged(rows, |row| row.hunting.as_ref())
}

fn number(value: Option<f64>) -> Value {
    Value::figure(value, units::figure)
}

/// An empty table: columns of text, then columns of figures.
fn table(texts: &[&str], figures: &[&str]) -> Table {
    Table::new(texts.iter().map(|text| (*text).into()).chain(figures.iter().map(|name| figure(*name))))
}

fn judged(rows: &[TradeRow], errors: impl Fn(&TradeRow) -> Option<&Judged>) -> Table {
    let mut table = table(
        &["scene", "structure"],
        &[
            "ns/ray",
            "MB",
            "rays",
            "holes/M",
            "phantoms/M",
            "displaced/M",
            "visible/M, 95 %",
            "swapped/M",
            "ties/M",
            "off by, 99 %",
            "largest",
            "t ulps, 99 %",
        ],
    );
    for row in rows {
        let star = if row.front { " *" } else { "" };
        let mut cells = vec![Value::text(&row.scene), Value::text(format!("{}{star}", row.structure))];
        cells.extend([number(row.ns_per_ray), number(row.bytes.map(|b| b as f64 / 1e6))]);
        match errors(row) {
            Some(judged) => cells.extend(of_kinds(judged)),
            None => cells.extend(of_old(row)),
        }
        table.push(cells);
    }
    table
}

fn of_kinds(judged: &Judged) -> Vec<Value> {
    let counts = &judged.counts;
    let million = |kind| number(Some(counts.per_million(counts.of(kind))));
    let bounds = judged.bounds.visible;
    let range = format!("{}–{}", units::figure(bounds.low * 1e6), units::figure(bounds.high * 1e6));
    let mut cells = vec![Value::text(units::count(counts.rays))];
    cells.extend(Kind::VISIBLE.map(million));
    cells.push(Value::text(range));
    cells.extend([Kind::Swapped, Kind::Tie].map(million));
    let space = [judged.errors.along.p99, judged.errors.along.largest, judged.errors.t_ulps.p99];
    cells.extend(space.map(|value| number(Some(value))));
    cells
}

/// A record of old tells no more than what is missed, invented, or of another object wherever it lies.
fn of_old(row: &TradeRow) -> Vec<Value> {
    let Some(old) = &row.accuracy else { return (0..10).map(|_| Value::text("failed")).collect() };
    let million = |n: u64| number(Some(n as f64 * 1e6 / old.rays.max(1) as f64));
    let mut cells = vec![Value::text(units::count(old.rays)), million(old.missed), million(old.false_hits)];
    cells.extend([Value::text("–"), Value::text("–"), million(old.wrong_object)]);
    cells.extend((0..4).map(|_| Value::text("–")));
    cells
}

/// Precisions with bytes, time and errors.
pub fn curve(rows: &[Precise]) -> Table {
    let mut table = table(
        &["scene", "structure", "corners"],
        &["B/triangle", "ns/ray", "holes/M", "phantoms/M", "displaced/M", "swapped/M", "off by, 99 %"],
    );
    for row in rows {
        let star = if row.front { " *" } else { "" };
        let counts = &row.errors.counts;
        let ns = row.ns_per_ray.map_or("–".to_owned(), units::figure);
        let mut cells = vec![
            Value::text(&row.scene),
            Value::text(&row.structure),
            Value::text(format!("{}{star}", row.precision)),
            number(Some(row.bytes_per_triangle)),
            Value::text(if row.packed { ns } else { format!("({ns})") }),
        ];
        let kinds = [Kind::Hole, Kind::Phantom, Kind::Displaced, Kind::Swapped];
        cells.extend(kinds.map(|kind| number(Some(counts.per_million(counts.of(kind))))));
        cells.push(number(Some(row.errors.errors.along.p99)));
        table.push(cells);
    }
    table
}

/// Extremes by structure: holes and phantoms.
pub fn extremes(rows: &[Extreme]) -> Table {
    let structures = rows.first().map_or(&[][..], |row| &row.answers);
    let head = ["extreme: holes / phantoms".into(), figure("rays")];
    let mut table =
        Table::new(head.into_iter().chain(structures.iter().map(|answer| figure(&answer.structure))));
    for row in rows {
        let cell = |answer: &trade::extremes::Answer| match &answer.found {
            Ok(Counts { holes, phantoms, .. }) => Value::text(format!("{holes} / {phantoms}")),
            Err(_) => Value::text("refused"),
        };
        let head = [Value::text(&row.name), Value::text(units::count(row.rays))];
        table.push(head.into_iter().chain(row.answers.iter().map(cell)));
    }
    table
}

/// Rays that leave surfaces.
pub fn leaving(rows: &[Leaving]) -> Table {
    let mut table = table(
        &["scene", "kernel", "offset"],
        &[
            "rays",
            "hit their own/M",
            "95 %",
            "at a distance of, median",
            "largest",
            "begin beyond another/M",
            "begin at, median",
        ],
    );
    for row in rows {
        let million = |n: u64| number(Some(n as f64 * 1e6 / row.rays.max(1) as f64));
        let bounds = row.own_bounds;
        table.push([
            Value::text(&row.scene),
            Value::text(&row.kernel),
            Value::text(row.offset.words()),
            Value::text(units::count(row.rays)),
            million(row.own),
            Value::text(format!("{}–{}", units::figure(bounds.low * 1e6), units::figure(bounds.high * 1e6))),
            number(Some(row.own_distance.median)),
            number(Some(row.own_distance.largest)),
            million(row.through),
            number(Some(row.start.median)),
        ]);
    }
    table
}
