//! A figure as a large picture in the light theme, with its legend.

use std::error::Error;

use plotters::element::DashedPathElement;
use plotters::prelude::*;
use plotters::style::FontTransform;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::canvas::{Area, FAINT, FONT, INK, PlotError, TEXT_PIXELS, draw_on, text};
use super::colors::{BAND_OPACITY, color_of};
use super::figure::{Chart, Figure, Role, Series, Shape};
use super::labels::beside_line;
use super::series::{DASH, FigureAxes, paint_series};
use super::ticks::TickedAxis;
use snakes_core::save::Picture;

/// Width and height of the picture of a figure, in pixels.
const SIZE: (u32, u32) = (1600, 900);
const TITLE_PIXELS: u32 = 26;
/// Margin around the contents of a picture, in pixels.
const MARGIN: i32 = 24;
/// Height of a line of the legend, in pixels.
const LEGEND_LINE: i32 = 30;
/// Length of a sample in the legend, in pixels.
const SAMPLE: i32 = 34;
/// Padding around the name of a mark on its plate, in pixels.
const PLATE: f32 = 8.0;
/// Maximum length of a name below an axis, in characters. The rest is cut off.
const MAX_NAME_LENGTH: usize = 32;

/// Maximum number of numbers along the vertical axis.
const MOST_Y_TICKS: f64 = 10.0;

/// Draws a figure as a picture of the usual size.
///
/// # Errors
/// The plotting library failed.
pub fn figure(figure: &Figure) -> Result<Picture, PlotError> {
    figure_of_size(figure, SIZE)
}

/// Draws a figure as a picture of this width and height, in pixels.
pub(super) fn figure_of_size(figure: &Figure, size: (u32, u32)) -> Result<Picture, PlotError> {
    let mut picture = Picture::new(size.0, size.1);
    draw_on(&mut picture, |area| {
        area.fill(&WHITE)?;
        let title = (FONT, TITLE_PIXELS).into_font().color(&INK);
        area.draw(&Text::new(figure.title.as_str(), (MARGIN, MARGIN), title))?;
        let mut top = MARGIN + TITLE_PIXELS as i32 + 12;
        if !figure.note.is_empty() {
            let weak = color_of(Role::Others);
            area.draw(&Text::new(figure.note.as_str(), (MARGIN, top), text().color(&weak)))?;
            top += LEGEND_LINE;
        }
        let below = legend(area, figure, top)?;
        let (_, charts) = area.split_vertically(below);
        // The grid has as many columns as rows, so that the charts are as wide in shape as the picture.
        let columns = (1..=figure.charts.len()).find(|n| n * n >= figure.charts.len());
        let columns = columns.unwrap_or(1);
        let rows = figure.charts.len().div_ceil(columns);
        for (part, chart) in charts.split_evenly((rows, columns)).iter().zip(&figure.charts) {
            paint(part, chart)?;
        }
        Ok(())
    })?;
    Ok(picture)
}

/// Draws the legend from `top` downwards. Returns its lower end, in pixels.
fn legend(area: &Area, figure: &Figure, top: i32) -> Result<i32, Box<dyn Error>> {
    let text = text();
    let (mut x, mut y) = (MARGIN, top);
    let listed = figure.listed();
    for series in &listed {
        let (width, _) = area.estimate_text_size(&series.name, &text)?;
        let needed = SAMPLE + 10 + width as i32 + 28;
        if x + needed > area.dim_in_pixel().0 as i32 && x > MARGIN {
            (x, y) = (MARGIN, y + LEGEND_LINE);
        }
        sample(area, series, (x, y + TEXT_PIXELS as i32 / 2))?;
        area.draw(&Text::new(series.name.as_str(), (x + SAMPLE + 10, y), text.clone()))?;
        x += needed;
    }
    Ok(if listed.is_empty() { top } else { y + LEGEND_LINE })
}

