//! The Pareto front of distance and energy: individuals that no other beats in both.
//!
//! The front is kept at a resolution of [`BOX_M`] (the ε-dominance of Laumanns and others, Evolutionary
//! Computation 10 (2002)), so that it stays small however long a run lasts.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use crate::genome::Genome;
use crate::score::Evaluation;

/// A member of the front.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FrontMember {
    /// The generation that found it; the first is 1.
    pub generation: u32,
    /// Its index in that generation.
    pub individual: u32,
    /// Its evaluation.
    #[serde(rename = "recorded")]
    pub evaluation: Evaluation,
    /// The individual.
    pub genome: Genome,
}

/// The front: for each [`BOX_M`] of distance the member that spent the least energy, unless one that got further
/// spent less.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Front {
    /// Members by the number of their box.
    members: BTreeMap<i32, FrontMember>,
}

/// Width of a box, in metres.
pub const BOX_M: f32 = 0.5;
/// Genomes with more genes are not kept: a front of them would make too large a checkpoint.
const LARGEST_MEMBER_GENES: usize = 5000;

/// Energy that an agent spent, in J; infinite if it was not measured.
fn energy_j(evaluation: &Evaluation) -> f32 {
    evaluation.effort.map_or(f32::INFINITY, |effort| effort.energy_j)
}

fn box_number(evaluation: &Evaluation) -> i32 {
    libm::floorf(evaluation.centre_y_m / BOX_M) as i32
}

impl Front {
    /// Whether [`Self::add`] would accept an individual: it is not disqualified, ended ahead of `start_y_m`, its energy
    /// was measured, and no member beats it.
    pub fn accepts(&self, genome: &Genome, evaluation: &Evaluation, start_y_m: f32) -> bool {
        let mut rivals = self.members.range(box_number(evaluation)..);
        evaluation.disqualified.is_none()
            && evaluation.effort.is_some()
            && evaluation.centre_y_m > start_y_m
            && !rivals.any(|(_, known)| energy_j(&known.evaluation) <= energy_j(evaluation))
            && genome.gene_count() <= LARGEST_MEMBER_GENES
    }

    /// Adds an individual if the front [`Self::accepts`] it, and removes the members that it beats.
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

    /// Its members, the shortest distance first.
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
