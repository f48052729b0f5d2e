//! Settings of the next run and of its preset, and which of them may change in the current run.

use std::collections::BTreeMap;

use crate::studio::state::current_run::CurrentRun;
use snakes_core::evolve::{Settings, fields};
use snakes_core::schema::{Choices, ListedSetting, Section, list};
use snakes_core::score::Trial;
use snakes_core::world::PhysicsEngine;

/// Settings of the next run and of its preset, as texts by full dotted name.
#[derive(Debug, Default)]
pub struct Values {
    settings: Settings,
    settings_of_preset: Option<Settings>,
    settings_of_run: Settings,
    /// Declarations and values of the next run's settings.
    listed: Vec<ListedSetting>,
    now: BTreeMap<String, String>,
    preset: BTreeMap<String, String>,
    preset_name: String,
    /// Usual values of all settings: see [`usual_values`].
    usual: BTreeMap<String, String>,
    /// Whether each setting may change in the current run, with the reason if not.
    live: BTreeMap<String, Result<(), &'static str>>,
}

impl Values {
    /// Reads the values for a run.
    pub fn of(run: &CurrentRun) -> Self {
        let settings = run.next_settings().clone();
        let settings_of_preset = run.preset_settings().cloned();
        let live = list(run.settings()).into_iter().map(|listed| (listed.path, listed.live));
        Self {
            listed: list(&settings),
            now: fields(&settings).into_iter().collect(),
            preset: settings_of_preset.iter().flat_map(fields).collect(),
            preset_name: run.next_preset().to_owned(),
            usual: usual_values(),
            live: live.collect(),
            settings_of_run: run.settings().clone(),
            settings,
            settings_of_preset,
        }
    }

    /// Returns whether the values are up to date.
    pub fn are_of(&self, run: &CurrentRun) -> bool {
        self.settings == *run.next_settings()
            && self.settings_of_preset.as_ref() == run.preset_settings()
            && self.settings_of_run == *run.settings()
            && self.preset_name == run.next_preset()
            && !self.now.is_empty()
    }

    /// Returns the settings of the next run.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Returns the declarations and values of the next run's settings, in the order of their sections.
    pub fn listed(&self) -> &[ListedSetting] {
        &self.listed
    }

    /// Checks whether a setting may change in the current run. The error is a sentence with the reason.
    pub fn live(&self, field: &str) -> Result<(), &'static str> {
        self.live.get(field).copied().unwrap_or(Ok(()))
    }

    /// Returns the value of a setting in the next run; `None` if the setting does not exist at present.
    pub fn now(&self, field: &str) -> Option<&str> {
        self.now.get(field).map(String::as_str)
    }

    /// Returns the value of a setting in the preset, if it exists there.
    pub fn in_preset(&self, field: &str) -> Option<&str> {
        self.preset.get(field).map(String::as_str)
    }

    /// Returns the name of the next run's preset.
    pub fn preset_name(&self) -> &str {
        &self.preset_name
    }

    /// Returns the value of a setting in the preset, if it differs from that in the next run.
    pub fn changed_from(&self, field: &str) -> Option<&str> {
        let preset = self.in_preset(field)?;
        (self.now(field)? != preset).then_some(preset)
    }

    /// Returns whether a setting differs from the preset, or from its usual value.
    pub fn is_special(&self, field: &str) -> bool {
        let is_unusual = || self.now(field) != self.usual.get(field).map(String::as_str);
        self.changed_from(field).is_some() || is_unusual()
    }

    /// Returns the changes that reset these settings to the preset's values.
    pub fn back<'a>(&self, fields: impl IntoIterator<Item = &'a str>) -> Vec<(String, String)> {
        let back = |field: &str| {
            let preset = self.changed_from(field)?.to_owned();
            Some((field.to_owned(), preset))
        };
        fields.into_iter().filter_map(back).collect()
    }
}

/// Returns the usual values of all settings: the defaults without a preset, but with the engine *lanes*.
fn usual_values() -> BTreeMap<String, String> {
    let all = every_setting().into_iter().map(|of| (of.path, of.value.to_string()));
    let engine = PhysicsEngine::Lanes.choice().name.to_owned();
    all.chain([(Trial::ENGINE_FIELD.to_owned(), engine)]).collect()
}

/// Returns every possible setting, including those of a separate ground.
pub fn every_setting() -> Vec<ListedSetting> {
    let mut settings = Settings::default();
    settings.trial.ground = Some(settings.trial.surface.clone());
    list(&settings)
}

/// Returns the sections of these settings in order.
pub fn sections_of<'a>(listed: impl IntoIterator<Item = &'a ListedSetting>) -> Vec<Section> {
    let mut sections: Vec<Section> = listed.into_iter().map(|listed| listed.section).collect();
    // The settings of a section are adjacent.
    sections.dedup();
    sections
}

/// Parses a list: `[1, 2]`.
pub fn numbers(text: &str) -> Option<Vec<f32>> {
    let inside = text.trim().strip_prefix('[')?.strip_suffix(']')?;
    inside.split(',').map(|number| number.trim().parse().ok()).collect()
}

/// Formats a list as setting text.
pub fn list_of(numbers: &[f32]) -> String {
    let texts: Vec<String> = numbers.iter().map(f32::to_string).collect();
    format!("[{}]", texts.join(", "))
}

/// Rounds a slider's value to four significant digits, and returns it as text.
pub fn rounded(value: f32) -> String {
    let four_digits: f32 = format!("{value:.3e}").parse().unwrap_or(value);
    four_digits.to_string()
}
