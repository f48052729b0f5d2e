//! NEAT, the evolution of networks that grow: Stanley & Miikkulainen 2002, "Evolving Neural Networks through
//! Augmenting Topologies", Evolutionary Computation 10(2).
//!
//! Nothing depends on threads or on the order of evaluation. A generation is made from the last generation and its fitness alone. Every
//! child draws from a stream of its own. Innovation numbers are assigned after all children are made, in their order.

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

pub use genome::{LinkGene, NetworkGenome};
pub use play::NetworkPlay;
pub use population::{LARGEST_NEAT_POPULATION, NeatPopulation};
pub use rules::NeatRules;
pub use species::SpeciesSummary;

#[cfg(test)]
mod population_tests;
#[cfg(test)]
mod published_tests;
