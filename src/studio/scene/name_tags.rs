//! Labels in the picture: name tags with the distance above each of several snakes, and the label of the fitness line.

use bevy::prelude::*;
use bevy_egui::{EguiContexts, EguiPrimaryContextPass, egui};

use super::camera::StageCamera;
use super::overlays::{Overlays, fitness_line_end};
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

/// Height of a tag's anchor point above the centre of the head, in metres.
const OVER_HEAD_M: f32 = 1.6;

fn draw(
    mut contexts: EguiContexts,
    lanes: Query<&Lane>,
    camera: Single<(&Camera, &Transform), With<StageCamera>>,
    overlays: Res<Overlays>,
    area: Res<StageArea>,
) -> Result {
    let shows_line = overlays.shows(Overlay::FitnessLine);
    let racing = || lanes.iter().filter(|lane| !lane.is_ghost);
    let are_many = racing().nth(1).is_some();
    if !are_many && !shows_line {
        return Ok(());
    }
    let context = contexts.ctx_mut()?;
    let (camera, place) = *camera;
    let place = GlobalTransform::from(*place);
    let mut tags: Vec<(egui::Pos2, String)> = racing()
        .filter_map(|lane| {
            let y_m = lane.drawn_middle().y;
            let (above, text) = if are_many {
                let head = lane.drawn_poses().next()?.translation + lane.offset();
                (
                    head + Vec3::Z * OVER_HEAD_M,
                    format!("{}  {} m", lane.staged.label(), decimals(y_m, 1)),
                )
            } else {
                (fitness_line_end(lane), format!("middle block at {} m", decimals(y_m, 2)))
            };
            let at = camera.world_to_viewport(&place, above).ok()?;
            Some((area.point_of(at), text))
        })
        .collect();
    tags.sort_by(|a, b| b.0.y.total_cmp(&a.0.y));
    let stage = area.rect();
    let layer = egui::LayerId::new(egui::Order::Background, egui::Id::new("name tags"));
    let painter = context.layer_painter(layer).with_clip_rect(stage);
    let palette = theme::of_context(context);
    let font = egui::FontId::proportional(theme::TAG_SIZE);
    let mut placed: Vec<egui::Rect> = Vec::new();
    for (at, text) in tags {
        let galley = painter.layout_no_wrap(text, font.clone(), palette.text);
        let size = galley.size() + egui::vec2(theme::GAP * 1.5, theme::GAP * 0.75);
        let over = egui::Rect::from_center_size(at - egui::vec2(0.0, size.y / 2.0), size);
        let mut rect = within(over, stage);
        // Moves a tag up while it would cover another.
        while let Some(other) = placed.iter().find(|other| other.intersects(rect)) {
            rect = rect.translate(egui::vec2(0.0, other.top() - rect.bottom() - 2.0));
        }
        placed.push(rect);
        painter.rect(
            rect,
            rect.height() / 2.0,
            palette.panel.gamma_multiply(0.9),
            egui::Stroke::new(1.0, palette.field_hovered),
            egui::StrokeKind::Inside,
        );
        let inside = rect.center() - galley.size() / 2.0;
        painter.galley(inside, galley, palette.text);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tag_at_the_edge_of_the_stage_is_not_cut() {
        let stage = egui::Rect::from_min_max(egui::pos2(100.0, 0.0), egui::pos2(900.0, 500.0));
        let tag =
            |x: f32| egui::Rect::from_center_size(egui::pos2(x, 50.0), egui::vec2(140.0, 20.0));
        for x in [105.0, 480.0, 890.0] {
            let shown = within(tag(x), stage);
            assert!(shown.left() >= stage.left() && shown.right() <= stage.right(), "{shown}");
        }
        assert_eq!(within(tag(480.0), stage), tag(480.0));
        assert_eq!(within(tag(2000.0), stage), tag(2000.0), "out of sight");
    }
}
