//! A chart's series as they go to the screen: in the form the plot borrows, and no more points than anybody can tell
//! apart. Files have them all.

use egui_plot::PlotPoint;

use crate::plot::{Chart, Shape};

/// A line is drawn with so many points at most: more than one for each point of the screen's width.
pub(super) const MOST_POINTS: usize = 1500;

/// A series as it is drawn.
#[derive(Debug, Clone)]
pub(super) enum Drawn {
    /// Points, joined or not.
    Points(Vec<PlotPoint>),
    /// The places of a band, its lower and its upper ends.
    Band([Vec<f64>; 3]),
    /// It is drawn from its data: there is little of it.
    AsItIs,
}

/// The series of a chart as they are drawn, in their order.
pub(super) fn drawn(chart: &Chart) -> Vec<Drawn> {
    let of_shape = |shape: &Shape| match shape {
        Shape::Line(points) | Shape::Dashed(points) => Drawn::Points(line(points)),
        Shape::Points(points) => Drawn::Points(points.iter().map(|&at| at.into()).collect()),
        Shape::Band(ends) => Drawn::Band(band(ends)),
        Shape::Bars { .. } | Shape::Cells(_) => Drawn::AsItIs,
    };
    chart.series.iter().map(|series| of_shape(&series.shape)).collect()
}

/// How many neighbours become one, if each of them is to be drawn with `each` points.
fn bucket(count: usize, each: usize) -> usize {
    if count <= MOST_POINTS { 1 } else { count.div_ceil(MOST_POINTS / each) }
}

/// Of neighbours the least and the most, in their order, so that no peak is lost.
fn line(points: &[[f64; 2]]) -> Vec<PlotPoint> {
    let size = bucket(points.len(), 2);
    if size == 1 {
        return points.iter().map(|&at| at.into()).collect();
    }
    let extremes = points.chunks(size).flat_map(|neighbours| {
        let by_height = |a: &&[f64; 2], b: &&[f64; 2]| a[1].total_cmp(&b[1]);
        let (least, most) =
            (neighbours.iter().min_by(by_height), neighbours.iter().max_by(by_height));
        let is_in_order = least.map(|at| at[0]) <= most.map(|at| at[0]);
        let [first, second] = if is_in_order { [least, most] } else { [most, least] };
        [first, second.filter(|second| first != Some(second))]
    });
    let mut drawn: Vec<PlotPoint> = extremes.flatten().map(|&at| at.into()).collect();
    // It reaches as far as all of it.
    if let (Some(&first), Some(&last)) = (points.first(), points.last()) {
        if drawn.first().is_some_and(|at| at.x > first[0]) {
            drawn.insert(0, first.into());
        }
        if drawn.last().is_some_and(|at| at.x < last[0]) {
            drawn.push(last.into());
        }
    }
    drawn
}

/// Of neighbours the lowest and the highest end.
fn band(ends: &[[f64; 3]]) -> [Vec<f64>; 3] {
    let mut drawn = [Vec::new(), Vec::new(), Vec::new()];
    let count = ends.chunks(bucket(ends.len(), 1)).len();
    for (index, neighbours) in ends.chunks(bucket(ends.len(), 1)).enumerate() {
        // It reaches as far as all of it.
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
    fn a_long_line_keeps_its_peaks_its_ends_and_its_order() {
        let mut points: Vec<[f64; 2]> =
            (0..10_000).map(|x| [f64::from(x), f64::from(x % 7)]).collect();
        points[4321][1] = 99.0;
        points[8765][1] = -99.0;
        let drawn = line(&points);
        assert!(drawn.len() <= MOST_POINTS + 2, "{}", drawn.len());
        assert!(drawn.iter().any(|at| (at.x, at.y) == (4321.0, 99.0)));
        assert!(drawn.iter().any(|at| (at.x, at.y) == (8765.0, -99.0)));
        assert_eq!((drawn[0].x, drawn[drawn.len() - 1].x), (0.0, 9999.0));
        assert!(drawn.windows(2).all(|pair| pair[0].x < pair[1].x));
        let few = &points[..MOST_POINTS];
        assert_eq!(line(few).len(), few.len(), "what can be told apart is drawn");
    }

    #[test]
    fn a_long_band_keeps_its_lowest_and_its_highest_end() {
        let mut ends: Vec<[f64; 3]> = (0..10_000).map(|x| [f64::from(x), 1.0, 2.0]).collect();
        ends[1234] = [1234.0, -5.0, 7.0];
        let [along, low, high] = band(&ends);
        assert!(along.len() <= MOST_POINTS && along.len() == low.len() && low.len() == high.len());
        assert!(low.contains(&-5.0) && high.contains(&7.0));
        assert_eq!((along[0], along[along.len() - 1]), (0.0, 9999.0));
        assert!(band(&[])[0].is_empty());
    }
}
