//! A chart as it is drawn: its data, and who is where in it.

use std::sync::Arc;

use crate::evolve::Place;
use crate::plot::Figure;
use crate::studio::casting::Pick;

/// A chart, worked out once for as long as what it shows stays the same.
#[derive(Debug, Clone)]
pub(super) struct View {
    /// What is drawn, and can be written as a file.
    pub figure: Arc<Figure>,
    /// What can be pointed at in each of its charts.
    pub hits: Vec<Vec<Hit>>,
}

impl View {
    /// A view of one chart or several.
    pub fn new(figure: Figure, hits: Vec<Vec<Hit>>) -> Self {
        Self { figure: Arc::new(figure), hits }
    }
}

/// Something in a chart that can be pointed at.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Hit {
    /// Where it is.
    pub target: Target,
    /// What stands beside the pointer.
    pub words: String,
    /// Whom a click puts on the stage.
    pub pick: Option<Pick>,
    /// Who that is, if it is somebody of the current run.
    pub place: Option<Place>,
}

/// Where something is that can be pointed at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Target {
    /// At a point.
    Point([f64; 2]),
    /// At a point, and wherever is above or below it.
    Column([f64; 2]),
    /// Anywhere from and to in x, from and to in y.
    Area([f64; 4]),
}

impl Hit {
    /// Something to read.
    pub fn new(target: Target, words: String) -> Self {
        Self { target, words, pick: None, place: None }
    }

    /// Somebody to replay.
    pub fn of(target: Target, words: String, pick: Pick, place: Place) -> Self {
        Self { target, words, pick: Some(pick), place: Some(place) }
    }
}
