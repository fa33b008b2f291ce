//! Who is asked, and what it answers.

use crate::compare::compare;
use crate::unusable;
use accel::{Accel, Hit, Ray, RaySet, Scene, Workload};
use harness::check::oracle_of;
use harness::guard::guard;
use harness::registry::{BuildFailure, Choice, Entry, StructureSpec, guarded_build};
use primitives::KernelId;
use serde::Serialize;

/// An answer to a question.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "answer", rename_all = "kebab-case")]
pub enum Verdict {
    /// All is as promised.
    Passed {
        /// Rays, builds or inputs that were looked at.
        checks: u64,
    },
    /// Something is not.
    Wrong {
        /// What.
        what: String,
    },
    /// A library that promises nothing of the kind: how many of its answers are not the true ones.
    Counted {
        /// Answers looked at.
        checks: u64,
        /// Those that are not true.
        wrong: u64,
    },
    /// The question makes no sense here.
    NotAsked {
        /// Why.
        why: &'static str,
    },
}

impl Verdict {
    /// Passed, or what is wrong.
    pub(super) fn of(checked: Result<u64, String>) -> Self {
        match checked {
            Ok(checks) => Self::Passed { checks },
            Err(what) => Self::Wrong { what },
        }
    }

    /// Both questions as one.
    pub(super) fn and(self, other: Self) -> Self {
        match (self, other) {
            (Self::Passed { checks: a }, Self::Passed { checks: b }) => Self::Passed { checks: a + b },
            (Self::Counted { checks: a, wrong: x }, Self::Counted { checks: b, wrong: y }) => {
                Self::Counted { checks: a + b, wrong: x + y }
            }
            (wrong @ Self::Wrong { .. }, _) | (_, wrong @ Self::Wrong { .. }) => wrong,
            (not @ Self::NotAsked { .. }, _) | (_, not) => not,
        }
    }
}

/// A structure that is asked.
#[derive(Clone, Copy)]
pub struct Subject {
    /// What is known of it.
    pub entry: &'static Entry,
}

impl Subject {
    pub(super) fn new(entry: &'static Entry) -> Self {
        Self { entry }
    }

    pub(super) fn is_built_in(&self) -> bool {
        self.entry.traits.built_in
    }

    /// The structure with this kernel, if it takes one, and a setting.
    pub(super) fn spec(&self, kernel: KernelId, setting: Option<(&str, &str)>) -> StructureSpec {
        let mut spec = StructureSpec::plain(self.entry.id);
        if self.is_built_in() {
            spec = spec.with_default("kernel", kernel);
        }
        match setting {
            Some((name, value)) => spec.with(name, value),
            None => spec,
        }
    }

    pub(super) fn choice(&self, kernel: KernelId) -> Choice {
        Choice::of(self.entry, &self.spec(kernel, None)).expect("settings that the structure has")
    }

    pub(super) fn takes(&self, setting: &str) -> bool {
        self.entry.settings.iter().any(|(name, _)| *name == setting)
    }

    pub(super) fn build<'s>(&self, scene: &'s Scene) -> Result<Box<dyn Accel + 's>, BuildFailure> {
        self.build_with(scene, KernelId::Exact)
    }

    pub(super) fn build_with<'s>(
        &self,
        scene: &'s Scene,
        kernel: KernelId,
    ) -> Result<Box<dyn Accel + 's>, BuildFailure> {
        guarded_build(&self.choice(kernel), scene, &Workload::GENERAL)
    }

    /// Holds it to brute force and the oracle on these rays; of a library it is counted how often it is wrong.
    pub(super) fn holds(&self, scene: &Scene, rays: &[Ray], kernel: KernelId) -> Verdict {
        if self.is_built_in() {
            let spec = self.spec(kernel, None).to_string();
            let compared = compare(scene, rays, &spec, rays.len().min(256));
            return Verdict::of(compared.map(|done| done.rays).map_err(|difference| difference.to_string()));
        }
        let mut hits = vec![None; rays.len()];
        let set = RaySet::List(rays.to_vec());
        let traced = match self.build(scene) {
            Ok(built) => guard("tracing", || built.trace(&set, &mut hits)).map_err(|panic| panic.to_string()),
            Err(failure) => Err(failure.to_string()),
        };
        if traced.is_err() {
            return Verdict::Counted { checks: rays.len() as u64, wrong: rays.len() as u64 };
        }
        let oracle = oracle_of(scene);
        let is_wrong = |(ray, hit): &(&Ray, &Option<Hit>)| {
            oracle.closest(ray).map(|(object, _)| object) != hit.map(|hit| hit.object)
        };
        let wrong = rays.iter().zip(&hits).filter(is_wrong).count() as u64;
        Verdict::Counted { checks: rays.len() as u64, wrong }
    }

    /// Whether none of these rays hits anything and tracing them ends, together and one by one.
    pub(super) fn hits_nothing(&self, scene: &Scene, rays: &[Ray]) -> Verdict {
        let (checks, set) = (rays.len() as u64, RaySet::List(rays.to_vec()));
        let found = match self.build(scene) {
            Ok(built) => {
                guard("tracing", || unusable::hits(&*built, &set)).map_err(|panic| panic.to_string())
            }
            Err(failure) => Err(failure.to_string()),
        };
        match (self.is_built_in(), found) {
            (true, Ok(0)) => Verdict::Passed { checks },
            (true, Ok(found)) => Verdict::Wrong { what: format!("{found} of {checks} rays hit") },
            (true, Err(what)) => Verdict::Wrong { what },
            (false, found) => Verdict::Counted { checks, wrong: found.unwrap_or(checks) },
        }
    }
}
