//! Draws charts: series, legend, hover texts and clicks.

use bevy_egui::egui::{self, Color32, Pos2, Stroke};
use egui_plot::{
    Arrows, Bar, BarChart, FilledArea, HLine, Line, LineStyle, PlotPoint, PlotPoints,
    PlotTransform, PlotUi, Points, VLine,
};

use super::downsample::DrawnSeries;
use super::legend::legend;
use super::view::{ChartHit, ChartView, HitShape};
use crate::studio::commands::pick::Pick;
use crate::studio::panels::shown::ShownLane;
use crate::studio::ui::accessible::named;
use crate::studio::ui::buttons::show_or_join;
use crate::studio::ui::plot_axes::{bounds, fixed_plot, x_title, y_title};
use crate::studio::ui::theme::{self, Palette};
use snakes_lab::plot::{Chart, Role, Series, Shape, beside_line};

/// Maximum distance between a click and a point of the chart, in egui points.
const CLICK_DISTANCE: f32 = 16.0;
/// Padding of the plate behind the name of a mark, in egui points.
const MARK_PADDING: egui::Vec2 = egui::vec2(4.0, 1.0);
/// Space around the number of a species, in egui points.
const LAYER_PADDING: f32 = 2.0;
/// Length of an arrow's head, in egui points.
const ARROW_TIP: f32 = 7.0;
/// Maximum number of points on a line that are marked individually.
const MAX_MARKED_POINTS: usize = 30;

/// Draws a chart view in the available width and this height, in points. `shown` are the individuals on the stage.
pub(super) fn draw(
    ui: &mut egui::Ui,
    id: &str,
    view: &ChartView,
    height: f32,
    shown: &[ShownLane],
) {
    legend(ui, view);
    let figure = &view.figure;
    let count = figure.charts.len();
    let width = ui.available_width();
    let columns = match count {
        0 | 1 => 1,
        _ => ((width / theme::MULTIPLE_WIDTH) as usize).clamp(1, count),
    };
    let rows = count.div_ceil(columns).max(1);
    let size = egui::vec2(
        (width - theme::GAP * (columns - 1) as f32) / columns as f32,
        if count > 1 { (height / rows as f32).max(theme::MULTIPLE_HEIGHT) } else { height },
    );
    for row in (0..count).collect::<Vec<_>>().chunks(columns) {
        ui.horizontal_top(|ui| {
            ui.spacing_mut().item_spacing.x = theme::GAP;
            for &index in row {
                ui.vertical(|ui| {
                    ui.set_width(size.x);
                    part(ui, (view, index), &format!("{id} {index}"), size.y, shown);
                });
            }
        });
    }
    if !figure.note.is_empty() {
        ui.label(egui::RichText::new(&figure.note).color(theme::of(ui).text_weak));
    }
}

