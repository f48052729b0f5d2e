//! The last generation, and the ancestry of individuals over all generations. A run's results do not depend on it.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use snakes_core::evolve::{Candidate, IndividualId, OwnStairs, Parents, ranking};
use snakes_core::genome::Genome;
use snakes_core::save::{IndividualRecord, LineageRecord, MAX_SPREAD};
use snakes_core::score::Evaluation;

/// A finished generation. Its lists are in the order of the individuals.
#[derive(Debug, Clone, PartialEq)]
pub struct Generation {
    /// Number of the generation; the first is 1.
    pub number: u32,
    /// Genomes of the individuals.
    pub genomes: Vec<Arc<Genome>>,
    /// Evaluations of the individuals.
    pub evaluations: Vec<Evaluation>,
    /// Parents of the individuals.
    pub parents: Vec<Parents>,
    /// Stairs of the individuals; empty if all have the stairs of the run.
    pub stairs: Vec<OwnStairs>,
}

/// An individual that has, or may have, descendants.
#[derive(Debug, Clone, PartialEq)]
pub struct Ancestor {
    /// Generation and index of the individual.
    pub place: IndividualId,
    /// Fitness of the individual; `None` if it was disqualified.
    pub fitness: Option<f32>,
    /// Genome of the individual; `None` if an earlier session evaluated it.
    pub genome: Option<Arc<Genome>>,
    /// Parents of the individual.
    pub parents: Parents,
}

/// Distribution of a generation's fitness.
#[derive(Debug, Clone, PartialEq)]
pub struct FitnessSpread {
    /// Number of the generation; the first is 1.
    pub generation: u32,
    /// Fitness of healthy individuals, sampled at even distances in the ranking, in ascending order.
    pub fitness: Vec<f32>,
}

/// The ancestry of an individual.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Ancestry {
    /// The individual, its first parent, the first parent of that parent, and so on, as far as known.
    pub line: Vec<Arc<Ancestor>>,
    /// The second parents of the individuals in `line`, as far as known.
    pub others: Vec<Arc<Ancestor>>,
    /// Distribution of fitness in all generations, the first generation first.
    pub spreads: Vec<Arc<FitnessSpread>>,
}

/// The ancestors of the individuals that may have descendants. Extinct lines are removed.
#[derive(Debug, Default)]
pub(super) struct Lineage {
    known: BTreeMap<IndividualId, Arc<Ancestor>>,
    spreads: Vec<Arc<FitnessSpread>>,
}

/// Maximum number of ancestors, which limits memory. The earliest are removed.
const MAX_ANCESTORS: usize = 60_000;

impl Lineage {
    /// Restores the lineage that earlier sessions saved.
    pub fn recalled(records: &[LineageRecord]) -> Self {
        let mut lineage = Self::default();
        for record in records {
            let place = |individual| IndividualId { generation: record.generation, individual };
            let ancestors =
                record.born.iter().map(|&IndividualRecord(individual, fitness, parents)| {
                    let place = place(individual);
                    Ancestor { place, fitness, genome: None, parents: parents.into() }
                });
            let ancestors = ancestors.map(|ancestor| (ancestor.place, Arc::new(ancestor)));
            lineage.known.extend(ancestors);
            let (generation, fitness) = (record.generation, record.spread.clone());
            lineage.spreads.push(Arc::new(FitnessSpread { generation, fitness }));
        }
        lineage
    }

    /// Adds a generation's champion and its individuals that may have children. Returns the record to be saved.
    pub fn add(
        &mut self,
        generation: &Generation,
        parent_pool: &[IndividualId],
        champion: Option<IndividualId>,
    ) -> LineageRecord {
        let number = generation.number;
        let champion = champion.filter(|champion| !parent_pool.contains(champion));
        let born = parent_pool.iter().copied().chain(champion);
        let born = born.filter(|place| place.generation == number);
        let ancestors = born.filter_map(|place| generation.ancestor(place.individual));
        let ancestors: Vec<Arc<Ancestor>> = ancestors.map(Arc::new).collect();
        let born = ancestors.iter().map(|ancestor| {
            IndividualRecord(ancestor.place.individual, ancestor.fitness, ancestor.parents.into())
        });
        let fitness = generation.spread();
        let record =
            LineageRecord { generation: number, spread: fitness.clone(), born: born.collect() };
        self.spreads.push(Arc::new(FitnessSpread { generation: number, fitness }));
        self.known.extend(ancestors.into_iter().map(|ancestor| (ancestor.place, ancestor)));
        record
    }

    /// Removes all individuals except `roots` and their ancestors.
    pub fn retain(&mut self, roots: impl Iterator<Item = IndividualId>) {
        let mut lines = BTreeSet::new();
        let mut kept = BTreeSet::new();
        for root in roots {
            let mut next = Some(root);
            while let Some(place) = next.take() {
                let Some(ancestor) = self.known.get(&place) else { break };
                if !lines.insert(place) {
                    break;
                }
                kept.insert(place);
                kept.extend(ancestor.parents.ids());
                next = ancestor.parents.ids().next();
            }
        }
        self.known.retain(|place, _| kept.contains(place));
        while self.known.len() > MAX_ANCESTORS {
            self.known.pop_first();
        }
    }

    /// Returns an individual, or `None` if it is not known.
    pub fn get(&self, place: IndividualId) -> Option<&Arc<Ancestor>> {
        self.known.get(&place)
    }

    /// Returns the ancestry of an individual; empty if it is not known.
    pub fn ancestry(&self, of: Option<IndividualId>) -> Ancestry {
        let first = of.and_then(|place| self.get(place));
        let parent = |ancestor: &&Arc<Ancestor>| self.get(ancestor.parents.ids().next()?);
        let line: Vec<_> = std::iter::successors(first, parent).cloned().collect();
        let seconds = line.iter().filter_map(|ancestor| ancestor.parents.ids().nth(1));
        let others = seconds.filter_map(|place| self.get(place).cloned()).collect();
        Ancestry { line, others, spreads: self.spreads.clone() }
    }
}

