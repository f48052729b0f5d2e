//! A small set of situations, computed from the senses, by which decisions are learned.

use super::Perception;
use super::postures::bend;
use super::sense::{ANGLE_SCALE_RAD, GAP_SCALE_M, SPEED_SCALE_M_S};
use crate::genome::controllers::{SITUATION_BITS, bits_of};

/// Borders between near, reachable and far gaps of the head, in metres.
const GAP_EDGES_M: [f32; 2] = [0.25, 1.0];
/// Borders between no step, a low step and a high step ahead of the head, in metres.
const STEP_EDGES_M: [f32; 2] = [0.05, 0.6];
/// Borders between a lowered, a level and a raised head, as sines of its pitch.
const PITCH_EDGES: [f32; 2] = [-0.3, 0.3];
/// Distance since the last decision above which the snake counts as moved, in metres.
pub(super) const MOVED_M: f32 = 0.1;
/// Bend from which on a joint counts as folded, in radians.
const FOLDED_RAD: f32 = 0.9;
/// Gap below which the head counts as near a riser for rules, in metres.
const NEAR_M: f32 = 0.5;
/// Gap below which the middle limb counts as near a riser, in metres.
const MIDDLE_GAP_M: f32 = 1.0;

/// A situation in which a decision is taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SensedSituation {
    /// Index of the last posture.
    pub posture: usize,
    /// Class of the head's gap: 0 near, 1 within reach, 2 far.
    pub gap: usize,
    /// Class of the step ahead of the head: 0 none, 1 low, 2 high.
    pub step: usize,
    /// Class of the head's pitch: 0 down, 1 level, 2 up.
    pub pitch: usize,
    /// Whether the snake has moved ahead since the last decision.
    pub has_moved: bool,
    /// Whether the middle limb is near a riser.
    pub middle_near: bool,
    /// Whether the joint before the middle limb is folded, and whether the joint behind it is.
    pub folded: [bool; 2],
}

/// Returns the number of the half-open class of a value: `edges[i-1] <= value < edges[i]`.
fn bin(value: f32, edges: [f32; 2]) -> usize {
    edges.iter().filter(|edge| value >= **edge).count()
}

impl SensedSituation {
    /// Computes the situation from the senses, the last posture, and the distance since the last decision, in metres.
    pub fn of(senses: &Perception, posture: usize, moved_m: f32) -> Self {
        let head = senses.limbs.first().copied().unwrap_or_default();
        let middle_limb = senses.limbs.len() / 2;
        let middle = senses.limbs.get(middle_limb).copied().unwrap_or_default();
        Self {
            posture,
            gap: bin(head.gap * GAP_SCALE_M, GAP_EDGES_M),
            step: bin(head.step_up, STEP_EDGES_M),
            pitch: bin(head.pitch, PITCH_EDGES),
            has_moved: moved_m > MOVED_M,
            middle_near: middle.gap * GAP_SCALE_M < MIDDLE_GAP_M,
            folded: [middle_limb.wrapping_sub(1), middle_limb].map(|joint| {
                let joint = senses.joints.get(joint).copied().unwrap_or_default();
                (joint.bend * ANGLE_SCALE_RAD).abs() >= FOLDED_RAD
            }),
        }
    }

    /// Returns the number of the situation among the states of a table, in mixed radix.
    pub fn table_state(&self) -> usize {
        let mut state = self.posture;
        for (digit, radix) in [
            (self.gap, 3),
            (self.step, 3),
            (self.pitch, 3),
            (usize::from(self.has_moved), 2),
            (usize::from(self.middle_near), 2),
            (usize::from(self.folded[0]), 2),
            (usize::from(self.folded[1]), 2),
        ] {
            state = state * radix + digit;
        }
        state
    }

