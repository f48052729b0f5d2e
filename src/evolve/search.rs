//! What all strategies share that search among points of the unit cube.

use std::sync::Arc;

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::{Founder, RunPlan};
use crate::check::{Invalid, within};
use crate::genome::{Descent, Genome, GenomeSpace};
use crate::rng::{Purpose, stream};

/// A search among points: what a point means, and where random numbers come from.
#[derive(Debug, Clone)]
pub struct Search {
    space: GenomeSpace,
    descent: Descent,
    seed: u64,
    /// The generation that is asked for; the first is 1.
    pub generation: u32,
    /// Individuals per generation.
    pub population: usize,
    /// Coordinates of a point.
    pub dimension: usize,
    /// From whom the first generation descends, and its point.
    founder: Option<(Arc<Founder>, Vec<f64>)>,
}

impl Search {
    /// The search of a run after its first `finished` generations.
    pub fn new(plan: &RunPlan, finished: u32) -> Self {
        let space = plan.settings.genome.clone();
        let descent = plan.settings.trial.descent();
        let founder = plan.founder.as_ref().filter(|_| finished == 0);
        let with_point =
            |founder: &Arc<Founder>| (Arc::clone(founder), space.exact_point_of(founder.genome()));
        Self {
            founder: founder.map(with_point),
            dimension: space.dimension(descent),
            space,
            descent,
            seed: plan.seed,
            generation: finished + 1,
            population: plan.settings.evolution.population as usize,
        }
    }

    /// The founder's point, while the generation is asked for that descends from it.
    pub fn founder(&self) -> Option<&[f64]> {
        self.founder.as_ref().filter(|_| self.generation == 1).map(|(_, point)| point.as_slice())
    }

    /// Whether an individual of the first generation is a mutant of the founder: the first individual is the founder
    /// itself, then every other one is a mutant, and the rest are newborns.
    pub fn is_founders_mutant(individual: usize) -> bool {
        individual.is_multiple_of(2)
    }

    /// The point of an individual of a generation that has no parents: of the founder, of a mutant of it by normally
    /// distributed steps, or drawn from nothing.
    pub fn first_point(&self, individual: usize, step: f64) -> Vec<f64> {
        match self.founder() {
            Some(founder) if individual == 0 => founder.to_vec(),
            Some(founder) if Self::is_founders_mutant(individual) => {
                let mut rng = self.stream(individual, Purpose::Mutation);
                founder.iter().map(|x| x + step * normal(&mut rng)).collect()
            }
            _ => self.newborn_point(individual),
        }
    }

    /// The genomes of a generation that begins with the founder: rounding would make it another.
    pub fn beginning_with_founder(&self, mut genomes: Vec<Genome>) -> Vec<Genome> {
        if let Some((founder, _)) = self.founder.as_ref().filter(|_| self.generation == 1)
            && let Some(first) = genomes.first_mut()
        {
            first.clone_from(founder.genome());
        }
        genomes
    }

    /// Takes the size of generations from a plan in which it was changed.
    pub fn amend(&mut self, plan: &RunPlan) {
        self.population = plan.settings.evolution.population as usize;
    }

    /// The random stream of an individual of the current generation.
    pub fn stream(&self, individual: usize, purpose: Purpose) -> ChaCha8Rng {
        stream(self.seed, self.generation, individual as u32, purpose)
    }

    /// The genome at a point.
    pub fn genome(&self, point: &[f64]) -> Genome {
        self.space.genome_at(point, self.descent)
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

    /// The point of the unit cube that means the same as a point beyond it.
    pub fn folded(&self, point: &[f64]) -> Vec<f64> {
        self.space.folded(point, self.descent)
    }

    /// An individual drawn from nothing.
    pub fn newborn(&self, individual: usize) -> Genome {
        self.space.birth(self.descent, &mut self.stream(individual, Purpose::Birth))
    }

    /// The point of an individual drawn from nothing.
    pub fn newborn_point(&self, individual: usize) -> Vec<f64> {
        self.space.point_of(&self.newborn(individual))
    }

    /// Checks a point from a file.
    pub fn check(&self, point: &[f64]) -> Result<(), Invalid> {
        within("coordinates", point.len(), self.dimension..=self.dimension)?;
        // Reflections and turns bring any point back, but not any number of times.
        point.iter().try_for_each(|&x| within("coordinate", x, -1.0e6..=1.0e6))
    }
}

/// A number from 0 to less than 1, each as likely.
pub fn uniform(rng: &mut ChaCha8Rng) -> f64 {
    rng.random_range(0.0..1.0)
}

/// A normally distributed number of mean 0 and variance 1, by the method of Box and Muller (1958).
pub fn normal(rng: &mut ChaCha8Rng) -> f64 {
    // From (0, 1], where the logarithm is finite.
    let first = 1.0 - uniform(rng);
    let second = uniform(rng);
    (-2.0 * libm::log(first)).sqrt() * libm::cos(std::f64::consts::TAU * second)
}
