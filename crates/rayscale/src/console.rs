//! What verbs say, and to whom: results to standard output, progress and notes to standard error.

use crate::error::Error;
use accel::Scene;
use anstream::stream::IsTerminal;
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use report::table::printable;
use scenes::{SceneError, SceneSpec};
use serde::Serialize;
use std::fmt::Display;
use std::io::{self, Write};
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::time::Duration;

/// Options of every verb.
#[derive(Clone, Debug, Default, Args)]
#[command(next_help_heading = "Everywhere")]
pub struct Global {
    /// No progress and no notes; results and errors only
    #[arg(short, long, global = true)]
    pub quiet: bool,
    /// Print results as JSON
    #[arg(long, global = true)]
    pub json: bool,
    /// Threads to use; each verb's help says what it uses otherwise
    #[arg(long, global = true, value_name = "N", value_parser = threads)]
    pub threads: Option<NonZeroUsize>,
    /// The folder of scene definitions that go before the program's own; $RAYSCALE_SCENES or ./scenes otherwise
    #[arg(long = "scenes", global = true, value_name = "DIR")]
    pub scenes_folder: Option<PathBuf>,
    /// The folder of meshes; otherwise $RAYSCALE_MESHES, or .setup/meshes here or above, then rayscale/meshes in your
    /// data folder
    #[arg(long = "meshes", global = true, value_name = "DIR")]
    pub meshes_folder: Option<PathBuf>,
}

/// Threads that may be asked for: more than any machine has, and few enough for every system to give them at once.
const MAX_THREADS: usize = 1024;

fn threads(text: &str) -> Result<NonZeroUsize, String> {
    let number = text.parse::<NonZeroUsize>().ok().filter(|number| number.get() <= MAX_THREADS);
    number.ok_or_else(|| format!("must be a number of threads from 1 to {MAX_THREADS}"))
}

/// The user's terminal, or the files that stand for it.
#[derive(Debug)]
pub struct Console {
    global: Global,
    grammar: fn() -> clap::Command,
}

const RED: &str = "\x1b[1;31m";
const CYAN: &str = "\x1b[36m";
const PLAIN: &str = "\x1b[0m";

impl Console {
    /// A console that minds the options of every verb; `grammar` is the program's.
    pub const fn new(global: Global, grammar: fn() -> clap::Command) -> Self {
        Self { global, grammar }
    }

    /// The program's grammar, for help texts and completions.
    pub fn grammar(&self) -> clap::Command {
        (self.grammar)()
    }

    /// Whether results are to be JSON.
    pub const fn json(&self) -> bool {
        self.global.json
    }

    /// Whether only results and errors are wanted.
    pub const fn quiet(&self) -> bool {
        self.global.quiet
    }

    /// `--threads`, if given.
    pub fn threads(&self) -> Option<usize> {
        self.global.threads.map(NonZeroUsize::get)
    }

    /// Runs `work` in a thread pool of `--threads`, or else `otherwise` threads (0: one a core).
    ///
    /// # Errors
    /// [`Error::Usage`] if the system does not give that many.
    pub fn in_pool<T: Send>(&self, otherwise: usize, work: impl FnOnce() -> T + Send) -> Result<T, Error> {
        let threads = self.threads().unwrap_or(otherwise);
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
        let pool = pool.map_err(|error| {
            Error::usage(format!("{threads} threads: {error}"), "choose a smaller number for --threads")
        })?;
        Ok(pool.install(work))
    }

    /// Prints a result: as text, or with `--json` as one JSON value.
    ///
    /// # Errors
    /// [`Error::Io`] when standard output takes no more.
    pub fn result<T: Serialize>(&self, value: &T, text: impl Display) -> Result<(), Error> {
        if self.global.json {
            let json = serde_json::to_string_pretty(value).map_err(io::Error::other);
            return self.print(json.map_err(|error| Error::io("standard output", error))?);
        }
        self.print(text)
    }

    /// Prints text to standard output, with a newline. Names in records and files are other people's: what a terminal
    /// takes for commands is made visible, as JSON would write it.
    ///
    /// # Errors
    /// [`Error::Io`] when standard output takes no more.
    pub fn print(&self, text: impl Display) -> Result<(), Error> {
        let mut out = anstream::stdout().lock();
        writeln!(out, "{}", printable(&text.to_string()))
            .and_then(|()| out.flush())
            .map_err(|error| Error::io("standard output", error))
    }

    /// Tells the user something that is no result; silent with `--quiet`.
    pub fn note(&self, text: impl Display) {
        if !self.global.quiet {
            // Nobody is left to be told that standard error is closed.
            let _ = writeln!(anstream::stderr(), "{}", printable(&text.to_string()));
        }
    }

    /// Loads a scene and says what a user should know of how it was read.
    ///
    /// # Errors
    /// Scenes that are not known or not sound.
    pub fn scene(&self, spec: &SceneSpec) -> Result<Scene, SceneError> {
        let loaded = scenes::load_full(spec)?;
        loaded.notes.iter().for_each(|note| self.note(note));
        Ok(loaded.scene)
    }

    /// Says what went wrong and what to do.
    pub fn error(&self, error: &Error) {
        let todo = error.todo();
        let mut out = anstream::stderr();
        let written = if self.global.json {
            let json = serde_json::json!({ "error": error.to_string(), "todo": todo }).to_string();
            writeln!(out, "{}", printable(&json))
        } else {
            let text = error.to_string();
            writeln!(out, "{RED}error:{PLAIN} {}", printable(&text)).and_then(|()| match todo {
                Some(todo) => writeln!(out, "{CYAN}to do:{PLAIN} {}", printable(&todo)),
                None => Ok(()),
            })
        };
        // As in `note`.
        let _ = written;
    }

    /// Progress over `len` steps: a bar on a terminal, otherwise hidden; use [`Console::note`] for
    /// lines that are to be seen in both.
    pub fn bar(&self, len: u64, what: impl Display) -> ProgressBar {
        if self.global.quiet || !io::stderr().is_terminal() {
            return ProgressBar::hidden();
        }
        let style = ProgressStyle::with_template("{msg} [{bar:30}] {pos}/{len} {eta}")
            .map(|style| style.progress_chars("=> "))
            .unwrap_or_else(|_| ProgressStyle::default_bar());
        let bar =
            ProgressBar::new(len).with_style(style).with_message(printable(&what.to_string()).into_owned());
        bar.enable_steady_tick(Duration::from_millis(200));
        bar
    }
}