/// Draws the chart with this index of a view, this high in points.
fn part(
    ui: &mut egui::Ui,
    (view, index): (&ChartView, usize),
    id: &str,
    height: f32,
    shown: &[ShownLane],
) {
    let chart = &view.figure.charts[index];
    let hits = view.hits.get(index).map_or(&[][..], Vec::as_slice);
    let has_names = !chart.x.names.is_empty();
    let name = if chart.name.is_empty() { String::new() } else { chart.name.clone() + ": " };
    let above = y_title(ui, &format!("{name}{}", chart.y.label()));
    let titles = 2.0 * (above.rect.height() + ui.spacing().item_spacing.y);
    let left = (height - titles).max(theme::MIN_CHART_HEIGHT);
    let palette = theme::of(ui);
    // The hover text is drawn below instead of by the plot.
    let plot = fixed_plot(id, left, [&chart.x, &chart.y]).label_formatter(|_| None);
    let plot = plot.show_axes([!has_names, true]).show(ui, |plot| {
        plot.set_plot_bounds(bounds(&chart.x.range, &chart.y.range));
        for (place, _) in &chart.x.names {
            let line = VLine::new("", *place).color(palette.field_hovered);
            plot.vline(line.width(1.0).allow_hover(false));
        }
        let series = chart.series.iter().zip(&view.drawn[index]);
        series.for_each(|(series, drawn)| add(plot, series, drawn, palette));
        for mark in &chart.marks {
            let line = HLine::new(&mark.name, mark.y).color(palette.text_weak);
            plot.hline(line.allow_hover(false).style(LineStyle::dashed_dense()));
        }
    });
    x_title(ui, &if has_names { chart.x.name.clone() } else { chart.x.label() });
    let label = match chart.name.as_str() {
        "" => format!("Chart: {}", view.figure.title),
        name => format!("Chart: {}, {name}", view.figure.title),
    };
    let response = named(plot.response, egui::WidgetType::Other, &label);
    let painter = ui.painter_at(response.rect);
    let canvas = ChartCanvas { painter, transform: plot.transform, palette };
    canvas.cells(view, chart);
    canvas.mark_labels(chart, &view.drawn[index]);
    canvas.layer_labels(chart);
    for shown in shown {
        let is_shown = |hit: &&ChartHit| hit.place.map(Pick::Individual) == Some(shown.champion);
        let Some(hit) = hits.iter().find(is_shown) else { continue };
        match shown.color(palette) {
            Some(color) => canvas.lane_mark(hit.target, color),
            None => canvas.ring(hit.target, palette.second),
        }
    }
    let at = response.interact_pointer_pos().or(response.hover_pos());
    let Some(pointed) = at.and_then(|at| canvas.nearest(hits, at)) else { return };
    let hit = &hits[pointed];
    canvas.ring(hit.target, palette.text);
    if response.clicked()
        && let Some(pick) = hit.pick
    {
        show_or_join(ui, pick).send(ui);
    }
    let replay = if hit.pick.is_some() {
        "\nClick to replay. Shift-click to add it to the stage"
    } else {
        ""
    };
    response.on_hover_ui_at_pointer(|ui| {
        // egui gives texts the same width. A tooltip does not become narrower with its content.
        ui.set_max_width(ui.spacing().tooltip_width);
        view.pictures.large(ui, pointed);
        ui.label(hit.words() + replay);
    });
}

/// Where a chart is painted over its plot.
struct ChartCanvas<'a> {
    painter: egui::Painter,
    transform: PlotTransform,
    palette: &'a Palette,
}

