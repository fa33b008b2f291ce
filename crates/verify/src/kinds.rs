//! Every kind of solid through every structure, held to brute force.

use crate::cases::{self, KINDS, Reach};
use crate::compare::Judged;
use accel::{Projection, Raster, RaySet, Scene, Vec3, Workload};
use harness::guard::guard;
use harness::registry::{self, StructureSpec, guarded_build};
use primitives::KernelId;
use scenes::Random;
use serde::Serialize;

/// One kind in one structure.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// The kind, or `mixed`.
    pub kind: String,
    /// The structure with its settings.
    pub structure: String,
    /// Rays traced.
    pub rays: u64,
    /// Those that hit.
    pub hits: u64,
    /// Answers that are not brute force's; of libraries those that hit or miss otherwise.
    pub differences: u64,
    /// Whether differences are none of a library's own arithmetic.
    pub built_in: bool,
}

/// What was compared.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Tally {
    /// Kind by kind.
    pub rows: Vec<Row>,
    /// The first differences, in words.
    pub findings: Vec<String>,
}

impl Tally {
    /// Whether no structure of the suite's own differs from brute force.
    pub fn is_sound(&self) -> bool {
        self.findings.is_empty() && self.rows.iter().all(|row| !row.built_in || row.differences == 0)
    }
}

/// Objects of a scene.
const OBJECTS: u32 = 60;

/// Rows and columns of an image, and rays of a list as many.
const SIDE: u32 = 64;

/// Differences told in words.
const MAX: usize = 20;

/// At least so many rays for each kind and for all mixed, half as image and half as list, through each of the structures: the
/// nearest hit, whether there is any, and every crossing. `done` is told of each kind.
pub fn run(rays: u64, seed: u64, structures: &[StructureSpec], mut done: impl FnMut(&str)) -> Tally {
    let mut tally = Tally::default();
    let kinds = KINDS.iter().map(|kind| (*kind, vec![*kind])).chain([("mixed", KINDS.to_vec())]);
    for (kind, kinds) in kinds {
        let first = tally.rows.len();
        let row = |spec: &StructureSpec| Row {
            kind: kind.into(),
            structure: spec.to_string(),
            rays: 0,
            hits: 0,
            differences: 0,
            built_in: registry::choose(spec).is_ok_and(|choice| choice.entry.traits.built_in),
        };
        tally.rows.extend(structures.iter().map(row));
        let mut numbers = Random::new(seed);
        let mut traced = 0;
        while traced < rays {
            let scene = cases::solids(&mut numbers, &kinds, OBJECTS);
            let reach = Reach { scale: 0, offset: None, origins: 1 };
            let list = RaySet::List(cases::rays(&mut numbers, &scene, &reach, (SIDE * SIDE) as usize));
            let image = raster(&mut numbers);
            traced += (list.len() + RaySet::Raster(image).len()) as u64;
            let Tally { rows, findings } = &mut tally;
            hold(&scene, &list, Workload::GENERAL, structures, &mut rows[first..], findings);
            // The image as one, and its rays alone.
            let workload = Workload { raster: Some(image), general: true };
            hold(&scene, &RaySet::Raster(image), workload, structures, &mut rows[first..], findings);
        }
        done(kind);
    }
    tally
}

/// An image from somewhere in front.
fn raster(numbers: &mut Random) -> Raster {
    let mut unit = || crate::Numbers::unit(numbers);
    let origin = Vec3::new(unit(), unit(), 4.0);
    let (right, down) = (Vec3::X * 0.012, Vec3::Y * 0.012);
    let forward = -origin - (right + down) * (SIDE / 2) as f32;
    Raster { projection: Projection::Perspective, rows: SIDE, cols: SIDE, origin, forward, right, down }
}

fn hold(
    scene: &Scene,
    rays: &RaySet,
    workload: Workload,
    structures: &[StructureSpec],
    rows: &mut [Row],
    findings: &mut Vec<String>,
) {
    let mut tell = |what: String| {
        if findings.len() < MAX {
            findings.push(what);
        }
    };
    let mut by_kernel: Vec<(KernelId, Judged<'_>)> = Vec::new();
    for (spec, row) in structures.iter().zip(rows) {
        let Ok(choice) = registry::choose(spec) else { continue };
        let kernel = choice.built_in_kernel().unwrap_or(KernelId::MollerTrumbore);
        if !by_kernel.iter().any(|(known, _)| *known == kernel) {
            match Judged::new(scene, rays, workload, kernel) {
                Ok(judged) => by_kernel.push((kernel, judged)),
                Err(difference) => return tell(difference.to_string()),
            }
        }
        let Some((_, judged)) = by_kernel.iter().find(|(known, _)| *known == kernel) else { continue };
        if row.built_in {
            match judged.hold_all(&spec.to_string()) {
                Ok(0) => continue,
                Ok(_) => {}
                Err(difference) => {
                    row.differences += 1;
                    tell(format!("{}: {difference}", row.kind));
                }
            }
        } else {
            let Ok(built) = guarded_build(&choice, scene, &workload) else { continue };
            let mut hits = vec![None; rays.len()];
            if let Err(panic) = guard("tracing", || built.trace(rays, &mut hits)) {
                tell(format!("{}, {spec}: {panic}", row.kind));
            }
            row.differences += judged.hit_otherwise(&hits);
        }
        row.rays += rays.len() as u64;
        row.hits += judged.hits();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_kind_in_every_structure_is_as_brute_force_has_it() {
        let structures = registry::with_variants(|entry| entry.traits.built_in && entry.id != "brute");
        let mut kinds = Vec::new();
        let tally = run(1, 3, &structures, |kind| kinds.push(kind.to_owned()));
        assert!(tally.is_sound(), "{:#?}", tally.findings);
        assert_eq!(kinds.len(), KINDS.len() + 1);
        for row in &tally.rows {
            assert!(row.rays > 4000 && row.hits > 200, "{row:?}");
        }
    }
}
