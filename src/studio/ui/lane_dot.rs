//! The dot that marks a lane by its colour.

use bevy_egui::egui;

use super::theme;

/// Draws the dot in the colour of a lane; the first lane is 0.
pub(crate) fn lane_dot(ui: &mut egui::Ui, lane: usize) -> egui::Response {
    let size = egui::Vec2::splat(theme::GAP * 1.25);
    let (rect, response) = ui.allocate_exact_size(size, egui::Sense::hover());
    let color = theme::of(ui).lane_color(lane);
    ui.painter().circle_filled(rect.center(), theme::GAP * 0.6, color);
    response
}
