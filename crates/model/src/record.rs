//! The study as a file.

use crate::errors::Errors;
use harness::front::front;
use harness::machine::Machine;
use harness::record::Suite;
use serde::{Deserialize, Serialize};
use std::fmt;

/// The form of records.
pub const FORMAT: u32 = 1;

/// What a scene is modelled by.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Form {
    /// Its true objects.
    True,
    /// Triangles, at this level.
    Level(u32),
}

impl fmt::Display for Form {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::True => f.pad("true objects"),
            Self::Level(level) => f.pad(&format!("level {level}")),
        }
    }
}

/// A scene in one form.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ModelRow {
    /// The form.
    pub form: Form,
    /// Solids or triangles.
    pub objects: u64,
    /// Bytes of the scene itself.
    pub scene_bytes: u64,
    /// Bytes of a structure for any rays, with its copies of geometry.
    pub structure_bytes: u64,
    /// Making the triangles, in ns; nothing for true objects.
    pub tessellate_ns: f64,
    /// Building the structure for any rays, in ns.
    pub build_ns: f64,
    /// ns a ray of the image, by a structure built for it.
    pub image_ns: f64,
    /// ns a ray of a list: rays reflected diffusely from what the image shows; none where it shows nothing.
    pub list_ns: Option<f64>,
    /// Errors against the true surface.
    pub errors: Errors,
    /// Whether no other form is as fast on the image and as right, and better in one of both.
    pub front: bool,
}

impl ModelRow {
    /// Bytes of scene and structure.
    pub fn bytes(&self) -> u64 {
        self.scene_bytes + self.structure_bytes
    }
}

/// A scene in all its forms.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SceneRows {
    /// Its name.
    pub scene: String,
    /// What kinds of solids there are, and how many.
    pub kinds: String,
    /// The true objects first, then levels in order.
    pub rows: Vec<ModelRow>,
    /// Why there are no more levels.
    pub ended: String,
}

impl SceneRows {
    /// Marks the rows that nothing beats.
    pub fn mark_front(&mut self) {
        let points: Vec<_> = self.rows.iter().map(|row| (row.image_ns, row.errors.wrong() as f64)).collect();
        self.rows.iter_mut().for_each(|row| row.front = false);
        front(&points).into_iter().for_each(|i| self.rows[i].front = true);
    }

    /// The true objects.
    pub fn truth(&self) -> Option<&ModelRow> {
        self.rows.iter().find(|row| row.form == Form::True)
    }

    /// The lowest level with at most this part of its pixels wrong.
    pub fn enough(&self, most_wrong: f64) -> Option<&ModelRow> {
        self.rows.iter().find(|row| row.form != Form::True && row.errors.wrong_part() <= most_wrong)
    }
}

/// Everything that tables, conclusions and charts are made from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Model {
    /// The format that the writer knew.
    pub format: u32,
    /// The command that made it.
    pub command: String,
    /// The program.
    pub suite: Suite,
    /// Where it ran.
    pub machine: Machine,
    /// The structure, with its settings.
    pub structure: String,
    /// Rows and columns of the images that are compared.
    pub pixels: u32,
    /// Widths of a pixel that a surface may be off.
    pub max_displacement: f64,
    /// The part of pixels that may be wrong where a level is said to be enough.
    pub max_wrong: f64,
    /// Scenes.
    pub scenes: Vec<SceneRows>,
}
