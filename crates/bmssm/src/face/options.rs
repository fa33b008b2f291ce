//! How a structure is built.

use crate::fast::Settings;
use lanes::Level;
use primitives::KernelId;

/// Settings of a structure, and the way to build it with them.
///
/// ```
/// use bmssm::{Bmssm, Kernel};
///
/// let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
/// let options = Bmssm::options().kernel(Kernel::Watertight).memory_limit(1 << 30);
/// let bmssm = options.build(&positions, &[[0, 1, 2]])?;
/// # assert!(bmssm.footprint().total() < 1 << 30);
/// # Ok::<(), bmssm::BuildError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[must_use]
pub struct Options {
    pub(super) settings: Settings,
}

impl Options {
    /// The ray-triangle intersector: Möller–Trumbore unless told otherwise. Objects of other kinds bring their own.
    pub fn kernel(mut self, kernel: KernelId) -> Self {
        self.settings.kernel = kernel;
        self
    }

    /// The instruction set: the widest that the machine has unless told otherwise. One that it lacks is replaced by
    /// plain Rust. The hits are the same with all of them.
    pub fn simd(mut self, simd: Level) -> Self {
        self.settings.simd = simd;
        self
    }

    /// Most bytes that the structure may take: what the machine has available unless told otherwise.
    pub fn memory_limit(mut self, bytes: u64) -> Self {
        self.settings.memory = Some(bytes.into());
        self
    }
}
