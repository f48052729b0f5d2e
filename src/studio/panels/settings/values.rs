//! Settings of the next run and of its preset, and which of them may change in the current run.

use std::collections::BTreeMap;

use crate::studio::state::current_run::CurrentRun;
use snakes_core::evolve::{Settings, fields};
use snakes_core::schema::{Choices, ListedSetting, Section, list};
use snakes_core::score::Trial;
use snakes_core::world::PhysicsEngine;

/// Settings of the next run and of its preset.
#[derive(Debug, Default)]
pub struct Values {
    settings: Settings,
    settings_of_preset: Option<Settings>,
    settings_of_run: Settings,
    /// Rows of the next run's settings.
    listed: Vec<ListedSetting>,
    now: BTreeMap<String, String>,
    preset: BTreeMap<String, String>,
    preset_name: String,
    /// See [`usual_values`].
    usual: BTreeMap<String, String>,
    /// Whether a setting may change in the current run.
    live: BTreeMap<String, Result<(), &'static str>>,
}

impl Values {
    /// The values for a run.
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

    /// Whether they are up to date.
    pub fn are_of(&self, run: &CurrentRun) -> bool {
        self.settings == *run.next_settings()
            && self.settings_of_preset.as_ref() == run.preset_settings()
            && self.settings_of_run == *run.settings()
            && self.preset_name == run.next_preset()
            && !self.now.is_empty()
    }

    /// The settings of the next run.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Rows of the next run's settings, in the order of their sections.
    pub fn listed(&self) -> &[ListedSetting] {
        &self.listed
    }

    /// Whether a setting may change in the current run; if not, a sentence with the reason.
    pub fn live(&self, field: &str) -> Result<(), &'static str> {
        self.live.get(field).copied().unwrap_or(Ok(()))
    }

    /// The value of a setting; `None` if it does not exist at present.
    pub fn now(&self, field: &str) -> Option<&str> {
        self.now.get(field).map(String::as_str)
    }

    /// The value of a setting in the preset.
    pub fn in_preset(&self, field: &str) -> Option<&str> {
        self.preset.get(field).map(String::as_str)
    }

    /// Name of the preset.
    pub fn preset_name(&self) -> &str {
        &self.preset_name
    }

    /// The preset's value, if it differs from the current one.
    pub fn changed_from(&self, field: &str) -> Option<&str> {
        let preset = self.in_preset(field)?;
        (self.now(field)? != preset).then_some(preset)
    }

    /// Whether a setting differs from the preset, or from the value that it has without any preset.
    pub fn is_special(&self, field: &str) -> bool {
        let is_unusual = || self.now(field) != self.usual.get(field).map(String::as_str);
        self.changed_from(field).is_some() || is_unusual()
    }

    /// The changes that reset these settings to the preset's values.
    pub fn back<'a>(&self, fields: impl IntoIterator<Item = &'a str>) -> Vec<(String, String)> {
        let back = |field: &str| {
            let preset = self.changed_from(field)?.to_owned();
            Some((field.to_owned(), preset))
        };
        fields.into_iter().filter_map(back).collect()
    }
}

/// The usual values of all settings: those without a preset, and the engine of the default one.
fn usual_values() -> BTreeMap<String, String> {
    let all = every_setting().into_iter().map(|of| (of.path, of.value.to_string()));
    let engine = PhysicsEngine::Lanes.choice().name.to_owned();
    all.chain([(Trial::ENGINE_FIELD.to_owned(), engine)]).collect()
}

/// Every possible setting, including those of a separate ground.
pub fn every_setting() -> Vec<ListedSetting> {
    let mut settings = Settings::default();
    settings.trial.ground = Some(settings.trial.surface.clone());
    list(&settings)
}

/// The sections of these settings, in order.
pub fn sections_of<'a>(listed: impl IntoIterator<Item = &'a ListedSetting>) -> Vec<Section> {
    let mut sections: Vec<Section> = listed.into_iter().map(|listed| listed.section).collect();
    // Settings of one section are adjacent.
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

/// A slider's value, rounded to four significant digits.
pub fn rounded(value: f32) -> String {
    let four_digits: f32 = format!("{value:.3e}").parse().unwrap_or(value);
    four_digits.to_string()
}
