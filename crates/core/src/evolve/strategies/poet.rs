//! POET, the paired open-ended trailblazer: stairs evolve, and for each staircase a separate search looks for the snake that climbs it best
//! (Wang, Lehman, Clune and Stanley, "Paired Open-Ended Trailblazer", 2019, and "Enhanced POET", 2020).
//!
//! A round has several blocks of learning, each followed by transfers of agents between stairs. At its end mutants of stairs are tried, and
//! the most novel of those that are neither too easy nor too hard become pairs. Each [`Phase`] is a generation of the run, so a run can
//! stop between any two phases. Where the authors' code differs from their text, this module follows the text: novelty compares ranks that
//! are clipped to the minimal criterion, and a challenge counts once it is solved.

mod batch;
mod new_stairs;
mod novelty;
mod state;
#[cfg(test)]
mod tests;

use super::attempt::Attempt;
use crate::check::Invalid;
use crate::evolve::candidate::Candidate;
use crate::evolve::plan::RunPlan;
use crate::evolve::settings::PoetSettings;
use crate::evolve::stairs_tree::{Agent, StairsNode, StairsTree, Transfer};
use crate::evolve::strategy::{Strategy, StrategyState};
use crate::genome::{Genome, StairsGenome};
use crate::score::Evaluation;
use batch::PoetRole;
use state::{FineTuned, MOST_TRANSFERS, Pair, Phase, PoetProgress, Proposal, RECENT, search_plan};

/// Number of consecutive measurements without a better agent after which a pair's search begins again around its agent.
const STALE: u32 = 8;

/// POET, whose pairs search with a strategy `S`.
pub struct Poet<S> {
    settings: PoetSettings,
    /// Plan of the run.
    plan: RunPlan,
    /// Number of the next generation; the first is 1.
    generation: u32,
    progress: PoetProgress<S>,
    /// Attempts of the next generation, which follow from the progress.
    batch: Vec<Attempt<PoetRole>>,
}

impl<S: Strategy> Poet<S> {
    fn with(plan: &RunPlan, finished: u32, progress: PoetProgress<S>) -> Self {
        let settings = plan.settings.evolution.poet.clone();
        let (plan, generation, batch) = (plan.clone(), finished + 1, Vec::new());
        let mut poet = Self { settings, plan, generation, progress, batch };
        poet.batch = poet.next_batch();
        poet
    }

    /// Returns the first stairs of a run: those of the trial, with the first rise.
    fn root(plan: &RunPlan) -> StairsGenome {
        let rise_m = plan.settings.evolution.poet.root_rise_m;
        StairsGenome::like(&plan.settings.trial.stairs, rise_m)
    }

    /// Returns the greatest length of stairs, in m: that of the stairs in the settings, for which a trial has time, or of the first stairs
    /// if they are longer.
    fn longest_m(&self) -> f32 {
        let length_m = Self::root(&self.plan).length_m();
        self.plan.settings.trial.stairs.treads_m().max(length_m)
    }

    /// Begins a search for the agent of a staircase, around a genome or from random genomes.
    fn search(&self, node: u32, restarts: u32, around: Option<&Genome>) -> S {
        S::begin(&search_plan(&self.plan, node, restarts, around))
    }

    /// Returns the score of an evaluation, which is its fitness (a share of the way), but at least 0, and 0 after a disqualification.
    fn score(evaluation: &Evaluation) -> f32 {
        if evaluation.disqualified.is_some() { 0.0 } else { evaluation.fitness.max(0.0) }
    }

    fn after_learning(
        &mut self,
        left: u32,
        candidates: &[Candidate],
        evaluations: &[Evaluation],
    ) -> Phase {
        let mut first = 0;
        for pair in &mut self.progress.pairs {
            let count = pair.search.population();
            let own = first..first + count;
            first += count;
            let (Some(candidates), Some(evaluations)) =
                (candidates.get(own.clone()), evaluations.get(own.clone()))
            else {
                continue;
            };
            for (index, evaluation) in evaluations.iter().enumerate() {
                let score = Self::score(evaluation);
                if pair.challenger.as_ref().is_none_or(|(_, best)| score > *best) {
                    let genome = candidates[index].genome.clone();
                    let individual = (own.start + index) as u32;
                    let agent = Agent { genome, generation: self.generation, individual };
                    pair.challenger = Some((agent, score));
                }
            }
            pair.search.tell(candidates, evaluations);
            pair.finished += 1;
        }
        match left.saturating_sub(1) {
            0 => Phase::Measure,
            left => Phase::Learn { left },
        }
    }

