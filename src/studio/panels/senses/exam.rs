//! Exam on unseen stairs, by rise and tread: with senses and, beside it, without senses. A click shows the snake on the stairs of a cell.

mod stairs_map;

use bevy_egui::egui;

use crate::studio::commands::{Command, ExamCommand};
use crate::studio::stage::lane::Lane;
use crate::studio::stage::staged_champion::StagedChampion;
use crate::studio::state::stairs_exams::{StairsExams, no_exam_because};
use crate::studio::ui::buttons::CommandButton;
use crate::studio::ui::text_rows::{cancellable_progress, explain, folded, title_text};
use crate::studio::ui::theme;

use stairs_map::{StairsMap, legend};

/// Draws the section about the exam of a lane's snake.
pub(super) fn exam(ui: &mut egui::Ui, lane: &Lane, exams: &StairsExams) {
    ui.add_space(theme::GAP / 2.0);
    let name = title_text("Exam on unseen stairs");
    let header = egui::CollapsingHeader::new(name).id_salt("exam").default_open(true);
    let hint = "How many of 100 staircases the snake climbs, nearly all unlike its own";
    folded(ui, header, hint, |ui| {
        let staged = &lane.staged;
        match exams.of(staged.champion()) {
            Some([]) => {}
            // The grids are side by side, with a common axis of the rises.
            Some(grids @ [first, ..]) => {
                for map in StairsMap::side_by_side(ui, grids, staged) {
                    if let Some(cell) = map.ui(ui) {
                        let watch = ExamCommand::Watch { suite: map.grid.suite, cell };
                        Command::Exam(watch).send(ui);
                    }
                }
                legend(ui, first, &staged.champion().trial);
                if staged.is_on_stairs_of_exam() {
                    own_stairs_button(ui, staged);
                } else {
                    explain(ui, "Click a cell to watch the snake on those stairs.");
                }
            }
            None => invitation(ui, staged, exams),
        }
        progress(ui, exams);
    });
}

/// Draws a description of the exam, and the button that begins it.
fn invitation(ui: &mut egui::Ui, staged: &StagedChampion, exams: &StairsExams) {
    if let Some(reason) = no_exam_because(staged) {
        return explain(ui, &reason);
    }
    if exams.progress().is_some() {
        return;
    }
    let senses = staged.champion().genome.senses_surroundings();
    let again = if senses { ", with its senses and without them" } else { "" };
    let stairs = "Five rises, four treads, five distances to the first step";
    explain(ui, &format!("Can it climb other stairs than its own? {stairs}{again}."));
    let hint = "Simulates 30 s on each staircase, in the background: about half a minute";
    let examine = Command::Exam(ExamCommand::Examine);
    CommandButton::new("Examine on 100 staircases", hint, examine).show(ui);
}

/// Draws a button that shows a champion on its own stairs again, if the champion is on stairs of its exam.
pub(in crate::studio::panels) fn own_stairs_button(ui: &mut egui::Ui, staged: &StagedChampion) {
    if staged.is_on_stairs_of_exam() {
        let hint = "Show the snake where it was found, from the start";
        let back = Command::Exam(ExamCommand::BackToOwnStairs);
        CommandButton::new("Back to its own stairs", hint, back).show(ui);
    }
}

/// Draws the progress of the exam in progress, of any snake, and a button that cancels it.
fn progress(ui: &mut egui::Ui, exams: &StairsExams) {
    let Some((name, [done, trials])) = exams.progress() else { return };
    explain(ui, &format!("Examining {name}"));
    let share = done as f32 / trials.max(1) as f32;
    let words = format!("{done} of {trials} trials");
    let cancel = ("Stop the exam", Command::Exam(ExamCommand::Cancel));
    cancellable_progress(ui, cancel, share, &words);
}

#[cfg(test)]
mod tests;
