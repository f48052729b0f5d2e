//! Strategies: who is asked for the next genomes, and told how they did.
//!
//! A strategy sees genomes and evaluations, never the world, a thread or a clock. All its randomness
//! comes from streams named after the individual it is for.

mod amend;
mod archive;
mod champion;
mod cma;
mod cma_es;
mod descriptor;
mod eigen;
mod field;
mod founder;
mod front;
mod ga;
mod halving;
mod map_elites;
mod novelty;
mod parents;
mod random;
mod restarts;
mod search;
mod settings;

pub use amend::{Changes, MOST_CHANGES, SettingChange, may_change_during_run};
pub use archive::{Archive, Elite};
pub use champion::{Champion, Origin};
pub use cma_es::CmaEsSettings;
pub use descriptor::Descriptor;
pub use field::{fields, with_field, with_fields};
pub use founder::Founder;
pub use front::{Front, FrontMember};
pub use ga::{Crossover, GaSettings, Mutation, Selection};
pub use halving::HalvingSettings;
pub use map_elites::MapElitesSettings;
pub use novelty::NoveltySettings;
pub use parents::{Parents, Place};
pub use restarts::RestartKind;
pub use settings::{EvolutionSettings, LARGEST_POPULATION, RunPlan, Settings, StrategyKind};

use serde::{Deserialize, Serialize};

use crate::check::Invalid;
use crate::genome::Genome;
use crate::score::Evaluation;

/// A way to search, one generation at a time.
pub trait Strategy: Send {
    /// The genomes of the next generation, in the order of their indices. Asking twice gives the same.
    fn ask(&self) -> Vec<Genome>;

    /// How many genomes the next generation has.
    fn population(&self) -> usize;

    /// How the genomes of the last `ask` did, in the same order.
    fn tell(&mut self, genomes: &[Genome], evaluations: &[Evaluation]);

    /// All that it has learned: together with settings, seed and the number of finished generations,
    /// enough to go on bit for bit.
    fn state(&self) -> StrategyState;

    /// Takes the settings of its plan anew, some of which were changed as [`may_change_during_run`] allows: the
    /// next generation is made by them.
    fn amend(&mut self, plan: &RunPlan);

    /// Whom the genomes that `ask` returns come from, in the same order.
    fn parents(&self) -> Vec<Parents>;

    /// Everybody who may become a parent from now on, in an order of its own.
    fn breeders(&self) -> Vec<Place> {
        Vec::new()
    }

    /// Tells a strategy that goes on what [`Self::breeders`] said before it was stopped: its state has their genes,
    /// but not their places. Whatever does not fit that state is left out, and they stay unknown.
    fn recall(&mut self, _breeders: &[Place]) {}

    /// The best of every kind that it has seen, if it keeps such an archive.
    fn archive(&self) -> Option<&Archive> {
        None
    }
}

/// What a strategy has learned.
#[derive(Debug, Clone, PartialEq)]
pub enum StrategyState {
    /// Of the report's method: the parents of the next generation, best first.
    Halving(Vec<Genome>),
    /// Of a method that searches among points of the unit cube.
    Points(Box<PointState>),
}

impl StrategyState {
    /// Of a method that searches among points.
    fn points(state: PointState) -> Self {
        Self::Points(Box::new(state))
    }
}

/// What a strategy that searches among points has learned.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum PointState {
    /// Of the genetic algorithm.
    Ga(ga::GaState),
    /// Of CMA-ES.
    CmaEs(cma_es::CmaEsState),
    /// Of MAP-Elites.
    MapElites(map_elites::MapElitesState),
    /// Of novelty search.
    Novelty(novelty::NoveltyState),
    /// Of random search, which learns nothing.
    Random,
}

