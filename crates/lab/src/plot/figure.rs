//! A chart as data: the window, the picture and the table of a chart all use the same figure.

use std::ops::RangeInclusive;

use snakes_core::evolve::StrategyKind;

/// Maximum number of shades that a legend lists; of more it lists none, because their order explains them.
const MAX_SHADES_LISTED: usize = 8;

/// Maximum number of bands that a legend lists beside the lines in their colours.
const MAX_BANDS_LISTED: usize = 2;

/// One chart, or several that belong together.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// Its title, a few words.
    pub title: String,
    /// An explanation in a sentence or two; may be empty.
    pub note: String,
    /// The charts, in reading order.
    pub charts: Vec<Chart>,
    /// Its table, if that has other numbers than the charts; the first record is the header.
    pub numbers: Option<Vec<Vec<String>>>,
}

/// Series within one pair of axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Chart {
    /// Its name within the figure; empty for the only one.
    pub name: String,
    /// The axis from left to right.
    pub x: Axis,
    /// The axis from the bottom up.
    pub y: Axis,
    /// The series, the rearmost first.
    pub series: Vec<Series>,
    /// Reference values: horizontal dashed lines.
    pub marks: Vec<Mark>,
}

/// An axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// The quantity.
    pub name: String,
    /// Its unit; empty for a count.
    pub unit: &'static str,
    /// Least and greatest value.
    pub range: RangeInclusive<f64>,
    /// Names in place of numbers, each with its position.
    pub names: Vec<(f64, String)>,
    /// Whether it counts, so that only whole numbers make sense.
    pub is_whole: bool,
    /// Whether positions are decimal logarithms of the numbers that labels show.
    pub is_logarithmic: bool,
}

/// A reference value.
#[derive(Debug, Clone, PartialEq)]
pub struct Mark {
    /// Its name.
    pub name: String,
    /// Its position on the y axis.
    pub y: f64,
}

/// Data that are drawn in one way and listed under one name.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// Its name. Empty for a visual aid, which appears in no legend and no table.
    pub name: String,
    /// Its meaning, which determines its colour.
    pub role: Role,
    /// Its shape.
    pub shape: Shape,
}

/// The data of a series, and how they are drawn.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// Points joined by straight lines.
    Line(Vec<[f64; 2]>),
    /// Points joined by dashed lines.
    Dashed(Vec<[f64; 2]>),
    /// Points.
    Points(Vec<[f64; 2]>),
    /// An area between a lower and an upper value at each x: `[x, lower, upper]`.
    Band(Vec<[f64; 3]>),
    /// A layer of a stack, which covers what is behind it: `[x, lower, upper]`.
    Layer(Vec<[f64; 3]>),
    /// Bars that begin at zero.
    Bars {
        /// Width of each bar.
        width: f64,
        /// Centre and height of each bar.
        bars: Vec<[f64; 2]>,
    },
    /// Arrows: from, to.
    Arrows(Vec<[[f64; 2]; 2]>),
    /// Rectangles in the colour of the series: `[left, right, bottom, top]`.
    Boxes(Vec<[f64; 4]>),
    /// Rectangles: `[left, right, bottom, top]`, the share of the value between the least and the greatest of all
    /// (0 to 1), and the value.
    Cells(Vec<([f64; 4], f32, f64)>),
}

/// Meaning of a series.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Role {
    /// The main series.
    First,
    /// A second series beside the main one.
    Second,
    /// A third series.
    Third,
    /// All other individuals or runs.
    Others,
    /// A torque about the bend axis.
    Bend,
    /// A torque about the twist axis.
    Twist,
    /// A learning method.
    Strategy(StrategyKind),
    /// A value between the least, 0, and the greatest, 1.
    Share(f32),
    /// A species of networks, by its number.
    Species(u32),
    /// The first block of a snake, its third, and so on.
    Red,
    /// The second, the fourth, and so on.
    Blue,
}

