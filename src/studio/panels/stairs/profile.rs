//! Drawing of the stairs from the side, to scale, with edges that can be dragged.

use bevy_egui::egui;

use super::edit::{StairsEdit, StairsResponse};
use crate::studio::ui::accessible::named;
use crate::studio::ui::theme;
use snakes_core::score::AgentSettings;
use snakes_core::world::{BUILDING_CODES, BuildingCode, Stairs};
use snakes_lab::plot::Role;

/// Maximum height of the drawing, in points.
const MOST_HEIGHT: f32 = 220.0;
/// Margin around the stairs, in points.
const SPACE: f32 = 10.0;
/// Maximum depth of the landing that is drawn, in metres.
const LANDING_M: f32 = 2.0;
/// Height above the stairs that is drawn, in metres.
const ABOVE_M: f32 = 1.0;
/// Radius of an edge's handle, in points.
const HANDLE: f32 = 4.0;
/// Maximum distance between the pointer and the centre of a handle that it drags, in points.
const REACH: f32 = 9.0;
/// Step by which edges move, in metres; with the Shift key they move by [`FINE_M`].
const SNAP_M: f32 = 0.05;
/// Step by which edges move with the Shift key, in metres.
const FINE_M: f32 = 0.01;
/// Distance between the block of the snake and the stairs, in metres.
const BEFORE_M: f32 = 0.3;

/// The drawing of the stairs.
pub(super) struct Profile<'a> {
    /// Stairs to draw, including the changes of a drag in progress.
    pub stairs: &'a Stairs,
    /// Stairs of the next run. They determine the scale, which must not change during a drag.
    pub next: &'a Stairs,
    /// Snake of which one block is drawn, as a scale.
    pub agent: &'a AgentSettings,
    /// Step to highlight; the lowest is 0.
    pub pointed: Option<u32>,
}

/// An edge that is being dragged: the step to which it belongs, the lowest of which is 0, and the position at which the
/// pointer took hold of the edge, as y and z in metres.
pub(super) type Grab = (u32, [f32; 2]);

/// Conversion from metres to points.
#[derive(Debug, Clone, Copy)]
struct ProfileScale {
    origin: egui::Pos2,
    points_per_m: f32,
}

impl ProfileScale {
    fn at(self, [y_m, z_m]: [f32; 2]) -> egui::Pos2 {
        self.origin + egui::vec2(y_m, -z_m) * self.points_per_m
    }

    fn rect(self, from_m: [f32; 2], to_m: [f32; 2]) -> egui::Rect {
        egui::Rect::from_two_pos(self.at(from_m), self.at(to_m))
    }

    fn back_m(self, at: egui::Pos2) -> [f32; 2] {
        let from = (at - self.origin) / self.points_per_m;
        [from.x, -from.y]
    }
}

