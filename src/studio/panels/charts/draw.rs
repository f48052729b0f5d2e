//! Draws a chart from its data: lines, points, bars, a legend; reads values out, and lets people click.

use bevy_egui::egui::{self, Color32, Pos2, Sense, Stroke};
use egui_plot::{
    Bar, BarChart, FilledArea, HLine, Line, LineStyle, PlotPoint, PlotPoints, PlotTransform,
    PlotUi, Points, Polygon, Text,
};

use super::thin::Drawn;
use super::view::{Hit, Target, View};
use crate::evolve::Place;
use crate::plot::{Chart, Figure, Role, Series, Shape};
use crate::studio::command::Command;
use crate::studio::look::{self, Palette};
use crate::studio::panels::axes::{axis_name, bounds, still};

/// How far beside a point a click still counts, in points of the screen.
const REACH: f32 = 16.0;
/// Up to so many points on a line each is marked.
const MOST_MARKED: usize = 30;

/// Draws a view over the width there is, as high as the room allows. `shown` is who is on the stage.
pub(super) fn draw(
    ui: &mut egui::Ui,
    id: &str,
    view: &View,
    height: f32,
    shown: Option<Place>,
    asked: &mut Vec<Command>,
) {
    legend(ui, &view.figure);
    let figure = &view.figure;
    let count = figure.charts.len();
    let width = ui.available_width();
    let columns = match count {
        0 | 1 => 1,
        _ => ((width / look::MULTIPLE_WIDTH) as usize).clamp(1, count),
    };
    let rows = count.div_ceil(columns).max(1);
    let size = egui::vec2(
        (width - look::GAP * (columns - 1) as f32) / columns as f32,
        if count > 1 { (height / rows as f32).max(look::MULTIPLE_HEIGHT) } else { height },
    );
    let indexed: Vec<(usize, &Chart)> = figure.charts.iter().enumerate().collect();
    for row in indexed.chunks(columns) {
        ui.horizontal_top(|ui| {
            ui.spacing_mut().item_spacing.x = look::GAP;
            for &(index, chart) in row {
                let hits = view.hits.get(index).map_or(&[][..], Vec::as_slice);
                ui.vertical(|ui| {
                    ui.set_width(size.x);
                    let drawn = view.drawn.get(index).map_or(&[][..], Vec::as_slice);
                    let (id, title) = (format!("{id} {index}"), figure.title.as_str());
                    let part = Part { id, title, chart, drawn };
                    part.ui(ui, hits, size.y, shown, asked);
                });
            }
        });
    }
    if !figure.note.is_empty() {
        ui.label(egui::RichText::new(&figure.note).color(look::of(ui).text_weak));
    }
}

/// One chart of a figure.
struct Part<'a> {
    id: String,
    title: &'a str,
    chart: &'a Chart,
    /// Its series as they go to the screen.
    drawn: &'a [Drawn],
}

impl Part<'_> {
    fn ui(
        &self,
        ui: &mut egui::Ui,
        hits: &[Hit],
        height: f32,
        shown: Option<Place>,
        asked: &mut Vec<Command>,
    ) {
        let chart = self.chart;
        let has_names = !chart.x.names.is_empty();
        let over = if has_names { chart.x.name.clone() } else { chart.x.label() };
        let name = if chart.name.is_empty() { String::new() } else { chart.name.clone() + ": " };
        let text = format!("{name}{}, over {}", chart.y.label(), lower(&over));
        let line = ui.add(egui::Label::new(axis_name(ui, &text)).truncate());
        let left = (height - line.rect.height() - look::GAP).max(look::LEAST_CHART_HEIGHT);
        let palette = look::of(ui);
        // The values are read out by this file.
        let plot = still(&self.id, left).label_formatter(|_| None).show_axes([!has_names, true]);
        let plot = plot.show(ui, |plot| {
            plot.set_plot_bounds(bounds(&chart.x.range, &chart.y.range));
            for (place, _) in &chart.x.names {
                let upright =
                    vec![[*place, *chart.y.range.start()], [*place, *chart.y.range.end()]];
                let line = Line::new("", upright).color(palette.field_hovered);
                plot.line(line.width(1.0).allow_hover(false));
            }
            let series = chart.series.iter().zip(self.drawn);
            series.for_each(|(series, drawn)| add(plot, series, drawn, palette));
            for mark in &chart.marks {
                let line = HLine::new(&mark.name, mark.y).color(palette.text_weak);
                plot.hline(line.allow_hover(false).style(LineStyle::dashed_dense()));
                let at = PlotPoint::new(*chart.x.range.start(), mark.y);
                let words = axis_text(&format!(" {}", mark.name), palette.text_weak);
                plot.text(Text::new(&mark.name, at, words).anchor(egui::Align2::LEFT_BOTTOM));
            }
        });
        let response = plot.response;
        let label = match chart.name.as_str() {
            "" => format!("Chart: {}", self.title),
            name => format!("Chart: {}, {name}", self.title),
        };
        response.widget_info(|| {
            egui::WidgetInfo::labeled(egui::WidgetType::Other, ui.is_enabled(), &label)
        });
        let painter = ui.painter_at(response.rect);
        let on_stage = hits.iter().find(|hit| shown.is_some() && hit.place == shown);
        if let Some(hit) = on_stage {
            ring(&painter, &plot.transform, hit, palette.second);
        }
        let at = response.interact_pointer_pos().or(response.hover_pos());
        let Some(hit) = at.and_then(|at| nearest(hits, &plot.transform, at)) else { return };
        ring(&painter, &plot.transform, hit, palette.text);
        if response.clicked()
            && let Some(pick) = hit.pick
        {
            let joins = ui.input(|input| input.modifiers.shift || input.modifiers.command);
            asked.push(if joins { Command::Join(pick) } else { Command::Show(pick) });
        }
        let replay =
            if hit.pick.is_some() { "\nClick to replay; with Shift, beside others" } else { "" };
        response.on_hover_text_at_pointer(hit.words() + replay);
    }
}

