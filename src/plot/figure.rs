//! A chart as data: what a window draws, what becomes a picture, and what becomes a table are the same.

use std::ops::RangeInclusive;

use crate::evolve::StrategyKind;

/// A legend names so many shades; of more it names none, they say what they mean by their order.
const MOST_SHADES_LISTED: usize = 8;

/// One chart, or several that belong together.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// What it shows, in a few words.
    pub title: String,
    /// What else there is to say of it, in a sentence or two; may be empty.
    pub note: String,
    /// The charts, in reading order.
    pub charts: Vec<Chart>,
    /// Its table, where that is of other numbers than those that are drawn; the first record is the head.
    pub numbers: Option<Vec<Vec<String>>>,
}

/// What is drawn within one pair of axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Chart {
    /// What tells it from the others of its figure; empty for an only one.
    pub name: String,
    /// The axis from left to right.
    pub x: Axis,
    /// The axis from the bottom up.
    pub y: Axis,
    /// What is drawn, the hindmost first.
    pub series: Vec<Series>,
    /// Heights to compare with: dashed lines from left to right.
    pub marks: Vec<Mark>,
}

/// An axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// What it measures.
    pub name: String,
    /// In what; empty for a count.
    pub unit: &'static str,
    /// From where to where.
    pub range: RangeInclusive<f64>,
    /// Names in place of numbers, each at its place.
    pub names: Vec<(f64, String)>,
}

/// A height to compare with.
#[derive(Debug, Clone, PartialEq)]
pub struct Mark {
    /// What is there.
    pub name: String,
    /// Where it is.
    pub y: f64,
}

/// Something that is drawn, and listed under its name.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// What it is. Empty for what only helps the eye: it is in no legend and no table.
    pub name: String,
    /// What it means, which says its colour.
    pub role: Role,
    /// How it is drawn.
    pub shape: Shape,
}

/// How a series is drawn.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// Points joined by straight lines.
    Line(Vec<[f64; 2]>),
    /// The same, dashed.
    Dashed(Vec<[f64; 2]>),
    /// Points.
    Points(Vec<[f64; 2]>),
    /// From a lower to an upper end, at each x.
    Band(Vec<[f64; 3]>),
    /// Bars from nothing up: the middle of each, and its height.
    Bars {
        /// How wide each is.
        width: f64,
        /// The middle of each, and its height.
        bars: Vec<[f64; 2]>,
    },
    /// Rectangles: from and to in x, from and to in y, and where their value stands between the least and the most of
    /// all, from 0 to 1; and that value.
    Cells(Vec<([f64; 4], f32, f64)>),
}

/// What a series means.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Role {
    /// The best, or what it is all about.
    First,
    /// What stands beside it.
    Second,
    /// What stands beside both.
    Third,
    /// All the others.
    Others,
    /// A torque about the bend axis.
    Bend,
    /// A torque about the twist axis.
    Twist,
    /// A method.
    Strategy(StrategyKind),
    /// A value between the least, 0, and the most, 1.
    Share(f32),
}

impl Axis {
    /// An axis with numbers.
    pub fn new(name: &str, unit: &'static str, range: RangeInclusive<f64>) -> Self {
        Self { name: name.to_owned(), unit, range, names: Vec::new() }
    }

    /// Name and unit.
    pub fn label(&self) -> String {
        with_unit(&self.name, self.unit)
    }

    /// The name at a place, if places have names.
    pub fn name_at(&self, place: f64) -> Option<&str> {
        let is_there = |(at, _): &&(f64, String)| (at - place).abs() < 1.0e-6;
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
    /// What of a shape becomes columns of a table: what to add to the series' name in each column's head.
    fn columns(&self) -> &'static [&'static str] {
        match self {
            Self::Line(_) | Self::Dashed(_) | Self::Points(_) | Self::Bars { .. } => &[""],
            Self::Band(_) => &[", lower end", ", upper end"],
            Self::Cells(_) => &[", x to", ", y from", ", y to", ""],
        }
    }

    /// Whether there is nothing to draw.
    fn is_empty(&self) -> bool {
        match self {
            Self::Line(points) | Self::Dashed(points) | Self::Points(points) => points.is_empty(),
            Self::Band(ends) => ends.is_empty(),
            Self::Bars { bars, .. } => bars.is_empty(),
            Self::Cells(cells) => cells.is_empty(),
        }
    }

    /// Its rows: x, and a value for each column.
    fn rows(&self) -> Vec<(f64, Vec<f64>)> {
        match self {
            Self::Line(points) | Self::Dashed(points) | Self::Points(points) => {
                points.iter().map(|&[x, y]| (x, vec![y])).collect()
            }
            Self::Bars { bars, .. } => bars.iter().map(|&[x, y]| (x, vec![y])).collect(),
            Self::Band(ends) => ends.iter().map(|&[x, low, high]| (x, vec![low, high])).collect(),
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

    /// What a legend names: every name once, and of shades no more than a legend can hold.
    pub fn listed(&self) -> Vec<&Series> {
        let is_shade = |series: &Series| matches!(series.role, Role::Share(_));
        let all = || self.charts.iter().flat_map(|chart| &chart.series);
        let are_many = all().filter(|series| is_shade(series)).count() > MOST_SHADES_LISTED;
        let mut listed: Vec<&Series> = Vec::new();
        for series in all().filter(|series| !series.name.is_empty()) {
            let is_known = listed.iter().any(|known| known.name == series.name);
            let is_too_much = are_many && is_shade(series);
            if !is_known && !is_too_much {
                listed.push(series);
            }
        }
        listed
    }

    /// The figure as a table, its first record the head: a column for each series, with its unit. Of several charts
    /// the first column names the chart.
    pub fn table(&self) -> Vec<Vec<String>> {
        if let Some(numbers) = &self.numbers {
            return numbers.clone();
        }
        let are_several = self.charts.len() > 1;
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
            let first: Vec<(usize, String)> = if are_several {
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

/// What stands at an x: columns and their values.
type Row = (f64, Vec<(usize, f64)>);

/// Cells at one x in one row, as long as no two of them are of one column.
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
    fn a_table_has_a_column_for_each_series_with_a_name_and_its_unit() {
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
    fn points_at_one_place_have_a_row_each_and_charts_their_name() {
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
    fn a_legend_names_everything_once_and_not_too_many_shades() {
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
    fn names_stand_in_place_of_numbers() {
        let mut chart = chart("", vec![line("parent", &[[0.0, 0.5]])]);
        chart.x.names = vec![(0.0, "density (kg/m³)".to_owned())];
        assert_eq!(Figure::of("", chart).table()[1], ["density (kg/m³)", "0.5"]);
    }
}
