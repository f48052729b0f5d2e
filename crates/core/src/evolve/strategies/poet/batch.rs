//! The candidates of a generation, which follow from the phase.

use super::Poet;
use super::state::{Child, FineTuned, Phase, Proposal};
use crate::evolve::strategy::Strategy;
use crate::genome::{Genome, StairsGenome};

/// A genome to evaluate, and its stairs.
#[derive(Debug, Clone)]
pub struct Candidate {
    pub genome: Genome,
    pub stairs: StairsGenome,
    /// Number of perturbed trials beside the nominal one.
    pub perturbed: u32,
    /// The index of the stairs on which it is evaluated, if the trials count for these.
    pub node: Option<u32>,
    /// The index of the stairs from which it comes, if it is not one of their own candidates.
    pub from: Option<u32>,
    /// Whether a search has drawn it.
    pub is_sample: bool,
}

impl<S: Strategy> Poet<S> {
    /// The candidates of the next generation.
    pub(super) fn batch(&self) -> Vec<Candidate> {
        match &self.progress.phase {
            Phase::Learn { .. } => self.learners(),
            Phase::Measure => self.measured(),
            Phase::Tune { proposals } => {
                proposals.iter().flat_map(|proposal| self.fine_tuned(proposal)).collect()
            }
            Phase::Confirm { tuned } => {
                let confirmed = |FineTuned { from, to, agent }: &FineTuned| {
                    let perturbed = self.settings.perturbed;
                    let tuned = self.on_node(&agent.genome, *to, Some(*from))?;
                    Some(Candidate { perturbed, ..tuned })
                };
                tuned.iter().filter_map(confirmed).collect()
            }
            Phase::Breed { children } => {
                let bred = |child: &Child| {
                    let agent = self.progress.agent(child.parent)?;
                    let perturbed = self.settings.perturbed;
                    Some(Candidate { perturbed, ..of_stairs(agent, child.stairs) })
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
                    .flat_map(|agent| stairs.clone().map(move |stairs| of_stairs(agent, stairs)))
                    .collect()
            }
        }
    }

    fn learners(&self) -> Vec<Candidate> {
        let mut all = Vec::new();
        for pair in &self.progress.pairs {
            let Some(node) = self.progress.node(pair.node) else { continue };
            all.extend(pair.search.ask().into_iter().map(|genome| Candidate {
                node: Some(pair.node),
                is_sample: true,
                ..of_stairs(&genome, node.stairs)
            }));
        }
        all
    }

    /// The agents and challengers on their own stairs, the agent of a pair before its challenger; then the better of both on
    /// the stairs of all other pairs, in the nominal trial.
    fn measured(&self) -> Vec<Candidate> {
        let mut all = Vec::new();
        let mut sent = Vec::new();
        for pair in &self.progress.pairs {
            let agent = self.progress.agent(pair.node);
            let challenger = pair.challenger.as_ref().map(|(agent, _)| &agent.genome);
            for genome in agent.into_iter().chain(challenger) {
                let perturbed = self.settings.perturbed;
                let own = self.on_node(genome, pair.node, None);
                all.extend(own.map(|own| Candidate { perturbed, ..own }));
            }
            // A challenger that was worse in the nominal trial than the agent in all trials is not sent in its place.
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

    /// An agent on the stairs to which it may move, in all trials, and the candidates of one generation around it.
    fn fine_tuned(&self, proposal: &Proposal) -> Vec<Candidate> {
        let Proposal { from, to, genome } = proposal;
        let restarts = self.progress.pair(*to).map_or(0, |pair| pair.restarts.saturating_add(1));
        let perturbed = self.settings.perturbed;
        let direct = self.on_node(genome, *to, Some(*from));
        let mut all: Vec<Candidate> =
            direct.into_iter().map(|direct| Candidate { perturbed, ..direct }).collect();
        for sample in self.search(*to, restarts, Some(genome)).ask() {
            let sample = self.on_node(&sample, *to, Some(*from));
            all.extend(sample.map(|sample| Candidate { is_sample: true, ..sample }));
        }
        all
    }

    /// All active agents, and the panel, on a mutant.
    fn compared(&self, stairs: &StairsGenome) -> Vec<Candidate> {
        let active = self.progress.pairs.iter().filter_map(|pair| self.progress.agent(pair.node));
        active.chain(&self.progress.panel).map(|genome| of_stairs(genome, *stairs)).collect()
    }

    fn on_node(&self, genome: &Genome, node: u32, from: Option<u32>) -> Option<Candidate> {
        let stairs = self.progress.node(node)?.stairs;
        Some(Candidate { node: Some(node), from, ..of_stairs(genome, stairs) })
    }
}

/// A genome on stairs, in the nominal trial alone.
fn of_stairs(genome: &Genome, stairs: StairsGenome) -> Candidate {
    let genome = genome.clone();
    Candidate { genome, stairs, perturbed: 0, node: None, from: None, is_sample: false }
}
