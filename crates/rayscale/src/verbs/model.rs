//! `rayscale model`: what modelling costs.

use crate::console::Console;
use crate::error::Error;
use crate::verb::{Outcome, Verb, command_line};
use clap::Args;
use harness::output::write_whole;
use harness::registry::StructureSpec;
use model::{Form, Model, Plan};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Compare true objects with their tessellation: time, memory and errors, and the level that an image needs
///
/// Each scene of solids is traced as it is and as triangles at rising levels, every one twice as fine as the one before, and its
/// image held against the true surface pixel by pixel. The answer names the lowest level that shows no more than --max-wrong of
/// its pixels otherwise, and what it costs beside the true objects.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  rayscale model teapot-patches
  rayscale model gyroid --pixels 512 --max-displacement 0.25
  rayscale model lattice-true teapot-patches gyroid machine-part-9 --out model")]
pub struct ModelVerb {
    /// Scenes of solids: ids or definitions
    #[arg(value_name = "SCENE", required = true)]
    scenes: Vec<String>,
    /// Structure for all forms, with settings
    #[arg(long, value_name = "ID[:NAME=VALUE,…]", default_value = "bmssm")]
    structure: StructureSpec,
    /// Rows and columns of the image
    #[arg(long, value_name = "N", default_value_t = 1024, value_parser = clap::value_parser!(u32).range(2..=8192))]
    pixels: u32,
    /// How far the right surface may be off, in widths of a pixel
    #[arg(long, value_name = "PIXELS", default_value_t = 0.5, value_parser = positive)]
    max_displacement: f64,
    /// How many pixels of those that show anything may be wrong, in percent
    #[arg(long, value_name = "PERCENT", default_value_t = 0.1, value_parser = positive)]
    max_wrong: f64,
    /// The highest level
    #[arg(long, value_name = "N", default_value_t = 6, value_parser = clap::value_parser!(u32).range(0..=12))]
    levels: u32,
    /// Triangles that no level may exceed
    #[arg(long, value_name = "N", default_value_t = 4_000_000)]
    triangles: u64,
    /// Rows and columns of the list of rays that is timed
    #[arg(long, value_name = "N", default_value_t = 256, value_parser = clap::value_parser!(u32).range(1..=4096))]
    list: u32,
    /// Samples of each time
    #[arg(long, value_name = "N", default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..=1000))]
    rounds: u32,
    /// Folder for model.json, model.md and model.svg
    #[arg(short, long, value_name = "FOLDER")]
    out: Option<PathBuf>,
}

fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value >= 0.0 && value.is_finite() => Ok(value),
        _ => Err("must be a number from 0 on".into()),
    }
}

impl Verb for ModelVerb {
    fn run(&self, console: &Console) -> Result<Outcome, Error> {
        if let Some(out) = &self.out {
            std::fs::create_dir_all(out).map_err(|error| Error::io(out.display(), error))?;
        }
        let plan = Plan {
            scenes: self.scenes.clone(),
            structure: self.structure.clone(),
            pixels: self.pixels,
            max_displacement: self.max_displacement,
            max_wrong: self.max_wrong / 100.0,
            levels: self.levels,
            triangles: self.triangles,
            list: self.list,
            rounds: self.rounds,
            command: command_line(),
        };
        let begun = |scene: &str, form: Form| console.note(format_args!("{scene}: {form}"));
        let mut kept = Ok(());
        // What is known by now is not lost if the rest fails.
        let keep = |model: &Model| kept = self.write(model);
        let found = console.in_pool(1, || model::run(&plan, begun, keep))?;
        kept?;
        let model = found?;
        let lines = model::conclusions(&model).join("\n");
        console.result(&model, format!("{}\n{lines}", model::table(&model).text()))?;
        Ok(Outcome::Done)
    }
}

impl ModelVerb {
    fn write(&self, model: &Model) -> Result<(), Error> {
        let Some(folder) = &self.out else { return Ok(()) };
        let json = serde_json::to_string_pretty(model).map_err(io::Error::other);
        let json = json.map_err(|error| Error::io("model.json", error))?;
        for (name, text) in
            [("model.json", json), ("model.md", model::page(model)), ("model.svg", model::charts(model))]
        {
            let path: &Path = &folder.join(name);
            let written: Result<(), io::Error> = write_whole(path, |out| out.write_all(text.as_bytes()));
            written.map_err(|error| Error::io(path.display(), error))?;
        }
        Ok(())
    }
}
