//! Controls of settings, generated from the rows of [`snakes_core::schema`].
//!
//! [`Sheet`] draws sections, and stores the values that are being dragged or typed.

mod changing;
mod choices;
mod folds;
mod form;
mod number;
mod row;
mod scale;
mod slider;
mod validation;
mod values;

pub use form::Sheet;
pub use values::every_setting;

#[cfg(test)]
mod tests;
