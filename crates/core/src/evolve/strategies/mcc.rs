//! Minimal criterion coevolution: a queue of snakes and a queue of stairs, without any fitness (Brant and Stanley, "Minimal
//! Criterion Coevolution", 2017).
//!
//! A snake enters the queue of snakes if it climbs some stairs of the queue of stairs, and stairs enter their queue if some snake climbs
//! them. The members of a queue have children in turn; when a queue is full, its oldest member is removed. Only a limited number of snakes
//! may enter by climbing the same stairs (Brant and Stanley, 2020): otherwise most snakes would be those of the easiest stairs. A search on
//! the first stairs finds the first snakes.
//!
//! Differences from the papers: there is one first staircase, children are drawn around their parents as by CMA-ES instead of by NEAT, a
//! snake that climbs several stairs counts for the least used of them, and the limit of uses ends once the run has the maximum number of
//! stairs.

mod state;
#[cfg(test)]
mod tests;

use rand::Rng;

use super::attempt::Attempt;
use super::inner_search::InnerSearch;
use crate::check::Invalid;
use crate::evolve::candidate::Candidate;
use crate::evolve::plan::RunPlan;
use crate::evolve::settings::{MccSettings, PoetSettings};
use crate::evolve::stairs_tree::{Agent, StairsNode, StairsTree};
use crate::evolve::strategy::{Strategy, StrategyState};
use crate::genome::{Genome, StairsChange, StairsGenome};
use crate::rng::{Purpose, stream};
use crate::score::Evaluation;
use state::{FirstSearch, MccProgress, PATIENCE};

/// Minimal criterion coevolution. Searches of the kind `S` make the children and find the first snakes.
pub struct Mcc<S> {
    /// Plan of the run.
    plan: RunPlan,
    /// Number of the next generation; the first is 1.
    generation: u32,
    progress: MccProgress<S>,
    /// Attempts of the next generation, which follow from the progress.
    batch: Vec<Attempt<MccRole>>,
}

/// Candidate that an attempt tests. Children are numbered within the generation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum MccRole {
    /// The attempt tests whether a candidate can be one of the first snakes.
    First,
    /// The attempt tests whether child number `child` of a snake climbs the stairs with the index `node`.
    Snake { child: u32, node: u32 },
    /// The attempt tests whether a snake of the queue climbs mutant number `child` of the stairs with the index `parent`.
    Stairs { child: u32, parent: u32, snake: u32 },
}

impl<S: Strategy> Mcc<S> {
    fn with(plan: &RunPlan, finished: u32, progress: MccProgress<S>) -> Self {
        let plan = plan.clone();
        let mut mcc = Self { plan, generation: finished + 1, progress, batch: Vec::new() };
        mcc.batch = mcc.next_batch();
        mcc
    }

    fn settings(&self) -> &MccSettings {
        &self.plan.settings.evolution.mcc
    }

    /// Returns the attempts of the next generation.
    fn next_batch(&self) -> Vec<Attempt<MccRole>> {
        if let Some(beginning) = &self.progress.beginning {
            let stairs = self.progress.nodes[0].stairs;
            let first = |asked| Attempt::sampled(asked, stairs, MccRole::First);
            return beginning.search.ask().into_iter().map(first).collect();
        }
        let mut all = self.children_of_snakes();
        all.extend(self.mutants_of_stairs());
        all
    }

    /// Returns the attempts of the children of snakes whose turn it is: each child on all stairs that still have uses.
    fn children_of_snakes(&self) -> Vec<Attempt<MccRole>> {
        let MccProgress { snakes, snake_turn, .. } = &self.progress;
        let open: Vec<u32> = self.progress.active().filter(|node| self.has_uses(*node)).collect();
        let mut all = Vec::new();
        if open.is_empty() {
            return all;
        }
        for child in 0..self.settings().snake_children {
            let parent = &snakes[(snake_turn + child) as usize % snakes.len()];
            let individual = all.len() as u32;
            let genome = self.child_of(&parent.genome, individual);
            all.extend(open.iter().map(|&node| {
                let stairs = self.progress.nodes[node as usize].stairs;
                Attempt::new(&genome, stairs, MccRole::Snake { child, node })
            }));
        }
        all
    }

    /// Returns whether snakes may still enter their queue by climbing these stairs. They always may once no more stairs can be added.
    fn has_uses(&self, node: u32) -> bool {
        !self.has_room() || self.progress.uses[node as usize] < self.settings().uses_of_stairs
    }

    /// Returns whether the run has room for the mutants of another generation.
    fn has_room(&self) -> bool {
        let most_new = self.settings().stairs_children as usize;
        self.progress.nodes.len() + most_new <= PoetSettings::MOST_STAIRS
    }

