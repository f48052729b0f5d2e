//! The lessons panel: the list of lessons, or the lesson in progress.

use std::collections::BTreeSet;

use bevy_egui::egui;
use egui_plot::{Line, PlotPoints};

use crate::studio::commands::files::FileCommand;
use crate::studio::commands::{Command, LessonCommand};
use crate::studio::state::lessons::{
    Asks, Found, LESSONS, LessonScene, LessonView, Lessons, Plays, Progress,
};
use crate::studio::ui::accessible::named;
use crate::studio::ui::buttons::{CommandButton, accent_button};
use crate::studio::ui::lane_dot::lane_dot;
use crate::studio::ui::plot_axes::{bounds, fixed_plot, x_title, y_title};
use crate::studio::ui::text_rows::{explain, title_text};
use crate::studio::ui::theme;
use snakes_core::evolve::Champion;
use snakes_core::score::{Evaluation, Fitness, Trial};
use snakes_lab::plot::Axis;

/// Draws the list of lessons or the lesson in progress, and sends the user's commands.
pub(super) fn lessons(ui: &mut egui::Ui, of: &Lessons) {
    match of.view() {
        None => list(ui, &of.finished),
        Some(view) => lesson(ui, view),
    }
}

fn list(ui: &mut egui::Ui, finished: &BTreeSet<String>) {
    explain(ui, "Two-minute experiments. Your own run is paused and comes back unchanged.");
    for (index, lesson) in LESSONS.iter().enumerate() {
        let palette = theme::of(ui);
        palette.card(palette.field_hovered).show(ui, |ui| {
            ui.set_width(ui.available_width());
            ui.label(title_text(numbered(index)));
            ui.label(lesson.question);
            ui.horizontal(|ui| {
                let name = format!("Begin lesson {}", index + 1);
                let begin = named(ui.button("Begin"), egui::WidgetType::Button, &name);
                if begin.clicked() {
                    Command::Lesson(LessonCommand::Begin(index)).send(ui);
                }
                if finished.contains(lesson.title) {
                    ui.label(egui::RichText::new("✔ finished").color(palette.accent));
                }
            });
        });
    }
}

/// Returns the title of a lesson after its number.
fn numbered(index: usize) -> String {
    format!("{}. {}", index + 1, LESSONS[index].title)
}

fn lesson(ui: &mut egui::Ui, view: LessonView<'_>) {
    let lesson = &LESSONS[view.index];
    ui.horizontal_wrapped(|ui| {
        let back = accent_button(ui, "Back to my own run");
        let hint = "End the lesson and restore your run, its settings and the stage";
        CommandButton::of(back, hint, Command::Lesson(LessonCommand::Leave)).show(ui);
        if view.index + 1 < LESSONS.len() {
            let next = Command::Lesson(LessonCommand::Begin(view.index + 1));
            CommandButton::new("Next lesson", "", next).show(ui);
        }
    });
    ui.label(egui::RichText::new(numbered(view.index)).size(theme::HEADING_SIZE).strong());
    ui.label(egui::RichText::new(lesson.question).italics());
    ui.label(lesson.story);
    heading(ui, "Try it");
    ui.label(lesson.to_try);
    for (index, scene) in lesson.scenes.iter().enumerate() {
        let is_shown = index == view.scene;
        let button = egui::Button::new(scene.label).selected(is_shown);
        let button = button.min_size(egui::vec2(ui.available_width(), 0.0));
        let refusal = Some("The runs are still in progress").filter(|_| view.is_busy);
        let show = Command::Lesson(LessonCommand::ShowScene(index));
        CommandButton::of(button, "", show).unless(refusal).show(ui);
    }
    if let Some(scene) = lesson.scenes.get(view.scene) {
        prediction(ui, scene, view);
    }
    heading(ui, "What to look for");
    ui.label(lesson.look_for);
    heading(ui, "Conclusion");
    if view.shows_conclusion {
        ui.label(lesson.conclusion);
    } else {
        let asked = lesson.scenes.iter().filter(|scene| scene.question.is_some()).count();
        let seen = match asked {
            1 => "the result of the experiment",
            _ => "the results of all experiments of this lesson",
        };
        explain(ui, &format!("It appears here once you have seen {seen}."));
    }
    worksheet(ui, view.index);
}

