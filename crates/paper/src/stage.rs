//! The stages of the reproduction.

use std::fmt;

/// What comes next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Operations and costs.
    CostModel,
    /// Objects that are left to test.
    Candidates,
    /// Times against the other methods.
    Speed,
    /// What it costs to make maps, and slices in depth.
    SetUp,
    /// Secondary rays.
    Secondary,
    /// Memory by formulas and as built.
    Memory,
    /// Large objects cut up.
    Split,
    /// Objects that no ray of an image can hit.
    Consistency,
}

impl fmt::Display for Stage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::CostModel => "Table 1 and the cost model",
            Self::Candidates => "Tables 6 and 7: candidates",
            Self::Speed => "Tables 2 to 5: speed",
            Self::SetUp => "set-up, and slices in depth",
            Self::Secondary => "secondary rays",
            Self::Memory => "memory",
            Self::Split => "large objects split",
            Self::Consistency => "image consistency",
        })
    }
}
