//! Controls of settings, generated from the rows of [`snakes_core::schema`].
//!
//! [`Sheet`] draws sections and keeps the values being dragged or typed.

mod changing;
mod choices;
mod columns;
mod folds;
mod form;
mod number;
mod scale;
mod slider;
mod validation;
mod values;

use snakes_core::schema::{ListedSetting, Section};

pub use form::Sheet;
pub use values::every_setting;

/// The sections of these settings, in order.
pub fn sections_of<'a>(listed: impl IntoIterator<Item = &'a ListedSetting>) -> Vec<Section> {
    let mut sections: Vec<Section> = listed.into_iter().map(|listed| listed.section).collect();
    // Settings of one section are adjacent.
    sections.dedup();
    sections
}

#[cfg(test)]
pub(super) mod tests;
