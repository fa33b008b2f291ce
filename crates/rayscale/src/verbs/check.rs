//! `rayscale check`: differences from brute force.

mod kinds;
mod marathon;
mod verify;

use crate::console::Console;
use crate::error::Error;
use crate::options::Selection;
use crate::progress::Progress;
use crate::verb::{Outcome, Verb};
use clap::Args;
use harness::registry::{self, StructureSpec};
use harness::sweeps::differences::{self, Sweep, Tally};
use harness::sweeps::leaks::{self, LeakTally};
use harness::sweeps::oracle::{self, OraclePlan, OracleTally};
use harness::units;
use harness::workload::Subject;
use primitives::KernelId;
use report::table::{Column, Table, Value, figure};
use scenes::rays::RaysId;
use serde::Serialize;
use std::path::PathBuf;
use std::time::Duration;

/// Compare the answers of structures with brute force, bit for bit, or with exact arithmetic
///
/// The suite's own structures must have no difference; there the exit code is 1 otherwise. Structures with a ray-triangle
/// test of their own are counted and not judged: `measure` judges them by exact arithmetic.
///
/// --oracle and --leaks check what kernels promise instead: that exact gives the true answer to every ray, and that neither exact
/// nor watertight lets a ray out of a closed mesh.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  rayscale check
  rayscale check --scene unit-one --structure ssm:resolution=4 --rays axis,bounds
  rayscale check --full
  rayscale check --oracle
  rayscale check --oracle 20000 --scene extreme-needles --structure minmax:kernel=exact
  rayscale check --leaks 10000000
  rayscale check --kinds 10000
  rayscale check --verify
  rayscale check --verify --run rays/ --structure ssm
  rayscale check --marathon marathon.json --time 10m")]
pub struct Check {
    #[command(flatten)]
    selection: Selection,
    /// Own structures with all their variants, on all sets of rays, at least 10 million of them for each
    #[arg(long)]
    full: bool,
    /// bmssm and ssm with the kernel exact against the oracle on so many rays over all scenes of triangles (but
    /// extreme-offset-10m, which takes long), 2 million otherwise
    #[arg(long, value_name = "RAYS", num_args = 0..=1, default_missing_value = "2000000")]
    oracle: Option<u64>,
    /// So many rays from inside closed meshes at three scales, 10 million otherwise, by bmssm and ssm with the kernels exact
    /// and watertight, and by Embree
    #[arg(long, value_name = "RAYS", num_args = 0..=1, default_missing_value = "10000000")]
    leaks: Option<u64>,
    /// Scenes of each kind of solid, and of all kinds mixed, by every structure on so many rays a kind, 1 million otherwise: nearest
    /// hits, occlusion and all crossings, images and lists
    #[arg(long, value_name = "RAYS", num_args = 0..=1, default_missing_value = "1000000")]
    kinds: Option<u64>,
    /// A tree of named questions, from closed meshes to cancelled builds, each asked of every structure
    #[arg(long)]
    verify: bool,
    /// Of --verify only the questions whose name holds this
    #[arg(long, value_name = "PATTERN", requires = "verify", default_value = "")]
    run: String,
    /// Random scenes, rays, settings, instruction sets and threads against brute force and exact arithmetic; the record says
    /// how far it came, and a further run goes on from there
    #[arg(long, value_name = "FILE")]
    marathon: Option<PathBuf>,
    /// With --marathon: for so long, such as 90s or 1h30m
    #[arg(long, value_name = "DURATION", requires = "marathon", value_parser = units::duration)]
    time: Option<Duration>,
    /// With --marathon: until the record has so many rays
    #[arg(long, value_name = "RAYS", requires = "marathon", default_value_t = 1_000_000_000)]
    until: u64,
}

