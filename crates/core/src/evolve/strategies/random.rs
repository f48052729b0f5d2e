//! Random search, which learns nothing. Only the first generation depends on the founder, if there is one.

use super::search::Search;
use crate::check::Invalid;
use crate::evolve::candidate::Candidate;
use crate::evolve::parents::Parents;
use crate::evolve::plan::RunPlan;
use crate::evolve::strategy::{Strategy, StrategyState};
use crate::score::Evaluation;

/// Standard deviation of the mutations of a founder, as a share of each gene's range.
const FOUNDER_STEP: f64 = 0.1;

/// Random search as a strategy.
#[derive(Debug, Clone)]
pub struct Random {
    search: Search,
}

impl Strategy for Random {
    fn begin(plan: &RunPlan) -> Self {
        Self { search: Search::new(plan, 0) }
    }

    fn resume(plan: &RunPlan, finished: u32, state: &StrategyState) -> Result<Self, Invalid> {
        let () = state.read()?;
        Ok(Self { search: Search::new(plan, finished) })
    }

    fn ask(&self) -> Vec<Candidate> {
        let genome = |individual| match self.search.founder_of(individual) {
            Some(_) => self.search.genome(&self.search.first_point(individual, FOUNDER_STEP)),
            None => self.search.random_genome(individual),
        };
        let candidate = |individual| Candidate::new(genome(individual), Parents::None);
        self.search.with_founder_first((0..self.search.population).map(candidate).collect())
    }

    fn population(&self) -> usize {
        self.search.population
    }

    fn tell(&mut self, _: &[Candidate], _: &[Evaluation]) {
        self.search.generation += 1;
    }

    fn state(&self) -> StrategyState {
        StrategyState::of(&())
    }

    fn apply_settings(&mut self, plan: &RunPlan) {
        self.search.apply_settings(plan);
    }
}
