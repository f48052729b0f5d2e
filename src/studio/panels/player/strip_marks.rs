//! Marks of a snake's climb on the timeline, and the legend of the torque strip.

use bevy_egui::egui::emath::TSTransform;
use bevy_egui::egui::{self, Color32, Rect, Shape, Stroke};

use super::climb_events::{ClimbEvent, ClimbEventKind};
use crate::studio::ui::accessible::named;
use crate::studio::ui::theme::{self, Palette};
use snakes_core::world::JointPlan;

/// Half the size of an event's mark, in points.
const HALF: f32 = 3.5;
/// Width and height of the flag of a winner, in points.
pub(super) const FLAG_WIDTH: f32 = HALF * 4.0;
/// Width of the number beside an event's mark, in points.
const NUMBER_WIDTH: f32 = 13.0;
/// Maximum horizontal distance between the pointer and a mark that it hovers over, in points.
const NEAR: f32 = 6.0;

/// Draws the events as marks in the band `marks`. A thin line connects each to the rows below, down to `bottom`.
pub(super) fn draw_events(
    painter: &egui::Painter,
    events: &[ClimbEvent],
    marks: Rect,
    bottom: f32,
    x_of: &dyn Fn(f64) -> f32,
    palette: &Palette,
) {
    let mut free_from = f32::MIN;
    for event in events {
        let time_x = x_of(event.time_s);
        // A mark at an end of the strip is moved so that it is completely visible.
        let x = time_x.max(marks.left() + HALF * 1.5).min(marks.right() - HALF * 1.5);
        let color = color_of(event.kind, palette);
        let line = [egui::pos2(time_x, marks.bottom()), egui::pos2(time_x, bottom)];
        painter.line_segment(line, Stroke::new(1.0, color.gamma_multiply(0.35)));
        painter.add(shape(event.kind, egui::pos2(x, marks.center().y), color));
        let (ClimbEventKind::Climbed(step) | ClimbEventKind::Lost(step)) = event.kind else {
            continue;
        };
        // Where marks are close together, some have no number; the hover text contains it.
        let is_free = x >= free_from && x + HALF + NUMBER_WIDTH <= marks.right();
        if is_free {
            let font = egui::FontId::proportional(theme::SMALL_SIZE - 1.0);
            let at = egui::pos2(x + HALF + 1.0, marks.center().y);
            painter.text(at, egui::Align2::LEFT_CENTER, step.to_string(), font, palette.text);
            free_from = x + HALF * 2.0 + NUMBER_WIDTH;
        }
    }
}

/// Returns the description of the event nearest to the pointer at `x`, if one is close enough.
pub(super) fn event_at(events: &[ClimbEvent], x: f32, x_of: &dyn Fn(f64) -> f32) -> Option<String> {
    let near = events.iter().map(|event| (event, (x_of(event.time_s) - x).abs()));
    let nearest = near.min_by(|(_, a), (_, b)| a.total_cmp(b));
    nearest.filter(|(_, distance)| *distance <= NEAR).map(|(event, _)| event.words())
}

fn color_of(kind: ClimbEventKind, palette: &Palette) -> Color32 {
    match kind {
        ClimbEventKind::Touched => palette.text_weak,
        ClimbEventKind::Climbed(_) => palette.accent,
        ClimbEventKind::Lost(_) => palette.problem,
        ClimbEventKind::Landed => palette.second,
    }
}

/// Draws the mark of a landing in a line of text. `said` is the mark's label for screen readers.
pub(super) fn landing_flag(ui: &mut egui::Ui, said: &str) -> egui::Response {
    let size = egui::Vec2::splat(FLAG_WIDTH);
    let (rect, response) = ui.allocate_exact_size(size, egui::Sense::hover());
    let kind = ClimbEventKind::Landed;
    let mut flag = shape(kind, egui::Pos2::ZERO, color_of(kind, theme::of(ui)));
    flag.transform(TSTransform::new(rect.center().to_vec2(), 1.4));
    ui.painter().add(flag);
    named(response, egui::WidgetType::Image, said)
}

