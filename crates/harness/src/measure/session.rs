//! What a run is asked for, and the record that it begins with.

use super::{Deadline, Options};
use crate::clock::Clock;
use crate::machine::Machine;
use crate::record::{FORMAT, Record, Run, Skipped, Structure, Suite};
use crate::registry::{self, Choice};
use crate::workload::Subject;
use std::time::SystemTime;

/// What is to be measured.
#[derive(Clone, Debug, Default)]
pub struct Session {
    /// Scenes and ray sets.
    pub subject: Subject,
    /// How much is measured.
    pub options: Options,
    /// Whether memory by resolution is recorded.
    pub memory: bool,
    /// When to stop. Where time is limited, the cells that are left share what is left of it; after its end no new
    /// ray set begins, and those are recorded as skipped.
    pub deadline: Deadline,
    /// The command as given.
    pub command: String,
}

/// A record of nothing yet.
pub fn begin(session: &Session, choices: &[Choice]) -> Record {
    // Before versions are asked for, as a library may start its threads for that.
    if session.options.threads == 1 {
        registry::keep_to_one_thread();
    }
    let structure = |choice: &Choice| Structure {
        id: choice.spec.to_string(),
        version: (choice.entry.version)(),
        settings: choice.builder.settings(),
        description: choice.entry.description.to_owned(),
    };
    let absent = registry::absent().into_iter();
    Record {
        format: FORMAT,
        started_unix: SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).map_or(0, |t| t.as_secs()),
        command: session.command.clone(),
        suite: Suite::this(),
        machine: Machine::here(),
        run: Some(Run {
            size: session.subject.size,
            seed: session.subject.seed,
            threads: session.options.threads,
            clock: Clock::of(session.options.threads),
            rounds: session.options.rounds,
            counters: session.options.counters,
            complete: false,
        }),
        structures: choices.iter().map(structure).collect(),
        scenes: Vec::new(),
        cells: Vec::new(),
        memory: Vec::new(),
        skipped: absent.map(|a| Skipped { id: a.id.to_owned(), reason: a.reason }).collect(),
    }
}
