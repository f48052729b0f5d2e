//! State of POET: stairs, pairs, and the phase of the round.

use rand::Rng;
use serde::{Deserialize, Serialize};

use super::super::inner_search::{InnerSearch, serialize_search};
use crate::check::{Invalid, within};
use crate::evolve::plan::RunPlan;
use crate::evolve::settings::PoetSettings;
use crate::evolve::stairs_tree::{Agent, StairsNode, Transfer, check_score};
use crate::evolve::strategy::{Strategy, StrategyState};
use crate::genome::{Genome, StairsGenome};
use crate::rng::{Purpose, stream};
use crate::schema::check;

/// Maximum number of an agent's latest scores, the greatest of which an agent from other stairs has to exceed.
pub const RECENT: usize = 5;
/// Maximum number of transfers that are stored.
pub const MOST_TRANSFERS: usize = 2000;

/// Phases of a round, each of which is a generation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum Phase {
    /// Each pair learns, for `left` more generations.
    Learn { left: u32 },
    /// Agents and challengers are measured on their own stairs, and tried on the stairs of other pairs.
    Measure,
    /// Agents that may be transferred are measured on the new stairs, and fine-tuned for a generation.
    Tune { proposals: Vec<Proposal> },
    /// Fine-tuned agents are measured.
    Confirm { tuned: Vec<FineTuned> },
    /// Mutants of stairs are tried with the agents of their parents.
    Breed { children: Vec<Child> },
    /// Mutants that are neither too easy nor too hard are tried with all agents.
    Compare { children: Vec<Child> },
    /// The agents of the new stairs, whose indices begin with `first`, are tried on all stairs.
    Place { first: u32 },
}

/// A proposed transfer of an agent.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Proposal {
    pub from: u32,
    pub to: u32,
    pub genome: Genome,
}

/// The best fine-tuned candidate of a proposed transfer.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FineTuned {
    pub from: u32,
    pub to: u32,
    pub agent: Agent,
}

/// A mutant of stairs, with the index of its parent.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Child {
    pub parent: u32,
    pub stairs: StairsGenome,
}

/// Active stairs and the search for their agent. A file has the state of the search in place of the search.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, bound(serialize = "S: Strategy", deserialize = "S: Deserialize<'de>"))]
pub struct Pair<S> {
    /// Index of the pair's stairs in the run.
    pub node: u32,
    #[serde(serialize_with = "serialize_search")]
    pub search: S,
    /// Number of generations that the search has finished.
    pub finished: u32,
    /// Number of times that the search has begun again.
    pub restarts: u32,
    /// Latest scores of the agent, at most [`RECENT`].
    pub recent: Vec<f32>,
    /// Number of consecutive measurements without a better agent.
    pub stale: u32,
    /// Best candidate since the last measurement, with its score in the nominal trial.
    pub challenger: Option<(Agent, f32)>,
}

impl<S> Pair<S> {
    /// Makes a pair whose search has not begun.
    pub fn new(node: u32, search: S) -> Self {
        Self {
            node,
            search,
            finished: 0,
            restarts: 0,
            recent: Vec::new(),
            stale: 0,
            challenger: None,
        }
    }

    /// Returns the score that an agent from other stairs has to exceed: the greatest recent score.
    pub fn to_beat(&self) -> f32 {
        self.recent.iter().copied().fold(0.0, f32::max)
    }
}

/// Returns the plan of a search for the agent of a staircase, around a genome or from random genomes.
pub fn search_plan(plan: &RunPlan, node: u32, restarts: u32, around: Option<&Genome>) -> RunPlan {
    let poet = &plan.settings.evolution.poet;
    let of = InnerSearch {
        population: poet.pair_candidates,
        step: poet.pair_step,
        seed: stream(plan.seed, node, restarts, Purpose::Pair).next_u64(),
        around,
    };
    of.plan(plan)
}

/// Everything that POET has learned.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields, bound(serialize = "S: Strategy", deserialize = "S: Deserialize<'de>"))]
pub struct PoetProgress<S> {
    pub phase: Phase,
    /// Number of finished rounds.
    pub rounds: u32,
    /// Number of transfer phases that this round has finished.
    pub transfers_done: u32,
    pub nodes: Vec<StairsNode>,
    /// Active pairs, the oldest first.
    pub pairs: Vec<Pair<S>>,
    /// Copies of agents, each made when the stairs of the agent were created. They serve to compare stairs for novelty.
    pub panel: Vec<Genome>,
    /// For each staircase, the scores of the panel's agents on it.
    pub rows: Vec<Vec<f32>>,
    pub transfers: Vec<Transfer>,
}

impl<S> PoetProgress<S> {
    pub fn node(&self, index: u32) -> Option<&StairsNode> {
        self.nodes.get(index as usize)
    }

    /// Returns the genome of a staircase's agent.
    pub fn agent(&self, index: u32) -> Option<&Genome> {
        Some(&self.node(index)?.agent.as_ref()?.genome)
    }

    pub fn node_mut(&mut self, index: u32) -> Option<&mut StairsNode> {
        self.nodes.get_mut(index as usize)
    }

    pub fn pair(&self, node: u32) -> Option<&Pair<S>> {
        self.pairs.iter().find(|pair| pair.node == node)
    }

    pub fn pair_mut(&mut self, node: u32) -> Option<&mut Pair<S>> {
        self.pairs.iter_mut().find(|pair| pair.node == node)
    }

