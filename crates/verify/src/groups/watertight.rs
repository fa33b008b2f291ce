//! Rays from inside of closed meshes: none may get out.

use super::group::Group;
use super::subject::{Subject, Verdict};
use harness::registry::Choice;
use harness::sweeps::leaks;
use primitives::KernelId;

pub(super) const GROUPS: &[Group] = &[
    Group {
        name: "watertight/exact",
        about: "closed meshes, kernel exact",
        ask: |s| tight(s, KernelId::Exact),
    },
    Group {
        name: "watertight/watertight",
        about: "closed meshes, kernel watertight",
        ask: |s| tight(s, KernelId::Watertight),
    },
];

/// Rays in all: a third each at faces, edges and corners of two meshes at three scales. Few for those that test all objects.
fn tight(subject: &Subject, kernel: KernelId) -> Verdict {
    let rays = if subject.entry.traits.linear { 2_000 } else { 100_000 };
    let choices = [subject.choice(kernel)];
    let Choice { spec, .. } = &choices[0];
    match leaks::run(rays, 1, &choices, ()) {
        Err(error) => Verdict::Wrong { what: error.to_string() },
        Ok(tally) => {
            let wrong: u64 = tally.sums().iter().map(|(_, _, leaks)| leaks.iter().sum::<u64>()).sum();
            let failed = tally.rows.iter().find_map(|row| row.error.clone());
            match (subject.is_built_in(), failed) {
                (true, Some(what)) => Verdict::Wrong { what },
                (true, None) if wrong > 0 => Verdict::Wrong { what: format!("{spec} lets {wrong} rays out") },
                (true, None) => Verdict::Passed { checks: tally.rays },
                (false, _) => Verdict::Counted { checks: tally.rays, wrong },
            }
        }
    }
}
