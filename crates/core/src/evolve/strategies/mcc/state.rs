//! State of minimal criterion coevolution: the two queues, and the search for the first snakes.

use rand::Rng;
use serde::{Deserialize, Serialize};

use super::super::inner_search::{InnerSearch, serialize_search};
use crate::check::{Invalid, within};
use crate::evolve::plan::RunPlan;
use crate::evolve::settings::{MccSettings, PoetSettings};
use crate::evolve::stairs_tree::{Agent, StairsNode};
use crate::evolve::strategy::{Strategy, StrategyState};
use crate::rng::{Purpose, stream};

/// Number of candidates in a generation of the search for the first snakes.
const CANDIDATES: u32 = 30;
/// First step of the search for the first snakes, as a share of each gene's range.
const FIRST_STEP: f32 = 0.15;
/// Number of consecutive generations without a successful snake after which the search for the first snakes begins again.
pub const PATIENCE: u32 = 50;

/// The search for the first snakes. A file has the state of the search in place of the search.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, bound(serialize = "S: Strategy", deserialize = "S: Deserialize<'de>"))]
pub struct FirstSearch<S> {
    #[serde(serialize_with = "serialize_search")]
    pub search: S,
    /// Number of generations that the search has finished.
    pub finished: u32,
    /// Number of times that the search has begun again.
    pub restarts: u32,
    /// Number of consecutive generations without a snake that climbs the first stairs.
    pub idle: u32,
}

impl<S: Strategy> FirstSearch<S> {
    /// Begins a search.
    pub fn new(plan: &RunPlan, restarts: u32) -> Self {
        let search = S::begin(&Self::plan(plan, restarts));
        Self { search, finished: 0, restarts, idle: 0 }
    }

    /// Returns the plan of the search, around the founder of the run or from random genomes.
    pub fn plan(plan: &RunPlan, restarts: u32) -> RunPlan {
        let of = InnerSearch {
            population: CANDIDATES,
            step: FIRST_STEP,
            seed: stream(plan.seed, 0, restarts, Purpose::Pair).next_u64(),
            around: plan.founder.as_ref().map(|founder| founder.genome()),
        };
        of.plan(plan)
    }
}

/// Everything that minimal criterion coevolution has found.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, bound(serialize = "S: Strategy", deserialize = "S: Deserialize<'de>"))]
pub struct MccProgress<S> {
    /// The search for the first snakes. None once the first snakes are found.
    pub beginning: Option<FirstSearch<S>>,
    /// Number of generations of coevolution.
    pub rounds: u32,
    /// All stairs that ever entered the queue of stairs; those that left it are archived.
    pub nodes: Vec<StairsNode>,
    /// For each staircase, the number of snakes that entered the queue of snakes by climbing it.
    pub uses: Vec<u32>,
    /// Queue of snakes, the oldest first.
    pub snakes: Vec<Agent>,
    /// Index in the queue of the snake that has children next.
    pub snake_turn: u32,
    /// Index in the queue of the stairs that have mutants next.
    pub stairs_turn: u32,
}

impl<S> MccProgress<S> {
    /// Returns the queue of stairs, as indices of `nodes`, the oldest first.
    pub fn active(&self) -> impl Iterator<Item = u32> {
        let nodes = (0..).zip(&self.nodes);
        nodes.filter(|(_, node)| node.archived.is_none()).map(|(index, _)| index)
    }

    /// Moves the turns forward by the numbers of children in a generation.
    pub fn pass_turns(&mut self, snake_children: u32, stairs_children: u32) {
        let passed = |turn: u32, children: u32, members: usize| {
            turn.saturating_add(children) % (members as u32).max(1)
        };
        let stairs = self.active().count();
        self.snake_turn = passed(self.snake_turn, snake_children, self.snakes.len());
        self.stairs_turn = passed(self.stairs_turn, stairs_children, stairs);
    }

    /// Removes the oldest members of the queues until they have at most the numbers of snakes and stairs in the settings. The turn stays
    /// with the member whose turn it is.
    pub fn shorten(&mut self, settings: &MccSettings) {
        let too_many = self.snakes.len().saturating_sub(settings.snake_queue as usize);
        self.snakes.drain(..too_many);
        let active = self.active().count();
        let archived = active.saturating_sub(settings.stairs_queue as usize);
        let oldest = self.nodes.iter_mut().filter(|node| node.archived.is_none());
        oldest.take(archived).for_each(|node| node.archived = Some(self.rounds));
        let moved = |turn: u32, removed: usize, left: usize| {
            turn.saturating_sub(removed as u32) % (left as u32).max(1)
        };
        self.snake_turn = moved(self.snake_turn, too_many, self.snakes.len());
        self.stairs_turn = moved(self.stairs_turn, archived, active - archived);
    }

    /// Reads the progress of a run after its first `finished` generations.
    pub fn read(state: &StrategyState, plan: &RunPlan, finished: u32) -> Result<Self, Invalid>
    where
        S: Strategy,
    {
        let saved: MccProgress<StrategyState> = state.read()?;
        saved.check(plan, finished)?;
        let MccProgress { beginning, rounds, nodes, uses, snakes, snake_turn, stairs_turn } = saved;
        let beginning = beginning.map(|beginning| {
            let FirstSearch { search, finished, restarts, idle } = beginning;
            let inside = |error: Invalid| error.inside("beginning");
            within("idle", idle, 0..=PATIENCE).map_err(inside)?;
            let plan = FirstSearch::<S>::plan(plan, restarts);
            let search = InnerSearch::resumed(&plan, finished, &search).map_err(inside)?;
            Ok(FirstSearch { search, finished, restarts, idle })
        });
        let beginning = beginning.transpose()?;
        Ok(Self { beginning, rounds, nodes, uses, snakes, snake_turn, stairs_turn })
    }
}

impl MccProgress<StrategyState> {
    fn check(&self, plan: &RunPlan, finished: u32) -> Result<(), Invalid> {
        within("rounds", self.rounds, 0..=finished)?;
        within("nodes", self.nodes.len(), 1..=PoetSettings::MOST_STAIRS)?;
        within("uses", self.uses.len(), self.nodes.len()..=self.nodes.len())?;
        // A change of settings may have reduced the maximum length of a queue, so the check is against the greatest allowed length.
        within("snakes", self.snakes.len(), 0..=1000)?;
        for (index, node) in self.nodes.iter().enumerate() {
            node.check(index, self.rounds, plan).map_err(|error| error.inside("nodes"))?;
        }
        for snake in &self.snakes {
            plan.check_genome(&snake.genome).map_err(|error| error.inside("snakes"))?;
        }
        let active = self.active().count();
        within("active", active, 1..=100)?;
        within("snake_turn", self.snake_turn as usize, 0..=self.snakes.len().max(1) - 1)?;
        within("stairs_turn", self.stairs_turn as usize, 0..=active - 1)?;
        match &self.beginning {
            Some(beginning) => within("finished", beginning.finished, 0..=finished)
                .map_err(|error| error.inside("beginning")),
            None => within("snakes", self.snakes.len(), 1..=1000),
        }
    }
}
