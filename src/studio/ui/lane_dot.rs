//! The dot that marks a lane by its colour.

use bevy_egui::egui;

use super::theme;

/// Draws the dot in the colour of a lane (the first is 0), of this diameter in points.
pub(crate) fn lane_dot(ui: &mut egui::Ui, lane: usize, diameter: f32) -> egui::Response {
    let (rect, response) =
        ui.allocate_exact_size(egui::Vec2::splat(diameter), egui::Sense::hover());
    let color = theme::of(ui).lane_color(lane);
    ui.painter().circle_filled(rect.center(), diameter / 2.0, color);
    response
}
