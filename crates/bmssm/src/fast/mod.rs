//! `bmssm`: the fast structure. One image is served by maps in image space ([`crate::raster`]), all
//! other rays by blocks with maps of their own ([`crate::general`]); only what the workload names is
//! built.

mod plan;
mod serve;
mod settings;

pub use crate::general::Storage;
pub use plan::Plan;
pub use settings::Settings;

use accel::{Accel, BuildError, Builder, Scene, Workload};
use lanes::PackedObjects;
use primitives::WithObjects;
use serve::Built;

const ID: &str = "bmssm";

/// Builds `bmssm`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bmssm {
    /// The settings.
    pub settings: Settings,
}

impl Bmssm {
    /// Changes one setting, see [`Settings::NAMES`].
    ///
    /// # Errors
    /// [`BuildError::Setting`] if there is no such setting or the value makes no sense.
    pub fn set(&mut self, name: &str, value: &str) -> Result<(), BuildError> {
        self.settings.set(name, value).map_err(|problem| BuildError::Setting {
            structure: ID.into(),
            setting: name.into(),
            problem,
        })
    }
}

impl Builder for Bmssm {
    fn id(&self) -> &str {
        ID
    }

    fn settings(&self) -> String {
        self.settings.to_string()
    }

    fn build<'s>(&self, scene: &'s Scene, workload: &Workload) -> Result<Box<dyn Accel + 's>, BuildError> {
        let build = Build { settings: self.settings, workload: *workload };
        primitives::with_objects(scene, self.settings.kernel, build)
    }
}

/// Builds for objects of any kind.
pub(crate) struct Build {
    pub settings: Settings,
    pub workload: Workload,
}

impl<'s> WithObjects<'s> for Build {
    type Out = Result<Box<dyn Accel + 's>, BuildError>;

    fn objects<O: PackedObjects + 's>(self, objects: O) -> Self::Out {
        let limit = self.settings.memory.unwrap_or_else(accel::available_memory);
        let plan = Plan::new(&self.settings, objects.len(), &self.workload, limit, O::bytes_of_blocks);
        let too_large = |bytes| BuildError::TooLarge { structure: ID.into(), bytes, limit };
        if plan.beside > limit {
            return Err(too_large(plan.beside));
        }
        Ok(Box::new(Built::new(objects, plan, limit).map_err(too_large)?))
    }
}

#[cfg(test)]
mod tests;
