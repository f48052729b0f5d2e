//! Bar above the stage: camera modes, overlays, theme and screenshots.

use bevy_egui::egui;
use bevy_egui::egui::containers::menu::{MenuButton, MenuConfig};

use crate::studio::commands::camera_mode::CameraMode;
use crate::studio::commands::overlay::Overlay;
use crate::studio::commands::quality::Quality;
use crate::studio::commands::screenshot_area::ScreenshotArea;
use crate::studio::commands::{Command, ViewCommand, WindowCommand};
use crate::studio::scene::overlays::Overlays;
use crate::studio::scene::quality::StageQuality;
use crate::studio::ui::buttons::{CommandButton, command_box};
use crate::studio::ui::theme::Theme;

/// Draws the camera bar, and collects the user's commands.
pub(crate) fn view_bar(
    ui: &mut egui::Ui,
    camera_mode: CameraMode,
    overlays: &Overlays,
    quality: &StageQuality,
    shows_torques: bool,
    theme: Theme,
    commands: &mut Vec<Command>,
) {
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        for choice in CameraMode::ALL {
            let hint = match choice {
                CameraMode::Follow => "Follow the snake, or all of them in a race (F, Home)",
                CameraMode::Side => "Follow from the side (C: next camera)",
                CameraMode::Top => "Follow from above (C: next camera)",
                CameraMode::Free => {
                    "Keep the camera where it is (F). Double-click a place to centre it"
                }
            };
            let button = ui.selectable_label(camera_mode == choice, choice.name());
            if button.on_hover_text(hint).clicked() {
                commands.push(Command::View(ViewCommand::SetCamera(choice)));
            }
        }
        ui.separator();
        let stays = MenuConfig::new().close_behavior(egui::PopupCloseBehavior::CloseOnClickOutside);
        MenuButton::new("Show").config(stays).ui(ui, |ui| {
            for overlay in Overlay::ALL {
                let (is_shown, words) = (overlays.shows(overlay), (overlay.name(), overlay.hint()));
                let toggle = Command::View(ViewCommand::ToggleOverlay(overlay));
                command_box(ui, is_shown, words, toggle, commands);
            }
            ui.separator();
            let hint = "Torques of each joint over the whole trial, below the player";
            let (words, toggle) = (("Torques over time", hint), WindowCommand::ToggleTorques);
            command_box(ui, shows_torques, words, Command::Window(toggle), commands);
            ui.separator();
            quality_choice(ui, quality, commands);
        });
        let (name, hint) = match theme {
            Theme::Light => ("Dark", "Switch to the dark theme"),
            Theme::Dark => ("Light", "Switch to the light theme"),
        };
        let toggle = Command::View(ViewCommand::ToggleTheme);
        CommandButton::new(name, hint, toggle).show(ui, commands);
        let hint = "Save a picture of the stage (P) or of the whole window (Shift P)";
        if ui.button("Picture").on_hover_text(hint).clicked() {
            commands.push(Command::View(ViewCommand::TakePicture(ScreenshotArea::Stage)));
        }
    });
}

/// Draws the choice of the picture's quality.
fn quality_choice(ui: &mut egui::Ui, quality: &StageQuality, commands: &mut Vec<Command>) {
    ui.label("Picture quality (A: next)");
    let automatic = (None, "automatic", "Suits the device and the time that a frame takes");
    let steps = Quality::ALL.map(|step| (Some(step), step.name(), step.hint()));
    for (choice, name, hint) in std::iter::once(automatic).chain(steps) {
        let name = match choice {
            None if quality.chosen.is_none() => format!("{name}: {}", quality.now().name()),
            _ => name.to_owned(),
        };
        if ui.radio(quality.chosen == choice, name).on_hover_text(hint).clicked() {
            commands.push(Command::View(ViewCommand::SetQuality(choice)));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::panels::testing::{clicked, panel};

    #[test]
    fn each_button_sends_its_command() {
        for (label, command) in [
            ("Side", Command::View(ViewCommand::SetCamera(CameraMode::Side))),
            ("Dark", Command::View(ViewCommand::ToggleTheme)),
            ("Picture", Command::View(ViewCommand::TakePicture(ScreenshotArea::Stage))),
        ] {
            let mut bar = panel([800.0, 600.0], |ui, commands| {
                let overlays = Overlays::default();
                view_bar(
                    ui,
                    CameraMode::Follow,
                    &overlays,
                    &StageQuality::default(),
                    false,
                    Theme::Light,
                    commands,
                );
            });
            assert_eq!(clicked(&mut bar, label), [command], "{label}");
        }
    }
}
