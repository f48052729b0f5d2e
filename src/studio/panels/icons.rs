//! The buttons of a player, drawn: no font has these signs alike.

use bevy_egui::egui::{self, Pos2, Rect, Shape, Stroke, WidgetInfo, WidgetType};

use crate::studio::look;

/// A sign on a button.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Icon {
    ToStart,
    StepBack,
    Play,
    Hold,
    StepForward,
    Loop,
}

/// Side of a button, in points.
const SIDE: f32 = 28.0;

impl Icon {
    /// What a screen reader says.
    fn label(self) -> &'static str {
        match self {
            Self::ToStart => "From the start",
            Self::StepBack => "Step back",
            Self::Play => "Play",
            Self::Hold => "Hold",
            Self::StepForward => "Step forward",
            Self::Loop => "Loop",
        }
    }

    /// Its shapes within a square.
    fn shapes(self, square: Rect, stroke: Stroke) -> Vec<Shape> {
        let at = |x: f32, y: f32| square.lerp_inside(egui::vec2(x, y));
        let filled = |points: Vec<Pos2>| Shape::convex_polygon(points, stroke.color, Stroke::NONE);
        let triangle = |from: f32, to: f32| filled(vec![at(from, 0.0), at(to, 0.5), at(from, 1.0)]);
        let bar = |from: f32, to: f32| {
            Shape::rect_filled(Rect::from_min_max(at(from, 0.0), at(to, 1.0)), 1.0, stroke.color)
        };
        match self {
            Self::Play => vec![triangle(0.1, 0.95)],
            Self::Hold => vec![bar(0.12, 0.38), bar(0.62, 0.88)],
            Self::StepForward => vec![triangle(0.1, 0.7), bar(0.75, 0.92)],
            Self::StepBack => vec![triangle(0.9, 0.3), bar(0.08, 0.25)],
            Self::ToStart => {
                vec![bar(0.0, 0.14), triangle(0.6, 0.16), triangle(1.05, 0.6)]
            }
            Self::Loop => {
                // Three quarters of a circle, and the head of an arrow at its end.
                let (centre, radius) = (square.center(), square.width() * 0.46);
                let on_circle = |turn: f32| {
                    let (sin, cos) = libm::sincosf(turn * std::f32::consts::TAU);
                    centre + egui::vec2(sin, -cos) * radius
                };
                let line = (0..=18).map(|part| on_circle(0.13 + 0.75 * part as f32 / 18.0));
                let end = on_circle(0.9);
                let side = radius * 0.62;
                let head = vec![
                    end + egui::vec2(-side * 0.5, -side * 0.75),
                    end + egui::vec2(side * 0.85, -side * 0.1),
                    end + egui::vec2(-side * 0.35, side * 0.85),
                ];
                vec![Shape::line(line.collect(), stroke), filled(head)]
            }
        }
    }
}

/// A button with a sign.
pub(super) fn icon_button(
    ui: &mut egui::Ui,
    icon: Icon,
    is_on: bool,
    hint: &str,
) -> egui::Response {
    let palette = look::of(ui);
    let (rect, response) = ui.allocate_exact_size(egui::Vec2::splat(SIDE), egui::Sense::click());
    response.widget_info(|| {
        WidgetInfo::selected(WidgetType::Button, ui.is_enabled(), is_on, icon.label())
    });
    if ui.is_rect_visible(rect) {
        let fill = match (is_on, response.hovered()) {
            (true, _) => palette.accent_soft,
            (false, true) => palette.field_hovered,
            (false, false) => palette.field,
        };
        let corner = ui.visuals().widgets.inactive.corner_radius;
        ui.painter().rect_filled(rect, corner, fill);
        if response.has_focus() {
            let stroke = Stroke::new(1.5, palette.accent);
            ui.painter().rect_stroke(rect, corner, stroke, egui::StrokeKind::Inside);
        }
        let square = Rect::from_center_size(rect.center(), egui::Vec2::splat(SIDE * 0.42));
        ui.painter().extend(icon.shapes(square, Stroke::new(2.0, palette.text)));
    }
    response.on_hover_text(hint)
}