/// Draws the sample of a series in the legend.
fn sample(area: &Area, series: &Series, (x, y): (i32, i32)) -> Result<(), Box<dyn Error>> {
    let color = color_of(series.role);
    let ends = [(x, y), (x + SAMPLE, y)];
    let block = [(x, y - 7), (x + SAMPLE, y + 7)];
    match &series.shape {
        Shape::Line(_) => area.draw(&PathElement::new(ends, color.stroke_width(3)))?,
        Shape::Dashed(_) => {
            let (on, off) = DASH;
            let style = color.stroke_width(2);
            area.draw(&DashedPathElement::new(ends, on, off, style))?;
        }
        Shape::Arrows(_) => {
            area.draw(&PathElement::new(ends, color.stroke_width(2)))?;
            let head = [(x + SAMPLE - 7, y - 5), (x + SAMPLE, y), (x + SAMPLE - 7, y + 5)];
            area.draw(&PathElement::new(head, color.stroke_width(2)))?;
        }
        Shape::Points(_) => area.draw(&Circle::new((x + SAMPLE / 2, y), 5, color.filled()))?,
        Shape::Band(_) => {
            area.draw(&Rectangle::new(block, color.mix(BAND_OPACITY.into()).filled()))?
        }
        Shape::Bars { .. } | Shape::Layer(_) | Shape::Boxes(_) => {
            area.draw(&Rectangle::new(block, color.filled()))?
        }
        Shape::Cells(_) => {
            for step in 0..SAMPLE {
                let color = color_of(Role::Share(step as f32 / (SAMPLE - 1) as f32));
                let line = [(x + step, y - 7), (x + step, y + 7)];
                area.draw(&PathElement::new(line, color.stroke_width(1)))?;
            }
        }
    }
    Ok(())
}

fn paint(area: &Area, chart: &Chart) -> Result<(), Box<dyn Error>> {
    let has_names = !chart.x.names.is_empty();
    let x = TickedAxis::new(&chart.x, if area.dim_in_pixel().0 > 800 { 12.0 } else { 6.0 });
    let y = TickedAxis::new(&chart.y, MOST_Y_TICKS);
    let (x_labels, y_labels) = (x.labels(), y.labels());
    let mut builder = ChartBuilder::on(area);
    builder.margin(MARGIN).y_label_area_size(78);
    builder.x_label_area_size(if has_names { names_height(area, chart)? } else { 48 });
    if !chart.name.is_empty() {
        builder.caption(&chart.name, text());
    }
    let mut axes = builder.build_cartesian_2d(x, y)?;
    let x_label = if has_names { String::new() } else { chart.x.label() };
    let x_text = |x: &f64| if has_names { String::new() } else { x_labels(x) };
    axes.configure_mesh()
        .x_label_formatter(&x_text)
        .x_desc(x_label)
        .y_label_formatter(&y_labels)
        .y_desc(chart.y.label())
        .light_line_style(WHITE)
        .bold_line_style(if has_names { WHITE } else { FAINT })
        .axis_style(INK)
        .label_style(text())
        .draw()?;
    for (place, name) in &chart.x.names {
        let upright = [(*place, *chart.y.range.start()), (*place, *chart.y.range.end())];
        axes.draw_series(LineSeries::new(upright, FAINT.stroke_width(1)))?;
        let (x, y) = axes.plotting_area().map_coordinate(&upright[0]);
        let short = short(name);
        let style = text().transform(FontTransform::Rotate270);
        let style = style.pos(Pos::new(HPos::Right, VPos::Center));
        let (left, top) = area.get_base_pixel();
        area.draw(&Text::new(short, (x - left, y - top + 10), style))?;
    }
    for series in &chart.series {
        paint_series(&mut axes, series)?;
    }
    for mark in &chart.marks {
        let ends = [(*chart.x.range.start(), mark.y), (*chart.x.range.end(), mark.y)];
        let dashes = DashedLineSeries::new(ends, DASH.0, DASH.1, color_of(Role::Others).into());
        axes.draw_series(dashes)?;
    }
    mark_labels(area, &axes, chart)
}

/// Shortens a name to fit below an axis.
fn short(name: &str) -> String {
    name.chars().take(MAX_NAME_LENGTH).collect()
}

/// Returns the height of the longest upright name below the x axis, with its distance from the axis, in pixels.
fn names_height(area: &Area, chart: &Chart) -> Result<u32, Box<dyn Error>> {
    let mut longest = 0;
    for (_, name) in &chart.x.names {
        longest = longest.max(area.estimate_text_size(&short(name), &text())?.0);
    }
    Ok(longest + 24)
}

