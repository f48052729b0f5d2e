//! Settings of POET.

use super::size::{GenomeSize, LARGEST_GENERATION_GENES, LARGEST_SAMPLE, LARGEST_STATE_GENES};
use crate::check::Invalid;
use crate::schema::{Need, number, setting_group, switch, whole};

setting_group! {
    /// Settings of POET: paired open-ended trailblazer (Wang, Lehman, Clune, Stanley, 2019; "Enhanced POET", 2020).
    pub struct PoetSettings in "POET":
        "Pairs of stairs and snakes: the stairs mutate, the snakes learn, and a snake moves to stairs that it climbs better."
    {
        /// Maximum number of active pairs of a staircase and a snake.
        pairs: u32 = 10,
            whole("Pairs", 1..=100)
                .hint("Maximum number of stairs whose snakes learn. When another one comes, the oldest is archived")
                .slider(1.0, 40.0);

        /// Number of candidates in a generation of each pair's search.
        pair_candidates: u32 = 12,
            whole("Candidates of a pair", 4..=1000)
                .hint("Number of snakes that each pair tries in a generation")
                .slider(4.0, 60.0)
                .fixed(super::cma_es::LEARNED);

        /// Standard deviation of each gene in the first generation of a pair, as a share of the gene's range.
        pair_step: f32 = 0.15,
            number("First step of a pair", 0.001..=1.0).needs(PoetSettings::POINTS)
                .hint("Spread of a pair's first candidates around its snake, as a share of each gene's range")
                .slider(0.01, 0.5)
                .logarithmic_from(0.01)
                .fixed(super::cma_es::LEARNED);

        /// Number of generations that each pair learns before snakes may be transferred to other stairs.
        learn_generations: u32 = 5,
            whole("Generations between transfers", 1..=1000)
                .hint("How many generations each pair learns before snakes may move to other stairs")
                .slider(1.0, 50.0);

        /// Number of transfer phases in a round, after which new stairs are made.
        transfers: u32 = 4,
            whole("Transfers in a round", 1..=100)
                .hint("How often snakes may move before new stairs are made; then a round ends")
                .slider(1.0, 20.0);

        /// Number of mutants of stairs that are tried at the end of a round.
        children: u32 = 8,
            whole("Mutants of stairs", 1..=100)
                .hint("How many mutants of stairs are tried at the end of a round")
                .slider(1.0, 40.0);

        /// Maximum number of mutants of stairs that become pairs at the end of a round.
        admitted: u32 = 1,
            whole("New stairs in a round", 1..=10).advanced()
                .hint("How many of the mutants are kept at most: those that rank the snakes of the run in the newest order")
                .slider(1.0, 10.0);

        /// Least score of a pair whose stairs may have mutants. A score is a share of the way.
        reproduces_from: f32 = 0.55,
            number("Share to reproduce", 0.0..=1.1).advanced()
                .hint("Stairs have mutants once their snake covers this share of the way")
                .slider(0.0, 1.0);

        /// Least score of the best snake on stairs that are not too hard.
        too_hard_below: f32 = 0.15,
            number("Too hard below", 0.0..=1.1).advanced()
                .hint("Mutants on which the best snake covers a smaller share of the way are refused")
                .slider(0.0, 1.0);

        /// Greatest score of the best snake on stairs that are not too easy.
        too_easy_above: f32 = 0.85,
            number("Too easy above", 0.0..=1.1).advanced()
                .hint("Mutants on which a snake covers a greater share of the way are refused")
                .slider(0.0, 1.0);

        /// Least score of the snake of a pair at which its stairs are solved.
        solved_from: f32 = 0.85,
            number("Solved from", 0.0..=1.1).advanced()
                .hint("Share of the way that the snake of a pair has to cover to solve its stairs")
                .slider(0.0, 1.0);

        /// Number of perturbed trials, in addition to the nominal trial, in which agents are measured and transferred.
        perturbed: u32 = 2,
            whole("Perturbed trials of a measurement", 0..=99).advanced()
                .hint("Varied trials in which the snakes of pairs are compared, so that none moves by luck")
                .slider(0.0, 10.0);

        /// Rise of a step of the first stairs, in m.
        root_rise_m: f32 = 0.1,
            number("First rise", 0.1..=1.2)
                .unit("m")
                .hint("Rise of the first stairs; their steps and treads are those of the trial")
                .slider(0.1, 1.2)
                .fixed("Takes effect with the next run, because this one has begun on its first stairs.");

        /// Whether mutants of stairs may also have landings, missing steps, ramps and steps down.
        features: bool = true,
            switch("Landings, gaps, ramps")
                .hint("Whether mutants may also have a landing, a missing step, ramps or steps down");
    }

    fn check_together(&self) -> Result<(), Invalid> {
        if self.too_hard_below <= self.too_easy_above {
            return Ok(());
        }
        Err(Invalid::new("too_hard_below", self.too_hard_below, format!("up to {}, above which stairs are too easy", self.too_easy_above)))
    }
}

impl PoetSettings {
    /// The need of a search among points. Pairs have such a search unless their bodies evolve.
    pub(super) const POINTS: Need = Need("a search among points");

    /// Maximum number of stairs in a run, which limits the size of its state. Beyond it no stairs are added.
    pub const MOST_STAIRS: usize = 1000;

    /// Checks that a generation, and the agents of all stairs, fit into memory.
    pub(super) fn check_size(&self, size: &GenomeSize<'_>) -> Result<(), Invalid> {
        let at_once = self.pairs * self.pair_candidates.max(self.pairs);
        let field = "evolution.poet.pairs";
        size.check_count(field, at_once, size.genes(), LARGEST_SAMPLE)?;
        // Mutants are compared on all agents, and on a copy of the first agent of each staircase.
        let compared = self.children * (self.pairs + Self::MOST_STAIRS as u32);
        let children = "evolution.poet.children";
        size.check_count(children, compared, size.genes(), LARGEST_GENERATION_GENES)?;
        // Each staircase keeps its agent and a copy of its first agent.
        let kept = 2 * Self::MOST_STAIRS as u32 + self.pairs * self.pair_candidates;
        size.check_count(field, kept, size.genes(), LARGEST_STATE_GENES)
    }
}
