//! References to individuals that the stage can show.

use snakes_core::evolve::IndividualId;

/// Reference to an individual that the stage can show.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Pick {
    /// A champion that the studio was opened with; the first is 0.
    Opened(usize),
    /// The champion of this generation of the current run; the first is 1.
    Generation(u32),
    /// A member of the Pareto front of distance and energy.
    Front {
        /// The generation that found it; the first is 1.
        generation: u32,
        /// Its index in that generation.
        individual: u32,
    },
    /// The elite of this cell of the archive.
    Elite(u32),
    /// The agent of these stairs, where stairs evolve; the first are 0.
    Stairs(u32),
    /// An individual of the latest generation, a champion, or an ancestor of either.
    Individual(IndividualId),
}
