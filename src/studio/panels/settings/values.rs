//! The settings of the next run and those of its preset, and which of them the run under way takes.

use std::collections::BTreeMap;

use crate::evolve::{Settings, fields};
use crate::schema::{ListedSetting, list};
use crate::studio::state::current_run::CurrentRun;

/// The settings of the next run beside those of its preset.
#[derive(Debug, Default)]
pub struct Values {
    settings: Settings,
    settings_of_preset: Option<Settings>,
    settings_of_run: Settings,
    /// The next run's settings with their rows.
    listed: Vec<ListedSetting>,
    now: BTreeMap<String, String>,
    preset: BTreeMap<String, String>,
    preset_name: String,
    /// Whether the current run takes a change of a setting.
    live: BTreeMap<String, Result<(), &'static str>>,
}

impl Values {
    /// The values of a run's next settings.
    pub fn of(run: &CurrentRun) -> Self {
        let settings = run.next_settings().clone();
        let settings_of_preset = run.preset_settings().cloned();
        let live = list(run.settings()).into_iter().map(|listed| (listed.path, listed.live));
        Self {
            listed: list(&settings),
            now: fields(&settings).into_iter().collect(),
            preset: settings_of_preset.iter().flat_map(fields).collect(),
            preset_name: run.next_preset().to_owned(),
            live: live.collect(),
            settings_of_run: run.settings().clone(),
            settings,
            settings_of_preset,
        }
    }

    /// Whether they are still those of a run.
    pub fn are_of(&self, run: &CurrentRun) -> bool {
        self.settings == *run.next_settings()
            && self.settings_of_preset.as_ref() == run.preset_settings()
            && self.settings_of_run == *run.settings()
            && self.preset_name == run.next_preset()
            && !self.now.is_empty()
    }

    /// The next run's settings, in the order of their sections.
    pub fn listed(&self) -> &[ListedSetting] {
        &self.listed
    }

    /// Whether the current run takes a change of a setting; if not, a sentence that says why.
    pub fn live(&self, field: &str) -> Result<(), &'static str> {
        self.live.get(field).copied().unwrap_or(Ok(()))
    }

    /// The value of a setting; none if there is no such setting now.
    pub fn now(&self, field: &str) -> Option<&str> {
        self.now.get(field).map(String::as_str)
    }

    /// The value of a setting in the preset.
    pub fn in_preset(&self, field: &str) -> Option<&str> {
        self.preset.get(field).map(String::as_str)
    }

    /// What the preset is called.
    pub fn preset_name(&self) -> &str {
        &self.preset_name
    }

    /// The preset's value of a setting that has another now.
    pub fn changed_from(&self, field: &str) -> Option<&str> {
        let preset = self.in_preset(field)?;
        (self.now(field)? != preset).then_some(preset)
    }

    /// The changes that give these settings the preset's values again.
    pub fn back<'a>(&self, fields: impl IntoIterator<Item = &'a str>) -> Vec<(String, String)> {
        let back = |field: &str| {
            let preset = self.changed_from(field)?.to_owned();
            Some((field.to_owned(), preset))
        };
        fields.into_iter().filter_map(back).collect()
    }
}

/// The numbers of a list as text: `[1, 2]`.
pub fn numbers(text: &str) -> Option<Vec<f32>> {
    let inside = text.trim().strip_prefix('[')?.strip_suffix(']')?;
    inside.split(',').map(|number| number.trim().parse().ok()).collect()
}

/// A list of numbers as it is typed into a setting.
pub fn list_of(numbers: &[f32]) -> String {
    let texts: Vec<String> = numbers.iter().map(f32::to_string).collect();
    format!("[{}]", texts.join(", "))
}

/// A slider's value with as many digits as a person can mean: four that count.
pub fn rounded(value: f32) -> String {
    let four_digits: f32 = format!("{value:.3e}").parse().unwrap_or(value);
    four_digits.to_string()
}
