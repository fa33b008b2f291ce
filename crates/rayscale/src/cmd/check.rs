//! `rayscale check`: differences from brute force.

use super::selection::Selection;
use super::{Console, Error, Outcome, Verb};
use crate::check::sweep::{self, Sweep, Tally};
use crate::rays::RaysId;
use crate::registry::{self, StructureSpec};
use crate::report::table::Table;
use crate::units;
use clap::Args;

/// Compare the answers of structures with brute force, bit for bit
///
/// The suite's own structures must have no difference; there the exit code is 1 otherwise. Structures with a ray-triangle
/// test of their own are counted and not judged: `measure` judges them by exact arithmetic.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  rayscale check
  rayscale check --scene unit-one --structure ssm:resolution=4 --rays axis,bounds
  rayscale check --full")]
pub struct Check {
    #[command(flatten)]
    selection: Selection,
    /// Own structures with all their variants, on all sets of rays, at least 10 million of them for each
    #[arg(long)]
    full: bool,
}

impl Verb for Check {
    fn run(&self, console: &Console) -> Result<Outcome, Error> {
        let tally =
            if self.full { full(console, &self.selection)? } else { plain(console, &self.selection)? };
        console.result(&tally, text(&tally))?;
        Ok(if tally.is_sound() { Outcome::Done } else { Outcome::Failed })
    }
}

/// The structures chosen on the scenes chosen.
fn plain(console: &Console, selection: &Selection) -> Result<Tally, Error> {
    let sweep = Sweep {
        scenes: selection.scenes()?,
        rays: selection.rays(&RaysId::ALL)?,
        size: selection.size.unwrap_or(128),
        seed: selection.seed,
        rays_each: 0,
        tests: 400_000_000,
    };
    run(console, &sweep, selection, &registry::defaults())
}

/// Rows and columns with `--full`: about ten million rays in one pass for a structure with two variants.
const FULL_SIZE: u32 = 96;

/// The suite's own structures and their variants on the scenes that hunt for errors.
pub fn full(console: &Console, selection: &Selection) -> Result<Tally, Error> {
    let scenes = if selection.scenes.is_empty() { sweep::hunting() } else { selection.scenes()? };
    let sweep = Sweep {
        scenes,
        rays: selection.rays(&RaysId::ALL)?,
        size: selection.size.unwrap_or(FULL_SIZE),
        seed: selection.seed,
        rays_each: 10_000_000,
        tests: 400_000_000,
    };
    let own: Vec<StructureSpec> =
        registry::with_variants(|entry| entry.traits.own_kernel && entry.id != "brute");
    run(console, &sweep, selection, &own)
}

fn run(
    console: &Console,
    sweep: &Sweep,
    selection: &Selection,
    otherwise: &[StructureSpec],
) -> Result<Tally, Error> {
    let choices = selection.structures(otherwise)?;
    let bar = console.bar(sweep.scenes.len() as u64, "checking");
    let tally = console.in_pool(0, || {
        sweep::run(sweep, &choices, |line| {
            bar.inc(1);
            bar.set_message(line.to_owned());
            if bar.is_hidden() {
                console.note(line);
            }
        })
    })??;
    bar.finish_and_clear();
    Ok(tally)
}

fn text(tally: &Tally) -> String {
    let mut table = Table::new(["structure", "rays", "differences"]);
    for row in &tally.structures {
        table.rows.push(vec![row.structure.clone(), units::count(row.rays), units::count(row.differences)]);
    }
    let mut text = table.text();
    for finding in &tally.findings {
        text.push_str(&format!("\n{finding}"));
    }
    text
}
