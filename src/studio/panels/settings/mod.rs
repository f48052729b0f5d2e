//! The controls of settings. The rows of [`crate::schema`] say which settings there are, in which sections, with
//! which words, ranges and choices; nothing is named here.
//!
//! [`Sheet`] draws sections, and keeps the values that are being dragged or typed.

mod choices;
mod columns;
mod form;
mod number;
mod validation;
mod values;

use crate::evolve::Settings;
use crate::schema::{ListedSetting, Section, list};

pub use form::Sheet;

/// Every setting that there can be, with those of a ground that has a surface of its own.
pub fn every_setting() -> Vec<ListedSetting> {
    let mut settings = Settings::default();
    settings.trial.ground = Some(settings.trial.surface.clone());
    list(&settings)
}

/// The sections of some settings, in their order.
pub fn sections_of<'a>(listed: impl IntoIterator<Item = &'a ListedSetting>) -> Vec<Section> {
    let mut sections: Vec<Section> = listed.into_iter().map(|listed| listed.section).collect();
    // The settings of a section follow each other.
    sections.dedup();
    sections
}

#[cfg(test)]
pub(super) mod tests;
