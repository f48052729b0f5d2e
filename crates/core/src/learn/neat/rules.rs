//! The settings of NEAT.

use serde::{Deserialize, Serialize};

use super::genome::{MOST_HIDDEN, MOST_LINKS};
use crate::check::{Invalid, within};

/// The settings of NEAT. The defaults are those of Stanley & Miikkulainen 2002 for a population of 150; the comment of
/// a field says so where the paper leaves the number open.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NeatRules {
    /// c₁: the weight of excess links in the distance between two genomes.
    pub excess_coefficient: f64,
    /// c₂: the weight of disjoint links in the distance.
    pub disjoint_coefficient: f64,
    /// c₃: the weight of the mean difference of the weights of matching links in the distance.
    pub weight_coefficient: f64,
    /// Two genomes with fewer links than this are compared by numbers of links, larger ones by shares.
    pub small_genome: u32,
    /// A genome joins the first species whose representative is nearer than this.
    pub species_threshold: f64,
    /// The number of species for which the threshold is adjusted by [`Self::threshold_step`] each generation; 0 keeps
    /// it as it is, as in the paper. By a fixed threshold, genomes that are not small are often all of one species.
    pub species_goal: u32,
    /// The change of an adjusted threshold per generation; it never falls below this step.
    pub threshold_step: f64,
    /// The share of a species, best first, that may have offspring: rounded down, and one more. The paper only says
    /// that the lowest are removed.
    pub survival_share: f64,
    /// A species without a better best fitness for so many generations has no offspring, unless it has the best genome;
    /// the paper does not make this exception, without which the best networks would die out on a plateau.
    pub stagnation_generations: u32,
    /// If the whole population has had no better best fitness for so many generations, only the two best species have
    /// offspring.
    pub standstill_generations: u32,
    /// The best genome of a species with more members than this is kept as it is.
    pub champion_species_size: u32,
    /// The share of offspring with a single parent.
    pub unmated_share: f64,
    /// The share of matings with a parent of another species.
    pub interspecies_share: f64,
    /// The share of matings in which the weights of matching links are averaged instead of taken from either parent.
    /// The paper names both kinds, without the share.
    pub averaged_share: f64,
    /// The probability that a link which is off in a parent is off in the child.
    pub disabled_share: f64,
    /// The probability that a mutant has its weights mutated, if it has no new link or node.
    pub weight_mutation: f64,
    /// The share of the mutated weights that are shifted; the others are drawn anew.
    pub shifted_share: f64,
    /// The largest shift of a weight. Not given in the paper.
    pub weight_step: f32,
    /// The largest size of the weight of a new link, and of one that is drawn anew. Not given in the paper.
    pub new_weight: f32,
    /// The largest size of a weight of the first generation. Not given in the paper.
    pub first_weight: f32,
    /// The largest size of any weight: mutation stops there. Not given in the paper.
    pub weight_limit: f32,
    /// The largest shift of a parameter, whose range is 0 to 1. The paper's genomes have none.
    pub parameter_step: f32,
    /// The probability that a mutant has one link more.
    pub add_link: f64,
    /// The probability that a mutant has one node more.
    pub add_node: f64,
    /// Whether new links may close a cycle.
    pub recurrent: bool,
    /// The number of links from which a genome grows no more.
    pub most_links: u32,
    /// The number of hidden nodes from which a genome grows no more.
    pub most_hidden: u32,
}

impl Default for NeatRules {
    fn default() -> Self {
        Self {
            excess_coefficient: 1.0,
            disjoint_coefficient: 1.0,
            weight_coefficient: 0.4,
            small_genome: 20,
            species_threshold: 3.0,
            species_goal: 0,
            threshold_step: 0.3,
            survival_share: 0.2,
            stagnation_generations: 15,
            standstill_generations: 20,
            champion_species_size: 5,
            unmated_share: 0.25,
            interspecies_share: 0.001,
            averaged_share: 0.4,
            disabled_share: 0.75,
            weight_mutation: 0.8,
            shifted_share: 0.9,
            weight_step: 2.5,
            new_weight: 8.0,
            first_weight: 1.0,
            weight_limit: 8.0,
            parameter_step: 0.1,
            add_link: 0.05,
            add_node: 0.03,
            recurrent: true,
            most_links: 1000,
            most_hidden: 200,
        }
    }
}

impl NeatRules {
    /// Checks every setting.
    ///
    /// # Errors
    /// A setting is not a number or out of its range.
    pub fn check(&self) -> Result<(), Invalid> {
        for (field, share) in [
            ("survival_share", self.survival_share),
            ("unmated_share", self.unmated_share),
            ("interspecies_share", self.interspecies_share),
            ("averaged_share", self.averaged_share),
            ("disabled_share", self.disabled_share),
            ("weight_mutation", self.weight_mutation),
            ("shifted_share", self.shifted_share),
            ("add_link", self.add_link),
            ("add_node", self.add_node),
        ] {
            within(field, share, 0.0..=1.0)?;
        }
        for (field, coefficient) in [
            ("excess_coefficient", self.excess_coefficient),
            ("disjoint_coefficient", self.disjoint_coefficient),
            ("weight_coefficient", self.weight_coefficient),
        ] {
            within(field, coefficient, 0.0..=1000.0)?;
        }
        for (field, generations) in [
            ("stagnation_generations", self.stagnation_generations),
            ("standstill_generations", self.standstill_generations),
        ] {
            within(field, generations, 1..=1_000_000)?;
        }
        within("species_threshold", self.species_threshold, 0.0..=1000.0)?;
        within("threshold_step", self.threshold_step, 0.001..=10.0)?;
        within("small_genome", self.small_genome, 0..=1_000_000)?;
        within("species_goal", self.species_goal, 0..=1000)?;
        within("champion_species_size", self.champion_species_size, 0..=1_000_000)?;
        within("weight_limit", self.weight_limit, 0.001..=1000.0)?;
        within("weight_step", self.weight_step, 0.0..=self.weight_limit)?;
        within("new_weight", self.new_weight, 0.0..=self.weight_limit)?;
        within("first_weight", self.first_weight, 0.0..=self.weight_limit)?;
        within("parameter_step", self.parameter_step, 0.0..=1.0)?;
        within("most_links", self.most_links, 1..=MOST_LINKS)?;
        within("most_hidden", self.most_hidden, 0..=MOST_HIDDEN)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_defaults_are_allowed_and_nonsense_is_refused() {
        assert_eq!(NeatRules::default().check(), Ok(()));
        let refusal = |rules: NeatRules| rules.check().unwrap_err().to_string();
        let rules = NeatRules { add_node: f64::NAN, ..NeatRules::default() };
        assert_eq!(refusal(rules), "add_node is NaN; allowed: 0 to 1");
        let rules = NeatRules { weight_step: 9.0, ..NeatRules::default() };
        assert_eq!(refusal(rules), "weight_step is 9; allowed: 0 to 8");
        let rules = NeatRules { most_links: 1_000_000_000, ..NeatRules::default() };
        assert_eq!(refusal(rules), "most_links is 1000000000; allowed: 1 to 10000");
    }
}
