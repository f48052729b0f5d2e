//! Candidates that are evaluated on stairs that evolve.

use std::sync::Arc;

use crate::evolve::candidate::{Candidate, OwnStairs};
use crate::evolve::parents::Parents;
use crate::genome::{Genome, StairsGenome};
use crate::world::Stairs;

/// A candidate on stairs, and its role, by which the strategy understands its result.
#[derive(Debug, Clone)]
pub struct Attempt<R> {
    /// The candidate, without its stairs.
    pub candidate: Candidate,
    /// The staircase on which it is evaluated.
    pub stairs: StairsGenome,
    /// Number of perturbed trials beside the nominal one.
    pub perturbed: u32,
    pub role: R,
}

impl<R> Attempt<R> {
    /// An attempt with a genome whose parents are not recorded, in the nominal trial alone.
    pub fn new(genome: &Genome, stairs: StairsGenome, role: R) -> Self {
        let candidate = Candidate::new(genome.clone(), Parents::Unknown);
        Self { candidate, stairs, perturbed: 0, role }
    }

    /// An attempt with a candidate that a search within the strategy has drawn.
    pub fn sampled(candidate: Candidate, stairs: StairsGenome, role: R) -> Self {
        let candidate = Candidate { parents: Parents::Distribution, ..candidate };
        Self { candidate, stairs, perturbed: 0, role }
    }

    /// The candidates of a batch, with their stairs. Equal staircases are built once.
    pub fn candidates(batch: &[Self]) -> Vec<Candidate> {
        let mut built: Vec<(StairsGenome, Arc<Stairs>)> = Vec::new();
        let candidate = |attempt: &Self| {
            // Attempts on equal staircases mostly follow one another.
            let known = built.iter().rev().find(|(of, _)| *of == attempt.stairs);
            let stairs = known.map(|(_, stairs)| Arc::clone(stairs)).unwrap_or_else(|| {
                let stairs = Arc::new(attempt.stairs.stairs());
                built.push((attempt.stairs, Arc::clone(&stairs)));
                stairs
            });
            let own = OwnStairs { stairs, perturbed: attempt.perturbed };
            Candidate { stairs: Some(own), ..attempt.candidate.clone() }
        };
        batch.iter().map(candidate).collect()
    }
}
