//! What a record of the trade says, in sentences and one table, made from its figures alone.

use crate::table::{Table, Value, figure};
use harness::record::Intersector;
use harness::stats::geometric_mean;
use harness::units::{self, times};
use judge::{Counts, Kind};
use primitives::KernelId;
use trade::curve::Precise;
use trade::{Judged, Trade, TradeRow};

/// Sentences, the most important first, and the figures that they are read off.
pub struct Conclusions {
    /// Three lines that stand for all.
    pub summary: Vec<String>,
    /// All sentences.
    pub sentences: Vec<String>,
    /// Every kernel beside the default one in the same structure.
    pub kernels: Table,
}

/// The kernel that others are compared with: the default one.
const PLAIN: KernelId = KernelId::MollerTrumbore;

/// Visible errors in a million that a picture of a million pixels hardly shows, and that it shows.
const LEVELS: [f64; 3] = [10.0, 100.0, 1000.0];

/// What a kernel costs in a structure, over scenes.
struct Cost {
    time: f64,
    most: (f64, String),
    bytes: Option<f64>,
    scenes: usize,
}

/// The conclusions of a record; none of a record of old, which mixes ordinary rays with others.
pub fn conclusions(trade: &Trade) -> Option<Conclusions> {
    let rows: Vec<&TradeRow> = trade.rows.iter().filter(|row| row.ordinary.is_some()).collect();
    if rows.is_empty() {
        return None;
    }
    let structures: Vec<&str> = ["bmssm", "ssm"]
        .into_iter()
        .filter(|id| rows.iter().any(|row| row.structure.split(':').next() == Some(*id)))
        .collect();
    let mut all =
        Conclusions { summary: Vec::new(), sentences: Vec::new(), kernels: table(trade, &rows, &structures) };
    let exact = sums(&rows, |row| row.is_exact());
    let plain = sums(&rows, |row| row.kernel == Intersector::BuiltIn(PLAIN));
    let cost = |kernel| -> Vec<String> {
        let words =
            |id: &&str| cost(&rows, id, kernel, |_| true).map(|cost| format!("{} in {id}", words(&cost)));
        structures.iter().filter_map(words).collect()
    };
    let exact_cost = cost(KernelId::Exact).join(", ");
    all.summary.push(format!(
        "**Exact answers cost {exact_cost}** the time of `{PLAIN}` and leave {}.",
        errors(&exact)
    ));
    all.summary.push(format!("`{PLAIN}`, the default, leaves {}.", errors(&plain)));
    let lossy = sums(&rows, |row| row.kernel == Intersector::BuiltIn(KernelId::Quantised));
    if lossy.rays > 0 {
        let bytes: Vec<String> = structures
            .iter()
            .filter_map(|id| {
                let cost = self::cost(&rows, id, KernelId::Quantised, |_| true)?;
                Some(format!("{} the bytes and {} the time in {id}", times(cost.bytes?), times(cost.time)))
            })
            .collect();
        all.summary.push(format!(
            "Corners of 16 bits take {} and leave {}.",
            bytes.join(", "),
            errors(&lossy)
        ));
    }
    all.sentences.extend(all.summary.iter().cloned());
    let hunting = total(&rows, |row| row.is_exact(), |row| row.hunting.as_ref());
    if hunting.rays > 0 {
        all.sentences.push(format!(
            "On rays that hunt for errors, counted apart, `exact` leaves {}; `{PLAIN}` leaves {}.",
            errors(&hunting),
            errors(&total(
                &rows,
                |row| row.kernel == Intersector::BuiltIn(PLAIN),
                |row| row.hunting.as_ref()
            ))
        ));
    }
    for (kind, generated) in [("generated scenes", true), ("meshes from elsewhere", false)] {
        let belongs = |row: &TradeRow| {
            let source = trade.scenes.iter().find(|scene| scene.id == row.scene).map(|scene| &scene.source);
            source.is_some_and(|source| source.starts_with("generated") == generated)
        };
        let costs: Vec<String> = structures
            .iter()
            .filter_map(|id| {
                Some(format!("{} in {id}", words(&self::cost(&rows, id, KernelId::Exact, belongs)?)))
            })
            .collect();
        let plain = sums(&rows, |row| belongs(row) && row.kernel == Intersector::BuiltIn(PLAIN));
        if !costs.is_empty() {
            all.sentences.push(format!(
                "On {kind} exactness costs {}, and `{PLAIN}` leaves {}.",
                costs.join(", "),
                errors(&plain)
            ));
        }
    }
    let mut others: Vec<&str> = Vec::new();
    for row in rows.iter().filter(|row| row.kernel == Intersector::External) {
        if !others.contains(&row.structure.as_str()) {
            others.push(&row.structure);
        }
    }
    for other in others {
        let found = sums(&rows, |row| row.structure == other);
        all.sentences.push(format!("`{other}` leaves {}.", errors(&found)));
    }
    all.sentences.extend(of_curve(&trade.curve));
    if trade.curve.iter().any(|row| row.structure == "ssm") {
        all.sentences.push(
            "How coarse a structure's own boxes or cells are changes no answer: they are rounded outwards and only choose \
             which triangles are tested."
                .to_owned(),
        );
    }
    Some(all)
}

