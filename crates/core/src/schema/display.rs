//! Units of panels that differ from the units of files: angles are stored in radians and shown in degrees.

use super::range::NumberRange;
use super::setting::{Setting, SettingKind};
use super::value::SettingValue;

/// A unit of panels, and its relation to the unit of files.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DisplayUnit {
    /// Symbol of the unit, as panels write it.
    pub unit: &'static str,
    /// Number that panels show for a stored 1.
    pub factor: f64,
}

/// Decimals that panels show of a number that was not typed in the unit of panels, such as 0.6 rad.
const ROUNDED_DECIMALS: usize = 2;
/// Greatest number of decimals with which a typed number is shown digit by digit. A number that needs more decimals was probably not typed,
/// and is rounded.
const TYPED_DECIMALS: usize = 4;

impl DisplayUnit {
    /// Degrees, for angles in radians.
    pub const DEGREES: Self = Self { unit: "°", factor: 180.0 / std::f64::consts::PI };

    /// Returns the unit in which panels show numbers with this unit of files. None: panels use the unit of files.
    pub fn of_unit(unit: &str) -> Option<Self> {
        (unit == "rad").then_some(Self::DEGREES)
    }

    /// Returns the stored number that is nearest to a shown number.
    #[expect(clippy::cast_possible_truncation, reason = "a setting is a 32-bit float")]
    pub fn stored(self, shown: f64) -> f32 {
        (shown / self.factor) as f32
    }

    /// Returns the number that panels show for a stored number.
    pub fn shown(self, stored: f32) -> f64 {
        f64::from(stored) * self.factor
    }

    /// Returns the text that panels show for a stored number. A number that was typed in this unit with up to four decimals has the typed
    /// digits; any other is rounded.
    pub fn text(self, stored: f32) -> String {
        let shown = self.shown(stored);
        let typed = (0..=TYPED_DECIMALS).map(|decimals| format!("{shown:.decimals$}"));
        let is_same = |text: &String| text.parse().is_ok_and(|typed| self.stored(typed) == stored);
        let exact = typed.into_iter().find(is_same);
        exact.unwrap_or_else(|| trimmed(format!("{shown:.ROUNDED_DECIMALS$}")))
    }

    /// Converts a bound of a range to the unit of panels, rounded to hundredths towards the inside of the range.
    fn bound(self, stored: f32, is_upper: bool) -> f32 {
        let hundredths = self.shown(stored) * 100.0;
        let inside = if is_upper { hundredths.floor() } else { hundredths.ceil() };
        #[expect(clippy::cast_possible_truncation, reason = "a slider has 32-bit floats")]
        let bound = (inside / 100.0) as f32;
        bound
    }
}

/// Returns a number's text without zeros at the end of its decimals.
fn trimmed(text: String) -> String {
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}

