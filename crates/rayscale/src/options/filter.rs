//! Which cells of a record.

use clap::Args;
use harness::record::Cell;

/// Which cells of a record.
#[derive(Clone, Debug, Default, Args)]
pub struct Filter {
    /// Only these scenes
    #[arg(long = "scene", value_name = "SCENE", value_delimiter = ';')]
    scenes: Vec<String>,
    /// Only these ray sets
    #[arg(long, value_name = "RAYS", value_delimiter = ',')]
    rays: Vec<String>,
    /// Only these structures
    #[arg(long = "structure", value_name = "ID")]
    structures: Vec<String>,
}

impl Filter {
    /// Whether a cell passes.
    pub fn takes(&self, cell: &Cell) -> bool {
        self.takes_rays(cell) && among(&self.structures, &cell.structure)
    }

    /// Whether a cell passes, those of one more structure included.
    pub fn takes_with(&self, structure: &str, cell: &Cell) -> bool {
        self.takes(cell) || self.takes_rays(cell) && cell.structure == structure
    }

    fn takes_rays(&self, cell: &Cell) -> bool {
        among(&self.scenes, &cell.scene) && among(&self.rays, &cell.rays)
    }
}

/// No names are all names.
fn among(names: &[String], name: &str) -> bool {
    names.is_empty() || names.iter().any(|n| n == name)
}
