//! Novelty search: who does what nobody did has children (Lehman and Stanley, Evolutionary Computation 19
//! (2011)), mixed with fitness as much as one likes.

use rand::RngExt;
use serde::{Deserialize, Serialize};

use super::ga::{Breeder, GaState};
use super::{
    Descriptor, Parents, Place, PointState, RunPlan, Strategy, StrategyState, full_ranking,
};
use crate::check::{Invalid, within};
use crate::genome::Genome;
use crate::rng::Purpose;
use crate::score::Evaluation;
use crate::world::Stairs;

/// Settings of novelty search. Children are made as the genetic algorithm makes them.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NoveltySettings {
    /// How much novelty counts: 1 is pure novelty search, 0 is the genetic algorithm.
    pub weight: f32,
    /// Novelty is the mean distance to so many nearest neighbours.
    pub neighbours: u32,
    /// How many of each generation, chosen at random, are remembered.
    pub remembered: u32,
    /// How many are remembered at most; beyond, they take the places of others at random.
    pub archive_limit: u32,
    /// What behaviours are told apart by, beside where the agent ends.
    pub first: Descriptor,
    /// And by this.
    pub second: Descriptor,
}

impl Default for NoveltySettings {
    fn default() -> Self {
        Self {
            weight: 0.5,
            neighbours: 15,
            remembered: 6,
            archive_limit: 2000,
            first: Descriptor::BodyHeight,
            second: Descriptor::ContactDuty,
        }
    }
}

impl NoveltySettings {
    /// Checks every field against its range.
    pub fn check(&self) -> Result<(), Invalid> {
        within("weight", self.weight, 0.0..=1.0)?;
        within("neighbours", self.neighbours, 1..=1000)?;
        within("remembered", self.remembered, 0..=1000)?;
        // Each individual is compared with all of them.
        within("archive_limit", self.archive_limit, 1..=20_000)
    }
}

/// A behaviour as a point: where the agent ended, and its two descriptors, each from 0 to 1.
type Spot = [f64; 3];

/// What novelty search knows.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct NoveltyState {
    /// The last generation, best first.
    members: GaState,
    /// The behaviours that are remembered.
    archive: Vec<Spot>,
}

/// Novelty search at work.
#[derive(Debug, Clone)]
pub struct Novelty {
    settings: NoveltySettings,
    breeder: Breeder,
    archive: Vec<Spot>,
    start_y_m: f32,
    stairs: Stairs,
}

impl Novelty {
    /// A fresh search.
    pub fn new(plan: &RunPlan) -> Self {
        Self::with(plan, Breeder::new(plan), Vec::new())
    }

    /// A search that goes on.
    pub fn resumed(plan: &RunPlan, finished: u32, state: NoveltyState) -> Result<Self, Invalid> {
        let NoveltyState { members, archive } = state;
        let most = plan.settings.evolution.novelty.archive_limit as usize;
        within("archive", archive.len(), 0..=most)?;
        archive.iter().flatten().try_for_each(|&x| within("archive", x, 0.0..=1.0))?;
        Ok(Self::with(plan, Breeder::resumed(plan, finished, members)?, archive))
    }

    fn with(plan: &RunPlan, breeder: Breeder, archive: Vec<Spot>) -> Self {
        let trial = &plan.settings.trial;
        Self {
            settings: plan.settings.evolution.novelty.clone(),
            breeder,
            archive,
            start_y_m: trial.start_y_m,
            stairs: trial.stairs.clone(),
        }
    }

    /// The behaviour of an agent; none if it was disqualified.
    fn place(&self, evaluation: &Evaluation) -> Option<Spot> {
        if evaluation.disqualified.is_some() {
            return None;
        }
        let share = |descriptor: Descriptor| {
            descriptor.value(evaluation, self.start_y_m).map_or(0.0, |x| descriptor.share(x))
        };
        // From as far behind the start as the landing's end is ahead of it.
        let reach_m = f64::from(self.stairs.end_y_m() - self.start_y_m).abs().max(1.0);
        let progress_m = f64::from(evaluation.centre_y_m - self.start_y_m);
        let end = (0.5 + progress_m / (2.0 * reach_m)).clamp(0.0, 1.0);
        let [first, second] = [self.settings.first, self.settings.second].map(share);
        Some([end, first, second])
    }

    /// Mean distance of each place to its nearest neighbours among all of them and the archive. Who has no
    /// place is not new at all.
    fn novelties(&self, places: &[Option<Spot>]) -> Vec<f64> {
        let novelty = |(index, place): (usize, &Option<Spot>)| {
            let Some(place) = place else { return f64::NEG_INFINITY };
            let others = places.iter().enumerate().filter(|(other, _)| *other != index);
            let all = others.filter_map(|(_, place)| place.as_ref()).chain(&self.archive);
            let mut distances: Vec<f64> = all.map(|other| distance(place, other)).collect();
            let neighbours = self.settings.neighbours as usize;
            if neighbours < distances.len() {
                distances.select_nth_unstable_by(neighbours, f64::total_cmp);
                distances.truncate(neighbours);
            }
            distances.sort_by(f64::total_cmp);
            distances.iter().sum::<f64>() / distances.len().max(1) as f64
        };
        places.iter().enumerate().map(novelty).collect()
    }