impl Setting {
    /// Returns the unit in which panels show the setting; empty if the setting has no unit.
    pub fn shown_unit(&self) -> &'static str {
        self.display.map_or(self.unit, |display| display.unit)
    }

    /// Returns the text of a number as panels show it, without its unit.
    pub fn shown_number(&self, stored: f32) -> String {
        self.display.map_or_else(|| stored.to_string(), |display| display.text(stored))
    }

    /// Returns the text of a value as panels show it, without its unit.
    pub fn shown_value(&self, value: &SettingValue) -> String {
        match (self.display, value) {
            (Some(_), SettingValue::Number(number)) => self.shown_number(*number),
            (Some(_), SettingValue::List(numbers)) => {
                let texts: Vec<String> =
                    numbers.iter().map(|number| self.shown_number(*number)).collect();
                format!("[{}]", texts.join(", "))
            }
            _ => value.to_string(),
        }
    }

    /// Converts the text of a value from the form of files and flags to the form of panels.
    pub fn shown_text(&self, text: &str) -> String {
        match self.display.and(self.parse(text)) {
            Some(value) => self.shown_value(&value),
            None => text.to_owned(),
        }
    }

    /// Returns the text of a value within a sentence. The unit follows only where panels show another unit than files.
    pub fn value_in_words(&self, value: &SettingValue) -> String {
        let unit = match value {
            SettingValue::Switch(true) => return "on".to_owned(),
            SettingValue::Switch(false) => return "off".to_owned(),
            SettingValue::Name(name) => {
                let SettingKind::Choice(choices) = self.kind else { return name.to_string() };
                let chosen = choices().into_iter().find(|choice| choice.name == *name);
                return chosen.map_or(name.to_string(), |choice| choice.title.to_owned());
            }
            SettingValue::None => "",
            _ => self.display.map_or("", |display| display.unit),
        };
        format!("{}{unit}", self.shown_value(value))
    }

    /// Converts a number that a person typed in the unit of panels to the text for files and flags. None if it is not a number.
    pub fn stored_text(&self, typed: &str) -> Option<String> {
        let Some(display) = self.display else { return Some(typed.to_owned()) };
        let shown: f64 = typed.parse().ok()?;
        shown.is_finite().then(|| display.stored(shown).to_string())
    }

    /// Converts a range to the unit of panels.
    pub fn shown_range(&self, range: &NumberRange) -> NumberRange {
        let Some(display) = self.display else { return *range };
        let (least, most) = (display.bound(range.least, false), display.bound(range.most, true));
        let slider =
            range.slider.map(|[from, to]| [display.bound(from, false), display.bound(to, true)]);
        let logarithmic_from = range.logarithmic_from.map(|from| display.bound(from, false));
        let gap = range.gap.map(|[from, to]| [display.bound(from, true), display.bound(to, false)]);
        NumberRange { least, most, slider, logarithmic_from, gap, ..*range }
    }

    /// Describes in words, in the unit of panels, the range of the setting's number or numbers.
    pub fn shown_range_in_words(&self) -> String {
        let Some(display) = self.display else { return self.range_in_words() };
        self.range_with(display.unit, |range| self.shown_range(range))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::schema::{Parts, number, optional_per_part};

    const DEGREES: DisplayUnit = DisplayUnit::DEGREES;

    fn angle() -> Setting {
        number("Angle", 0.0..=3.0).unit("rad").slider(0.0, 3.0).setting
    }

    #[test]
    fn an_angle_typed_in_hundredths_of_a_degree_is_read_back_with_the_same_digits() {
        for hundredths in 0..=18_000_u32 {
            let typed = trimmed(format!("{}.{:02}", hundredths / 100, hundredths % 100));
            let stored = angle().stored_text(&typed).expect("a number");
            let stored: f32 = stored.parse().expect("a number");
            assert_eq!(DEGREES.text(stored), typed);
        }
    }

    #[test]
    fn a_typed_angle_becomes_the_nearest_32_bit_float() {
        for typed in ["57.2958", "45", "0.01", "171.88", "103.1324"] {
            let stored: f32 =
                angle().stored_text(typed).and_then(|text| text.parse().ok()).expect(typed);
            let exact = typed.parse::<f64>().expect(typed).to_radians();
            let off = |number: f32| (f64::from(number) - exact).abs();
            assert!(off(stored) <= off(stored.next_up()), "{typed}");
            assert!(off(stored) <= off(stored.next_down()), "{typed}");
            assert_eq!(DEGREES.text(stored), typed);
        }
    }

    #[test]
    fn an_angle_of_a_file_is_rounded_unless_a_few_digits_are_exact() {
        let shown = [0.6, 0.8, 1.0, 1.8, 0.0, 3.0].map(|stored| DEGREES.text(stored));
        assert_eq!(shown, ["34.38", "45.84", "57.3", "103.1324", "0", "171.89"]);
    }

    #[test]
    fn panels_have_degrees_where_files_have_radians() {
        let angle = angle();
        assert_eq!((angle.unit, angle.title().as_str()), ("rad", "Angle, °"));
        assert_eq!(angle.range_in_words(), "0 to 3 rad");
        assert_eq!(angle.shown_range_in_words(), "0 to 171.88°");
        assert_eq!(angle.shown_text("[0.6, 1]"), "[0.6, 1]", "this one has no list");
        assert_eq!(angle.shown_text("0.6"), "34.38");
        assert_eq!(angle.value_in_words(&SettingValue::Number(0.6)), "34.38°");
        let limits =
            optional_per_part("Limit", 0.0..=3.0, Parts::Joints(2), 1.0).unit("rad").setting;
        assert_eq!(limits.shown_text("[0.6, 1]"), "[34.38, 57.3]");
        assert_eq!(limits.shown_text("none"), "none");
        assert_eq!(limits.value_in_words(&SettingValue::None), "none");
    }

    #[test]
    fn the_ends_of_a_range_can_be_typed() {
        let angle = angle();
        let crate::schema::SettingKind::Number(range) = angle.kind else { panic!("a number") };
        let shown = angle.shown_range(&range);
        assert_eq!((shown.slider, shown.most), (Some([0.0, 171.88]), 171.88));
        for end in [shown.least, shown.most] {
            let stored: f32 = angle
                .stored_text(&end.to_string())
                .and_then(|text| text.parse().ok())
                .expect("a number");
            assert!((range.least..=range.most).contains(&stored), "{end}");
        }
    }

    #[test]
    fn a_setting_without_another_unit_is_shown_as_it_is_stored() {
        let rise = number("Rise", 0.0..=3.0).unit("m").setting;
        assert_eq!((rise.title().as_str(), rise.shown_text("0.5").as_str()), ("Rise, m", "0.5"));
        assert_eq!(rise.value_in_words(&SettingValue::Number(0.5)), "0.5");
        assert_eq!(rise.shown_range_in_words(), "0 to 3 m");
    }
}
