//! A card over the stage, which can be folded and closed, and is placed beside the snakes.

use std::collections::{BTreeMap, BTreeSet};

use bevy_egui::egui;

use super::card_places::CardRoom;
use crate::studio::ui::accessible::named;
use crate::studio::ui::text_rows::title_text;
use crate::studio::ui::theme;

/// Cards that the user folded or closed since the start of the program.
#[derive(Debug, Default)]
pub(crate) struct CardStates {
    folded: BTreeSet<&'static str>,
    /// Closed cards, each with the occasion for which it was closed. Another occasion brings the card back.
    closed: BTreeMap<&'static str, String>,
}

impl CardStates {
    /// Returns whether any card is closed.
    pub fn has_closed(&self) -> bool {
        !self.closed.is_empty()
    }

    /// Brings all closed cards back.
    pub fn open_all(&mut self) {
        self.closed.clear();
    }
}

/// A card over the stage.
pub(super) struct StageCard {
    /// Name of the card, from which egui's ID is derived.
    pub name: &'static str,
    /// Title in the card's header.
    pub title: String,
    /// Reason for which the card is shown, such as the snakes of a race. A card that was closed stays closed for it.
    pub occasion: String,
    /// Corner of the stage at which the card is placed if it covers no snake there.
    pub corner: egui::Align2,
    /// Minimum width of the contents, in points, until the card was drawn once.
    pub least_width: f32,
}

/// The stage with the cards that were placed so far.
pub(super) struct CardTable<'a> {
    pub context: &'a egui::Context,
    /// Area in which cards can be placed, in points.
    pub room: egui::Rect,
    /// Areas of the cards that were placed so far, in points.
    pub taken: Vec<egui::Rect>,
    /// Areas of all limbs on the stage, in points.
    pub limbs: Vec<egui::Rect>,
    pub states: &'a mut CardStates,
}

impl CardTable<'_> {
    /// Draws a card with a header, and its contents unless it is folded. Returns its area, or `None` if it is closed.
    /// `selected` is the limb that the card must not cover.
    pub fn card(
        &mut self,
        card: &StageCard,
        selected: Option<egui::Rect>,
        content: impl FnOnce(&mut egui::Ui),
    ) -> Option<egui::Rect> {
        if self.states.closed.get(card.name) == Some(&card.occasion) {
            return None;
        }
        self.states.closed.remove(card.name);
        let is_folded = self.states.folded.contains(card.name);
        let (mut folds, mut closes) = (false, false);
        let area = self.place(card, selected, |ui| {
            folds = header(ui, &card.title, is_folded);
            if !is_folded {
                content(ui);
            }
            closes = close_button(ui, &card.title);
        });
        if folds && !self.states.folded.remove(card.name) {
            self.states.folded.insert(card.name);
        }
        if closes {
            self.states.closed.insert(card.name, card.occasion.clone());
        }
        Some(area)
    }

    /// Draws a card without a header. Returns its area.
    pub fn place(
        &mut self,
        card: &StageCard,
        selected: Option<egui::Rect>,
        content: impl FnOnce(&mut egui::Ui),
    ) -> egui::Rect {
        let id = egui::Id::new(card.name);
        let drawn = self.context.memory(|memory| memory.area_rect(id));
        // Before the first frame, the height of the card is unknown.
        let size = drawn.map_or(egui::vec2(card.least_width, 0.0), |rect| rect.size());
        let (room, taken, all) = (self.room, &self.taken, &self.limbs);
        let places = CardRoom { room, taken, selected, all, corner: card.corner };
        let at = places.place(size, drawn);
        let palette = theme::of_context(self.context);
        let shown =
            egui::Area::new(id).fixed_pos(at.min).constrain_to(room).show(self.context, |ui| {
                palette.card(palette.field_hovered).show(ui, content);
            });
        self.taken.push(shown.response.rect);
        shown.response.rect
    }
}

/// Side of the icons in a header, in points.
const SIDE: f32 = theme::GAP * 1.75;

/// Draws the title of a card, which folds the card when it is clicked. Returns whether it was.
fn header(ui: &mut egui::Ui, title: &str, is_folded: bool) -> bool {
    let line = ui.horizontal(|ui| {
        let (icon, _) = ui.allocate_exact_size(egui::Vec2::splat(SIDE), egui::Sense::hover());
        ui.add(egui::Label::new(title_text(title)).selectable(false));
        // Room for the button that closes the card.
        ui.add_space(SIDE + theme::GAP);
        icon
    });
    let place = line.response.rect.with_max_x(line.response.rect.right() - SIDE - theme::GAP);
    let name = if is_folded { format!("Unfold {title}") } else { format!("Fold {title}") };
    let fold = ui.interact(place, ui.id().with("fold"), egui::Sense::click());
    let fold = named(fold, egui::WidgetType::Button, &name);
    let icon = ui.interact(line.inner, ui.id().with("icon"), egui::Sense::hover());
    let openness = if is_folded { 0.0 } else { 1.0 };
    egui::collapsing_header::paint_default_icon(ui, openness, &icon);
    fold.clicked()
}

/// Draws the button at the upper right corner of a card that closes it. Returns whether it was clicked.
fn close_button(ui: &mut egui::Ui, title: &str) -> bool {
    let card = ui.min_rect();
    let size = egui::vec2(SIDE, ui.spacing().interact_size.y);
    let place = egui::Rect::from_min_size(card.right_top() - egui::vec2(SIDE, 0.0), size);
    let sign = egui::RichText::new("×").size(theme::TITLE_SIZE * 1.2);
    let close = ui.put(place, egui::Button::new(sign).frame(false).small());
    let close = named(close, egui::WidgetType::Button, &format!("Close {title}"));
    close.on_hover_text("Close this card; \"Show\" above the stage brings it back").clicked()
}

#[cfg(test)]
mod tests {
    use super::*;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    #[test]
    fn a_card_is_folded_closed_and_comes_back_for_another_occasion_or_on_request() {
        let state = (CardStates::default(), "a and b".to_owned());
        let mut harness = Harness::builder().with_size(egui::vec2(600.0, 400.0)).build_ui_state(
            |ui, (states, occasion): &mut (CardStates, String)| {
                let context = ui.ctx().clone();
                let room = context.content_rect().shrink(12.0);
                let (taken, limbs) = (Vec::new(), Vec::new());
                let mut table = CardTable { context: &context, room, taken, limbs, states };
                let card = StageCard {
                    name: "board",
                    title: "Race".to_owned(),
                    occasion: occasion.clone(),
                    corner: egui::Align2::LEFT_TOP,
                    least_width: 0.0,
                };
                table.card(&card, None, |ui| {
                    ui.label("content");
                });
            },
            state,
        );
        let click = |harness: &mut Harness<'_, _>, label: &str| {
            harness.get_by_label(label).click();
            harness.run();
        };
        harness.run();
        click(&mut harness, "Fold Race");
        assert!(harness.query_by_label("content").is_none());
        click(&mut harness, "Unfold Race");
        harness.get_by_label("content");
        click(&mut harness, "Close Race");
        assert!(harness.query_by_label("Race").is_none() && harness.state().0.has_closed());
        harness.state_mut().1 = "c and d".to_owned();
        harness.run();
        click(&mut harness, "Close Race");
        harness.state_mut().0.open_all();
        harness.run();
        harness.get_by_label("content");
    }
}
