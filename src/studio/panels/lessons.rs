//! Lessons: the list, and the lesson in progress.

use bevy_egui::egui;
use egui_plot::{Line, PlotPoints};

use crate::score::Evaluation;
use crate::studio::commands::{Command, LessonCommand};
use crate::studio::state::lessons::{Found, LESSONS, LessonView};
use crate::studio::ui::plot_axes::{bounds, fixed_plot, padded_range};
use crate::studio::ui::text_rows::explain;
use crate::studio::ui::theme;

/// Draws the list of lessons or the lesson in progress, and collects the user's commands.
pub(super) fn lessons(
    ui: &mut egui::Ui,
    current: Option<LessonView<'_>>,
    commands: &mut Vec<Command>,
) {
    match current {
        None => list(ui, commands),
        Some(view) => lesson(ui, view, commands),
    }
}

fn list(ui: &mut egui::Ui, commands: &mut Vec<Command>) {
    explain(ui, "Five two-minute experiments. Your own run is paused and comes back unchanged.");
    for (index, lesson) in LESSONS.iter().enumerate() {
        let palette = theme::of(ui);
        palette.card(palette.field_hovered).show(ui, |ui| {
            ui.set_width(ui.available_width());
            let title = format!("{}. {}", index + 1, lesson.title);
            ui.label(egui::RichText::new(title).size(theme::TITLE_SIZE).strong());
            ui.label(lesson.question);
            let name = format!("Begin lesson {}", index + 1);
            if ui.button(&name).clicked() {
                commands.push(Command::Lesson(LessonCommand::Begin(index)));
            }
        });
    }
}

fn lesson(ui: &mut egui::Ui, view: LessonView<'_>, commands: &mut Vec<Command>) {
    let lesson = &LESSONS[view.index];
    let palette = theme::of(ui);
    let accent = |text: &str| egui::RichText::new(text).strong().color(palette.on_accent);
    ui.horizontal_wrapped(|ui| {
        let back = egui::Button::new(accent("Back to my own run")).fill(palette.accent);
        let hint = "End the lesson and restore your run, its settings and the stage";
        if ui.add(back).on_hover_text(hint).clicked() {
            commands.push(Command::Lesson(LessonCommand::Leave));
        }
        if view.index + 1 < LESSONS.len() && ui.button("Next lesson").clicked() {
            commands.push(Command::Lesson(LessonCommand::Begin(view.index + 1)));
        }
    });
    let title = format!("{}. {}", view.index + 1, lesson.title);
    ui.label(egui::RichText::new(title).size(theme::HEADING_SIZE).strong());
    ui.label(egui::RichText::new(lesson.question).italics());
    ui.label(lesson.story);
    heading(ui, "Try it");
    ui.label(lesson.to_try);
    for (index, scene) in lesson.scenes.iter().enumerate() {
        let is_shown = index == view.scene;
        let button = egui::Button::new(scene.label()).selected(is_shown);
        let size = egui::vec2(ui.available_width(), 0.0);
        if ui.add_enabled(!view.is_busy, button.min_size(size)).clicked() {
            commands.push(Command::Lesson(LessonCommand::ShowScene(index)));
        }
    }
    heading(ui, "What to look for");
    ui.label(lesson.look_for);
    if !view.lanes.is_empty() && view.has_tried {
        lanes(ui, view.lanes);
    }
    if !view.runs.is_empty() {
        runs(ui, view.runs, view.is_busy);
    }
    heading(ui, "Conclusion");
    if view.has_tried && !view.is_busy {
        ui.label(lesson.answer);
    } else {
        ui.horizontal(|ui| {
            explain(ui, "Try the experiment first.");
            if ui.small_button("Show conclusion").clicked() {
                commands.push(Command::Lesson(LessonCommand::ShowAnswer));
            }
        });
    }
}

fn heading(ui: &mut egui::Ui, text: &str) {
    ui.add_space(theme::GAP / 2.0);
    ui.label(egui::RichText::new(text).size(theme::TITLE_SIZE).strong());
}

/// Table of the final results of all lanes.
fn lanes(ui: &mut egui::Ui, lanes: &[(String, Evaluation)]) {
    table(ui, "lanes", &["", "Ends at", "Fitness"], |ui| {
        for (name, evaluation) in lanes {
            ui.label(name);
            match evaluation.disqualified {
                Some(reason) => {
                    ui.label("disqualified:");
                    ui.label(reason.words());
                }
                None => {
                    ui.label(format!("{:.2} m", evaluation.centre_y_m));
                    ui.label(format!("{:.2}", evaluation.fitness));
                }
            }
            ui.end_row();
        }
    });
}

