//! One run of a study, from its plan to its values.

use std::collections::BTreeMap;

use super::bodies::BodyMeasures;
use super::champion::champion_values;
use super::definition::{Arm, Goal, Study};
use super::values::is_of_bodies;
use crate::run::{Cancelled, Evaluator, Experiment, GenerationReport, RunControl};
use snakes_core::check::Invalid;
use snakes_core::evolve::{Champion, RunPlan, check_effects};
use snakes_core::save::{CURVE_POINTS, Protocol, SaveError, StudiedRun, StudyRuns, StudyValue};
use snakes_core::score::Fitness;

/// A run of a study that is to be made.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedRun<'a> {
    /// Arm of the run.
    pub arm: &'a Arm,
    /// Plan of the run.
    pub plan: RunPlan,
    /// Protocol of the arm.
    pub protocol: Protocol,
    /// Whether the run's bodies are measured.
    measures_bodies: bool,
}

/// A finished run of a study.
#[derive(Debug, Clone, PartialEq)]
pub struct FinishedRun<'a> {
    /// Arm of the run.
    pub arm: &'a Arm,
    /// Protocol of the arm.
    pub protocol: Protocol,
    /// Seed, values and learning curve of the run.
    pub run: StudiedRun,
    /// Champion of the run; `None` if all snakes were disqualified.
    pub champion: Option<Champion>,
}

impl Study {
    /// Returns the runs of the study, seed by seed, so that an interrupted study has about equal numbers of runs for each arm.
    ///
    /// # Errors
    /// A preset cannot be read, an arm's settings are not allowed, or no arm uses a setting of the study.
    pub fn planned(&self) -> Result<Vec<PlannedRun<'_>>, SaveError> {
        let measures_bodies = self.shown().iter().any(|name| is_of_bodies(name));
        let mut of_arms = Vec::new();
        for arm in self.selected_arms() {
            let plan = self.plan(arm, self.first_seed)?;
            of_arms.push((arm, arm.protocol(&plan)?, plan));
        }
        for (arm, _, plan) in &of_arms {
            let fitness = plan.settings.trial.fitness;
            if !self.references.is_empty() && fitness != Fitness::Centre {
                let allowed = "centre, as of the published means";
                let field = format!("trial.fitness of {}", arm.name);
                return Err(SaveError::Study(Invalid::new(field, fitness, allowed)));
            }
        }
        for name in self.settings.keys() {
            let is_used = |plan: &RunPlan| check_effects(&plan.settings, [name.as_str()]).is_ok();
            if !of_arms.iter().any(|(.., plan)| is_used(plan)) {
                let allowed = "no value, because the strategies, controllers and bodies of the study do not use it";
                return Err(SaveError::Study(Invalid::new(name, &self.settings[name], allowed)));
            }
        }
        let of_seed = |seed| {
            let of_arms = of_arms.iter().cloned();
            of_arms.map(move |(arm, protocol, plan)| PlannedRun {
                arm,
                plan: RunPlan { seed, ..plan },
                protocol,
                measures_bodies,
            })
        };
        Ok(self.seeds().flat_map(of_seed).collect())
    }
}

impl<'a> PlannedRun<'a> {
    /// Returns the result of this run, if it is among the finished runs.
    pub fn result<'r>(&self, finished: &'r StudyRuns) -> Option<&'r StudiedRun> {
        let arm = finished.arm(&self.arm.name).filter(|arm| arm.protocol == self.protocol)?;
        arm.runs.iter().find(|run| run.seed == self.plan.seed)
    }

    /// Returns the number of simulated trials that the run's generations may spend.
    pub fn simulations(&self) -> u64 {
        u64::from(self.plan.settings.trial.most_simulations()) * self.plan.budget()
    }

    /// Makes the run. Calls `spent` with numbers of simulated trials, whose sum is [`Self::simulations`].
    ///
    /// # Errors
    /// `control` was cancelled.
    pub fn make(
        &self,
        evaluator: &dyn Evaluator,
        control: &RunControl,
        spent: &(dyn Fn(u64) + Sync),
    ) -> Result<FinishedRun<'a>, Cancelled> {
        let plan = &self.plan;
        let each = u64::from(plan.settings.trial.most_simulations());
        let mut experiment = Experiment::new(plan.clone());
        let mut progress = RunProgress::default();
        let mut bodies = self.measures_bodies.then(|| BodyMeasures::new(&plan.settings));
        while !experiment.is_over() {
            let before = experiment.evaluated();
            let report = experiment.run_generation(evaluator, control)?;
            spent(each * u64::from(report.evaluations));
            if let Some((bodies, generation)) = bodies.as_mut().zip(experiment.generation()) {
                bodies.add(generation);
            }
            progress.add(self, &experiment, before, &report);
            if self.arm.stops_at_goal && progress.goal_evaluations.is_some() {
                break;
            }
        }
        spent(each * plan.budget().saturating_sub(experiment.evaluated()));
        let champion = best_of(&experiment, plan).cloned();
        let mut values = champion_values(champion.as_ref());
        let number = |number: u64| StudyValue::Number(number as f64);
        if let Some(bodies) = bodies {
            bodies.finish(&mut values, plan, &experiment, evaluator, control)?;
        }
        values.extend([
            ("evaluations".to_owned(), number(experiment.evaluated())),
            ("simulations".to_owned(), number(experiment.simulations())),
        ]);
        progress.finish(&mut values);
        let run = StudiedRun {
            seed: plan.seed,
            values,
            curve: progress.curve,
            run_hash: format!("{:016x}", experiment.run_hash()),
        };
        Ok(FinishedRun { arm: self.arm, protocol: self.protocol.clone(), run, champion })
    }
}

