//! A card over the stage, which can be folded and closed, and is placed beside the snakes.

use std::collections::{BTreeMap, BTreeSet};

use bevy_egui::egui;

use super::card_places::CardRoom;
use crate::studio::ui::accessible::named;
use crate::studio::ui::text_rows::title_text;
use crate::studio::ui::theme;

/// Cards that the user folded or closed since the start of the program, and the rest of each card in its place.
#[derive(Debug, Default)]
pub(crate) struct CardStates {
    folded: BTreeSet<&'static str>,
    rests: BTreeMap<&'static str, CardRest>,
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

/// Distance from the pointer to a card, in points, within which the card stays in its place.
const REACH: f32 = theme::GAP * 6.0;
/// Time after which the pointer would be at a card with its present velocity, in seconds, so that the card stays in its place.
const AHEAD_S: f32 = 0.4;
/// Time for which a card stays in its place after the pointer was near it, in seconds.
const USED_S: f64 = 3.0;
/// Time for which a card covers a snake or the gate before it moves, in seconds.
const COVERS_S: f64 = 1.5;

/// Rest of a card in its place.
#[derive(Debug, Default)]
struct CardRest {
    /// Last time at which the pointer was near the card, in seconds.
    used_s: Option<f64>,
    /// Time since which the card covers something and another place would be better, in seconds. Minus infinity for a new card, which
    /// moves at once.
    covers_since_s: Option<f64>,
}

impl CardRest {
    /// Returns whether a card stays in its place at the time `now_s`. `is_used` tells whether the pointer is near the card, `covers` whether
    /// another place would be better, and `is_urgent` whether the card covers the selected limb.
    fn lasts(&mut self, now_s: f64, is_used: bool, covers: bool, is_urgent: bool) -> bool {
        self.used_s = if is_used { Some(now_s) } else { self.used_s };
        let since_s = self.covers_since_s.filter(|_| covers).unwrap_or(now_s);
        self.covers_since_s = covers.then_some(since_s);
        let was_used = self.used_s.is_some_and(|used_s| now_s < used_s + USED_S);
        let stays = if is_urgent { is_used } else { was_used || now_s < since_s + COVERS_S };
        !covers || (stays && since_s.is_finite())
    }
}

/// Returns whether the pointer is near a card or approaches it, and does not drag something else.
fn is_used(context: &egui::Context, card: egui::Rect) -> bool {
    let reach = card.expand(REACH);
    context.input(|input| {
        let pointer = &input.pointer;
        let drags_other = pointer.press_origin().is_some_and(|from| !reach.contains(from));
        let at = pointer.latest_pos().filter(|_| !drags_other);
        at.is_some_and(|at| reach.contains(at) || reach.contains(at + pointer.velocity() * AHEAD_S))
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
    /// Corner of the stage at which the card is placed if it covers no snake there.
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

    /// Draws a card without a header. Returns its area.
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
        // Before the first frame, which egui does not show, the size of the card is unknown.
        let size = drawn.map_or(egui::Vec2::ZERO, |rect| rect.size());
        let (room, taken, all) = (self.room, &self.taken, &self.kept_free);
        let places = CardRoom { room, taken, selected, all, corner: card.corner };
        let best = places.place(size);
        let now = drawn.filter(|_| is_shown).and_then(|now| places.as_at(size, now));
        let rest = self.states.rests.entry(card.name).or_default();
        let lasts = |now: &egui::Rect| {
            let now_s = self.context.input(|input| input.time);
            let is_urgent = selected.is_some_and(|limb| limb.intersects(*now));
            let covers = places.is_much_better(&best, now);
            rest.lasts(now_s, is_used(self.context, *now), covers, is_urgent)
        };
        let at = now.filter(lasts).unwrap_or_else(|| {
            let covers_since_s = (!is_shown).then_some(f64::NEG_INFINITY);
            *rest = CardRest { covers_since_s, used_s: None };
            best
        });
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

    #[test]
    fn a_card_moves_after_it_covered_something_for_long_but_not_while_it_is_used() {
        // Frames: time in seconds, whether the pointer is near, whether another place is better, whether that is urgent, whether it stays.
        let frames = [
            (0.0, false, false, false, true),
            (1.0, false, true, false, true),
            (2.4, false, true, false, true),
            (2.6, false, true, false, false),
            // In its new place, it begins anew.
            (2.7, false, true, false, true),
            (3.0, false, false, false, true),
            (4.3, false, true, false, true),
            (5.7, true, true, false, true),
            (8.6, false, true, false, true),
            (8.8, false, true, false, false),
            // A selected limb is uncovered at once, unless the pointer is on the card.
            (9.0, false, true, true, false),
            (9.1, true, true, true, true),
            (9.2, false, true, true, false),
        ];
        let mut rest = CardRest::default();
        for (now_s, is_used, covers, is_urgent, stays) in frames {
            assert_eq!(rest.lasts(now_s, is_used, covers, is_urgent), stays, "at {now_s} s");
            rest = if stays { rest } else { CardRest::default() };
        }
        rest.covers_since_s = Some(f64::NEG_INFINITY);
        assert!(!rest.lasts(9.3, true, true, false), "a new card, whose size was unknown");
    }

    #[test]
    fn a_pointer_that_is_near_a_card_or_comes_to_it_uses_it_and_one_that_drags_a_snake_does_not() {
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
        assert!(used_after(false, &[150.0, 166.0, 182.0, 198.0, 214.0, 230.0]), "it approaches");
        assert!(!used_after(true, &[150.0, 450.0]), "it drags something else");
    }
}