impl Axis {
    /// An axis with numbers.
    pub fn new(name: &str, unit: &'static str, range: RangeInclusive<f64>) -> Self {
        let (name, names) = (name.to_owned(), Vec::new());
        Self { name, unit, range, names, is_whole: false, is_logarithmic: false }
    }

    /// An axis with numbers around all finite values: see [`padded_range`].
    pub fn around(
        name: &str,
        unit: &'static str,
        values: impl IntoIterator<Item = f64>,
        least_width: f64,
    ) -> Self {
        Self::new(name, unit, padded_range(values, least_width).unwrap_or(0.0..=1.0))
    }

    /// An axis of equal ratios between two numbers, which are greater than zero, with labels at powers of ten.
    pub fn logarithmic(name: &str, unit: &'static str, range: RangeInclusive<f64>) -> Self {
        let decades = libm::log10(*range.start())..=libm::log10(*range.end());
        Self { is_whole: true, is_logarithmic: true, ..Self::new(name, unit, decades) }
    }

    /// An axis of a count, such as generations, with whole numbers.
    pub fn count(name: &str, range: RangeInclusive<f64>) -> Self {
        Self { is_whole: true, ..Self::new(name, "", range) }
    }

    /// Name and unit.
    pub fn label(&self) -> String {
        with_unit(&self.name, self.unit)
    }

    /// The position of a number.
    pub fn position_of(&self, number: f64) -> f64 {
        if self.is_logarithmic { libm::log10(number) } else { number }
    }

    /// The number at a position.
    pub fn number_at(&self, position: f64) -> f64 {
        if self.is_logarithmic { libm::pow(10.0, position) } else { position }
    }
}

/// A name with its unit in parentheses, unless the unit is empty or a space.
pub fn with_unit(name: &str, unit: &str) -> String {
    match unit.trim() {
        "" => name.to_owned(),
        unit => format!("{name} ({unit})"),
    }
}

/// The least and the greatest of the finite values; none if there are no such values.
pub fn extent(values: impl IntoIterator<Item = f64>) -> Option<[f64; 2]> {
    let finite = values.into_iter().filter(|value| value.is_finite());
    let ends = finite.map(|value| [value; 2]);
    ends.reduce(|[least, most], [value, _]| [least.min(value), most.max(value)])
}

/// The range of the finite values with a margin, at least `least_width` wide; none without finite values.
pub fn padded_range(
    values: impl IntoIterator<Item = f64>,
    least_width: f64,
) -> Option<RangeInclusive<f64>> {
    let [least, most] = extent(values)?;
    let missing = (least_width - (most - least)).max(0.0) / 2.0;
    let margin = missing + ((most - least) * 0.07).max(least_width * 0.07);
    Some(least - margin..=most + margin)
}

impl Chart {
    /// The only chart of a figure, which needs no name, without reference values.
    pub fn new(x: Axis, y: Axis, series: Vec<Series>) -> Self {
        Self { name: String::new(), x, y, series, marks: Vec::new() }
    }

    /// One of several charts, with its name.
    pub fn named(self, name: &str) -> Self {
        Self { name: name.to_owned(), ..self }
    }
}

impl Series {
    /// A series.
    pub fn new(name: &str, role: Role, shape: Shape) -> Self {
        Self { name: name.to_owned(), role, shape }
    }
}

impl Shape {
    /// The middle of the thickest part of a layer, and how thick that is; none for other shapes.
    pub fn thickest(&self) -> Option<([f64; 2], f64)> {
        let Self::Layer(ends) = self else { return None };
        let thickness = |[_, low, high]: &[f64; 3]| high - low;
        let most = ends.iter().map(thickness).max_by(f64::total_cmp)?;
        let widest: Vec<&[f64; 3]> = ends.iter().filter(|end| thickness(end) >= most).collect();
        let [x, low, high] = *widest[widest.len() / 2];
        Some(([x, (low + high) / 2.0], most))
    }

    /// The points of a line or a cloud, or centre and height of each bar; none of other shapes.
    pub fn points(&self) -> &[[f64; 2]] {
        match self {
            Self::Line(points) | Self::Dashed(points) | Self::Points(points) => points,
            Self::Bars { bars, .. } => bars,
            _ => &[],
        }
    }

