//! MAP-Elites (Mouret and Clune, arXiv:1504.04909): an archive of the best individual of every kind of behaviour, filled by two emitters.
//! One moves elites by normally distributed steps along the line to another elite (Vassiliades and Mouret, GECCO 2018); the other searches
//! for improvements by CMA-ES (Fontaine and others, GECCO 2020).

use rand::RngExt;
use serde::{Deserialize, Serialize};

use super::cma::{Cma, RankedCandidate};
use super::cma_es::covariance_shape;
use super::search::Search;
use crate::check::{Invalid, within};
use crate::evolve::archives::{Addition, Archive, ArchiveAxis, Elite, EliteGenes};
use crate::evolve::candidate::Candidate;
use crate::evolve::parents::{IndividualId, Parents};
use crate::evolve::plan::RunPlan;
use crate::evolve::settings::MapElitesSettings;
use crate::evolve::strategy::{Strategy, StrategyState};
use crate::rng::{Purpose, normal};
use crate::score::Evaluation;

/// State of MAP-Elites, as checkpoints have it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct MapElitesState {
    /// Elites with the numbers of their cells.
    elites: Vec<(u32, Elite<Vec<f64>>)>,
    /// The CMA-ES emitter. None while it is not active.
    emitter: Option<Cma>,
}

/// MAP-Elites over two descriptors of behaviour.
#[derive(Debug, Clone)]
pub struct MapElites {
    settings: MapElitesSettings,
    search: Search,
    archive: Archive<Vec<f64>>,
    emitter: Option<Cma>,
    start_y_m: f32,
}

impl MapElites {
    /// Returns the number of individuals in a generation that the CMA-ES emitter makes: at least 4, or 0 if its share is smaller.
    fn emitter_population(&self) -> usize {
        let wanted = self.search.population as f64 * f64::from(self.settings.cma_share);
        if wanted < 4.0 { 0 } else { wanted as usize }
    }

    /// Returns the cell of the archive to which an evaluation belongs. None if the agent was disqualified, or not observed.
    fn cell(&self, evaluation: &Evaluation) -> Option<u32> {
        if evaluation.disqualified.is_some() {
            return None;
        }
        let [x, y] = [self.settings.x, self.settings.y]
            .map(|descriptor| descriptor.value(evaluation, self.start_y_m));
        Some(self.archive.cell([x?, y?]))
    }

    /// Makes a candidate from an elite, moved by a normally distributed step in every gene and along the line to another elite.
    fn varied(&self, individual: usize, elites: &[&Elite<Vec<f64>>]) -> Candidate {
        let mut rng = self.search.stream(individual, Purpose::Mutation);
        let parent = rng.random_range(0..elites.len());
        let other = rng.random_range(0..elites.len());
        let has_one = parent == other || self.settings.line == 0.0;
        let (parent, other) = (elites[parent], elites[other]);
        let along = f64::from(self.settings.line) * normal(&mut rng);
        let step = f64::from(self.settings.step);
        let pairs = parent.genes.iter().zip(&other.genes);
        let point = pairs.map(|(x, to)| x + step * normal(&mut rng) + along * (to - x)).collect();
        let parents = match has_one {
            true => Parents::One(parent.id()),
            false => Parents::Two(parent.id(), other.id()),
        };
        self.search.candidate(point, parents)
    }

    /// Updates the CMA-ES emitter. Individuals that filled an empty cell rank first, then those that improved a cell, then the others. If
    /// no individual was added, or the emitter's search has ended, the emitter begins again at another elite.
    fn teach(
        &mut self,
        candidates: &[Candidate],
        evaluations: &[Evaluation],
        additions: &[Addition],
    ) {
        let share = self.emitter_population();
        let mut has_ended = true;
        if let Some(cma) = &mut self.emitter {
            let worth = |index: usize| match additions[index] {
                Addition::New => (2, f64::from(evaluations[index].fitness)),
                Addition::Better(by) => (1, f64::from(by)),
                Addition::None if evaluations[index].disqualified.is_some() => {
                    (-1, f64::from(evaluations[index].steps))
                }
                Addition::None => (0, f64::from(evaluations[index].fitness)),
            };
            let mut order: Vec<usize> = (0..share).collect();
            order.sort_by(|&a, &b| {
                let ((class_a, worth_a), (class_b, worth_b)) = (worth(a), worth(b));
                class_b.cmp(&class_a).then(worth_b.total_cmp(&worth_a))
            });
            // The values are made up from ranks and iterations. As they differ and rise, the criteria that compare values never end the
            // search.
            let ranked: Vec<RankedCandidate> = order
                .iter()
                .enumerate()
                .map(|(rank, &index)| {
                    let value = (share - rank) as f64 + f64::from(cma.iteration);
                    RankedCandidate { point: &candidates[index].heritage.point, value }
                })
                .collect();
            let is_fruitless = additions[..share].iter().all(|a| *a == Addition::None);
            has_ended = cma.update(&ranked).is_err() || cma.stop.is_some() || is_fruitless;
        }
        if has_ended {
            self.emitter = self.new_emitter();
        }
    }

    fn new_emitter(&self) -> Option<Cma> {
        let population = self.emitter_population();
        let elites: Vec<&Elite<Vec<f64>>> = self.archive.elites().map(|(_, elite)| elite).collect();
        if population == 0 || elites.is_empty() {
            return None;
        }
        let mut rng = self.search.stream(0, Purpose::Restart);
        let start = elites[rng.random_range(0..elites.len())].genes.clone();
        let shape = covariance_shape(self.search.dimension());
        // The check of the settings excludes errors. If there were one, the other emitter would make all individuals.
        Cma::new(start, self.settings.cma_step.into(), population as u32, shape, true).ok()
    }
}

