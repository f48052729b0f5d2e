//! Random search: every individual is drawn from nothing, and nothing is learned. Only a founder, if there is one,
//! makes a difference, in the first generation.

use super::search::Search;
use super::{Parents, PointState, RunPlan, Strategy, StrategyState};
use crate::genome::Genome;
use crate::score::Evaluation;

/// Standard deviation of the steps of a founder's mutants, as a share of each gene's range.
const FOUNDERS_STEP: f64 = 0.1;

/// Random search at work.
#[derive(Debug, Clone)]
pub struct Random {
    search: Search,
}

impl Random {
    /// A fresh search.
    pub fn new(plan: &RunPlan) -> Self {
        Self::resumed(plan, 0)
    }

    /// A search after its first `finished` generations.
    pub fn resumed(plan: &RunPlan, finished: u32) -> Self {
        Self { search: Search::new(plan, finished) }
    }
}

impl Strategy for Random {
    fn ask(&self) -> Vec<Genome> {
        let individual = |individual| match self.search.founder() {
            Some(_) if Search::is_founders_mutant(individual) => {
                self.search.genome(&self.search.first_point(individual, FOUNDERS_STEP))
            }
            _ => self.search.newborn(individual),
        };
        let genomes = (0..self.search.population).map(individual).collect();
        self.search.beginning_with_founder(genomes)
    }

    fn population(&self) -> usize {
        self.search.population
    }

    fn tell(&mut self, _: &[Genome], _: &[Evaluation]) {
        self.search.generation += 1;
    }

    fn state(&self) -> StrategyState {
        StrategyState::points(PointState::Random)
    }

    fn amend(&mut self, plan: &RunPlan) {
        self.search.amend(plan);
    }

    fn parents(&self) -> Vec<Parents> {
        vec![Parents::Newborn; self.search.population]
    }
}
