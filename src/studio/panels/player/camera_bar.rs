//! Bar above the stage: camera modes, overlays, theme and screenshots.

use bevy_egui::egui;
use bevy_egui::egui::containers::menu::{MenuButton, MenuConfig};

use super::stage_card::CardStates;
use crate::studio::commands::actions::{Situation, actions};
use crate::studio::commands::camera_mode::CameraMode;
use crate::studio::commands::{Command, ScreenshotArea, ViewCommand, WindowCommand};
use crate::studio::panels::help::menu::IsOn;
use crate::studio::scene::quality::StageQuality;
use crate::studio::ui::buttons::{CommandButton, command_box};

/// Draws the camera bar, and sends the user's commands. A bar that `is_narrow` lacks what the View menu has, too.
pub(crate) fn view_bar(
    ui: &mut egui::Ui,
    camera_mode: CameraMode,
    is_narrow: bool,
    is_on: IsOn<'_>,
    quality: &StageQuality,
    cards: &mut CardStates,
) {
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        for choice in CameraMode::ALL {
            let button = egui::Button::selectable(camera_mode == choice, choice.name());
            let set = Command::View(ViewCommand::SetCamera(choice));
            CommandButton::of(button, choice.hint(), set).show(ui);
        }
        ui.separator();
        let stays = MenuConfig::new().close_behavior(egui::PopupCloseBehavior::CloseOnClickOutside);
        MenuButton::new("Show").config(stays).ui(ui, |ui| {
            for action in actions().iter().filter(|action| action.shows_on_stage()) {
                let Some(command) = action.command(Situation::default()) else { continue };
                let is_shown = is_on(&command).unwrap_or(false);
                command_box(ui, is_shown, (action.name, action.hint), command);
            }
            let closed = egui::Button::new("Show closed cards again");
            let closed = ui.add_enabled(!cards.closed.is_empty(), closed);
            if closed.on_disabled_hover_text("No card over the stage is closed").clicked() {
                cards.closed.clear();
            }
            ui.separator();
            quality_choice(ui, quality);
        });
        let theme = Command::View(ViewCommand::ToggleTheme);
        let (name, hint) = match is_on(&theme) {
            Some(true) => ("Light", "Switch to the light theme"),
            _ => ("Dark", "Switch to the dark theme"),
        };
        CommandButton::new(name, hint, theme).show(ui);
        let larger = Command::Window(WindowCommand::ToggleLarger);
        let is_larger = is_on(&larger).unwrap_or(false);
        if !is_narrow {
            let button = egui::Button::new("Larger").selected(is_larger);
            let hint = "All texts a quarter larger, for a projector, or back to the usual size";
            CommandButton::of(button, hint, larger).show(ui);
        }
        let hint = "Save a picture of the stage (P) or of the whole window (Shift P)";
        if ui.button("Picture").on_hover_text(hint).clicked() {
            Command::View(ViewCommand::TakePicture(ScreenshotArea::Stage)).send(ui);
        }
    });
}

/// Draws the choice of the picture's quality.
fn quality_choice(ui: &mut egui::Ui, quality: &StageQuality) {
    ui.label("Picture quality (A: next)");
    let automatic = (None, "automatic", "Suits the device and the time that a frame takes");
    let steps = quality.offered().iter().map(|step| (Some(*step), step.name(), step.hint()));
    for (choice, name, hint) in std::iter::once(automatic).chain(steps) {
        let name = match choice {
            None if quality.chosen.is_none() => format!("{name}: {}", quality.now().name()),
            _ => name.to_owned(),
        };
        if ui.radio(quality.chosen == choice, name).on_hover_text(hint).clicked() {
            Command::View(ViewCommand::SetQuality(choice)).send(ui);
        }
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::studio::panels::testing::{Sent, clicked, panel};
    use egui_kittest::kittest::{NodeT, Queryable};

    /// Draws the bar with everything switched off.
    pub(in crate::studio::panels) fn switched_off_bar() -> Sent<'static> {
        let mut cards = CardStates::default();
        let quality = StageQuality::default();
        panel([900.0, 600.0], move |ui| {
            view_bar(ui, CameraMode::Follow, false, &|_| None, &quality, &mut cards);
        })
    }

    #[test]
    fn each_button_sends_its_command() {
        for (label, command) in [
            ("Side", Command::View(ViewCommand::SetCamera(CameraMode::Side))),
            ("Dark", Command::View(ViewCommand::ToggleTheme)),
            ("Larger", Command::Window(WindowCommand::ToggleLarger)),
            ("Picture", Command::View(ViewCommand::TakePicture(ScreenshotArea::Stage))),
        ] {
            assert_eq!(clicked(&mut switched_off_bar(), label), [command], "{label}");
        }
    }

    #[test]
    fn the_show_menu_switches_what_the_view_menu_does_and_brings_closed_cards_back() {
        let mut bar = switched_off_bar();
        clicked(&mut bar, "Show");
        for action in actions().iter().filter(|action| action.shows_on_stage()) {
            assert!(!action.hint.is_empty(), "{}", action.name);
            let sent = clicked(&mut bar, action.name);
            assert_eq!(sent.last().cloned(), action.command(Situation::default()));
        }
        assert!(bar.get_by_label("Show closed cards again").accesskit_node().is_disabled());
    }
}
