//! A population of networks, and the next generation.

use rand::{Rng, RngExt};
use serde::{Deserialize, Serialize};

use super::genome::{LinkGene, MOST_ENDS, NetworkGenome};
use super::innovation::Innovations;
use super::mating::drawn;
use super::mutation::{mutated, symmetric};
use super::offspring::comparable;
use super::reproduction::Ranking;
use super::rules::NeatRules;
use super::species::{FitnessProgress, SpeciesRecord, SpeciesSummary, assigned};
use crate::check::{Invalid, within};
use crate::rng::{Purpose, stream};

/// Greatest number of genomes of a population.
pub const LARGEST_NEAT_POPULATION: usize = 10_000;

/// A generation of networks before its evaluation. It contains the whole state, from which the search continues bit for bit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NeatPopulation {
    pub(super) rules: NeatRules,
    pub(super) innovations: Innovations,
    pub(super) next_species: u32,
    /// Threshold of the distance between members of a species. Differs from the initial threshold of the rules if it is adjusted.
    pub(super) threshold: f64,
    pub(super) progress: FitnessProgress,
    /// Species of this generation, in ascending order of id. Each has members.
    pub(super) records: Vec<SpeciesRecord>,
    /// Species of the last generation, from which this one descends, with their fitness; empty in the first generation.
    pub(super) evaluated: Vec<SpeciesSummary>,
    /// Id of the species of each genome.
    pub(crate) memberships: Vec<u32>,
    /// Genomes of this generation.
    pub(crate) genomes: Vec<NetworkGenome>,
}

impl NeatPopulation {
    /// Creates the first generation: every input is linked to every output, there are no hidden nodes, and weights and parameters are
    /// random.
    ///
    /// # Errors
    /// Returns an error if a setting or number is out of its range, or if the rules do not allow as many links.
    pub fn first(
        rules: NeatRules,
        inputs: u16,
        outputs: u16,
        parameters: u16,
        size: usize,
        seed: u64,
    ) -> Result<Self, Invalid> {
        for (field, ends) in [("inputs", inputs), ("outputs", outputs)] {
            within(field, ends, 1..=MOST_ENDS)?;
        }
        within("parameters", parameters, 0..=MOST_ENDS)?;
        rules.check()?;
        let links = u32::from(inputs) * u32::from(outputs);
        within("links of the first generation", links, 1..=rules.most_links)?;
        let genome = |place| {
            let mut rng = stream(seed, 0, place, Purpose::Birth);
            first_genome(inputs, outputs, parameters, &rules, &mut rng)
        };
        Self::founded(rules.clone(), Innovations::first(inputs, outputs), size, genome)
    }

    /// Creates a first generation that descends from one genome: the genome itself, and mutants of its weights and parameters.
    ///
    /// # Errors
    /// Returns an error if the genome, a setting or the size is not allowed.
    pub fn descended(
        rules: NeatRules,
        founder: &NetworkGenome,
        size: usize,
        seed: u64,
    ) -> Result<Self, Invalid> {
        rules.check()?;
        founder.check(&rules).map_err(|error| error.inside("founder"))?;
        let only_weights =
            NeatRules { add_node: 0.0, add_link: 0.0, weight_mutation: 1.0, ..rules.clone() };
        Self::founded(rules, Innovations::after(founder), size, |place| {
            let mut rng = stream(seed, 0, place, Purpose::Birth);
            let is_founder = place == 0;
            let genome = founder.clone();
            if is_founder { genome } else { mutated(genome, &only_weights, &mut rng).genome }
        })
    }

