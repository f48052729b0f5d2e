//! Random search, which learns nothing. Only a founder, if there is one, makes a difference, in the first generation.

use super::search::Search;
use crate::check::Invalid;
use crate::evolve::parents::Parents;
use crate::evolve::plan::RunPlan;
use crate::evolve::strategy::{Strategy, StrategyState};
use crate::genome::Genome;
use crate::score::Evaluation;

/// Standard deviation of the mutations of a founder, as a share of each gene's range.
const FOUNDER_STEP: f64 = 0.1;

/// Random search.
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

    fn ask(&self) -> Vec<Genome> {
        let individual = |individual| match self.search.founder() {
            Some(_) if Search::is_founder_mutant(individual) => {
                self.search.genome(&self.search.first_point(individual, FOUNDER_STEP))
            }
            _ => self.search.random_genome(individual),
        };
        let genomes = (0..self.search.population).map(individual).collect();
        self.search.with_founder_first(genomes)
    }

    fn population(&self) -> usize {
        self.search.population
    }

    fn tell(&mut self, _: &[Genome], _: &[Evaluation]) {
        self.search.generation += 1;
    }

    fn state(&self) -> StrategyState {
        StrategyState::of(&())
    }

    fn apply_settings(&mut self, plan: &RunPlan) {
        self.search.apply_settings(plan);
    }

    fn parents(&self) -> Vec<Parents> {
        vec![Parents::None; self.search.population]
    }
}
