//! A card over the stage, which can be folded and closed, and is placed beside the snakes.

use std::collections::{BTreeMap, BTreeSet};

use bevy_egui::egui;

use super::card_places::CardRoom;
use crate::studio::ui::accessible::named;
use crate::studio::ui::text_rows::title_text;
use crate::studio::ui::theme;

/// Cards that the user folded or closed since the start of the program, and those that have just appeared.
#[derive(Debug, Default)]
pub(crate) struct CardStates {
    folded: BTreeSet<&'static str>,
    /// Cards that are drawn for the first time, whose size is not known yet.
    new: BTreeSet<&'static str>,
    /// Closed cards, each with the occasion for which it was closed. Another occasion brings the card back.
    pub closed: BTreeMap<&'static str, String>,
}

/// Distance from the pointer to a card, in points, within which the card stays in its place.
const REACH: f32 = theme::GAP * 6.0;

/// Returns whether the pointer is near a card and does not drag something else.
fn is_used(context: &egui::Context, card: egui::Rect) -> bool {
    let reach = card.expand(REACH);
    context.input(|input| {
        let pointer = &input.pointer;
        let drags_other = pointer.press_origin().is_some_and(|from| !reach.contains(from));
        pointer.latest_pos().is_some_and(|at| reach.contains(at) && !drags_other)
    })
}

/// A card over the stage.
pub(super) struct StageCard {
    /// Name of the card, from which egui's ID is derived.
    pub name: &'static str,
    /// Title in the card's header.
    pub title: String,
    /// Reason for which the card is shown, such as the snakes of a race. A card that was closed stays closed for it.
    pub occasion: String,
    /// Corner of the stage at which the card is placed.
    pub corner: egui::Align2,
}

