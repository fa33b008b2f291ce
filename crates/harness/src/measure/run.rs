//! A whole run: scenes by name to a record.

use super::job::Job;
use super::memory::{RESOLUTIONS, memory_rows};
use super::resume::ResumeError;
use super::scene::measure;
use super::{Options, Session};
use crate::progress::{Event, Listener};
use crate::record::{Cell, Record, SceneEntry, Skipped};
use crate::registry::Choice;
use crate::workload::{self, RayQueries, RayQuery};
use accel::{Cancel, Scene};
use scenes::{SceneError, SceneSpec};

/// Why a session ends early.
#[derive(Debug, thiserror::Error)]
pub enum SessionError {
    /// A scene that is unsound.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A scene that is not what it was when the record was begun.
    #[error(transparent)]
    Resume(#[from] ResumeError),
}

/// Measures what `record` lacks, which is a new one ([`super::begin`]) or one to go on with ([`super::resume`]).
/// `listener` hears of scenes and ray sets; `keep` gets the record after every ray set of every pass. What can't be done is
/// in the record with its reason.
///
/// An interruption is no error: the record is what is done by then, and says that it is not complete.
///
/// # Errors
/// A scene that is unsound, or is another than in the record; scenes that are merely not on this machine are skipped.
pub fn run(
    session: &Session,
    choices: &[Choice],
    mut record: Record,
    mut listener: impl Listener,
    mut keep: impl FnMut(&Record),
) -> Result<Record, SessionError> {
    for (i, id) in session.subject.scenes.iter().enumerate() {
        if session.deadline.interrupted() {
            return Ok(record);
        }
        let spec: SceneSpec = id.parse()?;
        let loaded = match scenes::load_full(&spec) {
            Ok(loaded) => loaded,
            Err(error) if error.is_unavailable() => {
                listener.hear(&Event::SceneSkipped { id, reason: &error });
                skip(&mut record, id.clone(), error.to_string());
                keep(&record);
                continue;
            }
            Err(error) => return Err(error.into()),
        };
        let scene = &loaded.scene;
        if session.deadline.is_over() {
            skip(&mut record, scene.id.clone(), TIME_UP.to_owned());
            keep(&record);
            continue;
        }
        listener.hear(&Event::SceneBegun {
            id: &scene.id,
            place: i + 1,
            of: session.subject.scenes.len(),
            objects: scene.geometry.len(),
            kind: scene.geometry.kind(),
        });
        for note in &loaded.notes {
            listener.hear(&Event::SceneNote { note });
        }
        let entry = SceneEntry {
            id: scene.id.clone(),
            objects: scene.geometry.len() as u64,
            kind: scene.geometry.kind().to_owned(),
            source: loaded.source.clone(),
            checksum: scenes::checksum(&scene.geometry),
        };
        enter(&mut record, entry)?;
        let options = share_of_time(session, choices, session.subject.scenes.len() - i);
        one_scene(session, choices, scene, &options, &mut record, &mut listener, &mut keep);
    }
    if let Some(run) = record.run.as_mut().filter(|_| !session.deadline.interrupted()) {
        run.complete = true;
        keep(&record);
    }
    Ok(record)
}

const TIME_UP: &str = "the time was up";

/// The options for a scene when `scenes` of them are left.
fn share_of_time(session: &Session, choices: &[Choice], scenes: usize) -> Options {
    let mut options = session.options.clone();
    if let Some(left) = session.deadline.left() {
        // Builds, checks and memory take several times as long as the samples.
        let cells = scenes * session.subject.rays.len() * choices.len();
        let share = left / cells.max(1) as u32;
        options.cell_time = options.cell_time.min(share.mul_f64(0.2));
        options.sample_time = options.sample_time.min(share / 2);
        options.least_builds = 1;
        options.build_time = options.build_time.min(4 * options.cell_time);
    }
    options
}

/// Says why something is left out, in place of what an earlier run said.
fn skip(record: &mut Record, id: String, reason: String) {
    record.skipped.retain(|skipped| skipped.id != id);
    record.skipped.push(Skipped { id, reason });
}

/// Enters a scene, unless the record has it; nothing of it counts as left out from here on.
fn enter(record: &mut Record, entry: SceneEntry) -> Result<(), ResumeError> {
    let of_scene =
        |id: &str| id.strip_prefix(&entry.id).is_some_and(|rest| rest.is_empty() || rest.starts_with('/'));
    record.skipped.retain(|skipped| !of_scene(&skipped.id));
    match record.scene(&entry.id) {
        None => record.scenes.push(entry),
        Some(known) if known.checksum == entry.checksum => {}
        Some(known) => {
            return Err(ResumeError::Differs {
                what: format!("checksum of scene {}", entry.id),
                before: known.checksum.clone(),
                now: entry.checksum,
            });
        }
    }
    Ok(())
}

fn one_scene(
    session: &Session,
    choices: &[Choice],
    scene: &Scene,
    options: &Options,
    record: &mut Record,
    listener: &mut impl Listener,
    keep: &mut impl FnMut(&Record),
) {
    let RayQueries { made: queries, left_out } =
        workload::make(scene, &session.subject.rays, session.subject.size, session.subject.seed);
    record.skipped.extend(left_out.iter().map(|(id, error)| Skipped::rays(&scene.id, id, error)));
    let here = |cell: &&Cell| cell.scene == scene.id && cell.threads == options.threads;
    let known: Vec<Cell> = record.cells.iter().filter(here).cloned().collect();
    let job = Job { scene, queries: &queries, choices, options, known: &known, deadline: &session.deadline };
    let is_known = |q: &RayQuery| known.iter().any(|cell| cell.rays == q.id.name());
    let mut left: Vec<&RayQuery> =
        queries.iter().filter(|q| choices.iter().any(|c| job.lacks(q, c)) && !is_known(q)).collect();
    measure(&job, |asked, pass, cells| {
        cells.into_iter().for_each(|cell| put(record, cell));
        left.retain(|q| q.id != asked.id);
        keep(record);
        listener.hear(&Event::RaySetDone { rays: asked.id, pass: pass + 1, passes: options.passes() });
    });
    if session.deadline.interrupted() {
        return;
    }
    record.skipped.extend(left.iter().map(|w| Skipped::rays(&scene.id, &w.id, &TIME_UP)));
    if session.memory && !record.memory.iter().any(|row| row.scene == scene.id) {
        let over = || session.deadline.is_over();
        match memory_rows(scene, &RESOLUTIONS, Cancel::when(&over)) {
            Some(rows) => record.memory.extend(rows),
            None if session.deadline.interrupted() => {}
            None => {
                let id = format!("{}/memory by resolution", scene.id);
                record.skipped.push(Skipped { id, reason: TIME_UP.to_owned() });
            }
        }
    }
    keep(record);
}

/// Adds a cell to the record, or replaces what it was after an earlier pass.
fn put(record: &mut Record, cell: Cell) {
    let same = |old: &&mut Cell| old.key() == cell.key() && old.structure == cell.structure;
    match record.cells.iter_mut().find(same) {
        Some(old) => *old = cell,
        None => record.cells.push(cell),
    }
}
