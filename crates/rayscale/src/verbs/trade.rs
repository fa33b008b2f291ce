//! `rayscale trade`: what accuracy costs.

use crate::console::Console;
use crate::error::Error;
use crate::options::Selection;
use crate::progress::Progress;
use crate::verb::{Outcome, Verb, command_line};
use clap::Args;
use harness::measure::Options;
use harness::output::write_whole;
use report::{EXTREMES, TRADE, splice_at};
use scenes::rays::RaysId;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use trade::{ORDINARY, Plan, TIMED};

/// Compare time and memory with errors found by exact arithmetic
///
/// Every structure and kernel answers the same rays, ordinary ones and, counted apart, such as hunt for errors; integers decide
/// what is a hole, a phantom, displaced or another object, and how far hits are off. Writes a record, a page that begins with
/// conclusions, and plots. Judging uses all cores, times are taken on one.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  rayscale trade --out trade
  rayscale trade --scene sponza --scene bumps-20k --structure ssm:kernel=exact --structure embree --out trade
  rayscale trade --scene sponza --curve sponza --extremes 4000 --out trade
  rayscale trade --record trade/trade.json --out trade --splice README.md --splice docs/accuracy.md")]
pub struct Trade {
    #[command(flatten)]
    selection: Selection,
    /// Rows and columns of each ordinary set that is judged; there are four unless --rays says which
    #[arg(long, value_name = "N", default_value_t = 100, value_parser = clap::value_parser!(u32).range(1..=4096))]
    judged: u32,
    /// Rows and columns of each set that hunts for errors
    #[arg(long, value_name = "N", default_value_t = 60, value_parser = clap::value_parser!(u32).range(1..=4096))]
    hunting: u32,
    /// A scene of those compared for the curve of precision and for rays that leave surfaces; may be repeated
    #[arg(long, value_name = "SCENE", value_delimiter = ';')]
    curve: Vec<String>,
    /// Rays for each extreme; no extremes otherwise
    #[arg(long, value_name = "N", default_value_t = 0)]
    extremes: usize,
    /// Triangles of the largest extreme; none such otherwise
    #[arg(long, value_name = "N", default_value_t = 0, requires = "extremes")]
    largest: usize,
    /// Most samples of a time
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = clap::value_parser!(u16).range(1..=10_000))]
    rounds: u16,
    /// Folder for trade.json, trade.md, trade.svg and curve.svg
    #[arg(short, long, value_name = "FOLDER")]
    out: PathBuf,
    /// Compare nothing: make the page and the plots from this record
    #[arg(long, value_name = "FILE", conflicts_with_all = ["curve", "extremes", "scenes", "structures"])]
    record: Option<PathBuf>,
    /// Write the summary with the chart, or the table of extremes, between the markers of this text too, whichever it has; may
    /// be repeated
    #[arg(long, value_name = "FILE")]
    splice: Vec<PathBuf>,
}

impl Verb for Trade {
    fn run(&self, console: &Console) -> Result<Outcome, Error> {
        std::fs::create_dir_all(&self.out).map_err(|error| Error::io(self.out.display(), error))?;
        let trade = match &self.record {
            Some(path) => trade::Trade::read(path)?,
            None => self.study(console)?,
        };
        self.write("trade.md", &report::trade::page(&trade))?;
        self.write("trade.svg", &report::trade::svg(&trade))?;
        if let Some(curve) = report::trade::curve_svg(&trade) {
            self.write("curve.svg", &curve)?;
        }
        for path in &self.splice {
            self.splice_into(&trade, path)?;
        }
        console.result(&trade, report::trade::ordinary(&trade.rows).text())?;
        let failed = trade.rows.iter().filter_map(|row| Some((row, row.outcome.reason()?)));
        let lines: Vec<String> =
            failed.map(|(row, reason)| format!("{} {}: {reason}", row.scene, row.structure)).collect();
        lines.iter().for_each(|line| console.note(line));
        Ok(if lines.is_empty() { Outcome::Done } else { Outcome::Failed })
    }
}

impl Trade {
    fn study(&self, console: &Console) -> Result<trade::Trade, Error> {
        let choices = self.selection.structures(&trade::defaults())?;
        let rounds = usize::from(self.rounds);
        let scenes = self.selection.scenes()?;
        if let Some(other) = self.curve.iter().find(|scene| !scenes.contains(scene)) {
            let todo = format!("add --scene {other}, or leave it out");
            return Err(Error::usage(format!("--curve {other}: no scene that is compared"), todo));
        }
        let given = !self.selection.rays.is_empty();
        let defaults = Options::default();
        let ordinary = self.selection.rays(ORDINARY)?;
        let plan = Plan {
            scenes,
            timed: self.selection.rays(TIMED)?,
            size: self.selection.size.unwrap_or(128),
            ordinary: ordinary.into_iter().filter(|id: &RaysId| !given || !id.is_stress()).collect(),
            judged: self.judged,
            hunting: self.hunting,
            curve: self.curve.clone(),
            extremes: self.extremes,
            largest: self.largest,
            judges: std::thread::available_parallelism().map_or(1, usize::from),
            seed: self.selection.seed,
            options: Options {
                threads: console.threads().unwrap_or(1),
                rounds,
                least_rounds: defaults.least_rounds.min(rounds),
                ..defaults
            },
            command: command_line(),
        };
        let steps = plan.scenes.len() * plan.timed.len() * plan.options.passes();
        let mut progress = Progress::new(console, steps, "measuring");
        let mut kept = Ok(());
        let keep = |trade: &trade::Trade| {
            // What is known by now is not lost if the rest fails.
            kept = self.write_record(trade);
        };
        let trade = console.in_pool(1, || trade::run(&plan, &choices, &mut progress, keep))??;
        progress.finish();
        kept?;
        self.write_record(&trade)?;
        Ok(trade)
    }

    fn write_record(&self, trade: &trade::Trade) -> Result<(), Error> {
        // On one line: indented it would be five times as long.
        let json = serde_json::to_string(trade).map_err(io::Error::other);
        self.write("trade.json", &json.map_err(|error| Error::io("trade.json", error))?)
    }

    fn splice_into(&self, trade: &trade::Trade, path: &Path) -> Result<(), Error> {
        let text = std::fs::read_to_string(path).map_err(|error| Error::io(path.display(), error))?;
        let chart = self.out.join("curve.svg").display().to_string();
        let (summary, markers) = if text.contains(EXTREMES[0]) {
            (report::trade::extremes(trade), EXTREMES)
        } else {
            (report::trade::summary(trade, &chart).unwrap_or_default(), TRADE)
        };
        if summary.is_empty() {
            return Err(Error::usage(
                format!("{}: the record has nothing to write there", path.display()),
                "make a new one, with --extremes where extremes are wanted",
            ));
        }
        let text = splice_at(&text, &summary, markers)
            .map_err(|error| Error::usage(format!("{}: {error}", path.display()), "put the two lines in"))?;
        let written: Result<(), io::Error> = write_whole(path, |out| out.write_all(text.as_bytes()));
        written.map_err(|error| Error::io(path.display(), error))
    }

    fn write(&self, name: &str, text: &str) -> Result<(), Error> {
        let path: &Path = &self.out.join(name);
        let written: Result<(), io::Error> = write_whole(path, |out| out.write_all(text.as_bytes()));
        written.map_err(|error| Error::io(path.display(), error))
    }
}