impl ChartCanvas<'_> {
    /// Paints boxes, and cells with the bodies in them on a background of empty cells. Polygons of the plot would leave
    /// visible seams between neighbouring cells.
    fn cells(&self, view: &ChartView, chart: &Chart) {
        let Self { painter, transform, palette } = self;
        for series in &chart.series {
            if let Shape::Boxes(boxes) = &series.shape {
                // The edge keeps neighbouring blocks of the same colour apart.
                let (fill, edge) = (palette.role(series.role), Stroke::new(1.0, palette.field));
                for area in boxes.iter().map(|area| self.on_screen(HitShape::Area(*area))) {
                    painter.rect(area, 0.0, fill, edge, egui::StrokeKind::Middle);
                }
            }
            let Shape::Cells(cells) = &series.shape else { continue };
            painter.rect_filled(*transform.frame(), 0.0, palette.empty_cell);
            for (index, (area, share, _)) in cells.iter().enumerate() {
                let area = self.on_screen(HitShape::Area(*area));
                // A thin gap separates cells if they are large enough.
                let area = area.shrink(if area.size().min_elem() > 6.0 { 0.5 } else { 0.0 });
                let color = palette.role(Role::Share(*share));
                painter.rect_filled(area, 0.0, color);
                view.pictures.draw(painter, index, area, color);
            }
        }
    }

    /// Writes the names of the marks on plates beside their lines, at the places where they cover the least of the series.
    fn mark_labels(&self, chart: &Chart, drawn: &[DrawnSeries]) {
        let Self { painter, transform, palette } = self;
        if chart.marks.is_empty() {
            return;
        }
        let line = |of: &DrawnSeries| -> Vec<[f32; 2]> {
            of.points.iter().map(|point| transform.position_from_point(point).into()).collect()
        };
        let lines: Vec<_> = drawn.iter().map(line).collect();
        let frame = transform.frame();
        let area = [frame.left(), frame.top(), frame.right(), frame.bottom()];
        let mut taken = Vec::new();
        for mark in &chart.marks {
            let font = egui::FontId::proportional(theme::SMALL_SIZE);
            let text = painter.layout_no_wrap(mark.name.clone(), font, palette.text_weak);
            let size = text.size() + MARK_PADDING * 2.0;
            let y = transform.position_from_point(&PlotPoint::new(0.0, mark.y)).y;
            let place = beside_line(area, size.into(), y, &lines, &taken);
            taken.push(place);
            let plate = egui::Rect::from_min_size(egui::pos2(place[0], place[1]), size);
            painter.rect_filled(plate, 3.0, palette.panel.gamma_multiply(0.85));
            painter.galley(plate.min + MARK_PADDING, text, palette.text_weak);
        }
    }

    /// Returns the rectangle of a hit target on the screen. A point is a rectangle without extent.
    fn on_screen(&self, target: HitShape) -> egui::Rect {
        let place = |x: f64, y: f64| self.transform.position_from_point(&PlotPoint::new(x, y));
        match target {
            HitShape::Point([x, y]) | HitShape::Column([x, y]) => egui::Rect::from_pos(place(x, y)),
            HitShape::Area([left, right, bottom, top]) => {
                egui::Rect::from_two_pos(place(left, bottom), place(right, top))
            }
        }
    }

    /// Returns the index of the hit target under the pointer.
    fn nearest(&self, hits: &[ChartHit], at: Pos2) -> Option<usize> {
        let distance = |hit: &ChartHit| {
            let area = self.on_screen(hit.target);
            let way = at - area.center();
            match hit.target {
                HitShape::Point(_) => (way.length() <= CLICK_DISTANCE).then_some(way.length()),
                // The small vertical term selects the nearest point of a column.
                HitShape::Column(_) => {
                    (way.x.abs() <= CLICK_DISTANCE).then_some(way.x.abs() + way.y.abs() * 1.0e-3)
                }
                HitShape::Area(_) => area.contains(at).then_some(0.0),
            }
        };
        let near = hits.iter().enumerate().filter_map(|(index, hit)| Some((index, distance(hit)?)));
        near.min_by(|(_, a), (_, b)| a.total_cmp(b)).map(|(index, _)| index)
    }

    /// Marks an individual that is on the stage beside others by a dot in the colour of its lane.
    fn lane_mark(&self, target: HitShape, color: Color32) {
        if matches!(target, HitShape::Area(_)) {
            self.ring(target, color);
        }
        let at = self.on_screen(target).center();
        // The edge keeps the dot distinct from curves of a similar colour.
        let edge = Stroke::new(1.5, self.palette.panel);
        self.painter.circle(at, theme::LANE_DOT / 2.0, color, edge);
    }

    /// Draws a ring around the hovered target, or around an individual on the stage.
    fn ring(&self, target: HitShape, color: Color32) {
        let (area, stroke) = (self.on_screen(target), Stroke::new(2.0, color));
        match target {
            HitShape::Point(_) | HitShape::Column(_) => {
                self.painter.circle_stroke(area.center(), 6.0, stroke);
            }
            HitShape::Area(_) => {
                self.painter.rect_stroke(area, 0.0, stroke, egui::StrokeKind::Inside);
            }
        }
    }

    /// Writes the name of each layer, or its number without a name, where the layer is thickest, if there is room.
    fn layer_labels(&self, chart: &Chart) {
        let Self { painter, transform, palette } = self;
        let mut taken: Vec<egui::Rect> = Vec::new();
        for series in &chart.series {
            let Role::Species(number) = series.role else { continue };
            let Some(([x, y], thickness)) = series.shape.thickest() else { continue };
            let color = palette.role(series.role);
            let ink = theme::palette::text_on(color);
            let font = egui::FontId::proportional(theme::SMALL_SIZE);
            let name =
                if series.name.is_empty() { number.to_string() } else { series.name.clone() };
            let text = painter.layout_no_wrap(name, font, ink);
            let at = |y: f64| transform.position_from_point(&PlotPoint::new(x, y));
            let height = (at(y - thickness / 2.0).y - at(y + thickness / 2.0).y).abs();
            let area =
                egui::Rect::from_center_size(at(y), text.size() + egui::Vec2::splat(LAYER_PADDING));
            let is_covered = taken.iter().any(|other| other.intersects(area));
            if height < text.size().y || is_covered || !transform.frame().contains_rect(area) {
                continue;
            }
            taken.push(area);
            painter.galley(area.center() - text.size() / 2.0, text, ink);
        }
    }
}

