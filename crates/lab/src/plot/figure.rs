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
    /// The same, dashed.
    Dashed(Vec<[f64; 2]>),
    /// Points.
    Points(Vec<[f64; 2]>),
    /// An area between a lower and an upper value at each x: `[x, lower, upper]`.
    Band(Vec<[f64; 3]>),
    /// A layer of a stack, in the same form. It covers what is behind it.
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
        Self { name: name.to_owned(), unit, range, names: Vec::new(), is_whole: false }
    }

    /// An axis of a count, such as generations, with whole numbers.
    pub fn count(name: &str, range: RangeInclusive<f64>) -> Self {
        Self { is_whole: true, ..Self::new(name, "", range) }
    }

    /// Name and unit.
    pub fn label(&self) -> String {
        with_unit(&self.name, self.unit)
    }

    /// The name at a position, if there is one.
    pub fn name_at(&self, position: f64) -> Option<&str> {
        let is_there = |(at, _): &&(f64, String)| (at - position).abs() < 1.0e-6;
        self.names.iter().find(is_there).map(|(_, name)| name.as_str())
    }
}

fn with_unit(name: &str, unit: &str) -> String {
    if unit.is_empty() { name.to_owned() } else { format!("{name} ({unit})") }
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

    /// The columns of its table, as suffixes to the name of the series.
    fn columns(&self) -> &'static [&'static str] {
        match self {
            Self::Line(_) | Self::Dashed(_) | Self::Points(_) | Self::Bars { .. } => &[""],
            Self::Band(_) | Self::Layer(_) => &[", lower end", ", upper end"],
            Self::Arrows(_) => &[", y from", ", x to", ", y to"],
            Self::Boxes(_) => &[", x to", ", y from", ", y to"],
            Self::Cells(_) => &[", x to", ", y from", ", y to", ""],
        }
    }

    /// Whether there is nothing to draw.
    fn is_empty(&self) -> bool {
        match self {
            Self::Line(points) | Self::Dashed(points) | Self::Points(points) => points.is_empty(),
            Self::Band(ends) | Self::Layer(ends) => ends.is_empty(),
            Self::Bars { bars, .. } => bars.is_empty(),
            Self::Arrows(arrows) => arrows.is_empty(),
            Self::Boxes(boxes) => boxes.is_empty(),
            Self::Cells(cells) => cells.is_empty(),
        }
    }

    /// The rows of its table: x, and a value for each column.
    fn rows(&self) -> Vec<(f64, Vec<f64>)> {
        match self {
            Self::Line(points) | Self::Dashed(points) | Self::Points(points) => {
                points.iter().map(|&[x, y]| (x, vec![y])).collect()
            }
            Self::Bars { bars, .. } => bars.iter().map(|&[x, y]| (x, vec![y])).collect(),
            Self::Band(ends) | Self::Layer(ends) => {
                ends.iter().map(|&[x, low, high]| (x, vec![low, high])).collect()
            }
            Self::Arrows(arrows) => {
                arrows.iter().map(|&[[x, y], [to_x, to_y]]| (x, vec![y, to_x, to_y])).collect()
            }
            Self::Boxes(boxes) => {
                let row = |&[left, right, bottom, top]: &[f64; 4]| (left, vec![right, bottom, top]);
                boxes.iter().map(row).collect()
            }
            Self::Cells(cells) => cells
                .iter()
                .map(|&([left, right, bottom, top], _, value)| {
                    (left, vec![right, bottom, top, value])
                })
                .collect(),
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

    /// The figure as a table, the first record its header: a column for each series, with its unit. If there are
    /// several charts, the first column names the chart.
    pub fn table(&self) -> Vec<Vec<String>> {
        if let Some(numbers) = &self.numbers {
            return numbers.clone();
        }
        let has_several_charts = self.charts.len() > 1;
        let mut heads: Vec<String> = Vec::new();
        let mut rows: Vec<Vec<(usize, String)>> = Vec::new();
        let column = |head: String, heads: &mut Vec<String>| {
            heads.iter().position(|known| *known == head).unwrap_or_else(|| {
                heads.push(head);
                heads.len() - 1
            })
        };
        for chart in &self.charts {
            let mut of_chart: Vec<Row> = Vec::new();
            let first: Vec<(usize, String)> = if has_several_charts {
                vec![(column("chart".to_owned(), &mut heads), chart.name.clone())]
            } else {
                Vec::new()
            };
            let x_column = column(chart.x.label(), &mut heads);
            for series in chart.series.iter().filter(|series| !series.name.is_empty()) {
                let name = &series.name;
                let heads_of_series: Vec<usize> = (series.shape.columns().iter())
                    .map(|end| column(with_unit(&(name.clone() + end), chart.y.unit), &mut heads))
                    .collect();
                for (x, values) in series.shape.rows() {
                    let cells = heads_of_series.iter().copied().zip(values).collect();
                    of_chart.push((x, cells));
                }
            }
            for row in merged(of_chart) {
                let x = chart.x.name_at(row.0).map_or(row.0.to_string(), str::to_owned);
                let values = row.1.into_iter().map(|(column, value)| (column, value.to_string()));
                rows.push(first.iter().cloned().chain([(x_column, x)]).chain(values).collect());
            }
        }
        let filled = rows.into_iter().map(|row| {
            let mut record = vec![String::new(); heads.len()];
            row.into_iter().for_each(|(column, text)| record[column] = text);
            record
        });
        let filled: Vec<Vec<String>> = filled.collect();
        [heads].into_iter().chain(filled).collect()
    }
}

/// A row of a table: x, and the columns with their values.
type Row = (f64, Vec<(usize, f64)>);

/// Joins rows of the same x, unless they have values in the same column.
fn merged(mut rows: Vec<Row>) -> Vec<Row> {
    rows.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut merged: Vec<Row> = Vec::new();
    let mut first_at_x = 0;
    for (x, cells) in rows {
        if merged.get(first_at_x).is_none_or(|row| row.0 != x) {
            first_at_x = merged.len();
        }
        let is_free = |row: &&mut Row| {
            cells.iter().all(|(column, _)| row.1.iter().all(|(taken, _)| taken != column))
        };
        match merged[first_at_x..].iter_mut().find(is_free) {
            Some(row) => row.1.extend(cells),
            None => merged.push((x, cells)),
        }
    }
    merged
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chart(name: &str, series: Vec<Series>) -> Chart {
        Chart {
            name: name.to_owned(),
            x: Axis::new("Generation", "", 1.0..=3.0),
            y: Axis::new("Fitness", "m", -8.0..=2.0),
            series,
            marks: Vec::new(),
        }
    }

    fn line(name: &str, points: &[[f64; 2]]) -> Series {
        Series::new(name, Role::First, Shape::Line(points.to_vec()))
    }

    #[test]
    fn a_table_has_a_column_with_its_unit_for_each_named_series() {
        let band = Series::new("middle half", Role::Others, Shape::Band(vec![[1.0, -8.0, -7.0]]));
        let best = line("best", &[[1.0, -6.5], [2.0, 1.25]]);
        let unnamed = line("", &[[3.0, 1.0]]);
        let figure = Figure::of("Fitness", chart("", vec![band, unnamed, best]));
        let head =
            ["Generation", "middle half, lower end (m)", "middle half, upper end (m)", "best (m)"];
        let expected = [head, ["1", "-8", "-7", "-6.5"], ["2", "", "", "1.25"]];
        assert_eq!(figure.table(), expected.map(|row| row.map(str::to_owned).to_vec()));
        assert!(!figure.is_empty());
    }

    #[test]
    fn points_at_the_same_x_have_a_row_each_and_charts_are_named() {
        let cloud = Shape::Points(vec![[1.0, 5.0], [1.0, 6.0], [2.0, 7.0]]);
        let charts = vec![
            chart(
                "joint 1",
                vec![Series::new("others", Role::Others, cloud), line("best", &[[1.0, 9.0]])],
            ),
            chart("joint 2", vec![line("best", &[[1.0, 8.0]])]),
        ];
        let table = Figure::of_several("", charts).table();
        let expected = [
            ["chart", "Generation", "others (m)", "best (m)"],
            ["joint 1", "1", "5", "9"],
            ["joint 1", "1", "6", ""],
            ["joint 1", "2", "7", ""],
            ["joint 2", "1", "", "8"],
        ];
        assert_eq!(table, expected.map(|row| row.map(str::to_owned).to_vec()));
    }

    #[test]
    fn a_legend_lists_each_name_once_and_only_few_shades() {
        let shades = |count| {
            (0..count).map(|index| {
                let shade = Role::Share(index as f32 / 20.0);
                Series::new(&format!("parent {index}"), shade, Shape::Line(Vec::new()))
            })
        };
        let others = [line("best", &[]), line("", &[]), line("best", &[])];
        let names = |count| {
            let series = shades(count).chain(others.clone()).collect();
            Figure::of("", chart("", series)).listed().len()
        };
        assert_eq!((names(0), names(8), names(9)), (1, 9, 1));
    }

    #[test]
    fn names_replace_numbers() {
        let mut chart = chart("", vec![line("parent", &[[0.0, 0.5]])]);
        chart.x.names = vec![(0.0, "density (kg/m³)".to_owned())];
        assert_eq!(Figure::of("", chart).table()[1], ["density (kg/m³)", "0.5"]);
    }
}
