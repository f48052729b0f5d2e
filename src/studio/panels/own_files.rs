//! Presets and stairs, which are built in or made by the user: a list of them, and a field for the name of a new one.

use bevy_egui::egui;

use crate::studio::ui::text_prompt::{PromptEnd, TextPrompt};
use crate::studio::ui::text_rows::{explain, problem};
use crate::studio::ui::theme;
use snakes_core::save::{KnownFiles, OwnKind};

/// A button that opens a field for the name of a new file.
#[derive(Debug, Default)]
pub(super) struct OwnName {
    /// Name that is being typed; `None` while the field is closed.
    prompt: Option<TextPrompt>,
}

impl OwnName {
    /// Draws the button that opens and closes the field.
    pub fn button(
        &mut self,
        ui: &mut egui::Ui,
        (label, hint): (&str, &str),
        suggestion: impl FnOnce() -> String,
    ) {
        let mut is_open = self.prompt.is_some();
        if ui.toggle_value(&mut is_open, label).on_hover_text(hint).changed() {
            self.prompt = is_open.then(|| TextPrompt::new(suggestion()));
        }
    }

    /// Draws the field if it is open. Returns the name when the user saves.
    pub fn field<T: OwnKind>(
        &mut self,
        ui: &mut egui::Ui,
        known: &KnownFiles<T>,
    ) -> Option<String> {
        let mut prompt = self.prompt.take()?;
        let mut is_saved = false;
        let mut is_cancelled = false;
        ui.horizontal_wrapped(|ui| {
            let label = ui.label("Name");
            let (_, end) = prompt.ui(ui, |ui, field| {
                let field = field
                    .desired_width(theme::COMBO_WIDTH)
                    .margin(egui::Margin::symmetric(theme::GAP as i8, theme::GAP as i8 / 2))
                    .hint_text(format!("my-{}", T::WORD));
                ui.add(field).labelled_by(label.id)
            });
            let is_valid = !prompt.text.is_empty() && known.problem_with(&prompt.text).is_none();
            let folder = T::FOLDER;
            let hint =
                format!("Writes a file to the \"{folder}\" folder inside the saves folder (Enter)");
            let refusal = "Type another name first: this one is empty, taken or not allowed";
            let save = ui.add_enabled(is_valid, egui::Button::new("Save")).on_hover_text(hint);
            let save = save.on_disabled_hover_text(refusal);
            is_saved = is_valid && (save.clicked() || end == Some(PromptEnd::Accepted));
            let cancel_hint = "Save nothing (Esc)";
            is_cancelled = end == Some(PromptEnd::Cancelled)
                || ui.button("Cancel").on_hover_text(cancel_hint).clicked();
            if end == Some(PromptEnd::Accepted) && !is_valid {
                prompt.ask_again();
            }
        });
        let reason = known.problem_with(&prompt.text).filter(|_| !prompt.text.is_empty());
        if let Some(reason) = reason {
            problem(ui, &reason);
            let allowed = known.allowed_name(&prompt.text);
            if ui.button(format!("Use the name {allowed}")).clicked() {
                prompt.text = allowed;
                prompt.ask_again();
            }
        }
        if is_saved {
            return Some(prompt.text);
        }
        self.prompt = (!is_cancelled).then_some(prompt);
        None
    }
}

/// Draws the row of a file that can be used. Returns whether it was clicked.
pub(super) fn file_row(ui: &mut egui::Ui, name: &str, selected: Option<&str>, about: &str) -> bool {
    ui.selectable_label(selected == Some(name), name).on_hover_text(about).clicked()
}

/// Draws the user's own files below a heading, if there are any, with the reason if one cannot be used. Returns the clicked one.
pub(super) fn own_files<'k, T: OwnKind>(
    ui: &mut egui::Ui,
    known: &'k KnownFiles<T>,
    heading: &str,
    selected: Option<&str>,
    about: impl Fn(&T) -> &str,
) -> Option<&'k T> {
    let mut clicked = None;
    if !known.own().is_empty() {
        ui.separator();
        explain(ui, heading);
    }
    for own in known.own() {
        match &own.content {
            Ok(file) => {
                if file_row(ui, &own.name, selected, about(file)) {
                    clicked = Some(file);
                }
            }
            Err(reason) => {
                let button = egui::Button::selectable(false, &own.name);
                ui.add_enabled(false, button).on_disabled_hover_text(reason);
            }
        }
    }
    clicked
}
