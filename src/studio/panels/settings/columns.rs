//! Layout of a setting's label, control and buttons: in columns, or in two lines on narrow panels.

use bevy_egui::egui;

use crate::studio::ui::theme;

/// Widths of the columns of a setting's row, in points.
#[derive(Debug, Clone, Copy)]
pub struct Columns {
    is_wide: bool,
    label: f32,
    control: f32,
}

/// A part of a setting's row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// Column with the label of the setting.
    Label,
    /// Column with the control of the setting.
    Control,
    /// Column with the buttons that reset the setting to the preset's value, and that show several values side by side.
    Buttons,
}

/// Minimum width of a row in one line, in points.
const WIDE: f32 = 460.0;
/// Width of the column with the two buttons, in points.
pub const BUTTONS_WIDTH: f32 = 50.0;
/// Width of a number field, in points.
pub const VALUE_WIDTH: f32 = 76.0;

impl Columns {
    /// Returns the columns for the available width. A small control is in the same line as its label even on a narrow panel.
    pub fn of(ui: &egui::Ui, is_small: bool) -> Self {
        let all = ui.available_width();
        let gap = theme::GAP;
        if all < WIDE && is_small {
            let label = (all - VALUE_WIDTH - BUTTONS_WIDTH - 2.0 * gap).max(0.0);
            return Self { is_wide: true, label, control: VALUE_WIDTH };
        }
        if all < WIDE {
            return Self {
                is_wide: false,
                label: (all - BUTTONS_WIDTH - gap).max(0.0),
                control: all,
            };
        }
        // The width is limited, because a longer slider is not easier to set.
        let label = (all * 0.42).min(300.0);
        let control = (all - label - BUTTONS_WIDTH - 2.0 * gap).min(440.0);
        Self { is_wide: true, label, control }
    }

    /// Draws a row. Calls `part` for each part in reading order, with the part's width in points.
    pub fn row(self, ui: &mut egui::Ui, mut part: impl FnMut(&mut egui::Ui, Part, f32)) {
        let Self { is_wide, label, control } = self;
        ui.horizontal(|ui| {
            cell(ui, label, |ui| part(ui, Part::Label, label));
            if is_wide {
                cell(ui, control, |ui| part(ui, Part::Control, control));
            }
            cell(ui, BUTTONS_WIDTH, |ui| part(ui, Part::Buttons, BUTTONS_WIDTH));
        });
        if !is_wide {
            cell(ui, control, |ui| part(ui, Part::Control, control));
        }
    }
}

/// Draws a part of exactly this width, in points, so that wide contents do not move other columns. Contents of several
/// lines increase the height of the row.
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
