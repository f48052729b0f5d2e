//! Reproduction: the children of one generation.

use rand::{Rng, RngExt};

use super::innovation::Newborn;
use super::mating::{drawn, mated};
use super::mutation::{chance, mutated};
use super::offspring::{offspring_numbers, sharable};
use super::population::NeatPopulation;
use super::species::SpeciesRecord;
use crate::rng::{Purpose, stream};

/// The indices of a species' members in the population, best first.
pub struct Ranking {
    /// Id of the species.
    pub id: u32,
    /// Indices of the species' members in the population.
    pub places: Vec<usize>,
}

impl NeatPopulation {
    /// Ranks the members of each species, best first. Equal members keep their order.
    pub(super) fn rankings(&self, values: &[f64]) -> Vec<Ranking> {
        let ranking = |record: &SpeciesRecord| {
            let members = self
                .memberships
                .iter()
                .take(values.len())
                .enumerate()
                .filter(|(_, id)| **id == record.id);
            let mut places: Vec<usize> = members.map(|(place, _)| place).collect();
            places.sort_by(|&a, &b| values[b].total_cmp(&values[a]));
            Ranking { id: record.id, places }
        };
        self.records.iter().map(ranking).collect()
    }

    /// Makes as many children as there are genomes, species after species. Fitness is shared: each member's fitness is divided by the
    /// number of members, so the sum over a species is their mean.
    pub(super) fn children(
        &self,
        fertile: &[&Ranking],
        values: &[f64],
        seed: u64,
        generation: u32,
    ) -> Vec<Newborn> {
        let shared = sharable(values);
        let shares: Vec<f64> = fertile.iter().map(|ranking| ranking.mean(&shared)).collect();
        let numbers = offspring_numbers(&shares, self.genomes.len());
        let mut children = Vec::with_capacity(self.genomes.len());
        for (ranking, number) in fertile.iter().zip(numbers) {
            for rank in 0..number {
                let place = u32::try_from(children.len()).unwrap_or(u32::MAX);
                let mut rng = stream(seed, generation, place, Purpose::Mutation);
                let is_champion =
                    rank == 0 && ranking.places.len() > self.rules.champion_species_size as usize;
                children.push(if is_champion {
                    Newborn { genome: self.genomes[ranking.places[0]].clone(), novelty: None }
                } else {
                    self.child(ranking, fertile, values, &mut rng)
                });
            }
        }
        children
    }

    fn child(
        &self,
        ranking: &Ranking,
        fertile: &[&Ranking],
        values: &[f64],
        rng: &mut impl Rng,
    ) -> Newborn {
        let members = &ranking.places;
        let survivors = (self.rules.survival_share * members.len() as f64).floor() as usize + 1;
        let parents = &members[..survivors.min(members.len())];
        let first = parents[rng.random_range(0..parents.len())];
        if chance(rng, self.rules.unmated_share) {
            return mutated(self.genomes[first].clone(), &self.rules, rng);
        }
        let others: Vec<usize> =
            fertile.iter().filter(|r| r.id != ranking.id).map(|r| r.places[0]).collect();
        let stranger = chance(rng, self.rules.interspecies_share).then(|| drawn(&others, rng));
        let mate = drawn(parents, rng).copied().unwrap_or(first);
        let second = stranger.flatten().copied().unwrap_or(mate);
        let (a, b) = (&self.genomes[first], &self.genomes[second]);
        let is_fitter = values[first]
            .total_cmp(&values[second])
            .then(b.links.len().cmp(&a.links.len()))
            .is_ge();
        let (fitter, other) = if is_fitter { (a, b) } else { (b, a) };
        mutated(mated(fitter, other, &self.rules, rng), &self.rules, rng)
    }
}

impl Ranking {
    /// Returns the mean of the members' values, summed in the order of the ranking.
    pub fn mean(&self, values: &[f64]) -> f64 {
        let sum = self.places.iter().fold(0.0, |sum, &place| sum + values[place]);
        sum / self.places.len().max(1) as f64
    }
}
