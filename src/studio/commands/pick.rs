//! References to individuals that the stage can show.

use snakes_core::evolve::IndividualId;

/// Reference to an individual that the stage can show.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Pick {
    /// A champion with which the studio was opened; the first is 0.
    Opened(usize),
    /// The champion of this generation of the current run; the first is 1.
    Generation(u32),
    /// A member of the Pareto front of distance and energy.
    Front(IndividualId),
    /// The elite of the archive cell with this index.
    Elite(u32),
    /// The agent paired with these stairs in a run that evolves stairs; the first stairs are 0.
    Stairs(u32),
    /// An individual of the latest generation, a champion, or an ancestor of either.
    Individual(IndividualId),
}
