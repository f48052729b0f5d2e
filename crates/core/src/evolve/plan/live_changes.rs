//! Changes of settings while a run goes on.
//!
//! A change takes effect at the beginning of a generation. The plan at the start of a run and its changes together determine the bits of
//! the run.

use super::RunPlan;
use crate::check::{Invalid, within};
use crate::evolve::settings::{HalvingSettings, Settings, with_value};
use crate::schema::{Setting, SettingValue, list};

/// A change of one setting of a run.
#[derive(Debug, Clone, PartialEq)]
pub struct SettingChange {
    /// First generation to which the change applies; the first generation of a run is 1.
    pub generation: u32,
    /// Full dotted name of the setting, such as `evolution.population`.
    pub field: String,
    /// New value of the setting.
    pub value: SettingValue,
}

/// Changes since a run began, and the earlier values that still have an effect.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SettingChanges {
    /// Changes made so far, the earliest first.
    made: Vec<SettingChange>,
    range: Option<MutationRangeChange>,
    /// Generation of the latest change of the population, and the evaluations planned for all earlier generations. None: never changed.
    population: Option<(u32, u64)>,
}

/// Latest change of the mutation range of the report's method, or of the decay of that range.
#[derive(Debug, Clone, Copy, PartialEq)]
struct MutationRangeChange {
    generation: u32,
    /// Mutation range of the change's generation, in N·m. It decays in later generations.
    range_nm: f32,
    /// Mutation range of the generation before the change, in N·m. None if the range was set rather than its decay.
    before_nm: Option<f32>,
}

/// Maximum number of changes of a run, more than anyone makes by hand.
pub const MOST_CHANGES: usize = 2000;
/// Maximum length, in bytes, of the text of a setting's new value.
const LONGEST_VALUE: usize = 60;

const UNKNOWN: &str = "There is no such setting.";

/// Checks whether the setting with the full dotted name `field` may change during a run with these settings.
///
/// # Errors
/// Gives the reason why the setting may not change, as a sentence for a person.
pub fn may_change_during_run(field: &str, settings: &Settings) -> Result<(), &'static str> {
    live_setting(field, settings).map(drop)
}

/// Returns the row of a setting that may change during a run with these settings.
fn live_setting(field: &str, settings: &Settings) -> Result<Setting, &'static str> {
    let listed = list(settings).into_iter().find(|listed| listed.path == field).ok_or(UNKNOWN)?;
    listed.live.map(|()| listed.setting)
}

impl SettingChanges {
    /// Returns the changes, the earliest first.
    pub fn made(&self) -> &[SettingChange] {
        &self.made
    }
}

impl RunPlan {
    /// Returns this plan with a change made. None if the change leaves all settings as they are.
    ///
    /// # Errors
    /// Fails as [`Self::change`] does.
    pub fn changed(&self, change: &SettingChange) -> Result<Option<Self>, Invalid> {
        let mut plan = self.clone();
        plan.change(change)?;
        Ok((plan.settings != self.settings).then_some(plan))
    }

    /// Returns the change of a setting, from `generation` on, to the value in `text`. Does not make the change.
    ///
    /// # Errors
    /// Fails if the setting may not change during a run, or if the text is not a value of its type.
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

    /// Makes a change: the plan is then the plan of the generation from which on the change applies.
    ///
    /// A new mutation range of the report's method is the range of the change's generation, and decays afterwards. A new decay already
    /// applies to the range of the change's generation.
    ///
    /// # Errors
    /// Fails if the setting may not change during a run, if its value is not allowed, or if the generation is before that of the previous
    /// change or after the end of the run. The plan then stays unchanged.
    pub fn change(&mut self, change: &SettingChange) -> Result<(), Invalid> {
        let SettingChange { generation, field, value } = change;
        let latest = self.changes.made.last().map_or(1, |last| last.generation);
        // A change of the length may come after the last generation, because a finished run can be extended.
        let is_length = field == "evolution.generations";
        let last = self.settings.evolution.generations + u32::from(is_length);
        within("generation", *generation, latest..=last.max(latest))?;
        within("changes", self.changes.made.len() + 1, 1..=MOST_CHANGES)?;
        allow(field, &value.to_string(), &self.settings)?;
        let settings = with_value(&self.settings, field, value)?;
        // The new length cannot drop finished generations or the next generation.
        within("evolution.generations", settings.evolution.generations, *generation..=10_000)?;
        let before = &self.settings.evolution;
        match field.as_str() {
            "evolution.population" => {
                let (since, spent) = self.changes.population.unwrap_or((1, 0));
                let generations = u64::from(generation.saturating_sub(since));
                let spent = spent + u64::from(before.population) * generations;
                self.changes.population = Some((*generation, spent));
            }
            // In the first two generations the range has not decayed yet.
            "evolution.halving.mutation_range_nm" if *generation > 2 => {
                let range_nm = settings.evolution.halving.mutation_range_nm;
                let generation = *generation;
                self.changes.range =
                    Some(MutationRangeChange { generation, range_nm, before_nm: None });
            }
            "evolution.halving.mutation_decay" if *generation > 2 => {
                self.change_decay(*generation, settings.evolution.halving.mutation_decay);
            }
            _ => {}
        }
        self.settings = settings;
        self.changes.made.push(change.clone());
        Ok(())
    }

    fn change_decay(&mut self, generation: u32, decay: f32) {
        let before_nm = match self.changes.range {
            Some(change) if change.generation == generation => change.before_nm,
            _ => Some(self.mutation_range_nm(generation - 1)),
        };
        // A range that was set for this generation decays in later generations only.
        if let Some(range_nm) = before_nm.map(|before_nm| before_nm * decay) {
            self.changes.range = Some(MutationRangeChange { generation, range_nm, before_nm });
        }
    }

    /// Returns the mutation range of the report's method in a generation, after all changes so far, in N·m.
    pub fn mutation_range_nm(&self, generation: u32) -> f32 {
        let HalvingSettings { mutation_range_nm, mutation_decay, .. } =
            self.settings.evolution.halving;
        let (from, range_nm) = match self.changes.range {
            Some(change) => (change.generation, change.range_nm),
            None => (2, mutation_range_nm),
        };
        // The bits of a repeated multiplication, unlike those of a power, are the same on every system.
        (from..generation).fold(range_nm, |range, _| range * mutation_decay)
    }

    /// Returns the number of evaluations that the run may spend.
    pub fn budget(&self) -> u64 {
        let evolution = &self.settings.evolution;
        let (since, spent) = self.changes.population.unwrap_or((1, 0));
        let generations = (u64::from(evolution.generations) + 1).saturating_sub(since.into());
        spent + u64::from(evolution.population) * generations
    }

    /// Returns this plan with those of `changes` made that apply up to a generation.
    ///
    /// # Errors
    /// Fails if a change that is due is not allowed.
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

/// Returns the row of a setting that may change during a run. Fails if it may not, or if the text `value` is too long.
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