/// What was checked.
#[derive(Serialize)]
struct Checks {
    #[serde(flatten)]
    tally: Option<Tally>,
    #[serde(skip_serializing_if = "Option::is_none")]
    oracle: Option<OracleTally>,
    #[serde(skip_serializing_if = "Option::is_none")]
    leaks: Option<LeakTally>,
}

impl Verb for Check {
    fn run(&self, console: &Console) -> Result<Outcome, Error> {
        if self.verify {
            return verify::verify(console, &self.run, &self.selection.structures);
        }
        if let Some(rays) = self.kinds {
            return kinds::kinds(console, rays, &self.selection);
        }
        if let Some(record) = &self.marathon {
            let goal = ::verify::marathon::Goal { rays: self.until, time: self.time };
            return marathon::marathon(console, record, goal, self.selection.seed);
        }
        let sweep = self.full || (self.oracle.is_none() && self.leaks.is_none());
        let tally = match (sweep, self.full) {
            (false, _) => None,
            (true, false) => Some(plain(console, &self.selection)?),
            (true, true) => Some(full(console, &self.selection)?),
        };
        let oracle = self.oracle.map(|rays| by_oracle(console, &self.selection, rays)).transpose()?;
        let leaks = self.leaks.map(|rays| from_inside(console, &self.selection, rays)).transpose()?;
        let checks = Checks { tally, oracle, leaks };
        let texts = [
            checks.tally.as_ref().map(text),
            checks.oracle.as_ref().map(oracle_text),
            checks.leaks.as_ref().map(leaks_text),
        ];
        console.result(&checks, texts.into_iter().flatten().collect::<Vec<_>>().join("\n"))?;
        let sound = checks.tally.is_none_or(|tally| tally.is_sound())
            && checks.oracle.is_none_or(|tally| tally.is_exact())
            && checks.leaks.is_none_or(|tally| tally.is_tight());
        Ok(if sound { Outcome::Done } else { Outcome::Failed })
    }
}

/// A scene whose corners fall together on a few points: thousands of integers decide each ray, so it is judged only where it is asked for.
const SLOW: &str = "extreme-offset-10m";

/// These scenes with the ray sets chosen, or all.
fn subject(selection: &Selection, scenes: Vec<String>, size: u32) -> Result<Subject, Error> {
    let rays = selection.rays(RaysId::ALL)?;
    Ok(Subject { scenes, rays, size: selection.size.unwrap_or(size), seed: selection.seed })
}

/// The structures with a kernel that promises the truth, on the scenes chosen.
fn by_oracle(console: &Console, selection: &Selection, least: u64) -> Result<OracleTally, Error> {
    let all = || scenes::list().into_iter().map(|info| info.id).filter(|id| id != SLOW).collect();
    let plan = OraclePlan {
        subject: subject(
            selection,
            if selection.scenes.is_empty() { all() } else { selection.scenes()? },
            48,
        )?,
        least,
    };
    let choices = selection.structures(&registry::with_kernels([KernelId::Exact]))?;
    let mut progress = Progress::new(console, plan.subject.scenes.len(), "judging");
    let tally = console.in_pool(0, || oracle::run(&plan, &choices, &mut progress))??;
    progress.finish();
    Ok(tally)
}

/// The structures with a kernel that promises not to leak, and Embree on the same rays.
fn from_inside(console: &Console, selection: &Selection, least: u64) -> Result<LeakTally, Error> {
    let mut all = registry::with_kernels(KernelId::ALL.into_iter().filter(|kernel| kernel.is_watertight()));
    let others = registry::entries().iter().filter(|entry| entry.traits.leaks);
    all.extend(others.map(|entry| StructureSpec::plain(entry.id)));
    let choices = selection.structures(&all)?;
    let seed = selection.seed;
    let mut progress = Progress::new(console, leaks::MESHES.len() * leaks::SCALES.len(), "tracing");
    let tally = console.in_pool(0, || leaks::run(least, seed, &choices, &mut progress))??;
    progress.finish();
    Ok(tally)
}

