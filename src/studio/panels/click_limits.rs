//! Time limits of clicks.

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

#[cfg(test)]
mod tests {
    use super::*;

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
