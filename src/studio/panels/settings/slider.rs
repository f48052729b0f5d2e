//! Sliders of settings. If a slider changes the world, its value takes effect during the drag; otherwise when the
//! slider rests or is released.

use bevy_egui::egui;

use super::changing::Changing;
use super::form::Sheet;
use super::number::Control;
use super::scale::Scale;
use super::values::rounded;

impl Sheet {
    /// Draws a slider with marks. Returns the setting's text when its value takes effect.
    pub(super) fn slider(
        &mut self,
        ui: &mut egui::Ui,
        control: &Control,
        scale: &Scale,
        is_whole: bool,
    ) -> Option<String> {
        let value: f32 = control.value.parse().unwrap_or_default();
        let held = self.changing.as_ref().filter(|changing| changing.id == control.id);
        let mut so_far = held.map_or(value, |changing| changing.so_far);
        let before = so_far;
        let mut slider = scale.slider(&mut so_far);
        if is_whole {
            slider = slider.step_by(1.0);
        }
        let response = ui.add(slider).labelled_by(control.name).on_hover_text(control.hint);
        scale.paint(ui, response.rect);
        if let Some(said) = &control.said {
            let (is_on, value) = (ui.is_enabled(), f64::from(so_far));
            response.widget_info(|| egui::WidgetInfo::slider(is_on, value, said));
        }
        let now_s = ui.input(|input| input.time);
        if response.changed() {
            let is_dragged = response.dragged() || response.clicked();
            so_far = scale.settled(so_far, before, is_dragged);
            // In the part of the rail that represents zero, the pointer can move while the value does not.
            if so_far != before {
                let earlier = self.changing.take().filter(|changing| changing.id == control.id);
                self.changing = Some(Changing::moved(control.id, so_far, now_s, earlier));
            }
        }
        let changing = self.changing.as_mut().filter(|changing| changing.id == control.id)?;
        // A slider that is moved by the arrow keys has the focus and is never released.
        let is_held = response.dragged() || response.has_focus();
        if is_held && !changing.takes_effect(now_s) {
            return None;
        }
        let was_effective = changing.take_effect(now_s);
        if !is_held {
            self.changing = None;
        }
        let text = rounded(so_far);
        if was_effective || text == rounded(value) {
            return None;
        }
        match (control.check)(&text) {
            Ok(text) => {
                self.typed.remove(control.id);
                Some(text)
            }
            Err(problem) => {
                self.keep(control.id, text, Some(problem), control.value);
                None
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::commands::{Command, PlanCommand};
    use crate::studio::state::current_run::{CurrentRun, prepared_run};
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    /// Drags a setting's slider for this number of frames, each a sixtieth of a second. The first `moving` frames move
    /// it. Returns the values that took effect while the slider was held, and those after it was released.
    fn dragged(field: &'static str, label: &str, moving: usize, frames: usize) -> [Vec<f32>; 2] {
        type State = (CurrentRun, Vec<f32>);
        let mut sheet = Sheet::default();
        let ui = move |ui: &mut egui::Ui, (run, taken): &mut State| {
            sheet.begin(ui, run);
            let listed = sheet.values.listed.iter().find(|listed| listed.path == field);
            let listed = listed.expect("a setting").clone();
            sheet.entry(ui, &listed);
            for command in std::mem::take(&mut sheet.sent) {
                let Command::Plan(PlanCommand::SetField { field, text }) = command else {
                    panic!("{command:?}")
                };
                run.set_field(&field, &text).expect("allowed");
                taken.push(text.parse().expect("a number"));
            }
        };
        let builder = Harness::builder().with_size(egui::vec2(400.0, 200.0));
        let mut harness =
            builder.with_step_dt(1.0 / 60.0).build_ui_state(ui, (prepared_run(), Vec::new()));
        let rail = harness.get_by_role_and_label(egui::accesskit::Role::Slider, label).rect();
        let at = |share: f32| rail.lerp_inside(egui::vec2(share, 0.5));
        harness.drag_at(at(0.2));
        harness.run_steps(1);
        for frame in 0..frames {
            let share = 0.2 + 0.6 * (frame.min(moving) as f32 / moving as f32);
            harness.hover_at(at(share));
            harness.run_steps(1);
        }
        let held = std::mem::take(&mut harness.state_mut().1);
        harness.drop_at(at(0.8));
        harness.run_steps(4);
        [held, harness.state().1.clone()]
    }

    #[test]
    fn a_setting_of_the_world_follows_its_slider_and_others_wait_until_it_rests_or_is_released() {
        let bounce = ("trial.surface.bounce", "Bounce");
        let step = ("evolution.cma_es.step", "Size of first mutations");
        for ((field, label), moving, frames, while_held, on_release) in [
            // About three times in a second.
            (bounce, 60, 60, 3..=4, 1),
            (bounce, 6, 20, 1..=1, 0),
            (step, 60, 60, 0..=0, 1),
            (step, 6, 40, 1..=1, 0),
        ] {
            let [held, released] = dragged(field, label, moving, frames);
            assert!(while_held.contains(&held.len()), "{field}, {moving}: {held:?}");
            assert_eq!(released.len(), on_release, "{field}, {moving}: {released:?}");
            assert!(held.iter().chain(&released).is_sorted_by(|a, b| a < b), "it follows");
        }
    }
}