/// The fewest bits that keep to so many visible errors on every scene of the curve.
fn of_curve(curve: &[Precise]) -> Vec<String> {
    let mut scenes: Vec<&str> = curve.iter().map(|row| row.scene.as_str()).collect();
    scenes.dedup();
    scenes.sort_unstable();
    scenes.dedup();
    let mut all = Vec::new();
    for (sort, words) in
        [("over the scene", "over the whole scene"), ("over a block", "over a block of 64 triangles")]
    {
        for level in LEVELS {
            let of_sort = |row: &&Precise| row.precision.ends_with(sort) && row.bits.is_some();
            let mut bits: Vec<u32> = curve.iter().filter(of_sort).filter_map(|row| row.bits).collect();
            bits.sort_unstable();
            bits.dedup();
            let keeps = |bits: &u32| {
                let mut rows = curve.iter().filter(of_sort).filter(|row| row.bits == Some(*bits)).peekable();
                rows.peek().is_some() && rows.all(|row| row.errors.visible_per_million() <= level)
            };
            let all_of = bits.last().copied().unwrap_or(0);
            let scenes = match scenes.len() {
                1 => "the one scene".to_owned(),
                n => format!("all {n} scenes"),
            };
            if all_of == 0 {
                continue;
            }
            all.push(match bits.iter().find(|bits| keeps(bits)) {
                Some(bits) => format!(
                    "At most {level} visible errors in a million on {scenes} of the curve take {bits} bits a coordinate {words}."
                ),
                None => format!(
                    "No lattice {words} of up to {all_of} bits keeps to {level} visible errors in a million on {scenes} of the curve."
                ),
            });
        }
    }
    all
}

fn total(
    rows: &[&TradeRow],
    which: impl Fn(&TradeRow) -> bool,
    errors: impl Fn(&TradeRow) -> Option<&Judged>,
) -> Counts {
    let mut sum = Counts::default();
    rows.iter()
        .filter(|row| which(row))
        .filter_map(|row| errors(row))
        .for_each(|judged| sum += judged.counts);
    sum
}

fn sums(rows: &[&TradeRow], which: impl Fn(&TradeRow) -> bool) -> Counts {
    total(rows, which, |row| row.ordinary.as_ref())
}

/// Counts in words, with the bound where nothing was seen.
fn errors(counts: &Counts) -> String {
    let rays = units::count(counts.rays);
    let million = |count| units::figure(counts.per_million(count));
    let high = units::figure(counts.bounds(counts.visible()).high * 1e6);
    if counts.visible() + counts.swapped == 0 {
        return format!("no error in {rays} rays (at most {high} in a million, 95 %)");
    }
    let swapped = match counts.swapped {
        0 => String::new(),
        swapped => format!(" and {} swapped objects in a million", million(swapped)),
    };
    if counts.visible() == 0 {
        return format!("no visible error (at most {high} in a million, 95 %){swapped}, in {rays} rays");
    }
    format!(
        "{} visible errors in a million ({} holes, {} phantoms, {} displaced; at most {high}, 95 %){swapped}, in {rays} rays",
        million(counts.visible()),
        million(counts.holes),
        million(counts.phantoms),
        million(counts.displaced),
    )
}

fn words(cost: &Cost) -> String {
    let (most, scene) = &cost.most;
    if cost.scenes < 2 {
        return times(cost.time);
    }
    format!("{} ({} on {scene} at most)", times(cost.time), times(*most))
}

