//! Searches within a strategy. Each is a strategy with a plan of its own, whose run never ends.

use std::sync::Arc;

use serde::{Serialize, Serializer};

use crate::check::{Invalid, within};
use crate::evolve::plan::{Founder, RunPlan};
use crate::evolve::settings::{RestartKind, StrategyKind};
use crate::evolve::strategy::{Strategy, StrategyState};
use crate::genome::Genome;

/// Number of random genomes with which a search without a start genome begins, at most a quarter of the run's evaluations.
const NEWBORNS: u32 = 100;

/// Parameters of a search by CMA-ES or, where bodies evolve, by the genetic algorithm over bodies.
pub struct InnerSearch<'a> {
    /// Number of candidates in a generation.
    pub population: u32,
    /// First step of CMA-ES, as a share of each gene's range.
    pub step: f32,
    pub seed: u64,
    /// Genome around which the search begins. None: it begins with random genomes.
    pub around: Option<&'a Genome>,
}

impl InnerSearch<'_> {
    /// Restores a search with the given plan after its first `finished` generations.
    ///
    /// # Errors
    /// Fails if the state does not fit the plan, or if a generation would be too large.
    pub fn resumed<S: Strategy>(
        plan: &RunPlan,
        finished: u32,
        state: &StrategyState,
    ) -> Result<S, Invalid> {
        let search = match finished {
            0 => S::begin(plan),
            _ => S::resume(plan, finished, state)?,
        };
        let evolution = &plan.settings.evolution;
        let most = evolution.population.max(evolution.cma_es.newborns) as usize;
        within("population", search.population(), 1..=most)?;
        Ok(search)
    }

    /// Returns the plan of the search, with the trial and the space of genomes of `run`.
    pub fn plan(&self, run: &RunPlan) -> RunPlan {
        let mut settings = run.settings.clone();
        let most = u32::try_from(run.settings.evolution.budget() / 4).unwrap_or(u32::MAX);
        let evolution = &mut settings.evolution;
        evolution.strategy =
            if settings.genome.bodies.vary { StrategyKind::BodyGa } else { StrategyKind::CmaEs };
        evolution.population = self.population;
        // The search never ends, because no run has more generations.
        evolution.generations = 10_000;
        evolution.cma_es.step = self.step;
        evolution.cma_es.newborns = NEWBORNS.min(most);
        evolution.cma_es.restarts = RestartKind::None;
        let founder = self.around.map(|genome| Arc::new(Founder::new("agent", genome.clone())));
        RunPlan { founder, ..RunPlan::new(&run.preset, self.seed, settings) }
    }
}

/// Serializes a search as its state.
pub fn serialize_search<S: Strategy, T: Serializer>(search: &S, to: T) -> Result<T::Ok, T::Error> {
    search.state().serialize(to)
}
