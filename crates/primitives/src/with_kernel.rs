//! A kernel as a type.

#[cfg(feature = "exact")]
use crate::kernel::Exact;
use crate::kernel::{BaldwinWeber, BoundingBox, Double, MollerTrumbore, Quantised, Watertight};
use crate::{KernelId, TriangleKernel};

/// Code that is generic over the kernel.
pub trait WithKernel {
    /// What it computes.
    type Out;
    /// Does it with kernel `K`.
    fn kernel<K: TriangleKernel>(self) -> Self::Out;
}

impl KernelId {
    /// Calls `with` with the kernel as a type.
    #[inline]
    pub fn with<W: WithKernel>(self, with: W) -> W::Out {
        match self {
            Self::MollerTrumbore => with.kernel::<MollerTrumbore>(),
            Self::BaldwinWeber => with.kernel::<BaldwinWeber>(),
            Self::Watertight => with.kernel::<Watertight>(),
            Self::Double => with.kernel::<Double>(),
            #[cfg(feature = "exact")]
            Self::Exact => with.kernel::<Exact>(),
            Self::Quantised => with.kernel::<Quantised>(),
            Self::BoundingBox => with.kernel::<BoundingBox>(),
        }
    }
}
