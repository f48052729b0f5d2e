//! Candidates: genomes that a strategy proposes, with what the strategy states about each.

use std::sync::Arc;

use super::parents::Parents;
use crate::genome::Genome;
use crate::score::Trial;
use crate::world::Stairs;

/// A genome that a strategy proposes for evaluation.
#[derive(Debug, Clone, PartialEq)]
pub struct Candidate {
    /// Genome to be evaluated.
    pub genome: Genome,
    /// Parents of the genome.
    pub parents: Parents,
    /// Stairs on which the genome is evaluated. None: the stairs of the run.
    pub stairs: Option<OwnStairs>,
    /// Number of the candidate's species, ascending in the order of appearance. None if the strategy has no species.
    pub species: Option<u32>,
    /// Whether the candidate may become a champion.
    pub may_be_champion: bool,
    /// Properties that the strategy needs again when it learns the evaluation.
    pub(super) heritage: Heritage,
}

/// Properties of a candidate that its descendants inherit, but that do not follow from its genome. Each is 0 or empty for strategies that
/// do not use it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Heritage {
    /// Coordinates, in or around the unit cube, from which the genome was made.
    pub point: Vec<f64>,
    /// Size of a mutation step, as a share of each gene's range.
    pub step: f64,
    /// Generations since the structure of the candidate's body last changed.
    pub age: u32,
}

impl Candidate {
    /// Makes a candidate without species that is evaluated in the trial of the run.
    pub fn new(genome: Genome, parents: Parents) -> Self {
        Self {
            genome,
            parents,
            stairs: None,
            species: None,
            may_be_champion: true,
            heritage: Heritage::default(),
        }
    }

    /// Makes a candidate whose body last changed its structure `age` generations ago.
    pub(super) fn aged(age: u32, genome: Genome, parents: Parents) -> Self {
        let heritage = Heritage { age, ..Heritage::default() };
        Self { heritage, ..Self::new(genome, parents) }
    }

    /// Makes a candidate whose genome was made from `point`.
    pub(super) fn at(point: Vec<f64>, genome: Genome, parents: Parents) -> Self {
        let heritage = Heritage { point, ..Heritage::default() };
        Self { heritage, ..Self::new(genome, parents) }
    }
}

/// Stairs on which a candidate is evaluated instead of the stairs of the run.
#[derive(Debug, Clone, PartialEq)]
pub struct OwnStairs {
    /// Shape of the stairs.
    pub stairs: Arc<Stairs>,
    /// Number of perturbed trials in addition to those of the run.
    pub perturbed: u32,
}

impl OwnStairs {
    /// Returns `trial` on these stairs, with their additional perturbed trials.
    pub fn on(&self, trial: &Trial) -> Trial {
        let mut trial = trial.on_stairs((*self.stairs).clone());
        trial.repeats.trials += self.perturbed;
        trial
    }
}
