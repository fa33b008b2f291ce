//! Structures with a kernel that claims to be exact, against the oracle.

use super::unavailable;
use crate::check::oracle_of;
use crate::guard::guard;
use crate::progress::{Event, Listener};
use crate::registry::{Choice, guarded_build};
use crate::workload::{self, Subject, batches};
use accel::{Geometry, Hit, RaySet, Scene, Workload};
use oracle::{ExactHit, Verdict, classify};
use rayon::prelude::*;
use scenes::SceneError;
use scenes::rays::{Feature, Query, RaysId};
use serde::Serialize;

/// What is judged.
#[derive(Clone, Debug)]
pub struct OraclePlan {
    /// Scenes and ray sets; scenes of boxes are passed over, and sets that only ask whether there is a hit.
    pub subject: Subject,
    /// Rays to be judged at least: with more seeds until it is reached.
    pub least: u64,
}

/// What was found.
#[derive(Clone, Debug, Default, Serialize)]
pub struct OracleTally {
    /// Scenes judged.
    pub scenes: usize,
    /// Rays judged, each for every structure.
    pub rays: u64,
    /// By structure.
    pub structures: Vec<OracleRow>,
    /// What is wrong, in words, the first of each kind.
    pub findings: Vec<String>,
    /// Of the rays.
    #[serde(flatten)]
    pub kinds: RayKinds,
}

/// Rays that the oracle treats in a way of their own.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct RayKinds {
    /// Rays judged that are aimed at edges and corners.
    pub aimed: u64,
    /// Rays left out because t is less than the least normal `f32`: the hit-in-padded-bounds invariant may refuse such hits.
    pub left_out: u64,
}

/// A structure's wrong answers.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct OracleRow {
    /// The structure with its settings.
    pub structure: String,
    /// No hit where there is one.
    pub missed: u64,
    /// A hit where there is none.
    pub false_hits: u64,
    /// A hit of another object than the nearest.
    pub wrong_object: u64,
    /// Right hits whose t is off by more than one unit in the last place.
    pub wrong_t: u64,
    /// The largest error of t in such units.
    pub t_ulp_max: f64,
    /// Scenes and ray sets that could not be traced.
    pub failed: u64,
}

impl OracleRow {
    fn is_exact(&self) -> bool {
        self.missed + self.false_hits + self.wrong_object + self.wrong_t + self.failed == 0
    }
}

impl OracleTally {
    /// Whether every structure gave the true answer to every ray.
    pub fn is_exact(&self) -> bool {
        self.structures.iter().all(OracleRow::is_exact)
    }

    fn finding(&mut self, text: String) {
        if self.findings.len() < 20 {
            self.findings.push(text);
        }
    }
}

/// Judges; `listener` hears of every scene.
///
/// # Errors
/// A scene that is unsound; scenes that are not on this machine are passed over.
pub fn run(
    plan: &OraclePlan,
    choices: &[Choice],
    mut listener: impl Listener,
) -> Result<OracleTally, SceneError> {
    let row = |choice: &Choice| OracleRow { structure: choice.spec.to_string(), ..OracleRow::default() };
    let mut tally = OracleTally { structures: choices.iter().map(row).collect(), ..OracleTally::default() };
    for pass in 0.. {
        let before = tally.rays;
        for id in &plan.subject.scenes {
            if pass > 0 && tally.rays >= plan.least {
                break;
            }
            let scene = match scenes::load(&id.parse()?) {
                Ok(scene) => scene,
                Err(error) if error.is_unavailable() => {
                    tally.finding(unavailable(&error));
                    continue;
                }
                Err(error) => return Err(error),
            };
            one_scene(plan, &scene, choices, plan.subject.seed + pass, &mut tally);
            if pass == 0 {
                listener.hear(&Event::SceneChecked { id });
            }
        }
        if pass == 0 {
            tally.scenes = plan.subject.scenes.len() - tally.findings.len();
        }
        if tally.rays >= plan.least || tally.rays == before {
            break;
        }
    }
    Ok(tally)
}

