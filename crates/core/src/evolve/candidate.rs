//! A genome that a strategy proposes, and everything that the strategy says about it.

use std::sync::Arc;

use super::parents::Parents;
use crate::genome::Genome;
use crate::score::Trial;
use crate::world::Stairs;

/// A genome to be evaluated.
#[derive(Debug, Clone, PartialEq)]
pub struct Candidate {
    /// The genome.
    pub genome: Genome,
    /// Its parents.
    pub parents: Parents,
    /// The stairs on which it is evaluated; none for those of its run.
    pub stairs: Option<OwnStairs>,
    /// The number of its species; none if its strategy has no species. Numbers ascend in the order of appearance.
    pub species: Option<u32>,
    /// Whether it may become a champion.
    pub may_be_champion: bool,
    /// Properties that its strategy needs again when it learns the result.
    pub(super) heritage: Heritage,
}

/// Properties of a candidate that descendants take over, but that its genome does not tell. Each is 0 or empty for
/// strategies that do not use it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Heritage {
    /// Coordinates of the unit cube, or around it, from which the genome was made.
    pub point: Vec<f64>,
    /// Step of mutation, as a share of each gene's range.
    pub step: f64,
    /// Generations since the last change of the structure of its body.
    pub age: u32,
}

impl Candidate {
    /// A candidate that is evaluated in the trial of its run, without species.
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

    /// A candidate with this number of generations since the last change of the structure of its body.
    pub(super) fn aged(age: u32, genome: Genome, parents: Parents) -> Self {
        let heritage = Heritage { age, ..Heritage::default() };
        Self { heritage, ..Self::new(genome, parents) }
    }

    /// A candidate whose genome was made from a point.
    pub(super) fn at(point: Vec<f64>, genome: Genome, parents: Parents) -> Self {
        let heritage = Heritage { point, ..Heritage::default() };
        Self { heritage, ..Self::new(genome, parents) }
    }
}

/// The stairs on which a candidate is evaluated, if they are not those of its run.
#[derive(Debug, Clone, PartialEq)]
pub struct OwnStairs {
    /// The stairs.
    pub stairs: Arc<Stairs>,
    /// Number of perturbed trials beside those of the run.
    pub perturbed: u32,
}

impl OwnStairs {
    /// A trial on these stairs.
    pub fn on(&self, trial: &Trial) -> Trial {
        let mut trial = trial.on_stairs((*self.stairs).clone());
        trial.repeats.trials += self.perturbed;
        trial
    }
}