impl Profile<'_> {
    /// Draws the stairs. While an edge is dragged, returns the changed stairs, with the movement rounded to steps.
    /// `grab` is the edge that is being dragged, if any.
    pub fn ui(&self, ui: &mut egui::Ui, grab: &mut Option<Grab>) -> StairsResponse {
        let stairs = self.next;
        let [block_m, block_high_m] =
            [self.agent.limb_length_m.at(0), self.agent.limb_height_m.at(0)];
        let from_y_m = stairs.first_riser_y_m - BEFORE_M - block_m;
        let to_y_m = end_y_m(stairs);
        let (long_m, high_m) = (to_y_m - from_y_m, stairs.highest_m().max(block_high_m) + ABOVE_M);
        let width = ui.available_width();
        let room = egui::vec2(width, MOST_HEIGHT) - egui::Vec2::splat(2.0 * SPACE);
        let points_per_m = (room.x / long_m).min(room.y / high_m);
        let size = egui::vec2(width, high_m * points_per_m + 2.0 * SPACE);
        let (area, _) = ui.allocate_exact_size(size, egui::Sense::hover());
        let left = area.center().x - long_m * points_per_m / 2.0;
        let origin = egui::pos2(left - from_y_m * points_per_m, area.bottom() - SPACE);
        let scale = ProfileScale { origin, points_per_m };
        let painter = ui.painter().with_clip_rect(area);
        let palette = theme::of(ui);
        painter.rect_filled(area, 4.0, palette.field);
        let block = scale.rect(
            [stairs.first_riser_y_m - BEFORE_M, 0.0],
            [stairs.first_riser_y_m - BEFORE_M - block_m, block_high_m],
        );
        painter.rect_filled(block, 2.0, palette.role(Role::Red));
        let hint =
            format!("A block of the snake, to scale: {block_m} m long, {block_high_m} m high");
        ui.interact(block, ui.id().with("block"), egui::Sense::hover()).on_hover_text(hint);
        self.solids(&painter, scale, palette);
        let ground = egui::Stroke::new(1.0, palette.text_weak);
        painter.hline(area.x_range(), origin.y, ground);
        self.code_line(&painter, scale, palette);
        self.handles(ui, scale, grab)
    }

    /// Draws the solid parts of the stairs, and their outline.
    fn solids(&self, painter: &egui::Painter, scale: ProfileScale, palette: &theme::Palette) {
        let stairs = self.stairs;
        let to_y_m = end_y_m(stairs);
        let stone = theme::flat(palette.stair);
        let lit = palette.accent_soft;
        let color = |step| if self.pointed == Some(step) { lit } else { stone };
        for step in stairs.boxes() {
            let to_m = [step.max_m[1].min(to_y_m), step.max_m[2]];
            let rect = scale.rect([step.min_m[1], step.min_m[2]], to_m);
            painter.rect_filled(rect, 0.0, color(step.step));
        }
        for step in (0..stairs.steps).filter(|step| stairs.step_slope_m(*step) > 0.0) {
            let (foot_y_m, top_y_m) = (stairs.riser_y_m(step), stairs.tread_y_m(step));
            let (foot_m, top_m) = (stairs.height_m(step), stairs.height_m(step + 1));
            let low_m = foot_m.min(top_m);
            let corner_m = if top_m > foot_m { [top_y_m, low_m] } else { [foot_y_m, low_m] };
            let points = [[foot_y_m, foot_m], [top_y_m, top_m], corner_m].map(|at| scale.at(at));
            let fill = egui::Shape::convex_polygon(points.into(), color(step), egui::Stroke::NONE);
            painter.add(fill);
        }
        let outline = stairs.outline_m().into_iter().map(|[y_m, z_m]| [y_m.min(to_y_m), z_m]);
        let points: Vec<egui::Pos2> = outline.map(|at| scale.at(at)).collect();
        painter.add(egui::Shape::line(points, egui::Stroke::new(1.5, palette.text)));
    }

    /// Draws the steepest stairs that building codes allow in a home, as a dashed line over the first edges.
    fn code_line(&self, painter: &egui::Painter, scale: ProfileScale, palette: &theme::Palette) {
        let area = painter.clip_rect();
        let steepest = BUILDING_CODES.iter().map(BuildingCode::steepest).fold(0.0, f32::max);
        if self.stairs.steps == 0 {
            return;
        }
        let from_m = self.stairs.handle_m(0);
        let most_z_m = scale.back_m(area.left_top())[1];
        let along_m = (most_z_m - from_m[1]) / steepest;
        let to_m = [from_m[0] + along_m, most_z_m];
        let stroke = egui::Stroke::new(1.5, palette.second);
        let line = [scale.at(from_m), scale.at(to_m)];
        painter.extend(egui::Shape::dashed_line(&line, stroke, 6.0, 4.0));
        // The text is to the left of the line's upper end.
        let font = egui::FontId::proportional(theme::SMALL_SIZE);
        let text = "steepest in a home";
        let layout = painter.layout_no_wrap(text.to_owned(), font, palette.second);
        let top = area.top() + SPACE / 2.0;
        let height = layout.size().y + SPACE / 2.0;
        let x_at = scale.at(to_m).x - height / steepest - SPACE / 2.0;
        let place = egui::pos2((x_at - layout.size().x).max(area.left() + SPACE / 2.0), top);
        painter.galley(place, layout, palette.second);
    }

    /// Draws the handles of all steps. Returns the response to the pointer.
    fn handles(
        &self,
        ui: &mut egui::Ui,
        scale: ProfileScale,
        grab: &mut Option<Grab>,
    ) -> StairsResponse {
        let palette = theme::of(ui);
        let before = grab.take();
        let mut drawn = StairsResponse::default();
        for step in 0..self.stairs.steps {
            let handle_m = self.stairs.handle_m(step);
            let at = scale.at(handle_m);
            let reach = egui::Rect::from_center_size(at, egui::Vec2::splat(2.0 * REACH));
            let id = ui.id().with(("edge of step", step));
            let response = ui.interact(reach, id, egui::Sense::drag());
            let name = format!("Edge of step {}", step + 1);
            let response = named(response, egui::WidgetType::Other, &name);
            let is_taken = response.dragged() || response.drag_stopped();
            if response.hovered() || is_taken {
                drawn.pointed = Some(step);
                ui.ctx().set_cursor_icon(egui::CursorIcon::Move);
            }
            let is_lit = self.pointed == Some(step);
            let (radius, color) =
                if is_lit { (HANDLE + 2.0, palette.accent) } else { (HANDLE, palette.text) };
            ui.painter().circle(at, radius, color, egui::Stroke::new(1.0, palette.field));
            if is_taken && let Some(pointer) = response.interact_pointer_pos() {
                let pointer_m = scale.back_m(pointer);
                let same = before.filter(|(of, _)| *of == step);
                let from_m = same.map_or(pointer_m, |(_, from_m)| from_m);
                *grab = Some((step, from_m)).filter(|_| response.dragged());
                let snap_m = if ui.input(|input| input.modifiers.shift) { FINE_M } else { SNAP_M };
                // The movement is rounded, not the position, so that a coordinate that is not moved stays exactly as it is.
                let moved_m =
                    |axis: usize| ((pointer_m[axis] - from_m[axis]) / snap_m).round() * snap_m;
                let [y_m, z_m] = self.next.handle_m(step);
                let to_m = [y_m + moved_m(0), z_m + moved_m(1)];
                let stairs = self.next.with_handle_at(step, to_m);
                let is_complete = response.drag_stopped();
                drawn.edit = Some(StairsEdit { stairs, is_complete });
            } else {
                let (rise_m, tread_m) =
                    (self.stairs.step_rise_m(step), self.stairs.step_tread_m(step));
                response.on_hover_text(format!(
                    "Step {}: rise {rise_m:.2} m, tread {tread_m:.2} m. Drag it; with Shift, in centimetres",
                    step + 1
                ));
            }
        }
        drawn
    }
}

/// Returns the position on the y axis at which the drawing ends, in metres.
fn end_y_m(stairs: &Stairs) -> f32 {
    stairs.riser_y_m(stairs.steps) + stairs.landing_m.min(LANDING_M)
}
