//! All cells of one scene.

use super::build::{Built, build_all};
use super::entry::{Entries, References, ray_set};
use super::job::Job;
use crate::record::Cell;
use crate::registry::Choice;
use crate::workload::{RayQuery, batches};
use accel::{RaySet, Workload};

/// Builds, checks and measures in passes; one cell for every structure and ray set, except lists of rays for
/// structures that serve none. `keep` gets the cells of a ray set, as they are by then, whenever it is done in a pass
/// (the first is 0); no ray set begins after the deadline, and what is interrupted adds nothing to its cells.
///
/// Runs in the current thread pool.
pub fn measure(job: &Job, keep: impl FnMut(&RayQuery, usize, Vec<Cell>)) {
    // None is an interruption, after which there is nothing to do.
    let _ = all_passes(job, keep);
}

fn all_passes(job: &Job, mut keep: impl FnMut(&RayQuery, usize, Vec<Cell>)) -> Option<()> {
    let choices = crate::auto::resolve(job.choices, job.scene, &batches(job.queries));
    let job = &Job { choices: &choices, ..*job };
    let mut references = References::new(job.scene);
    let mut entries = Entries::new();
    // Workloads that no two ray sets share come one at a time, so that not all builds are held at once.
    let wanted = |by: bool, queries: &[&RayQuery]| -> Vec<&Choice> {
        let lacking = |c: &&Choice| queries.iter().any(|q| job.lacks(q, c));
        job.choices.iter().filter(|c| by_workload(c) == by).filter(lacking).collect()
    };
    let (lists, rasters): (Vec<_>, Vec<_>) =
        job.queries.iter().partition(|q| matches!(q.rays, RaySet::List(_)));
    let general: Vec<_> = wanted(false, &[&lists[..], &rasters[..]].concat());
    let general: Vec<_> = general.into_iter().map(|c| (c, Workload::GENERAL)).collect();
    let for_lists: Vec<_> = wanted(true, &lists).into_iter().map(|c| (c, Workload::GENERAL)).collect();
    let (mut built, mut built_for_lists) = (Vec::new(), Vec::new());
    let mut built_for_rasters: Vec<Vec<Built>> = job.queries.iter().map(|_| Vec::new()).collect();
    for pass in 0..job.options.passes() {
        if job.deadline.is_over() {
            return None;
        }
        let due = (job.options, pass);
        build_all(job.scene, &general, due, job.deadline, &mut built)?;
        build_all(job.scene, &for_lists, due, job.deadline, &mut built_for_lists)?;
        for (asked, for_raster) in job.queries.iter().zip(&mut built_for_rasters) {
            if job.deadline.is_over() {
                return None;
            }
            let mut entrants: Vec<(&Choice, &Built)> = choices_of(&general).zip(&built).collect();
            match asked.rays {
                RaySet::List(_) => entrants.extend(choices_of(&for_lists).zip(&built_for_lists)),
                RaySet::Raster(_) => {
                    let workload = Workload::of(&asked.rays);
                    let wanted: Vec<_> = wanted(true, &[asked]).into_iter().map(|c| (c, workload)).collect();
                    build_all(job.scene, &wanted, due, job.deadline, for_raster)?;
                    entrants.extend(wanted.iter().map(|(c, _)| *c).zip(&*for_raster));
                }
            }
            entrants.retain(|(choice, _)| job.wants(asked, choice, pass));
            if !entrants.is_empty() {
                let place = |choice: &Choice| job.choices.iter().position(|c| std::ptr::eq(c, choice));
                entrants.sort_by_key(|(choice, _)| place(choice));
                keep(asked, pass, ray_set(job, pass, asked, &entrants, &mut entries, &mut references)?);
            }
            for_raster.iter_mut().for_each(Built::drop_structure);
        }
    }
    Some(())
}

fn choices_of<'c>(wanted: &[(&'c Choice, Workload)]) -> impl Iterator<Item = &'c Choice> {
    wanted.iter().map(|(choice, _)| *choice)
}

fn by_workload(choice: &Choice) -> bool {
    choice.entry.traits.by_workload
}
