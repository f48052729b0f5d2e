//! Creation of genomes whose bodies evolve: first genomes and children.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::search::Search;
use crate::evolve::candidate::Candidate;
use crate::evolve::parents::Parents;
use crate::genome::{BodyChange, Genome};
use crate::rng::Purpose;

/// Number of attempts to change a body within its limits, after which its genes change instead.
const ATTEMPTS: usize = 20;

/// A child genome.
#[derive(Debug, Clone, PartialEq)]
pub struct BodyChild {
    /// Genome of the child.
    pub genome: Genome,
    /// Whether the structure of the child's body differs from its parent's.
    pub is_restructured: bool,
}

impl Search {
    /// Makes a genome of the first generation. With a founder, the first individual is the founder and every second one after it is a child
    /// of the founder. All others are drawn at random.
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

    /// Makes a candidate of the first generation. Children of the founder mutate by `step`, as a share of each gene's range.
    pub fn founding(&self, individual: usize, step: f64) -> Candidate {
        let child = |founder: &Genome, rng: &mut ChaCha8Rng| self.varied(founder, step, rng).genome;
        Candidate::new(self.first_genome(individual, child), Parents::None)
    }

    /// Makes a child of a genome: with a change of the body's structure, or with small changes of the genes by `step`, as a share of their
    /// ranges.
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

/// Draws whether a child has two parents, with the probability `two_parents`.
pub fn is_crossed(two_parents: f32, rng: &mut ChaCha8Rng) -> bool {
    rng.random_range(0.0..1.0) < f64::from(two_parents)
}
