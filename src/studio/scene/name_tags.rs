//! Labels in the picture: name tags with the distance beside the head of each of several snakes, and the label of the fitness line.

use bevy::prelude::*;
use bevy_egui::{EguiContexts, EguiPrimaryContextPass, egui};

use super::camera::StageCamera;
use super::overlays::{Overlays, fitness_line_ends};
use super::stage_view::StageView;
use crate::studio::commands::overlay::Overlay;
use crate::studio::stage::lane::Lane;
use crate::studio::ui::decimals::decimals;
use crate::studio::ui::theme;
use crate::studio::ui::viewport::StageArea;

pub(crate) fn plugin(app: &mut App) {
    app.add_systems(EguiPrimaryContextPass, draw);
}

/// Moves a tag sideways so that the edge of the stage cuts none of its text. A tag whose snake is out of view is not
/// moved.
fn within(tag: egui::Rect, stage: egui::Rect) -> egui::Rect {
    let stage = stage.shrink(theme::GAP / 2.0);
    if !stage.x_range().contains(tag.center().x) {
        return tag;
    }
    let aside = (stage.left() - tag.left()).max(0.0) - (tag.right() - stage.right()).max(0.0);
    tag.translate(egui::vec2(aside, 0.0))
}

/// Distance of a tag from heads and from other tags, in points.
const CLEAR: f32 = theme::GAP / 2.0;
/// Width of the line from a tag to its head, in points.
const TAG_LINE: f32 = 2.0;
/// Sides of a head at which its tag can be, in the order in which they are tried: above, to the left, to the right, and below.
const SIDES: [[f32; 2]; 4] = [[0.0, -1.0], [-1.0, 0.0], [1.0, 0.0], [0.0, 1.0]];

/// Places tags beside their heads, so that no tag covers a head or another tag. Each tag has the area of its head and its own size, in
/// points. A tag stays at its side of the last frame while that side is free; `sides` are indices of [`SIDES`].
fn places(
    tags: &[(egui::Rect, egui::Vec2)],
    sides: &mut Vec<usize>,
    stage: egui::Rect,
) -> Vec<egui::Rect> {
    let mut taken: Vec<egui::Rect> = tags.iter().map(|(head, _)| head.expand(CLEAR)).collect();
    sides.resize(tags.len(), 0);
    for ((head, size), last) in tags.iter().zip(sides) {
        let at = |side: usize| {
            let away = (head.size() + *size) / 2.0 + egui::Vec2::splat(CLEAR * 1.5);
            let middle = head.center() + away * egui::Vec2::from(SIDES[side]);
            within(egui::Rect::from_center_size(middle, *size), stage)
        };
        let is_free = |side: &usize| {
            let is_in_sight = stage.contains_rect(at(*side)) || !stage.intersects(*head);
            is_in_sight && !taken.iter().any(|other| other.intersects(at(*side)))
        };
        let free = std::iter::once(*last).chain(0..SIDES.len()).find(is_free);
        *last = free.unwrap_or(0);
        let mut place = at(*last);
        // Between many heads, a tag goes up until it is above all that it would cover.
        while let Some(other) = taken.iter().find(|other| other.intersects(place)) {
            place = place.translate(egui::vec2(0.0, other.top() - place.bottom() - 1.0));
        }
        taken.push(place.expand(CLEAR / 2.0));
    }
    taken[tags.len()..].iter().map(|place| place.shrink(CLEAR / 2.0)).collect()
}