    /// Returns the bits by which rules distinguish situations: see [`SITUATION_BITS`].
    pub fn bits(&self, senses: &Perception) -> u32 {
        let head = senses.limbs.first().copied().unwrap_or_default();
        let joints = senses.limbs.len().saturating_sub(1);
        let bent = |joint: usize| bend(self.posture, joint, joints);
        let (third, last) = (joints.saturating_sub(2), joints.saturating_sub(1));
        let bits: [bool; SITUATION_BITS.len()] = [
            head.gap * GAP_SCALE_M < NEAR_M,
            self.middle_near,
            head.pitch >= PITCH_EDGES[1],
            head.pitch < PITCH_EDGES[0],
            self.has_moved,
            bent(0) != 0.0,
            bent(0) > 0.0,
            bent(last) != 0.0,
            bent(1).abs() >= 1.0,
            bent(third).abs() >= 1.0,
        ];
        bits_of(&bits)
    }

    /// Describes the situation in words.
    pub fn words(&self) -> String {
        let of = |words: [&'static str; 3], index: usize| words[index.min(2)];
        let mut parts = vec![
            of(["riser at the head", "riser near", "no riser near"], self.gap),
            of(["nothing to climb", "low step ahead", "high step ahead"], self.step),
            of(["head down", "head level", "head up"], self.pitch),
            if self.has_moved { "moving" } else { "not moving" },
        ];
        if self.middle_near {
            parts.push("middle at a riser");
        }
        match self.folded {
            [true, true] => parts.push("folded in front and behind"),
            [true, false] => parts.push("folded in front"),
            [false, true] => parts.push("folded behind"),
            [false, false] => {}
        }
        parts.join(", ")
    }
}

/// Returns the distance ahead in a step at the perceived speed, in metres.
pub fn way_m(senses: &Perception, steps_per_s: u32) -> f32 {
    senses.snake.speed_ahead * SPEED_SCALE_M_S / steps_per_s as f32
}

#[cfg(test)]
mod tests {
    use super::super::perception::LimbSenses;
    use super::*;
    use crate::genome::controllers::{POSTURES, TABLE_STATES};
    use std::collections::BTreeSet;

    #[test]
    fn every_situation_has_a_state_of_its_own() {
        let mut states = BTreeSet::new();
        for posture in 0..POSTURES.len() {
            for number in 0..27 {
                for flags in 0..16 {
                    let situation = SensedSituation {
                        posture,
                        gap: number % 3,
                        step: number / 3 % 3,
                        pitch: number / 9,
                        has_moved: flags & 1 == 1,
                        middle_near: flags & 2 == 2,
                        folded: [flags & 4 == 4, flags & 8 == 8],
                    };
                    states.insert(situation.table_state());
                }
            }
        }
        assert_eq!(states.len(), TABLE_STATES);
        assert_eq!(states.last(), Some(&(TABLE_STATES - 1)));
    }

    #[test]
    fn the_bits_of_rules_tell_all_postures_apart() {
        let mut senses = Perception::default();
        senses.limbs = vec![LimbSenses::default(); 5];
        let bits = |posture| SensedSituation::of(&senses, posture, 0.2).bits(&senses);
        let all: BTreeSet<u32> = (0..POSTURES.len()).map(bits).collect();
        assert_eq!(all.len(), POSTURES.len());
        assert!(all.iter().all(|bits| bits >> 4 & 1 == 1 && bits >> SITUATION_BITS.len() == 0));
    }

    #[test]
    fn bins_are_half_open() {
        let mut senses = Perception::default();
        senses.limbs = vec![LimbSenses { gap: 0.125, ..LimbSenses::default() }; 5];
        assert_eq!(SensedSituation::of(&senses, 1, 0.0).gap, 1, "0.25 m belongs to the upper bin");
        senses.limbs[0].gap = 0.124;
        senses.limbs[0].pitch = -0.31;
        let situation = SensedSituation::of(&senses, 1, 0.2);
        assert_eq!((situation.gap, situation.pitch, situation.has_moved), (0, 0, true));
        assert!(situation.words().starts_with("riser at the head, "), "{}", situation.words());
    }
}
