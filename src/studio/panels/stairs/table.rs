//! The table of the steps.

use bevy_egui::egui;

use super::edit::{StairsEdit, StairsResponse};
use crate::studio::ui::accessible::named;
use crate::studio::ui::text_rows::explain;
use crate::studio::ui::theme;
use snakes_core::world::Stairs;

/// Change of a length per point by which its field is dragged, in metres.
const SPEED_M: f32 = 0.01;

/// Draws a row for each step, the lowest first. Adds to `response` the step whose row is under the pointer, and the change of
/// the stairs if a step was changed, copied or removed.
pub(super) fn table(
    ui: &mut egui::Ui,
    stairs: &Stairs,
    pointed: Option<u32>,
    response: &mut StairsResponse,
) {
    if stairs.steps == 0 {
        explain(ui, "Flat ground: there are no steps.");
        if ui.button("Add a step").clicked() {
            response.edit = Some(StairsEdit::complete(Stairs { steps: 1, ..stairs.clone() }));
        }
        return;
    }
    egui::Grid::new("steps").num_columns(5).spacing([theme::GAP, 2.0]).show(ui, |ui| {
        for heading in ["Step", "Rise", "Tread", "Top"] {
            explain(ui, heading);
        }
        ui.end_row();
        for step in 0..stairs.steps {
            let number = step + 1;
            let is_lit = pointed == Some(step);
            let mut text = egui::RichText::new(number.to_string());
            if is_lit {
                text = text.color(theme::of(ui).accent).strong();
            }
            let row = ui.label(text);
            let (rise_m, tread_m) = (stairs.step_rise_m(step), stairs.step_tread_m(step));
            let name = format!("Rise of step {number}");
            let rise =
                length(ui, rise_m, &name, -5.0..=5.0, |to_m| stairs.with_step_rise(step, to_m));
            let name = format!("Tread of step {number}");
            let tread =
                length(ui, tread_m, &name, 0.1..=20.0, |to_m| stairs.with_step_tread(step, to_m));
            response.edit = rise.or(tread).or(response.edit.take());
            explain(ui, &format!("{:.2} m", stairs.height_m(number)));
            ui.horizontal(|ui| {
                let copy = Stairs::with_step_copied as fn(&_, _) -> _;
                for (sign, verb, hint, change) in [
                    ("+", "Copy", "Add a copy of this step behind it", copy),
                    ("–", "Remove", "Remove this step", Stairs::without_step),
                ] {
                    let name = format!("{verb} step {number}");
                    let button = named(ui.small_button(sign), egui::WidgetType::Button, &name);
                    if button.on_hover_text(hint).clicked() {
                        response.edit = Some(StairsEdit::complete(change(stairs, step)));
                    }
                }
            });
            let line = egui::Rect::from_x_y_ranges(ui.max_rect().x_range(), row.rect.y_range());
            if ui.rect_contains_pointer(line) {
                response.pointed = response.pointed.or(Some(step));
            }
            ui.end_row();
        }
    });
}

/// Draws a field for a length that can be dragged or typed. Returns the change of the
/// stairs, which `changed` computes from a new length.
fn length(
    ui: &mut egui::Ui,
    length_m: f32,
    name: &str,
    range: std::ops::RangeInclusive<f32>,
    changed: impl FnOnce(f32) -> Stairs,
) -> Option<StairsEdit> {
    let mut changed_m = length_m;
    let field = egui::DragValue::new(&mut changed_m)
        .speed(SPEED_M)
        .range(range)
        .custom_formatter(|length_m, _| snakes_lab::study::number(length_m, 3))
        .suffix(" m")
        .update_while_editing(false);
    let response = named(ui.add(field), egui::WidgetType::DragValue, name);
    let is_complete = !response.dragged();
    let is_new = response.changed() || response.drag_stopped();
    is_new.then(|| StairsEdit { stairs: changed(changed_m), is_complete })
}
