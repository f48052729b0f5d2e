//! Several methods under equal budgets, with the same seeds.

use super::evaluator::Evaluator;
use super::experiment::Experiment;
use super::headless::HeadlessError;
use super::paired::paired_text;
use super::report::{GenerationReport, Quartiles};
use super::run_control::{Cancelled, RunControl};
use super::whole_runs::whole_runs;
use snakes_core::check::{Invalid, within};
use snakes_core::evolve::{Champion, Descriptor, RunPlan, Settings, StrategyKind};
use snakes_core::genome::ControllerKind;
use snakes_core::save::{CURVE_POINTS, ComparedBest, ComparedRun, Comparison};
use snakes_core::world::PhysicsEngine;

/// One run of a comparison.
#[derive(Debug, Clone, PartialEq)]
pub struct PlannedRun {
    /// The learning method.
    pub strategy: StrategyKind,
    /// The controller of the joints.
    pub controller: ControllerKind,
    /// The seed.
    pub seed: u64,
}

impl PlannedRun {
    /// Its plan: the settings with its method and controller, and enough generations to spend the budget.
    ///
    /// The report's method gets the report's number of generations: its mutation range halves with each, so more
    /// would change nothing. The others keep the population of the settings.
    ///
    /// # Errors
    /// The budget is too small for one generation, the settings do not fit together, or the stairs evolve, so that results on
    /// different stairs would be compared.
    pub fn plan(
        &self,
        preset: &str,
        settings: &Settings,
        evaluations: u32,
    ) -> Result<RunPlan, Invalid> {
        if self.strategy.info().evolves_stairs {
            let allowed = "strategies whose snakes all learn on the stairs of the preset";
            return Err(Invalid::new("--strategies", self.strategy, allowed));
        }
        let mut settings = settings.clone();
        settings.genome.controller = self.controller;
        settings.evolution.strategy = self.strategy;
        settings.genome.bodies.vary = self.strategy.info().varies_bodies;
        if settings.genome.has_creatures() {
            // The preset's engine may simulate nothing but limbs in a row.
            settings.trial.physics.engine = PhysicsEngine::Rapier;
        }
        let evolution = &mut settings.evolution;
        let fixed_generations = self.strategy.info().compared_generations;
        if let Some(generations) = fixed_generations {
            evolution.generations = generations;
            evolution.population = evaluations / generations;
        } else {
            evolution.generations = evaluations / evolution.population.max(1);
        }
        let min = evolution.population.max(fixed_generations.unwrap_or(1));
        within("evaluations", evaluations, min..=MAX_BUDGET)?;
        settings.check()?;
        Ok(RunPlan::new(preset, self.seed, settings))
    }
}

/// Maximum number of evaluations of a run.
const MAX_BUDGET: u32 = 10_000_000;

/// Evolves all plans, as many at the same time as `evaluator` has workers. Calls `done` with each finished run, one
/// at a time, and `spent` with the number of evaluations of each generation.
///
/// # Errors
/// `control` was cancelled, workers could not be started, or `done` failed.
pub fn run_all(
    plans: &[RunPlan],
    evaluator: &dyn Evaluator,
    control: &RunControl,
    spent: impl Fn(u32) + Sync,
    done: impl FnMut(ComparedRun) -> Result<(), HeadlessError> + Send,
) -> Result<(), HeadlessError> {
    let work = |index: usize, single: &dyn Evaluator| {
        let plan: &RunPlan = &plans[index];
        run_one(&mut Experiment::new(plan.clone()), plan, |experiment| {
            let report = experiment.run_generation(single, control)?;
            spent(report.evaluations);
            Ok(report)
        })
    };
    whole_runs(plans.len(), evaluator, control, work, done)
}

/// The best individual so far on the stairs of the run's trial; none while a ladder has not led to them.
fn best_of<'a>(experiment: &'a Experiment, plan: &RunPlan) -> Option<&'a Champion> {
    let goal = &plan.settings.trial.stairs;
    experiment.best().filter(|best| best.trial.stairs == *goal)
}

