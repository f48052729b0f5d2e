//! Novelty search: new behaviour is rewarded (Lehman and Stanley, Evolutionary Computation 19 (2011)), in any proportion to fitness.

use rand::RngExt;
use serde::{Deserialize, Serialize};

use super::breeder::{BehaviourPoint, Breeder};
use crate::check::{Invalid, within};
use crate::evolve::archives::Descriptor;
use crate::evolve::candidate::Candidate;
use crate::evolve::parents::IndividualId;
use crate::evolve::plan::RunPlan;
use crate::evolve::settings::NoveltySettings;
use crate::evolve::strategy::{Strategy, StrategyState, full_ranking};
use crate::genome::BodySpace;
use crate::rng::Purpose;
use crate::score::Evaluation;
use crate::world::Stairs;

/// State of novelty search, as checkpoints have it.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct NoveltyState<M, P> {
    /// Members of the last generation, best first.
    members: Vec<M>,
    /// Points of the archive.
    archive: Vec<P>,
}

/// Novelty search: a genetic algorithm whose individuals are ranked by novelty and fitness.
#[derive(Debug, Clone)]
pub struct Novelty<B: Breeder> {
    settings: NoveltySettings,
    breeder: B,
    archive: Vec<B::Point>,
    start_y_m: f32,
    stairs: Stairs,
    bodies: BodySpace,
}

impl<B: Breeder> Novelty<B> {
    fn with(plan: &RunPlan, breeder: B, archive: Vec<B::Point>) -> Self {
        let trial = &plan.settings.trial;
        Self {
            settings: plan.settings.evolution.novelty.clone(),
            breeder,
            archive,
            start_y_m: trial.start_y_m,
            stairs: trial.stairs.clone(),
            bodies: plan.settings.genome.bodies.clone(),
        }
    }

    /// Returns the behaviour of an agent. None if the agent was disqualified.
    fn behaviour(&self, evaluation: &Evaluation) -> Option<BehaviourPoint> {
        if evaluation.disqualified.is_some() {
            return None;
        }
        let share = |descriptor: Descriptor| {
            descriptor.value(evaluation, self.start_y_m).map_or(0.0, |x| descriptor.share(x))
        };
        // The axis of the final position reaches as far behind the start as the end of the landing lies ahead.
        let reach_m = f64::from(self.stairs.end_y_m() - self.start_y_m).abs().max(1.0);
        let progress_m = f64::from(evaluation.centre_y_m - self.start_y_m);
        let end = (0.5 + progress_m / (2.0 * reach_m)).clamp(0.0, 1.0);
        let [first, second] = [self.settings.first, self.settings.second].map(share);
        Some([end, first, second])
    }

    /// Returns the mean distance of each point to its nearest neighbours among the other points and the archive. Individuals without a
    /// point are the least novel.
    fn novelties(&self, points: &[Option<B::Point>]) -> Vec<f64> {
        let novelty = |(index, point): (usize, &Option<B::Point>)| {
            let Some(point) = point else { return f64::NEG_INFINITY };
            let others = points.iter().enumerate().filter(|(other, _)| *other != index);
            let all = others.filter_map(|(_, other)| other.as_ref()).chain(&self.archive);
            let mut distances: Vec<f64> =
                all.map(|other| distance(point.as_ref(), other.as_ref())).collect();
            let neighbours = self.settings.neighbours as usize;
            if neighbours < distances.len() {
                distances.select_nth_unstable_by(neighbours, f64::total_cmp);
                distances.truncate(neighbours);
            }
            distances.sort_by(f64::total_cmp);
            distances.iter().sum::<f64>() / distances.len().max(1) as f64
        };
        points.iter().enumerate().map(novelty).collect()
    }

    /// Adds randomly chosen points of a generation to the archive.
    fn remember(&mut self, points: &[Option<B::Point>]) {
        let mut rng = self.breeder.stream(Purpose::Archive);
        let mut candidates: Vec<B::Point> = points.iter().flatten().copied().collect();
        for _ in 0..self.settings.remembered {
            if candidates.is_empty() {
                break;
            }
            let point = candidates.swap_remove(rng.random_range(0..candidates.len()));
            if self.archive.len() < self.settings.archive_limit as usize {
                self.archive.push(point);
            } else {
                let index = rng.random_range(0..self.archive.len());
                self.archive[index] = point;
            }
        }
    }
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| (x - y) * (x - y)).sum::<f64>().sqrt()
}

/// Returns the rank of each index in an order; the first has rank 0.
fn ranks_in(order: &[usize]) -> Vec<f64> {
    let mut ranks = vec![0.0; order.len()];
    for (rank, &index) in order.iter().enumerate() {
        ranks[index] = rank as f64;
    }
    ranks
}

impl<B: Breeder> Strategy for Novelty<B> {
    fn begin(plan: &RunPlan) -> Self {
        Self::with(plan, B::begin(plan), Vec::new())
    }

    fn resume(plan: &RunPlan, finished: u32, state: &StrategyState) -> Result<Self, Invalid> {
        let NoveltyState::<B::Member, B::Point> { members, archive } = state.read()?;
        let most = plan.settings.evolution.novelty.archive_limit as usize;
        within("archive", archive.len(), 0..=most)?;
        let coordinates = archive.iter().flat_map(AsRef::as_ref);
        coordinates.into_iter().try_for_each(|&x| within("archive", x, 0.0..=1.0))?;
        Ok(Self::with(plan, B::resume_with(plan, finished, members)?, archive))
    }

