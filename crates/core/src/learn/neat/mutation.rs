//! Mutation of a genome: a new node, a new link, or other weights.

use std::collections::BTreeSet;

use rand::{Rng, RngExt};

use super::genome::NetworkGenome;
use super::innovation::{Newborn, StructuralNovelty};
use super::mating::drawn;
use super::rules::NeatRules;

/// Number of attempts to draw a pair of nodes that may be linked.
const TRIES_FOR_A_LINK: u32 = 20;

/// Returns a mutant of a genome. A mutant with a new structure keeps its weights, so that selection tests the structure alone.
pub fn mutated(mut genome: NetworkGenome, rules: &NeatRules, rng: &mut impl Rng) -> Newborn {
    let novelty = if chance(rng, rules.add_node) {
        new_node(&genome, rules, rng)
    } else if chance(rng, rules.add_link) {
        new_link(&genome, rules, rng)
    } else {
        None
    };
    if novelty.is_none() && chance(rng, rules.weight_mutation) {
        change_numbers(&mut genome, rules, rng);
    }
    Newborn { genome, novelty }
}

/// Returns true with this probability. It always draws one number.
pub fn chance(rng: &mut impl Rng, probability: f64) -> bool {
    rng.random_range(0.0..1.0) < probability
}

/// Draws a number uniformly from -`size` to `size`.
pub fn symmetric(rng: &mut impl Rng, size: f32) -> f32 {
    rng.random_range(-1.0..=1.0_f32) * size
}

/// Shifts most weights and parameters, and draws the others anew.
fn change_numbers(genome: &mut NetworkGenome, rules: &NeatRules, rng: &mut impl Rng) {
    for link in &mut genome.links {
        let weight = if chance(rng, rules.shifted_share) {
            link.weight + symmetric(rng, rules.weight_step)
        } else {
            symmetric(rng, rules.new_weight)
        };
        link.weight = weight.clamp(-rules.weight_limit, rules.weight_limit);
    }
    for parameter in &mut genome.parameters {
        let is_shifted = chance(rng, rules.shifted_share);
        *parameter = if is_shifted {
            (*parameter + symmetric(rng, rules.parameter_step)).clamp(0.0, 1.0)
        } else {
            rng.random_range(0.0..=1.0)
        };
    }
}

/// Chooses a random enabled link to split by a new node; `None` if there is no such link or the genome is full.
fn new_node(
    genome: &NetworkGenome,
    rules: &NeatRules,
    rng: &mut impl Rng,
) -> Option<StructuralNovelty> {
    let has_room = genome.links.len() + 2 <= rules.most_links as usize
        && genome.hidden().len() < rules.most_hidden as usize;
    let enabled: Vec<_> = genome.links.iter().filter(|link| link.enabled).collect();
    let split = drawn(&enabled, rng).filter(|_| has_room)?;
    Some(StructuralNovelty::Split { innovation: split.innovation })
}

/// Draws a link between two random nodes that are not linked yet; `None` if no pair is found or the genome is full.
fn new_link(
    genome: &NetworkGenome,
    rules: &NeatRules,
    rng: &mut impl Rng,
) -> Option<StructuralNovelty> {
    if genome.links.len() >= rules.most_links as usize {
        return None;
    }
    let mut nodes: Vec<u32> = (0..genome.first_hidden()).collect();
    nodes.extend(genome.hidden());
    let targets = nodes.get(usize::from(genome.inputs)..)?;
    for _ in 0..TRIES_FOR_A_LINK {
        let (&from, &to) = (drawn(&nodes, rng)?, drawn(targets, rng)?);
        let is_allowed = rules.recurrent || !is_reached(genome, to, from);
        if is_allowed && !genome.joins(from, to) {
            let weight = symmetric(rng, rules.new_weight);
            return Some(StructuralNovelty::Link { from, to, weight });
        }
    }
    None
}

/// Returns whether links, enabled or not, lead from one node to the other, or both nodes are the same.
fn is_reached(genome: &NetworkGenome, from: u32, to: u32) -> bool {
    let mut reached = BTreeSet::from([from]);
    loop {
        let before = reached.len();
        for link in &genome.links {
            if reached.contains(&link.from) {
                reached.insert(link.to);
            }
        }
        if reached.contains(&to) || reached.len() == before {
            return reached.contains(&to);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::genome::{LinkGene, link};
    use super::super::innovation::Innovations;
    use super::*;
    use crate::rng::{Purpose, stream};

    fn genome() -> NetworkGenome {
        let links = vec![link(0, 2, 0.5, 0), link(1, 2, -0.5, 1)];
        NetworkGenome { inputs: 2, outputs: 1, parameters: vec![0.5, 0.01], links }
    }

    fn only(add_node: f64, add_link: f64, weight_mutation: f64) -> NeatRules {
        NeatRules { add_node, add_link, weight_mutation, ..NeatRules::default() }
    }

    #[test]
    fn mutation_does_what_the_probabilities_say() {
        let rng = &mut stream(1, 0, 0, Purpose::Mutation);
        assert_eq!(mutated(genome(), &only(0.0, 0.0, 0.0), rng).genome, genome());
        let child = mutated(genome(), &only(1.0, 1.0, 1.0), rng);
        assert_eq!(child.genome, genome());
        assert!(matches!(child.novelty, Some(StructuralNovelty::Split { .. })));
        let child = mutated(genome(), &only(0.0, 1.0, 1.0), rng);
        // The only pair without a link is that of the output with itself.
        assert!(matches!(child.novelty, Some(StructuralNovelty::Link { from: 2, to: 2, .. })));
        let child = mutated(genome(), &only(0.0, 0.0, 1.0), rng);
        assert_eq!(child.novelty, None);
        assert!(child.genome.links.iter().zip(genome().links).all(|(a, b)| a.weight != b.weight));
        assert!(child.genome.parameters != genome().parameters);
    }

    #[test]
    fn mutants_of_mutants_stay_within_the_limits() {
        let limits = NeatRules { most_links: 9, most_hidden: 2, ..only(0.3, 0.3, 1.0) };
        for (i, recurrent) in [(0, true), (1, false)] {
            let rules = NeatRules { recurrent, ..limits.clone() };
            let rng = &mut stream(2, 0, i, Purpose::Mutation);
            let mut innovations = Innovations::first(2, 1);
            let mut child = [Newborn { genome: genome(), novelty: None }];
            for _ in 0..300 {
                child = [mutated(child[0].genome.clone(), &rules, rng)];
                innovations.settle(&mut child);
                assert_eq!(child[0].genome.check(&rules), Ok(()));
                let is_loop = |link: &LinkGene| is_reached(&child[0].genome, link.to, link.from);
                assert!(recurrent || !child[0].genome.links.iter().any(is_loop));
            }
            assert_eq!(child[0].genome.hidden().len(), 2);
            assert!(child[0].genome.links.len() >= 8);
        }
    }

    #[test]
    fn a_genome_with_nothing_to_change_is_left_alone() {
        let bare = NetworkGenome { parameters: vec![], links: vec![], ..genome() };
        let rng = &mut stream(3, 0, 0, Purpose::Mutation);
        let child = mutated(bare.clone(), &only(1.0, 0.0, 1.0), rng);
        assert_eq!(child, Newborn { genome: bare, novelty: None });
    }
}
