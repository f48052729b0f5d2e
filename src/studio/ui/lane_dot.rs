//! Dots in the colours of lanes and states.

use bevy_egui::egui;

use super::theme;

/// Draws a dot in the colour of a lane (the first is 0), with this diameter in points.
pub(crate) fn lane_dot(ui: &mut egui::Ui, lane: usize, diameter: f32) -> egui::Response {
    dot(ui, theme::of(ui).lane_color(lane), diameter)
}

/// Draws a dot of this diameter, in points.
pub(crate) fn dot(ui: &mut egui::Ui, color: egui::Color32, diameter: f32) -> egui::Response {
    let (rect, response) =
        ui.allocate_exact_size(egui::Vec2::splat(diameter), egui::Sense::hover());
    ui.painter().circle_filled(rect.center(), diameter / 2.0, color);
    response
}
