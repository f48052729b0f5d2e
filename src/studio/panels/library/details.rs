//! Under the list: what is chosen, what there is to know of it, and what can be done with it.

use std::path::PathBuf;

use bevy_egui::egui;

use super::actions::{Act, Action};
use super::thumbnail::{sparkline, thumbnail};
use crate::save::library::{Place, RunDetails};
use crate::studio::command::Command;
use crate::studio::library::{Ask, Item, fitness_text};
use crate::studio::look;
use crate::studio::panels::{explain, row};

/// A button for each action. Returns the one that is asked for.
pub fn buttons(ui: &mut egui::Ui, actions: &[Action]) -> Option<Act> {
    let mut wanted = None;
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing = egui::Vec2::splat(look::GAP / 2.0);
        for action in actions {
            if button(ui, action, true) {
                wanted = Some(action.act.clone());
            }
        }
    });
    wanted
}

/// The same as a menu.
pub fn menu(ui: &mut egui::Ui, actions: &[Action]) -> Option<Act> {
    let mut wanted = None;
    for action in actions {
        if button(ui, action, false) {
            wanted = Some(action.act.clone());
            ui.close();
        }
    }
    wanted
}

fn button(ui: &mut egui::Ui, action: &Action, is_small: bool) -> bool {
    let button = egui::Button::new(action.name);
    let button = if is_small { button.small() } else { button };
    let response = ui.add_enabled(action.refusal.is_none(), button).on_hover_text(action.hint);
    response.on_disabled_hover_text(action.refusal.unwrap_or_default()).clicked()
}

/// What there is to know of one save.
pub fn details(ui: &mut egui::Ui, item: &Item) {
    picture(ui, item);
    ui.add(egui::Label::new(egui::RichText::new(item.name()).strong()).truncate());
    if let Some(problem) = item.problem() {
        ui.add(egui::Label::new(egui::RichText::new(problem).color(look::of(ui).problem)));
        return;
    }
    if !item.is_read() {
        return explain(ui, "It is being read ...");
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
        let duration_s = champion.duration_s;
        lines.push(format!("{duration_s} s, controller {controller}, engine {engine}"));
        lines.extend(champion.note.clone());
    }
    if let Some(run) = item.run() {
        lines.push(match run.best {
            Some((generation, fitness)) => {
                let fitness = fitness_text(fitness, run.rewarded);
                format!("Best {fitness}, of generation {generation}; {}", item.generation_text())
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
            Some(why) => format!("It cannot go on: {why}"),
            None => "It can go on".to_owned(),
        });
    }
    if item.place().path().is_none() {
        lines.push("It comes with the program, and cannot be changed".to_owned());
    }
    for line in lines {
        explain(ui, &line);
    }
}

fn picture(ui: &mut egui::Ui, item: &Item) {
    let Some(of) = item.thumbnail() else { return };
    let size = egui::vec2(ui.available_width(), look::PICTURE_HEIGHT);
    let (rect, response) = ui.allocate_exact_size(size, egui::Sense::hover());
    let palette = look::of(ui);
    let line = item.run().map(|run| run.best_of_each.as_slice()).filter(|best| best.len() > 1);
    let Some(line) = line else {
        thumbnail(ui.painter(), rect, of, palette);
        response
            .on_hover_text("The way of its middle block, and the snake at the end, from the side");
        return;
    };
    let gap = look::GAP / 2.0;
    let [left, right] =
        [rect.with_max_x(rect.center().x - gap), rect.with_min_x(rect.center().x + gap)];
    thumbnail(ui.painter(), left, of, palette);
    sparkline(ui.painter(), right, line, palette);
    response.on_hover_text(
        "Left: what its best does, from the side. Right: the best of each generation",
    );
}

/// The champions of a run's generations.
pub fn champions(ui: &mut egui::Ui, place: &Place, run: &RunDetails, asked: &mut Vec<Command>) {
    let Some(folder) = place.run().map(ToOwned::to_owned) else { return };
    let folder: PathBuf = folder;
    if run.champions.len() > 1 {
        let hint = "Its generations side by side; of many some at equal distances";
        if ui.button("Race generations").on_hover_text(hint).clicked() {
            let (run, generations) = (folder.clone(), run.champions.clone());
            asked.push(Command::Library(Ask::RaceGenerations { run, generations }));
        }
    }
    let area = egui::ScrollArea::vertical().id_salt("champions").max_height(look::CHAMPIONS_HEIGHT);
    let height = ui.spacing().interact_size.y;
    area.auto_shrink([false, true]).show_rows(ui, height, run.champions.len(), |ui, rows| {
        for generation in run.champions.get(rows).unwrap_or_default() {
            let index = (*generation as usize).saturating_sub(1);
            let fitness = run.best_of_each.get(index).copied().flatten();
            let about = fitness.map(|fitness| fitness_text(fitness, run.rewarded));
            let name = format!("Generation {generation}");
            let response = row(ui, false, &name, &about.unwrap_or_default());
            if response.on_hover_text("Click to replay").clicked() {
                let (run, generation) = (folder.clone(), *generation);
                asked.push(Command::Library(Ask::ReplayGeneration { run, generation }));
            }
        }
    });
}
