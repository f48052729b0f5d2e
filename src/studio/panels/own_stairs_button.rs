//! The way back from the stairs of an exam, for the panels that name them.

use bevy_egui::egui;

use crate::studio::commands::{Command, ExamCommand};
use crate::studio::stage::staged_champion::StagedChampion;

/// Draws a button that shows a champion on its own stairs again, if it is on those of its exam.
pub(super) fn own_stairs_button(
    ui: &mut egui::Ui,
    staged: &StagedChampion,
    commands: &mut Vec<Command>,
) {
    if !staged.is_on_stairs_of_exam() {
        return;
    }
    let hint = "Show the snake where it was found, from the start";
    if ui.button("Back to its own stairs").on_hover_text(hint).clicked() {
        commands.push(Command::Exam(ExamCommand::BackToOwnStairs));
    }
}