    /// Keeps the better of each pair's agent and challenger, and proposes transfers.
    fn after_measurement(&mut self, attempts: &[Attempt<PoetRole>], scores: &[f32]) -> Phase {
        let round = self.progress.rounds + 1;
        let mut own =
            attempts.iter().zip(scores).filter(|(attempt, _)| attempt.role.from.is_none());
        let PoetProgress { pairs, nodes, .. } = &mut self.progress;
        for pair in pairs.iter_mut() {
            let Some(node) = nodes.get_mut(pair.node as usize) else { continue };
            let incumbent = node.agent.take();
            let challenger = pair.challenger.take().map(|(agent, _)| agent);
            let had_agent = incumbent.is_some();
            // Of equal scores, that of the agent counts, because it comes first.
            let mut best: Option<(Agent, f32, bool)> = None;
            for (number, agent) in incumbent.into_iter().chain(challenger).enumerate() {
                let Some((_, &score)) = own.next() else { break };
                if best.as_ref().is_none_or(|(_, most, _)| score > *most) {
                    best = Some((agent, score, number > 0 || !had_agent));
                }
            }
            let Some((agent, score, is_new)) = best else { continue };
            pair.stale = if is_new { 0 } else { pair.stale.saturating_add(1) };
            node.agent = Some(agent);
            Self::note_score(node, pair, score, round, self.settings.solved_from);
        }
        self.renew_stale_searches();
        let proposals = self.proposals(attempts, scores);
        if proposals.is_empty() { self.after_transfers() } else { Phase::Tune { proposals } }
    }

    fn note_score(node: &mut StairsNode, pair: &mut Pair<S>, score: f32, round: u32, solved: f32) {
        node.score = score;
        if score >= solved {
            node.solved = node.solved.or(Some(round));
        }
        if pair.recent.len() >= RECENT {
            pair.recent.remove(0);
        }
        pair.recent.push(score);
    }

    fn renew_stale_searches(&mut self) {
        for index in 0..self.progress.pairs.len() {
            let pair = &self.progress.pairs[index];
            if pair.stale >= STALE {
                let (node, restarts) = (pair.node, pair.restarts.saturating_add(1));
                self.begin_again(node, restarts);
            }
        }
    }

    /// Restarts the search of a pair around the agent of its staircase.
    fn begin_again(&mut self, node: u32, restarts: u32) {
        let search = self.search(node, restarts, self.progress.agent(node));
        if let Some(pair) = self.progress.pair_mut(node) {
            *pair = Pair {
                restarts,
                recent: std::mem::take(&mut pair.recent),
                ..Pair::new(node, search)
            };
        }
    }

    /// For each staircase, proposes the agent of another staircase that covers the greatest share of the way in the nominal trial, if the
    /// share exceeds the recent scores of the staircase's own agent.
    fn proposals(&self, attempts: &[Attempt<PoetRole>], scores: &[f32]) -> Vec<Proposal> {
        let mut proposals = Vec::new();
        for pair in &self.progress.pairs {
            let to_beat = pair.to_beat();
            let mut best: Option<(Proposal, f32)> = None;
            for (attempt, &score) in attempts.iter().zip(scores) {
                if let PoetRole { node: Some(to), from: Some(from) } = attempt.role
                    && to == pair.node
                    && score > best.as_ref().map_or(to_beat, |(_, most)| *most)
                {
                    let genome = attempt.candidate.genome.clone();
                    best = Some((Proposal { from, to, genome }, score));
                }
            }
            proposals.extend(best.map(|(proposal, _)| proposal));
        }
        proposals
    }

    /// Keeps the proposals that beat the recent scores of their target over all trials, each with its best fine-tuned candidate.
    fn after_tuning(
        &mut self,
        proposals: Vec<Proposal>,
        attempts: &[Attempt<PoetRole>],
        scores: &[f32],
    ) -> Phase {
        let mut tuned = Vec::new();
        let mut rest = (0..).zip(attempts.iter().zip(scores)).peekable();
        for proposal in proposals {
            let Some((_, (_, &direct))) = rest.next() else { break };
            let mut best: Option<(u32, &Genome, f32)> = None;
            while let Some((individual, (attempt, score))) =
                rest.next_if(|(_, (attempt, _))| attempt.is_sample())
            {
                if best.is_none_or(|(.., most)| *score > most) {
                    best = Some((individual, &attempt.candidate.genome, *score));
                }
            }
            if direct > self.progress.pair(proposal.to).map_or(0.0, Pair::to_beat)
                && let Some((individual, genome, _)) = best
            {
                let Proposal { from, to, .. } = proposal;
                let (genome, generation) = (genome.clone(), self.generation);
                tuned.push(FineTuned { from, to, agent: Agent { genome, generation, individual } });
            }
        }
        if tuned.is_empty() { self.after_transfers() } else { Phase::Confirm { tuned } }
    }

