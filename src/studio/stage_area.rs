//! The part of the window that panels leave for the stage.

use bevy::prelude::*;
use bevy_egui::egui;

/// The part of the window that is left for the stage.
#[derive(Resource)]
pub(super) struct StageArea {
    /// Where it is, in the panels' points.
    rect: egui::Rect,
    /// How wide the card at its lower left corner is, as a share of its width.
    card_share: f32,
    /// The panels, which know what lies over the stage.
    context: egui::Context,
}

impl Default for StageArea {
    fn default() -> Self {
        Self { rect: egui::Rect::ZERO, card_share: 0.0, context: egui::Context::default() }
    }
}

impl StageArea {
    /// Takes in where panels leave room, and how wide a card lies in the lower left corner of that, in points.
    pub fn set(&mut self, context: &egui::Context, rect: egui::Rect, card_width: f32) {
        self.rect = rect;
        self.card_share = card_width / rect.width().max(1.0);
        // A context is a handle.
        self.context = context.clone();
    }

    /// Where it is, in the panels' points.
    pub fn rect(&self) -> egui::Rect {
        self.rect
    }

    /// Where it is in the window, in logical pixels.
    pub fn in_window(&self) -> Rect {
        let (min, max, scale) = (self.rect.min, self.rect.max, self.context.zoom_factor());
        Rect::new(min.x * scale, min.y * scale, max.x * scale, max.y * scale)
    }

    /// A point of the window, in logical pixels, in the panels' points.
    pub fn point_of(&self, pixel: Vec2) -> egui::Pos2 {
        let point = pixel / self.context.zoom_factor();
        egui::pos2(point.x, point.y)
    }

    /// Whether what is done at this point of the window, in logical pixels, is done to the stage: it lies within it,
    /// under no card, menu or floating panel, and nothing in a panel is being dragged.
    pub fn has_pointer_at(&self, pixel: Vec2) -> bool {
        let at = self.point_of(pixel);
        let layer = || self.context.layer_id_at(at);
        self.rect.contains(at)
            && layer().is_none_or(|layer| layer.order == egui::Order::Background)
            && !self.context.egui_is_using_pointer()
    }

    /// Whether something is being typed in a panel.
    pub fn has_text_cursor(&self) -> bool {
        self.context.text_edit_focused()
    }

    /// How wide the card at its lower left corner is, as a share of its width.
    pub fn card_share(&self) -> f32 {
        self.card_share
    }

    /// Width over height.
    pub fn aspect(&self) -> f32 {
        let size = self.rect.size();
        if size.x > 0.0 && size.y > 0.0 { size.x / size.y } else { 1.0 }
    }
}
