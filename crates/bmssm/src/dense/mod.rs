//! `bmssm-dense`: the paper as it stands (Skala 1993, §2, §4, §5 and appendix), plain bit vectors for each
//! slice.
//!
//! The primary rays of a raster take the maps of its rows and columns ([`ImageMaps`]), all other rays
//! those of slices along x, y and z ([`SpaceMaps`]) and a walk from cell to cell. Only what the
//! workload names is built.

mod all;
mod axis;
mod detail;
mod image;
mod levels;
mod resolution;
mod settings;
mod space;
mod trace;

pub use axis::Axis;
pub use image::{Coverage, ImageMaps};
pub use resolution::Resolution;
pub use settings::{Loop, Settings};
pub use space::SpaceMaps;

use accel::grid::Grid;
use accel::{Accel, Bounds, BuildError, Builder, Scene, Workload};
use detail::{Appendix, Detail, Words};
use lanes::PackedObjects;
use primitives::WithObjects;
use trace::Built;

const ID: &str = "bmssm-dense";

/// Builds `bmssm-dense`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BmssmDense {
    /// The settings.
    pub settings: Settings,
}

impl BmssmDense {
    /// Changes one setting, see [`Settings::NAMES`].
    ///
    /// # Errors
    /// [`BuildError::Setting`] if there is no such setting or the value makes no sense.
    pub fn set(&mut self, name: &str, value: &str) -> Result<(), BuildError> {
        self.settings.set(name, value).map_err(|problem| setting(name, problem))
    }
}

impl Builder for BmssmDense {
    fn id(&self) -> &str {
        ID
    }

    fn settings(&self) -> String {
        self.settings.to_string()
    }

    fn build<'s>(&self, scene: &'s Scene, workload: &Workload) -> Result<Box<dyn Accel + 's>, BuildError> {
        primitives::with_objects(scene, self.settings.kernel, Build(self.settings, *workload))
    }
}

struct Build(Settings, Workload);

impl<'s> WithObjects<'s> for Build {
    type Out = Result<Box<dyn Accel + 's>, BuildError>;

    fn objects<O: PackedObjects + 's>(self, objects: O) -> Self::Out {
        let Self(settings, workload) = self;
        let mut order = accel::reserved(ID, objects.len())?;
        order.extend(0..objects.len() as u32);
        let maps = Maps::new(&objects.shape(), &settings, &workload)?;
        Ok(match settings.walk {
            Loop::Appendix => Box::new(maps.with(objects, Appendix(objects), &settings, &workload)),
            Loop::Words => {
                let blocks = objects.blocks(ID, &order)?;
                Box::new(maps.with(objects, Words(blocks), &settings, &workload))
            }
        })
    }
}

/// The maps that a workload asks for.
struct Maps {
    objects: usize,
    image: Option<ImageMaps>,
    space: Option<SpaceMaps>,
}

impl Maps {
    fn new<B: Bounds>(objects: &B, settings: &Settings, workload: &Workload) -> Result<Self, BuildError> {
        settings.resolution.check().map_err(|problem| setting("resolution", problem))?;
        let grid = (workload.general && !objects.is_empty())
            .then(|| {
                let bounds = objects.hull();
                Grid::new(bounds, settings.resolution.slices(objects, &bounds))
            })
            .transpose()
            .map_err(|error| setting("resolution", error.to_string()))?;
        let bytes_of = if settings.levels { SpaceMaps::bytes_of_levels } else { SpaceMaps::bytes_of };
        let bytes = workload.raster.map_or(0, |raster| ImageMaps::bytes_of(&raster, objects.len()))
            + grid.map_or(0, |grid| bytes_of(grid.resolution(), objects.len()));
        let limit = settings.memory.unwrap_or_else(accel::available_memory);
        if bytes > limit {
            return Err(BuildError::TooLarge { structure: ID.into(), bytes, limit });
        }
        let image = workload.raster.map(|raster| ImageMaps::try_new(objects, raster)).transpose()?;
        let space = grid.map(|grid| SpaceMaps::try_new(objects, grid)).transpose()?;
        let space = if settings.levels { space.map(SpaceMaps::with_levels).transpose()? } else { space };
        Ok(Self { objects: objects.len(), image, space })
    }

    fn with<O, D: Detail>(self, all: O, detail: D, settings: &Settings, workload: &Workload) -> Built<O, D> {
        let Self { objects, image, space } = self;
        let plan = plan(image.as_ref(), space.as_ref());
        let (simd, mailbox, general) = (settings.simd, settings.mailbox, workload.general);
        Built { all, detail, image, space, objects, simd, mailbox, general, plan }
    }
}

fn plan(image: Option<&ImageMaps>, space: Option<&SpaceMaps>) -> String {
    let mut lines = Vec::new();
    if let Some(maps) = image {
        let unseen = maps.coverage().unseen().len();
        lines.push(format!(
            "{} rows + {} columns; {unseen} of {} objects can't be hit by any ray of the image",
            maps.rows.len(),
            maps.cols.len(),
            maps.rows.objects()
        ));
    }
    if let Some(maps) = space {
        let [x, y, z] = maps.grid.resolution();
        let levels = match maps.above.len() {
            0 => String::new(),
            above => format!(", {above} levels of maps above"),
        };
        lines.push(format!("{x} × {y} × {z} slices{levels}"));
    }
    lines.join("\n")
}

fn setting(name: &str, problem: String) -> BuildError {
    BuildError::Setting { structure: ID.into(), setting: name.into(), problem }
}