impl Generation {
    /// Makes a generation of candidates and their evaluations.
    pub(super) fn of(
        number: u32,
        candidates: Vec<Candidate>,
        evaluations: Vec<Evaluation>,
    ) -> Self {
        let parents = candidates.iter().map(|candidate| candidate.parents).collect();
        let stairs = candidates.iter().filter_map(|candidate| candidate.stairs.clone()).collect();
        let genomes = candidates.into_iter().map(|candidate| Arc::new(candidate.genome)).collect();
        Self { number, genomes, evaluations, parents, stairs }
    }

    /// Returns an individual of this generation as an ancestor.
    fn ancestor(&self, individual: u32) -> Option<Ancestor> {
        let index = individual as usize;
        let evaluation = self.evaluations.get(index)?;
        Some(Ancestor {
            place: IndividualId { generation: self.number, individual },
            fitness: evaluation.disqualified.is_none().then_some(evaluation.fitness),
            genome: self.genomes.get(index).cloned(),
            parents: self.parents.get(index).copied().unwrap_or(Parents::Unknown),
        })
    }

    /// Samples the fitness of healthy individuals at even distances in the ranking, in ascending order.
    fn spread(&self) -> Vec<f32> {
        let ranked = ranking(&self.evaluations);
        let count = ranked.len().min(MAX_SPREAD);
        let place = |index: usize| index * (ranked.len() - 1) / (count - 1).max(1);
        let chosen = (0..count).rev().map(|index| ranked[place(index)]);
        chosen.map(|index| self.evaluations[index].fitness).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use snakes_core::evolve::{RunPlan, Settings, StrategyKind, begin};

    /// Evolves without simulating. `best` has the index of the best individual of each generation.
    fn lineage(strategy: StrategyKind, best: &[usize]) -> (Lineage, Vec<LineageRecord>) {
        let mut settings = Settings::default();
        settings.evolution.strategy = strategy;
        settings.evolution.population = 6;
        settings.evolution.generations = 100;
        settings.evolution.halving.parents = 2;
        settings.trial.duration_s = 0.5;
        let mut strategy = begin(&RunPlan::new("test", 1, settings));
        let mut lineage = Lineage::default();
        let mut records = Vec::new();
        for (number, best) in (1..).zip(best) {
            let asked = strategy.ask();
            let evaluations: Vec<Evaluation> = (0..6)
                .map(|i| Evaluation::of_fitness(if i == *best { 9.0 } else { i as f32 }))
                .collect();
            strategy.tell(&asked, &evaluations);
            let generation = Generation::of(number, asked, evaluations);
            let champion = IndividualId { generation: number, individual: *best as u32 };
            let parent_pool = strategy.parent_pool();
            records.push(lineage.add(&generation, &parent_pool, Some(champion)));
            lineage.retain(parent_pool.into_iter().chain(Some(champion)));
        }
        (lineage, records)
    }

    #[test]
    fn the_ancestry_of_the_reports_method_goes_back_parent_by_parent() {
        // Individuals with even indices are children of the best, those with odd indices of the second best.
        let (lineage, records) = lineage(StrategyKind::Halving, &[3, 2, 1, 4]);
        let of = IndividualId { generation: 4, individual: 4 };
        let line = lineage.ancestry(Some(of)).line;
        let places: Vec<(u32, u32)> =
            line.iter().map(|a| (a.place.generation, a.place.individual)).collect();
        // Individual 4 of generation 4 is even: its parent is the best of generation 3, which is 1. Individual 1 is odd: its parent
        // is the second best of generation 2, which is 5. Individual 5 is odd: its parent is the second best of generation 1, which
        // is 5.
        assert_eq!(places, [(4, 4), (3, 1), (2, 5), (1, 5)]);
        assert!(line.iter().all(|ancestor| ancestor.genome.is_some()));
        let again = Lineage::recalled(&records).ancestry(Some(of));
        let known: Vec<IndividualId> = again.line.iter().map(|ancestor| ancestor.place).collect();
        assert_eq!(known, line.iter().map(|ancestor| ancestor.place).collect::<Vec<_>>());
        assert_eq!(again.spreads.len(), 4);
    }

    #[test]
    fn individuals_without_descendants_are_removed() {
        let best: Vec<usize> = (0..60).map(|generation| generation % 6).collect();
        let (lineage, _) = self::lineage(StrategyKind::Halving, &best);
        assert!(lineage.known.len() < 60 + 2 * 6, "{} are known", lineage.known.len());
        let (crossed, _) = self::lineage(StrategyKind::Ga, &best);
        let ancestry = crossed.ancestry(Some(IndividualId { generation: 60, individual: 5 }));
        assert_eq!(ancestry.line.len(), 60);
        assert!(!ancestry.others.is_empty(), "some have two parents");
    }

    #[test]
    fn the_fitness_sample_includes_the_least_and_the_greatest() {
        let evaluations: Vec<Evaluation> =
            (0..100).map(|i| Evaluation::of_fitness(i as f32)).collect();
        let generation = Generation::of(1, Vec::new(), evaluations);
        let spread = generation.spread();
        assert_eq!(spread.len(), MAX_SPREAD);
        assert_eq!((spread.first(), spread.last()), (Some(&0.0), Some(&99.0)));
        assert!(spread.is_sorted());
        let none = Generation { evaluations: Vec::new(), ..generation };
        assert_eq!(none.spread(), [0.0; 0]);
    }
}
