//! The part of the window that panels leave for the stage.

use bevy::prelude::*;
use bevy_egui::egui;

use super::text_prompt;

/// The part of the window that panels leave for the stage.
#[derive(Resource)]
pub(crate) struct StageArea {
    /// Rectangle of the stage, in egui points.
    rect: egui::Rect,
    /// Width of the card at the lower left corner, as a fraction of the stage's width.
    card_share: f32,
    /// The egui context, which knows the layers over the stage.
    context: egui::Context,
}

impl Default for StageArea {
    fn default() -> Self {
        Self { rect: egui::Rect::ZERO, card_share: 0.0, context: egui::Context::default() }
    }
}

impl StageArea {
    /// Sets the stage's rectangle and the width of the card at its lower left corner, in points.
    pub fn set(&mut self, context: &egui::Context, rect: egui::Rect, card_width: f32) {
        self.rect = rect;
        self.card_share = card_width / rect.width().max(1.0);
        // Cloning a context only clones a handle.
        self.context = context.clone();
    }

    /// Rectangle of the stage, in egui points.
    pub fn rect(&self) -> egui::Rect {
        self.rect
    }

    /// Rectangle of the stage in the window, in logical pixels.
    pub fn in_window(&self) -> Rect {
        let (min, max, scale) = (self.rect.min, self.rect.max, self.context.zoom_factor());
        Rect::new(min.x * scale, min.y * scale, max.x * scale, max.y * scale)
    }

    /// Converts a window position from logical pixels to egui points.
    pub fn point_of(&self, pixel: Vec2) -> egui::Pos2 {
        let point = pixel / self.context.zoom_factor();
        egui::pos2(point.x, point.y)
    }

    /// Whether a pointer action at this window position, in logical pixels, belongs to the stage: no card, menu or
    /// floating panel covers it, and no drag in a panel is in progress.
    pub fn has_pointer_at(&self, pixel: Vec2) -> bool {
        let at = self.point_of(pixel);
        let layer = || self.context.layer_id_at(at);
        self.rect.contains(at)
            && layer().is_none_or(|layer| layer.order == egui::Order::Background)
            && !self.context.egui_is_using_pointer()
    }

    /// Whether letters are typed into a text field: one has the focus, or a dialog waits for a text.
    pub fn takes_letters(&self) -> bool {
        self.context.text_edit_focused() || text_prompt::is_open(&self.context)
    }

    /// Width of the card at the lower left corner, as a fraction of the stage's width.
    pub fn card_share(&self) -> f32 {
        self.card_share
    }

    /// Ratio of width to height.
    pub fn aspect(&self) -> f32 {
        let size = self.rect.size();
        if size.x > 0.0 && size.y > 0.0 { size.x / size.y } else { 1.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use text_prompt::TextPrompt;

    #[test]
    fn letters_belong_to_an_open_prompt_even_if_no_widget_has_the_focus() {
        let context = egui::Context::default();
        let mut area = StageArea::default();
        area.set(&context, egui::Rect::EVERYTHING, 0.0);
        let mut prompt = TextPrompt::new("my-ice".to_owned());
        let mut pass = |is_open: bool| {
            let _ = context.run_ui(egui::RawInput::default(), |ui| {
                if is_open {
                    prompt.ui(ui, |ui, field| ui.add(field));
                }
            });
        };
        assert!(!area.takes_letters());
        pass(true);
        context.memory_mut(|memory| memory.stop_text_input());
        assert!(area.takes_letters(), "a click beside the field took its focus");
        pass(false);
        pass(false);
        assert!(!area.takes_letters(), "the dialog is closed");
    }
}
