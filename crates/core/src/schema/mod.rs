//! The settings schema: a row for each setting, beside the field that the row describes.
//!
//! A struct of settings implements [`SettingGroup`]: its `walk` pairs each field with a row that has the setting's name, unit, range or
//! choices, label, hint, and whether it may change during a run. The checks, the list of all settings, `--set`, live changes, the panels
//! and `docs/settings.md` read these rows.
//!
//! Values are stored, written and checked in the unit of the row. Panels show some values in another unit, such as angles in degrees; only
//! the module `display` converts between the two.
//!
//! To add a setting, add a field with its default and its row to the `setting_group!` of its struct, which does not compile without the
//! row. If the walk has another order than the files, write the row in `walk` instead.

mod access;
mod choice;
mod declare;
mod display;
mod parts;
mod per_part;
mod range;
mod setting;
mod table;
mod value;
mod walk;

pub use crate::choices;
pub use crate::listed_values;
pub use crate::named_values;
pub use access::{check, find, list, set_text, set_value};
pub use choice::{Choice, Choices};
pub(crate) use declare::{named_by_info, setting_group, settings};
pub use display::DisplayUnit;
pub use parts::Parts;
pub use per_part::PerPart;
pub use range::NumberRange;
pub use setting::{Need, Setting, SettingKind, SettingRow};
pub use setting::{
    absent, choice, list_of_numbers, number, optional_per_part, per_part, switch, whole,
};
pub use table::markdown;
pub use value::{SettingField, SettingValue};
pub use walk::{ListedSetting, Section, SettingGroup, SettingVisitor, Walk, walk};

/// Returns whether a value is the default of its type.
///
/// Use it for a setting that an earlier released format does not have, with `#[serde(default, skip_serializing_if = "is_default")]`. The
/// default must act as the program did before the setting existed: then files without the setting keep their meaning, and runs that do not
/// use it keep their names.
pub fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

#[cfg(test)]
mod tests;
