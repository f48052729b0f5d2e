//! Sliders of settings. A slider takes effect when it is released or rests.

use bevy_egui::egui;

use super::form::{Changing, Sheet};
use super::number::Control;
use super::scale::Scale;
use super::values::rounded;

/// Time without movement after which a slider takes effect, in seconds.
const REST_S: f64 = 0.35;

impl Sheet {
    /// A slider with marks. Returns the setting's text on release or rest.
    pub(super) fn slider(
        &mut self,
        ui: &mut egui::Ui,
        control: &Control,
        scale: &Scale,
        is_whole: bool,
    ) -> Option<String> {
        let value: f32 = control.value.parse().unwrap_or_default();
        let mut so_far = match &self.changing {
            Some(changing) if changing.id == control.id => changing.so_far,
            _ => value,
        };
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
            // Within the part of the rail that stands for zero, the pointer moves and the value rests.
            if so_far != before {
                let id = control.id.to_owned();
                self.changing = Some(Changing { id, so_far, since_s: now_s });
            }
        }
        let since_s = match &self.changing {
            Some(changing) if changing.id == control.id => changing.since_s,
            _ => return None,
        };
        // With the arrow keys it has the focus and is never released.
        let is_held = response.dragged() || response.has_focus();
        let rests = is_held && now_s - since_s > REST_S;
        if !is_held {
            self.changing = None;
        }
        let text = rounded(so_far);
        if (is_held && !rests) || text == rounded(value) {
            return None;
        }
        if rests {
            // Only once, until it is moved again.
            let id = control.id.to_owned();
            self.changing = Some(Changing { id, so_far, since_s: f64::INFINITY });
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
