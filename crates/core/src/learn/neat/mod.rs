//! NEAT, the evolution of networks that grow: Stanley & Miikkulainen 2002, "Evolving Neural Networks through
//! Augmenting Topologies", Evolutionary Computation 10(2).
//!
//! Nothing here depends on threads or on the order of evaluation. A generation is made from the last one and its
//! fitness alone, every child draws from a stream of its own, and innovation numbers are handed out after all children
//! are made, in their order.

mod distance;
mod genome;
mod innovation;
mod mating;
mod mutation;
mod offspring;
mod play;
mod population;
mod population_check;
mod reproduction;
mod rules;
mod species;

pub use distance::distance;
pub use genome::{LinkGene, MOST_ENDS, MOST_HIDDEN, MOST_LINKS, NetworkGenome};
pub use innovation::{Innovations, Newborn, StructuralNovelty};
pub use mating::mated;
pub use mutation::mutated;
pub use offspring::offspring_numbers;
pub use play::{NetworkPlay, STEEPNESS};
pub use population::{LARGEST_NEAT_POPULATION, NeatPopulation};
pub use rules::NeatRules;
pub use species::SpeciesSummary;

#[cfg(test)]
mod population_tests;
#[cfg(test)]
mod published_tests;
