//! `rayscale scenes`

use crate::console::Console;
use crate::error::{Error, check_place};
use crate::verb::{Outcome, Verb};
use clap::{Args, Subcommand};
use harness::output::write_whole;
use harness::units;
use scenes::{Loaded, SceneInfo, SceneSpec};
use serde::Serialize;
use std::fmt::Write;
use std::path::PathBuf;

/// List the scenes, describe one, or export one as OBJ
#[derive(Debug, Args)]
#[command(after_help = "\
A scene is an id of the list, a TOML definition (see scenes/) or an OBJ or ASCII PLY file.
Behind an id or file, `@` changes it: `sponza@scale=-20` (2^-20 times as large),
`bumps-20k@offset=1e5,0,0`, `stadium@split=0.5` (edges cut to at most that length),
`model.obj@up=z@eye=4,-3,2@target=0,0,1@fov=30` (the camera; each may be left out).

Examples:
  rayscale scenes
  rayscale scenes describe stadium
  rayscale scenes describe model.obj --json
  rayscale scenes export bumps-200k --out bumps.obj")]
pub struct Scenes {
    #[command(subcommand)]
    what: Option<What>,
}

#[derive(Debug, Subcommand)]
enum What {
    /// All scenes that have a name (also without any word)
    List,
    /// What a scene is and where it comes from, with its size and checksum
    Describe {
        /// Scene: an id, a definition or a mesh
        scene: SceneSpec,
    },
    /// A scene as Wavefront OBJ; numbers read back to the same bits, boxes become twelve triangles
    Export {
        /// Scene: an id, a definition or a mesh
        scene: SceneSpec,
        /// The file to write
        #[arg(long, value_name = "FILE.obj")]
        out: PathBuf,
    },
}

/// A scene at hand.
#[derive(Debug, Serialize)]
struct Description {
    id: String,
    source: String,
    objects: usize,
    kind: &'static str,
    bounds: Option<[[f32; 3]; 2]>,
    checksum: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    catalog: Option<SceneInfo>,
}

impl Verb for Scenes {
    fn run(&self, console: &Console) -> Result<Outcome, Error> {
        match &self.what {
            None | Some(What::List) => list(console)?,
            Some(What::Describe { scene }) => describe(console, scene)?,
            Some(What::Export { scene, out }) => {
                check_place(out)?;
                let loaded = console.scene(scene)?;
                write_whole(out, |file| scenes::write_obj(&loaded, file))
                    .map_err(|error| Error::io(out.display(), error))?;
                let objects = loaded.geometry.len();
                let kind = loaded.geometry.kind();
                let text =
                    format!("{}: {} {kind} → {}", loaded.id, units::count(objects as u64), out.display());
                console.result(
                    &serde_json::json!({ "scene": loaded.id, "objects": objects, "kind": kind, "out": out.to_string_lossy() }),
                    text,
                )?;
            }
        }
        Ok(Outcome::Done)
    }
}

fn list(console: &Console) -> Result<(), Error> {
    scenes::broken_definitions().iter().for_each(|error| console.note(format_args!("passed over: {error}")));
    let all = scenes::list();
    let width = all.iter().map(|info| info.id.len()).max().unwrap_or(0);
    let mut text = String::new();
    for SceneInfo { id, description, character, default, available, .. } in &all {
        let mark = if *default { '*' } else { ' ' };
        let absent = if *available {
            ""
        } else {
            " [mesh not here: `cargo xtask setup` fetches it, --meshes names its folder]"
        };
        // Writing to a string does not fail.
        let _ = writeln!(text, "{mark} {id:<width$}  {description} ({character}){absent}");
    }
    let mut families: Vec<&str> = all.iter().filter_map(|info| info.family.as_deref()).collect();
    families.dedup();
    let _ = write!(
        text,
        "\n* in the default comparison. Families take other numbers too: {}.",
        families.join(", ")
    );
    console.result(&all, text)
}

fn describe(console: &Console, spec: &SceneSpec) -> Result<(), Error> {
    let Loaded { scene, source, .. } = scenes::load_full(spec)?;
    let catalog = match &spec.source {
        scenes::Source::Id(id) => Some(scenes::describe(id)?),
        _ => None,
    };
    let bounds = scene.geometry.bounds();
    let description = Description {
        objects: scene.geometry.len(),
        kind: scene.geometry.kind(),
        bounds: (!bounds.is_empty()).then(|| [bounds.min.to_array(), bounds.max.to_array()]),
        checksum: scenes::checksum(&scene.geometry),
        id: scene.id,
        source,
        catalog,
    };
    console.result(&description, describe_in_words(&description))
}

fn describe_in_words(of: &Description) -> String {
    let mut lines = vec![of.id.clone()];
    let mut line = |name: &str, text: &str| {
        if !text.is_empty() {
            lines.push(format!("  {name:<10} {text}"));
        }
    };
    if let Some(info) = &of.catalog {
        line("shows", &info.description);
        line("character", &info.character);
        line("suffers", &info.suffers);
        line("licence", &info.licence);
    }
    line("source", &of.source);
    line("objects", &format!("{} {}", units::count(of.objects as u64), of.kind));
    if let Some([min, max]) = of.bounds {
        line("bounds", &format!("{min:?} to {max:?}"));
    }
    line("checksum", &of.checksum);
    lines.join("\n")
}
