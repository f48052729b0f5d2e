//! The plan of the next run: edits, presets, undo.

use std::sync::Arc;

use super::CurrentRun;
use crate::studio::stage::staged_champion::StagedChampion;
use snakes_core::evolve::{RunPlan, Settings, changed_values, with_fields};
use snakes_core::save::{KnownFiles, NamedStairs, Preset, load_preset};

impl CurrentRun {
    /// Returns the settings of the next run.
    pub fn next_settings(&self) -> &Settings {
        &self.plan_next.settings
    }

    /// Returns whether the next run's seed, preset, founder or settings differ from those of the current run with its
    /// pending changes.
    pub fn next_run_differs(&self) -> bool {
        let (now, next) = (&self.plan_now, &self.plan_next);
        let of = |plan: &RunPlan| (plan.seed, plan.preset.clone());
        of(now) != of(next)
            || now.founder != next.founder
            || *self.requested_settings() != next.settings
    }

    /// Sets the seed of the next run. It also applies to a run that has not started.
    pub fn set_seed(&mut self, seed: u64) {
        self.plan_next.seed = seed;
        self.take_over_if_ready();
    }

    /// Sets one setting of the next run, by its name: see [`Self::set_fields`].
    #[cfg(test)]
    pub fn set_field(&mut self, field: &str, text: &str) -> Result<(), String> {
        self.set_fields(&[(field, text)])
    }

    /// Sets settings of the next run at once, by their names. They also apply to a run that has not started and, from the
    /// next generation on, to a run in progress if they may change.
    pub fn set_fields(&mut self, changes: &[(&str, &str)]) -> Result<(), String> {
        let next = &self.plan_next;
        let settings = with_fields(&next.settings, changes.iter().copied())?;
        settings.check_start()?;
        self.set_next_plan(RunPlan { settings, ..next.clone() })
    }

    /// Replaces the next run's plan. It also applies to a run that has not started. Settings that may change during a
    /// run also change in the current run, unless the plan is that of another preset or run.
    pub fn set_next_plan(&mut self, plan: RunPlan) -> Result<(), String> {
        self.replace_next(plan, true)
    }

    /// Replaces the next run's plan. Only an edit also changes a run in progress.
    pub fn replace_next(&mut self, plan: RunPlan, is_edit: bool) -> Result<(), String> {
        plan.check_founder().map_err(|error| {
            format!("The champion from which the next run starts does not fit: {error}")
        })?;
        let suited_run = self.next_suits_run();
        let before = std::mem::replace(&mut self.plan_next, plan);
        let next = &self.plan_next;
        if is_edit && suited_run && !self.is_lent && before.preset == next.preset {
            for (field, value) in changed_values(&before.settings, &next.settings) {
                if self.run_allows(&field).is_ok() {
                    self.change_running(&field, value)?;
                }
            }
        }
        if before != self.plan_next {
            self.take_over_if_ready();
        }
        Ok(())
    }

    /// Returns whether edits of the next run's settings also apply to the current run: both have the same search settings.
    pub(super) fn next_suits_run(&self) -> bool {
        let (next, requested) = (&self.plan_next, self.requested_settings());
        let is_same_preset = next.preset == self.plan_now.preset;
        let is_same_search = next.settings.evolution == requested.evolution;
        next.settings == *requested || (is_same_preset && is_same_search)
    }

    /// Rereads the user's presets.
    pub fn list_presets(&mut self) {
        self.context.presets = Arc::new(KnownFiles::read(&self.context.saves));
    }

    /// Rereads the user's stairs.
    pub fn list_stairs(&mut self) {
        self.context.stairs = Arc::new(KnownFiles::read(&self.context.saves));
    }

    /// Stores the next run's stairs among the user's own.
    pub fn store_stairs(&mut self, name: &str) -> Result<(), String> {
        let about = format!("Your own stairs, made in the world of {}.", self.plan_next.preset);
        let stairs = self.next_settings().trial.stairs.clone();
        let named = NamedStairs { name: name.to_owned(), about, stairs };
        self.context.saves.store_own(&named)?;
        self.list_stairs();
        Ok(())
    }

    /// Returns the unchanged settings of the next run's preset, if they are known.
    pub fn preset_settings(&self) -> Option<&Settings> {
        self.settings_of(&self.plan_next.preset)
    }

