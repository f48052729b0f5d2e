//! Learning by trial and error: all snakes of a run share what they have learned.
//!
//! A generation is a number of episodes. In the first the snake plays what has been learned, without chance; only it can
//! become a champion, because the luck of an explorer is no skill. The others explore, the first of them boldly and the
//! last carefully. Then the learner takes in the experience of all, in the order of their indices.

use std::sync::Arc;

use super::search::Search;
use crate::check::Invalid;
use crate::evolve::parents::Parents;
use crate::evolve::plan::RunPlan;
use crate::evolve::settings::{EvolutionSettings, StrategyKind};
use crate::evolve::strategy::{Strategy, StrategyState};
use crate::genome::controllers::{Explorer, POSTURES, Policy, SITUATION_BITS};
use crate::genome::{ControllerGenes, Genome};
use crate::learn::Episode;
use crate::learn::classifiers::{Xcs, Zcs};
use crate::learn::q_table::epsilon;
use crate::rng::{Purpose, stream};
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

    /// What a run knows at its beginning.
    ///
    /// # Errors
    /// A parameter of a classifier system is out of range; the settings' own ranges allow none.
    fn first_policy(plan: &RunPlan) -> Result<Policy, Invalid> {
        let evolution = &plan.settings.evolution;
        let (bits, actions) = (SITUATION_BITS.len(), POSTURES.len());
        Ok(match evolution.strategy {
            StrategyKind::Xcs => {
                Policy::Xcs(Arc::new(Xcs::new(evolution.xcs.parameters(), bits, actions)?))
            }
            StrategyKind::Zcs => {
                let mut rng = stream(plan.seed, 0, 0, Purpose::Learn);
                let parameters = evolution.zcs.parameters();
                Policy::Zcs(Arc::new(Zcs::new(parameters, bits, actions, &mut rng)?))
            }
            _ => Policy::default(),
        })
    }

    /// Whether a policy is what the run's strategy learns.
    fn is_of(policy: &Policy, strategy: StrategyKind) -> bool {
        match policy {
            Policy::Table(_) => strategy == StrategyKind::QLearning,
            Policy::Xcs(_) => strategy == StrategyKind::Xcs,
            Policy::Zcs(_) => strategy == StrategyKind::Zcs,
        }
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
        let strategy = plan.settings.evolution.strategy;
        let policy = match founder {
            Some(ControllerGenes::Decisions(genes)) if Self::is_of(&genes.policy, strategy) => {
                genes.policy.clone()
            }
            // A founder that learned otherwise lends its body.
            _ => Self::first_policy(plan).unwrap_or_default(),
        };
        Self::with_policy(plan, 0, policy)
    }

    fn resume(plan: &RunPlan, finished: u32, state: &StrategyState) -> Result<Self, Invalid> {
        let policy: Policy = state.read()?;
        policy.check().map_err(|error| error.inside("state"))?;
        let strategy = plan.settings.evolution.strategy;
        if !Self::is_of(&policy, strategy) {
            let allowed = format!("that of {strategy}");
            return Err(Invalid::new("state.policy", "that of another strategy", allowed));
        }
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
        let (mut transitions, mut decisions) = (Vec::new(), Vec::new());
        for episode in episodes.into_iter().flatten() {
            match episode {
                Episode::Table(of_one) => transitions.push(of_one),
                Episode::Rules(of_one, end) => decisions.push((of_one, end)),
            }
        }
        let mut rng = stream(self.seed, self.search.generation, 0, Purpose::Learn);
        // Experience that does not fit, which no controller of the program makes, teaches nothing.
        match &mut self.policy {
            Policy::Table(table) => {
                let rule = self.evolution.q_learning.rule();
                let trace = self.evolution.q_learning.trace;
                Arc::make_mut(table).learn_returns(&transitions, &rule, trace);
            }
            Policy::Xcs(rules) => {
                let (rules, trace) = (Arc::make_mut(rules), self.evolution.xcs.trace);
                for (decisions, end) in &decisions {
                    let _ = rules.learn_returns(decisions, *end, trace, &mut rng);
                }
            }
            Policy::Zcs(rules) => {
                let (rules, trace) = (Arc::make_mut(rules), self.evolution.zcs.trace);
                for (decisions, end) in &decisions {
                    let _ = rules.learn_returns(decisions, *end, trace, &mut rng);
                }
            }
        }
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
        // The settings' own ranges allow no parameter that is refused here.
        match &mut self.policy {
            Policy::Table(_) => {}
            Policy::Xcs(rules) => {
                let _ = Arc::make_mut(rules).set_settings(self.evolution.xcs.parameters());
            }
            Policy::Zcs(rules) => {
                let _ = Arc::make_mut(rules).set_settings(self.evolution.zcs.parameters());
            }
        }
    }

    fn parents(&self) -> Vec<Parents> {
        vec![Parents::None; self.search.population]
    }
}
