//! Species: genomes at a small distance from each other compete among themselves.

use serde::{Deserialize, Serialize};

use super::distance::distance;
use super::genome::NetworkGenome;
use super::rules::NeatRules;

/// The data of a species that are kept from one generation to the next.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SpeciesRecord {
    /// Id of the species, ascending in the order of appearance.
    pub id: u32,
    /// Course of the best fitness of the species.
    pub progress: FitnessProgress,
}

/// The course of the best fitness of a species or a population.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FitnessProgress {
    /// Number of evaluated generations.
    pub age: u32,
    /// Best fitness that a member has ever had; `None` before the first evaluation.
    pub best: Option<f64>,
    /// Number of generations since the best fitness was reached.
    pub unimproved: u32,
}

/// A species in a generation, for charts.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SpeciesSummary {
    /// Id of the species, ascending in the order of appearance.
    pub id: u32,
    /// Number of members of the species.
    pub size: u32,
    /// Best fitness of a member in this generation.
    pub best_fitness: f64,
    /// Mean fitness of the members in this generation.
    pub mean_fitness: f64,
    /// Number of generations of the species; it is 1 in its first generation.
    pub age: u32,
}

impl FitnessProgress {
    /// Returns the progress after one more generation, in which the best member had this fitness.
    pub fn after(&self, best: f64) -> Self {
        let is_better = self.best.is_none_or(|record| best > record);
        Self {
            age: self.age.saturating_add(1),
            best: if is_better { Some(best) } else { self.best },
            unimproved: if is_better { 0 } else { self.unimproved.saturating_add(1) },
        }
    }
}

/// Assigns each genome, in order, to the first species whose representative is nearer than the threshold, or to a new species with the
/// genome as representative. `old` contains the ids and representatives of the species so far. Returns the id of each genome's species,
/// and the next free id.
pub fn assigned<'a>(
    genomes: &'a [NetworkGenome],
    old: Vec<(u32, &'a NetworkGenome)>,
    mut next_id: u32,
    threshold: f64,
    rules: &NeatRules,
) -> (Vec<u32>, u32) {
    let mut representatives = old;
    let mut ids = Vec::with_capacity(genomes.len());
    for genome in genomes {
        let mut near = representatives.iter();
        match near.find(|(_, representative)| distance(rules, genome, representative) < threshold) {
            Some((id, _)) => ids.push(*id),
            None => {
                ids.push(next_id);
                representatives.push((next_id, genome));
                next_id = next_id.saturating_add(1);
            }
        }
    }
    (ids, next_id)
}

#[cfg(test)]
mod tests {
    use super::super::genome::link;
    use super::*;

    fn genome(weight: f32) -> NetworkGenome {
        let links = vec![link(0, 1, weight, 0)];
        NetworkGenome { inputs: 1, outputs: 1, parameters: vec![], links }
    }

    #[test]
    fn a_genome_joins_the_first_species_that_is_near_or_founds_one() {
        // The distance is 0.4 times the difference of the weights, so the threshold is a difference of 2.
        let genomes = [0.0, 2.5, 1.5, 4.0, -1.0].map(genome);
        let (ids, next) = assigned(&genomes, vec![], 7, 0.8, &NeatRules::default());
        assert_eq!((ids, next), (vec![7, 8, 7, 8, 7], 9));
        let (ids, next) =
            assigned(&genomes[3..], vec![(2, &genomes[1])], 9, 0.8, &NeatRules::default());
        assert_eq!((ids, next), (vec![2, 9], 10));
    }

    #[test]
    fn generations_without_progress_are_counted() {
        let mut record = FitnessProgress::default();
        let expected = [(1.0, 0), (1.0, 1), (0.5, 2), (1.5, 0)];
        for (age, (best, unimproved)) in (1..).zip(expected) {
            record = record.after(best);
            assert_eq!((record.age, record.unimproved), (age, unimproved));
        }
        assert_eq!(record.best, Some(1.5));
    }
}
