//! Checks and normalises text typed into a setting.

use super::values::numbers;
use crate::check::Invalid;
use crate::evolve::{Settings, with_field};
use crate::schema::{ListedSetting, Setting, SettingKind};

/// A setting being typed, with all others.
#[derive(Clone, Copy)]
pub struct Check<'a> {
    /// Current settings.
    pub settings: &'a Settings,
    /// Full dotted name.
    pub field: &'a str,
    /// Its row.
    pub setting: &'a Setting,
    /// All settings with their rows.
    pub all: &'a [ListedSetting],
}

impl Check<'_> {
    /// The setting's text for the typed text.
    ///
    /// # Errors
    /// The text is invalid; the message has the setting, the value and the allowed range.
    pub fn typed(&self, text: &str) -> Result<String, String> {
        let typed = text.trim();
        let unreadable = || {
            format!(
                "{} is \"{typed}\"; allowed: {}",
                self.setting.label,
                self.setting.range_in_words()
            )
        };
        let text = match &self.setting.kind {
            SettingKind::Number(range) => {
                let text = with_point(typed);
                let is_number = if range.is_whole {
                    text.parse::<u32>().is_ok()
                } else {
                    text.parse::<f32>().is_ok_and(f32::is_finite)
                };
                let allowed = range.least..=range.most;
                let is_allowed = text.parse().is_ok_and(|value: f32| allowed.contains(&value));
                // Use the label in the message.
                if !is_number || !is_allowed {
                    return Err(unreadable());
                }
                text
            }
            SettingKind::List(_) => {
                let text = format!("[{}]", typed.trim_start_matches('[').trim_end_matches(']'));
                let list = numbers(&text).ok_or_else(unreadable)?;
                if list.iter().any(|number| !number.is_finite()) {
                    return Err(unreadable());
                }
                text
            }
            SettingKind::Choice(_) | SettingKind::Switch | SettingKind::Absent(_) => {
                typed.to_owned()
            }
        };
        self.whole(&text).map(|()| text)
    }

    /// Checks the text together with all other settings.
    ///
    /// # Errors
    /// The text is invalid, in words.
    pub fn whole(&self, text: &str) -> Result<(), String> {
        let checked = with_field(self.settings, self.field, text);
        checked.map(drop).map_err(|invalid| in_words(&invalid, self.all))
    }
}

/// Accepts a decimal comma: "0,5".
fn with_point(typed: &str) -> String {
    let is_comma = typed.matches(',').count() == 1 && !typed.contains('.');
    if is_comma { typed.replace(',', ".") } else { typed.to_owned() }
}

/// Error message with the setting's label.
fn in_words(invalid: &Invalid, all: &[ListedSetting]) -> String {
    let Invalid { field, value, allowed } = invalid;
    let (path, index) = field
        .split_once('[')
        .map_or((field.as_str(), ""), |(path, rest)| (path, rest.trim_end_matches(']')));
    let known = all.iter().find(|listed| listed.path == path);
    let name = known.map_or(path, |listed| listed.setting.label);
    match index.parse::<u32>() {
        Ok(index) => format!("{name}, number {}, is {value}; allowed: {allowed}", index + 1),
        Err(_) => format!("{name} is {value}; allowed: {allowed}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::schema::list;

    fn typed(field: &str, text: &str) -> Result<String, String> {
        let mut settings = Settings::default();
        settings.trial.agent.limb_width_m = crate::schema::PerPart::Each(vec![1.0; 5]);
        let all = list(&settings);
        let listed = all.iter().find(|listed| listed.path == field).expect("a setting");
        Check { settings: &settings, field, setting: &listed.setting, all: &all }.typed(text)
    }

    #[test]
    fn typed_text_is_normalised() {
        assert_eq!(typed("trial.stairs.rise_m", " 0,7 "), Ok("0.7".to_owned()));
        assert_eq!(typed("trial.stairs.rise_m", "4.5"), Ok("4.5".to_owned()), "beyond the slider");
        assert_eq!(typed("trial.stairs.steps", "12"), Ok("12".to_owned()));
        let list = typed("genome.bend_limits_rad", "0.6, 0.8,1");
        assert_eq!(list, Ok("[0.6, 0.8,1]".to_owned()));
    }

    #[test]
    fn messages_have_label_value_and_range() {
        for (field, text, message) in [
            ("trial.stairs.rise_m", "9", "Rise is \"9\"; allowed: 0.01 to 5 m"),
            ("trial.stairs.rise_m", "high", "Rise is \"high\"; allowed: 0.01 to 5 m"),
            ("trial.stairs.rise_m", "NaN", "Rise is \"NaN\"; allowed: 0.01 to 5 m"),
            ("trial.stairs.steps", "2.5", "Steps is \"2.5\"; allowed: 0 to 100, whole numbers"),
            (
                "genome.bend_limits_rad",
                "0.6, x",
                "Bend limits to choose from is \"0.6, x\"; allowed: numbers from 0 to 3 rad, with \
                 commas between them",
            ),
            (
                "genome.bend_limits_rad",
                "0.6, 4",
                "Bend limits to choose from is 4; allowed: 0 to 3",
            ),
            // The value conflicts with another setting.
            (
                "trial.agent.limbs",
                "6",
                "Limb width is a list of 5; allowed: one value, or a list of 6",
            ),
        ] {
            assert_eq!(typed(field, text), Err(message.to_owned()));
        }
    }
}
