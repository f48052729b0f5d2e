//! A figure as a table.

use super::figure::{Axis, Figure, Shape, with_unit};

impl Figure {
    /// Returns the figure as a table, the header first, with a column for each series. If there are several charts, the first
    /// column names the chart.
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
                let x = chart.x.text_at(row.0);
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

impl Shape {
    /// Returns the columns of the shape's table, as suffixes to the name of the series.
    fn columns(&self) -> &'static [&'static str] {
        match self {
            Self::Line(_) | Self::Dashed(_) | Self::Points(_) | Self::Bars { .. } => &[""],
            Self::Band(_) | Self::Layer(_) => &[", lower end", ", upper end"],
            Self::Arrows(_) => &[", y from", ", x to", ", y to"],
            Self::Boxes(_) => &[", x to", ", y from", ", y to"],
            Self::Cells(_) => &[", x to", ", y from", ", y to", ""],
        }
    }

    /// Returns the rows of the shape's table: x, and a value for each column.
    fn rows(&self) -> Vec<(f64, Vec<f64>)> {
        match self {
            Self::Line(_) | Self::Dashed(_) | Self::Points(_) | Self::Bars { .. } => {
                self.points().iter().map(|&[x, y]| (x, vec![y])).collect()
            }
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

impl Axis {
    /// Returns the text of a position in a table: its name if it has one, otherwise its number.
    fn text_at(&self, position: f64) -> String {
        let is_there = |(at, _): &&(f64, String)| (at - position).abs() < 1.0e-6;
        let name = self.names.iter().find(is_there).map(|(_, name)| name.clone());
        name.unwrap_or_else(|| self.number_at(position).to_string())
    }
}

/// A row of a table: its x, and indices of columns with their values.
type Row = (f64, Vec<(usize, f64)>);

/// Joins rows of equal x, unless they have values in the same column.
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
    use crate::plot::{Chart, Role, Series};

    fn chart(name: &str, series: Vec<Series>) -> Chart {
        let (x, y) =
            (Axis::new("Generation", "", 1.0..=3.0), Axis::new("Fitness", "m", -8.0..=2.0));
        Chart::new(x, y, series).named(name)
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
    fn names_replace_numbers() {
        let mut chart = chart("", vec![line("parent", &[[0.0, 0.5]])]);
        chart.x.names = vec![(0.0, "density (kg/m³)".to_owned())];
        assert_eq!(Figure::of("", chart).table()[1], ["density (kg/m³)", "0.5"]);
    }
}
