//! Numbers of species, written into their layers of a stack.

use bevy_egui::egui;
use egui_plot::{PlotPoint, PlotTransform};

use crate::studio::ui::theme;
use crate::studio::ui::theme::Palette;
use snakes_lab::plot::{Chart, Role};

/// Space around the number of a species, in points.
const PADDING: f32 = 2.0;

/// Writes the number of each species where its layer is thickest, if there is room.
pub(super) fn layer_labels(
    painter: &egui::Painter,
    transform: &PlotTransform,
    chart: &Chart,
    palette: &Palette,
) {
    let mut taken: Vec<egui::Rect> = Vec::new();
    for series in &chart.series {
        let Role::Species(number) = series.role else { continue };
        let Some(([x, y], thickness)) = series.shape.thickest() else { continue };
        let color = palette.role(series.role);
        let ink = theme::palette::text_on(color);
        let font = egui::FontId::proportional(theme::SMALL_SIZE);
        let text = painter.layout_no_wrap(number.to_string(), font, ink);
        let at = |y: f64| transform.position_from_point(&PlotPoint::new(x, y));
        let height = (at(y - thickness / 2.0).y - at(y + thickness / 2.0).y).abs();
        let area = egui::Rect::from_center_size(at(y), text.size() + egui::Vec2::splat(PADDING));
        let is_covered = taken.iter().any(|other| other.intersects(area));
        if height < text.size().y || is_covered || !transform.frame().contains_rect(area) {
            continue;
        }
        taken.push(area);
        painter.galley(area.center() - text.size() / 2.0, text, ink);
    }
}
