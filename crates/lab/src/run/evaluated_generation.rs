//! A generation that was just evaluated, and which of its individuals are kept.

use std::cmp::Ordering;

use super::generation_trials::GenerationTrials;
use snakes_core::evolve::{Candidate, Champion, Front, FrontMember, RunPlan, Rung, ranking};
use snakes_core::score::Evaluation;

/// The individuals and results of a generation that was just evaluated.
pub struct EvaluatedGeneration<'a> {
    pub plan: &'a RunPlan,
    /// Number of the generation; the first is 1.
    pub generation: u32,
    /// Trials of its individuals.
    pub trials: &'a GenerationTrials,
    /// Rung of the ladder on which the generation was evaluated; `None` without a ladder.
    pub rung: Option<Rung>,
    /// Candidates, in the same order as `evaluations`.
    pub candidates: &'a [Candidate],
    pub evaluations: &'a [Evaluation],
}

impl EvaluatedGeneration<'_> {
    /// Returns an individual as a champion.
    pub fn individual(&self, index: usize) -> Champion {
        Champion {
            genome: self.candidates[index].genome.clone(),
            trial: self.trials.of(index).clone(),
            evaluation: self.evaluations[index],
            chosen_by: None,
            origin: self.plan.origin(self.generation, index),
        }
    }

    /// Returns the indices of the healthy individuals that may become champions, the best first. Where individuals have stairs of
    /// their own, `rank` decides the order, because fitness on different stairs cannot be compared.
    pub fn ranking(&self, rank: impl Fn(&Champion) -> [f32; 2]) -> Vec<usize> {
        let mut ranking = ranking(self.evaluations);
        ranking.retain(|&index| self.candidates[index].may_be_champion);
        if !self.trials.are_own() {
            return ranking;
        }
        let with_rank = |index| (rank(&self.individual(index)), index);
        let mut ranks: Vec<([f32; 2], usize)> = ranking.into_iter().map(with_rank).collect();
        ranks.sort_by(|(a, _), (b, _)| b.partial_cmp(a).unwrap_or(Ordering::Equal));
        ranks.into_iter().map(|(_, index)| index).collect()
    }

    /// Adds to a front the individuals that no other beats in both distance and energy.
    pub fn extend(&self, front: &mut Front) {
        if self.trials.are_own() {
            // Distances on different stairs cannot be compared.
            return;
        }
        for (index, candidate) in self.candidates.iter().enumerate() {
            let (genome, evaluation) = (&candidate.genome, self.evaluations[index]);
            let start_y_m = self.trials.common.middle_start_y_m(genome);
            // Clone only the few genomes that enter the front.
            if candidate.may_be_champion && front.accepts(genome, &evaluation, start_y_m) {
                let (genome, generation) = (genome.clone(), self.generation);
                let individual = index as u32;
                front.add(FrontMember { genome, evaluation, generation, individual }, start_y_m);
            }
        }
    }

    /// Returns the number by which each individual is counted: its species, or its number of blocks where bodies evolve. Empty if
    /// there are no species.
    pub fn species(&self) -> Vec<u32> {
        if self.plan.settings.genome.bodies.vary {
            let blocks = |candidate: &Candidate| candidate.genome.body.block_count() as u32;
            self.candidates.iter().map(blocks).collect()
        } else {
            self.candidates.iter().filter_map(|candidate| candidate.species).collect()
        }
    }
}
