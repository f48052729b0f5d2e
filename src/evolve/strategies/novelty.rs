//! Novelty search: unseen behaviour is rewarded (Lehman and Stanley, Evolutionary Computation 19 (2011)), to a
//! configurable share beside fitness.

use rand::RngExt;
use serde::{Deserialize, Serialize};

use super::ga::{Ga, GaMember};
use crate::check::{Invalid, within};
use crate::evolve::archives::Descriptor;
use crate::evolve::parents::{IndividualId, Parents};
use crate::evolve::plan::RunPlan;
use crate::evolve::settings::NoveltySettings;
use crate::evolve::strategy::{Strategy, StrategyState, full_ranking};
use crate::genome::Genome;
use crate::rng::Purpose;
use crate::score::Evaluation;
use crate::world::Stairs;

/// A behaviour as a point: the final position of the agent and its two descriptors, each from 0 to 1.
type BehaviourPoint = [f64; 3];

/// The state of novelty search.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct NoveltyState {
    /// The last generation, best first.
    members: Vec<GaMember>,
    /// The archived behaviours.
    archive: Vec<BehaviourPoint>,
}

/// Novelty search: a genetic algorithm with another order of the best.
#[derive(Debug, Clone)]
pub struct Novelty {
    settings: NoveltySettings,
    ga: Ga,
    archive: Vec<BehaviourPoint>,
    start_y_m: f32,
    stairs: Stairs,
}

impl Novelty {
    fn with(plan: &RunPlan, ga: Ga, archive: Vec<BehaviourPoint>) -> Self {
        let trial = &plan.settings.trial;
        Self {
            settings: plan.settings.evolution.novelty.clone(),
            ga,
            archive,
            start_y_m: trial.start_y_m,
            stairs: trial.stairs.clone(),
        }
    }

    /// The behaviour of an agent; none if it was disqualified.
    fn behaviour(&self, evaluation: &Evaluation) -> Option<BehaviourPoint> {
        if evaluation.disqualified.is_some() {
            return None;
        }
        let share = |descriptor: Descriptor| {
            descriptor.value(evaluation, self.start_y_m).map_or(0.0, |x| descriptor.share(x))
        };
        // The axis reaches as far behind the start as the end of the landing is ahead of it.
        let reach_m = f64::from(self.stairs.end_y_m() - self.start_y_m).abs().max(1.0);
        let progress_m = f64::from(evaluation.centre_y_m - self.start_y_m);
        let end = (0.5 + progress_m / (2.0 * reach_m)).clamp(0.0, 1.0);
        let [first, second] = [self.settings.first, self.settings.second].map(share);
        Some([end, first, second])
    }

    /// Mean distance of each behaviour to its nearest neighbours among all of them and the archive. Individuals without
    /// a behaviour are the least novel.
    fn novelties(&self, behaviours: &[Option<BehaviourPoint>]) -> Vec<f64> {
        let novelty = |(index, behaviour): (usize, &Option<BehaviourPoint>)| {
            let Some(behaviour) = behaviour else { return f64::NEG_INFINITY };
            let others = behaviours.iter().enumerate().filter(|(other, _)| *other != index);
            let all = others.filter_map(|(_, other)| other.as_ref()).chain(&self.archive);
            let mut distances: Vec<f64> = all.map(|other| distance(behaviour, other)).collect();
            let neighbours = self.settings.neighbours as usize;
            if neighbours < distances.len() {
                distances.select_nth_unstable_by(neighbours, f64::total_cmp);
                distances.truncate(neighbours);
            }
            distances.sort_by(f64::total_cmp);
            distances.iter().sum::<f64>() / distances.len().max(1) as f64
        };
        behaviours.iter().enumerate().map(novelty).collect()
    }

    /// Adds some behaviours, chosen at random, to the archive.
    fn remember(&mut self, behaviours: &[Option<BehaviourPoint>]) {
        let mut rng = self.ga.search.stream(0, Purpose::Archive);
        let mut candidates: Vec<BehaviourPoint> = behaviours.iter().flatten().copied().collect();
        for _ in 0..self.settings.remembered {
            if candidates.is_empty() {
                break;
            }
            let behaviour = candidates.swap_remove(rng.random_range(0..candidates.len()));
            if self.archive.len() < self.settings.archive_limit as usize {
                self.archive.push(behaviour);
            } else {
                let index = rng.random_range(0..self.archive.len());
                self.archive[index] = behaviour;
            }
        }
    }
}

