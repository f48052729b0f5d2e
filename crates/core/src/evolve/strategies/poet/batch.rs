//! Attempts of a generation of POET, which follow from the phase.

use super::super::attempt::Attempt;
use super::Poet;
use super::state::{Child, FineTuned, Phase, Proposal};
use crate::evolve::parents::Parents;
use crate::evolve::strategy::Strategy;
use crate::genome::{Genome, StairsGenome};

/// Relation of an attempt to the stairs of the run.
#[derive(Debug, Clone, Copy, Default)]
pub struct PoetRole {
    /// Index of the stairs on which the candidate is evaluated. None if the trials do not count for these stairs.
    pub node: Option<u32>,
    /// Index of the stairs from which the candidate comes. None if it is evaluated on its own stairs.
    pub from: Option<u32>,
}

impl Attempt<PoetRole> {
    /// Returns whether a search has drawn the candidate.
    pub fn is_sample(&self) -> bool {
        self.candidate.parents == Parents::Distribution
    }

    fn perturbed(self, perturbed: u32) -> Self {
        Self { perturbed, ..self }
    }
}

impl<S: Strategy> Poet<S> {
    /// Returns the attempts of the next generation.
    pub(super) fn next_batch(&self) -> Vec<Attempt<PoetRole>> {
        let perturbed = self.settings.perturbed;
        match &self.progress.phase {
            Phase::Learn { .. } => {
                let pairs = self.progress.pairs.iter();
                pairs.flat_map(|pair| self.samples(&pair.search, pair.node, None)).collect()
            }
            Phase::Measure => self.measured(),
            Phase::Tune { proposals } => {
                proposals.iter().flat_map(|proposal| self.fine_tuned(proposal)).collect()
            }
            Phase::Confirm { tuned } => {
                let confirmed = |FineTuned { from, to, agent }: &FineTuned| {
                    Some(self.on_node(&agent.genome, *to, Some(*from))?.perturbed(perturbed))
                };
                tuned.iter().filter_map(confirmed).collect()
            }
            Phase::Breed { children } => {
                let bred = |child: &Child| {
                    let agent = self.progress.agent(child.parent)?;
                    Some(on_stairs(agent, child.stairs).perturbed(perturbed))
                };
                children.iter().filter_map(bred).collect()
            }
            Phase::Compare { children } => {
                children.iter().flat_map(|child| self.compared(&child.stairs)).collect()
            }
            Phase::Place { first } => {
                let new = self.progress.nodes.iter().skip(*first as usize);
                let agents = new.filter_map(|node| Some(&node.agent.as_ref()?.genome));
                let stairs = self.progress.nodes.iter().map(|node| node.stairs);
                agents
                    .flat_map(|agent| stairs.clone().map(move |stairs| on_stairs(agent, stairs)))
                    .collect()
            }
        }
    }

    /// Returns the next candidates of a search, on the stairs with the index `node`.
    fn samples(&self, search: &S, node: u32, from: Option<u32>) -> Vec<Attempt<PoetRole>> {
        let Some(stairs) = self.progress.node(node).map(|of| of.stairs) else { return Vec::new() };
        let role = PoetRole { node: Some(node), from };
        search.ask().into_iter().map(|asked| Attempt::sampled(asked, stairs, role)).collect()
    }

    /// Returns the agents and challengers on their own stairs, the agent of a pair before its challenger; then the better of the two on the
    /// stairs of all other pairs, in the nominal trial.
    fn measured(&self) -> Vec<Attempt<PoetRole>> {
        let mut all = Vec::new();
        let mut sent = Vec::new();
        for pair in &self.progress.pairs {
            let agent = self.progress.agent(pair.node);
            let challenger = pair.challenger.as_ref().map(|(agent, _)| &agent.genome);
            for genome in agent.into_iter().chain(challenger) {
                let own = self.on_node(genome, pair.node, None);
                all.extend(own.map(|own| own.perturbed(self.settings.perturbed)));
            }
            // A challenger that was worse in the nominal trial than the agent in all trials does not replace the agent on other stairs.
            let score = self.progress.node(pair.node).map_or(0.0, |node| node.score);
            let is_better = pair.challenger.as_ref().is_some_and(|(_, nominal)| *nominal > score);
            let best = if is_better { challenger } else { agent.or(challenger) };
            sent.extend(best.map(|genome| (pair.node, genome)));
        }
        for pair in &self.progress.pairs {
            for &(from, genome) in sent.iter().filter(|(from, _)| *from != pair.node) {
                all.extend(self.on_node(genome, pair.node, Some(from)));
            }
        }
        all
    }

    /// Returns the attempt of an agent on the stairs to which it may be transferred, in all trials, and one generation of candidates around
    /// the agent.
    fn fine_tuned(&self, proposal: &Proposal) -> Vec<Attempt<PoetRole>> {
        let &Proposal { from, to, ref genome } = proposal;
        let restarts = self.progress.pair(to).map_or(0, |pair| pair.restarts.saturating_add(1));
        let direct = self.on_node(genome, to, Some(from));
        let direct = direct.map(|direct| direct.perturbed(self.settings.perturbed));
        let around = self.search(to, restarts, Some(genome));
        direct.into_iter().chain(self.samples(&around, to, Some(from))).collect()
    }

    /// Returns the attempts of all active agents and of the panel on a mutant of stairs.
    fn compared(&self, stairs: &StairsGenome) -> Vec<Attempt<PoetRole>> {
        let active = self.progress.pairs.iter().filter_map(|pair| self.progress.agent(pair.node));
        active.chain(&self.progress.panel).map(|genome| on_stairs(genome, *stairs)).collect()
    }

    fn on_node(&self, genome: &Genome, node: u32, from: Option<u32>) -> Option<Attempt<PoetRole>> {
        let stairs = self.progress.node(node)?.stairs;
        Some(Attempt::new(genome, stairs, PoetRole { node: Some(node), from }))
    }
}

/// Makes an attempt that does not count among the trials of a staircase of the run.
fn on_stairs(genome: &Genome, stairs: StairsGenome) -> Attempt<PoetRole> {
    Attempt::new(genome, stairs, PoetRole::default())
}
