//! Over the stage: how it is looked at, and what is drawn over it.

use bevy_egui::egui;
use bevy_egui::egui::containers::menu::{MenuButton, MenuConfig};

use crate::studio::command::Command;
use crate::studio::look::Theme;
use crate::studio::overlay::{Overlay, Overlays};
use crate::studio::screenshot::Photograph;
use crate::studio::view::Shot;

/// Draws the bar and adds what was asked for.
pub(super) fn view_bar(
    ui: &mut egui::Ui,
    shot: Shot,
    overlays: &Overlays,
    has_smooth_edges: bool,
    theme: Theme,
    asked: &mut Vec<Command>,
) {
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        for choice in Shot::ALL {
            let hint = match choice {
                Shot::Follow => "Go along with the snake, or with all of them (F, Home)",
                Shot::Side => "From the side, going along (C for the next camera)",
                Shot::Top => "From above, going along (C for the next camera)",
                Shot::Free => "Stay where you are put (F); double click to look at a place",
            };
            if ui.selectable_label(shot == choice, choice.name()).on_hover_text(hint).clicked() {
                asked.push(Command::Look(choice));
            }
        }
        ui.separator();
        let stays = MenuConfig::new().close_behavior(egui::PopupCloseBehavior::CloseOnClickOutside);
        MenuButton::new("Show").config(stays).ui(ui, |ui| {
            for overlay in Overlay::ALL {
                let (name, hint) = overlay.words();
                let mut is_shown = overlays.shows(overlay);
                if ui.checkbox(&mut is_shown, name).on_hover_text(hint).changed() {
                    asked.push(Command::Toggle(overlay));
                }
            }
            ui.separator();
            let mut is_smooth = has_smooth_edges;
            let hint = "Four samples for each pixel; slow where the processor draws (A)";
            if ui.checkbox(&mut is_smooth, "Smooth edges").on_hover_text(hint).changed() {
                asked.push(Command::ToggleSmoothEdges);
            }
        });
        let (name, hint) = match theme {
            Theme::Light => ("Dark", "The dark theme (T)"),
            Theme::Dark => ("Light", "The light theme (T)"),
        };
        if ui.button(name).on_hover_text(hint).clicked() {
            asked.push(Command::ToggleTheme);
        }
        let hint = "Save a picture of the stage (P); of the window with Shift P";
        if ui.button("Picture").on_hover_text(hint).clicked() {
            asked.push(Command::TakePicture(Photograph::Stage));
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    #[test]
    fn its_buttons_send_their_commands() {
        for (label, command) in [
            ("Side", Command::Look(Shot::Side)),
            ("Dark", Command::ToggleTheme),
            ("Picture", Command::TakePicture(Photograph::Stage)),
        ] {
            let overlays = Overlays::default();
            let mut harness = Harness::new_ui_state(
                |ui, asked| view_bar(ui, Shot::Follow, &overlays, false, Theme::Light, asked),
                Vec::new(),
            );
            harness.get_by_label(label).click();
            harness.run();
            assert_eq!(*harness.state(), [command], "{label}");
        }
    }
}
