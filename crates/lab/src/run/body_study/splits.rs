//! How much the share of adapted snakes changes when one of their blocks is split, and when one is inserted.

use crate::run::evaluator::Evaluator;
use crate::run::lineage::Generation;
use crate::run::run_control::{Cancelled, RunControl};
use snakes_core::evolve::{RunPlan, ranking};
use snakes_core::genome::{BodyChange, Genome};
use snakes_core::rng::{Purpose, stream};

/// Number of the best snakes of the last generation that are changed.
const CHANGED: usize = 20;
/// Attempts to change a body within its limits.
const ATTEMPTS: usize = 20;

/// The changes of the share by a split and by an insertion at a random place, one for each of the best snakes of a
/// generation whose body allows the change. A snake that is disqualified then has lost its whole share.
pub(super) fn split_changes(
    plan: &RunPlan,
    last: &Generation,
    evaluator: &dyn Evaluator,
    control: &RunControl,
) -> Result<[Vec<f32>; 2], Cancelled> {
    let (space, trial) = (&plan.settings.genome, plan.trial_in(last.number));
    let mut changes = [Vec::new(), Vec::new()];
    for (change, found) in [BodyChange::Split, BodyChange::Insert].into_iter().zip(&mut changes) {
        let (mut before, mut children): (Vec<f32>, Vec<Genome>) = (Vec::new(), Vec::new());
        for index in ranking(&last.evaluations).into_iter().take(CHANGED) {
            let mut rng = stream(plan.seed, last.number, index as u32, Purpose::Study);
            let genome = &last.genomes[index];
            let child =
                (0..ATTEMPTS).find_map(|_| space.with_body_change(genome, change, &mut rng));
            if let Some(child) = child {
                before.push(last.evaluations[index].fitness);
                children.push(child);
            }
        }
        let jobs: Vec<&Genome> = children.iter().collect();
        let after: Vec<std::sync::OnceLock<f32>> = vec![std::sync::OnceLock::new(); jobs.len()];
        evaluator.evaluate_batch(&trial, &jobs, control, &|job, result| {
            let share = result.map_or(0.0, |scored| match scored.evaluation.disqualified {
                None => scored.evaluation.fitness,
                Some(_) => 0.0,
            });
            // A second result of the same job is the same.
            let _ = after[job].set(share);
        })?;
        let after = after.iter().map(|share| share.get().copied().unwrap_or(0.0));
        *found = after.zip(before).map(|(after, before)| after - before).collect();
    }
    Ok(changes)
}
