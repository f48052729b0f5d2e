//! Learning by trial and error: all snakes of a run share what they have learned.
//!
//! A generation is a number of episodes. In the first the snake plays what has been learned, without chance; only it can
//! become a champion, because the luck of an explorer is no skill. The others explore, the first of them boldly and the
//! last carefully. Then the learner takes in the experience of all, in the order of their indices.

use super::search::Search;
use crate::check::Invalid;
use crate::evolve::parents::Parents;
use crate::evolve::plan::RunPlan;
use crate::evolve::settings::{EvolutionSettings, StrategyKind};
use crate::evolve::strategy::{Strategy, StrategyState};
use crate::genome::controllers::{Explorer, Policy};
use crate::genome::{ControllerGenes, Genome};
use crate::learn::Episode;
use crate::learn::q_table::epsilon;
use crate::score::Evaluation;

/// A learner that all episodes share.
#[derive(Debug, Clone)]
pub struct Learning {
    search: Search,
    seed: u64,
    evolution: EvolutionSettings,
    /// The snake of all episodes, without a policy of its own: the founder, or the one in the middle of all ranges.
    first: Genome,
    policy: Policy,
}

impl Learning {
    fn with_policy(plan: &RunPlan, finished: u32, policy: Policy) -> Self {
        let search = Search::new(plan, finished);
        let middle = || search.genome(&vec![0.5; search.dimension]);
        Self {
            first: plan.founder.as_ref().map_or_else(middle, |of| of.genome().clone()),
            search,
            seed: plan.seed,
            evolution: plan.settings.evolution.clone(),
            policy,
        }
    }

    /// What a run of this kind knows at its beginning.
    fn first_policy(kind: StrategyKind) -> Policy {
        let _ = kind;
        Policy::default()
    }

    /// How an individual explores; the first does not.
    fn explorer(&self, individual: usize) -> Option<Explorer> {
        let individual = individual as u32;
        let (finished, actors) = (self.search.generation - 1, self.search.population as u32);
        let ladder = self.evolution.exploration.ladder();
        (individual > 0).then(|| Explorer {
            epsilon: epsilon(finished, individual, actors, &ladder),
            seed: self.seed,
            generation: self.search.generation,
            individual,
            rule: self.evolution.q_learning.rule(),
        })
    }
}

impl Strategy for Learning {
    fn begin(plan: &RunPlan) -> Self {
        let founder = plan.founder.as_ref().map(|founder| &founder.genome().controller);
        let policy = match founder {
            Some(ControllerGenes::Decisions(genes)) => genes.policy.clone(),
            _ => Self::first_policy(plan.settings.evolution.strategy),
        };
        Self::with_policy(plan, 0, policy)
    }

    fn resume(plan: &RunPlan, finished: u32, state: &StrategyState) -> Result<Self, Invalid> {
        let policy: Policy = state.read()?;
        policy.check().map_err(|error| error.inside("state"))?;
        Ok(Self::with_policy(plan, finished, policy))
    }

    fn ask(&self) -> Vec<Genome> {
        let individual = |individual| {
            let mut genome = self.first.clone();
            if let ControllerGenes::Decisions(genes) = &mut genome.controller {
                genes.policy = self.policy.clone();
                genes.explorer = self.explorer(individual);
            }
            genome
        };
        (0..self.search.population).map(individual).collect()
    }

    fn population(&self) -> usize {
        self.search.population
    }

    fn learns_from_episodes(&self) -> bool {
        true
    }

    fn may_be_champion(&self, individual: usize) -> bool {
        individual == 0
    }

    fn learn(&mut self, episodes: Vec<Option<Episode>>) {
        let transitions: Vec<_> =
            episodes.into_iter().flatten().map(|Episode::Table(transitions)| transitions).collect();
        let Policy::Table(table) = &mut self.policy;
        let rule = self.evolution.q_learning.rule();
        std::sync::Arc::make_mut(table).replay(&transitions, &rule);
    }

    fn tell(&mut self, _: &[Genome], _: &[Evaluation]) {
        self.search.generation += 1;
    }

    fn state(&self) -> StrategyState {
        StrategyState::of(&self.policy)
    }

    fn apply_settings(&mut self, plan: &RunPlan) {
        self.search.apply_settings(plan);
        self.evolution = plan.settings.evolution.clone();
    }

    fn parents(&self) -> Vec<Parents> {
        vec![Parents::None; self.search.population]
    }
}
