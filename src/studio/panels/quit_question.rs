//! The question whether to quit although unfinished work would be lost. The run is not lost: every finished generation is saved.

use bevy_egui::egui;

use crate::studio::commands::{Command, WindowCommand};
use crate::studio::state::body_editor::BodyEditor;
use crate::studio::state::library::Library;
use crate::studio::state::shares::Shares;
use crate::studio::state::stairs_exams::StairsExams;
use crate::studio::ui::buttons::{CommandButton, accent_button};
use crate::studio::ui::text_rows::{explain, title_text};
use crate::studio::ui::theme;

/// Returns a sentence for each piece of work that is lost if the program ends now.
pub(crate) fn unfinished(
    shares: &Shares,
    exams: &StairsExams,
    bodies: &BodyEditor,
    library: &Library,
) -> Vec<String> {
    let share = shares.progress().map(|of| format!("A file is being written: {}.", of.in_words()));
    let exam = exams.progress().map(|(name, [done, all])| {
        format!("{name} is being examined on other stairs: {done} of {all} trials are done.")
    });
    let body = bodies.edited().filter(|of| of.is_unsaved || of.tuning.is_some());
    let body = body.map(|of| {
        let name = of.original.name();
        format!("The changed body of {name} is not saved: the panel Body has a button for that.")
    });
    let batches = library.under_way().map(|(words, _)| format!("{words} saves is in progress."));
    share.into_iter().chain(exam).chain(body).chain(batches).collect()
}

/// Draws the question over the window, with a sentence for each piece of work in `unfinished`, and sends the answer.
/// Closes the question when the last piece is finished.
pub(super) fn quit_question(context: &egui::Context, unfinished: &[String]) {
    let wait = Command::Window(WindowCommand::CloseModal);
    if unfinished.is_empty() {
        return wait.send(context);
    }
    let frame = theme::of_context(context).dialog();
    let shown = egui::Modal::new(egui::Id::new("quit")).frame(frame).show(context, |ui| {
        ui.set_max_width(theme::KEY_COLUMN_WIDTH);
        ui.label(title_text("Quit now?"));
        for sentence in unfinished {
            ui.label(sentence);
        }
        explain(ui, "Quitting loses this. The run is saved and can be continued later.");
        ui.horizontal(|ui| {
            let button = accent_button(ui, "Wait");
            CommandButton::of(button, "Keep the window open", wait.clone()).show(ui);
            CommandButton::new("Quit anyway", "", Command::Quit).show(ui);
        });
    });
    if shown.backdrop_response.clicked() {
        wait.send(context);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::panels::testing::{clicked, panel, shows};

    #[test]
    fn the_question_names_the_work_and_closes_when_it_is_finished() {
        let asked = |unfinished: &'static [&str]| {
            panel([600.0, 400.0], move |ui| {
                let unfinished: Vec<String> = unfinished.iter().map(|of| of.to_string()).collect();
                quit_question(ui.ctx(), &unfinished);
            })
        };
        let wait = Command::Window(WindowCommand::CloseModal);
        for (label, command) in [("Wait", wait.clone()), ("Quit anyway", Command::Quit)] {
            let mut question = asked(&["A file is being written: climb.gif  81 %."]);
            assert!(shows(&question, "climb.gif  81 %"));
            assert_eq!(clicked(&mut question, label), [command]);
        }
        let finished = asked(&[]);
        assert!(finished.state().contains(&wait) && !shows(&finished, "Quit now?"));
    }
}
