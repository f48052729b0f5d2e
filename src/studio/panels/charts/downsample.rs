//! Downsampling of chart series for the screen. Exported files contain all points.

use egui_plot::PlotPoint;

use snakes_lab::plot::{Chart, Shape};

/// Maximum number of points of a drawn line: about one per pixel of the screen's width.
pub(super) const MAX_POINTS: usize = 1500;

/// A series of a chart, prepared for drawing. It is empty if the series is small, and drawn directly from its data.
#[derive(Debug, Clone, Default)]
pub(super) struct DrawnSeries {
    /// Points, connected or not; those of the upper edge of a layer.
    pub points: Vec<PlotPoint>,
    /// Positions along the horizontal axis of a band or layer, with its lower and upper ends.
    pub area: [Vec<f64>; 3],
}

/// Prepares all series of a chart for drawing, in their order.
pub(super) fn drawn(chart: &Chart) -> Vec<DrawnSeries> {
    let of_shape = |shape: &Shape| match shape {
        Shape::Line(points) | Shape::Dashed(points) => {
            DrawnSeries { points: line(points), ..Default::default() }
        }
        Shape::Points(points) => DrawnSeries {
            points: points.iter().map(|&at| at.into()).collect(),
            ..Default::default()
        },
        Shape::Band(ends) => DrawnSeries { area: band(ends), ..Default::default() },
        // Layers are downsampled together before they are stacked, so that they fit onto each other.
        Shape::Layer(ends) => DrawnSeries {
            points: ends.iter().map(|&[x, _, high]| [x, high].into()).collect(),
            area: [0, 1, 2].map(|index| ends.iter().map(|end| end[index]).collect()),
        },
        Shape::Bars { .. } | Shape::Arrows(_) | Shape::Boxes(_) | Shape::Cells(_) => {
            DrawnSeries::default()
        }
    };
    chart.series.iter().map(|series| of_shape(&series.shape)).collect()
}

/// Returns how many neighbouring points form a group, if each group is drawn with `each` points.
fn bucket(count: usize, each: usize) -> usize {
    if count <= MAX_POINTS { 1 } else { count.div_ceil(MAX_POINTS / each) }
}

/// Keeps the first and the last point and, of each group between them, the minimum and the maximum in their order, so
/// that no peak is lost.
fn line(points: &[[f64; 2]]) -> Vec<PlotPoint> {
    let size = bucket(points.len(), 2);
    let ([first, between @ .., last], 2..) = (points, size) else {
        return points.iter().map(|&at| at.into()).collect();
    };
    let extremes = between.chunks(size).flat_map(|neighbours| {
        let by_height = |a: &&[f64; 2], b: &&[f64; 2]| a[1].total_cmp(&b[1]);
        let (min, max) = (neighbours.iter().min_by(by_height), neighbours.iter().max_by(by_height));
        let is_in_order = min.map(|at| at[0]) <= max.map(|at| at[0]);
        let [first, second] = if is_in_order { [min, max] } else { [max, min] };
        [first, second.filter(|second| first != Some(second))]
    });
    let kept = [Some(first)].into_iter().chain(extremes).chain([Some(last)]);
    kept.flatten().map(|&at| at.into()).collect()
}

/// Keeps the lowest lower end and the highest upper end of each group.
fn band(ends: &[[f64; 3]]) -> [Vec<f64>; 3] {
    let mut drawn = [Vec::new(), Vec::new(), Vec::new()];
    let count = ends.chunks(bucket(ends.len(), 1)).len();
    for (index, neighbours) in ends.chunks(bucket(ends.len(), 1)).enumerate() {
        // The last position is always kept.
        let place = if index + 1 == count { neighbours.last() } else { neighbours.first() };
        let Some(place) = place else { continue };
        let low = neighbours.iter().map(|end| end[1]).fold(place[1], f64::min);
        let high = neighbours.iter().map(|end| end[2]).fold(place[2], f64::max);
        for (along, value) in drawn.iter_mut().zip([place[0], low, high]) {
            along.push(value);
        }
    }
    drawn
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_downsampled_line_keeps_its_peaks_ends_and_order() {
        let mut points: Vec<[f64; 2]> =
            (0..10_000).map(|x| [f64::from(x), f64::from(x % 7)]).collect();
        points[4321][1] = 99.0;
        points[8765][1] = -99.0;
        let drawn = line(&points);
        assert!(drawn.len() <= MAX_POINTS + 2, "{}", drawn.len());
        assert!(drawn.iter().any(|at| (at.x, at.y) == (4321.0, 99.0)));
        assert!(drawn.iter().any(|at| (at.x, at.y) == (8765.0, -99.0)));
        assert_eq!((drawn[0].x, drawn[drawn.len() - 1].x), (0.0, 9999.0));
        assert!(drawn.windows(2).all(|pair| pair[0].x < pair[1].x));
        let few = &points[..MAX_POINTS];
        assert_eq!(line(few).len(), few.len(), "short lines are drawn completely");
    }

    #[test]
    fn a_downsampled_band_keeps_its_lowest_and_highest_ends() {
        let mut ends: Vec<[f64; 3]> = (0..10_000).map(|x| [f64::from(x), 1.0, 2.0]).collect();
        ends[1234] = [1234.0, -5.0, 7.0];
        let [along, low, high] = band(&ends);
        assert!(along.len() <= MAX_POINTS && along.len() == low.len() && low.len() == high.len());
        assert!(low.contains(&-5.0) && high.contains(&7.0));
        assert_eq!((along[0], along[along.len() - 1]), (0.0, 9999.0));
        assert!(band(&[])[0].is_empty());
    }
}
