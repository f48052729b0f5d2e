//! The trials of a generation: one for all, or those of the stairs on which its individuals are evaluated.

use snakes_core::evolve::{Candidate, OwnStairs};
use snakes_core::score::{Evaluation, Trial};

/// The trials of a generation, and which individual has which.
#[derive(Debug, Clone, PartialEq)]
pub struct GenerationTrials {
    /// The trial of the run; with stairs of their own, individuals have others.
    pub common: Trial,
    /// The different trials, in the order in which individuals first need them.
    pub all: Vec<Trial>,
    /// The index of each individual's trial; empty if all have the first.
    of: Vec<usize>,
}

impl GenerationTrials {
    /// The trials of candidates: on their own stairs, or all in `common` if they have none.
    pub fn new(common: Trial, candidates: &[Candidate]) -> Self {
        let mut different: Vec<&OwnStairs> = Vec::new();
        let mut of = Vec::new();
        for own in candidates.iter().filter_map(|candidate| candidate.stairs.as_ref()) {
            // From the end: individuals on the same stairs follow one another.
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

    /// Whether individuals have stairs of their own.
    pub fn are_own(&self) -> bool {
        !self.of.is_empty()
    }

    /// Index of the trial of an individual.
    pub fn index_of(&self, individual: usize) -> usize {
        self.of.get(individual).copied().unwrap_or(0)
    }

    /// Number of trials that were simulated for these evaluations, which are in the order of the individuals.
    pub fn simulations(&self, evaluations: &[Evaluation]) -> u64 {
        let of = |(index, evaluation): (usize, &Evaluation)| {
            u64::from(self.of(index).simulations_of(evaluation))
        };
        evaluations.iter().enumerate().map(of).sum()
    }

    /// The trial of an individual.
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
