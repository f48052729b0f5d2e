//! Progress bars on the terminal. If standard error is not a terminal, none is drawn.

use std::thread;
use std::time::Duration;

use crossbeam_channel::RecvTimeoutError;
use indicatif::{ProgressBar, ProgressStyle};

use super::evaluator::Evaluator;
use super::experiment::Experiment;
use super::report::GenerationReport;
use super::run_control::{Cancelled, RunControl};
use super::terminal::set_drawn;
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

/// Does `work` while a bar shows the number that `control` has counted.
pub fn with_bar<T>(bar: &ProgressBar, control: &RunControl, work: impl FnOnce() -> T) -> T {
    while_drawn(bar, &|| bar.set_position(control.done().into()), work)
}

/// Does `work`, which moves the bar itself, while the bar's estimate is kept up to date.
pub fn beneath_bar<T>(bar: &ProgressBar, work: impl FnOnce() -> T) -> T {
    while_drawn(bar, &|| bar.tick(), work)
}

/// Does `work` while a thread draws the bar again and again. If the system refuses the thread, the work is done all the same.
fn while_drawn<T>(bar: &ProgressBar, draw: &(dyn Fn() + Sync), work: impl FnOnce() -> T) -> T {
    set_drawn(Some(bar.clone()));
    let result = thread::scope(|scope| {
        let (finished, is_finished) = crossbeam_channel::bounded::<()>(0);
        let redraw = move || {
            // The loop ends when the sender is dropped.
            while is_finished.recv_timeout(Duration::from_millis(100))
                == Err(RecvTimeoutError::Timeout)
            {
                draw();
            }
        };
        let _ = thread::Builder::new().name("progress bar".to_owned()).spawn_scoped(scope, redraw);
        let result = work();
        drop(finished);
        result
    });
    set_drawn(None);
    bar.finish_and_clear();
    result
}
