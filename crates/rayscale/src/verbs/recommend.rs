//! `rayscale recommend`

use crate::console::Console;
use crate::error::Error;
use crate::options::LimitOptions;
use crate::options::Selection;
use crate::progress::Progress;
use crate::verb::{Outcome, Verb};
use accel::{Scene, Workload};
use clap::Args;
use harness::auto::Examiner;
use harness::guard::guard;
use harness::judge::{Counted, Tolerance};
use harness::measure::{Options, Session, begin, run};
use harness::recommend::{
    self, Answerer, Candidate, Constraints, ErrorRate, ErrorRates, Recommendation, rank,
};
use harness::record::Record;
use harness::registry::{self, Choice, StructureSpec, guarded_build};
use harness::units;
use harness::workload::{self, Subject};
use primitives::KernelId;
use report::table::in_columns;
use scenes::SceneSpec;
use std::fmt::Write;
use std::time::Duration;

/// Measure quickly on your scene and say which structure to use
#[derive(Debug, Args)]
#[command(after_help = "\
Every structure is built, checked and measured on the scene, with the settings worth trying, and
ranked by time per ray: the geometric mean over the ray sets, plus each ray's share of the build
if --rays-per-build says how many rays share one. Uses one thread unless --threads says otherwise.

Errors are counted by exact arithmetic on the rays that are traced for it; those of the exact kernel are
proven to be none. An error is what shows: a hole, a phantom, a hit that is displaced. Another object in the
same place, such as one of two triangles that coincide, is none unless --identity is given.

Examples:
  rayscale recommend model.obj
  rayscale recommend sponza --rays shadow,diffuse --memory 64MiB
  rayscale recommend model.obj --rays-per-build 2000000 --max-error 100")]
pub struct Recommend {
    /// Scene: an id, a definition or a mesh
    scene: String,
    /// Ray sets that matter to you
    #[arg(long, value_name = "RAYS", value_delimiter = ',', default_value = "perspective,diffuse")]
    rays: Vec<String>,
    /// Memory that structure and geometry copy may take, such as 64MiB
    #[arg(long, value_name = "SIZE", value_parser = size)]
    memory: Option<u64>,
    #[command(flatten)]
    limits: LimitOptions,
    /// Rays traced for each build; otherwise the build doesn't count
    #[arg(long, value_name = "N")]
    rays_per_build: Option<u64>,
}

/// Bytes by a number with a unit.
fn size(text: &str) -> Result<u64, String> {
    let digits = text.find(|c: char| !c.is_ascii_digit() && c != '.').unwrap_or(text.len());
    let (number, unit) = text.split_at(digits);
    let unit = match unit.trim().to_ascii_lowercase().as_str() {
        "" | "b" => 1.0,
        "k" | "kib" => 1024.0,
        "m" | "mib" => 1024.0 * 1024.0,
        "g" | "gib" => 1024.0 * 1024.0 * 1024.0,
        "kb" => 1e3,
        "mb" => 1e6,
        "gb" => 1e9,
        _ => return Err("must be a size such as 64MiB, 500kB or 1000000".to_owned()),
    };
    match number.parse::<f64>() {
        Ok(n) if n > 0.0 => Ok((n * unit) as u64),
        _ => Err("must be a size such as 64MiB, 500kB or 1000000".to_owned()),
    }
}

/// Structures that test every object for every ray are candidates up to so many objects.
const FEW_OBJECTS: usize = 2000;

/// Rays judged exactly for a kernel and ray set: all of them as a rule, else a sample.
const JUDGED: usize = 1 << 16;

/// Kernels that are tried where accuracy counts, the default one first.
fn kernels() -> impl Iterator<Item = KernelId> + Clone {
    KernelId::ALL.into_iter().filter(|kernel| kernel.is_recommended())
}

