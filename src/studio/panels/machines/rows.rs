//! Elements of the panel's lists: an entry of several lines, and a command to type.

use bevy_egui::egui;

use crate::studio::commands::Command;
use crate::studio::ui::accessible::named;
use crate::studio::ui::text_rows::at_right;
use crate::studio::ui::theme;

/// Width of the button beside a command, in points.
const COPY_WIDTH: f32 = 60.0;

/// Draws the entry of a worker or run with little spacing: a name, a text at the right end of the name's line, and
/// further lines.
pub(super) fn entry(
    ui: &mut egui::Ui,
    name: egui::RichText,
    right: egui::RichText,
    rest: impl FnOnce(&mut egui::Ui),
) {
    ui.scope(|ui| {
        ui.spacing_mut().item_spacing.y = theme::GAP / 4.0;
        ui.spacing_mut().interact_size.y = 0.0;
        ui.horizontal(|ui| {
            at_right(ui, |ui| {
                ui.label(right);
                ui.with_layout(egui::Layout::left_to_right(egui::Align::Center), |ui| {
                    ui.add(egui::Label::new(name).truncate());
                });
            });
        });
        rest(ui);
    });
    ui.add_space(theme::GAP / 2.0);
}

/// Draws a command to type, with a button that copies it.
pub(super) fn command_line(ui: &mut egui::Ui, command: &str) {
    let frame = egui::Frame::new()
        .fill(theme::of(ui).field)
        .corner_radius(4)
        .inner_margin(egui::Margin::symmetric(8, 4));
    frame.show(ui, |ui| {
        ui.horizontal_top(|ui| {
            let width = ui.available_width() - COPY_WIDTH;
            ui.vertical(|ui| {
                ui.set_width(width);
                ui.add(egui::Label::new(egui::RichText::new(command).monospace()).wrap());
            });
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Min), |ui| {
                let response = ui.small_button("Copy").on_hover_text("Copy this command");
                let name = format!("Copy: {command}");
                if named(response, egui::WidgetType::Button, &name).clicked() {
                    ui.ctx().copy_text(command.to_owned());
                    Command::Notify("Command copied.".to_owned()).send(ui);
                }
            });
        });
    });
}