fn draw(
    mut contexts: EguiContexts,
    lanes: Query<&Lane>,
    camera: Single<(&Camera, &Transform), With<StageCamera>>,
    overlays: Res<Overlays>,
    area: Res<StageArea>,
    mut sides: Local<Vec<usize>>,
) -> Result {
    let shows_line = overlays.contains(&Overlay::FitnessLine);
    let racing = || lanes.iter().filter(|lane| !lane.is_ghost);
    let are_many = racing().nth(1).is_some();
    if !are_many && !shows_line {
        return Ok(());
    }
    let context = contexts.ctx_mut()?;
    let view = StageView::new(camera.0, camera.1, context);
    let stage = area.rect;
    let layer = egui::LayerId::new(egui::Order::Background, egui::Id::new("name tags"));
    let painter = context.layer_painter(layer).with_clip_rect(stage);
    let palette = theme::of_context(context);
    let font = egui::FontId::proportional(theme::TAG_SIZE);
    let margin = egui::vec2(theme::GAP * 1.5, theme::GAP * 0.75);
    let (tags, texts): (Vec<_>, Vec<_>) = racing()
        .filter_map(|lane| {
            let (head, text, color) = if are_many {
                let text = format!("{}  {}", lane.staged.label(), lane.place_in_words());
                (view.limb(lane, 0)?, text, Some(palette.lane_color(lane.number)))
            } else {
                let at = view.point_of(fitness_line_ends(lane)[1])?;
                let text = format!("middle block at {} m", decimals(lane.drawn_middle().y, 2));
                (egui::Rect::from_pos(at), text, None)
            };
            let text = painter.layout_no_wrap(text, font.clone(), palette.text);
            let dot = color.map_or(0.0, |_| theme::LANE_DOT + theme::GAP / 2.0);
            Some(((head, text.size() + margin + egui::vec2(dot, 0.0)), (text, color)))
        })
        .unzip();
    let placed = places(&tags, &mut sides, stage);
    // A line to its head in the colour of the lane tells whose tag it is, where snakes stand close to each other.
    for ((rect, (head, _)), (_, color)) in placed.iter().zip(&tags).zip(&texts) {
        if let Some(color) = *color {
            let ends = [rect.clamp(head.center()), head.clamp(rect.center())];
            painter.line_segment(ends, egui::Stroke::new(TAG_LINE, color));
        }
    }
    for (rect, (text, color)) in placed.into_iter().zip(texts) {
        painter.rect(
            rect,
            rect.height() / 2.0,
            palette.panel.gamma_multiply(0.9),
            egui::Stroke::new(1.0, palette.field_hovered),
            egui::StrokeKind::Inside,
        );
        let mut at = rect.left_center() + egui::vec2(margin.x / 2.0, -text.size().y / 2.0);
        if let Some(color) = color {
            let radius = theme::LANE_DOT / 2.0;
            let dot = egui::pos2(at.x + radius, rect.center().y);
            painter.circle_filled(dot, radius, color);
            at.x += theme::LANE_DOT + theme::GAP / 2.0;
        }
        painter.galley(at, text, palette.text);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tag_covers_no_head_and_no_other_tag_and_keeps_its_side() {
        let stage = egui::Rect::from_min_max(egui::pos2(385.0, 29.0), egui::pos2(1280.0, 613.0));
        let size = egui::vec2(150.0, 22.0);
        let tags_of = |across: f32, up: f32| -> Vec<(egui::Rect, egui::Vec2)> {
            let at =
                |lane: usize| egui::pos2(600.0 + across * lane as f32, 400.0 - up * lane as f32);
            let head = |lane| egui::Rect::from_center_size(at(lane), egui::vec2(34.0, 30.0));
            (0..5).map(|lane| (head(lane), size)).collect()
        };
        for (across, up) in [(100.0, 40.0), (60.0, 5.0), (20.0, 45.0), (36.0, 32.0), (-50.0, 0.0)] {
            let (tags, mut sides) = (tags_of(across, up), Vec::new());
            let placed = places(&tags, &mut sides, stage);
            for (index, tag) in placed.iter().enumerate() {
                assert!(stage.contains_rect(*tag), "{tag}");
                assert!(tags.iter().all(|(head, _)| !head.expand(3.0).intersects(*tag)), "{tag}");
                assert!(placed[..index].iter().all(|other| !other.intersects(*tag)), "{tag}");
            }
            assert_eq!(places(&tags, &mut sides, stage), placed, "the next frame");
        }
        let alone = |x: f32, mut sides: Vec<usize>| {
            let head = egui::Rect::from_center_size(egui::pos2(x, 300.0), egui::vec2(34.0, 30.0));
            (head, places(&[(head, size)], &mut sides, stage)[0])
        };
        for x in [390.0, 800.0, 1275.0] {
            let (head, tag) = alone(x, Vec::new());
            assert!(stage.contains_rect(tag) && tag.bottom() < head.top(), "{tag}");
        }
        let (head, tag) = alone(800.0, vec![1]);
        assert!(tag.right() < head.left(), "it stays at the left");
        assert_eq!(alone(2000.0, Vec::new()).1.center().x, 2000.0, "out of sight");
    }
}
