//! Which ray-triangle test a chosen structure uses, and who chose it.

use super::{Choice, Entry, RegistryError, Settings, StructureSpec};
use crate::record::Intersector;
use accel::{Accel, BuildError, Builder, Scene, Workload};
use judge::Limits;
use primitives::KernelId;
use std::sync::Arc;

/// The value of the setting `kernel` that leaves the choice to the suite.
pub const AUTO: &str = "auto";

/// A structure's ray-triangle test.
#[derive(Clone, Debug, PartialEq)]
pub enum ChosenKernel {
    /// An external structure's.
    External,
    /// One of the suite's, as the user said or by default.
    Given(KernelId),
    /// To be decided for a scene and its rays.
    Auto {
        /// What errors are put up with.
        limits: Limits,
    },
    /// Decided.
    Decided {
        /// The kernel.
        kernel: KernelId,
        /// Why, in words.
        reason: String,
    },
}

impl ChosenKernel {
    pub(super) fn of(entry: &Entry, spec: &StructureSpec) -> Self {
        match spec.get("kernel") {
            _ if !entry.traits.built_in => Self::External,
            Some(AUTO) => Self::Auto { limits: Limits::default() },
            given => Self::Given(given.and_then(KernelId::from_id).unwrap_or(KernelId::MollerTrumbore)),
        }
    }

    pub(super) fn name(&self) -> &'static str {
        match self {
            Self::External => "own",
            Self::Auto { .. } => AUTO,
            Self::Given(kernel) | Self::Decided { kernel, .. } => kernel.id(),
        }
    }

    pub(super) fn reason(&self) -> &str {
        match self {
            Self::Decided { reason, .. } => reason,
            Self::Given(kernel) if kernel.is_lossy() => {
                "lossy, as asked for: it takes the scene for another one"
            }
            _ => "",
        }
    }

    /// A builder for `spec` with this kernel.
    pub(super) fn builder(
        &self,
        entry: &Entry,
        spec: &StructureSpec,
    ) -> Result<Arc<dyn Builder>, RegistryError> {
        let make = |spec: &StructureSpec| (entry.make)(&Settings::new(spec, entry.settings)?);
        match self {
            Self::External | Self::Given(_) => Ok(Arc::from(make(spec)?)),
            Self::Decided { kernel, .. } => Ok(Arc::from(make(&spec.with("kernel", kernel.id()))?)),
            // Made once all the same, so that slips in other settings are found.
            Self::Auto { .. } => {
                let standard = KernelId::MollerTrumbore.id();
                Ok(Arc::new(Undecided { inner: make(&spec.with("kernel", standard))?, standard }))
            }
        }
    }
}

impl Choice {
    /// The kernel of the brute force that answers are compared with: the structure's, or Möller–Trumbore for one
    /// that brings its own.
    pub fn reference_kernel(&self) -> KernelId {
        self.built_in_kernel().unwrap_or(KernelId::MollerTrumbore)
    }

    /// The suite's kernel that is used; none where the structure brings its own or none is decided yet.
    pub fn built_in_kernel(&self) -> Option<KernelId> {
        match self.kernel {
            ChosenKernel::Given(kernel) | ChosenKernel::Decided { kernel, .. } => Some(kernel),
            ChosenKernel::External | ChosenKernel::Auto { .. } => None,
        }
    }

    /// The intersector as records name it.
    pub fn intersector(&self) -> Intersector {
        Intersector::from(self.kernel().to_owned())
    }

    /// Whether the kernel is left to the suite and not decided yet.
    pub fn is_undecided(&self) -> bool {
        matches!(self.kernel, ChosenKernel::Auto { .. })
    }

    /// The same structure with a kernel that was chosen for the user.
    ///
    /// # Panics
    /// If the structure brings its own kernel.
    #[must_use]
    pub fn decided(&self, kernel: KernelId, reason: String) -> Self {
        let kernel = ChosenKernel::Decided { kernel, reason };
        let builder = kernel.builder(self.entry, &self.spec).expect("only the kernel is another");
        Self { kernel, builder, ..self.clone() }
    }
}

/// Stands for the builder until the kernel is known.
struct Undecided {
    inner: Box<dyn Builder>,
    standard: &'static str,
}

impl Builder for Undecided {
    fn id(&self) -> &str {
        self.inner.id()
    }

    fn settings(&self) -> String {
        self.inner.settings().replace(&format!("kernel={}", self.standard), "kernel=auto")
    }

    fn build<'s>(&self, _: &'s Scene, _: &Workload) -> Result<Box<dyn Accel + 's>, BuildError> {
        Err(BuildError::Setting {
            structure: self.id().to_owned(),
            setting: "kernel".to_owned(),
            problem: "`auto` has to be decided for a scene and its rays first".to_owned(),
        })
    }
}