/// Returns the mark of an event. The shapes differ, so that they can be distinguished without their colours.
fn shape(kind: ClimbEventKind, at: egui::Pos2, color: Color32) -> Shape {
    let corner = |x: f32, y: f32| at + egui::vec2(x, y) * HALF;
    let filled = |points: Vec<egui::Pos2>| Shape::convex_polygon(points, color, Stroke::NONE);
    match kind {
        ClimbEventKind::Touched => Shape::circle_filled(at, HALF * 0.8, color),
        ClimbEventKind::Climbed(_) => {
            filled(vec![corner(0.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)])
        }
        ClimbEventKind::Lost(_) => {
            filled(vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(0.0, 1.0)])
        }
        // A pole with a flag.
        ClimbEventKind::Landed => Shape::Vec(vec![
            Shape::line_segment([corner(-0.4, -1.4), corner(-0.4, 1.4)], Stroke::new(1.5, color)),
            filled(vec![corner(-0.4, -1.4), corner(1.4, -0.7), corner(-0.4, 0.0)]),
        ]),
    }
}

/// Draws the legend in one line, as far as the width allows: first the torques, then the marks.
pub(super) fn legend(ui: &mut egui::Ui, joints: &[JointPlan]) {
    let palette = theme::of(ui);
    let font = egui::FontId::proportional(theme::SMALL_SIZE);
    let (rect, response) = ui.allocate_exact_size(
        egui::vec2(ui.available_width(), theme::SMALL_SIZE + 2.0),
        egui::Sense::hover(),
    );
    let mut x = rect.left();
    let mut names = vec!["Joint torques".to_owned()];
    let mut item = |sample: Option<Shape>, text: String| {
        let text = ui.painter().layout_no_wrap(text, font.clone(), palette.text_weak);
        let left = if sample.is_some() { SAMPLE } else { 0.0 };
        if x + left + text.size().x > rect.right() {
            return;
        }
        if let Some(mut sample) = sample {
            sample.translate(egui::vec2(x, rect.center().y));
            ui.painter().add(sample);
        }
        names.push(text.text().to_owned());
        let y = rect.center().y - text.size().y / 2.0;
        let width = text.size().x;
        ui.painter().galley(egui::pos2(x + left, y), text, palette.text_weak);
        x += left + width + theme::GAP * 1.5;
    };
    item(None, scale(joints));
    let dash = |color| {
        Shape::line_segment(
            [egui::pos2(0.0, 0.0), egui::pos2(SAMPLE - 5.0, 0.0)],
            Stroke::new(2.0, color),
        )
    };
    item(Some(dash(palette.bend)), "bend".to_owned());
    item(Some(dash(palette.twist)), "twist".to_owned());
    for (kind, name) in [
        (ClimbEventKind::Climbed(1), "step climbed"),
        (ClimbEventKind::Lost(1), "step lost"),
        (ClimbEventKind::Landed, "top reached"),
        (ClimbEventKind::Touched, "first touch of the stairs"),
    ] {
        let mark = shape(kind, egui::pos2(HALF + 1.0, 0.0), color_of(kind, palette));
        item(Some(mark), name.to_owned());
    }
    named(response, egui::WidgetType::Label, &format!("Legend: {}", names.join(", ")));
}

/// Width of a sample in the legend, in points.
const SAMPLE: f32 = 15.0;

/// Describes the unit and the range of the rows.
fn scale(joints: &[JointPlan]) -> String {
    let limits =
        joints.iter().flat_map(|joint| [joint.max_bend_torque_nm, joint.max_twist_torque_nm]);
    let (least, most) =
        limits.fold((f32::MAX, f32::MIN), |(least, most), of| (least.min(of), most.max(of)));
    if least == most {
        format!("Torque, 0 to ±{most:.0} N·m")
    } else {
        "Torque (N·m), 0 to each joint's limit".to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pointer_finds_the_nearest_mark_or_none() {
        let events = [(2.0, ClimbEventKind::Climbed(1)), (2.5, ClimbEventKind::Lost(0))]
            .map(|(time_s, kind)| ClimbEvent { time_s, kind });
        let x_of = |time_s: f64| time_s as f32 * 10.0;
        assert_eq!(event_at(&events, 21.0, &x_of).as_deref(), Some("Step 1 climbed, 2.00 s"));
        assert_eq!(event_at(&events, 26.0, &x_of).as_deref(), Some("Fell off the stairs, 2.50 s"));
        assert_eq!(event_at(&events, 60.0, &x_of), None);
    }
}