    /// Replaces the agents of stairs by fine-tuned agents whose scores exceed the agents' recent scores.
    fn after_confirmation(&mut self, tuned: Vec<FineTuned>, scores: &[f32]) -> Phase {
        let round = self.progress.rounds + 1;
        for (FineTuned { from, to, agent }, &score) in tuned.into_iter().zip(scores) {
            let Some(pair) = self.progress.pair(to) else { continue };
            let restarts = pair.restarts.saturating_add(1);
            if score <= pair.to_beat() {
                continue;
            }
            if let Some(node) = self.progress.node_mut(to) {
                node.agent = Some(agent);
            }
            self.begin_again(to, restarts);
            let solved = self.settings.solved_from;
            let PoetProgress { pairs, nodes, transfers, .. } = &mut self.progress;
            let pair = pairs.iter_mut().find(|pair| pair.node == to);
            if let Some((node, pair)) = nodes.get_mut(to as usize).zip(pair) {
                Self::note_score(node, pair, score, round, solved);
            }
            if transfers.len() >= MOST_TRANSFERS {
                transfers.remove(0);
            }
            transfers.push(Transfer { round, from, to });
        }
        self.after_transfers()
    }

    fn after_transfers(&mut self) -> Phase {
        self.progress.transfers_done += 1;
        if self.progress.transfers_done < self.settings.transfers {
            return Phase::Learn { left: self.settings.learn_generations };
        }
        let children = self.children();
        if children.is_empty() { self.end_round() } else { Phase::Breed { children } }
    }

    /// Ends a round. Archives the oldest pairs, if there are too many.
    fn end_round(&mut self) -> Phase {
        self.progress.rounds += 1;
        let PoetProgress { rounds, nodes, pairs, .. } = &mut self.progress;
        while pairs.len() > self.settings.pairs as usize {
            let oldest = pairs.remove(0);
            if let Some(node) = nodes.get_mut(oldest.node as usize) {
                node.archived = Some(*rounds);
            }
        }
        self.progress.transfers_done = 0;
        Phase::Learn { left: self.settings.learn_generations }
    }
}

impl<S: Strategy> Strategy for Poet<S> {
    fn begin(plan: &RunPlan) -> Self {
        let founder = plan.founder.as_ref().map(|founder| founder.genome());
        let agent =
            founder.map(|genome| Agent { genome: genome.clone(), generation: 0, individual: 0 });
        let root = StairsNode { agent, ..StairsNode::new(Self::root(plan)) };
        let search = S::begin(&search_plan(plan, 0, 0, founder));
        let left = plan.settings.evolution.poet.learn_generations;
        let progress = PoetProgress {
            phase: Phase::Learn { left },
            rounds: 0,
            transfers_done: 0,
            nodes: vec![root],
            pairs: vec![Pair::new(0, search)],
            panel: Vec::new(),
            rows: vec![Vec::new()],
            transfers: Vec::new(),
        };
        Self::with(plan, 0, progress)
    }

    fn resume(plan: &RunPlan, finished: u32, state: &StrategyState) -> Result<Self, Invalid> {
        let progress = PoetProgress::read(state, plan, finished)?;
        Ok(Self::with(plan, finished, progress))
    }

    fn ask(&self) -> Vec<Candidate> {
        Attempt::candidates(&self.batch)
    }

    fn population(&self) -> usize {
        self.batch.len()
    }

    /// Processes the evaluations of the present phase, in the order of its candidates, and begins the next phase.
    fn tell(&mut self, candidates: &[Candidate], evaluations: &[Evaluation]) {
        let scores: Vec<f32> = evaluations.iter().map(Self::score).collect();
        let attempts = std::mem::take(&mut self.batch);
        for attempt in &attempts {
            if let Some(node) = attempt.role.node.and_then(|node| self.progress.node_mut(node)) {
                let trials = u64::from(attempt.perturbed) + 1;
                node.trials = node.trials.saturating_add(trials);
            }
        }
        let phase = std::mem::replace(&mut self.progress.phase, Phase::Measure);
        self.progress.phase = match phase {
            Phase::Learn { left } => self.after_learning(left, candidates, evaluations),
            Phase::Measure => self.after_measurement(&attempts, &scores),
            Phase::Tune { proposals } => self.after_tuning(proposals, &attempts, &scores),
            Phase::Confirm { tuned } => self.after_confirmation(tuned, &scores),
            Phase::Breed { children } => self.after_breeding(children, &scores),
            Phase::Compare { children } => self.after_comparison(&children, &scores),
            Phase::Place { first } => self.after_placing(first, &scores),
        };
        self.generation += 1;
        self.batch = self.next_batch();
    }

    fn state(&self) -> StrategyState {
        StrategyState::of(&self.progress)
    }

    fn apply_settings(&mut self, plan: &RunPlan) {
        self.settings = plan.settings.evolution.poet.clone();
        self.plan = plan.clone();
        for pair in &mut self.progress.pairs {
            pair.search.apply_settings(&search_plan(plan, pair.node, pair.restarts, None));
        }
        self.batch = self.next_batch();
    }

    fn stairs_tree(&self) -> Option<StairsTree> {
        let PoetProgress { rounds, nodes, transfers, .. } = &self.progress;
        Some(StairsTree { rounds: *rounds, nodes: nodes.clone(), transfers: transfers.clone() })
    }
}
