//! Details of the selected save, below the list, and buttons for its actions.

use bevy_egui::egui;

use super::actions::{LibraryAction, LibraryActionKind};
use crate::studio::commands::Command;
use crate::studio::commands::library::LibraryCommand;
use crate::studio::panels::thumbnail::{sparkline, thumbnail};
use crate::studio::state::library::LibraryItem;
use crate::studio::state::lineup::learning;
use crate::studio::ui::buttons::CommandButton;
use crate::studio::ui::decimals::in_percent;
use crate::studio::ui::text_rows::{explain, problem, row, title_text};
use crate::studio::ui::theme;
use snakes_core::save::library::{RunDetails, SavePlace};
use snakes_core::schema::{Choice, Choices};
use snakes_core::score::{EndingKind, ExamSuite, SuiteResult, Trick};
use snakes_lab::run::names::{preset_title, with_title};

/// Draws a button for each action. Returns the action that was clicked.
pub fn buttons(ui: &mut egui::Ui, actions: &[LibraryAction]) -> Option<LibraryActionKind> {
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing = egui::Vec2::splat(theme::GAP / 2.0);
        clicked_of(ui, actions, egui::Button::small)
    })
    .inner
}

/// Draws the actions as menu entries. Returns the action that was clicked.
pub fn menu(ui: &mut egui::Ui, actions: &[LibraryAction]) -> Option<LibraryActionKind> {
    let clicked = clicked_of(ui, actions, |button| button);
    if clicked.is_some() {
        ui.close();
    }
    clicked
}

