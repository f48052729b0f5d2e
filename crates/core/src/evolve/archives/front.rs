//! The Pareto front of distance and energy: individuals that no other individual beats in both.
//!
//! The front keeps at most one member for each [`BOX_M`] of distance (the ε-dominance of Laumanns and others, Evolutionary Computation 10
//! (2002)), so that it stays small however long a run lasts.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::genome::{Genome, GenomeSpace};
use crate::score::Evaluation;

/// A member of the Pareto front.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FrontMember {
    /// Generation that found the member; the first is 1.
    pub generation: u32,
    /// Index of the member in its generation.
    pub individual: u32,
    /// Evaluation of the member.
    #[serde(rename = "recorded")]
    pub evaluation: Evaluation,
    /// Genome of the member.
    pub genome: Genome,
}

/// The Pareto front: for each [`BOX_M`] of distance the member that spent the least energy, unless a member that got further spent no more.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Front {
    /// Members by the number of their box, which is their final y divided by `BOX_M` and rounded down.
    members: BTreeMap<i32, FrontMember>,
}

/// Width of a box along y, in metres.
pub const BOX_M: f32 = 0.5;
/// Greatest number of genes of a member. Genomes with more genes would make too large a checkpoint.
const LARGEST_MEMBER_GENES: usize = 5000;

/// Returns the energy that an agent spent, in J; infinite if it was not measured.
fn energy_j(evaluation: &Evaluation) -> f32 {
    evaluation.effort.map_or(f32::INFINITY, |effort| effort.energy_j)
}

fn box_number(evaluation: &Evaluation) -> i32 {
    libm::floorf(evaluation.centre_y_m / BOX_M) as i32
}

impl Front {
    /// Returns whether [`Self::add`] would accept an individual: it is not disqualified, ended ahead of `start_y_m`, has a measured energy
    /// and not too many genes, and no member beats it.
    pub fn accepts(&self, genome: &Genome, evaluation: &Evaluation, start_y_m: f32) -> bool {
        let mut rivals = self.members.range(box_number(evaluation)..);
        evaluation.disqualified.is_none()
            && evaluation.effort.is_some()
            && evaluation.centre_y_m > start_y_m
            && !rivals.any(|(_, known)| energy_j(&known.evaluation) <= energy_j(evaluation))
            && genome.gene_count(&GenomeSpace::default()) <= LARGEST_MEMBER_GENES
    }

    /// Adds an individual if [`Self::accepts`] allows it, and removes the members that the individual beats.
    pub fn add(&mut self, member: FrontMember, start_y_m: f32) {
        if !self.accepts(&member.genome, &member.evaluation, start_y_m) {
            return;
        }
        let number = box_number(&member.evaluation);
        let spent_j = energy_j(&member.evaluation);
        self.members
            .retain(|&other, known| other > number || energy_j(&known.evaluation) < spent_j);
        self.members.insert(number, member);
    }

    /// Returns the members, the shortest distance first.
    pub fn members(&self) -> impl ExactSizeIterator<Item = &FrontMember> {
        self.members.values()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::genome::{GenomeShape, GenomeSpace};
    use crate::rng::{Purpose, stream};
    use crate::world::Effort;

    #[test]
    fn members_beaten_in_both_distance_and_energy_are_removed() {
        let shape = GenomeShape { joints: 1, duration_s: 1.0 };
        let mut rng = stream(1, 1, 1, Purpose::Birth);
        let genome = GenomeSpace::default().random_genome(shape, &mut rng);
        let mut front = Front::default();
        for (individual, (y_m, energy_j)) in [
            (1.0, 50.0),
            (3.0, 90.0),
            (2.0, 95.0),
            (1.2, 40.0),
            (3.1, 60.0),
            (-9.0, 0.0),
            (8.0, 300.0),
        ]
        .into_iter()
        .enumerate()
        {
            let effort = Some(Effort { energy_j, ..Effort::default() });
            let evaluation = Evaluation { effort, ..Evaluation::of_fitness(y_m) };
            let genome = genome.clone();
            let individual = individual as u32;
            front.add(FrontMember { genome, evaluation, generation: 1, individual }, -7.0);
        }
        let kept: Vec<u32> = front.members().map(|member| member.individual).collect();
        assert_eq!(kept, [3, 4, 6]);
    }
}
