//! Exports charts as pictures or tables.

use std::path::PathBuf;

use crate::studio::commands::chart_export::{ChartExport, ChartFormat};
use snakes_core::save::{SavesFolder, encoded_csv, encoded_picture};
use snakes_lab::plot;
use snakes_lab::plot::Figure;

/// Writes a chart to the exports folder under a free name. If the chart is about the current run, the picture's title
/// includes the name of the run. Returns the file's path.
pub(crate) fn export(
    saves: &SavesFolder,
    export: &ChartExport,
    run: impl FnOnce() -> String,
) -> Result<PathBuf, String> {
    let ChartExport { figure, name, format, is_of_run } = export;
    let (ending, contents) = match format {
        ChartFormat::Png => {
            let titled = is_of_run.then(|| titled(figure, &run()));
            let picture = plot::figure(titled.as_ref().unwrap_or(figure));
            ("png", encoded_picture(&picture.map_err(|error| error.to_string())?))
        }
        ChartFormat::Csv => ("csv", encoded_csv(&figure.table())),
    };
    let contents = contents.map_err(|error| error.to_string())?;
    Ok(saves.exports().add_file(name, ending, &contents)?)
}

/// Adds the name of the run to the figure's title, because in the window the name is outside the chart.
fn titled(figure: &Figure, run: &str) -> Figure {
    Figure { title: format!("{} ({run})", figure.title), ..figure.clone() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use snakes_lab::plot::{Axis, Chart, Role, Series, Shape};
    use std::sync::Arc;

    #[test]
    fn charts_are_exported_under_free_names() {
        let folder = tempfile::tempdir().expect("a folder");
        let saves = SavesFolder::find(Some(folder.path()));
        let points = vec![[1.0, 2.0], [2.0, 3.5]];
        let (x, y) = (Axis::new("Generation", "", 0.0..=3.0), Axis::new("Fitness", "m", 0.0..=4.0));
        let series = vec![Series::new("best", Role::First, Shape::Line(points))];
        let chart = Chart::new(x, y, series);
        let figure = Arc::new(Figure::of("Fitness", chart));
        let write = |format| {
            let figure = Arc::clone(&figure);
            let of = ChartExport { figure, name: "fitness".to_owned(), format, is_of_run: true };
            export(&saves, &of, || "climb, seed 3".to_owned()).expect("written")
        };
        assert_eq!(write(ChartFormat::Csv), folder.path().join("exports/fitness-1.csv"));
        let table = write(ChartFormat::Csv);
        assert_eq!(table, folder.path().join("exports/fitness-2.csv"));
        let text = std::fs::read_to_string(table).expect("read");
        assert_eq!(text, "Generation,best (m)\n1,2\n2,3.5\n");
        let size = write(ChartFormat::Png).metadata().expect("there").len();
        assert!(size > 5_000, "{size} bytes are no picture");
        assert_eq!(titled(&figure, "climb, seed 3").title, "Fitness (climb, seed 3)");
    }
}
