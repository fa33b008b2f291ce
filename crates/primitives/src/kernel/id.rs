//! The names of kernels.

use accel::settings::one_of;

/// Names a kernel in settings and records.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum KernelId {
    /// [`MollerTrumbore`](super::MollerTrumbore)
    MollerTrumbore,
    /// [`BaldwinWeber`](super::BaldwinWeber)
    BaldwinWeber,
    /// [`Watertight`](super::Watertight)
    Watertight,
    /// [`Double`](super::Double)
    Double,
    /// [`Exact`](super::Exact)
    Exact,
    /// [`Quantised`](super::Quantised)
    Quantised,
    /// [`BoundingBox`](super::BoundingBox)
    BoundingBox,
}

impl KernelId {
    /// All kernels there are.
    pub const ALL: [Self; 7] = [
        Self::MollerTrumbore,
        Self::BaldwinWeber,
        Self::Watertight,
        Self::Double,
        Self::Exact,
        Self::Quantised,
        Self::BoundingBox,
    ];

    /// Whether it takes the scene for another one: made for what is cheaper still, and wrong by design.
    pub const fn is_lossy(self) -> bool {
        matches!(self, Self::Quantised | Self::BoundingBox)
    }

    /// Whether no ray slips between two triangles that share an edge.
    pub const fn is_watertight(self) -> bool {
        matches!(self, Self::Watertight | Self::Exact)
    }

    /// Name as used in settings and records.
    pub const fn id(self) -> &'static str {
        match self {
            Self::MollerTrumbore => "moller-trumbore",
            Self::BaldwinWeber => "baldwin-weber",
            Self::Watertight => "watertight",
            Self::Double => "double",
            Self::Exact => "exact",
            Self::Quantised => "quantised",
            Self::BoundingBox => "box",
        }
    }

    /// The kernel of that name.
    pub fn from_id(id: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kernel| kernel.id() == id)
    }

    /// A setting's value: the kernel of that name.
    ///
    /// # Errors
    /// There is none of that name; the text says which there are.
    pub fn parse(value: &str) -> Result<Self, String> {
        one_of(value, Self::ALL, |kernel| kernel.id())
    }
}

impl std::fmt::Display for KernelId {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.id())
    }
}
