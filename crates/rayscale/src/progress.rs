//! Progress as the user sees it: a bar on a terminal, lines elsewhere.

use crate::console::Console;
use harness::progress::{Event, Listener};
use indicatif::ProgressBar;

/// Shows events.
pub struct Progress<'c> {
    console: &'c Console,
    bar: ProgressBar,
}

impl<'c> Progress<'c> {
    /// Over so many ray sets, scenes or meshes.
    pub fn new(console: &'c Console, steps: usize, what: &str) -> Self {
        Self { console, bar: console.bar(steps as u64, what) }
    }

    /// Takes the bar away.
    pub fn finish(self) {
        self.bar.finish_and_clear();
    }
}

impl Listener for Progress<'_> {
    fn hear(&mut self, event: &Event) {
        if matches!(event, Event::RaySetDone { .. } | Event::SceneChecked { .. } | Event::MeshBegun { .. }) {
            self.bar.inc(1);
        }
        if let Event::SceneNote { .. } = event {
            // More than what is being done: it stays when the bar is gone.
            self.bar.suspend(|| self.console.note(event));
            return;
        }
        if !self.bar.is_hidden() {
            self.bar.set_message(event.to_string());
            return;
        }
        match event {
            Event::RaySetDone { pass: 1, .. } => self.console.note(format_args!("  {event}")),
            // Further passes are no news to a log.
            Event::RaySetDone { .. } => {}
            Event::RaysDecided { done, of, .. } if done < of => {}
            _ => self.console.note(event),
        }
    }
}
