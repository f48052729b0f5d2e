//! Where a setting's name, control and way back stand: in columns where there is room, else in two lines.

use bevy_egui::egui;

use crate::studio::ui::theme;

/// The widths of a row, in points.
#[derive(Debug, Clone, Copy)]
pub struct Columns {
    is_wide: bool,
    label: f32,
    control: f32,
}

/// A part of a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// The name.
    Label,
    /// The control.
    Control,
    /// The way back to the preset's value.
    Reset,
}

/// From this width on a row needs only one line, in points.
const WIDE: f32 = 460.0;
/// Width of the way back, in points.
pub const RESET_WIDTH: f32 = 22.0;
/// Width of a field for a number, in points.
pub const VALUE_WIDTH: f32 = 76.0;

impl Columns {
    /// The columns for what is left of a panel's width; a control that needs no more than a field's width stands
    /// beside its name even where there is little room.
    pub fn of(ui: &egui::Ui, is_small: bool) -> Self {
        let all = ui.available_width();
        let gap = theme::GAP;
        if all < WIDE && is_small {
            let label = (all - VALUE_WIDTH - RESET_WIDTH - 2.0 * gap).max(0.0);
            return Self { is_wide: true, label, control: VALUE_WIDTH };
        }
        if all < WIDE {
            return Self {
                is_wide: false,
                label: (all - RESET_WIDTH - gap).max(0.0),
                control: all,
            };
        }
        // On a very wide panel a slider over its whole width is no easier to set.
        let label = (all * 0.42).min(300.0);
        let control = (all - label - RESET_WIDTH - 2.0 * gap).min(440.0);
        Self { is_wide: true, label, control }
    }

    /// Draws a row: its parts in the order of reading.
    pub fn row(self, ui: &mut egui::Ui, mut part: impl FnMut(&mut egui::Ui, Part, f32)) {
        let Self { is_wide, label, control } = self;
        ui.horizontal(|ui| {
            cell(ui, label, |ui| part(ui, Part::Label, label));
            if is_wide {
                cell(ui, control, |ui| part(ui, Part::Control, control));
            }
            cell(ui, RESET_WIDTH, |ui| part(ui, Part::Reset, RESET_WIDTH));
        });
        if !is_wide {
            cell(ui, control, |ui| part(ui, Part::Control, control));
        }
    }
}

/// A part of exactly this width, whatever is in it: what is too wide for it moves no other column. What needs more
/// lines makes the row higher.
fn cell(ui: &mut egui::Ui, width: f32, show: impl FnOnce(&mut egui::Ui)) {
    let height = ui.spacing().interact_size.y;
    let rect = egui::Rect::from_min_size(ui.cursor().min, egui::vec2(width, height));
    let layout = egui::Layout::left_to_right(egui::Align::Center);
    let mut inside = ui.new_child(egui::UiBuilder::new().max_rect(rect).layout(layout));
    inside.set_width(width);
    show(&mut inside);
    let height = inside.min_rect().height().max(height);
    ui.allocate_exact_size(egui::vec2(width, height), egui::Sense::hover());
}