    /// Describes the preset of the current run: "climb", or "climb, changed" if the run has other settings.
    pub fn preset_in_words(&self) -> String {
        self.in_words(&self.plan_now.preset, self.settings())
    }

    /// Describes the preset of the next run, like [`Self::preset_in_words`].
    pub fn next_preset_in_words(&self) -> String {
        self.in_words(&self.plan_next.preset, self.next_settings())
    }

    fn in_words(&self, preset: &str, settings: &Settings) -> String {
        let own = self.settings_of(preset).filter(|own| *own != settings);
        let is_changed = own.is_some_and(|own| {
            let mut own = own.clone();
            // A longer run is no other experiment.
            own.evolution.generations = settings.evolution.generations;
            own != *settings
        });
        if is_changed { format!("{preset}, changed") } else { preset.to_owned() }
    }

    /// Returns the unchanged settings of a preset, if they are known.
    fn settings_of(&self, name: &str) -> Option<&Settings> {
        let first = &self.context.first.plan;
        // The program may have been started with a preset file.
        let of_first = (first.preset == name).then_some(&first.settings);
        self.context.presets.settings_of(name).or(of_first)
    }

    /// Stores the next run's settings as a user preset, which becomes the next run's preset.
    pub fn store_preset(&mut self, name: &str) -> Result<(), String> {
        let next = &self.plan_next;
        let about = format!("Your own preset, based on {}.", next.preset);
        let preset = Preset { name: name.to_owned(), about, settings: next.settings.clone() };
        self.context.saves.store_own(&preset)?;
        self.list_presets();
        self.plan_next.preset = preset.name;
        self.take_over_if_ready();
        Ok(())
    }

    /// Returns a preset by its name, a built-in one or one of the user's own.
    fn preset_named(&self, name: &str) -> Result<Preset, String> {
        match self.context.presets.find(name)? {
            Some(preset) => Ok(preset.clone()),
            None => Ok(load_preset(name)?),
        }
    }

    /// Returns whether a snake is of the kind that a preset evolves, with the same controller and the same genes of its
    /// body, so that its world can be tried with the snake.
    pub fn preset_suits(&self, name: &str, snake: Option<&StagedChampion>) -> Result<bool, String> {
        let space = self.preset_named(name)?.settings.genome;
        let suits = |staged: &StagedChampion| {
            let genome = &staged.champion().genome;
            space.controller == genome.controller.kind()
                && space.bodies.vary == genome.body.has_own_blocks()
        };
        Ok(snake.is_none_or(suits))
    }

    /// Sets the preset of the next run, a built-in preset or one of the user's own, and its settings.
    pub fn set_preset(&mut self, name: &str) -> Result<(), String> {
        let preset = self.preset_named(name)?;
        let seed = self.plan_next.seed;
        self.set_next_plan(RunPlan::new(&preset.name, seed, preset.settings))
    }

    /// Restores the next run's world from an earlier plan, or all settings if the earlier plan has another preset. The
    /// seed is kept.
    pub fn undo_world(&mut self, before: &RunPlan) -> Result<(), String> {
        let mut next = self.plan_next.clone();
        if next.preset == before.preset {
            next.settings.trial = before.settings.trial.clone();
        } else {
            next.preset.clone_from(&before.preset);
            next.settings = before.settings.clone();
            next.founder.clone_from(&before.founder);
        }
        // A founder that was chosen meanwhile may not fit the restored world.
        if next.check_founder().is_err() {
            next.founder = None;
        }
        self.set_next_plan(next)
    }
}

#[cfg(test)]
mod tests {
    use crate::studio::state::current_run::prepared_run;

    #[test]
    fn a_preset_with_other_settings_is_called_changed() {
        let mut run = prepared_run();
        run.set_preset("climb").expect("shipped");
        let said = |run: &super::CurrentRun| (run.preset_in_words(), run.next_preset_in_words());
        let words = |now: &str, next: &str| (now.to_owned(), next.to_owned());
        assert_eq!(said(&run), words("climb", "climb"));
        run.set_field("trial.surface.friction", "0.5").expect("allowed");
        assert_eq!(said(&run), words("climb, changed", "climb, changed"), "it has not started");
        run.set_preset("ice").expect("shipped");
        assert_eq!(said(&run), words("ice", "ice"));
        run.set_field("evolution.generations", "77").expect("allowed");
        assert_eq!(said(&run), words("ice", "ice"), "only longer");
    }
}
