//! Details of the selected save, below the list, and buttons for its actions.

use bevy_egui::egui;

use super::actions::{LibraryAction, LibraryActionKind};
use crate::studio::commands::Command;
use crate::studio::commands::library::LibraryCommand;
use crate::studio::panels::thumbnail::{sparkline, thumbnail};
use crate::studio::state::library::LibraryItem;
use crate::studio::ui::buttons::CommandButton;
use crate::studio::ui::text_rows::{explain, problem, row};
use crate::studio::ui::theme;
use snakes_core::save::library::{RunDetails, SavePlace};
use snakes_core::schema::Choices;

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
    let folder = item.place().shown_name();
    if item.name() != folder {
        explain(ui, &format!("Folder {folder}"));
    }
    if let Some(reason) = item.problem() {
        return problem(ui, reason);
    }
    if !item.is_read() {
        return explain(ui, "Loading…");
    }
    let mut lines = Vec::new();
    if let Some(champion) = item.champion() {
        let origin = &champion.origin;
        let (climbed, steps) = (champion.climbed, champion.steps);
        lines.push(format!("{}; {climbed} of {steps} steps", champion.reached));
        lines.push(format!(
            "Preset {}, seed {}, generation {}, snake {}",
            origin.preset,
            origin.seed,
            origin.generation,
            origin.individual + 1
        ));
        let (controller, engine) = (champion.controller.name(), champion.engine);
        let (duration_s, physics) = (champion.duration_s, champion.physics.choice().name);
        lines.push(format!(
            "Duration {duration_s} s, controller {controller}, physics {physics}, engine {engine}"
        ));
        lines.extend(champion.exam.as_ref().map(|exam| format!("Exam: {exam}")));
        lines.extend(champion.note.clone());
    }
    if let Some(run) = item.run() {
        lines.push(match run.best {
            Some((generation, fitness)) => {
                let fitness = run.rewarded.text(fitness);
                format!("Best {fitness} in generation {generation}; {}", item.generation_text())
            }
            None => item.generation_text(),
        });
        let method = run.strategy.map(|method| format!(", {}", method.title()));
        let (preset, seed, controller) = (&run.preset, run.seed, run.controller.name());
        lines.push(format!(
            "Preset {preset}, seed {seed}{}, controller {controller}",
            method.unwrap_or_default()
        ));
        lines.push(match &run.ended {
            _ if is_open => "Open in this window: the Watch panel controls it".to_owned(),
            Some(why) => format!("Cannot be resumed: {why}"),
            None => "Can be resumed".to_owned(),
        });
    }
    if item.place().path().is_none() {
        lines.push("Built-in champion; it cannot be changed".to_owned());
    }
    for line in lines {
        explain(ui, &line);
    }
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
pub fn champions(
    ui: &mut egui::Ui,
    place: &SavePlace,
    run: &RunDetails,
    commands: &mut Vec<Command>,
) {
    let Some(folder) = place.run() else { return };
    if run.champions.len() > 1 {
        let hint = "Replay the best of its generations side by side, spread evenly over the run";
        let (run, generations) = (folder.to_owned(), run.champions.clone());
        let race = Command::Library(LibraryCommand::RaceGenerations { run, generations });
        CommandButton::new("Race generations", hint, race).show(ui, commands);
    }
    let area =
        egui::ScrollArea::vertical().id_salt("champions").max_height(theme::CHAMPIONS_HEIGHT);
    let height = ui.spacing().interact_size.y;
    area.auto_shrink([false, true]).show_rows(ui, height, run.champions.len(), |ui, rows| {
        for generation in run.champions.get(rows).unwrap_or_default() {
            let index = (*generation as usize).saturating_sub(1);
            let fitness = run.best_of_each.get(index).copied().flatten();
            let about = fitness.map(|fitness| run.rewarded.text(fitness));
            let name = format!("Generation {generation}");
            let response = row(ui, false, &name, &about.unwrap_or_default());
            if response.on_hover_text("Click to replay").clicked() {
                let (run, generation) = (folder.to_owned(), *generation);
                commands
                    .push(Command::Library(LibraryCommand::ReplayGeneration { run, generation }));
            }
        }
    });
}