/// The strategy of a run at its beginning.
pub fn begin(plan: &RunPlan) -> Box<dyn Strategy> {
    match plan.settings.evolution.strategy {
        StrategyKind::Halving => Box::new(halving::Halving::new(plan)),
        StrategyKind::Ga => Box::new(ga::Ga::new(plan)),
        StrategyKind::CmaEs => Box::new(cma_es::CmaEs::new(plan)),
        StrategyKind::MapElites => Box::new(map_elites::MapElites::new(plan)),
        StrategyKind::Novelty => Box::new(novelty::Novelty::new(plan)),
        StrategyKind::Random => Box::new(random::Random::new(plan)),
    }
}

/// The strategy of a run that goes on after its first `finished` generations, of which it learned `state`.
///
/// # Errors
/// The state is that of another strategy or another space, or out of all bounds.
pub fn resume(
    plan: &RunPlan,
    finished: u32,
    state: StrategyState,
) -> Result<Box<dyn Strategy>, Invalid> {
    use {PointState as P, StrategyKind as K, StrategyState as S};
    let kind = plan.settings.evolution.strategy;
    let points = match (kind, state) {
        (K::Halving, S::Halving(parents)) => {
            return Ok(Box::new(halving::Halving::resumed(plan, finished, parents)?));
        }
        (_, S::Points(points)) => points,
        (_, S::Halving(_)) => return Err(foreign(kind)),
    };
    Ok(match (kind, *points) {
        (K::Ga, P::Ga(state)) => Box::new(ga::Ga::resumed(plan, finished, state)?),
        (K::CmaEs, P::CmaEs(state)) => Box::new(cma_es::CmaEs::resumed(plan, finished, state)?),
        (K::MapElites, P::MapElites(state)) => {
            Box::new(map_elites::MapElites::resumed(plan, finished, state)?)
        }
        (K::Novelty, P::Novelty(state)) => {
            Box::new(novelty::Novelty::resumed(plan, finished, state)?)
        }
        (K::Random, P::Random) => Box::new(random::Random::resumed(plan, finished)),
        _ => return Err(foreign(kind)),
    })
}

/// A state of another strategy than the plan's.
fn foreign(kind: StrategyKind) -> Invalid {
    Invalid::new("strategy", "another strategy's", format!("that of {kind}"))
}

/// The indices of the agents that may become parents, best first. Disqualified ones may not; of equals
/// the one with the lower index is first.
pub fn ranking(evaluations: &[Evaluation]) -> Vec<usize> {
    let mut ranked: Vec<usize> =
        (0..evaluations.len()).filter(|&i| evaluations[i].disqualified.is_none()).collect();
    ranked.sort_by(|&a, &b| evaluations[b].fitness.total_cmp(&evaluations[a].fitness));
    ranked
}

/// The indices of all agents, best first: those of [`ranking`], then the disqualified, the longer they lasted
/// the better, so that a method which needs everybody's rank learns which way is out of trouble.
pub fn full_ranking(evaluations: &[Evaluation]) -> Vec<usize> {
    let mut ranked = ranking(evaluations);
    let mut others: Vec<usize> =
        (0..evaluations.len()).filter(|&i| evaluations[i].disqualified.is_some()).collect();
    others.sort_by_key(|&i| std::cmp::Reverse(evaluations[i].steps));
    ranked.append(&mut others);
    ranked
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::Disqualification;

    #[test]
    fn the_disqualified_are_not_ranked_and_ties_go_to_the_first() {
        let evaluation = |fitness, steps, disqualified| Evaluation {
            steps,
            disqualified,
            ..Evaluation::of_fitness(fitness)
        };
        let evaluations = [
            evaluation(1.0, 9, None),
            evaluation(180.0, 3, Some(Disqualification::TooFast)),
            evaluation(3.0, 9, None),
            evaluation(150.0, 7, Some(Disqualification::TooFast)),
            evaluation(1.0, 9, None),
        ];
        assert_eq!(ranking(&evaluations), [2, 0, 4]);
        assert_eq!(full_ranking(&evaluations), [2, 0, 4, 3, 1]);
    }
}
