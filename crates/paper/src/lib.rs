//! The paper reproduced: every table and formula of Skala 1993 beside today's figure.
//!
//! [`run`] computes a [`Paper`], the record; [`page`] and [`plots`] only read it.

#![forbid(unsafe_code)]

pub mod candidates;
pub mod consistency;
pub mod depth;
mod error;
pub mod experiment;
pub mod facets;
mod loops;
pub mod memory;
pub mod operations;
pub mod page;
pub mod plots;
pub mod printed;
pub mod secondary;
pub mod setup;
pub mod slips;
pub mod speed;
mod stage;
mod table;
mod timing;

pub use error::PaperError;
pub use stage::Stage;
pub use table::Table;

use accel::Scene;
use harness::machine::Machine;
use image::RgbImage;
use scenes::load;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// How much is done.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Effort {
    /// Seeds of Tables 6 and 7.
    pub seeds: u64,
    /// Rounds of each timing.
    pub rounds: usize,
    /// How often the images of Tables 2 to 5 are traced; none in records of old, which repeated single rows.
    #[serde(default)]
    pub images: usize,
    /// Every how manieth row of them: 1 for whole images, as in the paper.
    #[serde(default)]
    pub image_step: u32,
    /// Secondary rays for each scene.
    pub secondary_rays: usize,
    /// Largest N of the memory tables.
    pub most_n: u32,
    /// Largest p of the memory tables.
    pub most_p: u32,
}

impl Effort {
    /// The whole of it.
    pub const FULL: Self = Self {
        seeds: 400,
        rounds: 31,
        images: 3,
        image_step: 1,
        secondary_rays: 200,
        most_n: 256,
        most_p: 1_000_000,
    };
    /// A look at it in seconds.
    pub const QUICK: Self = Self {
        seeds: 200,
        rounds: 5,
        images: 1,
        image_step: 16,
        secondary_rays: 50,
        most_n: 64,
        most_p: 10_000,
    };
}

/// All that the page shows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Paper {
    /// Version of the suite.
    pub version: String,
    /// The processor and the instruction set of the SIMD loops.
    pub machine: String,
    /// How much was done.
    pub effort: Effort,
    /// Tables 1 to 7 by number, `setup`, `depth` and `secondary`.
    pub tables: BTreeMap<String, Table>,
    /// §3 and §4.
    pub cost_model: operations::CostModel,
    /// §5.
    pub memory: memory::Memory,
    /// §2, image consistency; `None` where no scene could be had.
    pub consistency: Option<consistency::Consistency>,
    /// §2, large objects split.
    pub split: Vec<facets::Facets>,
    /// Where the print is wrong.
    pub slips: Vec<slips::Slip>,
}

/// Scenes for the demonstration of image consistency, the first that can be had.
const REAL: [&str; 3] = ["bunny", "sponza", "teapot"];

/// Everything. `tell` hears what comes next.
///
/// # Errors
/// Where the stadium can't be made or a structure not be built.
pub fn run(
    effort: &Effort,
    scene: Option<&str>,
    mut tell: impl FnMut(Stage),
) -> Result<(Paper, Option<RgbImage>), PaperError> {
    tell(Stage::CostModel);
    let (one, cost_model) = operations::evaluate(effort.rounds);
    tell(Stage::Candidates);
    let [six, seven] = candidates::tables(effort.seeds);
    tell(Stage::Speed);
    let [two, three, four, five] =
        speed::tables(speed::Images { rounds: effort.images, step: effort.image_step });
    tell(Stage::SetUp);
    let (setup, depth) = (setup::table(&two), depth::table());
    tell(Stage::Secondary);
    let secondary = secondary::table(effort.secondary_rays, effort.rounds);
    tell(Stage::Memory);
    let memory = memory::evaluate(effort.most_n, effort.most_p);
    tell(Stage::Split);
    let split = facets::all(effort.rounds.min(5))?;
    tell(Stage::Consistency);
    let consistency = match real(scene)? {
        Some(scene) => Some(consistency::evaluate(&scene)?),
        None => None,
    };
    let (consistency, picture) = consistency.unzip();
    let tables = [one, two, three, four, five, six, seven];
    let numbered = (1..).zip(tables).map(|(number, table)| (number.to_string(), table));
    let paper = Paper {
        version: env!("CARGO_PKG_VERSION").into(),
        machine: machine(),
        effort: effort.clone(),
        tables: numbered
            .chain([("setup".into(), setup), ("depth".into(), depth), ("secondary".into(), secondary)])
            .collect(),
        cost_model,
        memory,
        consistency,
        split,
        slips: slips::all(),
    };
    Ok((paper, picture))
}

/// The scene asked for, or the first real one there is.
fn real(scene: Option<&str>) -> Result<Option<Scene>, PaperError> {
    match scene {
        Some(id) => Ok(Some(load(&id.parse()?)?)),
        None => Ok(REAL.iter().find_map(|id| load(&id.parse().ok()?).ok())),
    }
}

fn machine() -> String {
    let Machine { cpu, isa, .. } = Machine::here();
    format!("{cpu}, {isa}")
}
