//! Who comes from whom: what a strategy knows of it, which changes nothing of what it does.

/// The place of an individual in its run.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Place {
    /// Generation; the first is 1.
    pub generation: u32,
    /// Index within the generation; the first is 0.
    pub individual: u32,
}

impl Place {
    /// The places of these individuals of a generation.
    pub(super) fn all(generation: u32, individuals: &[usize]) -> Vec<Self> {
        let place = |&individual: &usize| Self { generation, individual: individual as u32 };
        individuals.iter().map(place).collect()
    }
}

/// Whom an individual comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Parents {
    /// Nobody: it was drawn from nothing.
    Newborn,
    /// One, of which it is a copy, varied or not.
    One(Place),
    /// Two. The first is the one that it resembles more, if that can be said.
    Two(Place, Place),
    /// Nobody in particular: it was drawn from what the search had learned of all before.
    Distribution,
    /// Somebody of a generation that was finished before anybody wrote this down.
    Unknown,
}

impl Parents {
    /// The parents' places, the first first.
    pub fn places(self) -> impl Iterator<Item = Place> {
        let (first, second) = match self {
            Self::One(first) => (Some(first), None),
            Self::Two(first, second) => (Some(first), Some(second)),
            Self::Newborn | Self::Distribution | Self::Unknown => (None, None),
        };
        first.into_iter().chain(second)
    }
}