    fn remember(&mut self, places: &[Option<Spot>]) {
        let mut rng = self.breeder.search.stream(0, Purpose::Archive);
        let mut candidates: Vec<Spot> = places.iter().flatten().copied().collect();
        for _ in 0..self.settings.remembered {
            if candidates.is_empty() {
                break;
            }
            let place = candidates.swap_remove(rng.random_range(0..candidates.len()));
            if self.archive.len() < self.settings.archive_limit as usize {
                self.archive.push(place);
            } else {
                let index = rng.random_range(0..self.archive.len());
                self.archive[index] = place;
            }
        }
    }
}

fn distance(a: &Spot, b: &Spot) -> f64 {
    a.iter().zip(b).map(|(x, y)| (x - y) * (x - y)).sum::<f64>().sqrt()
}

/// The place of each index in an order: 0 is the first.
fn places_in(order: &[usize]) -> Vec<f64> {
    let mut places = vec![0.0; order.len()];
    for (place, &index) in order.iter().enumerate() {
        places[index] = place as f64;
    }
    places
}

impl Strategy for Novelty {
    fn ask(&self) -> Vec<Genome> {
        self.breeder.genomes()
    }

    fn population(&self) -> usize {
        self.breeder.search.population
    }

    /// Novelty and fitness have no common unit; what is mixed is the place in either's order.
    fn tell(&mut self, _: &[Genome], evaluations: &[Evaluation]) {
        let places: Vec<Option<Spot>> =
            evaluations.iter().map(|evaluation| self.place(evaluation)).collect();
        let novelties = self.novelties(&places);
        let mut by_novelty: Vec<usize> = (0..evaluations.len()).collect();
        by_novelty.sort_by(|&a, &b| novelties[b].total_cmp(&novelties[a]));
        let (by_fitness, by_novelty) =
            (places_in(&full_ranking(evaluations)), places_in(&by_novelty));
        let weight = f64::from(self.settings.weight);
        let mixed: Vec<f64> = by_fitness
            .iter()
            .zip(&by_novelty)
            .map(|(fitness, novelty)| (1.0 - weight) * fitness + weight * novelty)
            .collect();
        let mut order: Vec<usize> = (0..evaluations.len()).collect();
        order.sort_by(|&a, &b| mixed[a].total_cmp(&mixed[b]));
        self.remember(&places);
        self.breeder.select(&order);
    }

    fn state(&self) -> StrategyState {
        let members = self.breeder.state();
        StrategyState::points(PointState::Novelty(NoveltyState {
            members,
            archive: self.archive.clone(),
        }))
    }

    fn amend(&mut self, plan: &RunPlan) {
        self.settings = plan.settings.evolution.novelty.clone();
        self.archive.truncate(self.settings.archive_limit as usize);
        self.breeder.amend(plan);
    }

    fn parents(&self) -> Vec<Parents> {
        self.breeder.parents()
    }

    fn breeders(&self) -> Vec<Place> {
        self.breeder.breeders()
    }

    fn recall(&mut self, breeders: &[Place]) {
        self.breeder.recall(breeders);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::Settings;
    use crate::score::Behaviour;

    fn evaluation(centre_y_m: f32, contact_duty: f32) -> Evaluation {
        let behaviour = Some(Behaviour { contact_duty, ..Behaviour::default() });
        Evaluation { behaviour, ..Evaluation::of_fitness(centre_y_m) }
    }

    /// Who of a generation of four comes first: three alike, the last of whom is the fittest, and an odd one.
    fn first(weight: f32) -> usize {
        let mut settings = Settings::default();
        settings.evolution.population = 4;
        settings.evolution.novelty = NoveltySettings {
            weight,
            neighbours: 2,
            remembered: 1,
            archive_limit: 2,
            ..NoveltySettings::default()
        };
        let mut search = Novelty::new(&RunPlan::new("test", 1, settings));
        let asked = search.breeder.generation();
        let genomes = search.ask();
        let evaluations = [
            evaluation(0.0, 0.2),
            evaluation(-6.0, 0.9),
            evaluation(0.1, 0.2),
            evaluation(0.2, 0.2),
        ];
        search.tell(&genomes, &evaluations);
        assert_eq!(search.archive.len(), 1);
        search.tell(&genomes, &evaluations);
        search.tell(&genomes, &evaluations);
        assert_eq!(search.archive.len(), 2, "no more than its limit");
        let mut search = Novelty { archive: Vec::new(), ..search };
        search.breeder = Breeder::new(&RunPlan::new("test", 1, {
            let mut settings = Settings::default();
            settings.evolution.population = 4;
            settings
        }));
        search.tell(&genomes, &evaluations);
        let StrategyState::Points(points) = search.state() else { panic!("another state") };
        let PointState::Novelty(state) = *points else { panic!("another state") };
        let text = serde_json::to_value(state.members).expect("plain data");
        let best = &text[0]["point"];
        let is_best = |member: &crate::evolve::ga::Member| serde_json::json!(member.point) == *best;
        asked.iter().position(is_best).expect("one of them")
    }

    #[test]
    fn pure_novelty_prefers_the_odd_one_and_none_at_all_the_fittest() {
        assert_eq!(first(1.0), 1);
        assert_eq!(first(0.0), 3);
    }
}
