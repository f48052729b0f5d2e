//! Progress bars on the terminal. If standard error is not a terminal, none is drawn.

use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use crossbeam_channel::RecvTimeoutError;
use indicatif::{ProgressBar, ProgressStyle};

use super::evaluator::Evaluator;
use super::experiment::Experiment;
use super::report::GenerationReport;
use super::run_control::{Cancelled, RunControl};
use snakes_core::score::Evaluation;

/// Runs one generation with a progress bar; for `record`, see [`Experiment::run_generation_recording`].
///
/// # Errors
/// [`Cancelled`], if `control` was cancelled.
pub fn run_generation_with_bar(
    experiment: &mut Experiment,
    evaluator: &dyn Evaluator,
    control: &RunControl,
    record: impl Fn(u32, u32, &Evaluation) + Sync,
) -> Result<GenerationReport, Cancelled> {
    let bar = ProgressBar::new(experiment.population().into());
    // The template is a constant. If it were wrong, the default style would be used.
    if let Ok(style) = ProgressStyle::with_template("{msg} {wide_bar} {pos}/{len}  {eta} left") {
        bar.set_style(style);
    }
    bar.set_message(format!("generation {}", experiment.finished() + 1));
    with_bar(&bar, control, || experiment.run_generation_recording(evaluator, control, record))
}

/// Creates a bar that counts things, such as evaluations. `things` is their name.
pub fn bar_of(count: u64, things: &str) -> ProgressBar {
    let bar = ProgressBar::new(count).with_message(things.to_owned());
    // The template is a constant. If it were wrong, the default style would be used.
    if let Ok(style) = ProgressStyle::with_template("{wide_bar} {pos}/{len} {msg}  {eta} left") {
        bar.set_style(style);
    }
    bar
}

/// The bar that is currently drawn on the terminal.
static DRAWN: Mutex<Option<ProgressBar>> = Mutex::new(None);

fn set_drawn(bar: Option<ProgressBar>) {
    *DRAWN.lock().unwrap_or_else(PoisonError::into_inner) = bar;
}

/// Calls `write`, which writes to the terminal, while the bar is hidden.
pub fn beside_bar<T>(write: impl FnOnce() -> T) -> T {
    let bar = DRAWN.lock().unwrap_or_else(PoisonError::into_inner).clone();
    match bar {
        Some(bar) => bar.suspend(write),
        None => write(),
    }
}

/// Does `work` while a bar shows the number that `control` has counted.
pub fn with_bar<T>(bar: &ProgressBar, control: &RunControl, work: impl FnOnce() -> T) -> T {
    set_drawn(Some(bar.clone()));
    let result = std::thread::scope(|scope| {
        let (finished, is_finished) = crossbeam_channel::bounded::<()>(0);
        scope.spawn(move || {
            // The loop ends when the sender is dropped.
            while is_finished.recv_timeout(Duration::from_millis(100))
                == Err(RecvTimeoutError::Timeout)
            {
                bar.set_position(control.done().into());
            }
        });
        let result = work();
        drop(finished);
        result
    });
    set_drawn(None);
    bar.finish_and_clear();
    result
}
