//! Drawing the series of a chart in a picture.

use std::error::Error;

use plotters::prelude::*;

use super::canvas::Canvas;
use super::colors::{BAND_OPACITY, color_of};
use super::figure::{Role, Series, Shape};
use super::ticks::TickedAxis;

/// Lengths of the dashes and of the gaps of a dashed line, in pixels.
pub(super) const DASH: (i32, i32) = (10, 7);

/// The axes of a chart in a picture.
pub(super) type FigureAxes<'a, 'b> =
    ChartContext<'a, Canvas<'b>, Cartesian2d<TickedAxis, TickedAxis>>;

/// Draws a series between the axes of its chart.
pub(super) fn paint_series(
    axes: &mut FigureAxes<'_, '_>,
    series: &Series,
) -> Result<(), Box<dyn Error>> {
    let color = color_of(series.role);
    let pairs =
        |points: &[[f64; 2]]| -> Vec<(f64, f64)> { points.iter().map(|&[x, y]| (x, y)).collect() };
    match &series.shape {
        Shape::Line(points) => {
            let dot = if points.len() <= 60 { 3 } else { 0 };
            let line = LineSeries::new(pairs(points), color.stroke_width(3)).point_size(dot);
            axes.draw_series(line)?;
        }
        Shape::Dashed(points) => {
            let style = color.stroke_width(2);
            axes.draw_series(DashedLineSeries::new(pairs(points), DASH.0, DASH.1, style))?;
        }
        Shape::Points(points) => {
            let is_crowd = series.role == Role::Others;
            let (radius, style) =
                if is_crowd { (2, color.mix(0.35)) } else { (5, color.to_rgba()) };
            let dots = pairs(points).into_iter();
            axes.draw_series(dots.map(|at| Circle::new(at, radius, style.filled())))?;
        }
        Shape::Band(ends) | Shape::Layer(ends) => {
            let above = ends.iter().map(|&[x, _, high]| (x, high));
            let below = ends.iter().rev().map(|&[x, low, _]| (x, low));
            let edge: Vec<(f64, f64)> = above.clone().chain(below).collect();
            let is_layer = matches!(series.shape, Shape::Layer(_));
            let opacity = if is_layer { 1.0 } else { BAND_OPACITY.into() };
            axes.draw_series([Polygon::new(edge, color.mix(opacity).filled())])?;
            if is_layer {
                // A white line separates layers of similar colours.
                axes.draw_series(LineSeries::new(above, WHITE.stroke_width(1)))?;
            }
        }
        Shape::Bars { width, bars } => {
            let half = width / 2.0;
            let rectangle = |&[x, height]: &[f64; 2]| {
                Rectangle::new([(x - half, 0.0), (x + half, height)], color.filled())
            };
            axes.draw_series(bars.iter().map(rectangle))?;
        }
        Shape::Arrows(arrows) => {
            for &[from, to] in arrows {
                let ends = [from, to].map(|[x, y]| (x, y));
                let style = color.stroke_width(2);
                axes.draw_series([PathElement::new(ends, style)])?;
                let [from, to] = ends.map(|end| axes.plotting_area().map_coordinate(&end));
                let head = arrow_head(from, to);
                axes.draw_series([EmptyElement::at(ends[1]) + PathElement::new(head, style)])?;
            }
        }
        Shape::Boxes(boxes) => {
            for &[left, right, bottom, top] in boxes {
                let ends = [(left, bottom), (right, top)];
                axes.draw_series([Rectangle::new(ends, color.filled())])?;
                // A white edge separates neighbours of the same colour.
                axes.draw_series([Rectangle::new(ends, WHITE.stroke_width(1))])?;
            }
        }
        Shape::Cells(cells) => {
            let rectangle = |&([left, right, bottom, top], share, _): &([f64; 4], f32, f64)| {
                let color = color_of(Role::Share(share));
                Rectangle::new([(left, bottom), (right, top)], color.filled())
            };
            axes.draw_series(cells.iter().map(rectangle))?;
        }
    }
    Ok(())
}

/// Returns the head of an arrow between two pixels, relative to its tip.
fn arrow_head(from: (i32, i32), to: (i32, i32)) -> [(i32, i32); 3] {
    const LENGTH: f64 = 12.0;
    let (x, y) = (f64::from(from.0 - to.0), f64::from(from.1 - to.1));
    let length = libm::hypot(x, y).max(1.0);
    let (x, y) = (x / length * LENGTH, y / length * LENGTH);
    let side = |sign: f64| ((x - sign * y * 0.5) as i32, (y + sign * x * 0.5) as i32);
    [side(1.0), (0, 0), side(-1.0)]
}