/// Draws the question, the guess and the result of the selected scene.
fn prediction(ui: &mut egui::Ui, scene: &LessonScene, view: LessonView<'_>) {
    let progress = view.progress;
    if let Some(question) = &scene.question {
        let palette = theme::of(ui);
        ui.add_space(theme::GAP / 2.0);
        palette.card(palette.accent).show(ui, |ui| {
            ui.set_width(ui.available_width());
            ui.label(egui::RichText::new(question.text).strong());
            let guessed = progress.guess.and_then(|guess| scene.answers().get(guess).copied());
            match (guessed, progress.comparison(scene)) {
                (_, Some(comparison)) => {
                    ui.label(comparison);
                    ui.label(question.finding);
                }
                _ if !progress.has_begun => guess_buttons(ui, scene),
                (guessed, None) => {
                    ui.label(match guessed {
                        Some(guessed) => format!("Your guess: {guessed}"),
                        None => "No guess".to_owned(),
                    });
                    if question.asks == Asks::PlaybackSpeed {
                        explain(ui, next_play(&progress.plays));
                    } else if !view.is_busy {
                        explain(ui, "The result appears when the race has ended.");
                        if guessed.is_some() {
                            let show = Command::Lesson(LessonCommand::ShowResult);
                            CommandButton::new("Show the result now", "", show).show(ui);
                        }
                    }
                }
            }
        });
    }
    if !progress.plays.finished.is_empty() {
        plays(ui, &progress.plays);
    } else if let Some(trial) = progress.trial.as_ref().filter(|_| progress.is_revealed) {
        lanes(ui, &progress.lanes, trial.fitness);
        zero(ui, trial);
        match trial.fitness {
            Fitness::Climb => explain(
                ui,
                "Fitness is the distance on the stairs, until the whole snake is on the landing. Off the stairs, only the \
                 way to the first step counts.",
            ),
            fitness => explain(ui, &format!("Fitness: {}.", fitness.words())),
        }
    }
    if !progress.runs.is_empty() {
        let asks = scene.question.as_ref().map(|question| question.asks);
        runs(ui, progress, asks, view.is_busy);
    }
}

/// Draws the answers to choose from, and a button to continue without a guess.
fn guess_buttons(ui: &mut egui::Ui, scene: &LessonScene) {
    ui.horizontal_wrapped(|ui| {
        for (index, answer) in scene.answers().into_iter().enumerate() {
            // The full name distinguishes the button from controls of other panels with the same label.
            let name = format!("Guess: {answer}");
            let response = named(ui.button(answer), egui::WidgetType::Button, &name);
            if response.on_hover_text("Guess this, and begin the experiment").clicked() {
                Command::Lesson(LessonCommand::Guess(index)).send(ui);
            }
        }
    });
    let hint = "Begin the experiment; its result appears at the end";
    let watch = Command::Lesson(LessonCommand::Watch);
    CommandButton::new("Watch without a guess", hint, watch).small().show(ui);
}

/// Draws the section about the worksheet to print.
fn worksheet(ui: &mut egui::Ui, index: usize) {
    heading(ui, "Worksheet");
    ui.horizontal_wrapped(|ui| {
        let hint = "Opens the worksheet in the browser, which prints it on one sheet of paper; a tick there shows the teacher's answers";
        let print = Command::File(FileCommand::PrintWorksheet(index));
        CommandButton::new("Print the worksheet", hint, print).show(ui);
        let hint = "Copy its text (Markdown), with the teacher's answers at its end, to paste it into a text processor";
        let copied = Command::Notify(format!("Worksheet {} copied.", index + 1));
        if CommandButton::new("Copy worksheet", hint, copied).show(ui) {
            ui.ctx().copy_text(LESSONS[index].worksheet.to_owned());
        }
    });
}

fn heading(ui: &mut egui::Ui, text: &str) {
    ui.add_space(theme::GAP / 2.0);
    ui.label(title_text(text));
}

/// Returns the next task of a reader who compares playbacks.
fn next_play(plays: &Plays) -> &'static str {
    if plays.finished.is_empty() {
        return "Play it to its end. The result appears after two speeds.";
    }
    "Now choose another speed (the field with × below the stage), and play it to its end again."
}

/// Draws a table of the finished playbacks, with all digits of the results.
fn plays(ui: &mut egui::Ui, plays: &Plays) {
    table(ui, "plays", &["Speed", "Ends at", "Hash of the motion"], |ui| {
        for play in &plays.finished {
            ui.label(format!("× {}", play.speed));
            ui.label(format!("{} m", play.evaluation.centre_y_m));
            hash(ui, play.evaluation.trace_hash);
            ui.end_row();
        }
    });
}

fn hash(ui: &mut egui::Ui, hash: u64) {
    let text = egui::RichText::new(format!("{hash:016x}")).monospace();
    ui.add(egui::Label::new(text.size(theme::SMALL_SIZE)).wrap());
}

/// Draws the name of a lane or run, with the colour of its lane in the race.
fn lane_name(ui: &mut egui::Ui, lane: usize, name: &str) {
    ui.horizontal(|ui| {
        lane_dot(ui, lane, theme::GAP);
        ui.label(name);
    });
}

