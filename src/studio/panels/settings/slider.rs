//! Sliders of settings. A slider takes effect while it is dragged, if it changes the world, and else when it rests or is
//! released.

use bevy_egui::egui;

use super::form::Sheet;
use super::number::Control;
use super::scale::Scale;
use super::values::rounded;

/// Time without movement after which a slider takes effect, in seconds.
const REST_S: f64 = 0.35;
/// The same for a setting of the world, whose effect is seen on the stage.
const SETTLED_S: f64 = 0.12;
/// Time after which a setting of the world takes effect even while its slider moves, in seconds: long enough to see
/// the snake react.
const MOVING_S: f64 = 0.3;

/// A slider being dragged.
#[derive(Debug)]
pub(super) struct Changing {
    /// Id of the control.
    pub id: String,
    /// Current value.
    pub so_far: f32,
    /// Time of the last change, in seconds.
    moved_s: f64,
    /// Time at which it last took effect or, if it has not, of its first change, in seconds.
    effective_s: f64,
    /// Whether the current value has taken effect.
    is_effective: bool,
}

impl Changing {
    /// Whether the current value takes effect now although the slider is still held.
    fn takes_effect(&self, now_s: f64) -> bool {
        let is_of_world = self.id.starts_with("trial.");
        let is_settled = now_s - self.moved_s > if is_of_world { SETTLED_S } else { REST_S };
        let is_due = is_of_world && now_s - self.effective_s > MOVING_S;
        !self.is_effective && (is_settled || is_due)
    }
}

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
                let earlier = self.changing.take().filter(|changing| changing.id == control.id);
                self.changing = Some(Changing {
                    id: control.id.to_owned(),
                    so_far,
                    moved_s: now_s,
                    effective_s: earlier.map_or(now_s, |changing| changing.effective_s),
                    is_effective: false,
                });
            }
        }
        let changing = self.changing.as_mut().filter(|changing| changing.id == control.id)?;
        // With the arrow keys it has the focus and is never released.
        let is_held = response.dragged() || response.has_focus();
        if is_held && !changing.takes_effect(now_s) {
            return None;
        }
        (changing.effective_s, changing.is_effective) = (now_s, true);
        if !is_held {
            self.changing = None;
        }
        let text = rounded(so_far);
        if text == rounded(value) {
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