    /// Whether there is nothing to draw.
    pub fn is_empty(&self) -> bool {
        match self {
            Self::Line(_) | Self::Dashed(_) | Self::Points(_) | Self::Bars { .. } => {
                self.points().is_empty()
            }
            Self::Band(ends) | Self::Layer(ends) => ends.is_empty(),
            Self::Arrows(arrows) => arrows.is_empty(),
            Self::Boxes(boxes) => boxes.is_empty(),
            Self::Cells(cells) => cells.is_empty(),
        }
    }
}

impl Figure {
    /// A figure of one chart.
    pub fn of(title: &str, chart: Chart) -> Self {
        Self::of_several(title, vec![chart])
    }

    /// A figure of several charts.
    pub fn of_several(title: &str, charts: Vec<Chart>) -> Self {
        Self { title: title.to_owned(), note: String::new(), charts, numbers: None }
    }

    /// The figure with an explanation.
    pub fn with_note(self, note: impl Into<String>) -> Self {
        Self { note: note.into(), ..self }
    }

    /// The figure with a table of other numbers than those of its charts: the heads of the columns, and the records.
    pub fn with_numbers(
        self,
        heads: impl IntoIterator<Item = impl Into<String>>,
        records: impl IntoIterator<Item = Vec<String>>,
    ) -> Self {
        let heads = heads.into_iter().map(Into::into).collect();
        Self { numbers: Some([heads].into_iter().chain(records).collect()), ..self }
    }

    /// Whether there is nothing in it to draw.
    pub fn is_empty(&self) -> bool {
        self.charts.iter().flat_map(|chart| &chart.series).all(|series| series.shape.is_empty())
    }

    /// The series that a legend lists: each name once, and shades only if there are few.
    pub fn listed(&self) -> Vec<&Series> {
        let is_shade = |series: &Series| matches!(series.role, Role::Share(_));
        let all = || self.charts.iter().flat_map(|chart| &chart.series);
        let are_many = all().filter(|series| is_shade(series)).count() > MAX_SHADES_LISTED;
        let is_band = |series: &Series| matches!(series.shape, Shape::Band(_));
        let is_of_line = |band: &Series| {
            let is_line = |of: &Series| matches!(of.shape, Shape::Line(_)) && !of.name.is_empty();
            is_band(band) && all().any(|other| other.role == band.role && is_line(other))
        };
        let bands_are_many = all().filter(|series| is_band(series)).count() > MAX_BANDS_LISTED;
        let mut listed: Vec<&Series> = Vec::new();
        for series in all().filter(|series| !series.name.is_empty()) {
            let is_known = listed.iter().any(|known| known.name == series.name);
            let is_too_much = are_many && is_shade(series) || bands_are_many && is_of_line(series);
            if !is_known && !is_too_much {
                listed.push(series);
            }
        }
        listed
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_legend_lists_each_name_once_and_only_few_shades() {
        let shades = |count| {
            (0..count).map(|index| {
                let shade = Role::Share(index as f32 / 20.0);
                Series::new(&format!("parent {index}"), shade, Shape::Line(Vec::new()))
            })
        };
        let line = |name: &str| Series::new(name, Role::First, Shape::Line(Vec::new()));
        let others = [line("best"), line(""), line("best")];
        let names = |count| {
            let series = shades(count).chain(others.clone()).collect();
            let axis = Axis::new("", "", 0.0..=1.0);
            Figure::of("", Chart::new(axis.clone(), axis, series)).listed().len()
        };
        assert_eq!((names(0), names(8), names(9)), (1, 9, 1));
    }

    #[test]
    fn a_padded_range_is_never_empty() {
        assert_eq!(padded_range([f64::NAN], 1.0), None);
        let range = padded_range([2.0, f64::INFINITY], 1.0).expect("a value");
        assert!(*range.start() <= 1.5 && *range.end() >= 2.5, "{range:?}");
    }
}
