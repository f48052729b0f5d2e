//! CMA-ES as a strategy: it makes genomes from the points that [`super::cma`] samples.

use super::cma::{CmaParameters, CovarianceShape, RankedCandidate, RestartedCma};
use super::search::{Search, check_point};
use crate::check::{Invalid, within};
use crate::evolve::candidate::Candidate;
use crate::evolve::parents::Parents;
use crate::evolve::plan::RunPlan;
use crate::evolve::settings::CmaEsSettings;
use crate::evolve::strategy::{Strategy, StrategyState, full_ranking};
use crate::rng::Purpose;
use crate::score::Evaluation;

/// Largest dimension with a full covariance. In larger spaces the covariance is diagonal, because a run is too short to learn all
/// dependences between genes.
const LARGEST_FULL_DIMENSION: usize = 100;

/// CMA-ES as a strategy.
#[derive(Debug, Clone)]
pub struct CmaEs {
    settings: CmaEsSettings,
    search: Search,
    /// State of CMA-ES with its restarts. None while the first generation, of random genomes, is pending.
    runs: Option<RestartedCma>,
}

/// Returns the shape of the covariance in a space of the given dimension.
pub fn covariance_shape(dimension: usize) -> CovarianceShape {
    if dimension <= LARGEST_FULL_DIMENSION {
        CovarianceShape::Full
    } else {
        CovarianceShape::Diagonal
    }
}

/// Checks a state of CMA-ES from a file, in a space of the given dimension.
///
/// # Errors
/// Fails if the state is damaged, or belongs to a search with other parameters.
pub fn check_runs(
    runs: &RestartedCma,
    parameters: &CmaParameters,
    dimension: usize,
) -> Result<(), Invalid> {
    runs.check()?;
    check_point(&runs.current.mean, dimension)?;
    if runs.parameters != *parameters {
        let value = "different from those of the run";
        return Err(Invalid::new("parameters", value, "the parameters of the run"));
    }
    let most = u64::from(parameters.population) << 9;
    within("population", u64::from(runs.current.population), 2..=most)?;
    // Larger steps lead far outside the ranges of all genes.
    within("step", runs.current.step, 0.0..=1.0e6)
}

/// Returns the points of candidates in an order, best first, each with its value.
pub fn ranked_candidates<'a>(
    candidates: &'a [Candidate],
    evaluations: &[Evaluation],
    order: &[usize],
) -> Vec<RankedCandidate<'a>> {
    // A disqualified agent has no fitness. Its value is the least value of the agents ranked before it.
    let mut least = f64::INFINITY;
    let ranked = |&index: &usize| {
        let evaluation = &evaluations[index];
        if evaluation.disqualified.is_none() {
            least = least.min(f64::from(evaluation.fitness));
        }
        let value = if least.is_finite() { least } else { 0.0 };
        RankedCandidate { point: &candidates[index].heritage.point, value }
    };
    order.iter().map(ranked).collect()
}

impl CmaEs {
    /// Returns the settings of a run, with random genomes limited to a quarter of its budget.
    fn settings(plan: &RunPlan) -> CmaEsSettings {
        let evolution = &plan.settings.evolution;
        let most = u32::try_from(evolution.budget() / 4).unwrap_or(u32::MAX);
        let newborns = evolution.cma_es.newborns.min(most);
        CmaEsSettings { newborns, ..evolution.cma_es.clone() }
    }

    fn parameters(&self) -> CmaParameters {
        CmaParameters {
            step: self.settings.step.into(),
            population: u32::try_from(self.search.population).unwrap_or(u32::MAX).max(2),
            shape: covariance_shape(self.search.dimension()),
            active: self.settings.active,
            restart: self.settings.restarts,
        }
    }

    fn start(&mut self, mean: Vec<f64>) {
        // The check of the settings excludes errors. If there were one, all genomes would be random.
        self.runs = RestartedCma::new(self.parameters(), mean).ok();
        debug_assert!(self.runs.is_some(), "the settings were checked");
    }
}

impl Strategy for CmaEs {
    /// Begins at the founder, if there is one. Otherwise the mean begins at the best of the random genomes, or in the middle of all ranges
    /// if the settings have no random genomes.
    fn begin(plan: &RunPlan) -> Self {
        let settings = Self::settings(plan);
        let mut search = Self { settings, search: Search::new(plan, 0), runs: None };
        match search.search.founder_point() {
            Some(founder) => search.start(founder),
            None if search.settings.newborns == 0 => {
                search.start(vec![0.5; search.search.dimension()]);
            }
            None => {}
        }
        search
    }

    fn resume(plan: &RunPlan, finished: u32, state: &StrategyState) -> Result<Self, Invalid> {
        let settings = Self::settings(plan);
        let resumed = Self { settings, search: Search::new(plan, finished), runs: state.read()? };
        if let Some(runs) = &resumed.runs {
            check_runs(runs, &resumed.parameters(), resumed.search.dimension())?;
        }
        Ok(resumed)
    }

    fn ask(&self) -> Vec<Candidate> {
        match &self.runs {
            Some(runs) => self.search.sampled(|random| runs.current.candidates(random)),
            None => {
                let point = |individual| self.search.random_genome_point(individual);
                let random = |individual| self.search.candidate(point(individual), Parents::None);
                (0..self.population()).map(random).collect()
            }
        }
    }

    fn population(&self) -> usize {
        let random = self.settings.newborns.max(1) as usize;
        self.runs.as_ref().map_or(random, |runs| runs.current.population as usize)
    }

    fn forget_values(&mut self) {
        self.runs.iter_mut().for_each(|runs| runs.current.forget_values());
    }

    fn tell(&mut self, candidates: &[Candidate], evaluations: &[Evaluation]) {
        let order = full_ranking(evaluations);
        match &mut self.runs {
            Some(runs) => {
                let ranked = ranked_candidates(candidates, evaluations, &order);
                let mut rng = self.search.stream(0, Purpose::Restart);
                // The number of candidates is always right. If a coordinate is not finite, nothing more can be learned.
                let _ = runs.update(&ranked, &mut rng);
            }
            None => {
                let best = order.first().map(|&index| candidates[index].heritage.point.clone());
                self.start(best.unwrap_or_else(|| vec![0.5; self.search.dimension()]));
            }
        }
        self.search.generation += 1;
    }

    fn state(&self) -> StrategyState {
        StrategyState::of(&self.runs)
    }

    fn apply_settings(&mut self, plan: &RunPlan) {
        // CMA-ES depends on no setting that may change during a run.
        self.settings = Self::settings(plan);
    }
}
