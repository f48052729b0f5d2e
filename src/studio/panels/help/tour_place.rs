//! Placement of a card of the tour: beside its target, without covering the target.

use bevy_egui::egui::{Pos2, Rect, Vec2, pos2, vec2};

use crate::studio::ui::theme;

/// Distance between a card and its target, in points.
const GAP: f32 = theme::GAP * 2.0;
/// Distance of a card over the stage from the stage's upper edge, in points: below the camera bar.
const BELOW_BAR: f32 = theme::GAP * 6.0;
/// Minimum width of a card's contents, in points.
const LEAST_WIDTH: f32 = theme::GAP * 30.0;
/// Vertical position of a card beside a panel on the right, as a share of the panel's height. The stairs rise to the
/// right, so the area above the ground is free.
const LOW: f32 = 0.6;

/// Width of a card beyond that of its contents, in points.
const AROUND: f32 = theme::GAP * 4.0;

/// Returns the width of a card's contents, in points: the usual one, or less if the card then fits beside its target.
pub(super) fn content_width(target: Option<Rect>, screen: Rect) -> f32 {
    let beside =
        |target: Rect| (target.left() - screen.left()).max(screen.right() - target.right());
    let room = target.map_or(0.0, beside) - GAP - theme::GAP - AROUND;
    let usual = theme::TOUR_WIDTH.min(screen.width() - AROUND);
    if room < LEAST_WIDTH { usual } else { room.min(usual) }
}

/// Returns the rectangle for a card of this size: to the right of its target, to the left, below or above, wherever
/// there is room. Otherwise it is in the target's upper left corner, because the stairs rise to the right.
pub(super) fn card_place(target: Rect, screen: Rect, size: Vec2) -> Rect {
    let inside = screen.shrink(theme::GAP);
    let at = |x: f32, y: f32| {
        let last = inside.max - size;
        let x = x.min(last.x).max(inside.left());
        Rect::from_min_size(pos2(x, y.min(last.y).max(inside.top())), size)
    };
    let candidates = [
        at(target.right() + GAP, target.top() + BELOW_BAR),
        at(target.left() - GAP - size.x, target.top() + target.height() * LOW),
        at(target.left() + GAP, target.bottom() + GAP),
        at(target.left() + GAP, target.top() - GAP - size.y),
    ];
    let is_beside = |place: &Rect| !place.intersects(target) && inside.contains_rect(*place);
    let beside = candidates.into_iter().find(is_beside);
    beside.unwrap_or_else(|| at(target.left() + GAP, target.top() + BELOW_BAR))
}

/// Returns the corners of an arrow from a card to its target, or `None` if the card is over the target.
pub(super) fn arrow(card: Rect, target: Rect) -> Option<Vec<Pos2>> {
    let (long, half) = (theme::GAP * 1.75, theme::GAP);
    let y = card.center().y.clamp(target.top(), target.bottom()).clamp(card.top(), card.bottom());
    let x = card.center().x.clamp(target.left(), target.right()).clamp(card.left(), card.right());
    let (base, along) = if card.left() >= target.right() {
        (pos2(card.left(), y), vec2(-1.0, 0.0))
    } else if card.right() <= target.left() {
        (pos2(card.right(), y), vec2(1.0, 0.0))
    } else if card.top() >= target.bottom() {
        (pos2(x, card.top()), vec2(0.0, -1.0))
    } else if card.bottom() <= target.top() {
        (pos2(x, card.bottom()), vec2(0.0, 1.0))
    } else {
        return None;
    };
    let aside = along.rot90() * half;
    Some(vec![base + aside, base + along * long, base - aside])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::workspace::widths::LEAST_PANEL;

    fn rect(left: f32, top: f32, right: f32, bottom: f32) -> Rect {
        Rect::from_min_max(pos2(left, top), pos2(right, bottom))
    }

    #[test]
    fn a18_a_card_covers_neither_what_it_points_at_nor_the_upper_stairs() {
        // The window, the panel on the left, the stage, and the charts on the right of a wide window.
        for (size, left, right) in [
            (vec2(1024.0, 640.0), LEAST_PANEL, 1024.0),
            (vec2(1280.0, 720.0), 384.0, 1280.0),
            (vec2(1600.0, 900.0), 384.0, 1180.0),
        ] {
            let screen = Rect::from_min_size(Pos2::ZERO, size);
            let panel = rect(0.0, 56.0, left, size.y);
            let stage = rect(left, 28.0, right, size.y);
            let upper_stairs =
                rect(left + stage.width() * 0.6, 28.0, right, 28.0 + stage.height() / 2.0);
            let charts = rect(right, 56.0, size.x, size.y);
            for target in [panel, stage, charts] {
                if target.width() < 1.0 {
                    continue;
                }
                let width = content_width(Some(target), screen) + AROUND;
                let card = card_place(target, screen, vec2(width, 220.0));
                assert!(screen.contains_rect(card), "{size} {target}: {card}");
                assert!(!card.intersects(upper_stairs), "{size} {target}: {card}");
                assert!(!card.intersects(target), "{size} {target}: {card}");
                assert!(arrow(card, target).is_some(), "{size} {target}: an arrow");
            }
        }
    }

    #[test]
    fn an_arrow_points_from_the_card_to_its_target() {
        let card = rect(400.0, 100.0, 700.0, 300.0);
        let tip = |target| arrow(card, target).expect("beside it")[1];
        assert_eq!(tip(rect(0.0, 0.0, 380.0, 600.0)), pos2(386.0, 200.0));
        assert_eq!(tip(rect(720.0, 0.0, 900.0, 600.0)), pos2(714.0, 200.0));
        assert_eq!(arrow(card, rect(0.0, 0.0, 900.0, 600.0)), None);
    }
}
