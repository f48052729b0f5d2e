//! The table of the steps.

use bevy_egui::egui;

use super::edit::StairsEdit;
use crate::studio::ui::accessible::named;
use crate::studio::ui::decimals::short;
use crate::studio::ui::text_rows::explain;
use crate::studio::ui::theme;
use snakes_core::world::Stairs;

/// Change of a length per point by which its field is dragged, in metres.
const SPEED_M: f32 = 0.01;

/// Response of the table to the user.
#[derive(Debug, Default)]
pub(super) struct Listed {
    /// Step whose row is under the pointer; the lowest is 0.
    pub pointed: Option<u32>,
    /// Change of the stairs: a step was changed, copied or removed.
    pub edit: Option<StairsEdit>,
}

/// Draws a row for each step, the lowest first.
pub(super) fn table(ui: &mut egui::Ui, stairs: &Stairs, pointed: Option<u32>) -> Listed {
    let mut listed = Listed::default();
    if stairs.steps == 0 {
        explain(ui, "Flat ground: there are no steps.");
        if ui.button("Add a step").clicked() {
            listed.edit = Some(StairsEdit::complete(Stairs { steps: 1, ..stairs.clone() }));
        }
        return listed;
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
            let rise = length(ui, rise_m, &format!("Rise of step {number}"), -5.0..=5.0);
            let tread = length(ui, tread_m, &format!("Tread of step {number}"), 0.1..=20.0);
            let tread = tread.map(|to| to.edit(|length_m| stairs.with_step_tread(step, length_m)));
            let rise = rise.map(|to| to.edit(|length_m| stairs.with_step_rise(step, length_m)));
            listed.edit = rise.or(tread).or(listed.edit.take());
            explain(ui, &format!("{:.2} m", stairs.height_m(number)));
            let [copied, removed] = ui.horizontal(|ui| buttons(ui, number)).inner;
            if copied {
                listed.edit = Some(StairsEdit::complete(stairs.with_step_copied(step)));
            }
            if removed {
                listed.edit = Some(StairsEdit::complete(stairs.without_step(step)));
            }
            let line = egui::Rect::from_x_y_ranges(ui.max_rect().x_range(), row.rect.y_range());
            if ui.rect_contains_pointer(line) {
                listed.pointed = Some(step);
            }
            ui.end_row();
        }
    });
    listed
}

/// Draws the buttons of a row. Returns whether to copy the step, and whether to remove it.
fn buttons(ui: &mut egui::Ui, number: u32) -> [bool; 2] {
    let mut is_clicked = |sign: &str, name: String, hint: &str| {
        let button = named(ui.small_button(sign), egui::WidgetType::Button, &name);
        button.on_hover_text(hint).clicked()
    };
    let copied =
        is_clicked("+", format!("Copy step {number}"), "Add a copy of this step behind it");
    let removed = is_clicked("–", format!("Remove step {number}"), "Remove this step");
    [copied, removed]
}

/// A length that the user has changed.
struct Changed {
    length_m: f32,
    is_complete: bool,
}

impl Changed {
    /// Returns the change of the stairs, which `stairs` computes from the length.
    fn edit(self, stairs: impl FnOnce(f32) -> Stairs) -> StairsEdit {
        StairsEdit { stairs: stairs(self.length_m), is_complete: self.is_complete }
    }
}

/// Draws a field for a length that can be dragged or typed. Returns the length if it has changed.
fn length(
    ui: &mut egui::Ui,
    length_m: f32,
    name: &str,
    range: std::ops::RangeInclusive<f32>,
) -> Option<Changed> {
    let mut changed_m = length_m;
    let field = egui::DragValue::new(&mut changed_m)
        .speed(SPEED_M)
        .range(range)
        .custom_formatter(|length_m, _| short(length_m, 3))
        .suffix(" m")
        .update_while_editing(false);
    let response = named(ui.add(field), egui::WidgetType::DragValue, name);
    let is_complete = !response.dragged();
    let is_new = response.changed() || response.drag_stopped();
    is_new.then_some(Changed { length_m: changed_m, is_complete })
}
