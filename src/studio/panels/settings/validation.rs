//! Checks and normalises text that is typed for a setting.

use super::values::{Values, numbers};
use snakes_core::check::Invalid;
use snakes_core::evolve::with_field;
use snakes_core::schema::{ListedSetting, SettingKind, SettingValue};

impl Values {
    /// Converts text that is typed for a setting, in the unit of panels, to the setting's text, in the unit of files.
    ///
    /// # Errors
    /// The text is invalid; the message contains the setting, the value and the allowed range.
    pub fn typed(&self, listed: &ListedSetting, text: &str) -> Result<String, String> {
        let (typed, setting) = (text.trim(), &listed.setting);
        let unreadable = || {
            let allowed = setting.shown_range_in_words();
            format!("{} is \"{typed}\"; allowed: {allowed}", setting.label)
        };
        let text = match &setting.kind {
            SettingKind::Number(range) => {
                let text = setting.stored_text(&with_point(typed)).ok_or_else(unreadable)?;
                let is_number = if range.is_whole {
                    text.parse::<u32>().is_ok()
                } else {
                    text.parse::<f32>().is_ok_and(f32::is_finite)
                };
                let is_allowed = text.parse().is_ok_and(|value: f32| range.allows(value));
                // The message uses the setting's label.
                if !is_number || !is_allowed {
                    return Err(unreadable());
                }
                text
            }
            SettingKind::List(range) => {
                let inside = typed.trim_start_matches('[').trim_end_matches(']');
                let text = match setting.display {
                    None => format!("[{inside}]"),
                    Some(_) => stored_list(listed, inside).ok_or_else(unreadable)?,
                };
                let list = numbers(&text).ok_or_else(unreadable)?;
                let is_allowed = |number: &f32| range.allows(*number);
                // The check of the whole list would show the numbers in the unit of files.
                let is_shown_otherwise = setting.display.is_some();
                if list.iter().any(|number| !number.is_finite())
                    || (is_shown_otherwise && !list.iter().all(is_allowed))
                {
                    return Err(unreadable());
                }
                text
            }
            SettingKind::Choice(_) | SettingKind::Switch | SettingKind::Absent(_) => {
                typed.to_owned()
            }
        };
        self.whole(listed, &text).map(|()| text)
    }

    /// Checks the text of a setting, in the unit of files, together with all other settings.
    ///
    /// # Errors
    /// The text is invalid; the error is a message for the user.
    pub fn whole(&self, listed: &ListedSetting, text: &str) -> Result<(), String> {
        let checked = with_field(&self.settings, &listed.path, text);
        let checked = checked.and_then(|settings| settings.check_start());
        checked.map_err(|invalid| in_words(&invalid, &self.listed))
    }
}

/// Converts a list to the unit of files. A number whose text has not changed keeps all its digits, although the
/// text in the unit of panels is rounded.
fn stored_list(listed: &ListedSetting, typed: &str) -> Option<String> {
    let ListedSetting { setting, value, .. } = listed;
    let now = if let SettingValue::List(numbers) = value { numbers.as_slice() } else { &[] };
    let number = |(index, text): (usize, &str)| {
        let text = text.trim();
        let same = now.get(index).filter(|number| setting.shown_number(**number) == text);
        same.map(f32::to_string).or_else(|| setting.stored_text(text))
    };
    let stored: Option<Vec<String>> = typed.split(',').enumerate().map(number).collect();
    stored.map(|texts| format!("[{}]", texts.join(", ")))
}

/// Replaces a decimal comma, as in "0,5", by a point.
fn with_point(typed: &str) -> String {
    let is_comma = typed.matches(',').count() == 1 && !typed.contains('.');
    if is_comma { typed.replace(',', ".") } else { typed.to_owned() }
}

/// Returns an error message with the setting's label.
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
    use snakes_core::schema::{PerPart, list};

    fn typed(field: &str, text: &str) -> Result<String, String> {
        let mut values = Values::default();
        values.settings.trial.agent.limb_width_m = PerPart::Each(vec![1.0; 5]);
        values.listed = list(&values.settings);
        let listed = values.listed.iter().find(|listed| listed.path == field);
        values.typed(listed.expect("a setting"), text)
    }

    #[test]
    fn typed_text_is_normalised() {
        assert_eq!(typed("trial.stairs.rise_m", " 0,7 "), Ok("0.7".to_owned()));
        assert_eq!(typed("trial.stairs.rise_m", "4.5"), Ok("4.5".to_owned()), "beyond the slider");
        assert_eq!(typed("trial.stairs.steps", "12"), Ok("12".to_owned()));
        let list = typed("genome.bend_limits_rad", "34.38, 45.84,90");
        let expected = Ok("[0.6, 0.8, 1.5707964]".to_owned());
        assert_eq!(list, expected, "unchanged ones keep their digits");
        let limit = typed("trial.agent.bend_limit_rad", "45");
        assert_eq!(limit, Ok(std::f32::consts::FRAC_PI_4.to_string()), "degrees become radians");
    }

    #[test]
    fn messages_have_label_value_and_range() {
        let (rise, bends) = ("trial.stairs.rise_m", "genome.bend_limits_rad");
        let of_rise = "-5 to -0.01 or 0.01 to 5 m";
        let of_bends = "numbers from 0 to 171.88°, with commas between them";
        for (field, text, label, allowed) in [
            (rise, "9", "Rise", of_rise),
            (rise, "high", "Rise", of_rise),
            (rise, "NaN", "Rise", of_rise),
            ("trial.stairs.steps", "2.5", "Steps", "0 to 100, whole numbers"),
            (bends, "0.6, x", "Bend limits to choose from", of_bends),
            (bends, "0.6, 172", "Bend limits to choose from", of_bends),
            ("trial.agent.twist_limit_rad", "200", "Twist limit", "0 to 171.88°"),
        ] {
            let message = format!("{label} is \"{text}\"; allowed: {allowed}");
            assert_eq!(typed(field, text), Err(message));
        }
        // The value is in conflict with another setting.
        let message = "Block width is a list of 5; allowed: one value, or a list of 6";
        assert_eq!(typed("trial.agent.limbs", "6"), Err(message.to_owned()));
    }
}
