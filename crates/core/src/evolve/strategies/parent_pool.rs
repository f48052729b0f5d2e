//! Individuals of the last generation that may become parents.

use crate::evolve::parents::{IndividualId, Parents};

/// Possible parents of the next generation, best first.
#[derive(Debug, Clone)]
pub struct ParentPool<M> {
    /// Individuals that may become parents; empty before the first generation.
    pub members: Vec<M>,
    /// Ids of the members, in the same order; empty if they are unknown.
    ids: Vec<IndividualId>,
}

impl<M> ParentPool<M> {
    /// Makes a pool of members whose ids are unknown.
    pub fn unknown(members: Vec<M>) -> Self {
        Self { members, ids: Vec::new() }
    }

    /// Makes a pool of the individuals of a generation with the given indices.
    pub fn chosen(generation: u32, indices: &[usize], member: impl FnMut(&usize) -> M) -> Self {
        let id = |&index: &usize| IndividualId { generation, individual: index as u32 };
        Self {
            members: indices.iter().map(member).collect(),
            ids: indices.iter().map(id).collect(),
        }
    }

    /// Returns the parents of a child, given the indices of one or two members.
    pub fn parents(&self, first: usize, second: Option<usize>) -> Parents {
        let id = |index: usize| self.ids.get(index).copied();
        let parents = match second {
            None => id(first).map(Parents::One),
            Some(second) => id(first).zip(id(second)).map(|(a, b)| Parents::Two(a, b)),
        };
        parents.unwrap_or(Parents::Unknown)
    }

    /// Returns the ids of the members; empty if they are unknown.
    pub fn ids(&self) -> Vec<IndividualId> {
        self.ids.clone()
    }

    /// Sets the ids of the members from the beginning of a list. If the list is too short, the ids stay unknown.
    pub fn restore(&mut self, ids: &[IndividualId]) {
        self.ids = ids.get(..self.members.len()).unwrap_or_default().to_vec();
    }

    /// Keeps only the best `most` members.
    pub fn truncate(&mut self, most: usize) {
        self.members.truncate(most);
        self.ids.truncate(most);
    }
}
