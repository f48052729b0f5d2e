//! Placement of the cards over the stage, and of the messages beside them.

use bevy_egui::egui::{Align, Align2, Pos2, Rect, Vec2, pos2, vec2};

use crate::studio::ui::theme;

/// Minimum distance between two cards, in points.
const GAP: f32 = theme::GAP;
/// Distance of a new place from the limbs, in points, so that the card need not move again soon.
const FROM_LIMBS: f32 = theme::GAP * 1.5;
/// Weight of the selected limb's area, so large that any other limbs are covered before it.
const SELECTED: f32 = 1.0e6;
/// Minimum width of messages, in points.
const LEAST_MESSAGES: f32 = 200.0;

/// Areas around a card, in points.
pub(super) struct CardRoom<'a> {
    /// Area in which the card can be placed.
    pub room: Rect,
    /// Areas of the other cards, which the card must not cover.
    pub taken: &'a [Rect],
    /// Area of the selected limb, if it is in view.
    pub selected: Option<Rect>,
    /// Areas of all limbs on the stage, and of the gate.
    pub all: &'a [Rect],
    /// Corner of the area that is chosen among equally good places.
    pub corner: Align2,
}

impl CardRoom<'_> {
    /// Returns the place for a card of this size that is nearest to its preferred corner. With a selected limb, it is the nearest that covers
    /// neither this limb nor, if possible, any other limb.
    pub fn place(&self, size: Vec2) -> Rect {
        let cost = |place: &Rect| if self.selected.is_some() { self.covered(place) } else { 0.0 };
        let best = self.candidates(size).into_iter().min_by(|a, b| cost(a).total_cmp(&cost(b)));
        best.unwrap_or_else(|| self.corner.align_size_within_rect(size, self.room))
    }

    /// Returns the place of a card of this size that is nearest to the card's place `now`; `None` if the card must move. The size of the card
    /// may have changed.
    pub fn as_at(&self, size: Vec2, now: Rect) -> Option<Rect> {
        let distance =
            |place: &Rect| (place.min - now.min).length().min((place.max - now.max).length());
        let candidates = self.candidates(size).into_iter();
        let nearest = candidates.min_by(|a, b| distance(a).total_cmp(&distance(b)));
        nearest.filter(|place| distance(place) < GAP)
    }

    /// Returns the area of the limbs that a card would cover or touch, in square points. That of the selected limb counts [`SELECTED`] times.
    fn covered(&self, place: &Rect) -> f32 {
        let of = |limb: &Rect| {
            let common = place.expand(FROM_LIMBS).intersect(*limb);
            if common.is_positive() { common.area() } else { 0.0 }
        };
        self.all.iter().map(of).sum::<f32>() + self.selected.as_ref().map_or(0.0, of) * SELECTED
    }

    /// Returns the places at the left and the right edge that cover no other card, the preferred ones first.
    fn candidates(&self, size: Vec2) -> Vec<Rect> {
        let (room, last) = (self.room, self.room.max - size);
        let beside =
            self.taken.iter().flat_map(|card| [card.bottom() + GAP, card.top() - GAP - size.y]);
        let mut tops: Vec<f32> = [last.y, room.top()].into_iter().chain(beside).collect();
        let first = self.corner.align_size_within_rect(size, room).top();
        tops.sort_by(|a, b| (a - first).abs().total_cmp(&(b - first).abs()));
        let mut lefts = [room.left(), last.x];
        if self.corner.x() == Align::Max {
            lefts.reverse();
        }
        let at = |x: f32, y: f32| Rect::from_min_size(pos2(x, y), size);
        let all = lefts.into_iter().flat_map(|x| tops.iter().map(move |y| at(x, *y)));
        let is_free = |place: &Rect| {
            room.expand(0.5).contains_rect(*place)
                && !self.taken.iter().any(|card| card.intersects(*place))
        };
        all.filter(is_free).collect()
    }
}

