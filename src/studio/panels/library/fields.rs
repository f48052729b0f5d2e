//! Text fields: the new name of a save, and the path for import or export.

use std::path::PathBuf;

use bevy_egui::egui;
use bevy_egui::egui::Key as Press;

use super::LibraryPanel;
use super::actions::send;
use crate::save::library::{SavePlace, check_entry_name};
use crate::studio::commands::Command;
use crate::studio::commands::library::LibraryCommand;
use crate::studio::ui::theme;

/// Name being edited.
#[derive(Debug)]
pub struct RenameField {
    /// Place of the renamed save.
    pub place: SavePlace,
    /// Text typed so far.
    pub text: String,
    /// Whether the field has been focused.
    pub has_had_focus: bool,
}

/// Path being typed.
#[derive(Debug)]
pub struct PathPrompt {
    purpose: PathPurpose,
    text: String,
    has_had_focus: bool,
}

/// Purpose of a typed path.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PathPurpose {
    /// Target folder of an export.
    Export,
    /// File or folder to import.
    Import,
}

impl LibraryPanel {
    /// Draws a text field over the name of a row. Enter accepts the name, Escape cancels.
    pub(super) fn edit_name(
        &mut self,
        ui: &mut egui::Ui,
        rect: egui::Rect,
        commands: &mut Vec<Command>,
    ) {
        let Some(renaming) = &mut self.renaming else { return };
        let field = egui::TextEdit::singleline(&mut renaming.text);
        let response = ui.put(rect, field);
        label(ui, &response, "New name");
        if !renaming.has_had_focus {
            response.request_focus();
            renaming.has_had_focus = true;
            return;
        }
        if !response.lost_focus() {
            return;
        }
        let name = renaming.text.trim().to_owned();
        let is_valid = check_entry_name(&name).is_ok();
        if ui.input(|input| input.key_pressed(Press::Escape)) || name == renaming.place.name() {
            self.renaming = None;
        } else if is_valid {
            send(commands, LibraryCommand::Rename { place: renaming.place.clone(), name });
            self.renaming = None;
        } else if ui.input(|input| input.key_pressed(Press::Enter)) {
            // The reason is shown below the list.
            renaming.has_had_focus = false;
            return;
        } else {
            self.renaming = None;
        }
        self.wants_keyboard = true;
    }

    /// Opens the path field, or closes it if it is open for the same purpose.
    pub(super) fn toggle_path_field(&mut self, purpose: PathPurpose, text: String) {
        let is_open =
            self.path_prompt.as_ref().is_some_and(|path_prompt| path_prompt.purpose == purpose);
        self.path_prompt = (!is_open).then_some(PathPrompt { purpose, text, has_had_focus: false });
    }

    /// Draws the path field, if it is open.
    pub(super) fn path_field(&mut self, ui: &mut egui::Ui, commands: &mut Vec<Command>) {
        let Some(path_prompt) = &mut self.path_prompt else { return };
        let (label, hint) = match path_prompt.purpose {
            PathPurpose::Export => ("Export to", "Path of a folder; it is created if necessary"),
            PathPurpose::Import => ("Import from", "Path of a champion file or a run folder"),
        };
        let mut is_closed = false;
        ui.horizontal(|ui| {
            let name = ui.label(label);
            // Leaves room for the two buttons.
            let width = ui.available_width() - theme::COLUMN_WIDTHS[2];
            let field = egui::TextEdit::singleline(&mut path_prompt.text).desired_width(width);
            let response = ui.add(field).labelled_by(name.id).on_hover_text(hint);
            if !path_prompt.has_had_focus {
                response.request_focus();
                path_prompt.has_had_focus = true;
            }
            let is_entered =
                response.lost_focus() && ui.input(|input| input.key_pressed(Press::Enter));
            let has_text = !path_prompt.text.trim().is_empty();
            let ok = ui.add_enabled(has_text, egui::Button::new("OK").small());
            if (is_entered || ok.clicked()) && has_text {
                let path = PathBuf::from(path_prompt.text.trim());
                let places = self.selection.places().cloned().collect();
                send(
                    commands,
                    match path_prompt.purpose {
                        PathPurpose::Export => LibraryCommand::Export { places, to: Some(path) },
                        PathPurpose::Import => LibraryCommand::Import(vec![path]),
                    },
                );
                is_closed = true;
            }
            let is_cancelled =
                response.lost_focus() && ui.input(|input| input.key_pressed(Press::Escape));
            is_closed |= is_cancelled || ui.add(egui::Button::new("Cancel").small()).clicked();
        });
        if is_closed {
            self.path_prompt = None;
            self.wants_keyboard = true;
        }
    }
}

/// Sets the accessible name of a widget.
pub fn label(ui: &egui::Ui, response: &egui::Response, name: &str) {
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_label(name));
}