/// The structures chosen on the scenes chosen.
fn plain(console: &Console, selection: &Selection) -> Result<Tally, Error> {
    let sweep =
        Sweep { subject: subject(selection, selection.scenes()?, 128)?, rays_each: 0, tests: 400_000_000 };
    run(console, &sweep, selection, &registry::defaults())
}

/// Rows and columns with `--full`: about ten million rays in one pass for a structure with two variants.
const FULL_SIZE: u32 = 96;

/// The suite's own structures and their variants on the scenes that hunt for errors.
pub fn full(console: &Console, selection: &Selection) -> Result<Tally, Error> {
    let scenes = if selection.scenes.is_empty() { differences::hunting() } else { selection.scenes()? };
    let sweep =
        Sweep { subject: subject(selection, scenes, FULL_SIZE)?, rays_each: 10_000_000, tests: 400_000_000 };
    let own: Vec<StructureSpec> =
        registry::with_variants(|entry| entry.traits.built_in && entry.id != "brute");
    run(console, &sweep, selection, &own)
}

fn run(
    console: &Console,
    sweep: &Sweep,
    selection: &Selection,
    otherwise: &[StructureSpec],
) -> Result<Tally, Error> {
    let choices = selection.structures(otherwise)?;
    let mut progress = Progress::new(console, sweep.subject.scenes.len(), "checking");
    let tally = console.in_pool(0, || differences::run(sweep, &choices, &mut progress))??;
    progress.finish();
    Ok(tally)
}

fn text(tally: &Tally) -> String {
    let mut table = Table::of_figures("structure", ["rays", "differences"]);
    for row in &tally.structures {
        table.push([Value::text(&row.structure), Value::count(row.rays), Value::count(row.differences)]);
    }
    let mut text = table.text();
    for finding in &tally.findings {
        text.push_str(&format!("\n{finding}"));
    }
    text
}

fn oracle_text(tally: &OracleTally) -> String {
    let columns = ["rays", "missed", "false", "wrong object", "t off by > 1 ulp", "t ulp max"];
    let mut table = Table::of_figures("structure", columns);
    for row in &tally.structures {
        let counts = [tally.rays, row.missed, row.false_hits, row.wrong_object, row.wrong_t];
        let most = Value::figure(Some(row.t_ulp_max), units::ratio);
        table.push([Value::text(&row.structure)].into_iter().chain(counts.map(Value::count)).chain([most]));
    }
    let (scenes, aimed, left) =
        (tally.scenes, units::count(tally.kinds.aimed), units::count(tally.kinds.left_out));
    let mut text = table.text();
    text.push_str(&format!(
        "\n{scenes} scenes; {aimed} of the rays aimed at edges and corners; {left} left out, their t being denormal"
    ));
    for finding in &tally.findings {
        text.push_str(&format!("\n{finding}"));
    }
    text
}

fn leaks_text(tally: &LeakTally) -> String {
    let texts = ["mesh", "scale", "structure"].map(Column::from);
    let figures = ["rays", "at faces", "at edges", "at corners"].map(figure);
    let mut table = Table::new(texts.into_iter().chain(figures));
    let mut add = |mesh: &str, scale: String, structure: &str, rays: u64, leaks: [u64; 3]| {
        let names = [mesh.into(), scale.into(), structure.into()];
        table.push(names.into_iter().chain([Value::count(rays)]).chain(leaks.map(Value::count)));
    };
    for row in &tally.rows {
        add(&row.mesh, row.scale.to_string(), &row.structure, row.rays, row.leaks);
    }
    for (structure, rays, leaks) in tally.sums() {
        add("all", String::new(), structure, rays, leaks);
    }
    let errors = tally
        .rows
        .iter()
        .filter_map(|row| Some(format!("\n{} {}: {}", row.mesh, row.structure, row.error.as_ref()?)));
    table.text() + &errors.collect::<String>()
}