pub(super) fn run_one(
    experiment: &mut Experiment,
    plan: &RunPlan,
    mut generation: impl FnMut(&mut Experiment) -> Result<GenerationReport, Cancelled>,
) -> Result<ComparedRun, Cancelled> {
    let budget = plan.settings.evolution.budget();
    let mut curve = vec![None; CURVE_POINTS];
    let (mut first_on_landing, mut last_mean) = (None, None);
    while !experiment.is_over() {
        let before = experiment.evaluated();
        let report = generation(experiment)?;
        let number =
            |index: u32| u32::try_from(before).unwrap_or(u32::MAX).saturating_add(index + 1);
        first_on_landing = first_on_landing.or(report.first_on_landing.map(number));
        last_mean = report.statistics.map(|statistics| statistics.mean);
        let best = best_of(experiment, plan).map(|best| best.evaluation.fitness);
        // A point of the curve is the best fitness when that share of the budget was spent.
        let reached = (experiment.evaluated() * CURVE_POINTS as u64).div_ceil(budget.max(1));
        curve.iter_mut().skip((reached as usize).saturating_sub(1)).for_each(|at| *at = best);
    }
    let best = best_of(experiment, plan).map(|best| ComparedBest {
        fitness: best.evaluation.fitness,
        steps_climbed: best.evaluation.behaviour.map_or(0, |behaviour| behaviour.steps_climbed),
        energy_j_per_m: Descriptor::EnergyPerMetre
            .value(&best.evaluation, best.trial.middle_start_y_m(&best.genome))
            .filter(|energy| energy.is_finite()),
        cost_of_transport: best.evaluation.behaviour.and_then(|of| of.cost_of_transport),
        climbing_efficiency: best.evaluation.behaviour.and_then(|of| of.climbing_efficiency),
    });
    Ok(ComparedRun {
        strategy: plan.settings.evolution.strategy,
        controller: plan.settings.genome.controller,
        seed: plan.seed,
        evaluations: u32::try_from(experiment.evaluated()).unwrap_or(u32::MAX),
        best,
        first_on_landing,
        last_mean,
        curve,
        run_hash: format!("{:016x}", experiment.run_hash()),
    })
}

/// One method with one controller, over all seeds.
#[derive(Debug, Clone, PartialEq)]
pub struct ComparisonRow<'a> {
    /// The learning method.
    pub strategy: StrategyKind,
    /// The controller of the joints.
    pub controller: ControllerKind,
    /// Its runs.
    pub runs: Vec<&'a ComparedRun>,
}

/// The tables of a comparison.
pub trait ComparisonTables {
    /// The rows of the table, in the order of strategies and controllers.
    fn rows(&self) -> Vec<ComparisonRow<'_>>;
    /// The table as text.
    fn text(&self) -> String;
    /// The records of the CSV file, the header first: one per run.
    fn records(&self) -> Vec<Vec<String>>;
}

