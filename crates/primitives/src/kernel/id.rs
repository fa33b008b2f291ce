//! The names of kernels.

use accel::settings::one_of;

/// Names a kernel in settings and records.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[non_exhaustive]
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
    #[cfg(feature = "exact")]
    Exact,
    /// [`Quantised`](super::Quantised)
    Quantised,
    /// [`BoundingBox`](super::BoundingBox)
    BoundingBox,
}

/// See the functions of [`KernelId`] of the same names.
struct Traits {
    id: &'static str,
    lossy: bool,
    watertight: bool,
    tried: bool,
    recommended: bool,
}

impl KernelId {
    /// All kernels there are.
    pub const ALL: [Self; 6 + cfg!(feature = "exact") as usize] = [
        Self::MollerTrumbore,
        Self::BaldwinWeber,
        Self::Watertight,
        Self::Double,
        #[cfg(feature = "exact")]
        Self::Exact,
        Self::Quantised,
        Self::BoundingBox,
    ];

    /// All that lists, choices and recommendations know of it.
    const fn traits(self) -> Traits {
        const OTHER: Traits =
            Traits { id: "", lossy: false, watertight: false, tried: false, recommended: false };
        match self {
            Self::MollerTrumbore => Traits { id: "moller-trumbore", tried: true, recommended: true, ..OTHER },
            Self::BaldwinWeber => Traits { id: "baldwin-weber", tried: true, ..OTHER },
            Self::Watertight => {
                Traits { id: "watertight", watertight: true, tried: true, recommended: true, ..OTHER }
            }
            // It costs more than the exact one and is not proven.
            Self::Double => Traits { id: "double", ..OTHER },
            #[cfg(feature = "exact")]
            Self::Exact => Traits { id: "exact", watertight: true, tried: true, recommended: true, ..OTHER },
            Self::Quantised => Traits { id: "quantised", lossy: true, recommended: true, ..OTHER },
            Self::BoundingBox => Traits { id: "box", lossy: true, ..OTHER },
        }
    }

    /// Whether it takes the scene for another one: made for what is cheaper still, and wrong by design.
    pub const fn is_lossy(self) -> bool {
        self.traits().lossy
    }

    /// Whether no ray slips between two triangles that share an edge.
    pub const fn is_watertight(self) -> bool {
        self.traits().watertight
    }

    /// Whether it is tried where the kernel is left to the suite.
    pub const fn is_tried(self) -> bool {
        self.traits().tried
    }

    /// Whether it is tried with every structure where one is to be recommended.
    pub const fn is_recommended(self) -> bool {
        self.traits().recommended
    }

    /// Name as used in settings and records.
    pub const fn id(self) -> &'static str {
        self.traits().id
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