/// Returns the best individual so far on the stairs of the run's trial; `None` while a ladder has not reached these stairs.
fn best_of<'e>(experiment: &'e Experiment, plan: &RunPlan) -> Option<&'e Champion> {
    let goal = &plan.settings.trial.stairs;
    experiment.best().filter(|best| best.trial.stairs == *goal)
}

/// Numbers that are recorded after each generation.
#[derive(Debug)]
struct RunProgress {
    first_landing: Option<u64>,
    goal_evaluations: Option<u64>,
    means: Vec<Option<f64>>,
    disqualified: Vec<Option<f64>>,
    curve: Vec<Option<f32>>,
}

impl Default for RunProgress {
    fn default() -> Self {
        Self {
            first_landing: None,
            goal_evaluations: None,
            means: Vec::new(),
            disqualified: Vec::new(),
            curve: vec![None; CURVE_POINTS],
        }
    }
}

impl RunProgress {
    fn add(
        &mut self,
        run: &PlannedRun<'_>,
        experiment: &Experiment,
        before: u64,
        report: &GenerationReport,
    ) {
        let landing = report.first_on_landing.map(|index| before + u64::from(index) + 1);
        self.first_landing = self.first_landing.or(landing);
        let champion = report.champion.as_ref();
        let is_reached = match run.arm.goal {
            None => false,
            Some(Goal::Landing) => landing.is_some(),
            Some(Goal::Way(way_m)) => champion.is_some_and(|of| of.way_m() >= way_m),
            Some(Goal::Steps(steps)) => champion.is_some_and(|of| of.steps_climbed() >= steps),
        };
        if is_reached {
            self.goal_evaluations.get_or_insert(experiment.evaluated());
        }
        self.means.push(report.statistics.map(|statistics| statistics.mean));
        self.disqualified.push(Some(report.disqualified.into()));
        let best = best_of(experiment, &run.plan).map(|best| best.evaluation.fitness);
        // A point of the curve is the best fitness at the time when this share of the budget was spent.
        let reached =
            (experiment.evaluated() * CURVE_POINTS as u64).div_ceil(run.plan.budget().max(1));
        self.curve.iter_mut().skip((reached as usize).saturating_sub(1)).for_each(|at| *at = best);
    }

    fn finish(&self, values: &mut BTreeMap<String, StudyValue>) {
        let rises = self.means.windows(2).all(|pair| matches!(pair, [Some(a), Some(b)] if b > a));
        let mut add = |name: &str, value| values.insert(name.to_owned(), value);
        add("rises", StudyValue::Number(f64::from(u8::from(rises))));
        for (name, number) in [
            ("first_landing", self.first_landing.map(|number| number as f64)),
            ("goal_evaluations", self.goal_evaluations.map(|number| number as f64)),
            ("last_mean", self.means.last().copied().flatten()),
        ] {
            number.map(|number| add(name, StudyValue::Number(number)));
        }
        // The lists of runs with many generations are left out, because the curve shows them well enough.
        if self.means.len() <= MOST_GENERATIONS {
            add("generation_means", StudyValue::Numbers(self.means.clone()));
            add("generation_disqualified", StudyValue::Numbers(self.disqualified.clone()));
        }
    }
}

/// Maximum number of generations of a run whose means are stored one by one.
const MOST_GENERATIONS: usize = 20;
