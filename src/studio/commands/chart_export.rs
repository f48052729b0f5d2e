//! Export of a chart to a file.

use std::sync::Arc;

use snakes_lab::plot::Figure;

/// A chart to export.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ChartExport {
    /// The chart's data.
    pub figure: Arc<Figure>,
    /// First part of the file name.
    pub name: String,
    /// File format.
    pub format: ChartFormat,
    /// Whether it is about the current run, whose name the picture then has.
    pub is_of_run: bool,
}

/// A file format for charts.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum ChartFormat {
    /// PNG image of 1600 by 900 pixels.
    Png,
    /// CSV table.
    Csv,
}
