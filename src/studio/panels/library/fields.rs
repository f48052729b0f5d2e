//! Text fields: the new name of a save, its notes, and the path for import or export.

use std::path::PathBuf;

use bevy_egui::egui::{self, Key as Press, WidgetType};

use super::LibraryPanel;
use crate::studio::commands::Command;
use crate::studio::commands::files::{FileCommand, FileQuestion};
use crate::studio::commands::library::LibraryCommand;
use crate::studio::state::library::LibraryItem;
use crate::studio::ui::accessible::named;
use crate::studio::ui::text_prompt::{PromptEnd, TextPrompt};
use crate::studio::ui::text_rows::{explain, problem};
use crate::studio::ui::theme;
use snakes_core::check::Invalid;
use snakes_core::save::library::{SavePlace, check_entry_name};
use snakes_core::save::{check_notes, check_run_name};

/// Name of a save that is being edited.
#[derive(Debug)]
pub struct RenameField {
    /// Place of the save to rename.
    pub place: SavePlace,
    /// Name of the save before the edit.
    before: String,
    prompt: TextPrompt,
}

/// Notes of a save that are being edited.
#[derive(Debug)]
pub struct NotesField {
    /// Place of the save with the notes.
    place: SavePlace,
    /// Text typed so far.
    text: String,
    /// Whether the command that stores the notes has been sent.
    is_sent: bool,
}

/// A path that the user types, in answer to a question.
#[derive(Debug)]
pub struct PathPrompt {
    /// The question.
    pub question: FileQuestion,
    /// Reason why no file dialog is shown.
    pub reason: String,
    /// Field for the path.
    pub prompt: TextPrompt,
}

impl RenameField {
    /// Creates a field with the present name, which is selected.
    pub fn new(item: &LibraryItem) -> Self {
        let name = item.name().to_owned();
        let prompt = TextPrompt::new(name.clone());
        Self { place: item.place().clone(), before: name, prompt }
    }

    /// Returns the problem with the name typed so far, if there is one.
    pub fn problem(&self) -> Option<String> {
        let name = self.prompt.trimmed();
        let checked = match self.place {
            // A run without a name of its own is shown with its folder's name.
            SavePlace::Run(_) if name.is_empty() => Ok(()),
            SavePlace::Run(_) => check_run_name(name),
            _ => check_entry_name(name),
        };
        checked.err().map(|Invalid { allowed, .. }| format!("The name must be {allowed}."))
    }
}

impl LibraryPanel {
    /// Draws a text field over the name of a row. Enter accepts the name; Escape cancels.
    pub(super) fn edit_name(&mut self, ui: &mut egui::Ui, rect: egui::Rect) {
        let Some(renaming) = &mut self.renaming else { return };
        let problem = renaming.problem();
        // A child of the layout does not move the next row.
        let mut over_row = ui.new_child(egui::UiBuilder::new().max_rect(rect));
        let (response, end) = renaming.prompt.ui(&mut over_row, |ui, field| {
            let margin = egui::Margin::symmetric(theme::GAP as i8 / 2, 0);
            ui.put(rect, field.margin(margin).vertical_align(egui::Align::Center))
        });
        let response = named(response, WidgetType::TextEdit, "New name");
        if problem.is_some() {
            let stroke = egui::Stroke::new(1.5, theme::of(ui).problem);
            ui.painter().rect_stroke(rect, 2.0, stroke, egui::StrokeKind::Outside);
        }
        if end.is_none() && !response.lost_focus() {
            return;
        }
        let name = renaming.prompt.trimmed().to_owned();
        let is_changed = name != renaming.before && end != Some(PromptEnd::Cancelled);
        if is_changed && problem.is_none() {
            let rename = LibraryCommand::Rename { place: renaming.place.clone(), name };
            Command::Library(rename).send(ui);
        } else if is_changed && end == Some(PromptEnd::Accepted) {
            // The reason is shown below the list.
            return renaming.prompt.ask_again();
        }
        self.renaming = None;
        self.wants_keyboard = true;
    }