    /// Draws a child of a snake.
    fn child_of(&self, parent: &Genome, individual: u32) -> Genome {
        let mut rng = stream(self.plan.seed, self.generation, individual, Purpose::Mutation);
        let of = InnerSearch {
            // A search needs a population of at least two.
            population: 2,
            step: self.settings().child_step,
            seed: rng.next_u64(),
            around: Some(parent),
        };
        let drawn = S::begin(&of.plan(&self.plan)).ask().pop();
        drawn.map_or_else(|| parent.clone(), |of| of.genome)
    }

    /// Returns the attempts of all snakes on each mutant of the stairs whose turn it is.
    fn mutants_of_stairs(&self) -> Vec<Attempt<MccRole>> {
        let MccProgress { snakes, nodes, stairs_turn, .. } = &self.progress;
        let active: Vec<u32> = self.progress.active().collect();
        let longest_m = self.plan.settings.trial.stairs.treads_m().max(nodes[0].stairs.length_m());
        let mut all = Vec::new();
        if !self.has_room() {
            return all;
        }
        for child in 0..self.settings().stairs_children {
            let parent = active[(stairs_turn + child) as usize % active.len()];
            let mut rng = stream(self.plan.seed, self.generation, child, Purpose::StairsMutation);
            let change = StairsChange::drawn(longest_m, self.settings().special_steps, &mut rng);
            let stairs = nodes[parent as usize].stairs.mutant(&change, &mut rng);
            if nodes.iter().any(|node| node.stairs == stairs) {
                continue;
            }
            all.extend((0..).zip(snakes).map(|(snake, of)| {
                Attempt::new(&of.genome, stairs, MccRole::Stairs { child, parent, snake })
            }));
        }
        all
    }

    /// Returns whether the evaluated snake climbs its stairs.
    fn climbs(&self, evaluation: &Evaluation) -> bool {
        evaluation.disqualified.is_none() && evaluation.fitness >= self.settings().criterion
    }

    /// Processes the evaluations of the search for the first snakes.
    fn after_first(&mut self, candidates: &[Candidate], evaluations: &[Evaluation]) {
        let wanted = self.settings().first_snakes as usize;
        let mut found = 0;
        for (individual, (candidate, evaluation)) in (0..).zip(candidates.iter().zip(evaluations)) {
            if !self.climbs(evaluation) {
                continue;
            }
            let genome = candidate.genome.clone();
            let agent = Agent { genome, generation: self.generation, individual };
            found += 1;
            let root = &mut self.progress.nodes[0];
            if root.agent.is_none() || evaluation.fitness > root.score {
                (root.agent, root.score) = (Some(agent.clone()), evaluation.fitness);
            }
            root.solved = root.solved.or(Some(0));
            if self.progress.snakes.len() < wanted {
                self.progress.snakes.push(agent);
            }
        }
        let trials = &mut self.progress.nodes[0].trials;
        *trials = trials.saturating_add(evaluations.len() as u64);
        if self.progress.snakes.len() >= wanted {
            self.progress.beginning = None;
            return;
        }
        let Some(beginning) = &mut self.progress.beginning else { return };
        beginning.search.tell(candidates, evaluations);
        beginning.finished += 1;
        beginning.idle = if found > 0 { 0 } else { beginning.idle + 1 };
        if beginning.idle >= PATIENCE {
            *beginning = FirstSearch::new(&self.plan, beginning.restarts.saturating_add(1));
        }
    }

    /// Processes the evaluations of children. Those that meet the criterion enter the queues.
    fn after_children(&mut self, evaluations: &[Evaluation]) {
        self.progress.rounds += 1;
        self.progress.pass_turns(self.settings().snake_children, self.settings().stairs_children);
        let batch = std::mem::take(&mut self.batch);
        let tried: Vec<Tried<'_>> = (0..)
            .zip(batch.iter().zip(evaluations))
            .map(|(individual, (attempt, evaluation))| (individual, attempt, evaluation))
            .collect();
        for of_child in tried.chunk_by(|(_, a, _), (_, b, _)| a.role.is_of_child_of(b.role)) {
            match of_child.first().map(|(_, attempt, _)| attempt.role) {
                Some(MccRole::Snake { .. }) => self.take_snake(of_child),
                Some(MccRole::Stairs { parent, .. }) => self.take_stairs(parent, of_child),
                Some(MccRole::First) | None => {}
            }
        }
        self.progress.shorten(&self.plan.settings.evolution.mcc);
    }

