//! Islands: a CMA-ES for each number of blocks. Successive halving gives the evaluations to the best islands (Jamieson and Talwalkar,
//! "Non-stochastic Best Arm Identification and Hyperparameter Optimization", 2016).
//!
//! Bodies with different numbers of blocks have different genes, so each covariance is learned for one number of blocks.

use serde::{Deserialize, Serialize};

use super::cma::{CmaParameters, RestartedCma};
use super::cma_es::{check_runs, covariance_shape, ranked_candidates};
use crate::check::{Invalid, within};
use crate::evolve::candidate::Candidate;
use crate::evolve::parents::Parents;
use crate::evolve::plan::RunPlan;
use crate::evolve::settings::{IslandSettings, LARGEST_SAMPLE, RestartKind};
use crate::evolve::strategy::{Strategy, StrategyState, full_ranking};
use crate::genome::{GenomeShape, GenomeSpace};
use crate::rng::{Purpose, stream};
use crate::score::Evaluation;

/// Stages of successive halving: the evaluations that each island has had at the end of a stage, and the number of islands that continue.
const STAGES: [(u64, usize); 2] = [(120, 5), (480, 2)];

/// An island: the search for one number of blocks.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Island {
    /// Number of blocks of the island's bodies.
    limbs: u32,
    /// Whether the island still gets evaluations.
    is_active: bool,
    /// Number of evaluations so far.
    evaluations: u64,
    /// Best fitness so far. None before the first individual that is not disqualified.
    best: Option<f32>,
    /// State of CMA-ES. None while the first generation, of random genomes, is pending.
    runs: Option<RestartedCma>,
}

/// The strategy of islands.
#[derive(Debug, Clone)]
pub struct Islands {
    settings: IslandSettings,
    space: GenomeSpace,
    duration_s: f32,
    seed: u64,
    generation: u32,
    islands: Vec<Island>,
}

impl Islands {
    fn with(plan: &RunPlan, finished: u32, islands: Vec<Island>) -> Self {
        Self {
            settings: plan.settings.evolution.islands.clone(),
            space: plan.settings.genome.clone(),
            duration_s: plan.settings.trial.duration_s,
            seed: plan.seed,
            generation: finished + 1,
            islands,
        }
    }

    fn shape(&self, island: &Island) -> GenomeShape {
        GenomeShape { joints: island.limbs as usize - 1, duration_s: self.duration_s }
    }

    fn parameters(&self, island: &Island) -> CmaParameters {
        CmaParameters {
            step: self.settings.first_step.into(),
            population: self.settings.candidates,
            shape: covariance_shape(self.space.dimension(self.shape(island))),
            active: true,
            restart: RestartKind::Ipop,
        }
    }

    /// Begins CMA-ES on an island around the point `mean`.
    fn start(&self, island: &Island, mean: Vec<f64>) -> Option<RestartedCma> {
        // The check of the settings excludes errors. If there were one, all genomes of the island would be random.
        let shape = self.shape(island);
        let body = self.space.body_dimension(shape);
        let scale = |index| if index < body { f64::from(self.settings.body_share) } else { 1.0 };
        let scales: Vec<f64> = (0..mean.len()).map(scale).collect();
        let runs = RestartedCma::new(self.parameters(island), mean).ok();
        let runs = runs.map(|runs| runs.with_scales(&scales));
        debug_assert!(runs.is_some(), "the settings were checked");
        runs
    }

    /// Returns the number of candidates of an island in the next generation; 0 if the island is inactive.
    fn size(&self, island: &Island) -> usize {
        let runs = island.runs.as_ref();
        let size = runs.map_or(self.settings.candidates, |runs| runs.current.population);
        if island.is_active { size as usize } else { 0 }
    }

    /// Returns the candidates of an island, whose first individual has the index `first`.
    fn candidates(&self, island: &Island, first: usize) -> Vec<Candidate> {
        if !island.is_active {
            return Vec::new();
        }
        let stream =
            |index: u32, purpose| stream(self.seed, self.generation, first as u32 + index, purpose);
        let shape = self.shape(island);
        let (points, parents) = match &island.runs {
            Some(runs) => {
                let sample = |index| stream(index, Purpose::Sample);
                (runs.current.candidates(sample), Parents::Distribution)
            }
            None => {
                let random = |index| {
                    let mut rng = stream(index, Purpose::Birth);
                    self.space.point_of(&self.space.random_genome_of_plain_body(shape, &mut rng))
                };
                ((0..self.settings.candidates).map(random).collect(), Parents::None)
            }
        };
        let candidate = |point: Vec<f64>| {
            let genome = self.space.genome_at(&point, shape);
            Candidate::at(point, genome, parents)
        };
        points.into_iter().map(candidate).collect()
    }