/// Adds a series to a plot. The points are borrowed, because copying many of them in every frame would be slow.
fn add<'a>(plot: &mut PlotUi<'a>, series: &'a Series, drawn: &'a DrawnSeries, palette: &Palette) {
    let color = palette.role(series.role);
    let borrowed = || PlotPoints::from(drawn.points.as_slice());
    let [along, low, high] = &drawn.area;
    let line = |color, width| {
        Line::new(&series.name, borrowed()).color(color).width(width).allow_hover(false)
    };
    let dots = |color, radius| {
        Points::new(&series.name, borrowed()).color(color).radius(radius).allow_hover(false)
    };
    match &series.shape {
        Shape::Line(points) => {
            plot.line(line(color, 2.0));
            if points.len() <= MAX_MARKED_POINTS {
                plot.points(dots(color, 3.0));
            }
        }
        Shape::Dashed(_) => plot.line(line(color, 1.5).style(LineStyle::dashed_dense())),
        Shape::Points(_) if series.role == Role::Others => {
            plot.points(dots(color.gamma_multiply(0.45), 1.5));
        }
        Shape::Points(_) => plot.points(dots(color, 3.5)),
        Shape::Band(_) => {
            let band = FilledArea::new(&series.name, along, low, high);
            plot.add(band.fill_color(palette.band(color)).allow_hover(false));
        }
        Shape::Layer(_) => {
            let layer = FilledArea::new(&series.name, along, low, high);
            plot.add(layer.fill_color(color).allow_hover(false));
            // The edge keeps neighbouring layers of similar colours apart.
            plot.line(line(palette.field, 1.0));
        }
        Shape::Bars { width, bars } => {
            let bar = |&[x, height]: &[f64; 2]| Bar::new(x, height).width(width * 0.94).fill(color);
            let bars = BarChart::new(&series.name, bars.iter().map(bar).collect());
            plot.bar_chart(bars.color(color).allow_hover(false));
        }
        Shape::Arrows(arrows) => {
            let ends = |index: usize| -> PlotPoints<'_> {
                arrows.iter().map(|arrow| arrow[index]).collect()
            };
            let arrows = Arrows::new(&series.name, ends(0), ends(1)).color(color);
            plot.add(arrows.tip_length(ARROW_TIP).allow_hover(false));
        }
        // Boxes and cells are painted over the plot.
        Shape::Boxes(_) | Shape::Cells(_) => {}
    }
}

/// Returns the screen position of a chart position, for tests. `area` is the rectangle of the chart.
#[cfg(test)]
pub(super) fn screen_position(area: egui::Rect, chart: &Chart, [x, y]: [f64; 2]) -> Pos2 {
    let transform = PlotTransform::new(area, bounds(&chart.x.range, &chart.y.range), false);
    transform.position_from_point(&PlotPoint::new(x, y))
}
