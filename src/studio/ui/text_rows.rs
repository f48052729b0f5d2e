//! Elements of text that panels share: titles, explanations, problems, fields, clickable rows.

use bevy_egui::egui;

use super::buttons::CommandButton;
use super::theme;
use crate::studio::commands::Command;

/// Returns text in the style of a section title.
pub(crate) fn title_text(text: impl Into<String>) -> egui::RichText {
    egui::RichText::new(text).size(theme::TITLE_SIZE).strong()
}

/// Returns text in the colour of explanations.
pub(crate) fn weak(ui: &egui::Ui, text: impl Into<String>) -> egui::RichText {
    egui::RichText::new(text).color(theme::of(ui).text_weak)
}

/// Draws a section title.
pub(crate) fn title(ui: &mut egui::Ui, text: &str) {
    ui.add_space(theme::GAP);
    ui.label(title_text(text));
}

/// Draws a section title, with widgets at the right end of its line.
pub(crate) fn title_and(ui: &mut egui::Ui, text: &str, right: impl FnOnce(&mut egui::Ui)) {
    ui.add_space(theme::GAP);
    // Reduces the row height, because buttons are higher than text.
    ui.spacing_mut().interact_size.y -= theme::GAP * 0.75;
    ui.horizontal(|ui| {
        ui.label(title_text(text));
        at_right(ui, right);
    });
    ui.spacing_mut().interact_size.y += theme::GAP * 0.75;
}

/// Draws widgets from the right end of a line to the left.
pub(crate) fn at_right(ui: &mut egui::Ui, content: impl FnOnce(&mut egui::Ui)) {
    ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), content);
}

/// Draws a line of explanatory text.
pub(crate) fn explain(ui: &mut egui::Ui, text: &str) {
    ui.label(weak(ui, text));
}

/// Draws a sentence about a problem.
pub(crate) fn problem(ui: &mut egui::Ui, text: &str) {
    let text = egui::RichText::new(text).color(theme::of(ui).problem);
    ui.add(egui::Label::new(text).wrap());
}

/// Returns a text field for one line.
pub(crate) fn text_field(text: &mut String) -> egui::TextEdit<'_> {
    let margin = egui::Margin::symmetric(theme::GAP as i8, theme::GAP as i8 / 2);
    egui::TextEdit::singleline(text).margin(margin)
}

/// Draws a section that folds when its header is clicked. The header has a tooltip.
pub(crate) fn folded(
    ui: &mut egui::Ui,
    header: egui::CollapsingHeader,
    hint: &str,
    content: impl FnOnce(&mut egui::Ui),
) {
    header.show_unindented(ui, content).header_response.on_hover_text(hint);
}

/// Draws the progress of work in the background, beside a button whose command cancels it.
pub(crate) fn cancellable_progress(
    ui: &mut egui::Ui,
    (hint, cancel): (&str, Command),
    share: f32,
    words: &str,
) {
    ui.horizontal(|ui| {
        CommandButton::new("Cancel", hint, cancel).show(ui);
        ui.add(egui::ProgressBar::new(share).text(words).fill(theme::of(ui).accent_soft));
    });
}

/// Draws a clickable row of full width: the name on the left, details on the right.
pub(crate) fn row(ui: &mut egui::Ui, name: &str, about: &str) -> egui::Response {
    let button = egui::Button::new(name).right_text(weak(ui, about)).selected(false);
    ui.add(button.min_size(egui::vec2(ui.available_width(), 0.0)))
}