/// Draws a table of the final results of all lanes.
fn lanes(ui: &mut egui::Ui, lanes: &[(String, Evaluation)], fitness: Fitness) {
    table(ui, "lanes", &["", "Ends at", "Fitness"], |ui| {
        for (lane, (name, evaluation)) in lanes.iter().enumerate() {
            match lanes {
                // A single snake has no lane colour.
                [_] => drop(ui.label(name)),
                _ => lane_name(ui, lane, name),
            }
            match evaluation.disqualified {
                Some(reason) => {
                    ui.label("disqualified:");
                    ui.label(reason.words());
                }
                None => {
                    ui.label(format!("{:.2} m", evaluation.centre_y_m));
                    ui.label(fitness.brief(evaluation.fitness));
                }
            }
            ui.end_row();
        }
    });
}

/// Draws a chart of all runs and, when the results may be shown, a table of them.
fn runs(ui: &mut egui::Ui, progress: &Progress, asks: Option<Asks>, is_busy: bool) {
    let runs = &progress.runs;
    let trial = runs.iter().find_map(Found::best).map(|best| &best.trial);
    // A share is shown in percent. The vertical axis has a minimum range: a metre, or a tenth of the way.
    let (factor, unit, least) = match trial.map(|trial| trial.fitness) {
        Some(Fitness::Share) => (100.0, "%", 10.0),
        fitness => (1.0, fitness.map_or("", Fitness::unit).trim(), 1.0),
    };
    let palette = theme::of(ui);
    let best = |found: &Found| -> Vec<[f64; 2]> {
        let known = found.reports.iter().filter_map(|report| {
            Some([f64::from(report.generation), factor * report.statistics.as_ref()?.best])
        });
        known.collect()
    };
    let lines: Vec<Vec<[f64; 2]>> = runs.iter().map(best).collect();
    let along = |of: usize| lines.iter().flatten().map(move |point| point[of]);
    if along(0).next().is_some() {
        let x = Axis::around("Generation", "", along(0), 1.0);
        let y = Axis::around("Best fitness of each generation", unit, along(1), least);
        y_title(ui, &y.label());
        fixed_plot("lesson", theme::PLOT_HEIGHT, [&x, &y]).show(ui, |plot| {
            plot.set_plot_bounds(bounds(&x.range, &y.range));
            for (lane, (found, points)) in runs.iter().zip(&lines).enumerate() {
                let line = Line::new(found.name.clone(), PlotPoints::from(points.clone()));
                plot.line(line.color(palette.lane_color(lane)).width(2.0));
            }
        });
        x_title(ui, &x.label());
    }
    if is_busy {
        ui.horizontal(|ui| {
            ui.spinner();
            let done = runs.iter().map(|found| found.reports.len()).min().unwrap_or(0);
            explain(ui, &format!("Generations finished: {done}"));
        });
    }
    if !progress.is_revealed {
        for (lane, found) in runs.iter().enumerate() {
            lane_name(ui, lane, &found.name);
        }
        return;
    }
    let of_bodies = asks == Some(Asks::LateBodyChanges);
    let middle = if of_bodies { "Late changes" } else { "Disqualified" };
    table(ui, "runs", &["", "Best", middle, "Run hash"], |ui| {
        for (lane, found) in runs.iter().enumerate() {
            lane_name(ui, lane, &found.name);
            ui.label(found.best().map_or_else(|| "-".to_owned(), Champion::brief));
            if of_bodies {
                ui.label(found.late_body_changes().to_string()).on_hover_text(
                    "Generations of the second half whose best snake has another body than the best before it",
                );
            } else {
                let out: u32 = found.reports.iter().map(|report| report.disqualified).sum();
                let all: u32 = found.reports.iter().map(|report| report.evaluations).sum();
                ui.label(format!("{out} of {all}")).on_hover_text(
                    "Snakes that left the area, moved too fast or came apart, of all that were tried",
                );
            }
            hash(ui, found.run_hash.unwrap_or_default());
            ui.end_row();
        }
    });
    if let Some(trial) = trial.filter(|trial| trial.fitness.is_along_y()) {
        zero(ui, trial);
    }
}

/// Explains from where a table counts distances.
fn zero(ui: &mut egui::Ui, trial: &Trial) {
    let to_step_m = trial.stairs.first_riser_y_m;
    explain(
        ui,
        &format!(
            "Positions count from a line {to_step_m} m before the first step. Snakes start before that line, at negative positions."
        ),
    );
}

fn table(ui: &mut egui::Ui, id: &str, heads: &[&str], rows: impl FnOnce(&mut egui::Ui)) {
    let spacing = [theme::GAP * 1.5, theme::GAP / 2.0];
    egui::Grid::new(id).num_columns(heads.len()).spacing(spacing).show(ui, |ui| {
        for head in heads {
            explain(ui, head);
        }
        ui.end_row();
        rows(ui);
    });
}

#[cfg(test)]
mod tests;
