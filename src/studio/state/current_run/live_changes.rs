//! Changes of the current run's settings, and the founder of the next run.

use std::borrow::Cow;

use super::{CurrentRun, RunStatus};
use snakes_core::check::within;
use snakes_core::evolve::{
    Champion, Founder, RunPlan, SettingChange, Settings, may_change_during_run, with_value,
};
use snakes_core::schema::{Setting, SettingValue, list};
use snakes_lab::run::THREADS_RANGE;

/// Full dotted name of the number of generations.
const GENERATIONS: &str = "evolution.generations";

impl CurrentRun {
    /// Returns whether a run is in progress, running or paused.
    pub fn is_under_way(&self) -> bool {
        matches!(self.status(), RunStatus::Running | RunStatus::Paused)
    }

    /// Checks whether a setting, by its full dotted name, may change in the current run. The error is a sentence for a tooltip.
    pub(super) fn run_allows(&self, field: &str) -> Result<(), &'static str> {
        if !self.is_under_way() {
            return Err("No run is in progress, so a change takes effect with the next run.");
        }
        may_change_during_run(field, self.settings())
    }

    /// Checks whether edits of settings also apply to the current run. The error is a sentence for a tooltip.
    pub fn takes_changes(&self) -> Result<(), &'static str> {
        if self.is_lent {
            return Err("A lesson is open and your own run is paused.");
        }
        if !self.next_suits_run() {
            return Err(
                "Takes effect with the next run, because other search settings of the next run already differ from those of the current run.",
            );
        }
        Ok(())
    }

    /// Changes a setting of the current run, by its full dotted name, from its next generation on.
    pub(super) fn change_running(
        &mut self,
        field: &str,
        value: SettingValue,
    ) -> Result<(), String> {
        self.run_allows(field).map_err(str::to_owned)?;
        with_value(&self.requested_settings(), field, &value)?;
        let change = (field.to_owned(), value);
        if let Some(background) = &self.background {
            background.request_changes([change.clone()]);
        }
        self.pending.push(change);
        Ok(())
    }

    /// Returns the label of the button that calls [`Self::extend`]: "Continue for 200 generations".
    pub fn extension_in_words(&self) -> String {
        match self.source.plan.settings.evolution.generations {
            1 => "Continue for 1 generation".to_owned(),
            several => format!("Continue for {several} generations"),
        }
    }

    /// Continues a finished run for as many generations as it had when it began. The next run gets the same number, unless its settings
    /// differ already.
    ///
    /// # Errors
    /// The run is not finished, more generations are not allowed, or no thread can be started.
    pub fn extend(&mut self) -> Result<(), String> {
        if self.status() != RunStatus::Finished {
            return Err("Only a finished run can be continued for more generations.".to_owned());
        }
        let [now, more] =
            [self.settings(), &self.source.plan.settings].map(|of| of.evolution.generations);
        let change = (GENERATIONS.to_owned(), SettingValue::Whole(now + more));
        let longer = with_value(self.settings(), GENERATIONS, &change.1)?;
        if !self.next_run_differs() {
            self.plan_next.settings = longer;
        }
        self.pending.push(change);
        (self.run_hash, self.before) = (None, self.background.take());
        self.start()
    }

    /// Returns the settings of the current run with its pending changes.
    pub(super) fn requested_settings(&self) -> Cow<'_, Settings> {
        // Panels call this function for each of their rows in every frame, and changes are rarely pending.
        if self.pending.is_empty() {
            return Cow::Borrowed(&self.plan_now.settings);
        }
        let change = |settings: Settings, (field, value): &(String, SettingValue)| {
            // A setting of an option that has been deselected does not exist and is skipped.
            with_value(&settings, field, value).unwrap_or(settings)
        };
        Cow::Owned(self.pending.iter().fold(self.plan_now.settings.clone(), change))
    }

    /// Removes a pending change of a setting, by its full dotted name, after the change was made or refused.
    pub(super) fn settle_change(&mut self, field: &str) {
        if let Some(place) = self.pending.iter().position(|(pending, _)| pending == field) {
            self.pending.remove(place);
        }
    }

    /// Stores the plan of an opened run. If the run's settings changed earlier, the next run also gets the changed
    /// settings.
    pub(super) fn take_in_opened_plan(&mut self, plan_now: RunPlan) {
        if plan_now.changes.made().is_empty() {
            return;
        }
        let is_alike = self.source.plan == self.plan_next;
        self.plan_now = plan_now;
        if is_alike {
            self.plan_next.settings = self.plan_now.settings.clone();
        }
    }

    /// Returns the number of evaluation threads.
    pub fn threads(&self) -> usize {
        self.context.evaluator.workers()
    }

    /// Sets the number of evaluation threads, from the next generation on and for later runs. Results do not depend on
    /// this number.
    pub fn set_threads(&mut self, threads: usize) -> Result<(), String> {
        within("threads", threads, THREADS_RANGE)?;
        let evaluator = self.context.evaluator.with_workers(threads);
        self.context.evaluator = evaluator.map_err(|error| error.to_string())?;
        if let Some(background) = &self.background {
            background.set_evaluator(self.evaluator());
        }
        Ok(())
    }

    /// Makes the next run descend from a champion, in the champion's own world. The ranges of the genome are widened to
    /// include the champion. A run that has not begun is replaced at once.
    pub fn start_next_from(&mut self, champion: &Champion, name: &str) -> Result<(), String> {
        let next = &self.plan_next;
        let mut settings = Settings {
            trial: champion.trial.clone(),
            genome: next.settings.genome.widened_for(&champion.genome),
            evolution: next.settings.evolution.clone(),
        };
        settings.suit_strategy_to_bodies();
        let founder = Founder::new(name, champion.genome.clone());
        let plan = settings
            .check()
            .and_then(|()| RunPlan::new(&next.preset, next.seed, settings).starting_from(founder));
        self.plan_next =
            plan.map_err(|error| format!("No run can start from this champion: {error}"))?;
        self.take_over_if_ready();
        Ok(())
    }

    /// Removes the next run's founder, so that the run starts from random snakes.
    pub fn forget_founder(&mut self) {
        self.plan_next.founder = None;
        self.take_over_if_ready();
    }

    /// Returns the name of the current run's founder, if any.
    pub fn founder(&self) -> Option<&str> {
        self.source.plan.founder.as_ref().map(|founder| founder.name())
    }

    /// Returns the name of the next run's founder, if any.
    pub fn next_founder(&self) -> Option<&str> {
        self.plan_next.founder.as_ref().map(|founder| founder.name())
    }
}