    /// Ends the present stage once each active island has had its evaluations: only the best islands stay active.
    fn end_stage(&mut self) {
        let mut active: Vec<&mut Island> =
            self.islands.iter_mut().filter(|island| island.is_active).collect();
        let least = active.iter().map(|island| island.evaluations).min().unwrap_or(0);
        let stage = STAGES.into_iter().find(|(_, keep)| *keep < active.len());
        let Some((_, keep)) = stage.filter(|(evaluations, _)| least >= *evaluations) else {
            return;
        };
        let best = |island: &Island| island.best.unwrap_or(f32::NEG_INFINITY);
        active.sort_by(|a, b| best(b).total_cmp(&best(a)));
        active.into_iter().skip(keep).for_each(|island| island.is_active = false);
    }
}

impl Strategy for Islands {
    /// Begins the island with the founder's number of blocks at the founder, and all others at the best of some random genomes.
    fn begin(plan: &RunPlan) -> Self {
        let limbs = plan.settings.genome.bodies.limbs();
        let island =
            |limbs| Island { limbs, is_active: true, evaluations: 0, best: None, runs: None };
        let mut search = Self::with(plan, 0, limbs.map(island).collect());
        if let Some(founder) = &plan.founder {
            let blocks = founder.genome().body.segments.len();
            let own = search.islands.iter().position(|island| island.limbs as usize == blocks);
            if let Some(index) = own {
                let mean = search.space.exact_point_of(founder.genome());
                search.islands[index].runs = search.start(&search.islands[index], mean);
            }
        }
        search
    }

    fn resume(plan: &RunPlan, finished: u32, state: &StrategyState) -> Result<Self, Invalid> {
        let search = Self::with(plan, finished, state.read()?);
        let limbs: Vec<u32> = search.islands.iter().map(|island| island.limbs).collect();
        if !limbs.iter().copied().eq(plan.settings.genome.bodies.limbs()) {
            let allowed = "one island for each number of blocks of the run";
            return Err(Invalid::new("islands", format!("of {limbs:?} blocks"), allowed));
        }
        if !search.islands.iter().any(|island| island.is_active) {
            return Err(Invalid::new("islands", "all at rest", "one active island or more"));
        }
        let budget = plan.settings.evolution.budget();
        let mut coordinates = 0;
        for island in &search.islands {
            within("evaluations", island.evaluations, 0..=budget)?;
            let Some(runs) = &island.runs else { continue };
            let dimension = search.space.dimension(search.shape(island));
            check_runs(runs, &search.parameters(island), dimension)?;
            coordinates += dimension * runs.current.population as usize;
            within("population · dimension", coordinates, 1..=LARGEST_SAMPLE)?;
        }
        Ok(search)
    }

    fn ask(&self) -> Vec<Candidate> {
        let mut candidates = Vec::with_capacity(self.population());
        for island in &self.islands {
            candidates.extend(self.candidates(island, candidates.len()));
        }
        candidates
    }

    fn population(&self) -> usize {
        self.islands.iter().map(|island| self.size(island)).sum()
    }

    fn tell(&mut self, candidates: &[Candidate], evaluations: &[Evaluation]) {
        let mut first = 0;
        for index in 0..self.islands.len() {
            let island = &self.islands[index];
            let end = first + self.size(island);
            if first == end {
                continue;
            }
            let (asked, own) = (&candidates[first..end], &evaluations[first..end]);
            let order = full_ranking(own);
            let mut next = island.clone();
            next.evaluations += own.len() as u64;
            let best = order.first().map(|&best| &own[best]);
            let fitness = best.filter(|best| best.disqualified.is_none()).map(|best| best.fitness);
            next.best = [next.best, fitness].into_iter().flatten().reduce(f32::max);
            if let Some(runs) = &mut next.runs {
                let ranked = ranked_candidates(asked, own, &order);
                let mut rng = stream(self.seed, self.generation, first as u32, Purpose::Restart);
                // The number of candidates is always right. If a coordinate is not finite, nothing more can be learned.
                let _ = runs.update(&ranked, &mut rng);
            } else if let Some(&best) = order.first() {
                next.runs = self.start(island, asked[best].heritage.point.clone());
            }
            first = end;
            self.islands[index] = next;
        }
        self.end_stage();
        self.generation += 1;
    }

