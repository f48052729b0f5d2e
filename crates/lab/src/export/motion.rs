//! The motion of a champion, simulated again step by step.

use super::{ExportError, ExportProgress};
use snakes_core::evolve::Champion;
use snakes_core::score::Rollout;

/// Number of steps between two checks whether the user cancelled.
const STEPS_PER_LOOK: u32 = 64;

/// Simulates a champion, and calls `each` at the start and after every healthy step.
pub(super) fn follow(
    champion: &Champion,
    progress: &ExportProgress,
    mut each: impl FnMut(&Rollout) -> Result<(), ExportError>,
) -> Result<(), ExportError> {
    let mut rollout = Rollout::new(&champion.genome, &champion.trial);
    each(&rollout)?;
    while rollout.advance() {
        each(&rollout)?;
        if rollout.step().is_multiple_of(STEPS_PER_LOOK) {
            progress.reach(f64::from(rollout.step()) / f64::from(rollout.last_step().max(1)))?;
        }
    }
    progress.reach(1.0)
}
