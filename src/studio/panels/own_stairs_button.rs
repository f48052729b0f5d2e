//! A button to leave the stairs of an exam, for the panels that name these stairs.

use bevy_egui::egui;

use crate::studio::commands::{Command, ExamCommand};
use crate::studio::stage::staged_champion::StagedChampion;
use crate::studio::ui::buttons::CommandButton;

/// Draws a button that shows a champion on its own stairs again, if the champion is on stairs of its exam.
pub(super) fn own_stairs_button(ui: &mut egui::Ui, staged: &StagedChampion) {
    if staged.is_on_stairs_of_exam() {
        let hint = "Show the snake where it was found, from the start";
        let back = Command::Exam(ExamCommand::BackToOwnStairs);
        CommandButton::new("Back to its own stairs", hint, back).show(ui);
    }
}
