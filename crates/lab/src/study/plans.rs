//! Plans of an arm's runs: the settings of a preset, with the changes of the study and of the arm.

use std::ops::RangeInclusive;

use super::definition::{Arm, Plain, Study};
use snakes_core::check::{Invalid, within};
use snakes_core::evolve::{
    RunPlan, Settings, StrategyKind, changed_values, check_effects, with_fields,
};
use snakes_core::genome::ControllerKind;
use snakes_core::save::{Protocol, SaveError, load_preset, load_stairs, settings_fingerprint};
use snakes_core::schema::{Choices, SettingValue};
use snakes_core::score::ExamSuite;
use snakes_core::world::PhysicsEngine;

/// Numbers of evaluations that a run may spend. Fewer than a generation has are not allowed either.
pub const EVALUATIONS: RangeInclusive<u32> = 1..=10_000_000;

impl Study {
    /// Returns the plan of a run of an arm with this seed.
    ///
    /// # Errors
    /// The arm's preset or the study's stairs cannot be read, or the arm's settings are not allowed.
    pub fn plan(&self, arm: &Arm, seed: u64) -> Result<RunPlan, SaveError> {
        let preset = load_preset(arm.preset.as_ref().unwrap_or(&self.preset));
        let mut preset = preset.map_err(|error| match error {
            SaveError::Unknown(invalid) => {
                SaveError::Study(Invalid { field: format!("preset of {}", arm.name), ..invalid })
            }
            other => other,
        })?;
        if let Some(named) = &self.stairs {
            preset.settings.trial.stairs = load_stairs(named)?.stairs;
        }
        let settings = self.settings_of(arm, &preset.settings).map_err(|invalid| {
            // For a setting that does not exist, the error names the flag --set, which a study does not use.
            let field = if invalid.field == "set" { "settings" } else { &invalid.field };
            SaveError::Study(Invalid { field: format!("{field} of {}", arm.name), ..invalid })
        })?;
        Ok(RunPlan::new(&preset.name, seed, settings))
    }

    /// Returns the settings of an arm: those of its preset with all changes.
    ///
    /// # Errors
    /// The budget is too small for one generation, the settings do not fit together, a setting of the arm has no effect, or the
    /// stairs evolve, so that results on different stairs would be compared.
    fn settings_of(&self, arm: &Arm, preset: &Settings) -> Result<Settings, Invalid> {
        let text = |(name, value): (&String, &Plain)| (name.clone(), value.to_string());
        let changes: Vec<(String, String)> =
            self.settings.iter().chain(&arm.settings).map(text).collect();
        let mut settings = preset.clone();
        let mut others = Vec::new();
        // The method is set first, because it decides about the bodies and thus about the allowed values of other settings.
        for (name, value) in &changes {
            if is_short_for("evolution.strategy", name) {
                settings.evolution.strategy = StrategyKind::named(name, value)?;
            } else if is_short_for("genome.controller", name) {
                settings.genome.controller = ControllerKind::named(name, value)?;
            } else {
                others.push((name.as_str(), value.as_str()));
            }
        }
        if let Some((strategy, controller)) = arm.method {
            (settings.evolution.strategy, settings.genome.controller) = (strategy, controller);
        }
        let info = settings.evolution.strategy.info();
        if info.evolves_stairs {
            let allowed = "strategies whose snakes all learn on the stairs of the preset";
            return Err(Invalid::new("strategy", settings.evolution.strategy, allowed));
        }
        settings.genome.bodies.vary = info.varies_bodies;
        if settings.genome.has_creatures() {
            // The studies of creatures that were published are of rapier, whatever the engine of the preset.
            settings.trial.physics.engine = PhysicsEngine::Rapier;
        }
        let mut settings = with_fields(&settings, others)?;
        if self.exam_length {
            let duration_s = changes
                .iter()
                .any(|(name, _)| is_short_for(DURATION, name))
                .then_some(settings.trial.duration_s);
            settings.trial = ExamSuite::Stairs.undisturbed(&settings.trial).trial;
            settings.trial.duration_s = duration_s.unwrap_or(settings.trial.duration_s);
        }
        let own = arm.evaluations.or(self.evaluations);
        let times = arm.evaluations_times.unwrap_or(1);
        if let Some(evaluations) = own.map(|evaluations| evaluations.saturating_mul(times)) {
            let evolution = &mut settings.evolution;
            // The report's method gets the report's number of generations: its mutation range halves with each generation, so more
            // would change nothing. Other methods keep the population of the settings.
            let fixed_generations = info.compared_generations;
            if let Some(generations) = fixed_generations {
                evolution.generations = generations;
                evolution.population = evaluations / generations;
            } else {
                evolution.generations = evaluations / evolution.population.max(1);
            }
            let min = evolution.population.max(fixed_generations.unwrap_or(1));
            within("evaluations", evaluations, min..=*EVALUATIONS.end())?;
        }
        settings.check()?;
        settings.check_start()?;
        check_effects(&settings, arm.settings.keys().map(String::as_str))?;
        Ok(settings)
    }
}

impl Arm {
    /// Returns the protocol of the arm's runs, given the plan of one of them.
    ///
    /// # Errors
    /// The preset of the plan cannot be read.
    pub fn protocol(&self, plan: &RunPlan) -> Result<Protocol, SaveError> {
        let changed = changed_values(&load_preset(&plan.preset)?.settings, &plan.settings);
        let in_words = |(name, value): (String, SettingValue)| (name, value.to_string());
        Ok(Protocol {
            preset: plan.preset.clone(),
            settings: settings_fingerprint(plan),
            strategy: plan.settings.evolution.strategy,
            controller: plan.settings.genome.controller,
            fitness: plan.settings.trial.fitness,
            budget: plan.budget(),
            stops_at_goal: self.stops_at_goal,
            changed: Some(changed.into_iter().map(in_words).collect()),
        })
    }
}

/// Returns whether `name` is the full dotted name of a setting, or its last parts.
pub(super) fn is_short_for(field: &str, name: &str) -> bool {
    field.strip_suffix(name).is_some_and(|rest| rest.is_empty() || rest.ends_with('.'))
}

/// Full name of the setting for the duration of trials.
const DURATION: &str = "trial.duration_s";