/// Returns the area for messages, which are drawn in its lower right corner. It is not below the camera bar, and is
/// beside the card of a limb, or above the card if only there is room. `size` is the size of the messages.
pub(super) fn messages_room(
    stage: Rect,
    bar: Rect,
    card: Option<Rect>,
    others: &[Rect],
    size: Vec2,
) -> Rect {
    let size = size.max(vec2(theme::NOTICE_WIDTH, GAP * 8.0));
    let is_below_bar = stage.right() - size.x - GAP * 3.0 < bar.right();
    let top = if is_below_bar { bar.bottom() } else { stage.top() };
    let whole = Rect::from_min_max(pos2(stage.left(), top), stage.max);
    let Some(card) = card else { return whole };
    let to = |max: Pos2| Rect::from_min_max(whole.min, max);
    let rooms = [
        whole,
        // The area above the ground is preferred; above the card, messages could cover a snake on the stairs.
        to(pos2(card.left(), whole.bottom())),
        Rect::from_min_max(pos2(card.right(), whole.top()), whole.max),
        to(pos2(whole.right(), card.top())),
    ];
    // Rectangles that only touch do not count as overlapping.
    let covers = |a: Rect, b: Rect| a.intersect(b).is_positive();
    let messages = |room: &Rect| {
        let size = vec2(size.x.min(room.width()), size.y);
        Rect::from_min_size(room.max - size, size)
    };
    let is_free = |room: &&Rect| {
        let messages = messages(room);
        room.width() >= LEAST_MESSAGES
            && room.contains_rect(messages)
            && !covers(card, messages)
            && !others.iter().any(|other| covers(*other, messages))
    };
    let beside = || rooms[1..].iter().filter(|room| room.width() >= LEAST_MESSAGES);
    let largest = beside().max_by(|a, b| a.area().total_cmp(&b.area()));
    *rooms.iter().find(is_free).or(largest).unwrap_or(&whole)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rect(left: f32, top: f32, right: f32, bottom: f32) -> Rect {
        Rect::from_min_max(pos2(left, top), pos2(right, bottom))
    }

    /// The stage and its camera bar in a window of 1024 by 640 points.
    const STAGE: Rect = Rect { min: pos2(385.0, 29.0), max: pos2(1024.0, 452.0) };
    const BAR: Rect = Rect { min: pos2(397.0, 41.0), max: pos2(785.0, 76.0) };
    /// Size of the card on this stage, in points.
    const CARD: Vec2 = vec2(250.0, 224.0);

    /// Returns the limbs of a snake at the first step, from the head, as the default camera shows them in this window.
    fn snake() -> Vec<Rect> {
        let middles =
            [(722.0, 230.0), (686.0, 253.0), (648.0, 262.0), (605.0, 272.0), (558.0, 295.0)];
        middles.map(|(x, y)| Rect::from_center_size(pos2(x, y), vec2(46.0, 42.0))).to_vec()
    }

    fn around(limbs: &[Rect], selected: usize) -> CardRoom<'_> {
        let taken = std::slice::from_ref(&BAR);
        let (selected, corner) = (limbs.get(selected).copied(), Align2::RIGHT_BOTTOM);
        CardRoom { room: STAGE.shrink(12.0), taken, selected, all: limbs, corner }
    }

    #[test]
    fn the_card_of_a_limb_never_covers_that_limb() {
        let limbs = snake();
        for selected in 0..limbs.len() {
            // The limb is pulled to many places on the stage.
            for (x, y) in
                (400..1020).step_by(20).flat_map(|x| (40..450).step_by(20).map(move |y| (x, y)))
            {
                let mut pulled = limbs.clone();
                pulled[selected] =
                    Rect::from_center_size(pos2(x as f32, y as f32), vec2(46.0, 42.0));
                let place = around(&pulled, selected).place(CARD);
                let selected = pulled[selected];
                assert!(!place.intersects(selected), "{place} covers {selected}");
                assert!(STAGE.contains_rect(place) && !place.intersects(BAR), "{place}");
            }
        }
    }

    #[test]
    fn the_card_covers_no_limb_where_there_is_room_and_is_found_again_where_it_is() {
        let limbs = snake();
        let small = vec2(310.0, 160.0);
        let lower_right = around(&limbs, 0).place(small);
        assert_eq!(lower_right.max, STAGE.shrink(12.0).max);
        assert!(limbs.iter().all(|limb| !limb.intersects(lower_right)));
        let upper_left = rect(397.0, 84.0, 707.0, 244.0);
        let now = upper_left.translate(vec2(1.0, 2.0));
        assert_eq!(around(&limbs, 0).as_at(small, now), Some(upper_left));
    }

    #[test]
    fn messages_are_neither_below_the_camera_bar_nor_behind_the_card_of_a_limb() {
        let high = rect(702.0, 175.0, 1012.0, 440.0);
        for (card, size) in [
            (None, vec2(364.0, 60.0)),
            (Some(rect(702.0, 290.0, 1012.0, 440.0)), vec2(364.0, 60.0)),
            (Some(high), vec2(364.0, 60.0)),
            (Some(high), vec2(364.0, 300.0)),
            (Some(rect(397.0, 175.0, 707.0, 440.0)), vec2(364.0, 300.0)),
            (Some(rect(702.0, 84.0, 1012.0, 334.0)), vec2(364.0, 300.0)),
        ] {
            let room = messages_room(STAGE, BAR, card, &[], size);
            let size = vec2(size.x.min(room.width()), size.y);
            let drawn = Rect::from_min_size(room.max - size, size);
            assert!(drawn.top() >= BAR.bottom(), "{card:?}: {drawn}");
            let is_free = card.is_none_or(|card| !card.shrink(0.5).intersects(drawn));
            assert!(is_free, "{card:?}: {drawn}");
            assert!(room.width() >= LEAST_MESSAGES && STAGE.contains_rect(room), "{room}");
        }
    }
}
