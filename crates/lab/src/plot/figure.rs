//! Charts as data. The window, the picture and the table of a chart use the same figure.

use std::ops::RangeInclusive;

use snakes_core::evolve::StrategyKind;

/// Maximum number of shades in a legend. If a figure has more, the legend lists none, because their order explains them.
const MAX_SHADES_LISTED: usize = 8;

/// Maximum number of bands in a legend, if lines of the same colours are listed, too.
const MAX_BANDS_LISTED: usize = 2;

/// One chart, or several charts that belong together.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// Title of the figure, a few words.
    pub title: String,
    /// Explanation in a sentence or two; may be empty.
    pub note: String,
    /// Charts of the figure, in reading order.
    pub charts: Vec<Chart>,
    /// Records of the figure's table, the header first. `None` if the table has the numbers of the charts.
    pub numbers: Option<Vec<Vec<String>>>,
}

/// Series that share a pair of axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Chart {
    /// Name of the chart within the figure; empty for the only chart.
    pub name: String,
    /// The horizontal axis, from left to right.
    pub x: Axis,
    /// The vertical axis, from the bottom up.
    pub y: Axis,
    /// Series of the chart. Later series are drawn over earlier ones.
    pub series: Vec<Series>,
    /// Reference values, drawn as horizontal dashed lines.
    pub marks: Vec<Mark>,
}

/// An axis of a chart.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// Name of the quantity.
    pub name: String,
    /// Unit of the quantity; empty for a count.
    pub unit: &'static str,
    /// Least and greatest position.
    pub range: RangeInclusive<f64>,
    /// Names that replace numbers, each with its position.
    pub names: Vec<(f64, String)>,
    /// Whether the quantity is a count, so that only whole numbers make sense.
    pub is_whole: bool,
    /// Whether positions are the decimal logarithms of the numbers on the labels.
    pub is_logarithmic: bool,
}

/// A reference value of a chart.
#[derive(Debug, Clone, PartialEq)]
pub struct Mark {
    /// Name of the reference value.
    pub name: String,
    /// Position on the vertical axis.
    pub y: f64,
}

/// Data that are drawn in one way and listed under one name.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// Name of the series. Empty for a visual aid, which appears in no legend and no table.
    pub name: String,
    /// Meaning of the series, which determines its colour.
    pub role: Role,
    /// Data and shape of the series.
    pub shape: Shape,
}

/// The data of a series, and how they are drawn.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// Points joined by straight lines: `[x, y]`.
    Line(Vec<[f64; 2]>),
    /// Points joined by dashed lines: `[x, y]`.
    Dashed(Vec<[f64; 2]>),
    /// Separate points: `[x, y]`.
    Points(Vec<[f64; 2]>),
    /// An area between a lower and an upper value at each x: `[x, lower, upper]`.
    Band(Vec<[f64; 3]>),
    /// A layer of a stack, which hides what is drawn before it: `[x, lower, upper]`.
    Layer(Vec<[f64; 3]>),
    /// Vertical bars that begin at zero.
    Bars {
        /// Width of each bar.
        width: f64,
        /// Centre and height of each bar.
        bars: Vec<[f64; 2]>,
    },
    /// Arrows: `[from, to]`, each `[x, y]`.
    Arrows(Vec<[[f64; 2]; 2]>),
    /// Rectangles in the colour of the series: `[left, right, bottom, top]`.
    Boxes(Vec<[f64; 4]>),
    /// Rectangles with values: `[left, right, bottom, top]`, the value scaled to 0 (least of all values) to 1 (greatest), and the
    /// value.
    Cells(Vec<([f64; 4], f32, f64)>),
}

/// Meaning of a series, which determines its colour.
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
    /// A value scaled to 0 (least) to 1 (greatest).
    Share(f32),
    /// A species of networks, given by its number.
    Species(u32),
    /// The first, third, fifth block of a snake, and so on.
    Red,
    /// The second, fourth block of a snake, and so on.
    Blue,
}

impl Axis {
    /// Creates an axis with numbers.
    pub fn new(name: &str, unit: &'static str, range: RangeInclusive<f64>) -> Self {
        let (name, names) = (name.to_owned(), Vec::new());
        Self { name, unit, range, names, is_whole: false, is_logarithmic: false }
    }

    /// Creates an axis with numbers whose range holds all finite values: see [`padded_range`].
    pub fn around(
        name: &str,
        unit: &'static str,
        values: impl IntoIterator<Item = f64>,
        least_width: f64,
    ) -> Self {
        Self::new(name, unit, padded_range(values, least_width).unwrap_or(0.0..=1.0))
    }