impl ComparisonTables for Comparison {
    fn rows(&self) -> Vec<ComparisonRow<'_>> {
        let mut rows: Vec<ComparisonRow<'_>> = Vec::new();
        for run in &self.runs {
            let (strategy, controller) = (run.strategy, run.controller);
            match rows.last_mut() {
                Some(row) if (row.strategy, row.controller) == (strategy, controller) => {
                    row.runs.push(run);
                }
                _ => rows.push(ComparisonRow { strategy, controller, runs: vec![run] }),
            }
        }
        rows
    }

    fn text(&self) -> String {
        let head = [
            "strategy",
            "controller",
            "best fitness",
            "steps climbed",
            "landed",
            "evaluations to landing",
            "energy J/m",
            "cost of transport",
            "climbing eff.",
            "final mean",
        ];
        let mut lines = vec![head.map(str::to_owned)];
        for row in self.rows() {
            let show = |quartiles: Option<Quartiles>, digits: usize| match quartiles {
                // Most runs never reached the landing, and neither did the fastest.
                Some(Quartiles { low, .. }) if !low.is_finite() => "-".to_owned(),
                Some(Quartiles { low, median, high }) => {
                    let number = |x: f64| {
                        if x.is_finite() { format!("{x:.digits$}") } else { "-".to_owned() }
                    };
                    format!("{} [{} {}]", number(median), number(low), number(high))
                }
                None => "-".to_owned(),
            };
            let landed = row.runs.iter().filter(|run| run.first_on_landing.is_some()).count();
            lines.push([
                row.strategy.name().to_owned(),
                row.controller.name().to_owned(),
                show(row.fitness(), 2),
                show(row.steps_climbed(), 1),
                format!("{landed}/{}", row.runs.len()),
                show(row.evaluations_to_landing(), 0),
                show(row.energy_j_per_m(), 0),
                show(row.of_best(|best| best.cost_of_transport), 1),
                show(row.of_best(|best| best.climbing_efficiency), 3),
                show(Quartiles::of(row.runs.iter().filter_map(|run| run.last_mean)), 2),
            ]);
        }
        let mut text = String::new();
        for line in &lines {
            let mut written = String::new();
            for (column, cell) in line.iter().enumerate() {
                let width = lines.iter().map(|line| line[column].len()).max().unwrap_or(0);
                // Names to the left, numbers to the right.
                let left = column < 2;
                written +=
                    &if left { format!("{cell:<width$}  ") } else { format!("{cell:>width$}  ") };
            }
            text += written.trim_end();
            text += "\n";
        }
        text + "\nmedian [quartiles] over the seeds; a run that never reaches the landing counts as needing\n\
         infinitely many evaluations; final mean: mean fitness of the last generation\n\n"
            + &paired_text(self)
    }

    fn records(&self) -> Vec<Vec<String>> {
        let head = [
            "strategy",
            "controller",
            "seed",
            "evaluations",
            "best_fitness",
            "steps_climbed",
            "energy_j_per_m",
            "cost_of_transport",
            "climbing_efficiency",
            "first_on_landing",
            "last_mean",
            "run_hash",
        ];
        let mut records = vec![head.map(str::to_owned).to_vec()];
        let text = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
        for run in &self.runs {
            let best = run.best;
            records.push(vec![
                run.strategy.name().to_owned(),
                run.controller.name().to_owned(),
                run.seed.to_string(),
                run.evaluations.to_string(),
                best.map_or(String::new(), |best| best.fitness.to_string()),
                best.map_or(String::new(), |best| best.steps_climbed.to_string()),
                text(best.and_then(|best| best.energy_j_per_m)),
                text(best.and_then(|best| best.cost_of_transport).map(f64::from)),
                text(best.and_then(|best| best.climbing_efficiency).map(f64::from)),
                run.first_on_landing.map_or(String::new(), |number| number.to_string()),
                text(run.last_mean),
                run.run_hash.clone(),
            ]);
        }
        records
    }
}

