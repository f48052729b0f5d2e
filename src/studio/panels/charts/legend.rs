//! Legend of a chart: a sample and a name for each series, and a hint on what a click does.

use bevy_egui::egui::{self, Sense, Stroke};

use super::view::ChartView;
use crate::studio::ui::theme;
use snakes_lab::plot::{Series, Shape};

/// Draws the legend, which wraps between names. Marks are not in it, because they are labelled in the chart.
pub(super) fn legend(ui: &mut egui::Ui, view: &ChartView) {
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing = egui::vec2(theme::GAP, theme::GAP / 2.0);
        for series in view.figure.listed() {
            entry(ui, series);
        }
        let hint = hint(view);
        if !hint.is_empty() {
            let weak = theme::of(ui).text_weak;
            let text = egui::RichText::new(hint).small().italics().color(weak);
            // The hint moves to the next line as a whole.
            ui.add(egui::Label::new(text).extend());
        }
    });
}

/// Returns a hint on what a click does; empty if the chart has no hit targets.
fn hint(view: &ChartView) -> &'static str {
    let mut hits = view.hits.iter().flatten().peekable();
    let shapes = || view.figure.charts.iter().flat_map(|chart| &chart.series).map(|of| &of.shape);
    let has = |is_it: fn(&Shape) -> bool| shapes().any(is_it);
    if hits.peek().is_none() {
        ""
    } else if !hits.any(|hit| hit.pick.is_some()) {
        "Point at a line to read it."
    } else if has(|of| matches!(of, Shape::Cells(_))) {
        "Click a coloured cell to replay its snake."
    } else if has(|of| matches!(of, Shape::Layer(_))) {
        "Point at a band to read it. Click a point of the lines to replay that snake."
    } else if has(|of| matches!(of, Shape::Bars { .. })) {
        "Click a bar to replay its best snake."
    } else {
        "Click any point to replay that snake."
    }
}

fn entry(ui: &mut egui::Ui, series: &Series) {
    let color = theme::of(ui).text;
    let font = egui::TextStyle::Small.resolve(ui.style());
    let sample_size = egui::vec2(theme::SAMPLE_WIDTH, theme::SMALL_SIZE);
    let left = sample_size.x + theme::GAP / 2.0;
    // A long name wraps over several lines.
    let room = (ui.max_rect().width() - left).max(theme::SAMPLE_WIDTH);
    let name = ui.painter().layout(series.name.clone(), font, color, room);
    let size = egui::vec2(left + name.size().x, name.size().y);
    let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Label, true, &series.name));
    sample(ui, egui::Align2::LEFT_CENTER.align_size_within_rect(sample_size, rect), series);
    ui.painter().galley(egui::pos2(rect.left() + left, rect.top()), name, color);
}

/// Draws a sample of a series for the legend.
fn sample(ui: &egui::Ui, rect: egui::Rect, series: &Series) {
    let color = theme::of(ui).role(series.role);
    let (painter, y) = (ui.painter(), rect.center().y);
    let ends = [egui::pos2(rect.left(), y), egui::pos2(rect.right(), y)];
    match &series.shape {
        Shape::Line(_) => {
            painter.line_segment(ends, Stroke::new(2.0, color));
        }
        Shape::Dashed(_) => {
            painter.extend(egui::Shape::dashed_line(&ends, Stroke::new(1.5, color), 5.0, 3.0));
        }
        Shape::Arrows(_) => {
            painter.arrow(ends[0], ends[1] - ends[0], Stroke::new(1.5, color));
        }
        Shape::Points(_) => {
            painter.circle_filled(rect.center(), 3.0, color);
        }
        Shape::Band(_) => {
            painter.rect_filled(rect.shrink(1.0), 0.0, theme::of(ui).band(color));
        }
        Shape::Bars { .. } | Shape::Layer(_) | Shape::Boxes(_) => {
            painter.rect_filled(rect.shrink(1.0), 0.0, color);
        }
        Shape::Cells(_) => {
            let shades = 12;
            let width = rect.width() / shades as f32;
            for shade in 0..shades {
                let left = rect.left() + width * shade as f32;
                let part = egui::Rect::from_x_y_ranges(left..=left + width, rect.y_range());
                painter.rect_filled(
                    part,
                    0.0,
                    theme::palette::ramp(shade as f32 / (shades - 1) as f32),
                );
            }
        }
    }
}
