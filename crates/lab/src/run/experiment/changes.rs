//! Settings that change during a run: a change is proposed, then saved by the caller, then applied.

use std::borrow::Cow;

use super::Experiment;
use snakes_core::check::Invalid;
use snakes_core::evolve::{RunPlan, SettingChange, Settings};
use snakes_core::schema::SettingValue;

/// A checked change, which is to be saved and applied before the next generation begins.
#[derive(Debug, Clone, PartialEq)]
pub struct ProposedChange {
    /// The change.
    pub change: SettingChange,
    /// Plan of the next generation with this change.
    plan: RunPlan,
}

impl Experiment {
    /// Returns the settings of the next generation.
    pub fn settings(&self) -> Cow<'_, Settings> {
        match self.next_plan() {
            Cow::Borrowed(plan) => Cow::Borrowed(&plan.settings),
            Cow::Owned(plan) => Cow::Owned(plan.settings),
        }
    }

    /// Returns the plan of the next generation.
    pub fn next_plan(&self) -> Cow<'_, RunPlan> {
        self.plan_with(|change| change.generation <= self.finished + 1)
    }

    /// Returns the plan with all recorded changes, even those of later generations.
    pub fn plan_now(&self) -> Cow<'_, RunPlan> {
        self.plan_with(|_| true)
    }

    fn plan_with(&self, is_included: impl Fn(&SettingChange) -> bool) -> Cow<'_, RunPlan> {
        let mut plan = Cow::Borrowed(&self.plan);
        for change in self.ahead.iter().take_while(|change| is_included(change)) {
            // All recorded changes were checked before, so this cannot fail.
            let _ = plan.to_mut().change(change);
        }
        plan
    }

    /// Checks the change of a setting, given by its full dotted name, from the next generation on. Returns `None` if the setting
    /// already has the value. Changes nothing yet: see [`Self::apply_change`].
    ///
    /// # Errors
    /// The setting may not change during a run, its value is not allowed, or an earlier change has not taken effect
    /// yet.
    pub fn propose_change(
        &self,
        field: &str,
        value: SettingValue,
    ) -> Result<Option<ProposedChange>, Invalid> {
        let next = self.finished + 1;
        if let Some(later) = self.ahead.iter().find(|change| change.generation > next) {
            let later = later.generation;
            let allowed =
                format!("none before generation {later}, for which a change is already recorded");
            return Err(Invalid::new("changed setting", format!("{field:?}"), allowed));
        }
        let change = SettingChange { generation: next, field: field.to_owned(), value };
        let plan = self.next_plan().changed(&change)?;
        Ok(plan.map(|plan| ProposedChange { change, plan }))
    }

    /// Applies the change that was proposed last, from the next generation on. Drops known evaluations of that generation, because
    /// they were made under the old setting.
    pub fn apply_change(&mut self, proposed: ProposedChange) {
        self.apply_due_changes();
        self.plan = proposed.plan;
        self.adopt_settings();
        self.known.clear();
    }

    /// Makes the strategy follow the changed plan.
    fn adopt_settings(&mut self) {
        self.strategy.apply_settings(&self.plan);
        self.asked.take();
    }

    /// Applies the recorded changes that are due for the next generation.
    pub(super) fn apply_due_changes(&mut self) {
        let next = self.finished + 1;
        // Changes are applied one by one: changing a setting there and back differs from not changing it.
        while let Some(change) = self.ahead.pop_front_if(|change| change.generation <= next) {
            // All recorded changes were checked before, so this cannot fail.
            let _ = self.plan.change(&change);
            self.adopt_settings();
        }
    }
}
