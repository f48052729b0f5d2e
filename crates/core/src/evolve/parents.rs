//! Parents of individuals, as far as a strategy knows them. They are only recorded: the results of a run do not depend on them.

/// Position of an individual in a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct IndividualId {
    /// Generation of the individual; the first is 1.
    pub generation: u32,
    /// Index within the generation; the first is 0.
    pub individual: u32,
}

/// Parents of an individual.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Parents {
    /// No parents: the genome was drawn at random.
    None,
    /// One parent: the genome is a copy of the parent's, varied or not.
    One(IndividualId),
    /// Two parents. If the child resembles one of them more, that parent is the first.
    Two(IndividualId, IndividualId),
    /// No individual: the genome was drawn from a distribution that all earlier generations have shaped.
    Distribution,
    /// The parents are not recorded, because the run was continued after their generation had finished.
    Unknown,
}

impl Parents {
    /// Returns the ids of the known parents, in order.
    pub fn ids(self) -> impl Iterator<Item = IndividualId> {
        let (first, second) = match self {
            Self::One(first) => (Some(first), None),
            Self::Two(first, second) => (Some(first), Some(second)),
            Self::None | Self::Distribution | Self::Unknown => (None, None),
        };
        first.into_iter().chain(second)
    }
}
