//! Going on with a record that an earlier run left.

use super::session::{Session, begin};
use crate::record::Record;
use crate::registry::Choice;

/// Why figures of a record can't stand beside new ones. The text says what differs.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ResumeError {
    /// The record does not say how it was made.
    #[error("it does not say the size and seed of its ray sets: an older version made it")]
    Unsaid,
    /// Something that figures depend on is not as it was.
    #[error("its {what} was `{before}` and is `{now}` here: the figures would not be comparable")]
    Differs {
        /// What differs.
        what: String,
        /// In the record.
        before: String,
        /// Now.
        now: String,
    },
}

fn same(what: &str, before: impl ToString, now: impl ToString) -> Result<(), ResumeError> {
    let (before, now) = (before.to_string(), now.to_string());
    if before == now {
        return Ok(());
    }
    Err(ResumeError::Differs { what: what.to_owned(), before, now })
}

/// The record to go on with: what is in `old` stays, what `session` and `choices` add is announced.
///
/// The amount of main memory and the number of rounds may differ, for they change no figure that is there already.
///
/// # Errors
/// Where the program, the machine, the rays or the version or settings of a structure differ.
pub fn resume(old: Record, session: &Session, choices: &[Choice]) -> Result<Record, ResumeError> {
    let new = begin(session, choices);
    let (before, now) = (old.run.as_ref().ok_or(ResumeError::Unsaid)?, new.run.as_ref());
    let now = now.ok_or(ResumeError::Unsaid)?;
    same("version", &old.suite.version, &new.suite.version)?;
    same("commit", &old.suite.git, &new.suite.git)?;
    same("build profile", &old.suite.profile, &new.suite.profile)?;
    same("compiler", &old.suite.rustc, &new.suite.rustc)?;
    same("list of compiler flags", &old.suite.rustflags, &new.suite.rustflags)?;
    same("processor", &old.machine.cpu, &new.machine.cpu)?;
    same("instruction set", &old.machine.isa, &new.machine.isa)?;
    same("number of cores", old.machine.cores, new.machine.cores)?;
    same("operating system", &old.machine.os, &new.machine.os)?;
    same("flushing of denormal results", old.machine.flush_to_zero, new.machine.flush_to_zero)?;
    same("treatment of denormal operands", old.machine.denormals_are_zero, new.machine.denormals_are_zero)?;
    same("size of rasters", before.size, now.size)?;
    same("seed", before.seed, now.seed)?;
    same("number of threads", before.threads, now.threads)?;
    same("counting of steps", before.counters, now.counters)?;
    let mut record = old;
    for structure in new.structures {
        match record.structures.iter().find(|known| known.id == structure.id) {
            Some(known) => {
                same(&format!("version of {}", known.id), &known.version, &structure.version)?;
                same(&format!("list of settings of {}", known.id), &known.settings, &structure.settings)?;
            }
            None => record.structures.push(structure),
        }
    }
    if let Some(run) = &mut record.run {
        run.complete = false;
    }
    record.skipped.retain(|skipped| !new.skipped.contains(skipped));
    record.skipped.extend(new.skipped);
    if record.command != new.command {
        record.command = format!("{} && {}", record.command, new.command);
    }
    Ok(record)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::{Deadline, run};
    use crate::record::Skipped;
    use crate::registry;
    use crate::workload::Subject;
    use scenes::rays::RaysId;
    use std::sync::Arc;
    use std::sync::atomic::{AtomicBool, Ordering::Relaxed};

    fn session(size: u32) -> Session {
        let (scenes, rays) = (vec!["unit-one".to_owned()], vec![RaysId::Random]);
        let subject = Subject { scenes, rays, size, seed: 1 };
        Session { subject, command: "rayscale measure".to_owned(), ..Session::default() }
    }

    /// Two ray sets, and what stops the run.
    fn stoppable() -> (Session, Arc<AtomicBool>) {
        let mut session = session(16);
        session.subject.rays = vec![RaysId::Random, RaysId::Parallel];
        let flag = Arc::new(AtomicBool::new(false));
        session.deadline = Deadline::new(flag.clone(), None);
        (session, flag)
    }

    fn choices(ids: &[&str]) -> Vec<Choice> {
        ids.iter().map(|id| registry::parse(id).unwrap()).collect()
    }

    #[test]
    fn what_figures_depend_on_must_be_equal() {
        let record = begin(&session(16), &choices(&["ssm"]));
        let refusal = |change: &dyn Fn(&mut Record)| {
            let mut old = record.clone();
            change(&mut old);
            resume(old, &session(16), &choices(&["ssm"])).err().map(|e| e.to_string()).unwrap_or_default()
        };
        assert_eq!(refusal(&|_| ()), "");
        assert_eq!(refusal(&|old| old.machine.memory_bytes += 1), "");
        for (says, change) in [
            ("does not say", &(|old: &mut Record| old.run = None) as &dyn Fn(&mut Record)),
            ("commit was `none`", &|old| old.suite.git = "none".into()),
            ("processor was `Z80`", &|old| old.machine.cpu = "Z80".into()),
            ("seed was `2` and is `1`", &|old| old.run.as_mut().unwrap().seed = 2),
            ("size of rasters was `17`", &|old| old.run.as_mut().unwrap().size = 17),
            ("number of threads", &|old| old.run.as_mut().unwrap().threads = 9),
            ("version of ssm was `0`", &|old| old.structures[0].version = "0".into()),
        ] {
            assert!(refusal(change).contains(says), "`{}` should say `{says}`", refusal(change));
        }
    }

    #[test]
    fn structures_may_be_added_and_what_was_left_out_is_tried_again() {
        let mut old = begin(&session(16), &choices(&["ssm"]));
        let skipped = |id: &str| Skipped { id: id.into(), reason: "the time was up".into() };
        old.skipped.extend(["unit-one", "unit-one/random", "elsewhere"].map(skipped));
        let session = session(16);
        let choices = choices(&["ssm", "minmax"]);
        let record = resume(old, &session, &choices).unwrap();
        assert_eq!(record.structure_ids(), ["ssm", "minmax"]);
        let record = run(&session, &choices, record, (), |_| ()).unwrap();
        let ids: Vec<_> = record.skipped.iter().map(|s| s.id.as_str()).collect();
        assert!(ids.contains(&"elsewhere") && !ids.iter().any(|id| id.starts_with("unit-one")), "{ids:?}");
        assert!(record.cells.len() == 2 && record.run.unwrap().complete);
    }

    #[test]
    fn what_is_there_is_not_measured_again_and_a_changed_scene_is_refused() {
        let (session, one, two) = (session(16), choices(&["ssm"]), choices(&["ssm", "minmax"]));
        let first = run(&session, &one, begin(&session, &one), (), |_| ()).unwrap();
        let again = resume(first.clone(), &session, &two).unwrap();
        let second = run(&session, &two, again, (), |_| ()).unwrap();
        assert_eq!(second.cells[..1], first.cells[..]);
        assert_eq!(second.cells.len(), 2);
        let mut other = resume(first, &session, &one).unwrap();
        other.scenes[0].checksum = "00".into();
        let refused = run(&session, &one, other, (), |_| ()).unwrap_err().to_string();
        assert!(refused.contains("checksum of scene unit-one"), "{refused}");
    }

    #[test]
    fn an_interruption_leaves_whole_ray_sets() {
        let (session, flag) = stoppable();
        let choices = choices(&["ssm", "minmax"]);
        let stop = |_: &Record| flag.store(true, Relaxed);
        let record = run(&session, &choices, begin(&session, &choices), (), stop).unwrap();
        assert_eq!(record.cells.len(), 2);
        assert!(!record.run.unwrap().complete);
    }

    #[test]
    fn passes_that_are_lacking_are_added() {
        let (session, flag) = stoppable();
        let choices = choices(&["ssm", "minmax"]);
        let stop = |record: &Record| {
            let again = record.cells[0].passes.len() == 2;
            flag.store(again, Relaxed);
        };
        let begun = run(&session, &choices, begin(&session, &choices), (), stop).unwrap();
        let passes = |record: &Record| record.cells.iter().map(|c| c.passes.len()).collect::<Vec<_>>();
        assert_eq!(passes(&begun), [2, 2, 1, 1]);
        assert!(!begun.run.unwrap().complete);
        flag.store(false, Relaxed);
        let whole = resume(begun.clone(), &session, &choices).unwrap();
        let whole = run(&session, &choices, whole, (), |_| ()).unwrap();
        assert_eq!(passes(&whole), [3; 4]);
        for (before, after) in begun.cells.iter().zip(&whole.cells) {
            assert_eq!(after.trace_ns[..before.trace_ns.len()], before.trace_ns);
            assert_eq!(after.trace_ns.len(), after.passes.iter().sum::<usize>());
        }
    }

    #[test]
    fn without_time_everything_is_named_as_left_out() {
        let session =
            Session { deadline: Deadline::new(Default::default(), Some(Default::default())), ..session(16) };
        let choices = choices(&["ssm"]);
        let record = run(&session, &choices, begin(&session, &choices), (), |_| ()).unwrap();
        assert!(record.cells.is_empty() && record.skipped.iter().any(|s| s.id == "unit-one"));
    }
}
