//! Parents of individuals, as far as a strategy knows them. Nothing of a run depends on this.

/// An individual of a run, by its generation and index.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct IndividualId {
    /// Generation; the first is 1.
    pub generation: u32,
    /// Index within the generation; the first is 0.
    pub individual: u32,
}

/// The parents of an individual.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Parents {
    /// No parents: the genome was drawn at random.
    None,
    /// One, of which it is a copy, varied or not.
    One(IndividualId),
    /// Two. The first is the one that it resembles more, if there is a difference.
    Two(IndividualId, IndividualId),
    /// No single individual: it was drawn from a distribution that all earlier generations have shaped.
    Distribution,
    /// Not recorded, because an earlier session finished the generation of its parents.
    Unknown,
}

impl Parents {
    /// The ids of the parents, the first first.
    pub fn ids(self) -> impl Iterator<Item = IndividualId> {
        let (first, second) = match self {
            Self::One(first) => (Some(first), None),
            Self::Two(first, second) => (Some(first), Some(second)),
            Self::None | Self::Distribution | Self::Unknown => (None, None),
        };
        first.into_iter().chain(second)
    }
}