impl Strategy for MapElites {
    fn begin(plan: &RunPlan) -> Self {
        let settings = plan.settings.evolution.map_elites.clone();
        let trial = &plan.settings.trial;
        let floor = trial.resting_fitness();
        let axis = |descriptor| ArchiveAxis::of(descriptor, settings.cells);
        Self {
            archive: Archive::new(axis(settings.x), axis(settings.y), floor),
            settings,
            search: Search::new(plan, 0),
            emitter: None,
            start_y_m: trial.start_y_m,
        }
    }

    fn resume(plan: &RunPlan, finished: u32, state: &StrategyState) -> Result<Self, Invalid> {
        let MapElitesState { elites, emitter } = state.read()?;
        let mut search = Self { search: Search::new(plan, finished), ..Self::begin(plan) };
        for (_, elite) in &elites {
            search.search.check(&elite.genes)?;
        }
        search.archive.restore(elites)?;
        if let Some(emitter) = &emitter {
            emitter.check().map_err(|error| error.inside("emitter"))?;
            search.search.check(&emitter.mean)?;
            within("emitter.step", emitter.step, 0.0..=1.0e6)?;
            within("emitter.initial_step", emitter.initial_step, 0.0..=1.0e6)?;
            let expected = search.emitter_population();
            within("emitter.population", emitter.population as usize, expected..=expected)?;
        }
        search.emitter = emitter;
        Ok(search)
    }

    fn ask(&self) -> Vec<Candidate> {
        let mut candidates = match &self.emitter {
            Some(cma) => self.search.sampled(|random| cma.candidates(random)),
            None => Vec::new(),
        };
        let elites: Vec<&Elite<Vec<f64>>> = self.archive.elites().map(|(_, elite)| elite).collect();
        while candidates.len() < self.search.population {
            let individual = candidates.len();
            candidates.push(if elites.is_empty() {
                let point = self.search.first_point(individual, self.settings.step.into());
                self.search.candidate(point, Parents::None)
            } else {
                self.varied(individual, &elites)
            });
        }
        self.search.with_founder_first(candidates)
    }

    fn population(&self) -> usize {
        self.search.population
    }

    fn tell(&mut self, candidates: &[Candidate], evaluations: &[Evaluation]) {
        let add = |(index, (candidate, evaluation)): (usize, (&Candidate, &Evaluation))| {
            let Some(cell) = self.cell(evaluation) else {
                return Addition::None;
            };
            let elite = Elite {
                fitness: evaluation.fitness,
                generation: self.search.generation,
                individual: index as u32,
                // The point is folded into the unit cube, where lines between elites are short.
                genes: self.search.space.wrapped(&candidate.heritage.point, self.search.shape),
            };
            self.archive.add(cell, elite)
        };
        let additions: Vec<Addition> =
            candidates.iter().zip(evaluations).enumerate().map(add).collect();
        self.teach(candidates, evaluations, &additions);
        self.search.generation += 1;
    }

    fn state(&self) -> StrategyState {
        let elites = self.archive.elites().map(|(cell, elite)| (cell, elite.clone())).collect();
        let emitter = self.emitter.clone();
        StrategyState::of(&MapElitesState { elites, emitter })
    }

    fn apply_settings(&mut self, plan: &RunPlan) {
        self.settings = plan.settings.evolution.map_elites.clone();
        self.search.apply_settings(plan);
        let share = self.emitter_population();
        // An emitter with another population cannot learn from the present generation. A new emitter begins after the next.
        self.emitter.take_if(|emitter| emitter.population as usize != share);
    }

    fn parent_pool(&self) -> Vec<IndividualId> {
        self.archive.elites().map(|(_, elite)| elite.id()).collect()
    }

    fn archive(&self) -> Option<Archive> {
        Some(self.archive.copy_with(|point| EliteGenes::Point(point.clone())))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::{Descriptor, Settings};
    use crate::score::Behaviour;

    #[test]
    fn without_a_step_children_equal_their_recorded_parents() {
        let mut settings = Settings::default();
        settings.evolution.population = 12;
        settings.trial.duration_s = 1.0;
        settings.evolution.map_elites = MapElitesSettings {
            x: Descriptor::BodyHeight,
            y: Descriptor::ContactDuty,
            step: 0.0,
            cma_share: 0.0,
            ..MapElitesSettings::default()
        };
        let mut search = MapElites::begin(&RunPlan::new("test", 1, settings));
        let asked = search.ask();
        assert!(asked.iter().all(|of| of.parents == Parents::None));
        let evaluations: Vec<Evaluation> = (0..12)
            .map(|index| Evaluation {
                behaviour: Some(Behaviour {
                    contact_duty: index as f32 / 12.0,
                    ..Behaviour::default()
                }),
                ..Evaluation::of_fitness(index as f32)
            })
            .collect();
        search.tell(&asked, &evaluations);
        assert!(search.parent_pool().len() > 3, "several cells");
        assert!(search.ask().iter().any(|of| matches!(of.parents, Parents::Two(..))));
        search.settings.line = 0.0;
        for child in search.ask() {
            let Parents::One(parent) = child.parents else { panic!("{:?}", child.parents) };
            let Search { space, shape, .. } = &search.search;
            let point = space.wrapped(&space.point_of(&child.genome), *shape);
            let elite = &asked[parent.individual as usize].genome;
            let off = point.iter().zip(space.point_of(elite)).map(|(a, b)| (a - b).abs());
            assert!(off.fold(0.0, f64::max) < 1.0e-4, "genes differ from those of the parent");
        }
    }
}
