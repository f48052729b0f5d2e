//! Rows of text that panels share: titles, explanations, clickable rows.

use bevy_egui::egui;

use super::theme;

/// A section's title.
pub(crate) fn title(ui: &mut egui::Ui, text: &str) {
    ui.add_space(theme::GAP);
    ui.label(egui::RichText::new(text).size(theme::TITLE_SIZE).strong());
}

/// A section's title, with widgets at the right end of its line.
pub(crate) fn title_and(ui: &mut egui::Ui, text: &str, right: impl FnOnce(&mut egui::Ui)) {
    ui.add_space(theme::GAP);
    // Compensate for the height of buttons, which is larger than that of text.
    ui.spacing_mut().interact_size.y -= theme::GAP * 0.75;
    ui.horizontal(|ui| {
        ui.label(egui::RichText::new(text).size(theme::TITLE_SIZE).strong());
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), right);
    });
    ui.spacing_mut().interact_size.y += theme::GAP * 0.75;
}

/// A line of explanatory text.
pub(crate) fn explain(ui: &mut egui::Ui, text: &str) {
    ui.label(egui::RichText::new(text).color(theme::of(ui).text_weak));
}

/// Progress of work in the background beside a button that cancels it. Returns whether the button was clicked.
pub(crate) fn cancellable_progress(ui: &mut egui::Ui, hint: &str, share: f32, words: &str) -> bool {
    ui.horizontal(|ui| {
        let is_cancelled = ui.button("Cancel").on_hover_text(hint).clicked();
        ui.add(egui::ProgressBar::new(share).text(words).fill(theme::of(ui).accent_soft));
        is_cancelled
    })
    .inner
}

/// A clickable row over the whole width: name at the left, details at the right.
pub(crate) fn row(ui: &mut egui::Ui, is_shown: bool, name: &str, about: &str) -> egui::Response {
    let color = if is_shown { theme::of(ui).text } else { theme::of(ui).text_weak };
    let about = egui::RichText::new(about).color(color);
    let button = egui::Button::new(name).right_text(about).selected(is_shown);
    ui.add(button.min_size(egui::vec2(ui.available_width(), 0.0)))
}
