//! The choice of a generation's champion.

use crate::run::evaluated_generation::EvaluatedGeneration;
use crate::run::evaluator::{Evaluator, Job, evaluate_in_order};
use crate::run::run_control::{Cancelled, RunControl};
use snakes_core::evolve::Champion;
use snakes_core::score::Trial;

/// Number of candidates in each generation: the best ones in their own trial.
const CANDIDATES: usize = 2;

/// The champion of a generation, given the indices of its healthy individuals, the best first: the first of them, or,
/// if the settings say so, the candidate with the greatest fitness on a fixed list of varied trials. `None` if all
/// were disqualified. The second result is the number of trials that this has simulated.
///
/// # Errors
/// [`Cancelled`], if `control` was.
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
        // A candidate that fails on the list is no champion, and the evaluator's report of its own trial stands.
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
