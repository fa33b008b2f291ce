//! What verbs that run structures choose from: scenes, ray sets, structures, kernel.

use super::camera::CameraOptions;
use super::kernel::KernelOptions;
use super::names::{ray_sets, structures};
use crate::error::Error;
use clap::Args;
use harness::registry::{Choice, RegistryError, StructureSpec};
use scenes::SceneSpec;
use scenes::rays::RaysId;

/// Filters of what is run.
#[derive(Clone, Debug, Default, Args)]
pub struct Selection {
    /// A scene by id, or an OBJ, PLY or TOML file; may be repeated. The default set otherwise
    #[arg(long = "scene", value_name = "SCENE", value_delimiter = ';')]
    pub scenes: Vec<String>,
    /// A ray set; may be repeated. All that are for measuring otherwise
    #[arg(long = "rays", value_name = "RAYS", value_delimiter = ',', value_parser = ray_sets(), hide_possible_values = true)]
    pub rays: Vec<String>,
    /// A structure, with settings as `id:name=value,name=value`; may be repeated. All otherwise
    #[arg(long = "structure", value_name = "ID", value_parser = structures(), hide_possible_values = true)]
    pub structures: Vec<String>,
    #[command(flatten)]
    pub camera: CameraOptions,
    #[command(flatten)]
    pub kernel: KernelOptions,
    /// Rows and columns of rasters; lists have as many rays. 256, or what fits a full run
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=8192))]
    pub size: Option<u32>,
    /// Seed of lists of rays
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub seed: u64,
}

impl Selection {
    /// Names of scenes that can be read, the default set if none was chosen.
    ///
    /// # Errors
    /// A scene that is not known, or a file that holds none.
    pub fn scenes(&self) -> Result<Vec<String>, Error> {
        let named: Vec<String> = self.scenes.iter().map(|scene| self.camera.named(scene)).collect();
        for name in &named {
            let spec: SceneSpec = name.parse()?;
            match &spec.source {
                scenes::Source::Id(id) => drop(scenes::describe(id)?),
                // Read twice, so that a slip in the last file costs no measurement of the first.
                scenes::Source::Definition(_) | scenes::Source::Mesh(_) => drop(scenes::load(&spec)?),
            }
        }
        if !named.is_empty() {
            return Ok(named);
        }
        let default = scenes::list().into_iter().filter(|info| info.default);
        Ok(default.map(|info| self.camera.named(&info.id)).collect())
    }

    /// The ray sets chosen, or `otherwise`.
    ///
    /// # Errors
    /// A ray set that is not known.
    pub fn rays(&self, otherwise: impl IntoIterator<Item = RaysId>) -> Result<Vec<RaysId>, Error> {
        if self.rays.is_empty() {
            return Ok(otherwise.into_iter().collect());
        }
        let all = RaysId::ALL.map(RaysId::name);
        let find = |name: &String| name.parse().map_err(|_| Error::unknown("ray set", name, all));
        self.rays.iter().map(find).collect()
    }

    /// The structures chosen, or `otherwise`, with the kernel chosen.
    ///
    /// # Errors
    /// Structures, settings or kernels that are not known.
    pub fn structures(&self, otherwise: &[StructureSpec]) -> Result<Vec<Choice>, Error> {
        let asked: Result<Vec<StructureSpec>, RegistryError> =
            self.structures.iter().map(|s| s.parse()).collect();
        let asked = asked.map_err(Error::from)?;
        let specs = if asked.is_empty() { otherwise } else { &asked };
        self.kernel.choose_all(specs)
    }
}
