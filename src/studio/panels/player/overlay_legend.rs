//! Legend of the overlays over the scene: a sample and a line of text for each.

use bevy_egui::egui::{self, Color32, Pos2, Shape, Stroke};

use crate::studio::commands::overlay::Overlay;
use crate::studio::scene::overlays::{Overlays, WEIGHT_M};
use crate::studio::scene::wireframe::{block_color, stairs_color};
use crate::studio::ui::text_rows::weak;
use crate::studio::ui::theme::{self, Palette};

/// Size of a sample in the legend, in points.
const SAMPLE: egui::Vec2 = egui::vec2(30.0, 14.0);
/// Width of a sample's line, in points.
const LINE: f32 = 2.0;

/// Shape of a sample in the legend.
#[derive(Debug, Clone, Copy)]
enum Sample {
    Line,
    /// A cross, as at a contact.
    Contact,
    /// A thin arrow, as for a force.
    Force,
    /// An arrow for a torque. Its length and width show this share of the joint's limit.
    Torque(f32),
}

/// Draws the meaning of every visible overlay. `is_pulled` tells whether the mouse has pulled a snake.
pub(crate) fn overlay_legend(ui: &mut egui::Ui, overlays: &Overlays, is_pulled: bool) {
    ui.spacing_mut().item_spacing.y = theme::GAP / 4.0;
    // The rows are as low as their samples, so that the legend is small.
    ui.spacing_mut().interact_size.y = SAMPLE.y;
    for &overlay in overlays.iter() {
        let name = overlay.name();
        let entries = entries(overlay, is_pulled, theme::of(ui));
        let is_one = entries.len() == 1;
        if !is_one {
            ui.label(egui::RichText::new(name).strong());
        }
        for (sample, color, text) in entries {
            let text = if is_one { format!("{name}: {text}") } else { text };
            ui.horizontal(|ui| {
                let (rect, _) = ui.allocate_exact_size(SAMPLE, egui::Sense::hover());
                ui.painter().extend(shapes(sample, rect, color));
                ui.add(egui::Label::new(egui::RichText::new(text).small()).extend());
            });
        }
        if overlay == Overlay::Torques {
            let places = weak(ui, "At the sides: bend. Around the body: twist.").small();
            ui.add(egui::Label::new(places).extend());
        }
    }
}

/// Returns the samples of an overlay, with their colours and meanings.
fn entries(overlay: Overlay, is_pulled: bool, palette: &Palette) -> Vec<(Sample, Color32, String)> {
    let named = |sample, color, text: &str| (sample, color, text.to_owned());
    match overlay {
        Overlay::Contacts => vec![
            named(Sample::Contact, theme::flat(palette.force), "contact point"),
            (
                Sample::Force,
                theme::flat(palette.force),
                format!("force; {WEIGHT_M:.0} m long: the snake's weight"),
            ),
        ],
        Overlay::Torques => vec![
            named(Sample::Torque(0.6), palette.torque_plus, "positive"),
            named(Sample::Torque(0.6), palette.torque_minus, "negative"),
            named(Sample::Torque(0.15), palette.text_weak, "small"),
            named(Sample::Torque(1.0), palette.text_weak, "at the joint's limit"),
        ],
        Overlay::Trail => {
            let trail = named(Sample::Line, theme::flat(palette.trail), "path of the middle block");
            let pulled = named(Sample::Line, theme::flat(palette.pull), "the same, after a pull");
            [Some(trail), is_pulled.then_some(pulled)].into_iter().flatten().collect()
        }
        Overlay::FitnessLine => {
            vec![named(Sample::Line, palette.accent, "distance of the middle block")]
        }
        Overlay::Wireframe => vec![
            named(Sample::Line, theme::flat(block_color()), "blocks"),
            named(Sample::Line, theme::flat(stairs_color()), "stairs and ground"),
        ],
    }
}

/// Returns the shapes of a sample, which look as in the scene.
fn shapes(sample: Sample, rect: egui::Rect, color: Color32) -> Vec<Shape> {
    let (left, right) = (rect.left_center(), rect.right_center());
    let stroke = Stroke::new(LINE, color);
    match sample {
        Sample::Line => vec![Shape::line_segment([left, right], stroke)],
        Sample::Contact => {
            let arm = rect.height() * 0.3;
            let ends = [egui::vec2(arm, arm), egui::vec2(arm, -arm)];
            let middle = rect.center();
            ends.map(|end| Shape::line_segment([middle - end, middle + end], stroke)).into()
        }
        Sample::Force => arrow(left, right, LINE, color),
        Sample::Torque(share) => {
            // The arrow is longer and wider for a larger torque.
            let end = rect.left() + SAMPLE.x * (0.3 + 0.7 * share);
            arrow(left, egui::pos2(end, left.y), 1.5 + 4.5 * share, color)
        }
    }
}

/// Returns the shapes of an arrow from left to right.
fn arrow(from: Pos2, to: Pos2, width: f32, color: Color32) -> Vec<Shape> {
    let head = egui::vec2(width * 1.6, width * 1.1).max(egui::vec2(6.0, 4.0));
    let tip = vec![to, to - head, to - egui::vec2(head.x, -head.y)];
    let shaft = [from, to - egui::vec2(head.x * 0.6, 0.0)];
    vec![
        Shape::line_segment(shaft, Stroke::new(width, color)),
        Shape::convex_polygon(tip, color, Stroke::NONE),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::panels::testing::{Sent, panel, shows};
    use egui_kittest::kittest::Queryable;

    /// Creates the legend of these overlays. `is_pulled` tells whether the snake was pulled.
    fn legend(shown: &[Overlay], is_pulled: bool) -> Sent<'static> {
        let mut overlays = Overlays::default();
        overlays.extend(shown);
        panel([800.0, 600.0], move |ui| overlay_legend(ui, &overlays, is_pulled))
    }

    #[test]
    fn the_legend_names_both_directions_and_both_sizes_of_torques() {
        let harness = legend(&[Overlay::Torques], false);
        for label in ["Torques", "positive", "negative", "small", "at the joint's limit"] {
            harness.get_by_label(label);
        }
    }

    #[test]
    fn every_overlay_that_is_shown_has_a_legend_and_no_other() {
        for shown in Overlay::ALL {
            let harness = legend(&[shown], false);
            for overlay in Overlay::ALL {
                let is_listed = shows(&harness, overlay.name());
                assert_eq!(is_listed, overlay == shown, "{overlay:?} while {shown:?} is shown");
            }
            assert!(!entries(shown, false, theme::of_context(&harness.ctx)).is_empty());
        }
        let harness = legend(&Overlay::ALL, false);
        for text in ["contact point", "Trail: path of the middle block", "blocks"] {
            harness.get_by_label(text);
        }
        assert!(harness.query_by_label("the same, after a pull").is_none());
        legend(&[Overlay::Trail], true).get_by_label("the same, after a pull");
    }
}