    fn ask(&self) -> Vec<Candidate> {
        self.breeder.ask()
    }

    fn population(&self) -> usize {
        self.breeder.population()
    }

    /// Ranks the individuals by a weighted sum of two ranks, because novelty and fitness have no common unit.
    fn tell(&mut self, candidates: &[Candidate], evaluations: &[Evaluation]) {
        let point = |(candidate, evaluation): (&Candidate, &Evaluation)| {
            Some(B::point(self.behaviour(evaluation)?, &candidate.genome, &self.bodies))
        };
        let points: Vec<Option<B::Point>> = candidates.iter().zip(evaluations).map(point).collect();
        let novelties = self.novelties(&points);
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
        self.remember(&points);
        self.breeder.select(candidates, &order);
    }

    fn state(&self) -> StrategyState {
        let (members, archive) = (self.breeder.members().to_vec(), self.archive.clone());
        StrategyState::of(&NoveltyState { members, archive })
    }

    fn apply_settings(&mut self, plan: &RunPlan) {
        self.settings = plan.settings.evolution.novelty.clone();
        self.archive.truncate(self.settings.archive_limit as usize);
        self.breeder.apply_settings(plan);
    }

    fn parent_pool(&self) -> Vec<IndividualId> {
        self.breeder.parent_pool()
    }

    fn restore_parents(&mut self, pool: &[IndividualId]) {
        self.breeder.restore_parents(pool);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::strategies::body_ga::BodyGa;
    use crate::evolve::strategies::fixtures;
    use crate::evolve::strategies::ga::Ga;
    use crate::evolve::{BodyProtection, Settings, StrategyKind};
    use crate::genome::Genome;
    use crate::score::Behaviour;

    fn evaluation(centre_y_m: f32, contact_duty: f32) -> Evaluation {
        let behaviour = Some(Behaviour { contact_duty, ..Behaviour::default() });
        Evaluation { behaviour, ..Evaluation::of_fitness(centre_y_m) }
    }

    /// Returns the index of the best of four individuals: three behave alike, the last of which is the fittest, and number 1 behaves
    /// differently.
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
        let mut search = Novelty::<Ga>::begin(&RunPlan::new("test", 1, settings));
        let asked = search.ask();
        let evaluations = [
            evaluation(0.0, 0.2),
            evaluation(-6.0, 0.9),
            evaluation(0.1, 0.2),
            evaluation(0.2, 0.2),
        ];
        search.tell(&asked, &evaluations);
        assert_eq!(search.archive.len(), 1);
        search.tell(&asked, &evaluations);
        search.tell(&asked, &evaluations);
        assert_eq!(search.archive.len(), 2, "at most its limit");
        let mut fresh = Settings::default();
        fresh.evolution.population = 4;
        let ga = Ga::begin(&RunPlan::new("test", 1, fresh));
        let mut search = Novelty { archive: Vec::new(), breeder: ga, ..search };
        search.tell(&asked, &evaluations);
        let best = &search.breeder.members()[0];
        asked.iter().position(|of| of.heritage.point == best.point).expect("one of them")
    }

    #[test]
    fn pure_novelty_prefers_unusual_behaviour_and_weight_zero_the_fittest() {
        assert_eq!(first(1.0), 1);
        assert_eq!(first(0.0), 3);
    }

    #[test]
    fn a_body_like_no_other_is_the_most_novel_among_equal_behaviours() {
        let plan = fixtures::plan(StrategyKind::BodyNovelty, |settings| {
            settings.evolution.population = 40;
            settings.evolution.novelty.weight = 1.0;
            settings.evolution.novelty.neighbours = 5;
            settings.evolution.body_ga.protection = BodyProtection::None;
        });
        let mut search = Novelty::<BodyGa>::begin(&plan);
        let mut asked = search.ask();
        let blocks = |of: &Candidate| of.genome.body.segments.len();
        let few = asked.iter().position(|of| blocks(of) == 2).expect("one in eleven");
        let many = asked.iter().position(|of| blocks(of) > 8).expect("several");
        let common = asked[many].clone();
        (0..asked.len()).filter(|index| *index != few).for_each(|index| {
            asked[index] = common.clone();
        });
        let point = |genome: &Genome| BodyGa::point([0.5; 3], genome, &search.bodies);
        let points = asked.iter().map(|of| point(&of.genome));
        let points: Vec<_> = points.collect();
        assert!(points.iter().flatten().all(|of| (0.0..=1.0).contains(of)));
        assert!(points[few][3] == 0.0 && points[many][3] >= 0.7, "{:?}", points[many]);
        let novelties = search.novelties(&points.into_iter().map(Some).collect::<Vec<_>>());
        let most = (0..40).max_by(|&a, &b| novelties[a].total_cmp(&novelties[b]));
        assert_eq!(most, Some(few));
        let evaluations = vec![evaluation(0.0, 0.2); 40];
        let wanted = search.ask()[few].genome.clone();
        search.tell(&asked, &evaluations);
        assert_eq!(search.ask()[0].genome, wanted, "kept unchanged");
        let state = search.state();
        let again = Novelty::<BodyGa>::resume(&plan, 1, &state).expect("its own");
        let genomes = |of: Vec<Candidate>| of.into_iter().map(|of| of.genome).collect::<Vec<_>>();
        assert_eq!(genomes(again.ask()), genomes(search.ask()));
    }
}
