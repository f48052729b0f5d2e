//! Charts as files: a picture, or a table.

use std::path::PathBuf;
use std::sync::Arc;

use crate::plot::{self, Figure};
use crate::save::{SavesFolder, store_csv, store_picture};

/// A chart that is to be written.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Export {
    /// What is in it.
    pub figure: Arc<Figure>,
    /// How its file's name begins.
    pub name: &'static str,
    /// As what.
    pub format: Format,
}

/// What a chart can be written as.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Format {
    /// A picture of 1600 by 900 pixels.
    Png,
    /// A table.
    Csv,
}

/// Writes a chart into the folder for them, under a name that is not taken yet. Returns the file's path.
pub(super) fn export(saves: &SavesFolder, export: &Export) -> Result<PathBuf, String> {
    let Export { figure, name, format } = export;
    let folder = saves.exports();
    folder.prepare().map_err(|error| error.to_string())?;
    match format {
        Format::Png => {
            let path = folder.free_name(name, "png");
            let picture = plot::figure(figure).map_err(|error| error.to_string())?;
            store_picture(&path, &picture).map_err(|error| error.to_string())?;
            Ok(path)
        }
        Format::Csv => {
            let path = folder.free_name(name, "csv");
            store_csv(&path, &figure.table()).map_err(|error| error.to_string())?;
            Ok(path)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plot::{Axis, Chart, Role, Series, Shape};

    #[test]
    fn a_chart_becomes_a_picture_and_a_table_beside_those_before() {
        let folder = tempfile::tempdir().expect("a folder");
        let saves = SavesFolder::find(Some(folder.path()));
        let points = vec![[1.0, 2.0], [2.0, 3.5]];
        let chart = Chart {
            name: String::new(),
            x: Axis::new("Generation", "", 0.0..=3.0),
            y: Axis::new("Fitness", "m", 0.0..=4.0),
            series: vec![Series::new("best", Role::First, Shape::Line(points))],
            marks: Vec::new(),
        };
        let figure = Arc::new(Figure::of("Fitness", chart));
        let write = |format| {
            let of = Export { figure: Arc::clone(&figure), name: "fitness", format };
            export(&saves, &of).expect("written")
        };
        assert_eq!(write(Format::Csv), folder.path().join("exports/fitness-1.csv"));
        let table = write(Format::Csv);
        assert_eq!(table, folder.path().join("exports/fitness-2.csv"));
        let text = std::fs::read_to_string(table).expect("read");
        assert_eq!(text, "Generation,best (m)\n1,2\n2,3.5\n");
        let size = write(Format::Png).metadata().expect("there").len();
        assert!(size > 5_000, "{size} bytes are no picture");
    }
}
