//! Values of settings, and how they are read from and written to fields.

use std::fmt;

use super::{Choices, PerPart};

/// A value of a setting.
#[derive(Debug, Clone, PartialEq)]
pub enum SettingValue {
    /// A number in the setting's unit.
    Number(f32),
    /// A whole number.
    Whole(u32),
    /// The state of a switch: true is on.
    Switch(bool),
    /// The name of a choice, as files spell it.
    Name(&'static str),
    /// A list of numbers, in the setting's unit.
    List(Vec<f32>),
    /// No value: an optional setting is absent.
    None,
}

impl fmt::Display for SettingValue {
    /// Writes the value as a person types it: `0.5`, `true`, `ipop`, `[1, 2]`, `none`.
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => write!(formatter, "{number}"),
            Self::Whole(number) => write!(formatter, "{number}"),
            Self::Switch(is_on) => write!(formatter, "{is_on}"),
            Self::Name(name) => formatter.write_str(name),
            Self::List(numbers) => {
                let texts: Vec<String> = numbers.iter().map(f32::to_string).collect();
                write!(formatter, "[{}]", texts.join(", "))
            }
            Self::None => formatter.write_str("none"),
        }
    }
}

/// A field that stores the value of a setting.
pub trait SettingField {
    /// Returns the field's value.
    fn value(&self) -> SettingValue;

    /// Sets the field. Returns false, and keeps the old value, if `value` is of another type.
    fn set(&mut self, value: SettingValue) -> bool;
}

/// Implements [`SettingField`] for a type that corresponds to one variant of `SettingValue`.
macro_rules! field_of {
    ($type:ty, $variant:ident) => {
        impl SettingField for $type {
            fn value(&self) -> SettingValue {
                SettingValue::$variant(self.clone())
            }

            fn set(&mut self, value: SettingValue) -> bool {
                let SettingValue::$variant(value) = value else { return false };
                *self = value;
                true
            }
        }
    };
}

field_of!(f32, Number);
field_of!(u32, Whole);
field_of!(bool, Switch);
field_of!(Vec<f32>, List);

impl SettingField for PerPart {
    fn value(&self) -> SettingValue {
        match self {
            Self::All(number) => SettingValue::Number(*number),
            Self::Each(numbers) => SettingValue::List(numbers.clone()),
        }
    }

    fn set(&mut self, value: SettingValue) -> bool {
        *self = match value {
            SettingValue::Number(number) => Self::All(number),
            SettingValue::List(numbers) => Self::Each(numbers),
            _ => return false,
        };
        true
    }
}

impl SettingField for Option<PerPart> {
    fn value(&self) -> SettingValue {
        self.as_ref().map_or(SettingValue::None, SettingField::value)
    }

    fn set(&mut self, value: SettingValue) -> bool {
        if value == SettingValue::None {
            *self = None;
            return true;
        }
        let mut part = PerPart::All(0.0);
        let is_set = part.set(value);
        if is_set {
            *self = Some(part);
        }
        is_set
    }
}

/// Field of an absent group of settings, whose only value is none.
impl SettingField for () {
    fn value(&self) -> SettingValue {
        SettingValue::None
    }

    fn set(&mut self, value: SettingValue) -> bool {
        value == SettingValue::None
    }
}

impl<T: Choices> SettingField for T {
    fn value(&self) -> SettingValue {
        SettingValue::Name(self.choice().name)
    }

    fn set(&mut self, value: SettingValue) -> bool {
        let named = T::OPTIONS.iter().find(|option| option.value() == value);
        if let Some(option) = named {
            *self = *option;
        }
        named.is_some()
    }
}
