//! A generation as it was, and who came from whom over all of them. Nothing of a run depends on it.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use crate::evolve::{Parents, Place, ranking};
use crate::genome::Genome;
use crate::save::{BornRecord, LineageRecord, MOST_SPREAD};
use crate::score::Evaluation;

/// A finished generation. All three lists are in the order of the individuals.
#[derive(Debug, Clone, PartialEq)]
pub struct Generation {
    /// The first is 1.
    pub number: u32,
    /// The individuals.
    pub genomes: Vec<Arc<Genome>>,
    /// How they did.
    pub evaluations: Vec<Evaluation>,
    /// Whom they come from.
    pub parents: Vec<Parents>,
}

/// Somebody who has, or may have, descendants.
#[derive(Debug, Clone, PartialEq)]
pub struct Ancestor {
    /// Its place in the run.
    pub place: Place,
    /// What it reached; none if it was disqualified.
    pub fitness: Option<f32>,
    /// Its genes; none if an earlier session found it.
    pub genome: Option<Arc<Genome>>,
    /// Whom it comes from.
    pub parents: Parents,
}

/// How a generation's fitness was spread.
#[derive(Debug, Clone, PartialEq)]
pub struct Spread {
    /// The generation; the first is 1.
    pub generation: u32,
    /// Some of the healthy ones' fitness, from the least to the greatest, spread evenly over them.
    pub fitness: Vec<f32>,
}

/// The line of descent of somebody.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Descent {
    /// Itself, its first parent, that one's first parent, and so on, as far as it is known.
    pub line: Vec<Arc<Ancestor>>,
    /// The second parents of those in the line, as far as they are known.
    pub others: Vec<Arc<Ancestor>>,
    /// Everybody's fitness, the first generation first.
    pub spreads: Vec<Arc<Spread>>,
}

/// Who came from whom. Lines that have died out are forgotten.
#[derive(Debug, Default)]
pub(super) struct Lineage {
    known: BTreeMap<Place, Arc<Ancestor>>,
    spreads: Vec<Arc<Spread>>,
}

/// More ancestors than this would take too much memory; the earliest go.
const MOST_KNOWN: usize = 60_000;

impl Lineage {
    /// What an earlier session has written down.
    pub fn recalled(records: &[LineageRecord]) -> Self {
        let mut lineage = Self::default();
        for record in records {
            let place = |individual| Place { generation: record.generation, individual };
            let ancestors = record.born.iter().map(|&BornRecord(individual, fitness, parents)| {
                let place = place(individual);
                Ancestor { place, fitness, genome: None, parents: parents.into() }
            });
            let ancestors = ancestors.map(|ancestor| (ancestor.place, Arc::new(ancestor)));
            lineage.known.extend(ancestors);
            let (generation, fitness) = (record.generation, record.spread.clone());
            lineage.spreads.push(Arc::new(Spread { generation, fitness }));
        }
        lineage
    }

    /// Takes a generation in: those of it who may have children, and its champion. Returns what is to be written down.
    pub fn add(
        &mut self,
        generation: &Generation,
        breeders: &[Place],
        champion: Option<Place>,
    ) -> LineageRecord {
        let number = generation.number;
        let champion = champion.filter(|champion| !breeders.contains(champion));
        let born = breeders.iter().copied().chain(champion);
        let born = born.filter(|place| place.generation == number);
        let ancestors = born.filter_map(|place| generation.ancestor(place.individual));
        let ancestors: Vec<Arc<Ancestor>> = ancestors.map(Arc::new).collect();
        let born = ancestors.iter().map(|ancestor| {
            BornRecord(ancestor.place.individual, ancestor.fitness, ancestor.parents.into())
        });
        let fitness = generation.spread();
        let record =
            LineageRecord { generation: number, spread: fitness.clone(), born: born.collect() };
        self.spreads.push(Arc::new(Spread { generation: number, fitness }));
        self.known.extend(ancestors.into_iter().map(|ancestor| (ancestor.place, ancestor)));
        record
    }

    /// Forgets everybody but these and whom they come from.
    pub fn retain(&mut self, roots: impl Iterator<Item = Place>) {
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
                kept.extend(ancestor.parents.places());
                next = ancestor.parents.places().next();
            }
        }
        self.known.retain(|place, _| kept.contains(place));
        while self.known.len() > MOST_KNOWN {
            self.known.pop_first();
        }
    }

    /// Somebody who is known.
    pub fn get(&self, place: Place) -> Option<&Arc<Ancestor>> {
        self.known.get(&place)
    }

    /// The line of descent of somebody.
    pub fn descent(&self, of: Option<Place>) -> Descent {
        let first = of.and_then(|place| self.get(place));
        let parent = |ancestor: &&Arc<Ancestor>| self.get(ancestor.parents.places().next()?);
        let line: Vec<_> = std::iter::successors(first, parent).cloned().collect();
        let seconds = line.iter().filter_map(|ancestor| ancestor.parents.places().nth(1));
        let others = seconds.filter_map(|place| self.get(place).cloned()).collect();
        Descent { line, others, spreads: self.spreads.clone() }
    }
}

