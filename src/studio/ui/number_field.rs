//! Text field for a number. It validates its text, and commits the value when the field loses the focus.

use std::fmt::Display;
use std::ops::RangeInclusive;
use std::str::FromStr;

use bevy_egui::egui;

use super::text_rows::text_field;
use super::theme;

/// A text field for a number, with its unfinished text.
#[derive(Debug, Default)]
pub(crate) struct NumberField {
    /// Text of the field while it is edited or invalid; `None` while the field shows the value itself.
    text: Option<String>,
    /// Error message for the text; `None` if it is valid.
    pub problem: Option<String>,
}

impl NumberField {
    /// Draws the field with its label. Returns a new value when the user leaves the field with a valid one.
    pub fn ui<T: FromStr + Display + PartialOrd>(
        &mut self,
        ui: &mut egui::Ui,
        label: &str,
        hint: &str,
        value: T,
        range: RangeInclusive<T>,
    ) -> Option<T> {
        let name = ui.label(label);
        let mut text = self.text.clone().unwrap_or_else(|| value.to_string());
        let field = text_field(&mut text).desired_width(theme::FIELD_WIDTH);
        let response = ui.add(field).labelled_by(name.id).on_hover_text(hint);
        select_all_on_focus(&response, &text);
        let parsed = text.trim().parse().ok().filter(|number| range.contains(number));
        if response.changed() {
            self.problem = parsed.is_none().then(|| {
                let allowed = format!("allowed: {} to {}", range.start(), range.end());
                format!("{label} is \"{text}\"; {allowed}")
            });
            self.text = Some(text);
        }
        if response.lost_focus() && self.problem.is_none() {
            return self.text.take().and(parsed);
        }
        None
    }
}

/// Selects the whole text when a field gets the focus, so that typing replaces it.
pub(crate) fn select_all_on_focus(field: &egui::Response, text: &str) {
    if field.gained_focus() {
        select(field, 0, text.chars().count());
    }
}

/// Selects the characters of a text field from one index to another.
pub(crate) fn select(field: &egui::Response, from: usize, to: usize) {
    let mut state = egui::TextEdit::load_state(&field.ctx, field.id).unwrap_or_default();
    let [from, to] = [from, to].map(egui::text::CCursor::new);
    state.cursor.set_char_range(Some(egui::text::CCursorRange::two(from, to)));
    state.store(&field.ctx, field.id);
}
