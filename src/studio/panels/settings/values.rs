//! Settings of the next run and of its preset, and which of them may change in the current run.

use std::collections::BTreeMap;

use crate::studio::state::current_run::CurrentRun;
use snakes_core::evolve::Settings;
use snakes_core::schema::{Choices, ListedSetting, SettingValue, list};
use snakes_core::score::Trial;
use snakes_core::world::PhysicsEngine;

/// Settings of the next run and of its preset.
#[derive(Debug, Default)]
pub(super) struct Values {
    /// Settings of the next run.
    pub settings: Settings,
    settings_of_preset: Option<Settings>,
    settings_of_run: Settings,
    /// Declarations and values of the next run's settings, in the order of their sections.
    pub listed: Vec<ListedSetting>,
    /// Name of the next run's preset.
    pub preset_name: String,
    /// Values in the preset, by full dotted name.
    preset: BTreeMap<String, SettingValue>,
    /// Usual values of all settings, by full dotted name: the defaults without a preset, but with the engine *lanes*.
    usual: BTreeMap<String, SettingValue>,
    /// Whether each setting of the current run may change in it, by full dotted name. The error is a sentence with the reason.
    pub live: BTreeMap<String, Result<(), &'static str>>,
}

impl Values {
    /// Reads the values for a run.
    pub fn of(run: &CurrentRun) -> Self {
        let settings = run.next_settings().clone();
        let settings_of_preset = run.preset_settings().cloned();
        let values = |listed: Vec<ListedSetting>| listed.into_iter().map(|of| (of.path, of.value));
        let engine = SettingValue::Name(PhysicsEngine::Lanes.choice().name);
        let engine = (Trial::ENGINE_FIELD.to_owned(), engine);
        let live = list(run.settings()).into_iter().map(|listed| (listed.path, listed.live));
        Self {
            listed: list(&settings),
            preset: settings_of_preset.iter().flat_map(|preset| values(list(preset))).collect(),
            preset_name: run.plan_next.preset.clone(),
            usual: values(every_setting()).chain([engine]).collect(),
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
            && self.preset_name == run.plan_next.preset
            && !self.listed.is_empty()
    }

    /// Returns the value of a setting in the preset, if it differs from that in the next run.
    pub fn changed_from(&self, listed: &ListedSetting) -> Option<&SettingValue> {
        self.preset.get(&listed.path).filter(|preset| **preset != listed.value)
    }

    /// Returns whether a setting differs from the preset, or from its usual value.
    pub fn is_special(&self, listed: &ListedSetting) -> bool {
        self.changed_from(listed).is_some() || self.usual.get(&listed.path) != Some(&listed.value)
    }
}

/// Returns every possible setting, including those of a separate ground.
pub fn every_setting() -> Vec<ListedSetting> {
    let mut settings = Settings::default();
    settings.trial.ground = Some(settings.trial.surface.clone());
    list(&settings)
}

/// Parses a list: `[1, 2]`.
pub(super) fn numbers(text: &str) -> Option<Vec<f32>> {
    let inside = text.trim().strip_prefix('[')?.strip_suffix(']')?;
    inside.split(',').map(|number| number.trim().parse().ok()).collect()
}

/// Rounds a slider's value to four significant digits, and returns it as text.
pub(super) fn rounded(value: f32) -> String {
    let four_digits: f32 = format!("{value:.3e}").parse().unwrap_or(value);
    four_digits.to_string()
}