    /// Reads the progress of a run after its first `finished` generations.
    pub fn read(state: &StrategyState, plan: &RunPlan, finished: u32) -> Result<Self, Invalid>
    where
        S: Strategy,
    {
        let mut saved: PoetProgress<StrategyState> = state.read()?;
        saved.check(plan, finished)?;
        let mut pairs = Vec::new();
        for (index, pair) in std::mem::take(&mut saved.pairs).into_iter().enumerate() {
            let Pair { node, search, finished, restarts, recent, stale, challenger } = pair;
            // A search that has begun does not depend on the genome around which it began; the agent stands in for that genome.
            let plan = search_plan(plan, node, restarts, saved.agent(node));
            let search = InnerSearch::resumed(&plan, finished, &search)
                .map_err(|error| error.inside(&format!("pairs[{index}].search")))?;
            pairs.push(Pair { node, search, finished, restarts, recent, stale, challenger });
        }
        let PoetProgress { phase, rounds, transfers_done, nodes, panel, rows, transfers, .. } =
            saved;
        Ok(Self { phase, rounds, transfers_done, nodes, pairs, panel, rows, transfers })
    }
}

impl PoetProgress<StrategyState> {
    fn check(&self, plan: &RunPlan, finished: u32) -> Result<(), Invalid> {
        let settings = &plan.settings.evolution.poet;
        within("rounds", self.rounds, 0..=finished)?;
        within("transfers_done", self.transfers_done, 0..=100)?;
        within("nodes", self.nodes.len(), 1..=PoetSettings::MOST_STAIRS + 10)?;
        within("pairs", self.pairs.len(), 1..=101 + 10)?;
        within("transfers", self.transfers.len(), 0..=MOST_TRANSFERS)?;
        within("panel", self.panel.len(), 0..=self.nodes.len())?;
        within("rows", self.rows.len(), self.nodes.len()..=self.nodes.len())?;
        for (index, node) in self.nodes.iter().enumerate() {
            // Stairs created in the current round belong to a round that is not finished.
            let checked = node.check(index, self.rounds + 1, plan);
            checked.map_err(|error| error.inside("nodes"))?;
        }
        for row in &self.rows {
            // Each row has one column per agent of the panel, which gets the agents of new stairs only after the phase `Place`.
            within("row", row.len(), self.panel.len()..=self.panel.len())?;
            row.iter().try_for_each(|score| check_score("row", *score))?;
        }
        self.panel.iter().try_for_each(|genome| plan.check_genome(genome))?;
        for (index, pair) in self.pairs.iter().enumerate() {
            self.check_pair(pair, index, plan).map_err(|error| error.inside("pairs"))?;
        }
        for transfer in &self.transfers {
            self.check_place(transfer.from)?;
            self.check_place(transfer.to)?;
        }
        let most = settings.pairs.max(settings.children) as usize + 100;
        match &self.phase {
            Phase::Learn { left } => within("left", *left, 1..=1000),
            Phase::Measure => Ok(()),
            Phase::Tune { proposals } => {
                within("proposals", proposals.len(), 1..=most)?;
                let moves =
                    proposals.iter().map(|Proposal { from, to, genome }| (*from, *to, genome));
                self.check_moves(moves, plan)
            }
            Phase::Confirm { tuned } => {
                within("tuned", tuned.len(), 1..=most)?;
                let moves =
                    tuned.iter().map(|FineTuned { from, to, agent }| (*from, *to, &agent.genome));
                self.check_moves(moves, plan)
            }
            Phase::Breed { children } | Phase::Compare { children } => {
                within("children", children.len(), 1..=most)?;
                self.pairs.iter().try_for_each(|pair| self.check_agent(pair.node))?;
                children.iter().try_for_each(|child| {
                    self.check_agent(child.parent)?;
                    check(&child.stairs)
                })
            }
            Phase::Place { first } => {
                let least = self.nodes.len().saturating_sub(10).max(1) as u32;
                within("first", *first, least..=self.nodes.len() as u32 - 1)?;
                (*first..self.nodes.len() as u32).try_for_each(|node| self.check_agent(node))
            }
        }
    }

    fn check_pair(
        &self,
        pair: &Pair<StrategyState>,
        index: usize,
        plan: &RunPlan,
    ) -> Result<(), Invalid> {
        self.check_place(pair.node)?;
        if self.pairs[..index].iter().any(|other| other.node == pair.node) {
            let allowed = "another one than that of the pairs before";
            return Err(Invalid::new("node", pair.node, allowed));
        }
        within("recent", pair.recent.len(), 0..=RECENT)?;
        pair.recent.iter().try_for_each(|score| check_score("recent", *score))?;
        within("finished", pair.finished, 0..=10_000)?;
        let Some((agent, score)) = &pair.challenger else { return Ok(()) };
        check_score("challenger", *score)?;
        plan.check_genome(&agent.genome)
    }

    fn check_moves<'a>(
        &self,
        mut moves: impl Iterator<Item = (u32, u32, &'a Genome)>,
        plan: &RunPlan,
    ) -> Result<(), Invalid> {
        moves.try_for_each(|(from, to, genome)| {
            self.check_place(from)?;
            self.check_place(to)?;
            plan.check_genome(genome)
        })
    }

    fn check_place(&self, index: u32) -> Result<(), Invalid> {
        within("stairs", index, 0..=self.nodes.len() as u32 - 1)
    }

    /// Checks that the stairs with this index exist and have an agent.
    fn check_agent(&self, index: u32) -> Result<(), Invalid> {
        self.check_place(index)?;
        match self.nodes.get(index as usize).and_then(|node| node.agent.as_ref()) {
            Some(_) => Ok(()),
            None => Err(Invalid::new("stairs", index, "stairs that have an agent")),
        }
    }
}
