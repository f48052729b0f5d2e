//! Genomes with bodies of their own: those without parents, and children of others.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::search::Search;
use crate::evolve::candidate::Candidate;
use crate::evolve::parents::Parents;
use crate::genome::{BodyChange, Genome};
use crate::rng::Purpose;

/// Attempts to change a body within its limits, before its genes change instead.
const ATTEMPTS: usize = 20;

/// A genome that was made.
#[derive(Debug, Clone, PartialEq)]
pub struct BodyChild {
    /// Its genes.
    pub genome: Genome,
    /// Whether the structure of its body differs from its parent's.
    pub is_restructured: bool,
}

impl Search {
    /// An individual of the first generation: the founder, if there is one, every second one a child of it, the others drawn
    /// at random.
    pub fn first_genome(
        &self,
        individual: usize,
        child: impl FnOnce(&Genome, &mut ChaCha8Rng) -> Genome,
    ) -> Genome {
        match self.founder_of(individual) {
            Some(founder) if individual == 0 => founder.clone(),
            Some(founder) => child(founder, &mut self.stream(individual, Purpose::Mutation)),
            None => self.random_genome(individual),
        }
    }

    /// An individual of the first generation, whose children differ from the founder by this step.
    pub fn founding(&self, individual: usize, step: f64) -> Candidate {
        let child = |founder: &Genome, rng: &mut ChaCha8Rng| self.varied(founder, step, rng).genome;
        Candidate::new(self.first_genome(individual, child), Parents::None)
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
}

/// Whether a child has two parents, for the share of those that have.
pub fn is_crossed(two_parents: f32, rng: &mut ChaCha8Rng) -> bool {
    rng.random_range(0.0..1.0) < f64::from(two_parents)
}
