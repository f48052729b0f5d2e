//! Rows of the schema: name, label, unit, hint, range or choices, rule for changes.

use std::marker::PhantomData;
use std::ops::RangeInclusive;

use super::display::DisplayUnit;
use super::parts::Parts;
use super::value::SettingValue;
use super::{Choice, Choices, PerPart};
use crate::check::{Invalid, within};

/// A setting: everything the program knows of it, apart from its value.
#[derive(Debug, Clone, Copy)]
pub struct Setting {
    /// The name of its field.
    pub name: &'static str,
    /// The name in panels.
    pub label: &'static str,
    /// Its unit in files and flags; empty if it has none.
    pub unit: &'static str,
    /// The unit in which panels show it, if that is another.
    pub display: Option<DisplayUnit>,
    /// Whether a panel shows it only among the advanced settings of its section.
    pub is_advanced: bool,
    /// Its effect on the snake or on the search.
    pub hint: &'static str,
    /// The type and range of its values.
    pub kind: SettingKind,
    /// Reason why it may not change during a run, as a sentence; none if it may.
    pub(super) fixed: Option<&'static str>,
}

/// The type and range of the values of a setting.
#[derive(Debug, Clone, Copy)]
pub enum SettingKind {
    /// A number; if the range allows it, also one for each part, or no value.
    Number(NumberRange),
    /// Several numbers.
    List(NumberRange),
    /// One of some names.
    Choice(fn() -> Vec<Choice>),
    /// On or off.
    Switch,
    /// An optional group of settings that is absent; the text says how to add it.
    Absent(&'static str),
}

/// The numbers that a setting may have.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NumberRange {
    /// The least.
    pub least: f32,
    /// The greatest.
    pub most: f32,
    /// Whether only whole numbers are allowed.
    pub is_whole: bool,
    /// The ends of its slider; none: it has no slider.
    pub slider: Option<[f32; 2]>,
    /// From this value up the slider is logarithmic; none: it is linear.
    pub logarithmic_from: Option<f32>,
    /// The parts of the snake or the stairs that may have a value each.
    pub parts: Parts,
    /// The value with which an optional setting begins; none: the setting is not optional.
    pub begins_with: Option<f32>,
}

/// Something of a run without which some settings have no effect, such as soft limbs; the text says what. A row names what
/// its setting needs, and a group that knows the run says whether it has that ([`Walk::meet`](super::Walk::meet)).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Need(pub &'static str);

/// The row of a setting whose field is a `T`.
#[derive(Debug, Clone, Copy)]
pub struct SettingRow<T> {
    pub(super) setting: Setting,
    pub(super) is_used: bool,
    pub(super) need: Option<Need>,
    field: PhantomData<fn(&mut T)>,
}

fn row<T>(label: &'static str, kind: SettingKind) -> SettingRow<T> {
    let setting = Setting {
        name: "",
        label,
        unit: "",
        display: None,
        is_advanced: false,
        hint: "",
        kind,
        fixed: None,
    };
    SettingRow { setting, is_used: true, need: None, field: PhantomData }
}

fn numbers(least: f32, most: f32) -> NumberRange {
    NumberRange {
        least,
        most,
        is_whole: false,
        slider: None,
        logarithmic_from: None,
        parts: Parts::One,
        begins_with: None,
    }
}

fn numbers_in(range: RangeInclusive<f32>) -> NumberRange {
    numbers(*range.start(), *range.end())
}

/// A number.
pub fn number(label: &'static str, range: RangeInclusive<f32>) -> SettingRow<f32> {
    row(label, SettingKind::Number(numbers_in(range)))
}

/// A whole number. Its greatest value is at most 2^24, up to which a slider's numbers are exact.
pub fn whole(label: &'static str, range: RangeInclusive<u32>) -> SettingRow<u32> {
    let range = numbers(*range.start() as f32, *range.end() as f32);
    row(label, SettingKind::Number(NumberRange { is_whole: true, ..range }))
}

/// A number for all parts, or one for each.
pub fn per_part(
    label: &'static str,
    range: RangeInclusive<f32>,
    parts: Parts,
) -> SettingRow<PerPart> {
    row(label, SettingKind::Number(NumberRange { parts, ..numbers_in(range) }))
}

/// A number for all parts, one for each, or no value: then each genome has its own. A panel begins with `begins_with`.
pub fn optional_per_part(
    label: &'static str,
    range: RangeInclusive<f32>,
    parts: Parts,
    begins_with: f32,
) -> SettingRow<Option<PerPart>> {
    let begins_with = Some(begins_with);
    let range = NumberRange { parts, begins_with, ..numbers_in(range) };
    row(label, SettingKind::Number(range))
}

