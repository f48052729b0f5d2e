//! Genetic algorithms whose individuals are ranked from outside, by novelty search.

use std::fmt::Debug;

use rand_chacha::ChaCha8Rng;
use serde::Serialize;
use serde::de::DeserializeOwned;

use crate::check::Invalid;
use crate::evolve::candidate::Candidate;
use crate::evolve::plan::RunPlan;
use crate::evolve::strategy::Strategy;
use crate::genome::{BodySpace, Genome};
use crate::rng::Purpose;

/// A behaviour: the final position of the agent and its two descriptors, each scaled to 0 to 1.
pub type BehaviourPoint = [f64; 3];

/// A genetic algorithm whose individuals novelty search can rank.
pub trait Breeder: Strategy + Sized {
    /// An individual of the last generation, with its genes.
    type Member: Clone + Serialize + DeserializeOwned;
    /// Point that represents an individual. Its distance to other points is the individual's novelty. Each coordinate is from 0 to 1.
    type Point: Copy + Debug + AsRef<[f64]> + Send + Serialize + DeserializeOwned;

    /// Restores the algorithm after the first `finished` generations of a run, from the members of the last generation.
    ///
    /// # Errors
    /// Fails if there are more members than individuals in a generation, or if a member does not fit the plan.
    fn resume_with(
        plan: &RunPlan,
        finished: u32,
        members: Vec<Self::Member>,
    ) -> Result<Self, Invalid>;
    /// Returns the members of the last generation, best first.
    fn members(&self) -> &[Self::Member];
    /// Ends a generation. `ranking` lists the indices of its candidates, best first.
    fn select(&mut self, candidates: &[Candidate], ranking: &[usize]);
    /// Returns the random stream of the present generation for a purpose.
    fn stream(&self, purpose: Purpose) -> ChaCha8Rng;
    /// Returns the point of an individual.
    fn point(behaviour: BehaviourPoint, genome: &Genome, bodies: &BodySpace) -> Self::Point;
}
