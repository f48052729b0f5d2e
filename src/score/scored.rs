//! Scoring a genome: its evaluation, and the experience of its episode.

use super::{Evaluation, Rollout, Trial};
use crate::genome::Genome;
use crate::learn::Episode;

/// The outcome of scoring a genome.
#[derive(Debug, Clone, PartialEq)]
pub struct Scored {
    /// The evaluation.
    pub evaluation: Evaluation,
    /// The experience of the nominal trial, of a controller that learns from it.
    pub episode: Option<Episode>,
}

/// Scores a genome: runs its rollout to the end, and then its perturbed trials, if the settings ask for them.
/// Of these only the fitness counts: see [`super::Repeats`].
///
/// The perturbations are derived from the genome's own bits, from a fixed seed, or from the number of a generation's list,
/// which its trial holds. A champion's file is therefore enough to score it again.
pub fn score(genome: &Genome, trial: &Trial) -> Scored {
    let mut rollout = Rollout::new(genome, trial);
    while rollout.advance() {}
    let nominal = rollout.evaluation();
    let episode = rollout.finish();
    let repeats = &trial.repeats;
    if repeats.trials <= 1 || nominal.disqualified.is_some() {
        return Scored { evaluation: nominal, episode };
    }
    let mut fitnesses = vec![nominal.fitness];
    let hash = genome.hash();
    fitnesses.extend((1..repeats.trials).map(|number| {
        let perturbation = repeats.off.draw(
            trial.duration_s,
            trial.agent.limbs,
            &mut repeats.stream(hash, number),
        );
        let mut rollout = Rollout::perturbed(genome, trial, &perturbation);
        let at_start = rollout.evaluation().fitness;
        while rollout.advance() {}
        let evaluation = rollout.evaluation();
        // A disqualified trial scores at most its starting fitness. It may score less where energy costs.
        if evaluation.disqualified.is_some() {
            at_start.min(evaluation.fitness)
        } else {
            evaluation.fitness
        }
    }));
    let evaluation = Evaluation { fitness: repeats.counts.of(&fitnesses), ..nominal };
    Scored { evaluation, episode }
}

/// The evaluation of a genome: see [`score`].
pub fn evaluate(genome: &Genome, trial: &Trial) -> Evaluation {
    score(genome, trial).evaluation
}