/// Writes the names of the marks on plates beside their lines, where they hide little of the series.
fn mark_labels(
    area: &Area,
    axes: &FigureAxes<'_, '_>,
    chart: &Chart,
) -> Result<(), Box<dyn Error>> {
    let (left, top) = area.get_base_pixel();
    let pixel = |x: f64, y: f64| {
        let (x, y) = axes.plotting_area().map_coordinate(&(x, y));
        [(x - left) as f32, (y - top) as f32]
    };
    let line = |series: &Series| series.shape.points().iter().map(|&[x, y]| pixel(x, y)).collect();
    let lines: Vec<Vec<[f32; 2]>> = chart.series.iter().map(line).collect();
    let [from, to] = [
        pixel(*chart.x.range.start(), *chart.y.range.end()),
        pixel(*chart.x.range.end(), *chart.y.range.start()),
    ];
    let frame = [from[0], from[1], to[0], to[1]];
    let weak = color_of(Role::Others);
    let style = text().color(&weak);
    let mut taken = Vec::new();
    for mark in &chart.marks {
        let (width, height) = area.estimate_text_size(&mark.name, &style)?;
        let size = [width as f32 + PLATE * 2.0, height as f32 + PLATE];
        let y = pixel(*chart.x.range.start(), mark.y)[1];
        let place = beside_line(frame, size, y, &lines, &taken);
        taken.push(place);
        let [left, top, right, bottom] = place.map(|end| end as i32);
        area.draw(&Rectangle::new([(left, top), (right, bottom)], WHITE.mix(0.85).filled()))?;
        let corner = (left + PLATE as i32, top + PLATE as i32 / 2);
        area.draw(&Text::new(mark.name.as_str(), corner, style.clone()))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::{Axis, Mark, role_color};

    fn chart(name: &str, series: Vec<Series>) -> Chart {
        let (x, y) =
            (Axis::new("Generation", "", 0.0..=4.0), Axis::new("Fitness", "m", -1.0..=4.0));
        let marks = vec![Mark { name: "the first step".to_owned(), y: 3.0 }];
        Chart { marks, ..Chart::new(x, y, series).named(name) }
    }

    /// Counts the pixels of a picture that have the colour of a role.
    fn pixels(picture: &Picture, role: Role) -> usize {
        let color = role_color(role);
        picture.rgb.as_chunks::<3>().0.iter().filter(|pixel| **pixel == color).count()
    }

    #[test]
    fn every_shape_is_in_the_picture_in_its_colour() {
        let points = vec![[1.0, 1.0], [2.0, 2.0], [3.0, 1.0]];
        for (role, shape, fewest) in [
            (Role::First, Shape::Line(points.clone()), 1000),
            (Role::Second, Shape::Dashed(points.clone()), 500),
            (Role::Third, Shape::Points(points.clone()), 100),
            (Role::First, Shape::Bars { width: 0.5, bars: points }, 20_000),
            (Role::Second, Shape::Arrows(vec![[[1.0, 1.0], [9.0, 9.0]]]), 500),
            (Role::Share(1.0), Shape::Cells(vec![([1.0, 2.0, 1.0, 2.0], 1.0, 9.0)]), 20_000),
        ] {
            let name = format!("{shape:?}");
            let figure = Figure::of("Title", chart("", vec![Series::new("series", role, shape)]));
            let picture = super::figure(&figure).expect("drawn");
            assert_eq!((picture.width, picture.height), SIZE);
            let found = pixels(&picture, role);
            assert!(found > fewest, "{name}: {found} pixels");
        }
    }

    #[test]
    fn several_charts_are_drawn_and_names_below_them() {
        let line = |role| Series::new("series", role, Shape::Line(vec![[0.0, 0.0], [4.0, 3.0]]));
        let mut charts: Vec<Chart> = [Role::First, Role::Second, Role::Third, Role::Twist]
            .map(|role| chart("joint", vec![line(role)]))
            .into();
        charts[0].x.names = vec![(1.0, "density (kg/m³)".to_owned())];
        let figure = Figure::of_several("Torques", charts).with_note("Lines and dashes");
        let picture = super::figure(&figure).expect("drawn");
        for role in [Role::First, Role::Second, Role::Third, Role::Twist] {
            assert!(pixels(&picture, role) > 300, "{role:?}");
        }
    }

    #[test]
    fn an_empty_figure_is_a_picture_too() {
        let figure = Figure::of_several("Nothing", Vec::new());
        assert!(super::figure(&figure).is_ok());
    }
}
