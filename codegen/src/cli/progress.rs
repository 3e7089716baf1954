//! A bar on standard error while something takes its time.

use std::io::{IsTerminal, Write, stderr};
use std::path::Path;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::sync::{Mutex, PoisonError};
use std::thread::{Builder, JoinHandle};
use std::time::Duration;

use super::settings::quiet;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::bounds::Effort;
use crate::check::read;
use crate::error::Error;
use crate::pipeline::Generation;
use crate::progress::Progress;
use crate::text::escaped;

/// What is over sooner shows no bar.
const PATIENCE: Duration = Duration::from_secs(1);
/// Time between two turns of the spinner, which turns whether anybody reports or not.
const TICK: Duration = Duration::from_millis(100);
/// Of a stage of several parts, and of one that only begins and ends.
const COUNTED: &str = "{spinner} {msg} {bar:24} {pos}/{len}  {elapsed}";
const PLAIN: &str = "{spinner} {msg}  {elapsed}";

/// Does `work` with a bar for as long as it lasts.
pub(super) fn watched<T>(work: impl FnOnce(&dyn Progress) -> T) -> T {
    work(&Bars::new())
}

/// All stages of the specification at `path`, with a bar.
///
/// # Errors
/// As [`Generation::from_file`].
pub(super) fn generated(path: &Path) -> Result<Generation, Error> {
    let loaded = read(path)?;
    watched(|progress| Generation::with_progress(loaded, &Effort::default(), progress))
}

/// The model of the specification at `path` alone, with a bar.
///
/// # Errors
/// As [`Generation::model`].
pub(super) fn modelled(path: &Path) -> Result<Generation, Error> {
    let loaded = read(path)?;
    watched(|progress| Generation::model_only(loaded, &Effort::default(), progress))
}

/// The stage under way in a line of its own on standard error, from one second on until this is dropped; nothing where
/// standard error is not a terminal.
#[derive(Debug)]
pub(super) struct Bars {
    shown: Option<Shown>,
}

#[derive(Debug)]
struct Shown {
    bar: ProgressBar,
    open: Mutex<Open>,
    /// Dropped to stop `delay`.
    stop: Option<Sender<()>>,
    delay: Option<JoinHandle<()>>,
}

impl Bars {
    /// Waits for stages.
    pub(super) fn new() -> Self {
        Self { shown: (stderr().is_terminal() && !quiet()).then(Shown::new) }
    }

    /// Shows a line above the bar, on a terminal alone.
    pub(super) fn say(&self, line: &str) {
        if let Some(shown) = &self.shown {
            // Where standard error takes nothing, there is nobody to tell.
            shown.bar.suspend(|| writeln!(stderr().lock(), "{}", escaped(line))).unwrap_or_default();
        }
    }
}

impl Progress for Bars {
    fn report(&self, stage: &str, done: usize, total: usize) {
        if let Some(shown) = &self.shown {
            shown.report(stage, done, total);
        }
    }
}

impl Shown {
    fn new() -> Self {
        let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden());
        let (stop, stopped) = channel();
        let waiting = bar.clone();
        let delay = Builder::new().spawn(move || {
            if stopped.recv_timeout(PATIENCE) == Err(RecvTimeoutError::Timeout) {
                waiting.set_draw_target(ProgressDrawTarget::stderr());
                waiting.enable_steady_tick(TICK);
            }
        });
        // Without a thread to spare there is no bar, and all else goes on.
        Self { bar, open: Mutex::default(), stop: Some(stop), delay: delay.ok() }
    }

    fn report(&self, stage: &str, done: usize, total: usize) {
        let mut open = self.open.lock().unwrap_or_else(PoisonError::into_inner);
        let Some((stage, done, total)) = open.report(stage, done, total) else { return };
        let style = |template| {
            // A template that indicatif did not take would leave its own style, which is good enough.
            if let Ok(style) = ProgressStyle::with_template(template) {
                self.bar.set_style(style.progress_chars("=> "));
            }
        };
        // Each of these may draw: no count may stand beside the name of another stage.
        let changed = self.bar.message() != *stage;
        if changed {
            style(PLAIN);
            self.bar.set_message(stage.clone());
        }
        self.bar.set_length(*total as u64);
        self.bar.set_position(*done as u64);
        if changed && *total > 1 {
            style(COUNTED);
        }
    }
}

impl Drop for Shown {
    fn drop(&mut self) {
        self.stop = None;
        if let Some(delay) = self.delay.take() {
            // It holds nothing whose loss would matter.
            let _ = delay.join();
        }
        self.bar.finish_and_clear();
    }
}

/// The stages that have begun and not ended, the innermost last.
#[derive(Debug, Default)]
struct Open(Vec<(String, usize, usize)>);

impl Open {
    /// Takes in a report; returns what is to be shown now, if anything.
    fn report(&mut self, stage: &str, done: usize, total: usize) -> Option<&(String, usize, usize)> {
        match self.0.iter_mut().find(|(name, ..)| name == stage) {
            Some(known) => (known.1, known.2) = (done, total),
            None => self.0.push((stage.to_string(), done, total)),
        }
        self.0.retain(|(_, done, total)| done < total);
        self.0.last()
    }
}

#[cfg(test)]
mod tests {
    use super::Open;

    #[test]
    fn the_innermost_open_stage_is_shown() {
        let mut open = Open::default();
        let mut shown = |stage: &str, done, total| {
            open.report(stage, done, total).map(|(name, done, total)| format!("{name} {done}/{total}"))
        };
        assert_eq!(shown("outer", 0, 1).unwrap(), "outer 0/1");
        assert_eq!(shown("inner", 0, 3).unwrap(), "inner 0/3");
        assert_eq!(shown("inner", 2, 3).unwrap(), "inner 2/3");
        assert_eq!(shown("empty", 0, 0).unwrap(), "inner 2/3");
        assert_eq!(shown("inner", 3, 3).unwrap(), "outer 0/1");
        assert_eq!(shown("outer", 1, 1), None);
    }
}
