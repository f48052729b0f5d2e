//! The menu bar: every action by name, with its key.

use bevy_egui::egui;
use bevy_egui::egui::containers::menu::MenuBar;

use crate::studio::actions::{ACTIONS, Action, Menu, Situation};
use crate::studio::command::Command;
use crate::studio::look;

/// Draws the menus and adds what was asked for. `about` stands at the right end.
pub(super) fn menu(ui: &mut egui::Ui, situation: Situation, about: &str, asked: &mut Vec<Command>) {
    MenuBar::new().ui(ui, |ui| {
        let name = egui::RichText::new("Snakes & Stairs").strong().color(look::of(ui).accent);
        ui.label(name);
        ui.add_space(look::GAP / 2.0);
        for menu in Menu::ALL {
            ui.menu_button(menu.name(), |ui| {
                ui.set_min_width(look::MENU_WIDTH);
                for action in ACTIONS.iter().filter(|action| action.menu == menu) {
                    entry(ui, action, situation, asked);
                }
            });
        }
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            let text = egui::RichText::new(about).color(look::of(ui).text_weak);
            ui.add(egui::Label::new(text).truncate()).on_hover_text(about);
        });
    });
}

fn entry(ui: &mut egui::Ui, action: &Action, situation: Situation, asked: &mut Vec<Command>) {
    // A digit stands for many: there is nothing to choose here.
    if action.key().contains("...") {
        return;
    }
    let command = (action.asks)(situation);
    let button = egui::Button::new(action.name).shortcut_text(action.key());
    if ui.add_enabled(command.is_some(), button).clicked() {
        asked.extend(command);
        ui.close();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    #[test]
    fn a_menu_lists_its_actions_and_sends_what_is_chosen() {
        let mut harness = Harness::new_ui_state(
            |ui, asked| menu(ui, Situation::default(), "climb, seed 1", asked),
            Vec::new(),
        );
        harness.get_by_label("Run").click();
        harness.run();
        harness.get_by_label_contains("Evolve one generation").click();
        harness.run();
        assert_eq!(*harness.state(), [Command::SingleGeneration]);
        harness.get_by_label("Edit").click();
        harness.run();
        harness.get_by_label_contains("Undo").click();
        harness.run();
        assert_eq!(harness.state().len(), 1, "there is nothing to take back");
    }
}