/// A kernel in a structure beside the default one, over the scenes where both have a time.
fn cost(
    rows: &[&TradeRow],
    structure: &str,
    kernel: KernelId,
    which: impl Fn(&TradeRow) -> bool,
) -> Option<Cost> {
    let find = |scene: &str, kernel| {
        let own = |row: &&&TradeRow| {
            let parts: Vec<&str> = row.structure.split([':', ',']).collect();
            // Other settings would be another structure.
            parts[0] == structure && parts[1..].iter().all(|part| part.starts_with("kernel="))
        };
        rows.iter().filter(own).find(|row| row.scene == scene && row.kernel == Intersector::BuiltIn(kernel))
    };
    let mut ratios: Vec<(f64, &str)> = Vec::new();
    let mut bytes = Vec::new();
    for row in rows.iter().filter(|row| row.kernel == Intersector::BuiltIn(kernel) && which(row)) {
        let Some(found) = find(&row.scene, kernel).filter(|found| found.structure == row.structure) else {
            continue;
        };
        let Some(plain) = find(&row.scene, PLAIN) else { continue };
        if let Some((a, b)) = found.ns_per_ray.zip(plain.ns_per_ray) {
            ratios.push((a / b, &row.scene));
        }
        if let Some((a, b)) = found.bytes.zip(plain.bytes) {
            bytes.push(a as f64 / b as f64);
        }
    }
    let most = ratios.iter().copied().max_by(|a, b| a.0.total_cmp(&b.0))?;
    let time = geometric_mean(&ratios.iter().map(|(ratio, _)| *ratio).collect::<Vec<_>>())?;
    Some(Cost {
        time,
        most: (most.0, most.1.to_owned()),
        bytes: geometric_mean(&bytes),
        scenes: ratios.len(),
    })
}

fn table(trade: &Trade, rows: &[&TradeRow], structures: &[&str]) -> Table {
    let mut table = Table::new([
        "structure".into(),
        "kernel".into(),
        figure("time"),
        figure("at most"),
        figure("bytes"),
        figure("holes/M"),
        figure("phantoms/M"),
        figure("displaced/M"),
        figure("swapped/M"),
        figure("visible/M at most, 95 %"),
        figure("rays"),
    ]);
    let scenes = trade.scenes.len();
    let ratio = |value: Option<f64>| Value::figure(value, times);
    let mut push = |name: &str, kernel: &str, cost: Option<&Cost>, counts: &Counts| {
        let mut cells = vec![Value::text(name), Value::text(kernel), ratio(cost.map(|cost| cost.time))];
        cells.extend([ratio(cost.map(|cost| cost.most.0)), ratio(cost.and_then(|cost| cost.bytes))]);
        let kinds = [Kind::Hole, Kind::Phantom, Kind::Displaced, Kind::Swapped];
        cells.extend(
            kinds.map(|kind| Value::figure(Some(counts.per_million(counts.of(kind))), units::figure)),
        );
        cells.push(Value::figure(Some(counts.bounds(counts.visible()).high * 1e6), units::figure));
        cells.push(Value::text(units::count(counts.rays)));
        table.push(cells);
    };
    for id in structures {
        for kernel in KernelId::ALL {
            let own = |row: &TradeRow| {
                row.structure.split(':').next() == Some(*id) && row.kernel == Intersector::BuiltIn(kernel)
            };
            let counts = sums(rows, own);
            if counts.rays > 0 {
                push(id, kernel.id(), cost(rows, id, kernel, |_| true).as_ref(), &counts);
            }
        }
    }
    let mut named: Vec<&str> = Vec::new();
    for row in rows.iter().filter(|row| row.kernel == Intersector::External) {
        if !named.contains(&row.structure.as_str()) {
            named.push(&row.structure);
            let counts = sums(rows, |other| other.structure == row.structure);
            push(&row.structure, &format!("its own, {scenes} scenes"), None, &counts);
        }
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_seen_is_said_with_its_bound() {
        let none = Counts { rays: 1_000_000, ..Counts::default() };
        assert_eq!(errors(&none), "no error in 1,000,000 rays (at most 3 in a million, 95 %)");
        let swapped = Counts { swapped: 7, ..none };
        assert_eq!(
            errors(&swapped),
            "no visible error (at most 3 in a million, 95 %) and 7 swapped objects in a million, in 1,000,000 rays"
        );
        let holes = Counts { holes: 2, phantoms: 1, ..none };
        assert!(
            errors(&holes)
                .starts_with("3 visible errors in a million (2 holes, 1 phantoms, 0 displaced; at most 8.8")
        );
    }
}