/// A list of 1 to [`LONGEST_LIST`] numbers.
pub fn list_of_numbers(label: &'static str, range: RangeInclusive<f32>) -> SettingRow<Vec<f32>> {
    row(label, SettingKind::List(numbers_in(range)))
}

/// The most numbers in a list.
const LONGEST_LIST: usize = 100;

/// One of some names.
pub fn choice<T: Choices>(label: &'static str) -> SettingRow<T> {
    row(label, SettingKind::Choice(T::choices))
}

/// On or off.
pub fn switch(label: &'static str) -> SettingRow<bool> {
    row(label, SettingKind::Switch)
}

/// An optional group of settings that is absent; `how` says how to add it.
pub fn absent(label: &'static str, how: &'static str) -> SettingRow<()> {
    row(label, SettingKind::Absent(how))
}

impl<T> SettingRow<T> {
    /// Gives the setting the unit of files and flags. Panels show angles in degrees: see [`DisplayUnit::of_unit`].
    pub fn unit(mut self, unit: &'static str) -> Self {
        self.setting.unit = unit;
        self.setting.display = DisplayUnit::of_unit(unit);
        self
    }

    /// Lets panels show the setting only among the advanced settings of its section.
    pub fn advanced(mut self) -> Self {
        self.setting.is_advanced = true;
        self
    }

    /// Gives the setting a sentence, without its full stop, about its effect on the snake or on the search.
    pub fn hint(mut self, hint: &'static str) -> Self {
        self.setting.hint = hint;
        self
    }

    /// Gives the setting a slider between these values.
    pub fn slider(mut self, least: f32, most: f32) -> Self {
        if let SettingKind::Number(range) = &mut self.setting.kind {
            range.slider = Some([least, most]);
        }
        self
    }

    /// Makes the setting's slider logarithmic from a value up.
    pub fn logarithmic_from(mut self, value: f32) -> Self {
        if let SettingKind::Number(range) = &mut self.setting.kind {
            range.logarithmic_from = Some(value);
        }
        self
    }

    /// Restricts the effect of the setting to runs that meet a need.
    pub fn needs(mut self, need: Need) -> Self {
        self.need = Some(need);
        self
    }

    /// Sets whether it has an effect, given the other settings of its group.
    pub fn used_if(mut self, is_used: bool) -> Self {
        self.is_used = is_used;
        self
    }

    /// Forbids changes of the setting during a run; the reason is a sentence.
    pub fn fixed(mut self, reason: &'static str) -> Self {
        self.setting.fixed = Some(reason);
        self
    }
}

impl Setting {
    /// Its label with the unit of panels.
    pub fn title(&self) -> String {
        match self.shown_unit() {
            "" => self.label.to_owned(),
            unit => format!("{}, {unit}", self.label),
        }
    }

    /// Its name in words, without the unit at its end: `rise_m` is "rise".
    pub fn short_name(&self) -> String {
        let name = self.name;
        let short = UNITS_IN_NAMES.iter().find_map(|unit| name.strip_suffix(unit));
        short.unwrap_or(name).replace('_', " ")
    }

    /// The texts for one number or for the list, in words and in the unit of files; empty for a choice and a switch.
    pub fn range_in_words(&self) -> String {
        let unit = if self.unit.is_empty() { String::new() } else { format!(" {}", self.unit) };
        let ends = |range: &NumberRange| (range.least.to_string(), range.most.to_string());
        self.range_with(&unit, ends)
    }

    /// The range in words, with the ends as `ends` writes them.
    pub(super) fn range_with(
        &self,
        unit: &str,
        ends: impl Fn(&NumberRange) -> (String, String),
    ) -> String {
        match &self.kind {
            SettingKind::Number(range) => {
                let whole = if range.is_whole { ", whole numbers" } else { "" };
                let (least, most) = ends(range);
                format!("{least} to {most}{unit}{whole}")
            }
            SettingKind::List(range) => {
                let (least, most) = ends(range);
                format!("numbers from {least} to {most}{unit}, with commas between them")
            }
            SettingKind::Choice(_) | SettingKind::Switch | SettingKind::Absent(_) => String::new(),
        }
    }

