//! Menu bar: every action by name, with its shortcut.

use std::path::Path;

use bevy_egui::egui;
use bevy_egui::egui::containers::menu::MenuBar;

use crate::save::library::run_of_plan;
use crate::studio::commands::Command;
use crate::studio::commands::actions::{ACTIONS, Action, Menu, Situation};
use crate::studio::commands::files::{FileCommand, FileQuestion};
use crate::studio::state::files::RecentFiles;
use crate::studio::ui::theme;

/// Draws the menus and collects the user's commands. `is_on` says whether the setting that a command toggles is on.
/// `recent` are the files that were opened lately. `about` is shown at the right end.
pub(crate) fn menu(
    ui: &mut egui::Ui,
    situation: Situation,
    is_on: &dyn Fn(&Command) -> Option<bool>,
    recent: &RecentFiles,
    about: &str,
    commands: &mut Vec<Command>,
) {
    MenuBar::new().ui(ui, |ui| {
        let name = egui::RichText::new("Snakes & Stairs").strong().color(theme::of(ui).accent);
        ui.label(name);
        ui.add_space(theme::GAP / 2.0);
        for menu in Menu::ALL {
            ui.menu_button(menu.name(), |ui| {
                ui.set_min_width(theme::MENU_WIDTH);
                for action in ACTIONS.iter().filter(|action| action.menu == menu) {
                    entry(ui, action, situation, is_on, commands);
                    if action.name == BEFORE_RECENT {
                        open_recent(ui, recent, commands);
                    }
                }
            });
        }
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            let text = egui::RichText::new(about).color(theme::of(ui).text_weak);
            ui.add(egui::Label::new(text).truncate()).on_hover_text(about);
        });
    });
}

/// The action after which the files that were opened lately are listed.
const BEFORE_RECENT: &str = "Open…";

/// Draws the submenu of files that were opened lately: names, with whole paths as hints.
fn open_recent(ui: &mut egui::Ui, recent: &RecentFiles, commands: &mut Vec<Command>) {
    ui.add_enabled_ui(recent.paths().len() > 0, |ui| {
        ui.menu_button("Open recent", |ui| {
            ui.set_min_width(theme::MENU_WIDTH);
            for path in recent.paths() {
                let button = egui::Button::new(short_name(path)).truncate();
                if ui.add(button).on_hover_text(path.display().to_string()).clicked() {
                    let paths = vec![path.to_owned()];
                    commands.push(Command::File(FileCommand::Answer(FileQuestion::Open, paths)));
                    ui.close();
                }
            }
        });
    });
}

/// A file's name; for the plan of a run, the name of its folder.
fn short_name(path: &Path) -> String {
    run_of_plan(path).name()
}

fn entry(
    ui: &mut egui::Ui,
    action: &Action,
    situation: Situation,
    is_on: &dyn Fn(&Command) -> Option<bool>,
    commands: &mut Vec<Command>,
) {
    // An action for a range of digits needs a digit, which a menu cannot supply.
    if action.key().contains("...") {
        return;
    }
    let command = (action.asks)(situation);
    let mut button = egui::Button::new(action.name).shortcut_text(action.key());
    if let Some(is_on) = command.as_ref().and_then(is_on) {
        button = button.selected(is_on);
    }
    if ui.add_enabled(command.is_some(), button).clicked() {
        commands.extend(command);
        ui.close();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::commands::RunCommand;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    #[test]
    fn a_menu_entry_sends_its_command() {
        let mut harness = Harness::new_ui_state(
            |ui, commands| {
                let recent = RecentFiles::default();
                menu(ui, Situation::default(), &|_| None, &recent, "climb, seed 1", commands);
            },
            Vec::new(),
        );
        harness.get_by_label("Run").click();
        harness.run();
        harness.get_by_label_contains("Evolve one generation").click();
        harness.run();
        assert_eq!(*harness.state(), [Command::Run(RunCommand::SingleGeneration)]);
        harness.get_by_label("Edit").click();
        harness.run();
        harness.get_by_label_contains("Undo").click();
        harness.run();
        assert_eq!(harness.state().len(), 1, "there is nothing to undo");
    }

    #[test]
    fn the_file_menu_asks_for_files_and_lists_those_opened_lately() {
        let texts = ["/saves/mine.ron", "/runs/climb-seed1-be07eab1/run.ron"];
        let recent = RecentFiles::from_texts(&texts.map(str::to_owned));
        let mut harness = Harness::new_ui_state(
            |ui, commands| menu(ui, Situation::default(), &|_| None, &recent, "", commands),
            Vec::new(),
        );
        for (entry, command) in [
            ("Import…", FileCommand::Ask(FileQuestion::Import)),
            ("Export…", FileCommand::AskExport),
            ("Show saves folder", FileCommand::ShowSaves),
        ] {
            harness.get_by_label("File").click();
            harness.run();
            harness.get_by_label_contains(entry).click();
            harness.run();
            assert_eq!(harness.state().last(), Some(&Command::File(command)), "{entry}");
        }
        for (name, path) in ["mine", "climb-seed1-be07eab1"].into_iter().zip(texts) {
            harness.get_by_label("File").click();
            harness.run();
            harness.get_by_label_contains("Open recent").click();
            harness.run();
            harness.get_by_label(name).click();
            harness.run();
            let expected = FileCommand::Answer(FileQuestion::Open, vec![path.into()]);
            assert_eq!(harness.state().last(), Some(&Command::File(expected)));
        }
    }
}
