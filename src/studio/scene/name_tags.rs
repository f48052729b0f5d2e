//! Name tags above several snakes, with the distance of each.

use bevy::prelude::*;
use bevy_egui::{EguiContexts, EguiPrimaryContextPass, egui};

use super::camera::StageCamera;
use super::overlays::Overlays;
use crate::studio::commands::overlay::Overlay;
use crate::studio::stage::lane::Lane;
use crate::studio::ui::theme;
use crate::studio::ui::viewport::StageArea;

pub(crate) fn plugin(app: &mut App) {
    app.add_systems(EguiPrimaryContextPass, draw);
}

/// Height of a tag's anchor above the head's centre, in metres.
const OVER_HEAD_M: f32 = 1.6;

fn draw(
    mut contexts: EguiContexts,
    lanes: Query<&Lane>,
    camera: Single<(&Camera, &Transform), With<StageCamera>>,
    overlays: Res<Overlays>,
    area: Res<StageArea>,
) -> Result {
    let shows_line = overlays.shows(Overlay::FitnessLine);
    let are_many = lanes.iter().len() > 1;
    if !are_many && !shows_line {
        return Ok(());
    }
    let context = contexts.ctx_mut()?;
    let (camera, place) = *camera;
    let place = GlobalTransform::from(*place);
    let mut tags: Vec<(egui::Pos2, String)> = lanes
        .iter()
        .filter_map(|lane| {
            let head = lane.drawn_poses().next()?.translation + lane.offset();
            let above = head + Vec3::Z * OVER_HEAD_M;
            let at = camera.world_to_viewport(&place, above).ok()?;
            let y_m = lane.drawn_middle().y;
            let text = if are_many {
                format!("{}  {y_m:.1} m", lane.staged().label())
            } else {
                format!("{y_m:.2} m")
            };
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
        let mut rect = egui::Rect::from_center_size(at - egui::vec2(0.0, size.y / 2.0), size);
        // Move a tag up if it would cover another.
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