impl Verb for Recommend {
    fn run(&self, console: &Console) -> Result<Outcome, Error> {
        let selection = Selection { rays: self.rays.clone(), ..Selection::default() };
        let rays = selection.rays([])?;
        let spec: SceneSpec = self.scene.parse()?;
        let scene = console.scene(&spec)?;
        let limits = self.limits.limits();
        let choices = choices(&scene, limits.any())?;
        let session = Session {
            subject: Subject { scenes: vec![self.scene.clone()], rays, size: 192, seed: 1 },
            options: quick(console, self.rays_per_build.is_some()),
            ..Session::default()
        };
        console.note(format!("measuring {} structures on {}", choices.len(), scene.id));
        let constraints = Constraints {
            memory: self.memory,
            limits,
            rays_per_build: self.rays_per_build.map(|n| n as f64),
        };
        let steps = session.subject.rays.len() * session.options.passes();
        let mut progress = Progress::new(console, steps, "measuring");
        let (record, errors) = console.in_pool(1, || {
            let record = run(&session, &choices, begin(&session, &choices), &mut progress, |_| {});
            let errors = if limits.any() { errors(&session, &scene, &choices) } else { ErrorRates::new() };
            (record, errors)
        })?;
        progress.finish();
        let record = record?;
        let ranking = rank(&record, &errors, &constraints);
        console.result(
            &serde_json::json!({ "scene": scene.id, "constraints": constraints, "recommendation": ranking }),
            in_words(&record, &constraints, &ranking),
        )?;
        Ok(if ranking.fitting.is_empty() { Outcome::Failed } else { Outcome::Done })
    }
}

fn quick(console: &Console, builds_count: bool) -> Options {
    let usual = Options::default();
    Options {
        threads: console.threads().unwrap_or(1),
        passes: 2,
        rounds: 7,
        least_rounds: 3,
        // Short for each, rather than a limit of time for all, after which some would have no figure.
        cell_time: Duration::from_millis(150),
        sample_time: Duration::from_millis(400),
        build_rounds: if builds_count { 3 } else { 1 },
        least_builds: 2,
        check_tests: usual.check_tests / 4,
        exact_rays: 200,
        ..usual
    }
}

/// Every structure by default, some with other settings too; other kernels where accuracy counts.
fn choices(scene: &Scene, accuracy: bool) -> Result<Vec<Choice>, Error> {
    let mut specs: Vec<StructureSpec> = registry::defaults();
    specs.retain(|spec| {
        scene.geometry.len() <= FEW_OBJECTS
            || !registry::find(&spec.id).is_ok_and(|entry| entry.traits.linear)
    });
    specs.extend(registry::trials());
    if accuracy {
        specs.extend(registry::with_kernels(kernels().skip(1)));
    }
    specs.iter().map(|spec| Ok(registry::choose(spec)?)).collect()
}

/// Wrong answers of the suite's kernels, as for the kernel `auto`, and of structures with a test of their own.
fn errors(session: &Session, scene: &Scene, choices: &[Choice]) -> ErrorRates {
    let mut all = ErrorRates::new();
    let queries =
        workload::make(scene, &session.subject.rays, session.subject.size, session.subject.seed).made;
    let mut examiner =
        Examiner::new(scene, &workload::batches(&queries), JUDGED * queries.len(), Tolerance::VISIBLE);
    let mut enter = |answerer: Answerer, rates: Vec<ErrorRate>| {
        all.extend(queries.iter().zip(rates).map(|(q, rate)| ((answerer.clone(), q.id.to_string()), rate)));
    };
    for kernel in kernels() {
        enter(
            Answerer::Kernel(kernel),
            match kernel {
                KernelId::Exact => vec![ErrorRate::Proven; queries.len()],
                _ => examiner.examine(kernel).into_iter().map(ErrorRate::Seen).collect(),
            },
        );
    }
    for choice in choices.iter().filter(|c| !c.entry.traits.built_in) {
        // Whoever can't be built, or panics, has said so where it was measured.
        let Ok(accel) = guarded_build(choice, scene, &Workload::GENERAL) else { continue };
        if let Ok(wrong) = guard("tracing", || examiner.examine_structure(accel.as_ref())) {
            enter(
                Answerer::Structure(choice.spec.to_string()),
                wrong.into_iter().map(ErrorRate::Seen).collect(),
            );
        }
    }
    all
}

