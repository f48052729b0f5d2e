//! Layout of a setting's label, control and buttons: in columns, or in two lines on narrow panels.

use bevy_egui::egui;

use super::form::{Sheet, Shown};
use crate::studio::ui::text_rows::problem;
use crate::studio::ui::theme;

/// Minimum width of a row in one line, in points.
const WIDE: f32 = 460.0;
/// Width of the column with the two buttons, in points.
const BUTTONS_WIDTH: f32 = 50.0;
/// Width of a number field, in points.
pub(super) const VALUE_WIDTH: f32 = 76.0;

impl Sheet {
    /// Draws a row: `label`, `control` and `buttons`, each with the width of its column in points. The label returns its ID,
    /// with which the control is called. A small control is beside its label even on a narrow panel. `id` is the ID of
    /// the control, whose text may be invalid. Returns the requested value, if there is one.
    pub(super) fn row(
        &mut self,
        ui: &mut egui::Ui,
        (id, is_small): (&str, bool),
        label: impl FnOnce(&mut egui::Ui, f32) -> (egui::Id, Option<String>),
        mut control: impl FnMut(&mut Self, &mut egui::Ui, f32, egui::Id) -> Option<String>,
        buttons: impl FnOnce(&mut Self, &mut egui::Ui) -> Option<String>,
    ) -> Option<String> {
        let (all, gap) = (ui.available_width(), theme::GAP);
        let is_wide = all >= WIDE || is_small;
        let (label_width, control_width) = match (all >= WIDE, is_small) {
            // The widths are limited, because a longer slider is not easier to set.
            (true, _) => {
                let label = (all * 0.42).min(300.0);
                (label, (all - label - BUTTONS_WIDTH - 2.0 * gap).min(440.0))
            }
            (false, true) => (all - VALUE_WIDTH - BUTTONS_WIDTH - 2.0 * gap, VALUE_WIDTH),
            (false, false) => (all - BUTTONS_WIDTH - gap, all),
        };
        let label_width = label_width.max(0.0);
        let mut control = |sheet: &mut Self, ui: &mut egui::Ui, name| {
            cell(ui, control_width, |ui| control(sheet, ui, control_width, name))
        };
        let line = ui.horizontal(|ui| {
            let (name, new) = cell(ui, label_width, |ui| label(ui, label_width));
            let new = if is_wide { control(self, ui, name).or(new) } else { new };
            (name, cell(ui, BUTTONS_WIDTH, |ui| buttons(self, ui)).or(new))
        });
        let (name, new) = line.inner;
        let new = if is_wide { new } else { control(self, ui, name).or(new) };
        if let Some(reason) = self.typed.get(id).and_then(|typed| typed.problem.as_deref()) {
            problem(ui, reason);
        }
        new
    }

    /// Draws the row of a setting with its usual label and buttons. Returns the requested value, if there is one.
    pub(super) fn usual_row(
        &mut self,
        ui: &mut egui::Ui,
        shown: &Shown,
        is_small: bool,
        control: impl FnMut(&mut Self, &mut egui::Ui, f32, egui::Id) -> Option<String>,
    ) -> Option<String> {
        let label = |ui: &mut egui::Ui, width| (shown.name(ui, width).id, None);
        let buttons = |sheet: &mut Self, ui: &mut egui::Ui| sheet.buttons(ui, shown);
        self.row(ui, (&shown.listed.path, is_small), label, control, buttons)
    }
}

/// Draws a part of exactly this width, in points, so that wide contents do not move other columns. Contents of several
/// lines increase the height of the row.
fn cell<T>(ui: &mut egui::Ui, width: f32, show: impl FnOnce(&mut egui::Ui) -> T) -> T {
    let height = ui.spacing().interact_size.y;
    let rect = egui::Rect::from_min_size(ui.cursor().min, egui::vec2(width, height));
    let layout = egui::Layout::left_to_right(egui::Align::Center);
    let mut inside = ui.new_child(egui::UiBuilder::new().max_rect(rect).layout(layout));
    inside.set_width(width);
    let shown = show(&mut inside);
    let height = inside.min_rect().height().max(height);
    ui.allocate_exact_size(egui::vec2(width, height), egui::Sense::hover());
    shown
}
