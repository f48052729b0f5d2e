//! The part of the window that panels leave for the stage.

use bevy::prelude::*;
use bevy_egui::egui;

use super::text_prompt;

/// The part of the window that panels leave for the stage.
#[derive(Resource)]
pub(crate) struct StageArea {
    /// Rectangle of the stage, in egui points.
    rect: egui::Rect,
    /// Card over the stage, as fractions of its width and height from the upper left corner.
    card: Option<Rect>,
    /// The egui context, which knows the layers over the stage.
    context: egui::Context,
}

impl Default for StageArea {
    fn default() -> Self {
        Self { rect: egui::Rect::ZERO, card: None, context: egui::Context::default() }
    }
}

impl StageArea {
    /// Sets the stage's rectangle, and the rectangle of a card over it that must cover no snake, in points.
    pub fn set(&mut self, context: &egui::Context, rect: egui::Rect, card: Option<egui::Rect>) {
        self.rect = rect;
        self.card = card.map(|card| {
            let size = rect.size().max(egui::Vec2::splat(1.0));
            let share = |at: egui::Pos2| {
                let from_corner = (at - rect.min) / size;
                Vec2::new(from_corner.x, from_corner.y)
            };
            Rect::from_corners(share(card.min), share(card.max))
        });
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

    /// Card over the stage, as fractions of its width and height from the upper left corner.
    pub fn card(&self) -> Option<Rect> {
        self.card
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
        area.set(&context, egui::Rect::EVERYTHING, None);
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

    #[test]
    fn the_card_is_known_as_a_share_of_the_stage() {
        let mut area = StageArea::default();
        let stage = egui::Rect::from_min_size(egui::pos2(300.0, 40.0), egui::vec2(800.0, 400.0));
        let card = egui::Rect::from_min_size(egui::pos2(300.0, 240.0), egui::vec2(200.0, 200.0));
        area.set(&egui::Context::default(), stage, Some(card));
        assert_eq!(area.card(), Some(Rect::new(0.0, 0.5, 0.25, 1.0)));
    }
}
