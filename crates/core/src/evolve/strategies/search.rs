//! The common part of strategies: the space of genomes, the founder, and points of the unit cube.

use std::sync::Arc;

use rand_chacha::ChaCha8Rng;

use crate::check::{Invalid, within};
use crate::evolve::candidate::Candidate;
use crate::evolve::parents::Parents;
use crate::evolve::plan::{Founder, RunPlan};
use crate::genome::{Genome, GenomeShape, GenomeSpace};
use crate::rng::{Purpose, normal, stream};

/// The common part of all strategies: the space of genomes, the founder, and the random streams.
#[derive(Debug, Clone)]
pub struct Search {
    /// Space of the genomes that the strategy may make.
    pub space: GenomeSpace,
    /// Layout of the genomes where bodies do not evolve.
    pub shape: GenomeShape,
    /// Seed of the run.
    pub seed: u64,
    /// Number of the next generation; the first is 1.
    pub generation: u32,
    /// Number of individuals per generation.
    pub population: usize,
    /// Founder from which the first generation descends. None in later generations.
    founder: Option<Arc<Founder>>,
}

impl Search {
    /// Makes the common part after the first `finished` generations of a run.
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

    /// Returns the number of coordinates of a point.
    pub fn dimension(&self) -> usize {
        self.space.dimension(self.shape)
    }

    /// Returns the founder if an individual descends from it: in the first generation the first individual, which is the founder itself,
    /// and every second individual after it. None for the others, which are random.
    pub fn founder_of(&self, individual: usize) -> Option<&Genome> {
        let descends = self.generation == 1 && individual.is_multiple_of(2);
        self.founder.as_ref().filter(|_| descends).map(|founder| founder.genome())
    }

    /// Returns the point of the founder, in the first generation.
    pub fn founder_point(&self) -> Option<Vec<f64>> {
        self.founder_of(0).map(|founder| self.space.exact_point_of(founder))
    }

    /// Returns the point of an individual without parents, before mutation: that of the founder, or a random point.
    pub fn unvaried_point(&self, individual: usize) -> Vec<f64> {
        match self.founder_of(individual) {
            Some(founder) => self.space.exact_point_of(founder),
            None => self.random_genome_point(individual),
        }
    }

    /// Returns the point of an individual without parents: that of the founder, of a mutant of the founder by normally distributed steps,
    /// or a random point.
    pub fn first_point(&self, individual: usize, step: f64) -> Vec<f64> {
        let mut point = self.unvaried_point(individual);
        if individual > 0 && self.founder_of(individual).is_some() {
            let mut rng = self.stream(individual, Purpose::Mutation);
            point.iter_mut().for_each(|x| *x += step * normal(&mut rng));
        }
        point
    }

    /// Replaces the first genome of the first generation by the founder, if there is one, because a genome made from the founder's point
    /// may differ by rounding.
    pub fn with_founder_first(&self, mut candidates: Vec<Candidate>) -> Vec<Candidate> {
        if let Some((founder, first)) = self.founder_of(0).zip(candidates.first_mut()) {
            first.genome.clone_from(founder);
        }
        candidates
    }

    /// Adopts the population of a plan, which may have changed.
    pub fn apply_settings(&mut self, plan: &RunPlan) {
        self.population = plan.settings.evolution.population as usize;
    }

    /// Returns the random stream of an individual of the current generation.
    pub fn stream(&self, individual: usize, purpose: Purpose) -> ChaCha8Rng {
        stream(self.seed, self.generation, individual as u32, purpose)
    }

    /// Returns the genome at a point.
    pub fn genome(&self, point: &[f64]) -> Genome {
        self.space.genome_at(point, self.shape)
    }

    /// Makes the candidate at a point.
    pub fn candidate(&self, point: Vec<f64>, parents: Parents) -> Candidate {
        let genome = self.genome(&point);
        Candidate::at(point, genome, parents)
    }

    /// Makes candidates at points that `draw` draws from a distribution, given the random stream of each individual.
    pub fn sampled(
        &self,
        draw: impl FnOnce(&dyn Fn(u32) -> ChaCha8Rng) -> Vec<Vec<f64>>,
    ) -> Vec<Candidate> {
        let points = draw(&|index| self.stream(index as usize, Purpose::Sample));
        let candidate = |point| self.candidate(point, Parents::Distribution);
        points.into_iter().map(candidate).collect()
    }

    /// Draws the random genome of an individual.
    pub fn random_genome(&self, individual: usize) -> Genome {
        self.space.random_genome(self.shape, &mut self.stream(individual, Purpose::Birth))
    }

    /// Returns the point of the random genome of an individual.
    pub fn random_genome_point(&self, individual: usize) -> Vec<f64> {
        self.space.point_of(&self.random_genome(individual))
    }

    /// Checks a genome from a file. A body that cannot be built is reported before genes that do not fit the run.
    pub fn check_genome(&self, genome: &Genome, plan: &RunPlan) -> Result<(), Invalid> {
        plan.settings.trial.check_genome(genome)?;
        self.space.check_genome(genome, self.shape)
    }

    /// Checks a point from a file.
    pub fn check(&self, point: &[f64]) -> Result<(), Invalid> {
        check_point(point, self.dimension())
    }
}

/// Checks a point of the given dimension from a file.
pub fn check_point(point: &[f64], dimension: usize) -> Result<(), Invalid> {
    within("coordinates", point.len(), dimension..=dimension)?;
    // Reflections and turns map any point into the unit cube, but lose precision far outside.
    point.iter().try_for_each(|&x| within("coordinate", x, -1.0e6..=1.0e6))
}
