//! Buttons and check boxes that send a command. Their tooltips include the command's shortcut.

use std::borrow::Cow;

use bevy_egui::egui;

use super::check_box::check_box;
use super::theme;
use crate::studio::commands::actions::hint_with_key;
use crate::studio::commands::pick::Pick;
use crate::studio::commands::{Command, StageCommand};

/// A button that sends a command when it is clicked.
pub(crate) struct CommandButton<'a> {
    button: egui::Button<'a>,
    hint: Cow<'a, str>,
    refusal: Option<&'a str>,
    command: Command,
}

impl<'a> CommandButton<'a> {
    /// Creates a button with this label. An empty hint adds no tooltip.
    pub fn new(
        label: impl egui::IntoAtoms<'a>,
        hint: impl Into<Cow<'a, str>>,
        command: Command,
    ) -> Self {
        Self::of(egui::Button::new(label), hint, command)
    }

    /// Makes an existing egui button send a command.
    pub fn of(button: egui::Button<'a>, hint: impl Into<Cow<'a, str>>, command: Command) -> Self {
        Self { button, hint: hint.into(), refusal: None, command }
    }

    /// Makes the button low.
    pub fn small(self) -> Self {
        Self { button: self.button.small(), ..self }
    }

    /// Disables the button if `refusal` is a reason. The reason replaces the tooltip unless it is empty.
    pub fn unless(self, refusal: Option<&'a str>) -> Self {
        Self { refusal, ..self }
    }

    /// Disables the button unless `is_possible`.
    pub fn only_if(self, is_possible: bool) -> Self {
        self.unless((!is_possible).then_some(""))
    }

    /// Draws the button, and sends its command when it is clicked. Returns whether it was clicked.
    pub fn show(self, ui: &mut egui::Ui) -> bool {
        let pressed = self.pressed(ui);
        let is_clicked = pressed.is_some();
        Command::send_all(pressed, ui);
        is_clicked
    }

    /// Draws the button. Returns its command when it is clicked.
    pub fn pressed(self, ui: &mut egui::Ui) -> Option<Command> {
        let Self { button, hint, refusal, command } = self;
        let mut response = ui.add_enabled(refusal.is_none(), button);
        if !hint.is_empty() {
            response = hint_of_command(response, &hint, &command);
        }
        if let Some(refusal) = refusal.filter(|refusal| !refusal.is_empty()) {
            response = response.on_disabled_hover_text(refusal);
        }
        response.clicked().then_some(command)
    }
}

/// Draws a check box for something that a command switches on and off. A click sends the command.
pub(crate) fn command_box(
    ui: &mut egui::Ui,
    mut is_on: bool,
    (label, hint): (&str, &str),
    command: Command,
) {
    let response = check_box(ui, &mut is_on, label);
    if hint_of_command(response, hint, &command).clicked() {
        command.send(ui);
    }
}

/// Adds a tooltip with the hint and the command's shortcut, which is looked up only while the tooltip is shown.
pub(crate) fn hint_of_command(
    response: egui::Response,
    hint: &str,
    command: &Command,
) -> egui::Response {
    response.on_hover_ui(|ui| {
        // The same width as that of egui's own tooltips.
        ui.set_max_width(ui.spacing().tooltip_width);
        ui.label(hint_with_key(hint, command));
    })
}

/// Returns a button in the accent colour, for the most likely action.
pub(crate) fn accent_button(ui: &egui::Ui, label: &str) -> egui::Button<'static> {
    let palette = theme::of(ui);
    let text = egui::RichText::new(label).strong().color(palette.on_accent);
    egui::Button::new(text).fill(palette.accent)
}

/// Returns the command of a click on an individual: it is shown alone or, with Shift or Control, joins the stage.
pub(crate) fn show_or_join(ui: &egui::Ui, pick: Pick) -> Command {
    let joins = ui.input(|input| input.modifiers.shift || input.modifiers.command);
    Command::Stage(if joins { StageCommand::Join(pick) } else { StageCommand::Show(pick) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::commands::{PlanCommand, RunCommand};

    #[test]
    fn a_hint_names_the_shortcut_of_its_command_in_any_situation() {
        for (command, hint) in [
            (Command::Run(RunCommand::Start), "Go (E)"),
            (Command::Run(RunCommand::Pause), "Go (E)"),
            (Command::Plan(PlanCommand::DropChange), "Go (Esc)"),
            (Command::Stage(StageCommand::Leave), "Go (Esc)"),
            (Command::Run(RunCommand::Reset), "Go"),
        ] {
            assert_eq!(hint_with_key("Go", &command), hint);
        }
    }
}
