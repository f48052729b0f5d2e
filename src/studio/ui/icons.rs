//! Icon buttons. The icons are drawn, because no font has all of them in one style.

use bevy_egui::egui::{self, Color32, Pos2, Rect, Shape, Stroke, WidgetType};

use super::accessible::{named, named_selected};
use super::theme;
use snakes_core::schema::named_values;

named_values! {
    /// An icon of a button. Its name is its label for screen readers.
    pub enum Icon {
        ToStart = "Play from start";
        StepBack = "Previous step";
        Play = "Play";
        Pause = "Pause playback";
        StepForward = "Next step";
        Loop = "Loop";
        /// Reset a setting to the preset's value.
        Reset = "Reset";
        Undo = "Undo";
        Redo = "Redo";
        /// Show a setting at several values side by side.
        Sweep = "Sweep";
    }
}

/// Side length of an icon button, in points.
const SIDE: f32 = 28.0;
/// Side length of a small icon button, in points.
const SMALL_SIDE: f32 = 22.0;

impl Icon {
    /// Returns the shapes of the icon within a square.
    fn shapes(self, square: Rect, stroke: Stroke) -> Vec<Shape> {
        let at = |x: f32, y: f32| square.lerp_inside(egui::vec2(x, y));
        let filled = |points: Vec<Pos2>| Shape::convex_polygon(points, stroke.color, Stroke::NONE);
        let triangle = |from: f32, to: f32| filled(vec![at(from, 0.0), at(to, 0.5), at(from, 1.0)]);
        let bar = |from: f32, to: f32| {
            Shape::rect_filled(Rect::from_min_max(at(from, 0.0), at(to, 1.0)), 1.0, stroke.color)
        };
        match self {
            Self::Play => vec![triangle(0.1, 0.95)],
            Self::Pause => vec![bar(0.12, 0.38), bar(0.62, 0.88)],
            Self::StepForward => vec![triangle(0.1, 0.7), bar(0.75, 0.92)],
            Self::StepBack => vec![triangle(0.9, 0.3), bar(0.08, 0.25)],
            Self::ToStart => {
                vec![bar(0.0, 0.14), triangle(0.6, 0.16), triangle(1.05, 0.6)]
            }
            Self::Loop => round_arrow(square, stroke, false),
            Self::Reset => round_arrow(square, stroke, true),
            Self::Undo => turned_arrow(square, stroke, true),
            Self::Redo => turned_arrow(square, stroke, false),
            Self::Sweep => (0..4)
                .map(|index| {
                    let (left, top) = (0.05 + 0.25 * index as f32, 0.75 - 0.22 * index as f32);
                    let bar = Rect::from_min_max(at(left, top), at(left + 0.15, 0.95));
                    Shape::rect_filled(bar, 0.5, stroke.color)
                })
                .collect(),
        }
    }
}

/// Returns the shapes of three quarters of a circle with an arrow head. The arrow points clockwise, or counterclockwise if mirrored.
fn round_arrow(square: Rect, stroke: Stroke, is_mirrored: bool) -> Vec<Shape> {
    let (centre, radius) = (square.center(), square.width() * 0.46);
    let side = if is_mirrored { -1.0 } else { 1.0 };
    let on_circle = |turn: f32| {
        let (sin, cos) = libm::sincosf(turn * std::f32::consts::TAU);
        centre + egui::vec2(side * sin, -cos) * radius
    };
    let line = (0..=18).map(|part| on_circle(0.13 + 0.75 * part as f32 / 18.0));
    let end = on_circle(0.9);
    let head_size = radius * 0.62;
    let corner = |x: f32, y: f32| end + egui::vec2(side * x, y) * head_size;
    let head = vec![corner(-0.5, -0.75), corner(0.85, -0.1), corner(-0.35, 0.85)];
    let head = Shape::convex_polygon(head, stroke.color, Stroke::NONE);
    vec![Shape::line(line.collect(), stroke), head]
}

/// Returns the shapes of an arrow that starts at the bottom and turns to the left, or else to the right.
fn turned_arrow(square: Rect, stroke: Stroke, is_left: bool) -> Vec<Shape> {
    let at = |x: f32, y: f32| square.lerp_inside(egui::vec2(if is_left { x } else { 1.0 - x }, y));
    let line = (0..=12).map(|part| {
        let (sin, cos) = libm::sincosf(std::f32::consts::PI * part as f32 / 12.0);
        at(0.55 + 0.4 * sin, 0.6 - 0.32 * cos)
    });
    let line: Vec<Pos2> =
        std::iter::once(at(0.3, 0.28)).chain(line).chain([at(0.25, 0.92)]).collect();
    let head = vec![at(0.0, 0.28), at(0.36, 0.0), at(0.36, 0.56)];
    vec![Shape::line(line, stroke), Shape::convex_polygon(head, stroke.color, Stroke::NONE)]
}

/// Draws a small icon button. `label` tells screen readers its purpose.
pub(crate) fn small_icon_button(
    ui: &mut egui::Ui,
    icon: Icon,
    label: &str,
    hint: &str,
) -> egui::Response {
    let palette = theme::of(ui);
    let color = if ui.is_enabled() { palette.text } else { palette.text_weak.gamma_multiply(0.5) };
    let fills = [None, Some(palette.field_hovered)];
    let response = square_button(ui, icon, SMALL_SIDE, (0.55, Stroke::new(1.6, color)), fills);
    let response = named(response, WidgetType::Button, label);
    response.on_hover_text(hint).on_disabled_hover_text(hint)
}

/// Draws an icon button, highlighted if it is on.
pub(crate) fn icon_button(ui: &mut egui::Ui, icon: Icon, is_on: bool) -> egui::Response {
    let palette = theme::of(ui);
    let fills = match is_on {
        true => [palette.accent_soft; 2],
        false => [palette.field, palette.field_hovered],
    };
    let stroke = Stroke::new(2.0, palette.text);
    let response = square_button(ui, icon, SIDE, (0.42, stroke), fills.map(Some));
    named_selected(response, WidgetType::Button, is_on, icon.name())
}

/// Draws a square button of this side length in points, with an icon whose side is a share of the button's. The fills are the
/// background, and the background under the pointer.
fn square_button(
    ui: &mut egui::Ui,
    icon: Icon,
    side: f32,
    (share, stroke): (f32, Stroke),
    [fill, hovered_fill]: [Option<Color32>; 2],
) -> egui::Response {
    let (rect, response) = ui.allocate_exact_size(egui::Vec2::splat(side), egui::Sense::click());
    if ui.is_rect_visible(rect) {
        let corner = ui.visuals().widgets.inactive.corner_radius;
        if let Some(fill) = if response.hovered() { hovered_fill } else { fill } {
            ui.painter().rect_filled(rect, corner, fill);
        }
        if response.has_focus() {
            let stroke = Stroke::new(1.5, theme::of(ui).accent);
            ui.painter().rect_stroke(rect, corner, stroke, egui::StrokeKind::Inside);
        }
        let square = Rect::from_center_size(rect.center(), rect.size() * share);
        ui.painter().extend(icon.shapes(square, stroke));
    }
    response
}