impl Generation {
    /// One of its individuals as an ancestor of others.
    fn ancestor(&self, individual: u32) -> Option<Ancestor> {
        let index = individual as usize;
        let evaluation = self.evaluations.get(index)?;
        Some(Ancestor {
            place: Place { generation: self.number, individual },
            fitness: evaluation.disqualified.is_none().then_some(evaluation.fitness),
            genome: self.genomes.get(index).cloned(),
            parents: self.parents.get(index).copied().unwrap_or(Parents::Unknown),
        })
    }

    /// Some of the healthy ones' fitness, from the least to the greatest, spread evenly over them.
    fn spread(&self) -> Vec<f32> {
        let ranked = ranking(&self.evaluations);
        let count = ranked.len().min(MOST_SPREAD);
        let place = |index: usize| index * (ranked.len() - 1) / (count - 1).max(1);
        let chosen = (0..count).rev().map(|index| ranked[place(index)]);
        chosen.map(|index| self.evaluations[index].fitness).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::{RunPlan, Settings, StrategyKind, begin};

    /// Evolves without a world: of each generation the one with this index is the best.
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
            let (genomes, parents) = (strategy.ask(), strategy.parents());
            let evaluations: Vec<Evaluation> = (0..6)
                .map(|i| Evaluation::of_fitness(if i == *best { 9.0 } else { i as f32 }))
                .collect();
            strategy.tell(&genomes, &evaluations);
            let genomes = genomes.into_iter().map(Arc::new).collect();
            let generation = Generation { number, genomes, evaluations, parents };
            let champion = Place { generation: number, individual: *best as u32 };
            let breeders = strategy.breeders();
            records.push(lineage.add(&generation, &breeders, Some(champion)));
            lineage.retain(breeders.into_iter().chain(Some(champion)));
        }
        (lineage, records)
    }

    #[test]
    fn the_line_of_the_reports_method_goes_back_parent_by_parent() {
        // In turn: even indices are children of the best, odd ones of the second.
        let (lineage, records) = lineage(StrategyKind::Halving, &[3, 2, 1, 4]);
        let of = Place { generation: 4, individual: 4 };
        let line = lineage.descent(Some(of)).line;
        let places: Vec<(u32, u32)> =
            line.iter().map(|a| (a.place.generation, a.place.individual)).collect();
        // 4 of the last comes from the best of the third, 1; that from the second best of the second, 5 (of 2 and
        // 5); that, odd, from the second best of the first (of 3 and 5).
        assert_eq!(places, [(4, 4), (3, 1), (2, 5), (1, 5)]);
        assert!(line.iter().all(|ancestor| ancestor.genome.is_some()));
        let again = Lineage::recalled(&records).descent(Some(of));
        let known: Vec<Place> = again.line.iter().map(|ancestor| ancestor.place).collect();
        assert_eq!(known, line.iter().map(|ancestor| ancestor.place).collect::<Vec<_>>());
        assert_eq!(again.spreads.len(), 4);
    }

    #[test]
    fn who_has_no_descendants_is_forgotten() {
        let best: Vec<usize> = (0..60).map(|generation| generation % 6).collect();
        let (lineage, _) = self::lineage(StrategyKind::Halving, &best);
        assert!(lineage.known.len() < 60 + 2 * 6, "{} are known", lineage.known.len());
        let (crossed, _) = self::lineage(StrategyKind::Ga, &best);
        let descent = crossed.descent(Some(Place { generation: 60, individual: 5 }));
        assert_eq!(descent.line.len(), 60);
        assert!(!descent.others.is_empty(), "some have two parents");
    }

    #[test]
    fn the_spread_reaches_from_the_least_to_the_greatest() {
        let evaluations: Vec<Evaluation> =
            (0..100).map(|i| Evaluation::of_fitness(i as f32)).collect();
        let generation =
            Generation { number: 1, genomes: Vec::new(), evaluations, parents: Vec::new() };
        let spread = generation.spread();
        assert_eq!(spread.len(), MOST_SPREAD);
        assert_eq!((spread.first(), spread.last()), (Some(&0.0), Some(&99.0)));
        assert!(spread.is_sorted());
        let none = Generation { evaluations: Vec::new(), ..generation };
        assert_eq!(none.spread(), [0.0; 0]);
    }
}
