//! MAP-Elites (Mouret and Clune, arXiv:1504.04909): an archive of the best of every kind of behaviour, and two
//! emitters that fill it: one that varies elites by normally distributed steps along the line to another (Vassiliades and
//! Mouret, GECCO 2018), and one that searches for improvements by CMA-ES (Fontaine and others, GECCO 2020).

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};

use super::cma::{Cma, RankedCandidate};
use super::cma_es::covariance_shape;
use super::search::Search;
use crate::check::{Invalid, within};
use crate::evolve::archives::{Addition, Archive, ArchiveAxis, Elite, EliteGenes};
use crate::evolve::parents::{IndividualId, Parents};
use crate::evolve::plan::RunPlan;
use crate::evolve::settings::MapElitesSettings;
use crate::evolve::strategy::{Strategy, StrategyState};
use crate::genome::Genome;
use crate::rng::{Purpose, normal};
use crate::score::Evaluation;

/// The state of MAP-Elites.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct MapElitesState {
    /// The elites with the numbers of their cells.
    elites: Vec<(u32, Elite<Vec<f64>>)>,
    /// The CMA-ES emitter, while one is active.
    emitter: Option<Cma>,
}

/// MAP-Elites.
#[derive(Debug, Clone)]
pub struct MapElites {
    settings: MapElitesSettings,
    search: Search,
    archive: Archive<Vec<f64>>,
    emitter: Option<Cma>,
    start_y_m: f32,
}

impl MapElites {
    /// Number of individuals in a generation that the CMA-ES emitter makes. It needs at least four.
    fn emitter_population(&self) -> usize {
        let wanted = self.search.population as f64 * f64::from(self.settings.cma_share);
        if wanted < 4.0 { 0 } else { wanted as usize }
    }

    /// The cell of an agent; none if it was disqualified.
    fn cell(&self, evaluation: &Evaluation) -> Option<u32> {
        if evaluation.disqualified.is_some() {
            return None;
        }
        let [x, y] = [self.settings.x, self.settings.y]
            .map(|descriptor| descriptor.value(evaluation, self.start_y_m));
        Some(self.archive.cell([x?, y?]))
    }

    fn points(&self) -> Vec<Vec<f64>> {
        let mut points = match &self.emitter {
            Some(cma) => {
                cma.candidates(|index| self.search.stream(index as usize, Purpose::Sample))
            }
            None => Vec::new(),
        };
        let elites: Vec<&Elite<Vec<f64>>> = self.archive.elites().map(|(_, elite)| elite).collect();
        while points.len() < self.search.population {
            let individual = points.len();
            points.push(if elites.is_empty() {
                self.search.first_point(individual, self.settings.step.into())
            } else {
                self.varied(individual, &elites)
            });
        }
        points
    }

    /// Chooses the elite that is varied and the one that it moves towards. Returns their indices, and the stream from
    /// which the random numbers continue.
    fn chosen(&self, individual: usize, elites: usize) -> (usize, usize, ChaCha8Rng) {
        let mut rng = self.search.stream(individual, Purpose::Mutation);
        let parent = rng.random_range(0..elites);
        let other = rng.random_range(0..elites);
        (parent, other, rng)
    }

    /// An elite, moved by a normally distributed step in every gene and along the line to another elite.
    fn varied(&self, individual: usize, elites: &[&Elite<Vec<f64>>]) -> Vec<f64> {
        let (parent, other, mut rng) = self.chosen(individual, elites.len());
        let (parent, other) = (elites[parent], elites[other]);
        let along = f64::from(self.settings.line) * normal(&mut rng);
        let step = f64::from(self.settings.step);
        let pairs = parent.genes.iter().zip(&other.genes);
        pairs.map(|(x, to)| x + step * normal(&mut rng) + along * (to - x)).collect()
    }