fn in_words(record: &Record, constraints: &Constraints, ranking: &Recommendation) -> String {
    let mut text = String::new();
    let settings = |structure: &str| {
        record.structures.iter().find(|s| s.id == structure).map(|s| s.settings.clone()).unwrap_or_default()
    };
    let head = [
        "    structure",
        "per ray",
        "build",
        "memory",
        if constraints.limits.counted == Counted::Identity { "wrong answers" } else { "visible errors" },
    ]
    .map(str::to_owned);
    let mut lines = vec![head.to_vec()];
    lines.extend(
        ranking.fitting.iter().zip(1..).map(|(c, place)| row(&format!("{place:>2}."), c, constraints, "")),
    );
    lines.extend(
        ranking.others.iter().map(|c| row(" – ", c, constraints, &format!("  ({})", c.misfits.join("; ")))),
    );
    text.push_str(&in_columns(&lines, &[false, true, true, true, false]));
    text.push('\n');
    for (structure, reason) in &ranking.unfit {
        // Writing to a string does not fail.
        let _ = writeln!(text, " –  {structure}  {reason}");
    }
    let sets = record.ray_sets().join(" and ");
    let _ = match (&ranking.fitting[..], &ranking.others[..]) {
        ([best, rest @ ..], _) => {
            let build =
                if constraints.rays_per_build.is_some() { " with its share of the build" } else { "" };
            let gap = rest.first().map_or(String::new(), |next| {
                let ratio = next.cost / best.cost;
                let next = &next.structure;
                if ratio < 1.05 {
                    format!("; {next} is as good within 5 %")
                } else {
                    format!("; {next} takes {ratio:.2} times as long")
                }
            });
            let counted = constraints.limits.counted;
            let open = constraints.limits.errors.zip(best.error);
            let open = open.map(|(limit, error)| (limit / 1e6, error.bound(counted)));
            let open = open.filter(|(limit, bound)| bound > limit).map_or(String::new(), |(_, bound)| {
                format!(
                    "\nThe rays looked at do not rule out that {} of its answers are {}; only the kernel `exact` is proven.",
                    recommend::per_million(bound),
                    counted.words()
                )
            });
            write!(
                text,
                "\nUse `{}`: the least time per ray{build} on {sets} rays of all that fit ({}){gap}.{open}\nIts settings: {}",
                best.structure,
                units::time(best.cost),
                settings(&best.structure)
            )
        }
        ([], [nearest, ..]) => write!(
            text,
            "\nNothing fits. `{}` comes nearest: {}.\nIts settings: {}",
            nearest.structure,
            nearest.misfits.join("; "),
            settings(&nearest.structure)
        ),
        ([], []) => write!(text, "\nNothing could be measured."),
    };
    text
}

/// A candidate's line in columns, with its place before and a remark behind.
fn row(place: &str, c: &Candidate, constraints: &Constraints, remark: &str) -> Vec<String> {
    let error = match c.error {
        Some(ErrorRate::Proven) => "none".to_owned(),
        Some(error) => match error.share(constraints.limits.counted) {
            0.0 => "none seen".to_owned(),
            share => recommend::per_million(share),
        },
        None => String::new(),
    };
    let (ns, build) = (units::time(c.ns), units::time(c.build_ns));
    let remark = if error.is_empty() { remark.trim_start() } else { remark };
    vec![format!("{place} {}", c.structure), ns, build, units::bytes(c.bytes), format!("{error}{remark}")]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_have_units() {
        for (text, bytes) in
            [("64MiB", 64 << 20), ("1.5 GiB", 3 << 29), ("500kB", 500_000), ("7", 7), ("2k", 2048)]
        {
            assert_eq!(size(text), Ok(bytes), "{text}");
        }
        for text in ["", "MiB", "0", "-1", "1 parsec", "1..2k"] {
            assert!(size(text).is_err(), "{text}");
        }
    }
}
