//! The run under way is changed, or a champion founds the next one.

use std::sync::Arc;

use super::{CurrentRun, RunStatus};
use crate::check::within;
use crate::evolve::{
    Champion, Founder, RunPlan, SettingChange, Settings, fields, may_change_during_run, with_field,
};
use crate::run::THREADS_RANGE;
use crate::schema::list;

impl CurrentRun {
    /// Whether a run is under way whose settings could change.
    pub fn is_under_way(&self) -> bool {
        matches!(self.status(), RunStatus::Running | RunStatus::Paused)
    }

    /// Whether a setting, by its full dotted name, may change in the run under way. The error is a sentence for a
    /// tooltip.
    pub fn may_change(&self, field: &str) -> Result<(), &'static str> {
        if !self.is_under_way() {
            return Err("No run is in progress, so it takes effect with the next run.");
        }
        self.takes_changes()?;
        may_change_during_run(field, self.settings())
    }

    /// Whether the run under way takes changes of its settings at all. The error is a sentence for a tooltip.
    pub fn takes_changes(&self) -> Result<(), &'static str> {
        if self.is_lent {
            return Err("A lesson is going on, and your own run waits.");
        }
        if !self.next_is_own {
            return Err(
                "The run under way keeps its own: the next run's settings are of another preset or run.",
            );
        }
        Ok(())
    }

    /// Changes a setting of the run under way, by its full dotted name, from its next generation on.
    pub(super) fn change_running(&mut self, field: &str, text: &str) -> Result<(), String> {
        self.may_change(field).map_err(str::to_owned)?;
        self.awaited = with_field(&self.awaited, field, text).map_err(|error| error.to_string())?;
        if let Some(background) = &self.background {
            background.request_changes([(field.to_owned(), text.to_owned())]);
        }
        Ok(())
    }

    /// Changes a setting of the run under way if it may change, and leaves it to the next run if not.
    pub(super) fn change_running_too(&mut self, field: &str, text: &str) -> Result<(), String> {
        if self.may_change(field).is_err() {
            return Ok(());
        }
        self.change_running(field, text)
    }

    /// What was changed in the current run, the earliest first: for marks in a chart.
    pub fn changes(&self) -> &[SettingChange] {
        self.source_now.changes.made()
    }

    /// Takes over the plan after the run has changed a setting.
    pub(super) fn take_in_change(&mut self, field: &str, plan_now: RunPlan) {
        self.source_now = plan_now;
        self.await_as_it_is(field);
    }

    /// Awaits that a setting, by its full dotted name, stays as the run has it by now.
    pub(super) fn await_as_it_is(&mut self, field: &str) {
        let all = fields(&self.source_now.settings);
        let Some((_, value)) = all.into_iter().find(|(of, _)| of == field) else { return };
        // What belongs to a choice that is awaited no more is of no account then.
        if let Ok(awaited) = with_field(&self.awaited, field, &value) {
            self.awaited = awaited;
        }
    }

    /// Takes over the plan of a run that was opened. If earlier sessions have changed it, the next run gets the changed
    /// settings.
    pub(super) fn take_in_opened_plan(&mut self, plan_now: RunPlan) {
        if plan_now.changes.made().is_empty() {
            return;
        }
        let is_alike = self.source.plan == self.engine.next;
        self.source_now = plan_now;
        self.awaited = self.source_now.settings.clone();
        if is_alike {
            self.engine.next.settings = self.awaited.clone();
        }
    }

    /// Takes in that nothing more will change.
    pub(super) fn await_no_change(&mut self) {
        self.awaited = self.source_now.settings.clone();
    }

    /// How many threads evolve.
    pub fn threads(&self) -> usize {
        self.engine.evaluator.workers()
    }

    /// Evolves on so many threads, from the next generation on and in later runs. That changes no bit.
    pub fn set_threads(&mut self, threads: usize) -> Result<(), String> {
        within("threads", threads, THREADS_RANGE).map_err(|error| error.to_string())?;
        let evaluator = self.engine.evaluator.with_workers(threads);
        self.engine.evaluator = evaluator.map_err(|error| error.to_string())?;
        if let Some(background) = &self.background {
            background.set_evaluator(Arc::clone(&self.engine.evaluator));
        }
        Ok(())
    }

    /// Prepares the next run so that it descends from a champion, in the champion's own world. Genomes may be what
    /// they could be, and what the champion is. A run that has not begun is replaced by it at once.
    pub fn start_next_from(&mut self, champion: &Champion, name: &str) -> Result<(), String> {
        let next = &self.engine.next;
        let settings = Settings {
            trial: champion.trial.clone(),
            genome: next.settings.genome.widened_for(&champion.genome),
            evolution: next.settings.evolution.clone(),
        };
        let founder = Founder::new(name, champion.genome.clone());
        let plan = settings
            .check()
            .and_then(|()| RunPlan::new(&next.preset, next.seed, settings).starting_from(founder));
        self.engine.next = plan.map_err(|error| format!("No run can begin from it: {error}"))?;
        self.take_over_if_ready()
    }

    /// Lets the next run begin from nothing again.
    pub fn forget_founder(&mut self) -> Result<(), String> {
        self.engine.next.founder = None;
        self.take_over_if_ready()
    }

    /// What the founder of the current run is called, if it has one.
    pub fn founder(&self) -> Option<&str> {
        self.source.plan.founder.as_ref().map(|founder| founder.name())
    }

    /// What the founder of the next run is called, if it has one.
    pub fn next_founder(&self) -> Option<&str> {
        self.engine.next.founder.as_ref().map(|founder| founder.name())
    }
}

/// A change in a few words: "From generation 8: mutation range 50 N·m".
pub(crate) fn news_of(change: &SettingChange) -> String {
    let SettingChange { generation, field, value } = change;
    let all = list(&Settings::default());
    let setting = all.iter().find(|listed| listed.path == *field).map(|listed| listed.setting);
    let name = setting.map_or_else(|| field.clone(), |setting| setting.short_name());
    let unit = setting.map(|setting| setting.unit).filter(|unit| !unit.is_empty());
    let unit = unit.map_or(String::new(), |unit| format!(" {unit}"));
    format!("From generation {generation}: {name} {}{unit}", value.replace('_', " "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::save::shipped_champion;
    use crate::studio::state::current_run::prepared_run;

    #[test]
    fn a_change_is_told_in_words() {
        let change = |field: &str, value: &str| {
            let (field, value) = (format!("evolution.{field}"), value.to_owned());
            news_of(&SettingChange { generation: 8, field, value })
        };
        let range = change("halving.mutation_range_nm", "50");
        assert_eq!(range, "From generation 8: mutation range 50 N·m");
        assert_eq!(change("ga.crossover", "one_point"), "From generation 8: crossover one point");
    }

    #[test]
    fn nothing_can_be_changed_of_a_run_that_has_not_begun() {
        let mut run = prepared_run();
        let reason = run.change_running("evolution.generations", "9").expect_err("refused");
        assert!(reason.starts_with("No run is in progress"), "{reason}");
        assert_eq!(run.changes(), []);
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
        assert_eq!(run.next_founder(), Some("climber"), "and everything is as it was");
        run.forget_founder().expect("allowed");
        assert_eq!((run.founder(), run.next_founder()), (None, None));
        run.set_field("agent.limbs", "7").expect("allowed again");
        run.start_next_from(&champion, "climber").expect("it fits");
        run.set_preset("report").expect("shipped");
        assert_eq!(run.next_founder(), None, "a preset begins from nothing");
    }
}