/// Describes a change of a setting: "From generation 8: mutation range 50 N·m", or "The run goes on until generation 400."
pub(crate) fn news_of(change: &SettingChange) -> String {
    let SettingChange { generation, field, value } = change;
    if field == "evolution.generations" {
        return format!("The run goes on until generation {value}.");
    }
    let setting = setting_of(field);
    let name = setting.map_or_else(|| field.clone(), |setting| setting.short_name());
    let unit = setting.map(|setting| setting.shown_unit()).filter(|unit| !unit.is_empty());
    let unit = unit.map_or(String::new(), |unit| format!(" {unit}"));
    let value = setting.map_or_else(|| value.to_string(), |setting| setting.shown_value(value));
    let value = value.replace('_', " ");
    format!("From generation {generation}: {name} {value}{unit}")
}

/// Describes why a requested change was not made: "Population was not changed in the current run: ...".
pub(super) fn refusal_in_words(field: &str, reason: &str) -> String {
    let name = setting_of(field).map_or(field, |setting| setting.label);
    format!("{name} was not changed in the current run: {reason}")
}

/// Returns the declaration of the setting with this full dotted name.
fn setting_of(field: &str) -> Option<Setting> {
    let all = list(&Settings::default());
    all.into_iter().find(|listed| listed.path == field).map(|listed| listed.setting)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::state::current_run::prepared_run;
    use snakes_core::save::shipped_champion;

    #[test]
    fn a_change_is_described_in_words() {
        let change = |field: &str, value| {
            news_of(&SettingChange { generation: 8, field: format!("evolution.{field}"), value })
        };
        let range = change("halving.mutation_range_nm", SettingValue::Number(50.0));
        assert_eq!(range, "From generation 8: mutation range 50 N·m");
        let crossover = change("ga.crossover", SettingValue::Name("one_point"));
        assert_eq!(crossover, "From generation 8: crossover one point");
        let longer = change("generations", SettingValue::Whole(400));
        assert_eq!(longer, "The run goes on until generation 400.");
        let refusal = refusal_in_words("evolution.halving.mutation_range_nm", "the run has ended");
        assert_eq!(refusal, "Mutation range was not changed in the current run: the run has ended");
    }

    #[test]
    fn a_run_that_has_not_started_accepts_no_changes() {
        let mut run = prepared_run();
        let nine = SettingValue::Whole(9);
        let reason = run.change_running("evolution.generations", nine).expect_err("refused");
        assert!(reason.starts_with("No run is in progress"), "{reason}");
        assert_eq!(run.plan_now.changes.made(), []);
    }

    #[test]
    fn the_threads_change_and_too_many_are_refused() {
        let mut run = prepared_run();
        run.set_threads(2).expect("allowed");
        assert_eq!(run.threads(), 2);
        let refusal = run.set_threads(0).expect_err("refused");
        assert_eq!(refusal, "threads is 0; allowed: 1 to 1024");
        assert_eq!(run.threads(), 2);
    }

    #[test]
    fn a_champion_founds_the_next_run_in_its_own_world() {
        let mut run = prepared_run();
        let champion = shipped_champion().expect("well formed").champion;
        run.start_next_from(&champion, "climber").expect("it fits");
        assert_eq!((run.founder(), run.next_founder()), (Some("climber"), Some("climber")));
        assert_eq!(run.settings().trial, champion.trial);
        assert_eq!(run.settings().genome.controller, champion.genome.controller.kind());
        let refusal = run.set_field("agent.limbs", "7").expect_err("refused");
        assert!(refusal.contains("founder.controller joints is 4; allowed: 6"), "{refusal}");
        assert_eq!(run.next_founder(), Some("climber"), "nothing has changed");
        run.forget_founder();
        assert_eq!((run.founder(), run.next_founder()), (None, None));
        run.set_field("agent.limbs", "7").expect("allowed again");
        run.start_next_from(&champion, "climber").expect("it fits");
        run.set_preset("report").expect("shipped");
        assert_eq!(run.next_founder(), None, "a preset has no founder");
    }
}
