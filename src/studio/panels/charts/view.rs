//! A chart as it is drawn: its data, and who is where in it.

use std::fmt;
use std::sync::Arc;

use super::thin::{Drawn, drawn};
use crate::evolve::Place;
use crate::plot::Figure;
use crate::studio::casting::Pick;

/// A chart, worked out once for as long as what it shows stays the same.
#[derive(Debug, Clone)]
pub(super) struct View {
    /// What is shown, and can be written as a file.
    pub figure: Arc<Figure>,
    /// The series of each of its charts, as they go to the screen.
    pub drawn: Vec<Vec<Drawn>>,
    /// What can be pointed at in each of its charts.
    pub hits: Vec<Vec<Hit>>,
}

impl View {
    /// A view of one chart or several.
    pub fn new(figure: Figure, hits: Vec<Vec<Hit>>) -> Self {
        let drawn = figure.charts.iter().map(drawn).collect();
        Self { figure: Arc::new(figure), drawn, hits }
    }
}

/// Something in a chart that can be pointed at.
#[derive(Debug, Clone)]
pub(super) struct Hit {
    /// Where it is.
    pub target: Target,
    words: Words,
    /// Whom a click puts on the stage.
    pub pick: Option<Pick>,
    /// Who that is, if it is somebody of the current run.
    pub place: Option<Place>,
}

/// What there is to say of something: worked out when somebody points at it, since there may be ten thousand.
#[derive(Clone)]
struct Words(Arc<dyn Fn() -> String + Send + Sync>);

impl fmt::Debug for Words {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Debug::fmt(&(self.0)(), f)
    }
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
    pub fn new(target: Target, words: impl Fn() -> String + Send + Sync + 'static) -> Self {
        Self { target, words: Words(Arc::new(words)), pick: None, place: None }
    }

    /// Somebody to replay.
    pub fn of(
        target: Target,
        words: impl Fn() -> String + Send + Sync + 'static,
        pick: Pick,
        place: Place,
    ) -> Self {
        Self { pick: Some(pick), place: Some(place), ..Self::new(target, words) }
    }

    /// What stands beside the pointer.
    pub fn words(&self) -> String {
        (self.words.0)()
    }
}
