//! Genomes with bodies of their own: those without parents, and children of others.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use std::sync::Arc;

use crate::evolve::plan::{Founder, RunPlan};
use crate::genome::{BodyChange, Genome, GenomeShape, GenomeSpace};
use crate::rng::{Purpose, stream};

/// Attempts to change a body within its limits, before its genes change instead.
const ATTEMPTS: usize = 20;

/// Makes the genomes of a strategy that varies bodies.
#[derive(Debug, Clone)]
pub struct BodyChildren {
    /// The genomes that may be made.
    pub space: GenomeSpace,
    /// The shape of their controllers.
    pub shape: GenomeShape,
    seed: u64,
    /// The next generation; the first is 1.
    pub generation: u32,
    /// The founder that the first generation descends from.
    founder: Option<Arc<Founder>>,
}

/// A genome that was made.
#[derive(Debug, Clone, PartialEq)]
pub struct BodyChild {
    /// Its genes.
    pub genome: Genome,
    /// Whether the structure of its body differs from its parent's.
    pub is_restructured: bool,
}

impl BodyChildren {
    /// The maker of the genomes after the first `finished` generations of a run.
    pub fn new(plan: &RunPlan, finished: u32) -> Self {
        Self {
            space: plan.settings.genome.clone(),
            shape: plan.settings.trial.genome_shape(),
            seed: plan.seed,
            generation: finished + 1,
            founder: plan.founder.clone().filter(|_| finished == 0),
        }
    }

    /// The random numbers of an individual.
    pub fn stream(&self, individual: usize, purpose: Purpose) -> ChaCha8Rng {
        stream(self.seed, self.generation, individual as u32, purpose)
    }

    /// An individual of the first generation: the founder, if there is one, every second one a child of it, the others drawn
    /// at random.
    pub fn first(
        &self,
        individual: usize,
        child: impl FnOnce(&Genome, &mut ChaCha8Rng) -> Genome,
    ) -> Genome {
        match &self.founder {
            Some(founder) if individual == 0 => founder.genome().clone(),
            Some(founder) if individual.is_multiple_of(2) => {
                let mut rng = self.stream(individual, Purpose::Mutation);
                child(founder.genome(), &mut rng)
            }
            _ => {
                let mut rng = self.stream(individual, Purpose::Birth);
                self.space.random_genome(self.shape, &mut rng)
            }
        }
    }

    /// A child of a genome: with a change of its structure, or with small changes of its genes by this step, as a share of
    /// their ranges.
    pub fn varied(&self, parent: &Genome, step: f64, rng: &mut ChaCha8Rng) -> BodyChild {
        if let Some(change) = BodyChange::draw(rng) {
            let changed =
                (0..ATTEMPTS).find_map(|_| self.space.with_body_change(parent, change, rng));
            if let Some(genome) = changed {
                return BodyChild { genome, is_restructured: true };
            }
        }
        let genome = self.space.with_small_changes(parent, step, rng);
        BodyChild { genome, is_restructured: false }
    }

    /// Whether a child has two parents, for the share of those that have.
    pub fn is_crossed(two_parents: f32, rng: &mut ChaCha8Rng) -> bool {
        rng.random_range(0.0..1.0) < f64::from(two_parents)
    }
}
