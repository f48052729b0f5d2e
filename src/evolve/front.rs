//! Distance against energy: who is beaten by nobody in both.
//!
//! The front is kept at a resolution of [`BOX_M`] (the ε-dominance of Laumanns and others, Evolutionary
//! Computation 10 (2002)), so that it stays small however long a run goes on.

use std::collections::BTreeMap;

use crate::genome::{Controller, Genome};
use crate::score::Evaluation;

/// One of the front.
#[derive(Debug, Clone, PartialEq)]
pub struct FrontMember {
    /// The individual.
    pub genome: Genome,
    /// What it reached.
    pub evaluation: Evaluation,
    /// The generation that found it; the first is 1.
    pub generation: u32,
    /// Its index in that generation.
    pub individual: u32,
}

/// The front: of all that ended in the same [`BOX_M`] of distance the one that spent least, unless somebody
/// who got further spent less.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Front {
    /// By the number of their box.
    members: BTreeMap<i32, FrontMember>,
}

/// Width of a box, in metres.
pub const BOX_M: f32 = 0.5;
/// Genomes of more torque points are not kept: a front of them would make too large a checkpoint.
const LARGEST_MEMBER_TORQUES: usize = 5000;

impl FrontMember {
    fn energy_j(&self) -> f32 {
        self.evaluation.effort.map_or(f32::INFINITY, |effort| effort.energy_j)
    }

    fn box_number(&self) -> i32 {
        libm::floorf(self.evaluation.centre_y_m / BOX_M) as i32
    }

    fn is_small(&self) -> bool {
        match &self.genome.controller {
            Controller::Signal(signals) => {
                signals.all().map(Vec::len).sum::<usize>() <= LARGEST_MEMBER_TORQUES
            }
            Controller::Wave(_) | Controller::Gait(_) => true,
        }
    }
}

impl Front {
    /// Takes somebody in who is beaten by nobody, and drops who is beaten by it. Only who ended further ahead
    /// than `start_y_m`, in good health, with its energy measured, is considered.
    pub fn add(&mut self, member: FrontMember, start_y_m: f32) {
        let evaluation = &member.evaluation;
        let is_fit = evaluation.disqualified.is_none()
            && evaluation.effort.is_some()
            && evaluation.centre_y_m > start_y_m;
        let number = member.box_number();
        let is_beaten =
            self.members.range(number..).any(|(_, known)| known.energy_j() <= member.energy_j());
        if !is_fit || is_beaten || !member.is_small() {
            return;
        }
        self.members.retain(|&other, known| other > number || known.energy_j() < member.energy_j());
        self.members.insert(number, member);
    }

    /// Its members, the least distance first.
    pub fn members(&self) -> impl ExactSizeIterator<Item = &FrontMember> {
        self.members.values()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::genome::{Descent, GenomeSpace};
    use crate::rng::{Purpose, stream};
    use crate::world::Effort;

    #[test]
    fn only_those_stay_whom_nobody_beats_in_both() {
        let descent = Descent { joints: 1, duration_s: 1.0 };
        let genome = GenomeSpace::default().birth(descent, &mut stream(1, 1, 1, Purpose::Birth));
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
            let evaluation = Evaluation {
                fitness: y_m,
                centre_y_m: y_m,
                disqualified: None,
                trace_hash: 0,
                steps: 1,
                effort: Some(Effort { energy_j, ..Effort::default() }),
                behaviour: None,
            };
            let genome = genome.clone();
            let individual = individual as u32;
            front.add(FrontMember { genome, evaluation, generation: 1, individual }, -7.0);
        }
        let kept: Vec<u32> = front.members().map(|member| member.individual).collect();
        assert_eq!(kept, [3, 4, 6]);
    }
}