    /// Creates a logarithmic axis between two positive numbers, with labels at powers of ten.
    pub fn logarithmic(name: &str, unit: &'static str, range: RangeInclusive<f64>) -> Self {
        let decades = libm::log10(*range.start())..=libm::log10(*range.end());
        Self { is_whole: true, is_logarithmic: true, ..Self::new(name, unit, decades) }
    }

    /// Creates an axis of a count, such as generations, with whole numbers.
    pub fn count(name: &str, range: RangeInclusive<f64>) -> Self {
        Self { is_whole: true, ..Self::new(name, "", range) }
    }

    /// Returns the name with the unit.
    pub fn label(&self) -> String {
        with_unit(&self.name, self.unit)
    }

    /// Returns the position of a number on the axis.
    pub fn position_of(&self, number: f64) -> f64 {
        if self.is_logarithmic { libm::log10(number) } else { number }
    }

    /// Returns the number at a position of the axis.
    pub fn number_at(&self, position: f64) -> f64 {
        if self.is_logarithmic { libm::pow(10.0, position) } else { position }
    }
}

/// Returns a name with its unit in parentheses, or the name alone if the unit is blank.
pub fn with_unit(name: &str, unit: &str) -> String {
    match unit.trim() {
        "" => name.to_owned(),
        unit => format!("{name} ({unit})"),
    }
}

/// Returns the least and the greatest of the finite values, or `None` if there are no finite values.
pub fn extent(values: impl IntoIterator<Item = f64>) -> Option<[f64; 2]> {
    let finite = values.into_iter().filter(|value| value.is_finite());
    let ends = finite.map(|value| [value; 2]);
    ends.reduce(|[least, most], [value, _]| [least.min(value), most.max(value)])
}

/// Returns the range of the finite values with a margin, wider than `least_width`. `None` if there are no finite values.
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
    /// Creates the only chart of a figure, which needs no name, without reference values.
    pub fn new(x: Axis, y: Axis, series: Vec<Series>) -> Self {
        Self { name: String::new(), x, y, series, marks: Vec::new() }
    }

    /// Returns the chart with a name, for a figure of several charts.
    pub fn named(self, name: &str) -> Self {
        Self { name: name.to_owned(), ..self }
    }
}

impl Series {
    /// Creates a series.
    pub fn new(name: &str, role: Role, shape: Shape) -> Self {
        Self { name: name.to_owned(), role, shape }
    }
}

impl Shape {
    /// Returns the middle of the thickest part of a layer, and its thickness. `None` for other shapes.
    pub fn thickest(&self) -> Option<([f64; 2], f64)> {
        let Self::Layer(ends) = self else { return None };
        let thickness = |[_, low, high]: &[f64; 3]| high - low;
        let most = ends.iter().map(thickness).max_by(f64::total_cmp)?;
        let widest: Vec<&[f64; 3]> = ends.iter().filter(|end| thickness(end) >= most).collect();
        let [x, low, high] = *widest[widest.len() / 2];
        Some(([x, (low + high) / 2.0], most))
    }

    /// Returns the points of a line or a cloud, or centre and height of each bar. Empty for other shapes.
    pub fn points(&self) -> &[[f64; 2]] {
        match self {
            Self::Line(points) | Self::Dashed(points) | Self::Points(points) => points,
            Self::Bars { bars, .. } => bars,
            _ => &[],
        }
    }

    /// Returns whether there is nothing to draw.
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
    /// Creates a figure of one chart.
    pub fn of(title: &str, chart: Chart) -> Self {
        Self::of_several(title, vec![chart])
    }

    /// Creates a figure of several charts.
    pub fn of_several(title: &str, charts: Vec<Chart>) -> Self {
        Self { title: title.to_owned(), note: String::new(), charts, numbers: None }
    }

    /// Returns the figure with an explanation.
    pub fn with_note(self, note: impl Into<String>) -> Self {
        Self { note: note.into(), ..self }
    }

    /// Returns the figure with a table of other numbers than those of its charts, given as the heads of its columns and its
    /// records.
    pub fn with_numbers(
        self,
        heads: impl IntoIterator<Item = impl Into<String>>,
        records: impl IntoIterator<Item = Vec<String>>,
    ) -> Self {
        let heads = heads.into_iter().map(Into::into).collect();
        Self { numbers: Some([heads].into_iter().chain(records).collect()), ..self }
    }

    /// Returns whether the figure has nothing to draw.
    pub fn is_empty(&self) -> bool {
        self.charts.iter().flat_map(|chart| &chart.series).all(|series| series.shape.is_empty())
    }

    /// Returns the series that a legend lists: each name once; shades only if they are few; and bands only if they are few or no
    /// line has their colour.
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
