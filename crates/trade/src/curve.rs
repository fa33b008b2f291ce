//! The curve of precision: how few bits a coordinate may have.
//!
//! Most precisions have no packing of their own here. The scene's corners are then rounded, the structures are built over the rounded
//! scene, and its answers are judged by the true one: errors are those of any packing that holds the same corners. Bytes are
//! the structure's, with the corners counted at their bits; times are those over the rounded scene in `f32`, without
//! what unpacking takes. 16 bits over the scene, `f32`, `f64`, exact and boxes are measured as they are.

mod rounding;

use crate::judged::{Judged, Set};
use crate::timing::times;
use accel::{Accel, Geometry, Group, RaySet, Scene, Workload};
use harness::registry::{self, guarded_build};
use harness::workload::{pick, sample};
use judge::{Judge, Tally};
use rounding::Rounding;
use scenes::rays::Query;
use serde::{Deserialize, Serialize};

/// A precision in a structure on a scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Precise {
    /// Scene.
    pub scene: String,
    /// Structure.
    pub structure: String,
    /// What corners are kept as.
    pub precision: String,
    /// Bits of a coordinate; none where corners are not kept.
    pub bits: Option<u32>,
    /// Whether the time is that of this very packing; else unpacking is not in it.
    pub packed: bool,
    /// ns per ray, geometric mean over the ordinary sets.
    pub ns_per_ray: Option<f64>,
    /// Bytes a triangle, of structure and corners.
    pub bytes_per_triangle: f64,
    /// Errors on ordinary rays.
    pub errors: Judged,
    /// Whether no other precision of the structure and scene is as small, as fast and as right, and better in one of these.
    pub front: bool,
}

/// The structures that the curve is drawn for.
const STRUCTURES: [&str; 2] = ["bmssm", "ssm"];

/// Rays of a set that are timed.
const TIMED: usize = 1 << 15;

/// Samples of a time.
const ROUNDS: usize = 3;

/// A packing that is measured as it is: a name, the kernel, bits of a coordinate.
const PACKED: [(&str, &str, Option<u32>); 5] = [
    ("16 bits over the scene", "quantised", Some(16)),
    ("f32", "moller-trumbore", Some(32)),
    ("f32, f64 where it counts", "double", Some(32)),
    ("exact", "exact", Some(32)),
    ("boxes only", "box", None),
];

/// Coordinates of a triangle's corners.
const COORDINATES: f64 = 9.0;

/// Runs a task on the judges' threads.
pub type OnJudges<'a> = &'a dyn Fn(&mut (dyn FnMut() + Send));

/// Every precision on a scene; `on_judges` runs what is not timed.
pub fn of(scene: &Scene, judge: &Judge, sets: &[Set], on_judges: OnJudges) -> Vec<Precise> {
    let Geometry::Triangles(mesh) = &scene.geometry else { return Vec::new() };
    let timed: Vec<(RaySet, Query)> =
        sets.iter().map(|set| (pick(&set.rays, &sample(set.rays.len(), TIMED)), set.query)).collect();
    let timed: Vec<(&RaySet, Query)> = timed.iter().map(|(rays, query)| (rays, *query)).collect();
    let rounded: Vec<(Rounding, Scene)> = Rounding::all()
        .into_iter()
        .map(|r| (r, Scene { geometry: Geometry::Triangles(r.apply(mesh)), ..scene.clone() }))
        .collect();
    let triangles = mesh.triangles.len().max(1) as f64;
    let mut all = Vec::new();
    for structure in STRUCTURES {
        let build = |kernel: &str, scene| {
            let choice = registry::parse(&format!("{structure}:kernel={kernel}")).ok()?;
            guarded_build(&choice, scene, &Workload::GENERAL).ok()
        };
        let mut built: Vec<(Precise, Box<dyn Accel + '_>)> = Vec::new();
        let blank = |precision: &str, bits, packed, bytes_per_triangle| Precise {
            scene: scene.id.clone(),
            structure: structure.to_owned(),
            precision: precision.to_owned(),
            bits,
            packed,
            ns_per_ray: None,
            bytes_per_triangle,
            errors: Judged::default(),
            front: false,
        };
        for (name, kernel, bits) in PACKED {
            let Some(accel) = build(kernel, scene) else { continue };
            let bytes = accel.footprint().total() as f64 / triangles;
            built.push((blank(name, bits, true, bytes), accel));
        }
        for (rounding, scene) in &rounded {
            let Some(accel) = build("moller-trumbore", scene) else { continue };
            let footprint = accel.footprint();
            // What copies hold beside corners stays: numbers of objects, limits.
            let beside = footprint.bytes(Group::GeometryCopy) as f64 / triangles - COORDINATES * 4.0;
            let corners = COORDINATES * f64::from(rounding.bits()) / 8.0 + rounding.header();
            let bytes = footprint.bytes(Group::Structure) as f64 / triangles + beside.max(0.0) + corners;
            built.push((blank(&rounding.name(), Some(rounding.bits()), false, bytes), accel));
        }
        let accels: Vec<&dyn Accel> = built.iter().map(|(_, accel)| accel.as_ref()).collect();
        let ns = times(&accels, &timed, ROUNDS);
        let mut rows: Vec<Precise> = Vec::new();
        for ((row, accel), ns) in built.iter().zip(ns) {
            let mut row = row.clone();
            row.ns_per_ray = ns;
            on_judges(&mut || {
                let mut sum = Tally::default();
                sets.iter().for_each(|set| sum.extend(set.judge(judge, accel.as_ref())));
                row.errors = Judged::of("", sum);
            });
            rows.push(row);
        }
        mark(&mut rows);
        all.extend(rows);
    }
    all
}

/// Marks the front of bytes, time and visible errors.
fn mark(rows: &mut [Precise]) {
    let point =
        |row: &Precise| Some([row.bytes_per_triangle, row.ns_per_ray?, row.errors.visible_per_million()]);
    let points: Vec<Option<[f64; 3]>> = rows.iter().map(point).collect();
    let beats = |a: &[f64; 3], b: &[f64; 3]| a.iter().zip(b).all(|(a, b)| a <= b) && a != b;
    for (row, point) in rows.iter_mut().zip(&points) {
        row.front = point.is_some_and(|point| !points.iter().flatten().any(|other| beats(other, &point)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_front_has_three_axes() {
        let row = |bytes: f64, ns: f64, holes: u64| Precise {
            scene: String::new(),
            structure: String::new(),
            precision: String::new(),
            bits: None,
            packed: true,
            ns_per_ray: Some(ns),
            bytes_per_triangle: bytes,
            errors: Judged::counted(judge::Counts { rays: 1000, holes, ..judge::Counts::default() }),
            front: false,
        };
        let mut rows =
            [row(1.0, 9.0, 9), row(9.0, 1.0, 9), row(9.0, 9.0, 0), row(9.0, 9.0, 1), row(1.0, 9.0, 10)];
        mark(&mut rows);
        assert_eq!(rows.map(|row| row.front), [true, true, true, false, false]);
    }
}
