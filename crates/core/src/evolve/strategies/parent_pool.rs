//! The individuals of the last generation that may have children.

use crate::evolve::parents::{IndividualId, Parents};

/// Possible parents of the next generation, best first.
#[derive(Debug, Clone)]
pub struct ParentPool<M> {
    /// The parents; empty before the first generation.
    pub members: Vec<M>,
    /// Their ids; empty if they are unknown.
    ids: Vec<IndividualId>,
}

impl<M> ParentPool<M> {
    /// Parents whose ids are not known.
    pub fn unknown(members: Vec<M>) -> Self {
        Self { members, ids: Vec::new() }
    }

    /// The individuals of a generation with these indices.
    pub fn chosen(generation: u32, indices: &[usize], member: impl FnMut(&usize) -> M) -> Self {
        let id = |&index: &usize| IndividualId { generation, individual: index as u32 };
        Self {
            members: indices.iter().map(member).collect(),
            ids: indices.iter().map(id).collect(),
        }
    }

    /// The parents of a child of one or two members, given their indices.
    pub fn parents(&self, first: usize, second: Option<usize>) -> Parents {
        let id = |index: usize| self.ids.get(index).copied();
        let parents = match second {
            None => id(first).map(Parents::One),
            Some(second) => id(first).zip(id(second)).map(|(a, b)| Parents::Two(a, b)),
        };
        parents.unwrap_or(Parents::Unknown)
    }

    /// The ids of the parents, as far as they are known.
    pub fn ids(&self) -> Vec<IndividualId> {
        self.ids.clone()
    }

    /// Takes the ids of the parents from the beginning of a list. If the list is too short, they stay unknown.
    pub fn restore(&mut self, ids: &[IndividualId]) {
        self.ids = ids.get(..self.members.len()).unwrap_or_default().to_vec();
    }

    /// Removes all parents but the best.
    pub fn truncate(&mut self, most: usize) {
        self.members.truncate(most);
        self.ids.truncate(most);
    }
}
