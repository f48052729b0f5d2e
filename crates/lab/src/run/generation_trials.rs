//! The trials of a generation: a single trial for all individuals, or trials on the individuals' own stairs.

use snakes_core::evolve::{Candidate, OwnStairs};
use snakes_core::score::{Evaluation, Trial};

/// Trials of a generation, and which individual has which trial.
#[derive(Debug, Clone, PartialEq)]
pub struct GenerationTrials {
    /// Trial of the run. Individuals with stairs of their own have other trials.
    pub common: Trial,
    /// All different trials, in the order in which individuals first need them.
    pub all: Vec<Trial>,
    /// Index in `all` of each individual's trial. Empty if all individuals have the first trial.
    of: Vec<usize>,
}

impl GenerationTrials {
    /// Makes the trials of candidates: on their own stairs, or all in `common` if they have none.
    pub fn new(common: Trial, candidates: &[Candidate]) -> Self {
        let mut different: Vec<&OwnStairs> = Vec::new();
        let mut of = Vec::new();
        for own in candidates.iter().filter_map(|candidate| candidate.stairs.as_ref()) {
            // The search begins at the end, because individuals on the same stairs are adjacent.
            let known = different.iter().rposition(|other| *other == own);
            of.push(known.unwrap_or(different.len()));
            if known.is_none() {
                different.push(own);
            }
        }
        if of.is_empty() {
            return Self { all: vec![common.clone()], common, of };
        }
        let all = different.into_iter().map(|own| own.on(&common)).collect();
        Self { common, all, of }
    }

    /// Returns whether individuals have stairs of their own.
    pub fn are_own(&self) -> bool {
        !self.of.is_empty()
    }

    /// Returns the index in `all` of an individual's trial.
    pub fn index_of(&self, individual: usize) -> usize {
        self.of.get(individual).copied().unwrap_or(0)
    }

    /// Returns the number of trials that were simulated for these evaluations, which are in the order of the individuals.
    pub fn simulations(&self, evaluations: &[Evaluation]) -> u64 {
        let of = |(index, evaluation): (usize, &Evaluation)| {
            u64::from(self.of(index).simulations_of(evaluation))
        };
        evaluations.iter().enumerate().map(of).sum()
    }

    /// Returns the trial of an individual.
    pub fn of(&self, individual: usize) -> &Trial {
        self.all.get(self.index_of(individual)).unwrap_or(&self.common)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use snakes_core::evolve::{Parents, RunPlan, Settings, begin};
    use snakes_core::world::Stairs;
    use std::sync::Arc;

    #[test]
    fn individuals_on_equal_stairs_share_a_trial() {
        let plan = RunPlan::new("test", 1, Settings::default());
        let genome = begin(&plan).ask().remove(0).genome;
        let own = |steps, perturbed| {
            let stairs = Arc::new(Stairs { steps, ..Stairs::default() });
            let mut candidate = Candidate::new(genome.clone(), Parents::None);
            candidate.stairs = Some(OwnStairs { stairs, perturbed });
            candidate
        };
        let trials = GenerationTrials::new(
            Trial::default(),
            &[own(3, 0), own(3, 0), own(4, 0), own(3, 2), own(4, 0)],
        );
        assert_eq!(trials.all.len(), 3);
        let steps = [0, 1, 2, 3, 4].map(|index| trials.of(index).stairs.steps);
        assert_eq!(steps, [3, 3, 4, 3, 4]);
        let repeats = [2, 3, 4].map(|index| trials.of(index).repeats.trials);
        assert_eq!(repeats, [1, 3, 1]);
        let common = GenerationTrials::new(Trial::default(), &[]);
        assert!(!common.are_own());
        assert_eq!(*common.of(7), Trial::default());
    }
}
