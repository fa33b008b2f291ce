//! One row a cell.

use harness::record::{Query, Record};
use std::io::{self, Write};

const HEAD: [&str; 29] = [
    "scene",
    "objects",
    "rays",
    "query",
    "structure",
    "kernel",
    "threads",
    "ray_count",
    "hits",
    "samples",
    "ns_per_ray_median",
    "ns_per_ray_mad",
    "ns_per_ray_min",
    "build_ns_median",
    "bytes_structure",
    "bytes_geometry_copy",
    "bytes_peak_build",
    "rays_checked",
    "differences",
    "rays_exact",
    "missed",
    "false_hits",
    "wrong_object",
    "t_ulp_p99",
    "t_ulp_max",
    "version",
    "settings",
    "plan",
    "error",
];

/// Writes a record's cells as CSV; figures that there are none of stay empty.
///
/// # Errors
/// Errors of `out`.
pub fn write_csv(record: &Record, out: impl Write) -> io::Result<()> {
    let mut csv = csv::Writer::from_writer(out);
    csv.write_record(HEAD)?;
    for cell in &record.cells {
        let objects = record.scene(&cell.scene).map(|s| s.objects);
        let structure = record.structures.iter().find(|s| s.id == cell.structure);
        let (timing, bytes) = (cell.ns_per_ray.as_ref(), cell.bytes.as_ref());
        let check = cell.check.as_ref();
        let errors = check.and_then(|c| c.errors.as_ref());
        csv.write_record([
            cell.scene.clone(),
            text(objects),
            cell.rays.clone(),
            if cell.query == Query::Closest { "closest" } else { "occluded" }.to_owned(),
            cell.structure.clone(),
            cell.kernel.to_string(),
            cell.threads.to_string(),
            cell.ray_count.to_string(),
            cell.hits.to_string(),
            cell.trace_ns.len().to_string(),
            text(timing.map(|t| t.median)),
            text(timing.map(|t| t.mad)),
            text(timing.map(|t| t.min)),
            text(cell.build()),
            text(bytes.map(|b| b.structure)),
            text(bytes.map(|b| b.geometry_copy)),
            text(bytes.and_then(|b| b.peak_build)),
            text(check.map(|c| c.rays_checked)),
            text(check.map(|c| c.differences)),
            text(errors.map(|e| e.rays_exact)),
            text(errors.map(|e| e.missed)),
            text(errors.map(|e| e.false_hits)),
            text(errors.map(|e| e.wrong_object)),
            text(errors.map(|e| e.t_ulp_p99)),
            text(errors.map(|e| e.t_ulp_max)),
            structure.map(|s| s.version.clone()).unwrap_or_default(),
            structure.map(|s| s.settings.clone()).unwrap_or_default(),
            cell.plan.clone(),
            cell.outcome.reason().unwrap_or_default().to_owned(),
        ])?;
    }
    csv.flush()
}

fn text(value: Option<impl ToString>) -> String {
    value.map_or_else(String::new, |value| value.to_string())
}