/// Chart and table of the results of all runs.
fn runs(ui: &mut egui::Ui, runs: &[Found], is_busy: bool) {
    let palette = theme::of(ui);
    let colors = [palette.accent, palette.second];
    let best = |found: &Found| -> Vec<[f64; 2]> {
        let known = found.reports.iter().filter_map(|report| {
            Some([f64::from(report.generation), report.statistics.as_ref()?.best])
        });
        known.collect()
    };
    let lines: Vec<Vec<[f64; 2]>> = runs.iter().map(best).collect();
    let axis = |of: usize, least: f64| {
        padded_range(lines.iter().flatten().map(move |point| point[of]), least)
    };
    if let (Some(x), Some(y)) = (axis(0, 1.0), axis(1, 1.0)) {
        explain(ui, "Best fitness of each generation (m)");
        fixed_plot("lesson", theme::PLOT_HEIGHT).show(ui, |plot| {
            plot.set_plot_bounds(bounds(&x, &y));
            for ((found, points), color) in runs.iter().zip(&lines).zip(colors) {
                let line = Line::new(found.name.clone(), PlotPoints::from(points.clone()));
                plot.line(line.color(color).width(2.0));
            }
        });
    }
    if is_busy {
        ui.horizontal(|ui| {
            ui.spinner();
            let done = runs.iter().map(|found| found.reports.len()).min().unwrap_or(0);
            explain(ui, &format!("Generations finished: {done}"));
        });
    }
    table(ui, "runs", &["", "Best", "Disqualified", "Run hash"], |ui| {
        for (found, color) in runs.iter().zip(colors) {
            ui.label(egui::RichText::new(&found.name).color(color).strong());
            let best = found.best().map(|best| format!("{:.2} m", best.evaluation.fitness));
            ui.label(best.unwrap_or_else(|| "-".to_owned()));
            let out: u32 = found.reports.iter().map(|report| report.disqualified).sum();
            let all: u32 = found.reports.iter().map(|report| report.evaluations).sum();
            ui.label(format!("{out} of {all}"))
                .on_hover_text("Disqualified snakes of all that were evaluated");
            let hash = found.run_hash.map(|hash| format!("{hash:016x}"));
            let hash = egui::RichText::new(hash.unwrap_or_default()).monospace();
            ui.add(egui::Label::new(hash.size(theme::SMALL_SIZE)).wrap());
            ui.end_row();
        }
    });
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
mod tests {
    use super::*;
    use crate::studio::stage::{Show, StageMode};
    use crate::studio::state::current_run::prepared_run;
    use crate::studio::state::lessons::Lessons;
    use crate::studio::state::undo::UndoHistory;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    /// Commands sent by a click on `label`.
    fn sent(of: &Lessons, label: &str) -> Vec<Command> {
        let size = egui::vec2(theme::PANEL_WIDTH, 1600.0);
        let mut harness = Harness::builder()
            .with_size(size)
            .build_ui_state(|ui, commands| lessons(ui, of.view(), commands), Vec::new());
        harness.run();
        harness.get_by_label(label).click();
        harness.run();
        harness.state().clone()
    }

    #[test]
    fn each_lesson_can_be_started_from_the_list() {
        for index in 0..LESSONS.len() {
            let label = format!("Begin lesson {}", index + 1);
            assert_eq!(
                sent(&Lessons::default(), &label),
                [Command::Lesson(LessonCommand::Begin(index))]
            );
        }
    }

    #[test]
    fn lesson_buttons_run_an_experiment_show_the_conclusion_and_leave() {
        let mut run = prepared_run();
        let mut of = Lessons::default();
        let on_show = Show { champions: Vec::new(), mode: StageMode::Solo };
        let mut apply = |of: &mut Lessons, command| {
            let (show, history) = (on_show.clone(), &mut UndoHistory::default());
            of.apply(&command, &mut run, show, history).expect("allowed");
        };
        apply(&mut of, LessonCommand::Begin(0));
        let second = LESSONS[0].scenes[1].label();
        assert_eq!(sent(&of, second), [Command::Lesson(LessonCommand::ShowScene(1))]);
        assert_eq!(sent(&of, "Show conclusion"), [Command::Lesson(LessonCommand::ShowAnswer)]);
        assert_eq!(sent(&of, "Next lesson"), [Command::Lesson(LessonCommand::Begin(1))]);
        assert_eq!(sent(&of, "Back to my own run"), [Command::Lesson(LessonCommand::Leave)]);
        apply(&mut of, LessonCommand::ShowScene(1));
        // The conclusion is visible after an experiment.
        let size = egui::vec2(theme::PANEL_WIDTH, 1600.0);
        let mut commands = Vec::new();
        let harness =
            Harness::builder().with_size(size).build_ui(|ui| lessons(ui, of.view(), &mut commands));
        assert!(harness.query_by_label(LESSONS[0].answer).is_some());
    }
}
