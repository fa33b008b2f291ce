//! The cells of a record as tables.

use crate::table::{Table, Value, figure};
use harness::grouped::Measure;
use harness::record::{Cell, Key, Outcome, Query, Record};
use harness::units;
use std::collections::BTreeMap;
use std::fmt::Write;

/// A figure of every structure for every scene and ray set: these down, structures across. What failed says `failed`, what is
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
    let mut out = Table::of_figures("scene, rays", structures.iter().copied());
    for key in keys {
        let mut name = format!("{} {}", key.scene, key.rays);
        if threads {
            let _ = write!(name, " ×{}", key.threads);
        }
        let figure = |s: &&str| table.get(&(key.clone(), *s)).cloned().unwrap_or_else(|| "–".to_owned());
        out.push(std::iter::once(name).chain(structures.iter().map(figure)));
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

/// Every cell with all its figures, a row each; what there is none of stays empty.
pub fn all(record: &Record) -> Table {
    let mut table = Table::new([
        "scene".into(),
        figure("objects"),
        "rays".into(),
        "query".into(),
        "structure".into(),
        "kernel".into(),
        figure("threads"),
        figure("ray_count"),
        figure("hits"),
        figure("samples"),
        figure("ns_per_ray_median"),
        figure("ns_per_ray_mad"),
        figure("ns_per_ray_min"),
        figure("build_ns_median"),
        figure("bytes_structure"),
        figure("bytes_geometry_copy"),
        figure("bytes_peak_build"),
        figure("rays_checked"),
        figure("differences"),
        figure("rays_exact"),
        figure("missed"),
        figure("false_hits"),
        figure("wrong_object"),
        figure("t_ulp_p99"),
        figure("t_ulp_max"),
        "version".into(),
        "settings".into(),
        "plan".into(),
        "error".into(),
    ]);
    let number = |value: Option<f64>| Value::figure(value, units::figure);
    for cell in &record.cells {
        let structure = record.structures.iter().find(|s| s.id == cell.structure);
        let (timing, bytes) = (cell.ns_per_ray.as_ref(), cell.bytes.as_ref());
        let check = cell.check.as_ref();
        let errors = check.and_then(|c| c.errors.as_ref());
        table.push([
            Value::text(&cell.scene),
            Value::count(record.scene(&cell.scene).map(|s| s.objects)),
            Value::text(&cell.rays),
            Value::text(if cell.query == Query::Closest { "closest" } else { "occluded" }),
            Value::text(&cell.structure),
            Value::text(cell.kernel.name()),
            Value::count(cell.threads as u64),
            Value::count(cell.ray_count),
            Value::count(cell.hits),
            Value::count(cell.trace_ns.len() as u64),
            number(timing.map(|t| t.median)),
            number(timing.map(|t| t.mad)),
            number(timing.map(|t| t.min)),
            number(cell.build()),
            Value::count(bytes.map(|b| b.structure)),
            Value::count(bytes.map(|b| b.geometry_copy)),
            Value::count(bytes.and_then(|b| b.peak_build)),
            Value::count(check.map(|c| c.rays_checked)),
            Value::count(check.map(|c| c.differences)),
            Value::count(errors.map(|e| e.rays_exact)),
            Value::count(errors.map(|e| e.missed)),
            Value::count(errors.map(|e| e.false_hits)),
            Value::count(errors.map(|e| e.wrong_object)),
            number(errors.map(|e| e.t_ulp_p99)),
            number(errors.map(|e| e.t_ulp_max)),
            Value::text(structure.map(|s| s.version.clone()).unwrap_or_default()),
            Value::text(structure.map(|s| s.settings.clone()).unwrap_or_default()),
            Value::text(&cell.plan),
            Value::text(cell.outcome.reason().unwrap_or_default()),
        ]);
    }
    table
}