impl ComparisonRow<'_> {
    /// Best fitness of each run.
    pub fn fitness(&self) -> Option<Quartiles> {
        Quartiles::of(self.runs.iter().filter_map(|run| Some(f64::from(run.best?.fitness))))
    }

    /// Number of steps that the best of each run climbed.
    pub fn steps_climbed(&self) -> Option<Quartiles> {
        Quartiles::of(self.runs.iter().filter_map(|run| Some(f64::from(run.best?.steps_climbed))))
    }

    /// Number of evaluations until the first agent on the landing; infinite for a run without one.
    pub fn evaluations_to_landing(&self) -> Option<Quartiles> {
        let number = |run: &&ComparedRun| run.first_on_landing.map_or(f64::INFINITY, f64::from);
        Quartiles::of(self.runs.iter().map(number))
    }

    /// A value of the best of each run.
    fn of_best(&self, value: impl Fn(ComparedBest) -> Option<f32>) -> Option<Quartiles> {
        Quartiles::of(self.runs.iter().filter_map(|run| value(run.best?).map(f64::from)))
    }

    /// Energy per metre of the best of each run, in J/m.
    pub fn energy_j_per_m(&self) -> Option<Quartiles> {
        Quartiles::of(self.runs.iter().filter_map(|run| run.best?.energy_j_per_m))
    }

    /// The learning curve: quartiles of the best fitness so far, at each point of the budget where all runs have
    /// a best.
    pub fn curve(&self) -> Vec<(usize, Quartiles)> {
        let at = |point: usize| {
            let values: Option<Vec<f64>> =
                self.runs.iter().map(|run| Some(f64::from((*run.curve.get(point)?)?))).collect();
            Some((point, Quartiles::of(values?)?))
        };
        (0..CURVE_POINTS).filter_map(at).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::LocalPool;

    fn plans() -> Vec<RunPlan> {
        let mut settings = Settings::default();
        settings.trial.duration_s = 0.5;
        settings.evolution.population = 6;
        settings.evolution.islands.candidates = 4;
        settings.genome.bodies.limbs_max = 3;
        let planned = |strategy: StrategyKind| {
            let gait = ControllerKind::Gait;
            let controller = strategy.controllers().find(|kind| *kind == gait);
            let controller = controller.or(strategy.controllers().next()).expect("a controller");
            PlannedRun { strategy, controller, seed: 3 }
        };
        let all = StrategyKind::ALL.into_iter().filter(|kind| !kind.info().evolves_stairs);
        all.map(|strategy| planned(strategy).plan("test", &settings, 24).expect("allowed"))
            .collect()
    }

    fn compared(plans: &[RunPlan], threads: usize) -> Comparison {
        let mut comparison = Comparison::new("test", String::new(), 24, Default::default());
        let done = |run| {
            comparison.add(run);
            Ok(())
        };
        let evaluator = LocalPool::new(threads).expect("threads");
        run_all(plans, &evaluator, &RunControl::default(), |_| (), done).expect("not cancelled");
        comparison
    }

    #[test]
    fn creatures_are_compared_in_rapier_with_bodies_in_lanes() {
        let mut settings = Settings::default();
        settings.trial.physics.engine = PhysicsEngine::Lanes;
        let engine = |strategy, controller| {
            let planned = PlannedRun { strategy, controller, seed: 1 };
            let plan = planned.plan("test", &settings, 100_000).expect("allowed");
            plan.settings.trial.physics.engine
        };
        let (creatures, bodies) = (StrategyKind::CreatureGa, StrategyKind::BodyGa);
        assert_eq!(engine(creatures, ControllerKind::PartNeurons), PhysicsEngine::Rapier);
        assert_eq!(engine(bodies, ControllerKind::Gait), PhysicsEngine::Lanes);
    }

    #[test]
    fn a_strategy_whose_stairs_evolve_is_not_compared() {
        let (strategy, controller) = (StrategyKind::Poet, ControllerKind::Gait);
        let planned = PlannedRun { strategy, controller, seed: 1 };
        let error = planned.plan("test", &Settings::default(), 1000).expect_err("refused");
        assert!(error.to_string().starts_with("--strategies is poet; allowed: "), "{error}");
    }

    #[test]
    fn all_runs_spend_the_same_and_the_number_of_threads_changes_nothing() {
        let plans = plans();
        let comparison = compared(&plans, 1);
        assert_eq!(comparison.runs.len(), plans.len());
        assert!(comparison.runs.iter().all(|run| run.evaluations == 24));
        assert_eq!(comparison, compared(&plans, 3));
        let mut experiment = Experiment::new(plans[1].clone());
        while !experiment.is_over() {
            let evaluator = LocalPool::new(1).expect("threads");
            experiment.run_generation(&evaluator, &RunControl::default()).expect("not cancelled");
        }
        let ga = &comparison.runs[1];
        assert_eq!(ga.run_hash, format!("{:016x}", experiment.run_hash()), "it is the run itself");
        assert_eq!(ga.curve.last().copied().flatten(), ga.best.map(|best| best.fitness));
        assert_eq!(comparison.rows().len(), plans.len());
        let text = comparison.text();
        // A line for each but the first, which the others are compared with.
        assert_eq!(text.lines().count(), plans.len() + 5 + plans.len() - 1);
        for line in text.lines().take(plans.len() + 1) {
            let cells = line.split("  ").filter(|cell| !cell.is_empty());
            assert_eq!(cells.count(), 10, "{line}");
        }
    }
}
