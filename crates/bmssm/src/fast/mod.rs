//! `bmssm`: the fast structure. One image is served by maps in image space ([`crate::raster`]), all
//! other rays by blocks with maps of their own ([`crate::general`]); only what the workload names is
//! built.

mod plan;
mod serve;
mod settings;

pub use crate::general::Storage;
pub use plan::Plan;
pub use settings::Settings;

use crate::id::ID;
use accel::{Accel, BuildError, Builder, Cancel, Scene, Workload};
use lanes::PackedObjects;
use primitives::WithObjects;
use serve::Built;

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
        self.build_unless(scene, workload, Cancel::NEVER)
    }

    fn build_unless<'s>(
        &self,
        scene: &'s Scene,
        workload: &Workload,
        cancel: Cancel,
    ) -> Result<Box<dyn Accel + 's>, BuildError> {
        let build = Build { settings: self.settings, workload: *workload, cancel };
        primitives::with_objects(scene, self.settings.kernel, build)
    }
}

/// Builds for objects of any kind.
pub(crate) struct Build<'c> {
    pub settings: Settings,
    pub workload: Workload,
    pub cancel: Cancel<'c>,
}

impl<'s> WithObjects<'s> for Build<'_> {
    type Out = Result<Box<dyn Accel + 's>, BuildError>;

    fn objects<O: PackedObjects + 's>(self, objects: O) -> Self::Out {
        let limit = self.settings.memory.unwrap_or_else(accel::available_memory);
        let plan = Plan::new(&self.settings, objects.len(), &self.workload, limit, O::bytes_of_blocks);
        if plan.beside > limit {
            return Err(BuildError::TooLarge { structure: ID.into(), bytes: plan.beside, limit });
        }
        Ok(Box::new(Built::new(objects, plan, limit, self.cancel)?))
    }
}

#[cfg(test)]
mod tests;
