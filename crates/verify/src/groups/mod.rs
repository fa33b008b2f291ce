//! A named tree of questions, each asked of every structure: after the groups of Embree's own `verify`.

mod builds;
mod geometry;
mod group;
mod rays;
mod subject;
mod watertight;

pub use group::Group;
pub use subject::{Subject, Verdict};

use harness::registry;
use serde::Serialize;

/// All questions, branch by branch.
pub fn all() -> Vec<Group> {
    [watertight::GROUPS, geometry::GROUPS, rays::GROUPS, builds::GROUPS].concat()
}

/// An answer.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct VerdictRow {
    /// The question's name.
    pub group: &'static str,
    /// The structure.
    pub structure: &'static str,
    /// The answer.
    pub verdict: Verdict,
}

/// All answers.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Verification {
    /// By question, then by structure.
    pub rows: Vec<VerdictRow>,
}

impl Verification {
    /// Whether no structure fails in what it promises.
    pub fn is_sound(&self) -> bool {
        self.rows.iter().all(|row| !matches!(row.verdict, Verdict::Wrong { .. }))
    }
}

/// Asks every question whose name holds `pattern` of every structure of this program, or of those named; `begun` hears
/// of each question.
pub fn run(pattern: &str, structures: &[String], mut begun: impl FnMut(&Group)) -> Verification {
    let mut verification = Verification::default();
    for group in all().into_iter().filter(|group| group.name.contains(pattern)) {
        begun(&group);
        let wanted = |id: &str| structures.is_empty() || structures.iter().any(|name| name == id);
        for entry in registry::entries().iter().filter(|entry| wanted(entry.id)) {
            let verdict = (group.ask)(&Subject::new(entry));
            verification.rows.push(VerdictRow { group: group.name, structure: entry.id, verdict });
        }
    }
    verification
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_a_tree_and_answers_are_complete() {
        let names: Vec<&str> = all().iter().map(|group| group.name).collect();
        assert!(names.iter().all(|name| name.split('/').count() == 2));
        let mut once = names.clone();
        once.dedup();
        assert_eq!(names, once);
        let asked = run("geometry/empty", &[], |_| ());
        assert_eq!(asked.rows.len(), registry::entries().len());
        assert!(asked.is_sound(), "{asked:#?}");
    }

    #[test]
    fn small_groups_pass() {
        let own = ["ssm", "bmssm", "ssm-list", "bmssm-dense"].map(str::to_owned);
        for pattern in ["geometry/", "rays/inactive", "rays/nan", "rays/all-hits", "builds/cancelled"] {
            let asked = run(pattern, &own, |_| ());
            assert!(asked.is_sound() && !asked.rows.is_empty(), "{asked:#?}");
        }
    }
}