/// A name within a sentence: units stay as they are.
fn lower(name: &str) -> String {
    let mut letters = name.chars();
    letters
        .next()
        .map_or(String::new(), |first| first.to_lowercase().collect::<String>() + letters.as_str())
}

fn axis_text(text: &str, color: Color32) -> egui::RichText {
    egui::RichText::new(text).color(color).small()
}

/// Adds a series to a chart. Its points are borrowed: there may be many, and this happens in every frame.
fn add<'a>(plot: &mut PlotUi<'a>, series: &'a Series, drawn: &'a Drawn, palette: &Palette) {
    let color = palette.role(series.role);
    let borrowed = || match drawn {
        Drawn::Points(points) => PlotPoints::from(points.as_slice()),
        Drawn::Band(_) | Drawn::AsItIs => PlotPoints::default(),
    };
    match &series.shape {
        Shape::Line(points) => {
            let line = Line::new(&series.name, borrowed()).color(color);
            plot.line(line.width(2.0).allow_hover(false));
            if points.len() <= MOST_MARKED {
                let dots = Points::new(&series.name, borrowed()).color(color);
                plot.points(dots.radius(3.0).allow_hover(false));
            }
        }
        Shape::Dashed(_) => {
            let line = Line::new(&series.name, borrowed()).color(color);
            let line = line.style(LineStyle::dashed_dense()).width(1.5);
            plot.line(line.allow_hover(false));
        }
        Shape::Points(_) => {
            let is_crowd = series.role == Role::Others;
            let (radius, color) =
                if is_crowd { (1.5, color.gamma_multiply(0.45)) } else { (3.5, color) };
            let dots = Points::new(&series.name, borrowed()).color(color);
            plot.points(dots.radius(radius).allow_hover(false));
        }
        Shape::Band(_) => {
            let Drawn::Band([along, low, high]) = drawn else { return };
            let band = FilledArea::new(&series.name, along, low, high);
            plot.add(band.fill_color(color.gamma_multiply(0.2)).allow_hover(false));
        }
        Shape::Bars { width, bars } => {
            let bar = |&[x, height]: &[f64; 2]| Bar::new(x, height).width(width * 0.94).fill(color);
            let bars = BarChart::new(&series.name, bars.iter().map(bar).collect());
            plot.bar_chart(bars.color(color).allow_hover(false));
        }
        Shape::Cells(cells) => {
            for ([left, right, bottom, top], share, _) in cells {
                let corners =
                    vec![[*left, *bottom], [*right, *bottom], [*right, *top], [*left, *top]];
                let cell = Polygon::new("", corners).stroke(Stroke::NONE);
                let cell = cell.fill_color(palette.role(Role::Share(*share)));
                plot.polygon(cell.allow_hover(false));
            }
        }
    }
}

