//! Rows of the schema: name, label, unit, hint, range or choices, and whether the setting may change during a run.

use std::marker::PhantomData;
use std::ops::RangeInclusive;

use super::display::DisplayUnit;
use super::parts::Parts;
use super::range::NumberRange;
use super::value::SettingValue;
use super::{Choice, Choices, PerPart};
use crate::check::{Invalid, within};

/// Row of the schema: everything that the program knows about a setting apart from its value.
#[derive(Debug, Clone, Copy)]
pub struct Setting {
    /// Name of the setting's field.
    pub name: &'static str,
    /// Name of the setting in panels.
    pub label: &'static str,
    /// Unit in files and flags; empty if the setting has none.
    pub unit: &'static str,
    /// Unit in which panels show the setting. None: the unit of files.
    pub display: Option<DisplayUnit>,
    /// Whether panels show the setting only among the advanced settings of its section.
    pub is_advanced: bool,
    /// Effect of the setting on the snake or on the search, as a sentence without its full stop.
    pub hint: &'static str,
    /// Type and range of the setting's values.
    pub kind: SettingKind,
    /// Reason why the setting may not change during a run, as a sentence. None: it may.
    pub(super) fixed: Option<&'static str>,
}

/// Type and range of the values of a setting.
#[derive(Debug, Clone, Copy)]
pub enum SettingKind {
    /// A single number; if the range allows it, also a number for each part, or no value.
    Number(NumberRange),
    /// A list of numbers.
    List(NumberRange),
    /// A name from the list that the function returns.
    Choice(fn() -> Vec<Choice>),
    /// A switch that is on or off.
    Switch,
    /// An optional group of settings that is absent; the text says how to add it.
    Absent(&'static str),
}

/// A property of a run, such as soft limbs, without which some settings have no effect; the text names it. A row states what its setting
/// needs, and a group that knows the run states which needs are met ([`Walk::meet`](super::Walk::meet)).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Need(pub &'static str);

/// Row of a setting whose field is a `T`, while it is built.
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

/// Makes the row of a number.
pub fn number(label: &'static str, range: RangeInclusive<f32>) -> SettingRow<f32> {
    row(label, SettingKind::Number(NumberRange::of(range)))
}

/// Makes the row of a whole number. Its greatest value is at most 2^24, up to which a slider's numbers are exact.
pub fn whole(label: &'static str, range: RangeInclusive<u32>) -> SettingRow<u32> {
    let range = NumberRange::of(*range.start() as f32..=*range.end() as f32);
    row(label, SettingKind::Number(NumberRange { is_whole: true, ..range }))
}

/// Makes the row of a number for all parts together or of a number for each part.
pub fn per_part(
    label: &'static str,
    range: RangeInclusive<f32>,
    parts: Parts,
) -> SettingRow<PerPart> {
    row(label, SettingKind::Number(NumberRange { parts, ..NumberRange::of(range) }))
}

/// Makes the row of a number for all parts together, of a number for each part, or of no value: each genome then has its own. Panels switch
/// the setting on with `begins_with`.
pub fn optional_per_part(
    label: &'static str,
    range: RangeInclusive<f32>,
    parts: Parts,
    begins_with: f32,
) -> SettingRow<Option<PerPart>> {
    let begins_with = Some(begins_with);
    let range = NumberRange { parts, begins_with, ..NumberRange::of(range) };
    row(label, SettingKind::Number(range))
}

/// Makes the row of a list of 1 to [`LONGEST_LIST`] numbers.
pub fn list_of_numbers(label: &'static str, range: RangeInclusive<f32>) -> SettingRow<Vec<f32>> {
    row(label, SettingKind::List(NumberRange::of(range)))
}

/// Greatest length of a list of numbers.
const LONGEST_LIST: usize = 100;

/// Makes the row of a setting whose value is a name of `T`.
pub fn choice<T: Choices>(label: &'static str) -> SettingRow<T> {
    row(label, SettingKind::Choice(T::choices))
}

/// Makes the row of a setting that is on or off.
pub fn switch(label: &'static str) -> SettingRow<bool> {
    row(label, SettingKind::Switch)
}

/// Makes the row of an optional group of settings that is absent; `how` says how to add the group.
pub fn absent(label: &'static str, how: &'static str) -> SettingRow<()> {
    row(label, SettingKind::Absent(how))
}

impl<T> SettingRow<T> {
    /// Sets the unit in files and flags. Panels show angles in degrees: see [`DisplayUnit::of_unit`].
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

    /// Sets the sentence, without its full stop, about the setting's effect on the snake or on the search.
    pub fn hint(mut self, hint: &'static str) -> Self {
        self.setting.hint = hint;
        self
    }

