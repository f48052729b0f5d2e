//! The common part of strategies: the genomes that they may make, the founder, and points of the unit cube.

use std::sync::Arc;

use rand_chacha::ChaCha8Rng;

use crate::check::{Invalid, within};
use crate::evolve::candidate::Candidate;
use crate::evolve::parents::Parents;
use crate::evolve::plan::{Founder, RunPlan};
use crate::genome::{Genome, GenomeShape, GenomeSpace};
use crate::rng::{Purpose, normal, stream};

/// The common part of all searches: the space of genomes, the founder, and the streams of random numbers.
#[derive(Debug, Clone)]
pub struct Search {
    /// The genomes that may be made.
    pub space: GenomeSpace,
    shape: GenomeShape,
    /// Seed of the run.
    pub seed: u64,
    /// The next generation; the first is 1.
    pub generation: u32,
    /// Individuals per generation.
    pub population: usize,
    /// The founder that the first generation descends from.
    founder: Option<Arc<Founder>>,
}

impl Search {
    /// The search after the first `finished` generations of a run.
    pub fn new(plan: &RunPlan, finished: u32) -> Self {
        Self {
            founder: plan.founder.clone().filter(|_| finished == 0),
            space: plan.settings.genome.clone(),
            shape: plan.settings.trial.genome_shape(),
            seed: plan.seed,
            generation: finished + 1,
            population: plan.settings.evolution.population as usize,
        }
    }

    /// Number of coordinates of a point.
    pub fn dimension(&self) -> usize {
        self.space.dimension(self.shape)
    }

    /// The founder, for an individual that descends from it: in the first generation the first individual, which is the
    /// founder itself, and every second one after it. The others are random.
    pub fn founder_of(&self, individual: usize) -> Option<&Genome> {
        let descends = self.generation == 1 && individual.is_multiple_of(2);
        self.founder.as_ref().filter(|_| descends).map(|founder| founder.genome())
    }

    /// The point of the founder, in the first generation.
    pub fn founder_point(&self) -> Option<Vec<f64>> {
        self.founder_of(0).map(|founder| self.space.exact_point_of(founder))
    }

    /// The point from which an individual that has no parents begins: that of the founder, or a random one.
    pub fn unvaried_point(&self, individual: usize) -> Vec<f64> {
        match self.founder_of(individual) {
            Some(founder) => self.space.exact_point_of(founder),
            None => self.random_genome_point(individual),
        }
    }

    /// The point of an individual that has no parents: that of the founder, of a mutant of it by normally distributed
    /// steps, or a random one.
    pub fn first_point(&self, individual: usize, step: f64) -> Vec<f64> {
        let mut point = self.unvaried_point(individual);
        if individual > 0 && self.founder_of(individual).is_some() {
            let mut rng = self.stream(individual, Purpose::Mutation);
            point.iter_mut().for_each(|x| *x += step * normal(&mut rng));
        }
        point
    }

    /// Replaces the first genome of the first generation by the founder, if there is one: the genome at its point
    /// may differ by rounding.
    pub fn with_founder_first(&self, mut candidates: Vec<Candidate>) -> Vec<Candidate> {
        if let Some((founder, first)) = self.founder_of(0).zip(candidates.first_mut()) {
            first.genome.clone_from(founder);
        }
        candidates
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

    /// The candidate at a point.
    pub fn candidate(&self, point: Vec<f64>, parents: Parents) -> Candidate {
        let genome = self.genome(&point);
        Candidate::at(point, genome, parents)
    }

    /// Candidates at points that a distribution draws, given the random stream of each.
    pub fn sampled(
        &self,
        draw: impl FnOnce(&dyn Fn(u32) -> ChaCha8Rng) -> Vec<Vec<f64>>,
    ) -> Vec<Candidate> {
        let points = draw(&|index| self.stream(index as usize, Purpose::Sample));
        let candidate = |point| self.candidate(point, Parents::Distribution);
        points.into_iter().map(candidate).collect()
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

    /// Checks a genome from a file. An error names a body that cannot be built rather than a gene that does not fit the run.
    pub fn check_genome(&self, genome: &Genome, plan: &RunPlan) -> Result<(), Invalid> {
        plan.settings.trial.check_genome(genome)?;
        self.space.check_genome(genome, self.shape)
    }

    /// Checks a point from a file.
    pub fn check(&self, point: &[f64]) -> Result<(), Invalid> {
        check_point(point, self.dimension())
    }
}

/// Checks a point of this dimension from a file.
pub fn check_point(point: &[f64], dimension: usize) -> Result<(), Invalid> {
    within("coordinates", point.len(), dimension..=dimension)?;
    // Reflections and turns return any point to the cube, but lose precision far outside.
    point.iter().try_for_each(|&x| within("coordinate", x, -1.0e6..=1.0e6))
}