    /// Creates the next generation from the fitness of each genome of this one. Larger is better. Fitness that is missing or not finite
    /// counts as the smallest of the others. `seed`, and `generation`, the number of the new generation, select the streams of random
    /// numbers.
    pub fn next(&self, fitness: &[f64], seed: u64, generation: u32) -> Self {
        let mut fitness = fitness.to_vec();
        fitness.resize(self.genomes.len(), f64::NAN);
        let values = comparable(&fitness);
        let rankings = self.rankings(&values);
        let best =
            |ranking: &Ranking| ranking.places.first().map_or(f64::MIN, |&best| values[best]);
        let evaluated = self.summaries(&rankings, &values);
        let mut progress = self.progress.after(values.iter().copied().fold(f64::MIN, f64::max));
        let mut records: Vec<SpeciesRecord> = self.records.clone();
        for (record, ranking) in records.iter_mut().zip(&rankings) {
            record.progress = record.progress.after(best(ranking));
        }
        // The best species comes first. The sort is stable, so of equal species the older comes first.
        let mut order: Vec<usize> = (0..rankings.len()).collect();
        order.retain(|&place| !rankings[place].places.is_empty());
        order.sort_by(|&a, &b| best(&rankings[b]).total_cmp(&best(&rankings[a])));
        let is_standstill = progress.unimproved >= self.rules.standstill_generations;
        if is_standstill {
            order.truncate(2);
            progress.unimproved = 0;
            order.iter().for_each(|&place| records[place].progress.unimproved = 0);
        } else {
            let limit = self.rules.stagnation_generations;
            let leader = order.first().copied();
            order.retain(|&i| records[i].progress.unimproved < limit || Some(i) == leader);
        }
        order.sort_unstable();
        let fertile: Vec<&Ranking> = order.iter().map(|&place| &rankings[place]).collect();
        let mut children = self.children(&fertile, &values, seed, generation);
        let mut innovations = self.innovations.clone();
        innovations.settle(&mut children);
        let genomes: Vec<_> = children.into_iter().map(|child| child.genome).collect();
        let threshold = self.adjusted_threshold();
        // This stream follows those of the children.
        let last = u32::try_from(self.genomes.len()).unwrap_or(u32::MAX);
        let mut rng = stream(seed, generation, last, Purpose::Mutation);
        let representatives = rankings.iter().filter_map(|ranking| {
            drawn(&ranking.places, &mut rng).map(|&place| (ranking.id, &self.genomes[place]))
        });
        let (memberships, next_species) = assigned(
            &genomes,
            representatives.collect(),
            self.next_species,
            threshold,
            &self.rules,
        );
        records.extend((self.next_species..next_species).map(new_species));
        records.retain(|record| memberships.contains(&record.id));
        Self {
            rules: self.rules.clone(),
            innovations,
            next_species,
            threshold,
            progress,
            records,
            evaluated,
            memberships,
            genomes,
        }
    }

    fn founded(
        rules: NeatRules,
        innovations: Innovations,
        size: usize,
        genome: impl Fn(u32) -> NetworkGenome,
    ) -> Result<Self, Invalid> {
        rules.check()?;
        within("size", size, 1..=LARGEST_NEAT_POPULATION)?;
        let genomes: Vec<NetworkGenome> = (0..).map(genome).take(size).collect();
        let (memberships, next_species) =
            assigned(&genomes, vec![], 1, rules.species_threshold, &rules);
        let population = Self {
            innovations,
            next_species,
            threshold: rules.species_threshold,
            progress: FitnessProgress::default(),
            records: (1..next_species).map(new_species).collect(),
            evaluated: vec![],
            memberships,
            genomes,
            rules,
        };
        population.check()?;
        Ok(population)
    }

    fn summaries(&self, rankings: &[Ranking], values: &[f64]) -> Vec<SpeciesSummary> {
        let summary = |(record, ranking): (&SpeciesRecord, &Ranking)| SpeciesSummary {
            id: record.id,
            size: u32::try_from(ranking.places.len()).unwrap_or(u32::MAX),
            best_fitness: ranking.places.first().map_or(f64::MIN, |&best| values[best]),
            mean_fitness: ranking.mean(values),
            age: record.progress.age.saturating_add(1),
        };
        self.records.iter().zip(rankings).map(summary).collect()
    }

    fn adjusted_threshold(&self) -> f64 {
        let (goal, step) = (self.rules.species_goal as usize, self.rules.threshold_step);
        match self.records.len() {
            _ if goal == 0 => self.threshold,
            number if number > goal => self.threshold + step,
            number if number < goal => (self.threshold - step).max(step),
            _ => self.threshold,
        }
    }
}

fn new_species(id: u32) -> SpeciesRecord {
    SpeciesRecord { id, progress: FitnessProgress::default() }
}

fn first_genome(
    inputs: u16,
    outputs: u16,
    parameters: u16,
    rules: &NeatRules,
    rng: &mut impl Rng,
) -> NetworkGenome {
    let ends = (0..u32::from(inputs))
        .flat_map(|from| (0..u32::from(outputs)).map(move |i| (from, u32::from(inputs) + i)));
    let link = |(innovation, (from, to))| {
        let weight = symmetric(rng, rules.first_weight);
        LinkGene { from, to, weight, enabled: true, innovation }
    };
    let links = (0..).zip(ends).map(link).collect();
    let parameters = (0..parameters).map(|_| rng.random_range(0.0..=1.0)).collect();
    NetworkGenome { inputs, outputs, parameters, links }
}
