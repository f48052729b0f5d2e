//! View of the neurons in limbs: the activity of all, and the connections of those in the selected limb.

use bevy_egui::egui::{self, Align2, Stroke};

use super::network_graph::network_graph;
use crate::studio::ui::accessible::named;
use crate::studio::ui::decimals::decimals;
use crate::studio::ui::text_rows::{explain, title};
use crate::studio::ui::theme;
use snakes_core::control::{ActiveLimb, LimbActivity};

/// Height of a row in the table of neurons, in points.
const ROW: f32 = theme::GAP * 2.5;
/// Width of the names of the neurons, in points.
const NAMES: f32 = theme::GAP * 13.0;
/// Maximum radius of a drawn neuron, in points.
const RADIUS: f32 = theme::GAP;
/// Names of the neurons of a limb, in the order of the rows from the top.
const ROWS: [&str; 4] = ["neuron 1: bend", "neuron 2: twist", "neuron 3", "neuron 4"];

/// Draws the neurons of all limbs, and the connections of the selected one.
pub(super) fn limb_view(ui: &mut egui::Ui, activity: &LimbActivity, limb: usize) {
    explain(
        ui,
        "Each column is a block, from the head to the tail; its colour shows what a neuron says.",
    );
    table(ui, activity, limb);
    let name = match limb {
        0 => "the head".to_owned(),
        limb if limb + 1 == activity.limbs.len() => "the tail".to_owned(),
        limb => format!("block {}", limb + 1),
    };
    title(ui, &format!("Wiring of {name}"));
    explain(ui, "Front and rear neurons are those of the neighbouring blocks, a step ago.");
    if let Some(network) = activity.network(limb) {
        network_graph(ui, &network);
    }
}

/// Draws a table of the neurons, with a column for each limb.
fn table(ui: &mut egui::Ui, activity: &LimbActivity, selected: usize) {
    let palette = theme::of(ui);
    let height = ROW * (ROWS.len() as f32 + 1.0);
    let size = egui::vec2(ui.available_width(), height);
    let (area, _) = ui.allocate_exact_size(size, egui::Sense::hover());
    let width = (area.width() - NAMES) / activity.limbs.len().max(1) as f32;
    let radius = RADIUS.min(width * 0.4);
    let x_of = |limb: usize| area.left() + NAMES + width * (limb as f32 + 0.5);
    let y_of = |row: f32| area.top() + ROW * (row + 0.5);
    let small = egui::FontId::proportional(theme::SMALL_SIZE);
    let column = egui::vec2(width.min(ROW * 1.5), height);
    let lit = egui::Rect::from_center_size(egui::pos2(x_of(selected), area.center().y), column);
    ui.painter().rect_filled(lit, theme::GAP / 2.0, palette.accent_soft);
    for (row, name) in ROWS.iter().enumerate() {
        let at = egui::pos2(area.left(), y_of(row as f32 + 1.0));
        ui.painter().text(at, Align2::LEFT_CENTER, name, small.clone(), palette.text);
    }
    for (limb, ActiveLimb { neurons, outputs, .. }) in activity.limbs.iter().enumerate() {
        let color = if limb == selected { palette.text } else { palette.text_weak };
        let head = egui::pos2(x_of(limb), y_of(0.0));
        let number = (limb + 1).to_string();
        ui.painter().text(head, Align2::CENTER_CENTER, number, small.clone(), color);
        for (row, (neuron, output)) in neurons.iter().zip(outputs).enumerate() {
            let center = egui::pos2(x_of(limb), y_of(row as f32 + 1.0));
            let full = if *output < 0.0 { palette.torque_minus } else { palette.torque_plus };
            let fill = palette.panel.lerp_to_gamma(full, output.abs().min(1.0));
            let is_off = neuron.kind.name() == "off";
            if is_off {
                // A neuron that is always silent is drawn as a dot.
                ui.painter().circle_filled(center, radius * 0.25, palette.text_weak);
            } else {
                ui.painter().circle(center, radius, fill, Stroke::new(1.0, palette.text_weak));
            }
            let rect = egui::Rect::from_center_size(center, egui::vec2(width, ROW));
            let id = ui.id().with(("limb neuron", limb, row));
            let response = ui.interact(rect, id, egui::Sense::hover());
            let purpose = match activity.purpose(limb, row) {
                "" => String::new(),
                purpose => format!(", {purpose} of joint {}", limb + 1),
            };
            let value = if is_off { String::new() } else { format!(": {}", decimals(*output, 2)) };
            let said = format!(
                "Block {}, neuron {}{purpose} ({}){value}",
                limb + 1,
                row + 1,
                neuron.kind.name()
            );
            named(response, egui::WidgetType::Other, &said).on_hover_text(&said);
        }
    }
}
