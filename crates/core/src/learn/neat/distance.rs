//! The distance between two genomes, and the alignment of their links.

use super::genome::{LinkGene, NetworkGenome};
use super::rules::NeatRules;

/// Returns the distance c₁ E / N + c₂ D / N + c₃ W of two genomes: E is the number of excess and D of disjoint links, W the mean
/// difference of the weights of matching links, N the number of links of the larger genome, or 1 if both are small (Stanley & Miikkulainen
/// 2002). Parameters do not count.
pub fn distance(rules: &NeatRules, a: &NetworkGenome, b: &NetworkGenome) -> f64 {
    let last = |genome: &NetworkGenome| genome.links.last().map(|link| link.innovation);
    let (last_a, last_b) = (last(a), last(b));
    let (mut excess, mut disjoint, mut matching, mut difference) = (0.0, 0.0, 0.0, 0.0);
    for pair in Aligned::new(&a.links, &b.links) {
        let is_excess = match pair {
            (Some(x), Some(y)) => {
                matching += 1.0;
                difference += f64::from((x.weight - y.weight).abs());
                continue;
            }
            (Some(x), None) => Some(x.innovation) > last_b,
            (None, Some(y)) => Some(y.innovation) > last_a,
            (None, None) => continue,
        };
        *(if is_excess { &mut excess } else { &mut disjoint }) += 1.0;
    }
    let larger = a.links.len().max(b.links.len());
    let size = if larger < rules.small_genome as usize { 1.0 } else { larger.max(1) as f64 };
    let mean = if matching > 0.0 { difference / matching } else { 0.0 };
    rules.excess_coefficient * excess / size
        + rules.disjoint_coefficient * disjoint / size
        + rules.weight_coefficient * mean
}

/// Two lists of links in the order of their innovation numbers, with matching links together.
pub struct Aligned<'a> {
    a: &'a [LinkGene],
    b: &'a [LinkGene],
}

impl<'a> Aligned<'a> {
    /// Aligns two lists that are in ascending order of innovation numbers.
    pub fn new(a: &'a [LinkGene], b: &'a [LinkGene]) -> Self {
        Self { a, b }
    }
}

impl<'a> Iterator for Aligned<'a> {
    type Item = (Option<&'a LinkGene>, Option<&'a LinkGene>);

    fn next(&mut self) -> Option<Self::Item> {
        let (first_a, first_b) = (self.a.first(), self.b.first());
        let smaller = [first_a, first_b].into_iter().flatten().map(|link| link.innovation).min()?;
        let a = first_a.filter(|link| link.innovation == smaller);
        let b = first_b.filter(|link| link.innovation == smaller);
        self.a = self.a.get(usize::from(a.is_some())..).unwrap_or_default();
        self.b = self.b.get(usize::from(b.is_some())..).unwrap_or_default();
        Some((a, b))
    }
}

#[cfg(test)]
mod tests {
    use super::super::genome::link;
    use super::*;

    fn genome(links: Vec<LinkGene>) -> NetworkGenome {
        NetworkGenome { inputs: 3, outputs: 1, parameters: vec![], links }
    }

    #[test]
    fn a_distance_is_the_one_computed_by_hand() {
        // Links 0 and 2 match, with differences 1 and 3. Links 1 and 3 are disjoint, 6 and 7 excess.
        let a = genome(vec![link(0, 3, 1.0, 0), link(1, 3, 0.0, 1), link(2, 3, -1.0, 2)]);
        let mut a_and_more = a.clone();
        a_and_more.links.extend([link(0, 4, 0.0, 6), link(4, 3, 0.0, 7)]);
        let b = genome(vec![link(0, 3, 2.0, 0), link(2, 3, 2.0, 2), link(1, 2, 0.0, 3)]);
        let rules = NeatRules { disjoint_coefficient: 10.0, ..NeatRules::default() };
        let expected = 2.0 + 10.0 * 2.0 + 0.4 * 2.0;
        assert_eq!(distance(&rules, &a_and_more, &b), expected);
        assert_eq!(distance(&rules, &b, &a_and_more), expected);
        let large = NeatRules { small_genome: 5, ..rules };
        assert_eq!(distance(&large, &a_and_more, &b), 2.0 / 5.0 + 20.0 / 5.0 + 0.8);
        assert_eq!(distance(&large, &b, &b), 0.0);
    }

    #[test]
    fn genomes_without_links_have_a_distance() {
        let one = genome(vec![link(0, 3, 2.0, 0)]);
        let rules = NeatRules { small_genome: 0, ..NeatRules::default() };
        assert_eq!(distance(&rules, &genome(vec![]), &genome(vec![])), 0.0);
        assert_eq!(distance(&rules, &genome(vec![]), &one), 1.0);
    }
}