    /// Gives the setting a slider from `least` to `most`.
    pub fn slider(mut self, least: f32, most: f32) -> Self {
        if let SettingKind::Number(range) = &mut self.setting.kind {
            range.slider = Some([least, most]);
        }
        self
    }

    /// Forbids the numbers between `from` and `to`, which themselves are allowed.
    pub fn without(mut self, from: f32, to: f32) -> Self {
        if let SettingKind::Number(range) = &mut self.setting.kind {
            range.gap = Some([from, to]);
        }
        self
    }

    /// Makes the slider logarithmic from `value` up.
    pub fn logarithmic_from(mut self, value: f32) -> Self {
        if let SettingKind::Number(range) = &mut self.setting.kind {
            range.logarithmic_from = Some(value);
        }
        self
    }

    /// Limits the setting's effect to runs that meet `need`.
    pub fn needs(mut self, need: Need) -> Self {
        self.need = Some(need);
        self
    }

    /// Sets whether the setting has an effect, given the other settings of its group.
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
    /// Returns the label with the unit of panels.
    pub fn title(&self) -> String {
        match self.shown_unit() {
            "" => self.label.to_owned(),
            unit => format!("{}, {unit}", self.label),
        }
    }

    /// Returns the name in words, without the unit at its end: `rise_m` is "rise".
    pub fn short_name(&self) -> String {
        let name = self.name;
        let short = UNITS_IN_NAMES.iter().find_map(|unit| name.strip_suffix(unit));
        short.unwrap_or(name).replace('_', " ")
    }

    /// Describes the range of the number or of the list in words, in the unit of files; empty for other kinds of setting.
    pub fn range_in_words(&self) -> String {
        let unit = match self.unit {
            "" | "°" => self.unit.to_owned(),
            unit => format!(" {unit}"),
        };
        self.range_with(&unit, |range| *range)
    }

    /// Describes the range that `shown` makes of the setting's range.
    pub(super) fn range_with(
        &self,
        unit: &str,
        shown: impl Fn(&NumberRange) -> NumberRange,
    ) -> String {
        match &self.kind {
            SettingKind::Number(range) => {
                let whole = if range.is_whole { ", whole numbers" } else { "" };
                format!("{}{unit}{whole}", shown(range).in_words())
            }
            SettingKind::List(range) => {
                let range = shown(range).in_words();
                format!("numbers from {range}{unit}, with commas between them")
            }
            SettingKind::Choice(_) | SettingKind::Switch | SettingKind::Absent(_) => String::new(),
        }
    }

    /// Describes every text that [`Self::parse`] accepts, with the allowed range.
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

    /// Reads a value of the setting's type from a text. The value may be out of range: see [`Self::check`].
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

    /// Checks a value against the range; errors call it `path`.
    ///
    /// # Errors
    /// Fails if the value is out of range, or is a list of the wrong length.
    pub fn check(&self, path: &str, value: &SettingValue) -> Result<(), Invalid> {
        match (&self.kind, value) {
            (SettingKind::Number(range), SettingValue::Number(number)) => {
                range.check(path, *number)
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
                    range.check(&format!("{path}[{index}]"), number)
                })
            }
            (SettingKind::List(range), SettingValue::List(numbers)) => {
                if !(1..=LONGEST_LIST).contains(&numbers.len()) {
                    let allowed = format!("1 to {LONGEST_LIST} values");
                    return Err(Invalid::new(path, format!("{} values", numbers.len()), allowed));
                }
                numbers.iter().try_for_each(|&number| range.check(path, number))
            }
            _ => Ok(()),
        }
    }

    /// Returns whether each word of `words` occurs in the label, name, hint or choices, in any case.
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

/// Reads a finite number. The text is read as a 64-bit float and then rounded to 32 bits, as in the first files of settings.
#[expect(clippy::cast_possible_truncation, reason = "a setting is a 32-bit float")]
fn parse_number(text: &str) -> Option<f32> {
    // Zero has no sign, so that `-0` names the same run as `0`.
    text.parse::<f64>().ok().map(|number| number as f32 + 0.0).filter(|number| number.is_finite())
}

/// Reads the numbers of a text such as `[1, 2]`.
fn parse_list(text: &str) -> Option<Vec<f32>> {
    let inside = text.trim().strip_prefix('[')?.strip_suffix(']')?.trim();
    if inside.is_empty() {
        return Some(Vec::new());
    }
    inside.split(',').map(|number| parse_number(number.trim())).collect()
}

/// Units with which names of settings end, the longer ones first.
const UNITS_IN_NAMES: [&str; 10] =
    ["_nms_per_rad", "_m_s_per_n", "_kg_m3", "_per_s", "_m_s2", "_m_s", "_rad", "_nm", "_m", "_s"];
