//! A chart prepared for drawing: its data and its hit targets.

use std::sync::Arc;

use super::archive_pictures::ArchivePictures;
use super::downsample::{DrawnSeries, drawn};
use crate::studio::commands::pick::Pick;
use snakes_core::evolve::IndividualId;
use snakes_lab::plot::Figure;

/// A chart or figure that is computed once and cached until its data changes.
#[derive(Clone)]
pub(super) struct ChartView {
    /// Data of the figure, which is also exported.
    pub figure: Arc<Figure>,
    /// Series of each chart, prepared for drawing.
    pub drawn: Vec<Vec<DrawnSeries>>,
    /// Hit targets of each chart.
    pub hits: Vec<Vec<ChartHit>>,
    /// Pictures of the bodies in the cells of the chart, in their order. The first hit targets belong to the same cells.
    pub pictures: ArchivePictures,
    /// Whether the figure is about the current run.
    pub is_of_run: bool,
}

impl ChartView {
    /// Creates the view of one or several charts of the current run.
    pub fn new(figure: Figure, hits: Vec<Vec<ChartHit>>) -> Self {
        let drawn = figure.charts.iter().map(drawn).collect();
        let pictures = ArchivePictures::default();
        Self { figure: Arc::new(figure), drawn, hits, pictures, is_of_run: true }
    }
}

/// A part of a chart that has a hover text.
#[derive(Clone)]
pub(super) struct ChartHit {
    /// Position and shape of the hit target.
    pub target: HitShape,
    /// Computes the hover text on demand, because a chart may have ten thousand hit targets.
    words: Arc<dyn Fn() -> String + Send + Sync>,
    /// Individual that a click on the hit target replays, if any.
    pub pick: Option<Pick>,
    /// Place of the individual, if it belongs to the current run.
    pub place: Option<IndividualId>,
}

/// Position and shape of a hit target, in chart coordinates.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum HitShape {
    /// A point, with a small area around it.
    Point([f64; 2]),
    /// A point, with everything above and below it.
    Column([f64; 2]),
    /// A rectangle: left, right, bottom, top.
    Area([f64; 4]),
}

impl ChartHit {
    /// Creates a hit target with a hover text.
    pub fn new(target: HitShape, words: impl Fn() -> String + Send + Sync + 'static) -> Self {
        Self { target, words: Arc::new(words), pick: None, place: None }
    }

    /// Creates a hit target with a hover text. A click on it replays an individual.
    pub fn of(
        target: HitShape,
        words: impl Fn() -> String + Send + Sync + 'static,
        pick: Pick,
        place: IndividualId,
    ) -> Self {
        Self { pick: Some(pick), place: Some(place), ..Self::new(target, words) }
    }

    /// Returns the hover text.
    pub fn words(&self) -> String {
        (self.words)()
    }
}

/// Version of the data from which a view was computed.
pub(super) type Version = (u32, u64, usize, u64);

/// Names an individual of a run: "Generation 3, snake 12".
pub(super) fn generation_and_snake(of: IndividualId) -> String {
    format!("Generation {}, snake {}", of.generation, of.individual + 1)
}

/// Names an individual of a run within a sentence: "snake 12 of generation 3".
pub(super) fn snake_of_generation(of: IndividualId) -> String {
    format!("snake {} of generation {}", of.individual + 1, of.generation)
}
