//! What both grids can be told.

use crate::resolution::Resolution;
use accel::BuildError;
use accel::settings::{self, none_of};
use lanes::Level;
use primitives::KernelId;

/// Settings of a grid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// The ray-triangle test.
    pub kernel: KernelId,
    /// The instruction set.
    pub simd: Level,
    /// The rule for the number of cells.
    pub resolution: Resolution,
    /// Most bytes the grid may take; `None` for what the machine has to give.
    pub memory: Option<u128>,
}

impl Settings {
    /// Names and meanings, for help texts.
    pub const NAMES: [(&str, &str); 5] = [
        ("kernel", "ray-triangle test; quantised and box are lossy"),
        ("simd", "instruction set"),
        ("resolution", "slices per axis, as 64 or 64x32x16"),
        ("density", "cells for each object instead of a resolution"),
        ("memory", "most bytes the grid may take"),
    ];

    /// On the best instruction set, limited by the memory there is.
    pub fn new(resolution: Resolution) -> Self {
        Self { kernel: KernelId::MollerTrumbore, simd: Level::best(), resolution, memory: None }
    }

    /// Changes one setting of the structure `id`.
    ///
    /// # Errors
    /// [`BuildError::Setting`] if there is no such setting or the value makes no sense.
    pub(crate) fn set(&mut self, id: &str, name: &str, value: &str) -> Result<(), BuildError> {
        let error = |problem| BuildError::Setting { structure: id.into(), setting: name.into(), problem };
        match name {
            "kernel" => self.kernel = KernelId::parse(value).map_err(error)?,
            "simd" => self.simd = Level::parse(value).map_err(error)?,
            "resolution" => self.resolution = Resolution::parse_slices(value).map_err(error)?,
            "density" => self.resolution = Resolution::parse_density(value).map_err(error)?,
            "memory" => self.memory = Some(settings::bytes(value).map_err(error)?),
            _ => return Err(error(none_of(name, Self::NAMES.map(|(name, _)| name)))),
        }
        Ok(())
    }

    pub(crate) fn display(&self) -> String {
        let memory = self.memory.map(|bytes| format!(" memory={bytes}")).unwrap_or_default();
        format!("kernel={} simd={} {}{memory}", self.kernel, self.simd.id(), self.resolution)
    }
}
