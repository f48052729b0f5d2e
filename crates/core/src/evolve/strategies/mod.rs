//! The registry of strategies.
//!
//! To add a strategy, write a file in this folder, a line in [`constructors`], a row of [`StrategyKind`] and, if the strategy has settings,
//! a file in [`super::settings`].

mod attempt;
mod body_children;
mod body_ga;
mod body_map_elites;
mod breeder;
mod cma;
mod cma_es;
mod creature_ga;
#[cfg(test)]
mod fixtures;
mod ga;
mod halving;
mod inner_search;
mod islands;
mod learned;
mod learning;
mod map_elites;
mod mcc;
mod neat;
mod novelty;
mod parent_pool;
mod poet;
mod random;
mod search;
mod wave_takeover;

use super::plan::RunPlan;
use super::settings::{Settings, StrategyKind};
use super::strategy::{Strategy, StrategyState};
use crate::check::Invalid;
use crate::genome::ControllerKind;
use crate::genome::controllers::Policy;
use body_ga::BodyGa;
use ga::Ga;
use learned::JointSystems;
use learning::Learning;
use mcc::Mcc;
use novelty::Novelty;
use poet::Poet;

/// Returns the constructors of the strategy that the settings choose.
fn constructors(settings: &Settings) -> Constructors {
    match settings.evolution.strategy {
        StrategyKind::Halving => Constructors::of::<halving::Halving>(),
        StrategyKind::Ga => Constructors::of::<Ga>(),
        StrategyKind::CmaEs => Constructors::of::<cma_es::CmaEs>(),
        StrategyKind::MapElites => Constructors::of::<map_elites::MapElites>(),
        StrategyKind::Novelty => Constructors::of::<Novelty<Ga>>(),
        StrategyKind::Xcs if settings.genome.controller == ControllerKind::JointDecisions => {
            Constructors::of::<Learning<JointSystems>>()
        }
        StrategyKind::QLearning | StrategyKind::Xcs | StrategyKind::Zcs => {
            Constructors::of::<Learning<Policy>>()
        }
        StrategyKind::Neat => Constructors::of::<neat::Neat>(),
        StrategyKind::BodyGa => Constructors::of::<BodyGa>(),
        StrategyKind::BodyNovelty => Constructors::of::<Novelty<BodyGa>>(),
        StrategyKind::BodyMapElites => Constructors::of::<body_map_elites::BodyMapElites>(),
        StrategyKind::Islands => Constructors::of::<islands::Islands>(),
        StrategyKind::Poet => Constructors::of::<Poet<cma_es::CmaEs>>(),
        StrategyKind::BodyPoet => Constructors::of::<Poet<BodyGa>>(),
        StrategyKind::Mcc => Constructors::of::<Mcc<cma_es::CmaEs>>(),
        StrategyKind::CreatureGa => Constructors::of::<creature_ga::CreatureGa>(),
        StrategyKind::Random => Constructors::of::<random::Random>(),
    }
}

type Resumed = Result<Box<dyn Strategy>, Invalid>;

/// Functions that begin and resume a strategy.
struct Constructors {
    begin: fn(&RunPlan) -> Box<dyn Strategy>,
    resume: fn(&RunPlan, u32, &StrategyState) -> Resumed,
}

impl Constructors {
    fn of<S: Strategy + 'static>() -> Self {
        Self {
            begin: |plan| Box::new(S::begin(plan)),
            resume: |plan, finished, state| Ok(Box::new(S::resume(plan, finished, state)?)),
        }
    }
}

/// Begins the strategy of a run.
pub fn begin(plan: &RunPlan) -> Box<dyn Strategy> {
    (constructors(&plan.settings).begin)(plan)
}

/// Restores the strategy of a run after its first `finished` generations.
///
/// # Errors
/// Fails if the state does not fit the plan: another strategy wrote it, or a value is not allowed.
pub fn resume(plan: &RunPlan, finished: u32, state: &StrategyState) -> Resumed {
    (constructors(&plan.settings).resume)(plan, finished, state)
}
