//! Menu bar: every action by name, with its shortcut.

use bevy_egui::egui;
use bevy_egui::egui::containers::menu::MenuBar;

use crate::studio::commands::Command;
use crate::studio::commands::actions::{ACTIONS, Action, Menu, Situation};
use crate::studio::ui::theme;

/// Draws the menus and collects the user's commands. `is_on` says whether the setting that a command toggles is on.
/// `about` is shown at the right end.
pub(crate) fn menu(
    ui: &mut egui::Ui,
    situation: Situation,
    is_on: &dyn Fn(&Command) -> Option<bool>,
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
                }
            });
        }
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            let text = egui::RichText::new(about).color(theme::of(ui).text_weak);
            ui.add(egui::Label::new(text).truncate()).on_hover_text(about);
        });
    });
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
            |ui, commands| menu(ui, Situation::default(), &|_| None, "climb, seed 1", commands),
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
}
