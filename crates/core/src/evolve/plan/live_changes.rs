//! Changes of settings during a run.
//!
//! A change takes effect at the beginning of a generation. The plan at the start and the changes together determine
//! the bits of the run.

use super::RunPlan;
use crate::check::{Invalid, within};
use crate::evolve::settings::{HalvingSettings, Settings, with_value};
use crate::schema::{Setting, SettingValue, list};

/// A change of one setting of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct SettingChange {
    /// The first generation that it applies to; the first of a run is 1.
    pub generation: u32,
    /// The full dotted name of the setting, such as `evolution.population`.
    pub field: String,
    /// Its new value.
    pub value: SettingValue,
}

/// The changes since a run began, and the earlier values that still matter.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SettingChanges {
    /// The earliest first.
    made: Vec<SettingChange>,
    range: Option<MutationRangeChange>,
    /// The latest change of the population: its generation, and the evaluations planned for all earlier ones.
    population: Option<(u32, u64)>,
}

/// The latest change of the mutation range of the report's method, or of its decay.
#[derive(Debug, Clone, Copy, PartialEq)]
struct MutationRangeChange {
    generation: u32,
    /// The range of that generation, in N·m. It decays afterwards.
    range_nm: f32,
    /// The range of the generation before, in N·m; none if the range was set rather than its decay.
    before_nm: Option<f32>,
}

/// Maximum number of changes of a run, more than anyone makes by hand.
pub const MOST_CHANGES: usize = 2000;
/// Maximum length of the text of a new value, in bytes.
const LONGEST_VALUE: usize = 60;

const UNKNOWN: &str = "There is no such setting.";

/// Whether a setting, by its full dotted name, may change while a run of these settings goes on. The error is a
/// sentence for a person.
///
/// # Errors
/// It may not; why.
pub fn may_change_during_run(field: &str, settings: &Settings) -> Result<(), &'static str> {
    live_setting(field, settings).map(drop)
}

/// The row of a setting that may change while a run of these settings goes on.
fn live_setting(field: &str, settings: &Settings) -> Result<Setting, &'static str> {
    let listed = list(settings).into_iter().find(|listed| listed.path == field).ok_or(UNKNOWN)?;
    listed.live.map(|()| listed.setting)
}

impl SettingChanges {
    /// The changes, the earliest first.
    pub fn made(&self) -> &[SettingChange] {
        &self.made
    }
}

impl RunPlan {
    /// This plan with a change; none if the setting has that value already.
    ///
    /// # Errors
    /// As [`Self::change`].
    pub fn changed(&self, change: &SettingChange) -> Result<Option<Self>, Invalid> {
        let mut plan = self.clone();
        plan.change(change)?;
        Ok((plan.settings != self.settings).then_some(plan))
    }

    /// The change of a setting to the value that a text says, from a generation on. The plan stays as it is.
    ///
    /// # Errors
    /// The setting may not change during a run, or the text is no value for it.
    pub fn change_of_text(
        &self,
        generation: u32,
        field: &str,
        text: &str,
    ) -> Result<SettingChange, Invalid> {
        let setting = allow(field, text, &self.settings)?;
        let refused = || Invalid::new(field, format!("{text:?}"), setting.allowed());
        let value = setting.parse(text).ok_or_else(refused)?;
        Ok(SettingChange { generation, field: field.to_owned(), value })
    }