/// What of a chart is under the pointer.
fn nearest<'a>(hits: &'a [Hit], transform: &PlotTransform, at: Pos2) -> Option<&'a Hit> {
    let place = |[x, y]: [f64; 2]| transform.position_from_point(&PlotPoint::new(x, y));
    let distance = |hit: &Hit| match hit.target {
        Target::Point(point) => Some(place(point).distance(at)).filter(|far| *far <= REACH),
        // Of those in one column the nearest.
        Target::Column(point) => {
            let (aside, along) = ((place(point).x - at.x).abs(), (place(point).y - at.y).abs());
            (aside <= REACH).then_some(aside + along * 1.0e-3)
        }
        Target::Area([left, right, bottom, top]) => {
            let area = egui::Rect::from_two_pos(place([left, bottom]), place([right, top]));
            area.contains(at).then_some(0.0)
        }
    };
    let near = hits.iter().filter_map(|hit| Some((hit, distance(hit)?)));
    near.min_by(|(_, a), (_, b)| a.total_cmp(b)).map(|(hit, _)| hit)
}

/// Marks what is pointed at, or on the stage.
fn ring(painter: &egui::Painter, transform: &PlotTransform, hit: &Hit, color: Color32) {
    let place = |[x, y]: [f64; 2]| transform.position_from_point(&PlotPoint::new(x, y));
    let stroke = Stroke::new(2.0, color);
    match hit.target {
        Target::Point(point) | Target::Column(point) => {
            painter.circle_stroke(place(point), 6.0, stroke);
        }
        Target::Area([left, right, bottom, top]) => {
            let area = egui::Rect::from_two_pos(place([left, bottom]), place([right, top]));
            painter.rect_stroke(area, 0.0, stroke, egui::StrokeKind::Inside);
        }
    }
}

/// What is drawn how, in a line that wraps between names. Marks have theirs in the chart.
fn legend(ui: &mut egui::Ui, figure: &Figure) {
    let color = look::of(ui).text;
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing = egui::vec2(look::GAP, look::GAP / 2.0);
        for series in figure.listed() {
            let font = egui::TextStyle::Small.resolve(ui.style());
            let sample_size = egui::vec2(look::SAMPLE_WIDTH, look::SMALL_SIZE);
            let left = sample_size.x + look::GAP / 2.0;
            // One that is longer than a line has several.
            let room = (ui.max_rect().width() - left).max(look::SAMPLE_WIDTH);
            let name = ui.painter().layout(series.name.clone(), font, color, room);
            let size = egui::vec2(left + name.size().x, name.size().y);
            let (rect, response) = ui.allocate_exact_size(size, Sense::hover());
            response.widget_info(|| {
                egui::WidgetInfo::labeled(egui::WidgetType::Label, true, &series.name)
            });
            sample(ui, egui::Align2::LEFT_CENTER.align_size_within_rect(sample_size, rect), series);
            ui.painter().galley(egui::pos2(rect.left() + left, rect.top()), name, color);
        }
    });
}

/// A sample of how a series is drawn.
fn sample(ui: &egui::Ui, rect: egui::Rect, series: &Series) {
    let color = look::of(ui).role(series.role);
    let (painter, y) = (ui.painter(), rect.center().y);
    let ends = [egui::pos2(rect.left(), y), egui::pos2(rect.right(), y)];
    match &series.shape {
        Shape::Line(_) => {
            painter.line_segment(ends, Stroke::new(2.0, color));
        }
        Shape::Dashed(_) => {
            painter.extend(egui::Shape::dashed_line(&ends, Stroke::new(1.5, color), 5.0, 3.0));
        }
        Shape::Points(_) => {
            painter.circle_filled(rect.center(), 3.0, color);
        }
        Shape::Band(_) => {
            painter.rect_filled(rect.shrink(1.0), 0.0, color.gamma_multiply(0.3));
        }
        Shape::Bars { .. } => {
            painter.rect_filled(rect.shrink(1.0), 0.0, color);
        }
        Shape::Cells(_) => {
            let shades = 12;
            let width = rect.width() / shades as f32;
            for shade in 0..shades {
                let left = rect.left() + width * shade as f32;
                let part = egui::Rect::from_x_y_ranges(left..=left + width, rect.y_range());
                painter.rect_filled(part, 0.0, look::ramp(shade as f32 / (shades - 1) as f32));
            }
        }
    }
}

/// For tests: the place on the screen of a place in a chart whose area is `chart`.
#[cfg(test)]
pub(super) fn place_in(area: egui::Rect, chart: &Chart, [x, y]: [f64; 2]) -> Pos2 {
    let share = |value: f64, range: &std::ops::RangeInclusive<f64>| {
        ((value - range.start()) / (range.end() - range.start())) as f32
    };
    egui::pos2(
        area.left() + area.width() * share(x, &chart.x.range),
        area.bottom() - area.height() * share(y, &chart.y.range),
    )
}
