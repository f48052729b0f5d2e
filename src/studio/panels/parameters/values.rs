//! What the settings are now, and what they are in the preset: as text, by name.

use std::collections::BTreeMap;

use crate::evolve::{Settings, fields};
use crate::studio::evolution::Evolution;

/// The values of the next run and of its preset.
#[derive(Debug, Default)]
pub struct Values {
    /// Of which settings.
    settings: Settings,
    /// Of which preset's settings, if they are known.
    of_preset: Option<Settings>,
    now: BTreeMap<String, String>,
    preset: BTreeMap<String, String>,
    /// What the preset is called.
    preset_name: String,
}

impl Values {
    /// The values of a run's next settings.
    pub fn of(run: &Evolution) -> Self {
        let (settings, of_preset) = (run.next_settings().clone(), run.preset_settings().cloned());
        Self {
            now: fields(&settings).into_iter().collect(),
            preset: of_preset.iter().flat_map(fields).collect(),
            preset_name: run.next_preset().to_owned(),
            settings,
            of_preset,
        }
    }

    /// Whether they are still those of a run.
    pub fn are_of(&self, run: &Evolution) -> bool {
        self.settings == *run.next_settings()
            && self.of_preset.as_ref() == run.preset_settings()
            && self.preset_name == run.next_preset()
            && !self.now.is_empty()
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

    /// What gives all settings that begin like this the preset's values again.
    pub fn back(&self, fields: impl IntoIterator<Item = String>) -> Vec<(String, String)> {
        let back = |field: String| {
            let preset = self.changed_from(&field)?.to_owned();
            Some((field, preset))
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
