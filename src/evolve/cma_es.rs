//! CMA-ES as a strategy: what [`super::cma`] samples, as genomes.

use serde::{Deserialize, Serialize};

use super::cma::{Ranked, Shape};
use super::restarts::{CmaSettings, RestartKind, Restarting};
use super::search::Search;
use super::{Parents, PointState, RunPlan, Strategy, StrategyState, full_ranking};
use crate::check::{Invalid, within};
use crate::genome::Genome;
use crate::rng::Purpose;
use crate::score::Evaluation;

/// Settings of CMA-ES.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CmaEsSettings {
    /// Standard deviation of the first generation, as a share of each gene's range.
    pub step: f32,
    /// Whether bad individuals count too, by making their directions less likely.
    pub active: bool,
    /// What happens when a search has come to its end.
    pub restarts: RestartKind,
    /// Whether a search begins at the best of that many newborns instead of the middle of all ranges. They are a
    /// generation of their own. 0: in the middle.
    pub newborns: u32,
}

impl Default for CmaEsSettings {
    fn default() -> Self {
        Self { step: 0.3, active: true, restarts: RestartKind::Bipop, newborns: 0 }
    }
}

impl CmaEsSettings {
    /// Checks every field against its range.
    pub fn check(&self) -> Result<(), Invalid> {
        within("step", self.step, 1.0e-6..=10.0)?;
        // They are a generation of their own, which the budget may not have foreseen.
        within("newborns", self.newborns, 0..=10_000)
    }
}

/// Spaces of more dimensions are searched without dependences between genes: learning them would take longer
/// than any run, and their number is the square of the dimension.
const LARGEST_FULL_DIMENSION: usize = 100;

/// What CMA-ES knows. None: nothing yet, the newborns come first.
pub type CmaEsState = Option<Restarting>;

/// CMA-ES at work.
#[derive(Debug, Clone)]
pub struct CmaEs {
    settings: CmaEsSettings,
    search: Search,
    state: CmaEsState,
}

/// The covariance's shape in a space.
pub fn shape(dimension: usize) -> Shape {
    if dimension <= LARGEST_FULL_DIMENSION { Shape::Full } else { Shape::Diagonal }
}

impl CmaEs {
    /// A fresh search. A founder is where its mean begins, in the place of the best newborn.
    pub fn new(plan: &RunPlan) -> Self {
        let settings = Self::settings(plan);
        let mut fresh = Self { settings, search: Search::new(plan, 0), state: None };
        match fresh.search.founder().map(<[f64]>::to_vec) {
            Some(founder) => fresh.start(founder),
            None if fresh.settings.newborns == 0 => fresh.start(vec![0.5; fresh.search.dimension]),
            None => {}
        }
        fresh
    }

    /// A search that goes on.
    pub fn resumed(plan: &RunPlan, finished: u32, state: CmaEsState) -> Result<Self, Invalid> {
        let settings = Self::settings(plan);
        let resumed = Self { settings, search: Search::new(plan, finished), state };
        if let Some(runs) = &resumed.state {
            runs.check()?;
            resumed.search.check(runs.current().mean())?;
            if *runs.settings() != resumed.run_settings() {
                let allowed = "those of the run";
                return Err(Invalid::new("settings", "others", allowed));
            }
            let most = u64::from(plan.settings.evolution.population) << 9;
            within("population", u64::from(runs.population()), 2..=most)?;
            // Steps that long have left every range behind them.
            within("step", runs.current().step(), 0.0..=1.0e6)?;
        }
        Ok(resumed)
    }

    /// The settings of a run: newborns never take more than a quarter of what it may cost.
    fn settings(plan: &RunPlan) -> CmaEsSettings {
        let evolution = &plan.settings.evolution;
        let most = u32::try_from(evolution.budget() / 4).unwrap_or(u32::MAX);
        let newborns = evolution.cma_es.newborns.min(most);
        CmaEsSettings { newborns, ..evolution.cma_es.clone() }
    }

    /// How its searches begin.
    fn run_settings(&self) -> CmaSettings {
        CmaSettings {
            step: self.settings.step.into(),
            population: u32::try_from(self.search.population).unwrap_or(u32::MAX).max(2),
            shape: shape(self.search.dimension),
            active: self.settings.active,
            restart: self.settings.restarts,
        }
    }

    fn start(&mut self, mean: Vec<f64>) {
        // The settings' check has ruled errors out; without a start newborns are all there is.
        self.state = Restarting::new(self.run_settings(), mean).ok();
        debug_assert!(self.state.is_some(), "the settings were checked");
    }

    fn points(&self) -> Vec<Vec<f64>> {
        match &self.state {
            Some(runs) => {
                runs.candidates(|index| self.search.stream(index as usize, Purpose::Sample))
            }
            None => (0..self.population()).map(|i| self.search.newborn_point(i)).collect(),
        }
    }
}

impl Strategy for CmaEs {
    fn ask(&self) -> Vec<Genome> {
        self.search.genomes(&self.points())
    }

    fn population(&self) -> usize {
        let newborns = self.settings.newborns.max(1) as usize;
        self.state.as_ref().map_or(newborns, |runs| runs.population() as usize)
    }

    fn tell(&mut self, _: &[Genome], evaluations: &[Evaluation]) {
        let points = self.points();
        let order = full_ranking(evaluations);
        match &mut self.state {
            Some(runs) => {
                // A disqualified agent has no fitness; whoever is ranked behind is worth no more.
                let mut least = f64::INFINITY;
                let ranked: Vec<Ranked> = order
                    .iter()
                    .map(|&index| {
                        let evaluation = &evaluations[index];
                        if evaluation.disqualified.is_none() {
                            least = least.min(f64::from(evaluation.fitness));
                        }
                        let value = if least.is_finite() { least } else { 0.0 };
                        Ranked { point: &points[index], value }
                    })
                    .collect();
                let mut rng = self.search.stream(0, Purpose::Restart);
                // All candidates are there; if one is not finite, the search has nothing left to learn.
                let _ = runs.update(&ranked, &mut rng);
            }
            None => {
                let best = order.first().and_then(|&index| points.get(index).cloned());
                self.start(best.unwrap_or_else(|| vec![0.5; self.search.dimension]));
            }
        }
        self.search.generation += 1;
    }

    fn state(&self) -> StrategyState {
        StrategyState::points(PointState::CmaEs(self.state.clone()))
    }

    fn amend(&mut self, plan: &RunPlan) {
        // What it has learned depends on nothing that may change.
        self.settings = Self::settings(plan);
    }

    fn parents(&self) -> Vec<Parents> {
        let is_learned = self.state.is_some();
        let parents = if is_learned { Parents::Distribution } else { Parents::Newborn };
        vec![parents; self.population()]
    }
}
