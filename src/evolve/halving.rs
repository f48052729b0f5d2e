//! The report's method: the best few become parents, every child is one parent shifted at random, and
//! the range of the shift halves with each generation.

use serde::{Deserialize, Serialize};

use super::{RunPlan, Strategy, StrategyState, ranking};
use crate::check::{Invalid, within};
use crate::genome::{Genome, GenomeSpace};
use crate::rng::{Purpose, stream};
use crate::score::Evaluation;

/// Settings of the report's method.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HalvingSettings {
    /// Individuals per generation. The report simulated 500 to 1000.
    pub population: u32,
    /// Generations in a run. The report has six.
    pub generations: u32,
    /// How many of the best become parents. The report has four.
    pub parents: u32,
    /// Mutation range of the second generation, in N·m. The report has 100.
    pub mutation_range_nm: f32,
    /// What the range is multiplied by with each further generation. The report has 0.5.
    pub mutation_decay: f32,
}

impl Default for HalvingSettings {
    fn default() -> Self {
        Self {
            population: 500,
            generations: 6,
            parents: 4,
            mutation_range_nm: 100.0,
            mutation_decay: 0.5,
        }
    }
}

/// The most individuals a generation may have: their genomes must fit into memory.
pub const LARGEST_POPULATION: u32 = 100_000;

impl HalvingSettings {
    /// Checks every field against its range.
    pub fn check(&self) -> Result<(), Invalid> {
        within("population", self.population, 1..=LARGEST_POPULATION)?;
        within("generations", self.generations, 1..=10_000)?;
        within("parents", self.parents, 1..=LARGEST_POPULATION)?;
        within("mutation_range_nm", self.mutation_range_nm, 0.0..=1.0e6)?;
        within("mutation_decay", self.mutation_decay, 0.0..=1.0)
    }
}

/// The report's method at work.
#[derive(Debug, Clone)]
pub struct Halving {
    settings: HalvingSettings,
    space: GenomeSpace,
    run_seed: u64,
    joints: usize,
    duration_s: f32,
    /// The generation that `ask` returns; the first is 1.
    generation: u32,
    parents: Vec<Genome>,
}

impl Halving {
    /// A fresh search.
    pub fn new(plan: &RunPlan) -> Self {
        Self::resumed(plan, 0, Vec::new())
    }

    /// A search that goes on after its first `finished` generations, of which `parents` are left.
    pub fn resumed(plan: &RunPlan, finished: u32, parents: Vec<Genome>) -> Self {
        let settings = &plan.settings;
        Self {
            settings: settings.evolution.clone(),
            space: settings.genome.clone(),
            run_seed: plan.seed,
            joints: settings.trial.agent.joints(),
            duration_s: settings.trial.duration_s,
            generation: finished + 1,
            parents,
        }
    }

    /// The range within which the children of the current generation are shifted, in N·m.
    fn mutation_range_nm(&self) -> f32 {
        // Repeated multiplication instead of a power: its bits are the same everywhere.
        (2..self.generation)
            .fold(self.settings.mutation_range_nm, |range, _| range * self.settings.mutation_decay)
    }

    fn newborn(&self, individual: u32) -> Genome {
        let mut rng = stream(self.run_seed, self.generation, individual, Purpose::Birth);
        self.space.birth(self.joints, self.duration_s, &mut rng)
    }

    fn child(&self, individual: u32) -> Genome {
        // In turn, so that every parent has its equal share of the children.
        let parent = &self.parents[individual as usize % self.parents.len()];
        let mut rng = stream(self.run_seed, self.generation, individual, Purpose::Mutation);
        self.space.mutated(parent, self.mutation_range_nm(), &mut rng)
    }
}

impl Strategy for Halving {
    /// The first generation is drawn from nothing; so is a later one that found nobody fit to be a
    /// parent because all were disqualified.
    fn ask(&self) -> Vec<Genome> {
        let individuals = 0..self.settings.population;
        if self.parents.is_empty() {
            individuals.map(|individual| self.newborn(individual)).collect()
        } else {
            individuals.map(|individual| self.child(individual)).collect()
        }
    }

    fn tell(&mut self, genomes: &[Genome], evaluations: &[Evaluation]) {
        let best = ranking(evaluations);
        let chosen = best.iter().take(self.settings.parents as usize);
        self.parents = chosen.map(|&index| genomes[index].clone()).collect();
        self.generation += 1;
    }

    fn state(&self) -> StrategyState {
        StrategyState::Halving { parents: self.parents.clone() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::Settings;
    use crate::world::Disqualification;

    fn evaluated(fitness: f32) -> Evaluation {
        let disqualified = None;
        Evaluation {
            fitness,
            centre_y_m: fitness,
            disqualified,
            trace_hash: 0,
            steps: 1,
            effort: None,
        }
    }

    fn small() -> Halving {
        let evolution = HalvingSettings { population: 8, parents: 2, ..HalvingSettings::default() };
        let mut settings = Settings { evolution, ..Settings::default() };
        settings.trial.duration_s = 1.0;
        Halving::new(&RunPlan::new("test", 1, settings))
    }

    /// The largest difference between two genomes' torque points, in N·m.
    fn distance_nm(a: &Genome, b: &Genome) -> f32 {
        let (mut a, mut b) = (a.clone(), b.clone());
        let pairs = a.signals.all_mut().flatten().zip(b.signals.all_mut().flatten());
        pairs.map(|(x, y)| (*x - *y).abs()).fold(0.0, f32::max)
    }

    #[test]
    fn children_come_from_the_best_in_turn_within_the_halved_range() {
        let mut halving = small();
        let mut genomes = halving.ask();
        for range_nm in [100.0, 50.0, 25.0] {
            let fitness = (0..8).map(|i| evaluated(if i == 5 { 9.0 } else { i as f32 }));
            halving.tell(&genomes, &fitness.collect::<Vec<_>>());
            let children = halving.ask();
            for (index, child) in children.iter().enumerate() {
                let parent = &genomes[if index % 2 == 0 { 5 } else { 7 }];
                let distance = distance_nm(child, parent);
                assert!(distance <= range_nm + 0.001, "{distance} N·m in a range of {range_nm}");
                assert!(distance > range_nm * 0.5, "{distance} N·m in a range of {range_nm}");
            }
            genomes = children;
        }
    }

    #[test]
    fn a_generation_without_a_healthy_agent_starts_afresh() {
        let mut halving = small();
        let genomes = halving.ask();
        let broken =
            Evaluation { disqualified: Some(Disqualification::JointBroke), ..evaluated(99.0) };
        halving.tell(&genomes, &[broken; 8]);
        let again = halving.ask();
        assert_eq!(again.len(), 8);
        assert!(distance_nm(&again[0], &genomes[0]) > 200.0, "newborns, not copies");
    }
}
