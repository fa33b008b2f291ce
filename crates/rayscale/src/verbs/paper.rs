//! `rayscale paper`

use crate::console::Console;
use crate::error::Error;
use crate::verb::{Outcome, Verb};
use clap::Args;
use harness::output::write_whole;
use paper::{Effort, Paper, page, plots, run};
use serde_json::json;
use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// Reproduce the paper (Skala 1993): its tables and formulas beside today's figures
#[derive(Debug, Args)]
#[command(after_help = "\
Writes paper.json, paper.md, SVG plots and a picture. Timings use one thread.

Examples:
  rayscale paper
  rayscale paper --quick --out /tmp/paper
  rayscale paper --scene sponza
  rayscale paper --from reports/paper/paper.json --out /tmp/again")]
pub struct PaperVerb {
    /// Folder to write to
    #[arg(long, value_name = "DIR", default_value = "reports/paper")]
    out: PathBuf,
    /// A look at it in seconds: fewer seeds, rounds, rays and sizes
    #[arg(long)]
    quick: bool,
    /// The scene that shows image consistency, instead of the first real mesh there is
    #[arg(long, value_name = "SCENE", conflicts_with = "from")]
    scene: Option<String>,
    /// Make page and plots again from a record instead of measuring
    #[arg(long, value_name = "JSON", conflicts_with = "quick")]
    from: Option<PathBuf>,
}

impl Verb for PaperVerb {
    fn run(&self, console: &Console) -> Result<Outcome, Error> {
        let (paper, picture) = match &self.from {
            Some(path) => (read(path)?, None),
            None => {
                let effort = if self.quick { Effort::QUICK } else { Effort::FULL };
                // Loops are compared: other threads would only disturb.
                console.in_pool(1, || run(&effort, self.scene.as_deref(), |stage| console.note(stage)))??
            }
        };
        let place = |error| Error::io(self.out.display(), error);
        fs::create_dir_all(&self.out).map_err(place)?;
        let mut files: Vec<(&str, Vec<u8>)> = vec![
            (
                "paper.json",
                format!(
                    "{}\n",
                    serde_json::to_string_pretty(&paper).map_err(io::Error::other).map_err(place)?
                )
                .into_bytes(),
            ),
            ("paper.md", page::markdown(&paper).into_bytes()),
        ];
        files.extend(plots::all(&paper).into_iter().map(|(name, svg)| (name, svg.into_bytes())));
        if let Some(picture) = picture {
            let mut png = io::Cursor::new(Vec::new());
            picture.write_to(&mut png, image::ImageFormat::Png).map_err(io::Error::other).map_err(place)?;
            files.push(("consistency.png", png.into_inner()));
        }
        let mut names = Vec::new();
        for (name, bytes) in files {
            let path = self.out.join(name);
            write_whole(&path, |out| out.write_all(&bytes))
                .map_err(|error| Error::io(path.display(), error))?;
            names.push(path.display().to_string());
        }
        console.result(&json!({ "written": names }), format!("written: {}", names.join(" ")))?;
        Ok(Outcome::Done)
    }
}

fn read(path: &Path) -> Result<Paper, Error> {
    let text = fs::read_to_string(path).map_err(|error| Error::io(path.display(), error))?;
    serde_json::from_str(&text).map_err(|error| {
        Error::usage(format!("{}: {error}", path.display()), "give a paper.json that `rayscale paper` wrote")
    })
}
