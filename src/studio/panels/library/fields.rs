//! What is typed: a name over its row, a path to copy to or from.

use std::path::PathBuf;

use bevy_egui::egui::{self, Key as Press};

use super::{LibraryPanel, send};
use crate::save::library::{Place, check_entry_name};
use crate::studio::command::Command;
use crate::studio::library::Ask;
use crate::studio::look;

/// A name that is being edited.
#[derive(Debug)]
pub struct Naming {
    /// Whose.
    pub place: Place,
    /// The name so far.
    pub text: String,
    /// Whether its field has had the keyboard.
    pub has_begun: bool,
}

/// A path that is being typed.
#[derive(Debug)]
pub struct Asking {
    what: Wanted,
    text: String,
    has_begun: bool,
}

/// What a path is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Wanted {
    /// Where copies go.
    Export,
    /// What is copied in.
    Import,
}

impl LibraryPanel {
    /// A field over the name of a row: Enter takes it, Escape leaves it as it was.
    pub(super) fn edit_name(
        &mut self,
        ui: &mut egui::Ui,
        rect: egui::Rect,
        asked: &mut Vec<Command>,
    ) {
        let Some(naming) = &mut self.naming else { return };
        let field = egui::TextEdit::singleline(&mut naming.text);
        let response = ui.put(rect, field);
        label(ui, &response, "New name");
        if !naming.has_begun {
            response.request_focus();
            naming.has_begun = true;
            return;
        }
        if !response.lost_focus() {
            return;
        }
        let name = naming.text.trim().to_owned();
        let is_good = check_entry_name(&name).is_ok();
        if ui.input(|input| input.key_pressed(Press::Escape)) || name == naming.place.name() {
            self.naming = None;
        } else if is_good {
            send(asked, Ask::Rename { place: naming.place.clone(), name });
            self.naming = None;
        } else if ui.input(|input| input.key_pressed(Press::Enter)) {
            // What is wrong with it is said below.
            naming.has_begun = false;
            return;
        } else {
            self.naming = None;
        }
        self.wants_keyboard = true;
    }

    /// Opens a field for a path, or closes it.
    pub(super) fn ask_for(&mut self, what: Wanted, text: String) {
        let is_open = self.asking.as_ref().is_some_and(|asking| asking.what == what);
        self.asking = (!is_open).then_some(Asking { what, text, has_begun: false });
    }

    /// A field for a path, while one is asked for.
    pub(super) fn path_field(&mut self, ui: &mut egui::Ui, asked: &mut Vec<Command>) {
        let Some(asking) = &mut self.asking else { return };
        let (label, hint) = match asking.what {
            Wanted::Export => ("Export to", "A folder, which is made if need be"),
            Wanted::Import => ("Import from", "A champion's file, or the folder of a run"),
        };
        let mut is_done = false;
        ui.horizontal(|ui| {
            let name = ui.label(label);
            // The width of the two buttons beside it.
            let width = ui.available_width() - look::COLUMN_WIDTHS[2];
            let field = egui::TextEdit::singleline(&mut asking.text).desired_width(width);
            let response = ui.add(field).labelled_by(name.id).on_hover_text(hint);
            if !asking.has_begun {
                response.request_focus();
                asking.has_begun = true;
            }
            let is_entered =
                response.lost_focus() && ui.input(|input| input.key_pressed(Press::Enter));
            let is_there = !asking.text.trim().is_empty();
            let go = ui.add_enabled(is_there, egui::Button::new("OK").small());
            if (is_entered || go.clicked()) && is_there {
                let path = PathBuf::from(asking.text.trim());
                let places = self.selection.places().cloned().collect();
                send(
                    asked,
                    match asking.what {
                        Wanted::Export => Ask::Export { places, to: Some(path) },
                        Wanted::Import => Ask::Import(vec![path]),
                    },
                );
                is_done = true;
            }
            let is_left =
                response.lost_focus() && ui.input(|input| input.key_pressed(Press::Escape));
            is_done |= is_left || ui.add(egui::Button::new("Cancel").small()).clicked();
        });
        if is_done {
            self.asking = None;
            self.wants_keyboard = true;
        }
    }
}

/// Names a field for who does not see it.
pub fn label(ui: &egui::Ui, response: &egui::Response, name: &str) {
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_label(name));
}
