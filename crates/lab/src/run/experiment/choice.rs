//! Choosing the champion of a generation.

use crate::run::evaluated_generation::EvaluatedGeneration;
use crate::run::evaluator::{Evaluator, Job, evaluate_in_order};
use crate::run::run_control::{Cancelled, RunControl};
use snakes_core::evolve::Champion;
use snakes_core::score::Trial;

/// Number of individuals of each generation that compete for champion: the best in their own trial.
const CANDIDATES: usize = 2;

/// Chooses the champion of a generation. `ranking` has the indices of its healthy individuals, the best first. The champion is the
/// first of them or, if the settings have a list of varied trials, the candidate with the greatest fitness on that list; `None` if
/// there is none. Also returns the number of trials that the choice simulated.
///
/// # Errors
/// [`Cancelled`], if `control` was cancelled.
pub(super) fn choose_champion(
    evaluated: &EvaluatedGeneration<'_>,
    ranking: &[usize],
    evaluator: &dyn Evaluator,
    control: &RunControl,
    rank: impl Fn(&Champion) -> [f32; 2],
) -> Result<(Option<Champion>, u64), Cancelled> {
    let candidates = &ranking[..ranking.len().min(CANDIDATES)];
    let of = |&index: &usize| evaluated.trials.of(index).that_chooses_champions();
    let Some(trials) = candidates.iter().map(of).collect::<Option<Vec<Trial>>>() else {
        return Ok((ranking.first().map(|&index| evaluated.individual(index)), 0));
    };
    let genomes: Vec<_> =
        candidates.iter().map(|&index| &evaluated.candidates[index].genome).collect();
    let jobs: Vec<Job<'_>> =
        genomes.iter().enumerate().map(|(trial, genome)| Job { genome, trial }).collect();
    let results = evaluate_in_order(&trials, &jobs, evaluator, control)?;
    let (mut best, mut simulations) = (None::<Champion>, 0);
    for ((&index, result), trial) in candidates.iter().zip(results).zip(&trials) {
        // A candidate whose simulation panics on the list cannot become champion.
        let Ok(on_list) = result else { continue };
        simulations += u64::from(trial.simulations_of(&on_list.evaluation));
        let chosen_by = Some(on_list.evaluation.fitness);
        let candidate = Champion { chosen_by, ..evaluated.individual(index) };
        if best.as_ref().is_none_or(|best| rank(&candidate) > rank(best)) {
            best = Some(candidate);
        }
    }
    Ok((best, simulations))
}