    /// Makes a change: the plan is then that of the generation from which on the change applies.
    ///
    /// A new mutation range of the report's method applies to that generation, and decays afterwards. A new decay
    /// already applies to the range of that generation.
    ///
    /// # Errors
    /// The setting may not change during a run, its value is not allowed, or the generation is earlier than that of
    /// the change before, or after the end. The plan is then as it was.
    pub fn change(&mut self, change: &SettingChange) -> Result<(), Invalid> {
        let SettingChange { generation, field, value } = change;
        let latest = self.changes.made.last().map_or(1, |last| last.generation);
        // A finished run may still be extended.
        let is_length = field == "evolution.generations";
        let last = self.settings.evolution.generations + u32::from(is_length);
        within("generation", *generation, latest..=last.max(latest))?;
        within("changes", self.changes.made.len() + 1, 1..=MOST_CHANGES)?;
        allow(field, &value.to_string(), &self.settings)?;
        let settings = with_value(&self.settings, field, value)?;
        // Finished generations and the next one cannot be dropped.
        within("evolution.generations", settings.evolution.generations, *generation..=10_000)?;
        let before = &self.settings.evolution;
        match field.as_str() {
            "evolution.population" => {
                let (since, spent) = self.changes.population.unwrap_or((1, 0));
                let generations = u64::from(generation.saturating_sub(since));
                let spent = spent + u64::from(before.population) * generations;
                self.changes.population = Some((*generation, spent));
            }
            // Before the third generation nothing has decayed.
            "evolution.halving.mutation_range_nm" if *generation > 2 => {
                let range_nm = settings.evolution.halving.mutation_range_nm;
                let generation = *generation;
                self.changes.range =
                    Some(MutationRangeChange { generation, range_nm, before_nm: None });
            }
            "evolution.halving.mutation_decay" if *generation > 2 => {
                let decay = settings.evolution.halving.mutation_decay;
                self.change_decay(*generation, decay);
            }
            _ => {}
        }
        self.settings = settings;
        self.changes.made.push(change.clone());
        Ok(())
    }

    fn change_decay(&mut self, generation: u32, decay: f32) {
        let before_nm = match self.changes.range {
            // The range was set for this generation: only later ones decay.
            Some(MutationRangeChange { generation: of, before_nm: None, .. })
                if of == generation =>
            {
                return;
            }
            Some(MutationRangeChange { generation: of, before_nm, .. }) if of == generation => {
                before_nm
            }
            _ => Some(self.mutation_range_nm(generation - 1)),
        };
        let range_nm = before_nm.unwrap_or_default() * decay;
        self.changes.range = Some(MutationRangeChange { generation, range_nm, before_nm });
    }

    /// The mutation range of the report's method in a generation after all changes so far, in N·m.
    pub fn mutation_range_nm(&self, generation: u32) -> f32 {
        let HalvingSettings { mutation_range_nm, mutation_decay, .. } =
            self.settings.evolution.halving;
        let (from, range_nm) = match self.changes.range {
            Some(change) => (change.generation, change.range_nm),
            None => (2, mutation_range_nm),
        };
        // Repeated multiplication instead of a power: its bits are the same everywhere.
        (from..generation).fold(range_nm, |range, _| range * mutation_decay)
    }

    /// Number of evaluations that the run may cost.
    pub fn budget(&self) -> u64 {
        let evolution = &self.settings.evolution;
        let (since, spent) = self.changes.population.unwrap_or((1, 0));
        let generations = (u64::from(evolution.generations) + 1).saturating_sub(since.into());
        spent + u64::from(evolution.population) * generations
    }

    /// The plan of a generation: this one with the changes that apply by then.
    ///
    /// # Errors
    /// One of them is not allowed.
    pub fn in_generation(
        &self,
        generation: u32,
        changes: &[SettingChange],
    ) -> Result<Self, Invalid> {
        let mut plan = self.clone();
        let mut due = changes.iter().take_while(|change| change.generation <= generation);
        due.try_for_each(|change| plan.change(change))?;
        Ok(plan)
    }
}

/// The row of a setting that may change to a value with this text.
fn allow(field: &str, value: &str, settings: &Settings) -> Result<Setting, Invalid> {
    let short = |text: &str| text.chars().take(LONGEST_VALUE).collect::<String>();
    if value.len() > LONGEST_VALUE {
        let allowed = format!("up to {LONGEST_VALUE} bytes");
        return Err(Invalid::new(short(field), format!("{:?}", short(value)), allowed));
    }
    live_setting(field, settings).map_err(|reason| {
        let (first, rest) = reason.trim_end_matches('.').split_at(1);
        let reason = format!("{}{rest}", first.to_lowercase());
        let allowed = format!("a setting that may change during a run ({reason})");
        Invalid::new("changed setting", format!("{:?}", short(field)), allowed)
    })
}

#[cfg(test)]
mod tests;
