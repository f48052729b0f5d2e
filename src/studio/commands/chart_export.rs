//! Export of a chart to a file.

use std::sync::Arc;

use snakes_lab::plot::Figure;

/// Request to export a chart.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct ChartExport {
    /// Data of the chart.
    pub figure: Arc<Figure>,
    /// First part of the exported file's name.
    pub name: String,
    /// Format of the exported file.
    pub format: ChartFormat,
    /// Whether the chart shows the current run. The picture then includes the run's name.
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
