//! The settings of NEAT.

use super::genome::{MOST_HIDDEN, MOST_LINKS};
use crate::learn::parameters::parameters;

parameters! {
    /// The settings of NEAT. The defaults are those of Stanley & Miikkulainen 2002 for a population of 150. If the paper does not give a
    /// number, the comment of the field says it.
    pub struct NeatRules {
        /// c₁: weight of excess links in the distance between two genomes.
        excess_coefficient: f64 = 1.0, 0.0..=1000.0;
        /// c₂: weight of disjoint links in the distance between two genomes.
        disjoint_coefficient: f64 = 1.0, 0.0..=1000.0;
        /// c₃: weight of the mean difference of the weights of matching links in the distance between two genomes.
        weight_coefficient: f64 = 0.4, 0.0..=1000.0;
        /// Number of links below which genomes are small. Two small genomes are compared by numbers of links, others by shares.
        small_genome: u32 = 20, 0..=1_000_000;
        /// Distance to the representative of a species within which a genome joins the species. It joins the first such species.
        species_threshold: f64 = 3.0, 0.0..=1000.0;
        /// Number of species for which the threshold is adjusted by [`Self::threshold_step`] each generation; 0 keeps the threshold as it
        /// is, as in the paper. With a fixed threshold, genomes that are not small often form a single species.
        species_goal: u32 = 0, 0..=1000;
        /// Change of an adjusted threshold per generation. The threshold never falls below this step.
        threshold_step: f64 = 0.3, 0.001..=10.0;
        /// Share of a species, best first, that may have offspring. The number is rounded down, and one is added. The paper only says that
        /// the lowest are removed.
        survival_share: f64 = 0.2, 0.0..=1.0;
        /// Number of generations without a better best fitness after which a species has no offspring, unless it has the best genome. The
        /// paper does not make this exception, without which the best networks would die out on a plateau.
        stagnation_generations: u32 = 15, 1..=1_000_000;
        /// Number of generations without a better best fitness of the whole population after which only the two best species have
        /// offspring.
        standstill_generations: u32 = 20, 1..=1_000_000;
        /// Number of members above which the best genome of a species is kept as it is.
        champion_species_size: u32 = 5, 0..=1_000_000;
        /// Share of offspring with a single parent.
        unmated_share: f64 = 0.25, 0.0..=1.0;
        /// Share of matings with a parent of another species.
        interspecies_share: f64 = 0.001, 0.0..=1.0;
        /// Share of matings in which the weights of matching links are averaged instead of taken from either parent. The paper names both
        /// kinds, but not the share.
        averaged_share: f64 = 0.4, 0.0..=1.0;
        /// Probability that a link that is off in a parent is off in the child.
        disabled_share: f64 = 0.75, 0.0..=1.0;
        /// Probability that a mutant without a new link or node has its weights mutated.
        weight_mutation: f64 = 0.8, 0.0..=1.0;
        /// Share of the mutated weights that are shifted. The others are drawn anew.
        shifted_share: f64 = 0.9, 0.0..=1.0;
        /// Largest shift of a weight. The paper does not give it.
        weight_step: f32 = 2.5, 0.0..=*weight_limit;
        /// Largest absolute value of the weight of a new link, and of a weight that is drawn anew. The paper does not give it.
        new_weight: f32 = 8.0, 0.0..=*weight_limit;
        /// Largest absolute value of a weight of the first generation. The paper does not give it.
        first_weight: f32 = 1.0, 0.0..=*weight_limit;
        /// Largest absolute value of any weight, to which mutation clamps it. The paper does not give it.
        weight_limit: f32 = 8.0, 0.001..=1000.0;
        /// Largest shift of a parameter, whose range is 0 to 1. The paper's genomes have no parameters.
        parameter_step: f32 = 0.1, 0.0..=1.0;
        /// Probability that a mutant has one more link.
        add_link: f64 = 0.05, 0.0..=1.0;
        /// Probability that a mutant has one more node.
        add_node: f64 = 0.03, 0.0..=1.0;
        /// Whether new links may close a cycle.
        recurrent: bool = true, false..=true;
        /// Number of links at which a genome stops growing.
        most_links: u32 = 1000, 1..=MOST_LINKS;
        /// Number of hidden nodes at which a genome stops growing.
        most_hidden: u32 = 200, 0..=MOST_HIDDEN;
    }
}
