//! Time limits of clicks, and the keyboard after a click.

use bevy_egui::egui;

use crate::studio::scene::camera::mouse::DOUBLE_CLICK_S;

/// Sets time limits of clicks that do not depend on the frame rate. egui processes a press and its release only in the next frame.
pub(crate) fn set_click_limits(context: &egui::Context) {
    let frame_s = context.input(|input| input.unstable_dt);
    context.options_mut(|options| {
        options.input_options.max_double_click_delay = f64::from(DOUBLE_CLICK_S + frame_s);
        // A press without movement is a click whatever its duration, as in native toolkits.
        options.input_options.max_click_duration = f64::INFINITY;
    });
}

/// Takes the keyboard from a button or list when the mouse is pressed, unless text is being typed. Space would otherwise
/// press the button again instead of pausing the stage.
pub(crate) fn leave_keyboard_to_stage(context: &egui::Context) {
    if context.input(|input| input.pointer.any_pressed()) && !context.text_edit_focused() {
        context.memory_mut(|memory| {
            memory.focused().into_iter().for_each(|focused| memory.surrender_focus(focused));
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::panels::testing::{clicked, panel, press};
    use crate::studio::ui::buttons::CommandButton;

    #[test]
    fn a13_space_does_not_press_a_button_again_that_was_clicked_after_it_had_the_keyboard() {
        use crate::studio::commands::Command;
        let mut panel = panel([300.0, 100.0], |ui| {
            leave_keyboard_to_stage(ui.ctx());
            CommandButton::new("Undo", "", Command::Undo).show(ui);
        });
        press(&mut panel, egui::Key::Tab);
        press(&mut panel, egui::Key::Space);
        assert_eq!(*panel.state(), [Command::Undo], "the keyboard presses it");
        clicked(&mut panel, "Undo");
        press(&mut panel, egui::Key::Space);
        assert_eq!(*panel.state(), [Command::Undo, Command::Undo]);
    }

    #[test]
    fn a_click_that_spans_a_slow_frame_still_counts() {
        let context = egui::Context::default();
        let button = |is_down| egui::Event::PointerButton {
            pos: egui::pos2(20.0, 20.0),
            button: egui::PointerButton::Primary,
            pressed: is_down,
            modifiers: egui::Modifiers::default(),
        };
        let moved = egui::Event::PointerMoved(egui::pos2(20.0, 20.0));
        let frames = [vec![], vec![moved], vec![button(true)], vec![button(false)]];
        let clicks = frames.into_iter().enumerate().filter(|(second, events)| {
            let input = egui::RawInput {
                time: Some(*second as f64 * 3.0),
                events: events.clone(),
                ..egui::RawInput::default()
            };
            let mut is_clicked = false;
            let _ = context.run_ui(input, |ui| {
                set_click_limits(ui.ctx());
                is_clicked = ui.button("A button of some size").clicked();
            });
            is_clicked
        });
        assert_eq!(clicks.count(), 1);
    }
}
