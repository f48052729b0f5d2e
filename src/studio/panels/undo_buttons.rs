//! Undo and redo buttons in the title row of a panel.

use bevy_egui::egui;

use crate::studio::commands::Command;
use crate::studio::state::undo::{UndoDirection, UndoHistory};
use crate::studio::ui::icons::{Icon, small_icon_button};

/// Draws the undo and redo buttons, and sends the user's commands.
pub(super) fn undo_buttons(ui: &mut egui::Ui, history: &UndoHistory) {
    for (way, icon, name, command) in [
        (UndoDirection::Forth, Icon::Redo, "Redo", Command::Redo),
        (UndoDirection::Back, Icon::Undo, "Undo", Command::Undo),
    ] {
        let step = history.next(way);
        let hint = step.map_or(way.nothing().to_owned(), |step| format!("{name} {step}"));
        let is_on = step.is_some();
        let button = |ui: &mut egui::Ui| small_icon_button(ui, icon, name, &hint);
        if ui.add_enabled_ui(is_on, button).inner.clicked() {
            command.send(ui);
        }
    }
}
