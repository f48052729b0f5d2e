//! Genetic algorithms that leave it to novelty search which individuals are the best.

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

/// A behaviour: the final position of the agent and its two descriptors, each from 0 to 1.
pub type BehaviourPoint = [f64; 3];

/// A genetic algorithm to which novelty search tells which individuals are the best.
pub trait Breeder: Strategy + Sized {
    /// An individual of the last generation.
    type Member: Clone + Serialize + DeserializeOwned;
    /// An individual as a point, whose distance to the others is its novelty. Each coordinate is from 0 to 1.
    type Point: Copy + Debug + AsRef<[f64]> + Send + Serialize + DeserializeOwned;

    /// The algorithm after the first `finished` generations of a run, of which the last is known.
    ///
    /// # Errors
    /// It is larger than a generation, or an individual in it is not one of this plan.
    fn resume_with(
        plan: &RunPlan,
        finished: u32,
        members: Vec<Self::Member>,
    ) -> Result<Self, Invalid>;
    /// The last generation, best first.
    fn members(&self) -> &[Self::Member];
    /// Ends a generation: `ranking` lists the indices of its candidates, best first.
    fn select(&mut self, candidates: &[Candidate], ranking: &[usize]);
    /// The random numbers of the present generation for a purpose.
    fn stream(&self, purpose: Purpose) -> ChaCha8Rng;
    /// The point of an individual.
    fn point(behaviour: BehaviourPoint, genome: &Genome, bodies: &BodySpace) -> Self::Point;
}
