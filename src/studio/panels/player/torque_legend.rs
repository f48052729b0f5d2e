//! Legend of the torque arrows in the scene.

use bevy_egui::egui;

use crate::studio::ui::theme;

/// Size of the drawn arcs, in points.
const ARC: egui::Vec2 = egui::vec2(30.0, 14.0);

/// Draws what colour, width and place of the arrows mean.
pub(crate) fn torque_legend(ui: &mut egui::Ui) {
    let palette = theme::of(ui);
    ui.spacing_mut().item_spacing.y = theme::GAP / 4.0;
    ui.label(egui::RichText::new("Torques").strong());
    for (color, share, text) in [
        (palette.torque_plus, 0.6, "positive"),
        (palette.torque_minus, 0.6, "negative"),
        (palette.text_weak, 0.15, "small"),
        (palette.text_weak, 1.0, "at the joint's limit"),
    ] {
        ui.horizontal(|ui| {
            let (rect, _) = ui.allocate_exact_size(ARC, egui::Sense::hover());
            // Like the arrows: longer and wider with the torque.
            let end = rect.left() + ARC.x * (0.3 + 0.7 * share);
            let (from, to) = (rect.left_center(), egui::pos2(end, rect.center().y));
            let width = 1.5 + 4.5 * share;
            ui.painter().line_segment([from, to - egui::vec2(width, 0.0)], (width, color));
            let tip = [
                to,
                to - egui::vec2(width * 1.6, width * 1.1),
                to - egui::vec2(width * 1.6, -width * 1.1),
            ];
            ui.painter().add(egui::Shape::convex_polygon(tip.to_vec(), color, egui::Stroke::NONE));
            ui.label(egui::RichText::new(text).small());
        });
    }
    let places = egui::RichText::new("At the sides: bend. Around the body: twist.");
    ui.label(places.small().color(palette.text_weak));
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    #[test]
    fn the_legend_names_both_directions_and_both_sizes() {
        let mut harness = Harness::new_ui(torque_legend);
        harness.run();
        for label in ["Torques", "positive", "negative", "small", "at the joint's limit"] {
            harness.get_by_label(label);
        }
    }
}