    /// Lets the emitter learn: individuals that filled an empty cell rank first, then those that improved one, then the
    /// others. If there was no progress, or its search has ended, it begins again at another elite.
    fn teach(&mut self, points: &[Vec<f64>], evaluations: &[Evaluation], additions: &[Addition]) {
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
            // There are no values by which to judge the end of a search: distinct ones never end it.
            let ranked: Vec<RankedCandidate> = order
                .iter()
                .enumerate()
                .map(|(rank, &index)| {
                    let value = (share - rank) as f64 + f64::from(cma.iteration());
                    RankedCandidate { point: &points[index], value }
                })
                .collect();
            let is_fruitless = additions[..share].iter().all(|a| *a == Addition::None);
            has_ended = cma.update(&ranked).is_err() || cma.stop().is_some() || is_fruitless;
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
        let shape = covariance_shape(self.search.dimension);
        // The check of the settings excludes errors. Without this emitter the other makes all individuals.
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
            search.search.check(emitter.mean())?;
            for (field, step) in
                [("emitter.step", emitter.step()), ("emitter.initial_step", emitter.initial_step())]
            {
                within(field, step, 0.0..=1.0e6)?;
            }
            let expected = search.emitter_population();
            within("emitter.population", emitter.population() as usize, expected..=expected)?;
        }
        search.emitter = emitter;
        Ok(search)
    }

    fn ask(&self) -> Vec<Genome> {
        self.search.with_founder_first(self.search.genomes(&self.points()))
    }

    fn population(&self) -> usize {
        self.search.population
    }

    fn tell(&mut self, _: &[Genome], evaluations: &[Evaluation]) {
        let points = self.points();
        let add = |(index, (point, evaluation)): (usize, (&Vec<f64>, &Evaluation))| {
            let Some(cell) = self.cell(evaluation) else {
                return Addition::None;
            };
            let elite = Elite {
                fitness: evaluation.fitness,
                generation: self.search.generation,
                individual: index as u32,
                // Inside the cube lines between elites are short.
                genes: self.search.folded(point),
            };
            self.archive.add(cell, elite)
        };
        let additions: Vec<Addition> =
            points.iter().zip(evaluations).enumerate().map(add).collect();
        self.teach(&points, evaluations, &additions);
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
        // An emitter of another size cannot learn from this generation. It begins again after the next.
        self.emitter.take_if(|emitter| emitter.population() as usize != share);
    }

    fn parents(&self) -> Vec<Parents> {
        let elites = self.parent_pool();
        let drawn = self.emitter.as_ref().map_or(0, |emitter| emitter.population() as usize);
        let of = |individual| {
            if individual < drawn {
                return Parents::Distribution;
            }
            if elites.is_empty() {
                return Parents::None;
            }
            let (parent, other, _) = self.chosen(individual, elites.len());
            if parent == other || self.settings.line == 0.0 {
                return Parents::One(elites[parent]);
            }
            Parents::Two(elites[parent], elites[other])
        };
        (0..self.search.population).map(of).collect()
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
        let genomes = search.ask();
        assert_eq!(search.parents(), [Parents::None; 12]);
        let evaluations: Vec<Evaluation> = (0..12)
            .map(|index| Evaluation {
                behaviour: Some(Behaviour {
                    contact_duty: index as f32 / 12.0,
                    ..Behaviour::default()
                }),
                ..Evaluation::of_fitness(index as f32)
            })
            .collect();
        search.tell(&genomes, &evaluations);
        assert!(search.parent_pool().len() > 3, "several cells");
        let parents = search.parents();
        assert!(parents.iter().any(|parents| matches!(parents, Parents::Two(..))));
        search.settings.line = 0.0;
        for (child, parents) in search.ask().iter().zip(search.parents()) {
            let Parents::One(parent) = parents else { panic!("{parents:?}") };
            let point = search.search.folded(&search.search.point_of(child));
            let elite = &genomes[parent.individual as usize];
            let off = point.iter().zip(search.search.point_of(elite)).map(|(a, b)| (a - b).abs());
            assert!(off.fold(0.0, f64::max) < 1.0e-4, "genes differ from those of the parent");
        }
    }
}