    fn state(&self) -> StrategyState {
        StrategyState::of(&self.islands)
    }

    fn apply_settings(&mut self, plan: &RunPlan) {
        // CMA-ES depends on no setting that may change during a run.
        self.settings = plan.settings.evolution.islands.clone();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::StrategyKind;
    use crate::evolve::strategies::fixtures;
    use crate::genome::ControllerKind;

    fn plan() -> RunPlan {
        fixtures::plan(StrategyKind::Islands, |_| ())
    }

    /// Advances the search by generations in which seven blocks are best, and other numbers worse the more they differ from seven.
    fn advance(search: &mut Islands, generations: u32) {
        let fitness = |of: &Candidate| -(of.genome.body.segments.len() as f32 - 7.0).abs();
        (0..generations).for_each(|_| fixtures::advance(search, fitness));
    }

    fn active(search: &Islands) -> Vec<u32> {
        let islands = search.islands.iter().filter(|island| island.is_active);
        islands.map(|island| island.limbs).collect()
    }

    #[test]
    fn the_best_five_islands_go_on_after_120_evaluations_and_the_best_two_after_480() {
        let mut search = Islands::begin(&plan());
        assert_eq!(search.population(), 11 * 12);
        advance(&mut search, 9);
        assert_eq!(active(&search).len(), 11);
        advance(&mut search, 1);
        assert_eq!(active(&search), [5, 6, 7, 8, 9]);
        advance(&mut search, 29);
        assert_eq!(active(&search).len(), 5);
        advance(&mut search, 1);
        assert_eq!(active(&search), [6, 7], "of equals the one with fewer blocks");
        let asked = search.ask();
        assert!(asked.iter().all(|of| of.parents == Parents::Distribution));
        assert_eq!(asked.len(), search.population());
    }

    #[test]
    fn bodies_vary_less_than_gaits_at_first() {
        let mut search = Islands::begin(&plan());
        advance(&mut search, 1);
        let island = search.islands.iter().find(|island| island.limbs == 7).expect("an island");
        let body = search.space.body_dimension(search.shape(island));
        let asked = search.candidates(island, 0);
        let mean = &island.runs.as_ref().expect("started").current.mean;
        let spread = |range: std::ops::Range<usize>| {
            let points = asked.iter().map(|of| &of.heritage.point);
            let offs = points.flat_map(|point| {
                range.clone().map(|coordinate| (point[coordinate] - mean[coordinate]).abs())
            });
            offs.sum::<f64>() / range.len() as f64
        };
        let ratio = spread(0..body) / spread(body..mean.len());
        assert!((0.07..0.14).contains(&ratio), "{ratio} instead of 0.1");
    }

    #[test]
    fn a_state_of_other_islands_is_refused() {
        let mut search = Islands::begin(&plan());
        advance(&mut search, 2);
        let state = search.state();
        assert_eq!(Islands::resume(&plan(), 2, &state).expect("its own").ask(), search.ask());
        let mut fewer = plan();
        fewer.settings.genome.bodies.limbs_max = 11;
        let error = Islands::resume(&fewer, 2, &state).expect_err("refused").to_string();
        assert!(error.starts_with("islands is of [2, 3, "), "{error}");
        let mut resting = search.islands.clone();
        resting.iter_mut().for_each(|island| island.is_active = false);
        let error = Islands::resume(&plan(), 2, &StrategyState::of(&resting)).expect_err("refused");
        assert_eq!(error.to_string(), "islands is all at rest; allowed: one active island or more");
        let mut spent = search.islands.clone();
        spent[3].evaluations = u64::MAX;
        let error = Islands::resume(&plan(), 2, &StrategyState::of(&spent)).expect_err("refused");
        assert!(error.to_string().starts_with("evaluations is 18446744073709551615"), "{error}");
        let mut others = plan();
        others.settings.genome.controller = ControllerKind::Wave;
        let error = Islands::resume(&others, 2, &state).expect_err("refused").to_string();
        assert!(error.starts_with("coordinates is "), "{error}");
    }
}