fn one_scene(plan: &OraclePlan, scene: &Scene, choices: &[Choice], seed: u64, tally: &mut OracleTally) {
    if !matches!(scene.geometry, Geometry::Triangles(_)) {
        return;
    }
    let oracle = oracle_of(scene);
    let sets: Vec<RaysId> =
        plan.subject.rays.iter().copied().filter(|id| id.query() == Query::Closest).collect();
    let queries = workload::make(scene, &sets, plan.subject.size, seed).made;
    let choices = crate::auto::resolve(choices, scene, &batches(&queries));
    let general: Vec<_> = choices.iter().map(|c| guarded_build(c, scene, &Workload::GENERAL)).collect();
    for asked in &queries {
        let rays = &asked.rays;
        let truth: Vec<_> = (0..rays.len()).into_par_iter().map(|i| oracle.closest(&rays.ray(i))).collect();
        let fair: Vec<usize> = (0..rays.len()).filter(|i| !is_denormal(truth[*i].as_ref())).collect();
        tally.rays += fair.len() as u64;
        tally.kinds.left_out += (rays.len() - fair.len()) as u64;
        if matches!(asked.id.aims_at(), Some(Feature::Edge | Feature::Vertex)) {
            tally.kinds.aimed += fair.len() as u64;
        }
        for (row, choice) in choices.iter().enumerate() {
            let place = format!("{}: {} {}", choice.spec, scene.id, asked.id);
            let by_workload;
            let built = match rays {
                RaySet::Raster(_) if choice.entry.traits.by_workload => {
                    by_workload = guarded_build(choice, scene, &Workload::of(rays));
                    &by_workload
                }
                _ => &general[row],
            };
            let mut hits = vec![None; rays.len()];
            let traced = match built {
                Ok(accel) => guard("tracing", || accel.trace(rays, &mut hits)).map_err(|e| e.to_string()),
                Err(failure) => Err(failure.to_string()),
            };
            if let Err(error) = traced {
                tally.structures[row].failed += 1;
                tally.finding(format!("{place}: {error}"));
                continue;
            }
            let before = tally.structures[row].is_exact();
            for i in &fair {
                count(&mut tally.structures[row], hits[*i], truth[*i].as_ref());
                if before && !tally.structures[row].is_exact() && tally.findings.len() < 20 {
                    let text = format!("{place}: {:?}: {:?}, true: {:?}", rays.ray(*i), hits[*i], truth[*i]);
                    if !tally.findings.iter().any(|known| known.starts_with(&place)) {
                        tally.finding(text);
                    }
                }
            }
        }
    }
}

fn is_denormal(truth: Option<&(u32, ExactHit)>) -> bool {
    truth.is_some_and(|(_, hit)| {
        let t = hit.t.to_f64();
        t != 0.0 && t.abs() < f64::from(f32::MIN_POSITIVE)
    })
}

fn count(row: &mut OracleRow, hit: Option<Hit>, truth: Option<&(u32, ExactHit)>) {
    let judgement = classify(hit, truth);
    match judgement.verdict {
        Verdict::Agree => {
            // Beyond the range of `f32` the correctly rounded t is infinite.
            let beyond = |(_, exact): &&(u32, ExactHit)| exact.t.to_f32().is_infinite();
            let rounded = truth.filter(beyond).map(|(_, exact)| exact.t.to_f32());
            let off = match rounded {
                Some(t) if hit.is_some_and(|hit| hit.t == t) => 0.0,
                _ => judgement.t_ulp_error.map_or(0.0, f64::abs),
            };
            row.wrong_t += u64::from(off > 1.0);
            row.t_ulp_max = row.t_ulp_max.max(off);
        }
        Verdict::Missed => row.missed += 1,
        Verdict::False => row.false_hits += 1,
        Verdict::WrongObject => row.wrong_object += 1,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::registry;

    #[test]
    fn the_exact_kernel_passes_and_rounding_ones_fail() {
        let choices =
            ["ssm:kernel=exact", "bmssm:kernel=exact", "ssm"].map(|id| registry::parse(id).unwrap());
        let scenes = vec!["bumps-1k@offset=1e4,0,0".into(), "unit-boxes".into(), "unit-coplanar".into()];
        let subject = Subject { scenes, rays: RaysId::ALL.to_vec(), size: 12, seed: 1 };
        let plan = OraclePlan { subject, least: 6000 };
        let tally = run(&plan, &choices, ()).unwrap();
        assert!(tally.rays >= 6000 && tally.kinds.aimed > 1000, "{tally:?}");
        assert!(!tally.is_exact());
        let [grid, maps, rounding] = &tally.structures[..] else { panic!() };
        assert!(grid.is_exact() && maps.is_exact() && grid.t_ulp_max <= 0.5, "{:?}", tally.findings);
        assert!(rounding.missed + rounding.wrong_object > 0 && rounding.t_ulp_max > 1.0, "{rounding:?}");
        assert!(tally.findings.iter().any(|text| text.starts_with("ssm:")), "{:?}", tally.findings);
    }
}