fn clicked_of(
    ui: &mut egui::Ui,
    actions: &[LibraryAction],
    look: fn(egui::Button<'static>) -> egui::Button<'static>,
) -> Option<LibraryActionKind> {
    let mut clicked = None;
    for action in actions {
        let button = look(egui::Button::new(action.name));
        let response = ui.add_enabled(action.refusal.is_none(), button).on_hover_text(action.hint);
        if response.on_disabled_hover_text(action.refusal.unwrap_or_default()).clicked() {
            clicked = Some(action.act.clone());
        }
    }
    clicked
}

/// Draws the details of a save. `is_open` tells whether the save is the run that this window has open.
pub fn details(ui: &mut egui::Ui, item: &LibraryItem, is_open: bool) {
    picture(ui, item);
    ui.add(egui::Label::new(egui::RichText::new(item.name()).strong()).truncate());
    if let Some(reason) = item.problem() {
        return problem(ui, &reason.message);
    }
    if item.read.is_none() {
        return explain(ui, "Loading…");
    }
    // Lines that are always shown, and those that a click unfolds.
    let (mut lines, mut folded) = (Vec::new(), Vec::new());
    let mut exam: &[SuiteResult] = &[];
    let folder = item.place().shown_name();
    if item.name() != folder {
        folded.push(format!("Folder {folder}"));
    }
    if let Some(champion) = item.champion() {
        let origin = &champion.origin;
        let (climbed, steps) = (champion.climbed, champion.steps);
        lines.push(format!("{}; {climbed} of {steps} steps", champion.reached));
        let (about, command) = match champion.note.as_deref().unwrap_or_default() {
            note if note.starts_with(FOUND_BY) => ("", note),
            note => note.split_once(&format!(" {FOUND_BY}")).unwrap_or((note, "")),
        };
        lines.extend((!about.is_empty()).then(|| about.to_owned()));
        exam = &champion.exam;
        folded.push(format!(
            "{}, seed {}, generation {}, snake {}",
            preset_title(&origin.preset),
            origin.seed,
            origin.generation,
            origin.individual + 1
        ));
        let (controller, engine) = (champion.controller.name(), champion.engine);
        let (duration_s, physics) = (champion.duration_s, champion.physics.choice().name);
        folded.push(format!(
            "Duration {duration_s} s, controller {controller}, physics {physics}, engine {engine}"
        ));
        let command = command.trim_start_matches(FOUND_BY).trim();
        folded.extend((!command.is_empty()).then(|| format!("{FOUND_BY} {command}")));
    }
    if let Some(run) = item.run() {
        lines.push(match run.best {
            Some((generation, fitness)) => {
                let fitness = run.rewarded.text(fitness);
                format!("Best {fitness} in generation {generation}; {}", item.generation_text())
            }
            None => item.generation_text(),
        });
        lines.push(match &run.ended {
            _ if is_open => "Open in this window: the Watch panel controls it".to_owned(),
            Some(_) if run.generations.is_some() => {
                "Finished; opened, it can be continued for more generations".to_owned()
            }
            Some(why) => format!("Cannot be continued: {why}"),
            None => "Can be continued".to_owned(),
        });
        let method = run.strategy.map(|method| format!(", {}", method.title()));
        let (preset, seed, controller) = (with_title(&run.preset), run.seed, run.controller.name());
        let method = method.unwrap_or_default();
        folded.push(format!("{preset}, seed {seed}{method}, controller {controller}"));
    }
    if item.place().path().is_none() {
        lines.push("Built-in champion; it cannot be changed".to_owned());
    }
    lines.iter().for_each(|line| explain(ui, line));
    if !exam.is_empty() {
        exam_table(ui, exam);
    }
    egui::CollapsingHeader::new("Details").show(ui, |ui| {
        folded.iter().for_each(|line| explain(ui, line));
    });
}

/// Words before the command that found a champion, in the note of its file.
const FOUND_BY: &str = "Found by:";

/// Draws the results of an exam: per suite, on how many trials the champion landed, or which share of its way it kept.
fn exam_table(ui: &mut egui::Ui, exam: &[SuiteResult]) {
    ui.label(title_text("Exam"));
    let spacing = [theme::GAP * 1.5, theme::GAP / 4.0];
    egui::Grid::new("exam").num_columns(2).min_row_height(0.0).spacing(spacing).show(ui, |ui| {
        ui.spacing_mut().interact_size.y = 0.0;
        let mut row = |name: &str, hint: &str, value: String| {
            explain(ui, name);
            ui.label(value).on_hover_text(hint);
            ui.end_row();
        };
        for result in exam {
            let Choice { title, sentence, .. } = result.suite.choice();
            let is_of_ways = result.suite != ExamSuite::HeldOut && !result.each.is_empty();
            row(
                title,
                &sentence,
                match is_of_ways {
                    true => format!("at least {} of the way kept", in_percent(result.kept)),
                    false => format!("{} of {} climbed", result.landed, result.trials),
                },
            );
            let ways = result.each.iter().filter(|_| is_of_ways);
            let ways = ways.map(|(condition, kept)| (condition.as_str(), in_percent(*kept)));
            let classes = result.classes().into_iter();
            let classes = classes.map(|(class, landed, of)| (class, format!("{landed} of {of}")));
            for (name, value) in ways.chain(classes) {
                row(&format!("    {name}"), &sentence, value);
            }
            // The line of the suite says how many landed.
            let others = result.endings.counts.iter().filter(|of| of.kind != EndingKind::Landed);
            let others = others.map(|of| (of.kind.choice(), of.trials));
            let tricks = Trick::OPTIONS.iter().zip(result.endings.tricks);
            let tricks = tricks.filter(|(_, trials)| *trials > 0);
            let tricks = tricks.map(|(trick, trials)| (trick.choice(), trials));
            for (Choice { title, sentence, .. }, trials) in others.chain(tricks) {
                row(&format!("    {title}"), &sentence, format!("{trials} of {}", result.trials));
            }
        }
    });
}

fn picture(ui: &mut egui::Ui, item: &LibraryItem) {
    let Some(of) = item.thumbnail() else { return };
    let size = egui::vec2(ui.available_width(), theme::PICTURE_HEIGHT);
    let (rect, response) = ui.allocate_exact_size(size, egui::Sense::hover());
    let palette = theme::of(ui);
    let line = item.run().map(|run| run.best_of_each.as_slice()).filter(|best| best.len() > 1);
    let Some(line) = line else {
        thumbnail(ui.painter(), rect, of, palette);
        response.on_hover_text("Side view: the path of the middle block and the final pose");
        return;
    };
    let gap = theme::GAP / 2.0;
    let [left, right] =
        [rect.with_max_x(rect.center().x - gap), rect.with_min_x(rect.center().x + gap)];
    thumbnail(ui.painter(), left, of, palette);
    sparkline(ui.painter(), right, line, palette);
    response
        .on_hover_text("Left: side view of its best snake. Right: best fitness of each generation");
}

/// Draws the list of the champions of a run.
pub fn champions(ui: &mut egui::Ui, place: &SavePlace, run: &RunDetails) {
    let Some(folder) = place.run() else { return };
    let fitness_of = |generation: u32| {
        run.best_of_each.get((generation as usize).saturating_sub(1)).copied().flatten()
    };
    if run.champions.len() > 1 {
        let hint = "Replay the best of its generations side by side; of many, those that show how it improved";
        let fitness =
            run.champions.iter().map(|generation| fitness_of(*generation).unwrap_or_default());
        let chosen = learning(&fitness.collect::<Vec<_>>());
        let generations = chosen.into_iter().map(|index| run.champions[index]).collect();
        let run = folder.to_owned();
        let race = Command::Library(LibraryCommand::RaceGenerations { run, generations });
        CommandButton::new("Race generations", hint, race).show(ui);
    }
    let area =
        egui::ScrollArea::vertical().id_salt("champions").max_height(theme::CHAMPIONS_HEIGHT);
    let height = ui.spacing().interact_size.y;
    area.auto_shrink([false, true]).show_rows(ui, height, run.champions.len(), |ui, rows| {
        for generation in run.champions.get(rows).unwrap_or_default() {
            let about = fitness_of(*generation).map(|fitness| run.rewarded.text(fitness));
            let name = format!("Generation {generation}");
            let response = row(ui, &name, &about.unwrap_or_default());
            if response.on_hover_text("Click to replay").clicked() {
                let (run, generation) = (folder.to_owned(), *generation);
                Command::Library(LibraryCommand::ReplayGeneration { run, generation }).send(ui);
            }
        }
    });
}