    /// Draws the notes of a save, which are stored when the field loses the focus. Escape restores the old notes.
    pub(super) fn notes(&mut self, ui: &mut egui::Ui, item: &LibraryItem) {
        if item.place().path().is_none() {
            return;
        }
        let kept = match item.notes() {
            Ok(notes) => notes.text.as_str(),
            Err(reason) => {
                return problem(ui, &format!("Its notes cannot be read. {reason}"));
            }
        };
        let edited = self.notes.take().map(|field| (field.text, field.is_sent));
        let (mut text, mut is_sent) = edited.unwrap_or_else(|| (kept.to_owned(), false));
        let field = egui::TextEdit::multiline(&mut text)
            .hint_text("Notes")
            .desired_rows(2)
            .desired_width(f32::INFINITY)
            .margin(egui::Margin::symmetric(8, 4));
        let response = ui.add(field).on_hover_text("Your notes about this save");
        ui.ctx().accesskit_node_builder(response.id, |node| node.set_label("Notes"));
        let refusal = check_notes(text.trim()).err();
        if let Some(refusal) = &refusal {
            problem(ui, &refusal.to_string());
        }
        is_sent &= !response.changed();
        let is_restored =
            response.lost_focus() && ui.input(|input| input.key_pressed(Press::Escape));
        let is_edited = text.trim() != kept.trim() && !is_restored;
        if response.lost_focus() && is_edited && !is_sent && refusal.is_none() {
            let (place, text) = (item.place().clone(), text.clone());
            Command::Library(LibraryCommand::SetNotes { place, text }).send(ui);
            is_sent = true;
        }
        // After the command is sent, the typed text is shown until the new notes are read.
        if response.has_focus() || is_edited {
            self.notes = Some(NotesField { place: item.place().clone(), text, is_sent });
        }
    }

    /// Stores notes that were being edited when another save was selected. The field may then be gone before it loses
    /// the focus.
    pub(super) fn keep_notes_of_others(&mut self, ui: &egui::Ui, shown: Option<&LibraryItem>) {
        let is_other = |field: &mut NotesField| Some(&field.place) != shown.map(LibraryItem::place);
        if let Some(NotesField { place, text, is_sent: false }) = self.notes.take_if(is_other) {
            Command::Library(LibraryCommand::SetNotes { place, text }).send(ui);
        }
    }

    /// Draws the path field, if it is open.
    pub(super) fn path_field(&mut self, ui: &mut egui::Ui) {
        let Some(PathPrompt { question, reason, prompt }) = &mut self.path_prompt else { return };
        let (label, hint) = match question {
            FileQuestion::Open => ("Open", "Path of a champion file or a run folder"),
            FileQuestion::Import => ("Import from", "Path of a champion file or a run folder"),
            FileQuestion::Share(..) => ("Save as", "Path of the file to write"),
            FileQuestion::Export(_) => {
                ("Export to", "Path of a folder; it is created if necessary")
            }
        };
        explain(ui, reason);
        let mut is_closed = false;
        ui.horizontal_wrapped(|ui| {
            let name = ui.label(label);
            // The rest of the width is for two buttons.
            let width = ui.available_width() - theme::COLUMN_WIDTHS[2];
            let (_, end) = prompt.ui(ui, |ui, field| {
                let response = ui.add(field.desired_width(width)).labelled_by(name.id);
                response.on_hover_text(hint)
            });
            let has_text = !prompt.trimmed().is_empty();
            let ok = ui.add_enabled(has_text, egui::Button::new("OK").small());
            let ok = ok.on_disabled_hover_text("Type a path first");
            let is_accepted = end == Some(PromptEnd::Accepted) || ok.clicked();
            if is_accepted && has_text {
                let paths = vec![PathBuf::from(prompt.trimmed())];
                Command::File(FileCommand::Answer(question.clone(), paths)).send(ui);
                is_closed = true;
            } else if is_accepted {
                prompt.ask_again();
            }
            is_closed |= end == Some(PromptEnd::Cancelled)
                || ui.add(egui::Button::new("Cancel").small()).clicked();
        });
        if is_closed {
            self.path_prompt = None;
            self.wants_keyboard = true;
        }
    }
}
