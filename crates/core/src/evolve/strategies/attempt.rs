//! Evaluations of candidates on stairs that evolve.

use std::sync::Arc;

use crate::evolve::candidate::{Candidate, OwnStairs};
use crate::evolve::parents::Parents;
use crate::genome::{Genome, StairsGenome};
use crate::world::Stairs;

/// A candidate on a staircase, with its role `R`, by which the strategy interprets the evaluation.
#[derive(Debug, Clone)]
pub struct Attempt<R> {
    /// Candidate to be evaluated; its stairs are set by `Attempt::candidates`.
    pub candidate: Candidate,
    /// Staircase on which the candidate is evaluated.
    pub stairs: StairsGenome,
    /// Number of perturbed trials in addition to the nominal trial.
    pub perturbed: u32,
    pub role: R,
}

impl<R> Attempt<R> {
    /// Makes an attempt in the nominal trial only, with a genome whose parents are not recorded.
    pub fn new(genome: &Genome, stairs: StairsGenome, role: R) -> Self {
        let candidate = Candidate::new(genome.clone(), Parents::Unknown);
        Self { candidate, stairs, perturbed: 0, role }
    }

    /// Makes an attempt in the nominal trial only, with a candidate that a search within the strategy has drawn.
    pub fn sampled(candidate: Candidate, stairs: StairsGenome, role: R) -> Self {
        let candidate = Candidate { parents: Parents::Distribution, ..candidate };
        Self { candidate, stairs, perturbed: 0, role }
    }

    /// Returns the candidates of a batch, with their stairs. Attempts on equal staircases share one object.
    pub fn candidates(batch: &[Self]) -> Vec<Candidate> {
        let mut built: Vec<(StairsGenome, Arc<Stairs>)> = Vec::new();
        let candidate = |attempt: &Self| {
            // The list is searched from its end, because attempts on equal staircases mostly follow one another.
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
