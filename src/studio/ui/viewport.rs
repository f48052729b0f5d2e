//! The part of the window that panels leave for the stage.

use bevy::prelude::*;
use bevy_egui::egui;

use super::text_prompt;

/// The part of the window that panels leave for the stage.
#[derive(Resource)]
pub(crate) struct StageArea {
    /// Rectangle of the stage in the window, in egui points.
    pub rect: egui::Rect,
    /// Rectangles of the cards over the stage, in egui points.
    cards: Vec<egui::Rect>,
    /// Rectangle of the messages over the stage, in egui points; `None` without messages.
    pub(super) messages: Option<egui::Rect>,
    /// Area in whose lower right corner messages are drawn, in egui points.
    pub(super) messages_room: egui::Rect,
    /// egui context, which knows the layers over the stage.
    context: egui::Context,
}

impl Default for StageArea {
    fn default() -> Self {
        Self {
            rect: egui::Rect::ZERO,
            cards: Vec::new(),
            messages: None,
            messages_room: egui::Rect::ZERO,
            context: egui::Context::default(),
        }
    }
}

impl StageArea {
    /// Sets the stage's rectangle, the rectangles of the cards that must not cover a snake, and the area for messages,
    /// all in points.
    pub fn set(
        &mut self,
        context: &egui::Context,
        rect: egui::Rect,
        cards: Vec<egui::Rect>,
        messages_room: egui::Rect,
    ) {
        (self.rect, self.cards, self.messages_room) = (rect, cards, messages_room);
        // Cloning a context only clones a handle.
        self.context = context.clone();
    }

    /// Returns the rectangle of the stage in the window, in logical pixels.
    pub fn in_window(&self) -> Rect {
        let (min, max, scale) = (self.rect.min, self.rect.max, self.context.zoom_factor());
        Rect::new(min.x * scale, min.y * scale, max.x * scale, max.y * scale)
    }

    /// Converts a window position from logical pixels to egui points.
    pub fn point_of(&self, pixel: Vec2) -> egui::Pos2 {
        let point = pixel / self.context.zoom_factor();
        egui::pos2(point.x, point.y)
    }

    /// Returns whether a pointer action at this window position, in logical pixels, belongs to the stage: no card, menu
    /// or floating panel covers it, and no drag in a panel is in progress.
    pub fn has_pointer_at(&self, pixel: Vec2) -> bool {
        let at = self.point_of(pixel);
        let layer = || self.context.layer_id_at(at);
        self.rect.contains(at)
            && layer().is_none_or(|layer| layer.order == egui::Order::Background)
            && !self.context.egui_is_using_pointer()
    }

    /// Returns whether typed letters go into a text field: a field has the focus, or a text prompt is open.
    pub fn takes_letters(&self) -> bool {
        self.context.text_edit_focused() || text_prompt::is_open(&self.context)
    }

    /// Returns the size of the messages in the last frame, in egui points; zero without messages.
    pub fn messages_size(&self) -> egui::Vec2 {
        self.messages.map_or(egui::Vec2::ZERO, |messages| messages.size())
    }

    /// Returns the rectangles of cards and messages, as fractions of the stage's width and height from its upper left corner.
    pub fn covers(&self) -> impl Iterator<Item = Rect> {
        let size = self.rect.size().max(egui::Vec2::splat(1.0));
        let share = move |at: egui::Pos2| {
            let from_corner = (at - self.rect.min) / size;
            Vec2::new(from_corner.x, from_corner.y)
        };
        let covers = self.cards.iter().chain(&self.messages);
        let over_stage = covers.filter(|cover| cover.intersects(self.rect));
        over_stage.map(move |cover| Rect::from_corners(share(cover.min), share(cover.max)))
    }

    /// Returns the stage's ratio of width to height, or 1 if it is empty.
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
        area.set(&context, egui::Rect::EVERYTHING, Vec::new(), egui::Rect::ZERO);
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
    fn card_and_messages_are_known_as_shares_of_the_stage() {
        let mut area = StageArea::default();
        let stage = egui::Rect::from_min_size(egui::pos2(300.0, 40.0), egui::vec2(800.0, 400.0));
        let card = egui::Rect::from_min_size(egui::pos2(300.0, 240.0), egui::vec2(200.0, 200.0));
        area.set(&egui::Context::default(), stage, vec![card], stage);
        let corner = area.messages_room.max;
        area.messages = Some(egui::Rect::from_min_max(egui::pos2(900.0, 340.0), corner));
        assert_eq!(area.messages_size(), egui::vec2(200.0, 100.0));
        let covers: Vec<Rect> = area.covers().collect();
        assert_eq!(covers, [Rect::new(0.0, 0.5, 0.25, 1.0), Rect::new(0.75, 0.75, 1.0, 1.0)]);
        let above = egui::Rect::from_min_size(egui::Pos2::ZERO, egui::vec2(900.0, 30.0));
        area.messages = Some(above);
        assert_eq!(area.covers().count(), 1, "beside the stage");
    }
}