    /// Adds a child of a snake to the queue, if it climbs stairs that still have uses. The entry counts for the least used of these stairs.
    fn take_snake(&mut self, tried: &[Tried<'_>]) {
        let mut least: Option<(u32, u32, f32, u32)> = None;
        for (individual, attempt, evaluation) in tried {
            let MccRole::Snake { node, .. } = attempt.role else { continue };
            let trials = &mut self.progress.nodes[node as usize].trials;
            *trials = trials.saturating_add(1);
            let uses = self.progress.uses[node as usize];
            if self.climbs(evaluation)
                && self.has_uses(node)
                && least.is_none_or(|(fewest, ..)| uses < fewest)
            {
                least = Some((uses, node, evaluation.fitness, *individual));
            }
        }
        let Some((_, node, fitness, individual)) = least else { return };
        let genome = tried[0].1.candidate.genome.clone();
        let agent = Agent { genome, generation: self.generation, individual };
        let uses = &mut self.progress.uses[node as usize];
        *uses = uses.saturating_add(1);
        let of = &mut self.progress.nodes[node as usize];
        if fitness > of.score {
            (of.agent, of.score) = (Some(agent.clone()), fitness);
        }
        self.progress.snakes.push(agent);
    }

    /// Adds a mutant of stairs to the queue, if a snake climbs it.
    fn take_stairs(&mut self, parent: u32, tried: &[Tried<'_>]) {
        let climbed = tried.iter().filter(|(.., evaluation)| self.climbs(evaluation));
        // Of snakes with equal fitness the first is kept.
        let best = climbed.reduce(|a, b| if b.2.fitness > a.2.fitness { b } else { a });
        let Some((_, attempt, evaluation)) = best else { return };
        let MccRole::Stairs { snake, .. } = attempt.role else { return };
        let MccProgress { nodes, uses, snakes, rounds, .. } = &mut self.progress;
        nodes.push(StairsNode {
            parent: Some(parent),
            born: *rounds,
            solved: Some(*rounds),
            agent: snakes.get(snake as usize).cloned(),
            score: evaluation.fitness,
            trials: tried.len() as u64,
            ..StairsNode::new(attempt.stairs)
        });
        uses.push(0);
    }
}

/// Index of an individual, its attempt, and its evaluation.
type Tried<'a> = (u32, &'a Attempt<MccRole>, &'a Evaluation);

impl MccRole {
    /// Returns whether two attempts test the same child.
    fn is_of_child_of(self, other: Self) -> bool {
        match (self, other) {
            (Self::Snake { child: a, .. }, Self::Snake { child: b, .. })
            | (Self::Stairs { child: a, .. }, Self::Stairs { child: b, .. }) => a == b,
            _ => false,
        }
    }
}

impl<S: Strategy> Strategy for Mcc<S> {
    fn begin(plan: &RunPlan) -> Self {
        let evolution = &plan.settings.evolution;
        let stairs = StairsGenome::like(&plan.settings.trial.stairs, evolution.mcc.start_rise_m);
        let progress = MccProgress {
            beginning: Some(FirstSearch::new(plan, 0)),
            rounds: 0,
            nodes: vec![StairsNode::new(stairs)],
            uses: vec![0],
            snakes: Vec::new(),
            snake_turn: 0,
            stairs_turn: 0,
        };
        Self::with(plan, 0, progress)
    }

    fn resume(plan: &RunPlan, finished: u32, state: &StrategyState) -> Result<Self, Invalid> {
        let mut progress = MccProgress::read(state, plan, finished)?;
        // A change of settings may have reduced the maximum lengths of the queues.
        progress.shorten(&plan.settings.evolution.mcc);
        Ok(Self::with(plan, finished, progress))
    }

    fn ask(&self) -> Vec<Candidate> {
        Attempt::candidates(&self.batch)
    }

    fn population(&self) -> usize {
        self.batch.len()
    }

    fn tell(&mut self, candidates: &[Candidate], evaluations: &[Evaluation]) {
        if self.progress.beginning.is_some() {
            self.after_first(candidates, evaluations);
        } else {
            self.after_children(evaluations);
        }
        self.generation += 1;
        self.batch = self.next_batch();
    }

    fn state(&self) -> StrategyState {
        StrategyState::of(&self.progress)
    }

    fn apply_settings(&mut self, plan: &RunPlan) {
        self.plan = plan.clone();
        if let Some(beginning) = &mut self.progress.beginning {
            beginning.search.apply_settings(&FirstSearch::<S>::plan(plan, beginning.restarts));
        }
        self.progress.shorten(&plan.settings.evolution.mcc);
        self.batch = self.next_batch();
    }

    fn stairs_tree(&self) -> Option<StairsTree> {
        let MccProgress { rounds, nodes, .. } = &self.progress;
        Some(StairsTree { rounds: *rounds, nodes: nodes.clone(), transfers: Vec::new() })
    }
}
