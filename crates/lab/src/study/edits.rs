//! Changes in the fitness of adapted snakes when one of their blocks is split, and when one is inserted.

use crate::run::{Cancelled, Evaluator, Generation, Job, RunControl, evaluate_in_order};
use snakes_core::evolve::{RunPlan, ranking};
use snakes_core::genome::{BodyChange, Genome};
use snakes_core::rng::{Purpose, stream};

/// Number of the best snakes of the last generation whose bodies are changed.
const CHANGED: usize = 20;
/// Maximum number of attempts to change a body within its limits.
const ATTEMPTS: usize = 20;

/// Name of a value, and its numbers: changes in fitness, one for each snake.
pub(super) type EditChanges = (&'static str, Vec<Option<f64>>);

/// Splits a block, or inserts one, at a random place in each of the best snakes of a generation whose body allows it. Returns the
/// changes in fitness of both. A snake that is disqualified after the change loses its whole fitness.
///
/// # Errors
/// `control` was cancelled.
pub(super) fn edit_changes(
    plan: &RunPlan,
    last: &Generation,
    evaluator: &dyn Evaluator,
    control: &RunControl,
) -> Result<Vec<EditChanges>, Cancelled> {
    let space = &plan.settings.genome;
    let mut values = Vec::new();
    for (name, change) in
        [("split_changes", BodyChange::Split), ("insertion_changes", BodyChange::Insert)]
    {
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
        let jobs: Vec<Job<'_>> = children.iter().map(|genome| Job { genome, trial: 0 }).collect();
        let trials = [plan.trial_in(last.number)];
        let results = evaluate_in_order(&trials, &jobs, evaluator, control)?;
        let after = results.into_iter().map(|result| match result {
            Ok(scored) if scored.evaluation.disqualified.is_none() => scored.evaluation.fitness,
            _ => 0.0,
        });
        let changes = after.zip(before).map(|(after, before)| Some(f64::from(after - before)));
        values.push((name, changes.collect()));
    }
    Ok(values)
}
