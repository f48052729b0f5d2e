//! The settings of NEAT.

use super::genome::{MOST_HIDDEN, MOST_LINKS};
use crate::learn::parameters::parameters;

parameters! {
    /// The settings of NEAT. The defaults are those of Stanley & Miikkulainen 2002 for a population of 150; the comment of
    /// a field says so where the paper leaves the number open.
    pub struct NeatRules {
        /// c₁: the weight of excess links in the distance between two genomes.
        excess_coefficient: f64 = 1.0, 0.0..=1000.0;
        /// c₂: the weight of disjoint links in the distance.
        disjoint_coefficient: f64 = 1.0, 0.0..=1000.0;
        /// c₃: the weight of the mean difference of the weights of matching links in the distance.
        weight_coefficient: f64 = 0.4, 0.0..=1000.0;
        /// Two genomes with fewer links than this are compared by numbers of links, larger ones by shares.
        small_genome: u32 = 20, 0..=1_000_000;
        /// A genome joins the first species whose representative is nearer than this.
        species_threshold: f64 = 3.0, 0.0..=1000.0;
        /// The number of species for which the threshold is adjusted by [`Self::threshold_step`] each generation; 0 keeps
        /// it as it is, as in the paper. By a fixed threshold, genomes that are not small are often all of one species.
        species_goal: u32 = 0, 0..=1000;
        /// The change of an adjusted threshold per generation; it never falls below this step.
        threshold_step: f64 = 0.3, 0.001..=10.0;
        /// The share of a species, best first, that may have offspring: rounded down, and one more. The paper only says
        /// that the lowest are removed.
        survival_share: f64 = 0.2, 0.0..=1.0;
        /// A species without a better best fitness for so many generations has no offspring, unless it has the best genome;
        /// the paper does not make this exception, without which the best networks would die out on a plateau.
        stagnation_generations: u32 = 15, 1..=1_000_000;
        /// If the whole population has had no better best fitness for so many generations, only the two best species have
        /// offspring.
        standstill_generations: u32 = 20, 1..=1_000_000;
        /// The best genome of a species with more members than this is kept as it is.
        champion_species_size: u32 = 5, 0..=1_000_000;
        /// The share of offspring with a single parent.
        unmated_share: f64 = 0.25, 0.0..=1.0;
        /// The share of matings with a parent of another species.
        interspecies_share: f64 = 0.001, 0.0..=1.0;
        /// The share of matings in which the weights of matching links are averaged instead of taken from either parent.
        /// The paper names both kinds, without the share.
        averaged_share: f64 = 0.4, 0.0..=1.0;
        /// The probability that a link which is off in a parent is off in the child.
        disabled_share: f64 = 0.75, 0.0..=1.0;
        /// The probability that a mutant has its weights mutated, if it has no new link or node.
        weight_mutation: f64 = 0.8, 0.0..=1.0;
        /// The share of the mutated weights that are shifted; the others are drawn anew.
        shifted_share: f64 = 0.9, 0.0..=1.0;
        /// The largest shift of a weight. Not given in the paper.
        weight_step: f32 = 2.5, 0.0..=*weight_limit;
        /// The largest size of the weight of a new link, and of one that is drawn anew. Not given in the paper.
        new_weight: f32 = 8.0, 0.0..=*weight_limit;
        /// The largest size of a weight of the first generation. Not given in the paper.
        first_weight: f32 = 1.0, 0.0..=*weight_limit;
        /// The largest size of any weight: mutation stops there. Not given in the paper.
        weight_limit: f32 = 8.0, 0.001..=1000.0;
        /// The largest shift of a parameter, whose range is 0 to 1. The paper's genomes have none.
        parameter_step: f32 = 0.1, 0.0..=1.0;
        /// The probability that a mutant has one link more.
        add_link: f64 = 0.05, 0.0..=1.0;
        /// The probability that a mutant has one node more.
        add_node: f64 = 0.03, 0.0..=1.0;
        /// Whether new links may close a cycle.
        recurrent: bool = true, false..=true;
        /// The number of links from which a genome grows no more.
        most_links: u32 = 1000, 1..=MOST_LINKS;
        /// The number of hidden nodes from which a genome grows no more.
        most_hidden: u32 = 200, 0..=MOST_HIDDEN;
    }
}
