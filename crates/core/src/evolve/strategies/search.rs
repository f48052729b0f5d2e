//! The common part of all strategies that search among points of the unit cube.

use std::sync::Arc;

use rand_chacha::ChaCha8Rng;

use crate::check::{Invalid, within};
use crate::evolve::plan::{Founder, RunPlan};
use crate::genome::{Genome, GenomeShape, GenomeSpace};
use crate::rng::{Purpose, normal, stream};

/// A search among points: the genome at each point, and the streams of random numbers.
#[derive(Debug, Clone)]
pub struct Search {
    space: GenomeSpace,
    shape: GenomeShape,
    seed: u64,
    /// The next generation; the first is 1.
    pub generation: u32,
    /// Individuals per generation.
    pub population: usize,
    /// Coordinates of a point.
    pub dimension: usize,
    /// The founder that the first generation descends from, and its point.
    founder: Option<(Arc<Founder>, Vec<f64>)>,
}

impl Search {
    /// The search after the first `finished` generations of a run.
    pub fn new(plan: &RunPlan, finished: u32) -> Self {
        let space = plan.settings.genome.clone();
        let shape = plan.settings.trial.genome_shape();
        let founder = plan.founder.as_ref().filter(|_| finished == 0);
        let with_point =
            |founder: &Arc<Founder>| (Arc::clone(founder), space.exact_point_of(founder.genome()));
        Self {
            founder: founder.map(with_point),
            dimension: space.dimension(shape),
            space,
            shape,
            seed: plan.seed,
            generation: finished + 1,
            population: plan.settings.evolution.population as usize,
        }
    }

    /// The point of the founder, in the first generation.
    pub fn founder(&self) -> Option<&[f64]> {
        self.founder.as_ref().filter(|_| self.generation == 1).map(|(_, point)| point.as_slice())
    }

    /// Whether an individual of the first generation is a mutant of the founder. The first individual is the founder
    /// itself, every second one after it is a mutant, and the others are random.
    pub fn is_founder_mutant(individual: usize) -> bool {
        individual.is_multiple_of(2)
    }

    /// The point of an individual that has no parents: that of the founder, of a mutant of it by normally distributed
    /// steps, or a random one.
    pub fn first_point(&self, individual: usize, step: f64) -> Vec<f64> {
        match self.founder() {
            Some(founder) if individual == 0 => founder.to_vec(),
            Some(founder) if Self::is_founder_mutant(individual) => {
                let mut rng = self.stream(individual, Purpose::Mutation);
                founder.iter().map(|x| x + step * normal(&mut rng)).collect()
            }
            _ => self.random_genome_point(individual),
        }
    }

    /// Replaces the first genome of the first generation by the founder, if there is one: the genome at its point
    /// may differ by rounding.
    pub fn with_founder_first(&self, mut genomes: Vec<Genome>) -> Vec<Genome> {
        if let Some((founder, _)) = self.founder.as_ref().filter(|_| self.generation == 1)
            && let Some(first) = genomes.first_mut()
        {
            first.clone_from(founder.genome());
        }
        genomes
    }

    /// Adopts the population of a plan in which it may have changed.
    pub fn apply_settings(&mut self, plan: &RunPlan) {
        self.population = plan.settings.evolution.population as usize;
    }

    /// The random stream of an individual of the current generation.
    pub fn stream(&self, individual: usize, purpose: Purpose) -> ChaCha8Rng {
        stream(self.seed, self.generation, individual as u32, purpose)
    }

    /// The genome at a point.
    pub fn genome(&self, point: &[f64]) -> Genome {
        self.space.genome_at(point, self.shape)
    }

    /// The point of a genome.
    #[cfg(test)]
    pub fn point_of(&self, genome: &Genome) -> Vec<f64> {
        self.space.point_of(genome)
    }

    /// The genomes at several points.
    pub fn genomes(&self, points: &[Vec<f64>]) -> Vec<Genome> {
        points.iter().map(|point| self.genome(point)).collect()
    }

    /// The point of the unit cube that has the same genome as a point outside it.
    pub fn folded(&self, point: &[f64]) -> Vec<f64> {
        self.space.wrapped(point, self.shape)
    }

    /// Ends a mutation from one point to another by the rules of the kind of controller.
    pub fn after_mutation(&self, before: &[f64], point: &mut [f64], rng: &mut ChaCha8Rng) {
        self.space.after_mutation(before, point, self.shape, rng);
    }

    /// A random genome.
    pub fn random_genome(&self, individual: usize) -> Genome {
        self.space.random_genome(self.shape, &mut self.stream(individual, Purpose::Birth))
    }

    /// The point of a random genome.
    pub fn random_genome_point(&self, individual: usize) -> Vec<f64> {
        self.space.point_of(&self.random_genome(individual))
    }

    /// Checks a point from a file.
    pub fn check(&self, point: &[f64]) -> Result<(), Invalid> {
        within("coordinates", point.len(), self.dimension..=self.dimension)?;
        // Reflections and turns return any point to the cube, but lose precision far outside.
        point.iter().try_for_each(|&x| within("coordinate", x, -1.0e6..=1.0e6))
    }
}