fn distance(a: &BehaviourPoint, b: &BehaviourPoint) -> f64 {
    a.iter().zip(b).map(|(x, y)| (x - y) * (x - y)).sum::<f64>().sqrt()
}

/// The rank of each index in an order: 0 is the first.
fn ranks_in(order: &[usize]) -> Vec<f64> {
    let mut ranks = vec![0.0; order.len()];
    for (rank, &index) in order.iter().enumerate() {
        ranks[index] = rank as f64;
    }
    ranks
}

impl Strategy for Novelty {
    fn begin(plan: &RunPlan) -> Self {
        Self::with(plan, Ga::begin(plan), Vec::new())
    }

    fn resume(plan: &RunPlan, finished: u32, state: &StrategyState) -> Result<Self, Invalid> {
        let NoveltyState { members, archive } = state.read()?;
        let most = plan.settings.evolution.novelty.archive_limit as usize;
        within("archive", archive.len(), 0..=most)?;
        archive.iter().flatten().try_for_each(|&x| within("archive", x, 0.0..=1.0))?;
        Ok(Self::with(plan, Ga::resume_with(plan, finished, members)?, archive))
    }

    fn ask(&self) -> Vec<Genome> {
        self.ga.ask()
    }

    fn population(&self) -> usize {
        self.ga.population()
    }

    /// Mixes ranks, because novelty and fitness have no common unit.
    fn tell(&mut self, _: &[Genome], evaluations: &[Evaluation]) {
        let behaviours: Vec<Option<BehaviourPoint>> =
            evaluations.iter().map(|evaluation| self.behaviour(evaluation)).collect();
        let novelties = self.novelties(&behaviours);
        let mut by_novelty: Vec<usize> = (0..evaluations.len()).collect();
        by_novelty.sort_by(|&a, &b| novelties[b].total_cmp(&novelties[a]));
        let (by_fitness, by_novelty) =
            (ranks_in(&full_ranking(evaluations)), ranks_in(&by_novelty));
        let weight = f64::from(self.settings.weight);
        let mixed: Vec<f64> = by_fitness
            .iter()
            .zip(&by_novelty)
            .map(|(fitness, novelty)| (1.0 - weight) * fitness + weight * novelty)
            .collect();
        let mut order: Vec<usize> = (0..evaluations.len()).collect();
        order.sort_by(|&a, &b| mixed[a].total_cmp(&mixed[b]));
        self.remember(&behaviours);
        self.ga.select(&order);
    }

    fn state(&self) -> StrategyState {
        let (members, archive) = (self.ga.members().to_vec(), self.archive.clone());
        StrategyState::of(&NoveltyState { members, archive })
    }

    fn apply_settings(&mut self, plan: &RunPlan) {
        self.settings = plan.settings.evolution.novelty.clone();
        self.archive.truncate(self.settings.archive_limit as usize);
        self.ga.apply_settings(plan);
    }

    fn parents(&self) -> Vec<Parents> {
        self.ga.parents()
    }

    fn parent_pool(&self) -> Vec<IndividualId> {
        self.ga.parent_pool()
    }

    fn restore_parents(&mut self, pool: &[IndividualId]) {
        self.ga.restore_parents(pool);
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

    /// The index of the best of four: three behave alike, the last of them is the fittest, and number 1 is different.
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
        let mut search = Novelty::begin(&RunPlan::new("test", 1, settings));
        let asked = search.ga.generation();
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
        assert_eq!(search.archive.len(), 2, "at most its limit");
        let mut fresh = Settings::default();
        fresh.evolution.population = 4;
        let ga = Ga::begin(&RunPlan::new("test", 1, fresh));
        let mut search = Novelty { archive: Vec::new(), ga, ..search };
        search.tell(&genomes, &evaluations);
        let best = &search.ga.members()[0];
        asked.iter().position(|member| member == best).expect("one of them")
    }

    #[test]
    fn pure_novelty_prefers_unusual_behaviour_and_weight_zero_the_fittest() {
        assert_eq!(first(1.0), 1);
        assert_eq!(first(0.0), 3);
    }
}
