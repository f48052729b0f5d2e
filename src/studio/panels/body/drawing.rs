//! A drawing of a body to scale, from above and from the side.

use bevy_egui::egui;

use crate::studio::ui::accessible::named;
use crate::studio::ui::theme;
use snakes_core::world::BodyPlan;
use snakes_lab::mesh::Outlines;
use snakes_lab::plot::Role;

/// Maximum height of both views together, in points.
const HEIGHT: f32 = 130.0;
/// Space between the views and around them, in points.
const SPACE: f32 = 8.0;

/// Draws the blocks of a body, with the head on the right. Returns the block that was clicked.
pub(super) fn drawing(
    ui: &mut egui::Ui,
    body: &BodyPlan,
    selected: Option<usize>,
) -> Option<usize> {
    let outlines = Outlines::of(body);
    let [width_m, length_m, height_m] = outlines.size_m();
    if length_m <= 0.0 || width_m + height_m <= 0.0 {
        return None;
    }
    let width = ui.available_width();
    let name = (theme::SMALL_SIZE + 2.0) * 2.0;
    let room = HEIGHT - 2.0 * SPACE;
    let scale = ((width - 2.0 * SPACE) / length_m).min(room / (width_m + height_m));
    let tall = (width_m + height_m) * scale + 3.0 * SPACE + name;
    let (area, response) = ui.allocate_exact_size(egui::vec2(width, tall), egui::Sense::click());
    let palette = theme::of(ui);
    let painter = ui.painter();
    painter.rect_filled(area, 4.0, palette.field);
    let left = area.center().x - length_m * scale / 2.0;
    let mut clicked = None;
    let mut top = area.top() + SPACE;
    for (view, of_view_m, side) in [("From above", width_m, 0), ("From the side", height_m, 2)] {
        let font = egui::FontId::proportional(theme::SMALL_SIZE);
        let at = egui::pos2(area.left() + SPACE, top - SPACE / 2.0);
        painter.text(at, egui::Align2::LEFT_TOP, view, font, palette.text_weak);
        top += name / 2.0;
        for (block, corners) in outlines.seen(side).into_iter().enumerate() {
            let points: Vec<egui::Pos2> = corners
                .into_iter()
                .map(|[along_m, down_m]| egui::pos2(left + along_m * scale, top + down_m * scale))
                .collect();
            let hull = egui::Rect::from_points(&points);
            let color = palette.role(if block % 2 == 0 { Role::Red } else { Role::Blue });
            let is_soft = body.parts_of(block).len() > 1;
            let frame = egui::Stroke::new(1.0, palette.field);
            if is_soft {
                // Soft blocks have round corners.
                let corner = hull.height().min(hull.width()) / 2.0 * 0.8;
                painter.rect_filled(hull.shrink(0.5), corner, color);
            } else {
                painter.add(egui::Shape::convex_polygon(points.clone(), color, frame));
            }
            if selected == Some(block) {
                let stroke = egui::Stroke::new(2.0, palette.text);
                painter.add(egui::Shape::closed_line(points, stroke));
            }
            let hit = hull.expand2(egui::vec2(0.0, SPACE / 2.0));
            if response.clicked()
                && response.interact_pointer_pos().is_some_and(|at| hit.contains(at))
            {
                clicked = Some(block);
            }
        }
        top += of_view_m * scale + SPACE;
    }
    let response = named(response, egui::WidgetType::Other, "Drawing of the blocks");
    if selected.is_some() {
        response.on_hover_text("Click a block to change it. The head is on the right");
    }
    clicked
}
