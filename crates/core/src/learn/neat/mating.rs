//! Mating: one genome from two, gene by gene.

use rand::{Rng, RngExt};

use super::distance::Aligned;
use super::genome::{LinkGene, NetworkGenome};
use super::mutation::chance;
use super::rules::NeatRules;

/// Returns the child of two genomes of the same shape. Matching links have the weight of a random parent, or the mean of both. All other
/// links are those of the fitter parent, whose structure the child inherits. Parameters are inherited like weights.
///
/// If both parents are equally fit, the one with fewer links should be passed as the fitter, to keep networks small.
pub fn mated(
    fitter: &NetworkGenome,
    other: &NetworkGenome,
    rules: &NeatRules,
    rng: &mut impl Rng,
) -> NetworkGenome {
    let is_averaged = chance(rng, rules.averaged_share);
    let mut inherited = |mine: f32, theirs: f32| match (is_averaged, chance(rng, 0.5)) {
        (true, _) => (mine + theirs) / 2.0,
        (false, true) => mine,
        (false, false) => theirs,
    };
    let mut child = fitter.clone();
    for (mine, &theirs) in child.parameters.iter_mut().zip(&other.parameters) {
        *mine = inherited(*mine, theirs);
    }
    let pairs = Aligned::new(&fitter.links, &other.links);
    let pairs: Vec<_> = pairs.filter_map(|(mine, theirs)| Some((*mine?, theirs))).collect();
    for (gene, (mine, theirs)) in child.links.iter_mut().zip(&pairs) {
        if let Some(theirs) = theirs {
            gene.weight = inherited(mine.weight, theirs.weight);
        }
    }
    for (gene, (mine, theirs)) in child.links.iter_mut().zip(&pairs) {
        gene.enabled = is_enabled(mine, *theirs, rules, rng);
    }
    child
}

fn is_enabled(
    mine: &LinkGene,
    theirs: Option<&LinkGene>,
    rules: &NeatRules,
    rng: &mut impl Rng,
) -> bool {
    let is_on_in_both = mine.enabled && theirs.is_none_or(|link| link.enabled);
    is_on_in_both || !chance(rng, rules.disabled_share)
}

/// Draws an element of a list; `None` if the list is empty.
pub fn drawn<'a, T>(list: &'a [T], rng: &mut impl Rng) -> Option<&'a T> {
    if list.is_empty() { None } else { list.get(rng.random_range(0..list.len())) }
}

#[cfg(test)]
mod tests {
    use super::super::genome::link;
    use super::*;
    use crate::rng::{Purpose, stream};

    fn genome(links: Vec<LinkGene>, parameter: f32) -> NetworkGenome {
        NetworkGenome { inputs: 2, outputs: 1, parameters: vec![parameter], links }
    }

    fn parents() -> [NetworkGenome; 2] {
        let off = LinkGene { enabled: false, ..link(0, 2, 1.0, 0) };
        [
            genome(vec![off, link(0, 3, 3.0, 4), link(3, 2, 5.0, 5)], 0.25),
            genome(vec![link(0, 2, 2.0, 0), link(1, 2, 7.0, 1), link(2, 2, 7.0, 9)], 0.75),
        ]
    }

    #[test]
    fn disjoint_and_excess_links_come_from_the_fitter_parent() {
        let [a, b] = parents();
        for i in 0..100 {
            let rng = &mut stream(1, 0, i, Purpose::Mutation);
            let child = mated(&a, &b, &NeatRules::default(), rng);
            let numbers = |genome: &NetworkGenome| -> Vec<u32> {
                genome.links.iter().map(|link| link.innovation).collect()
            };
            assert_eq!(numbers(&child), [0, 4, 5]);
            assert_eq!((child.links[1].weight, child.links[2].weight), (3.0, 5.0));
            let child = mated(&b, &a, &NeatRules::default(), rng);
            assert_eq!(numbers(&child), [0, 1, 9]);
        }
    }

    #[test]
    fn matching_weights_come_from_either_parent_or_are_averaged() {
        let [a, b] = parents();
        let seen = |averaged_share| {
            let rules = NeatRules { averaged_share, ..NeatRules::default() };
            let mut rng = stream(2, 0, 0, Purpose::Mutation);
            let mut weights: Vec<(f32, f32)> = (0..100)
                .map(|_| mated(&a, &b, &rules, &mut rng))
                .map(|child| (child.links[0].weight, child.parameters[0]))
                .collect();
            weights.sort_by(|x, y| x.partial_cmp(y).unwrap());
            weights.dedup();
            weights
        };
        assert_eq!(seen(0.0), [(1.0, 0.25), (1.0, 0.75), (2.0, 0.25), (2.0, 0.75)]);
        assert_eq!(seen(1.0), [(1.5, 0.5)]);
    }

    #[test]
    fn a_link_that_is_off_in_a_parent_is_off_in_three_of_four_children() {
        let [a, b] = parents();
        let mut rng = stream(3, 0, 0, Purpose::Mutation);
        for (fitter, other) in [(&a, &b), (&b, &a)] {
            let rules = NeatRules::default();
            let off =
                (0..4000).filter(|_| !mated(fitter, other, &rules, &mut rng).links[0].enabled);
            let off = off.count();
            assert!((2900..3100).contains(&off), "{off} of 4000");
        }
    }
}
