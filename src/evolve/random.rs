//! Random search: every individual is drawn from nothing, and nothing is learned.

use super::search::Search;
use super::{PointState, RunPlan, Strategy, StrategyState};
use crate::genome::Genome;
use crate::score::Evaluation;

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
        (0..self.search.population).map(|individual| self.search.newborn(individual)).collect()
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
}