/// The stage with the cards that were placed so far.
pub(super) struct CardTable<'a> {
    pub context: &'a egui::Context,
    /// Area in which cards can be placed, in points.
    pub room: egui::Rect,
    /// Areas of the cards that were placed so far, in points.
    pub taken: Vec<egui::Rect>,
    /// Areas of all limbs on the stage and of the gate, in points.
    pub kept_free: Vec<egui::Rect>,
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

    /// Draws a card without a header. Returns its area. A card stays where it appeared, because a person reads it and clicks on it; only a
    /// card over `selected` moves, unless the pointer is near it.
    pub fn place(
        &mut self,
        card: &StageCard,
        selected: Option<egui::Rect>,
        content: impl FnOnce(&mut egui::Ui),
    ) -> egui::Rect {
        let id = egui::Id::new(card.name);
        let layer = egui::LayerId::new(egui::Order::Middle, id);
        let (drawn, is_shown) = self
            .context
            .memory(|memory| (memory.area_rect(id), memory.areas().visible_last_frame(&layer)));
        let size = drawn.map_or(egui::Vec2::ZERO, |rect| rect.size());
        let (room, taken, all) = (self.room, &self.taken, &self.kept_free);
        let places = CardRoom { room, taken, selected, all, corner: card.corner };
        let is_new = self.states.new.remove(card.name) || !is_shown;
        if !is_shown {
            self.states.new.insert(card.name);
        }
        let stays = |now: &egui::Rect| {
            selected.is_none_or(|limb| !limb.intersects(*now) || is_used(self.context, *now))
        };
        let now = drawn.filter(|_| !is_new).and_then(|now| places.as_at(size, now));
        let at = now.filter(stays).unwrap_or_else(|| places.place(size));
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
    use crate::studio::panels::testing::click;
    use egui_kittest::Harness;
    use egui_kittest::kittest::Queryable;

    #[test]
    fn a_card_is_folded_closed_and_comes_back_for_another_occasion_or_on_request() {
        let state = (CardStates::default(), "a and b".to_owned());
        let mut harness = Harness::builder().with_size(egui::vec2(600.0, 400.0)).build_ui_state(
            |ui, (states, occasion): &mut (CardStates, String)| {
                let context = ui.ctx().clone();
                let room = context.content_rect().shrink(12.0);
                let (taken, kept_free) = (Vec::new(), Vec::new());
                let mut table = CardTable { context: &context, room, taken, kept_free, states };
                let card = StageCard {
                    name: "board",
                    title: "Race".to_owned(),
                    occasion: occasion.clone(),
                    corner: egui::Align2::LEFT_TOP,
                };
                table.card(&card, None, |ui| {
                    ui.label("content");
                });
            },
            state,
        );
        harness.run();
        click(&mut harness, "Fold Race");
        assert!(harness.query_by_label("content").is_none());
        click(&mut harness, "Unfold Race");
        harness.get_by_label("content");
        click(&mut harness, "Close Race");
        assert!(harness.query_by_label("Race").is_none() && !harness.state().0.closed.is_empty());
        harness.state_mut().1 = "c and d".to_owned();
        harness.run();
        click(&mut harness, "Close Race");
        harness.state_mut().0.closed.clear();
        harness.run();
        harness.get_by_label("content");
    }

    #[test]
    fn a_card_stays_beside_a_snake_that_moves_below_it_and_leaves_only_its_own_limb() {
        let context = egui::Context::default();
        let mut states = CardStates::default();
        let mut frame = |limb: egui::Pos2, selects: bool, pointer: egui::Pos2| {
            let mut at = egui::Rect::NOTHING;
            let limb = egui::Rect::from_center_size(limb, egui::Vec2::splat(40.0));
            let events = vec![egui::Event::PointerMoved(pointer)];
            let input = egui::RawInput { events, ..Default::default() };
            let _ = context.run_ui(input, |ui| {
                let room = egui::Rect::from_min_size(egui::Pos2::ZERO, egui::vec2(600.0, 400.0));
                let (taken, kept_free) = (Vec::new(), vec![limb]);
                let context = &ui.ctx().clone();
                let mut table = CardTable { context, room, taken, kept_free, states: &mut states };
                let (title, occasion) = ("Race".to_owned(), String::new());
                let corner = egui::Align2::LEFT_TOP;
                let card = StageCard { name: "board", title, occasion, corner };
                at = table.place(&card, selects.then_some(limb), |ui| {
                    ui.label("content");
                });
            });
            at
        };
        let (away, far) = (egui::pos2(300.0, 200.0), egui::pos2(590.0, 390.0));
        frame(away, false, far);
        let first = frame(away, false, far);
        assert_eq!(first.min, egui::Pos2::ZERO);
        let below = first.center();
        for _ in 0..500 {
            assert_eq!(frame(below, false, far), first);
        }
        assert_eq!(frame(below, true, below), first, "the pointer is on the card");
        assert!(!frame(below, true, far).contains(below));
    }

    #[test]
    fn a_pointer_near_a_card_uses_it_and_one_that_drags_a_snake_does_not() {
        let card = egui::Rect::from_min_size(egui::pos2(400.0, 300.0), egui::vec2(200.0, 100.0));
        let used_after = |presses: bool, ways: &[f32]| {
            let (context, mut is_used_now) = (egui::Context::default(), false);
            for (frame, x) in ways.iter().enumerate() {
                let (time, pos) = (Some(frame as f64 * 0.02), egui::pos2(*x, 350.0));
                let (button, modifiers) = (egui::PointerButton::Primary, egui::Modifiers::NONE);
                let press = egui::Event::PointerButton { pos, button, pressed: true, modifiers };
                let presses = presses && frame == 0;
                let mut events = vec![egui::Event::PointerMoved(pos)];
                events.extend(presses.then_some(press));
                let input = egui::RawInput { time, events, ..Default::default() };
                let _ = context.run_ui(input, |ui| is_used_now = is_used(ui.ctx(), card));
            }
            is_used_now
        };
        assert!(!used_after(false, &[150.0]) && used_after(false, &[380.0]));
        assert!(!used_after(true, &[150.0, 450.0]), "it drags something else");
    }
}