    /// Every text that [`Self::parse`] accepts, in words.
    pub fn allowed(&self) -> String {
        match &self.kind {
            SettingKind::Number(range) => {
                let list =
                    if range.parts == Parts::One { "" } else { ", or a list such as [1, 2]" };
                let none = if range.begins_with.is_none() { "" } else { ", or none" };
                format!("{}{list}{none}", self.range_in_words())
            }
            SettingKind::List(_) => {
                format!("a list such as [0.6, 0.8], {}", self.range_in_words())
            }
            SettingKind::Choice(choices) => names(*choices).join(", "),
            SettingKind::Switch => "true, false".to_owned(),
            SettingKind::Absent(how) => (*how).to_owned(),
        }
    }

    /// Reads a value from a text. It may still be out of range: see [`Self::check`].
    pub fn parse(&self, text: &str) -> Option<SettingValue> {
        match &self.kind {
            SettingKind::Number(range) if range.is_whole => {
                text.parse().ok().map(SettingValue::Whole)
            }
            SettingKind::Number(range) => {
                if text == "none" && range.begins_with.is_some() {
                    return Some(SettingValue::None);
                }
                let list = || parse_list(text).filter(|_| range.parts != Parts::One);
                parse_number(text)
                    .map(SettingValue::Number)
                    .or_else(|| list().map(SettingValue::List))
            }
            SettingKind::List(_) => parse_list(text).map(SettingValue::List),
            SettingKind::Choice(choices) => {
                let name = names(*choices).into_iter().find(|name| *name == text);
                name.map(SettingValue::Name)
            }
            SettingKind::Switch => text.parse().ok().map(SettingValue::Switch),
            SettingKind::Absent(_) => (text == "none").then_some(SettingValue::None),
        }
    }

    /// Checks a value against the range; `path` is what errors call it.
    ///
    /// # Errors
    /// It is out of range, or a list of the wrong length.
    pub fn check(&self, path: &str, value: &SettingValue) -> Result<(), Invalid> {
        match (&self.kind, value) {
            (SettingKind::Number(range), SettingValue::Number(number)) => {
                within(path, *number, range.least..=range.most)
            }
            (SettingKind::Number(range), SettingValue::Whole(number)) => {
                within(path, f64::from(*number), range.least.into()..=range.most.into())
            }
            (SettingKind::Number(range), SettingValue::List(numbers)) => {
                let count = range.parts.count();
                if numbers.len() != count {
                    let allowed = format!("one value, or a list of {count}");
                    return Err(Invalid::new(
                        path,
                        format!("a list of {}", numbers.len()),
                        allowed,
                    ));
                }
                numbers.iter().enumerate().try_for_each(|(index, &number)| {
                    within(&format!("{path}[{index}]"), number, range.least..=range.most)
                })
            }
            (SettingKind::List(range), SettingValue::List(numbers)) => {
                if !(1..=LONGEST_LIST).contains(&numbers.len()) {
                    let allowed = format!("1 to {LONGEST_LIST} values");
                    return Err(Invalid::new(path, format!("{} values", numbers.len()), allowed));
                }
                numbers
                    .iter()
                    .try_for_each(|&number| within(path, number, range.least..=range.most))
            }
            _ => Ok(()),
        }
    }

    /// Whether each of these words occurs in its label, name, hint or choices.
    pub fn is_about(&self, words: &str) -> bool {
        let mut text = format!("{} {} {}", self.title(), self.name.replace('_', " "), self.hint);
        if let SettingKind::Choice(choices) = self.kind {
            for choice in choices() {
                text += &format!(" {} {}", choice.title, choice.name.replace('_', " "));
            }
        }
        let text = text.to_lowercase();
        words.to_lowercase().split_whitespace().all(|word| text.contains(word))
    }
}

fn names(choices: fn() -> Vec<Choice>) -> Vec<&'static str> {
    choices().iter().map(|choice| choice.name).collect()
}

/// A finite number. It is read as a 64-bit float first, as the settings of older runs were.
#[expect(clippy::cast_possible_truncation, reason = "a setting is a 32-bit float")]
fn parse_number(text: &str) -> Option<f32> {
    text.parse::<f64>().ok().map(|number| number as f32).filter(|number| number.is_finite())
}

/// The numbers of a text such as `[1, 2]`.
fn parse_list(text: &str) -> Option<Vec<f32>> {
    let inside = text.trim().strip_prefix('[')?.strip_suffix(']')?.trim();
    if inside.is_empty() {
        return Some(Vec::new());
    }
    inside.split(',').map(|number| parse_number(number.trim())).collect()
}

/// The units with which names of settings end, the longer ones first.
const UNITS_IN_NAMES: [&str; 10] =
    ["_nms_per_rad", "_m_s_per_n", "_kg_m3", "_per_s", "_m_s2", "_m_s", "_rad", "_nm", "_m", "_s"];
