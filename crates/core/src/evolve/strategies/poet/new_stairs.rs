//! New stairs at the end of a round: mutants, the minimal criterion, and the selection of the most novel mutants.

use super::state::{Child, Pair, Phase, PoetProgress};
use super::{Poet, novelty};
use crate::evolve::settings::PoetSettings;
use crate::evolve::stairs_tree::{Agent, StairsNode};
use crate::evolve::strategy::Strategy;
use crate::genome::StairsChange;
use crate::rng::{Purpose, drawn, stream};

impl<S: Strategy> Poet<S> {
    /// Returns mutants of stairs whose agents have the score that reproduction requires.
    pub(super) fn children(&self) -> Vec<Child> {
        let score = |node: u32| self.progress.node(node).map_or(0.0, |node| node.score);
        let mut parents: Vec<u32> = self.progress.pairs.iter().map(|pair| pair.node).collect();
        parents.retain(|node| score(*node) >= self.settings.reproduces_from);
        let room = PoetSettings::MOST_STAIRS.saturating_sub(self.progress.nodes.len());
        if parents.is_empty() || room < self.settings.admitted as usize {
            return Vec::new();
        }
        let longest_m = self.longest_m();
        let child = |number| {
            let round = self.progress.rounds + 1;
            let mut rng = stream(self.plan.seed, round, number, Purpose::StairsMutation);
            let parent = drawn(&parents, &mut rng);
            let change = StairsChange::drawn(longest_m, self.settings.features, &mut rng);
            let stairs = self.progress.node(parent)?.stairs.mutant(&change, &mut rng);
            let is_known = self.progress.nodes.iter().any(|node| node.stairs == stairs);
            (!is_known).then_some(Child { parent, stairs })
        };
        (0..self.settings.children).filter_map(child).collect()
    }

    /// Keeps the mutants on which the agents of their parents score neither too much nor too little.
    pub(super) fn after_breeding(&mut self, children: Vec<Child>, scores: &[f32]) -> Phase {
        let fits = |score: f32| {
            (self.settings.too_hard_below..=self.settings.too_easy_above).contains(&score)
        };
        let children: Vec<Child> = children
            .into_iter()
            .zip(scores)
            .filter_map(|(child, score)| fits(*score).then_some(child))
            .collect();
        if self.progress.panel.is_empty()
            && let Some(root) = self.progress.nodes.first_mut()
            && let Some(agent) = &root.agent
        {
            self.progress.panel.push(agent.genome.clone());
            self.progress.rows.iter_mut().for_each(|row| row.push(root.score));
        }
        if children.is_empty() { self.end_round() } else { Phase::Compare { children } }
    }

    /// Admits the most novel mutants on which the best active agent scores neither too much nor too little.
    pub(super) fn after_comparison(&mut self, children: &[Child], scores: &[f32]) -> Phase {
        let (least, most) = (self.settings.too_hard_below, self.settings.too_easy_above);
        let agents = self.progress.pairs.len();
        let mut rows: Vec<(&Child, &[f32], &[f32])> = Vec::new();
        let width = agents + self.progress.panel.len();
        for (child, scores) in children.iter().zip(scores.chunks(width.max(1))) {
            let (active, panel) = scores.split_at(agents.min(scores.len()));
            rows.push((child, active, panel));
        }
        let known: Vec<Vec<f32>> =
            self.progress.rows.iter().map(|row| novelty::ranks(row, least, most)).collect();
        let novelty =
            |panel: &[f32]| novelty::distance(&novelty::ranks(panel, least, most), &known);
        let mut order: Vec<usize> = (0..rows.len()).collect();
        let values: Vec<f32> = rows.iter().map(|(_, _, panel)| novelty(panel)).collect();
        order.sort_by(|&a, &b| values[b].total_cmp(&values[a]));
        let first = self.progress.nodes.len() as u32;
        for index in order {
            let (child, active, panel) = rows[index];
            if self.progress.nodes.len() as u32 - first >= self.settings.admitted {
                break;
            }
            let best = (0..active.len()).reduce(|a, b| if active[b] > active[a] { b } else { a });
            let Some(best) = best else { continue };
            let score = active[best];
            if !(least..=most).contains(&score) {
                continue;
            }
            let agent = self.progress.node(self.progress.pairs[best].node);
            let Some(agent) = agent.and_then(|node| node.agent.clone()) else { continue };
            let most_of_all = panel.iter().copied().fold(score, f32::max);
            self.admit(child, agent, score, panel.to_vec(), (least..=most).contains(&most_of_all));
        }
        if self.progress.nodes.len() as u32 == first {
            self.end_round()
        } else {
            Phase::Place { first }
        }
    }

    fn admit(
        &mut self,
        child: &Child,
        agent: Agent,
        score: f32,
        row: Vec<f32>,
        is_new_challenge: bool,
    ) {
        let number = self.progress.nodes.len() as u32;
        let search = self.search(number, 0, Some(&agent.genome));
        self.progress.nodes.push(StairsNode {
            parent: Some(child.parent),
            born: self.progress.rounds + 1,
            is_new_challenge,
            agent: Some(agent),
            score,
            ..StairsNode::new(child.stairs)
        });
        self.progress.rows.push(row);
        self.progress.pairs.push(Pair::new(number, search));
    }

    /// Adds the agents of the new stairs to the panel.
    pub(super) fn after_placing(&mut self, first: u32, scores: &[f32]) -> Phase {
        let PoetProgress { nodes, rows, panel, .. } = &mut self.progress;
        let count = nodes.len();
        for (node, column) in nodes.iter().skip(first as usize).zip(scores.chunks(count.max(1))) {
            panel.extend(node.agent.as_ref().map(|agent| agent.genome.clone()));
            rows.iter_mut().zip(column).for_each(|(row, score)| row.push(*score));
        }
        self.end_round()
    }
}
