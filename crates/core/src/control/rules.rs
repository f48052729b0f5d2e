//! The controller with waves that rules choose.

mod activity;

use super::perception::Perception;
use super::sense::GAP_SCALE_M;
use super::servo::JointServos;
use super::situation::{MOVED_M, way_m};
use super::{Activity, Controller, Observation, Senses, WaveUses};
use crate::genome::controllers::{JointGroup, RULE_SENSES, RuleGenes, WaveRule, bits_of};
use crate::world::JointTorque;

/// Number of decisions per second.
const DECISIONS_PER_S: u64 = 4;
/// Time in which the targets change from one wave to the next, in s: less than the time between decisions.
const BLEND_S: f64 = 0.2;
/// The two halves of the joints. Each half follows a wave.
const HALVES: [JointGroup; 2] = [JointGroup::Front, JointGroup::Rear];

/// Follows the waves that rules choose, a few times per second and for each half of the joints.
///
/// All waves run from the start on, so that a wave that is chosen again continues with the phase that it would have had.
#[derive(Debug, Clone)]
pub struct RuleFollower {
    genes: RuleGenes,
    servo: JointServos,
    /// Index of the wave of the front and of the rear half since the last decision.
    chosen: [usize; 2],
    /// Index of the wave of the front and of the rear half before the last decision.
    before: [usize; 2],
    /// Bits to which the conditions referred at the last decision; `None` before the first decision.
    bits: Option<u32>,
    /// Distance of the middle limb since the last decision, integrated from its sensed speed, in m.
    way_m: f32,
    uses: WaveUses,
}

impl RuleFollower {
    /// Creates the follower before the first step.
    pub fn new(genes: RuleGenes) -> Self {
        Self {
            servo: JointServos::new(genes.stiffness_nm_per_rad, genes.servo_damping_nms_per_rad),
            chosen: [0; 2],
            before: [0; 2],
            bits: None,
            way_m: 0.0,
            uses: WaveUses::new(genes.library.len()),
            genes,
        }
    }

    /// Chooses the waves of both halves for a new decision.
    fn decide(&mut self, observation: &Observation, front_joints: usize) {
        let bits = bits(&observation.perception, self.way_m);
        self.way_m = 0.0;
        self.bits = Some(bits);
        self.before = self.chosen;
        self.chosen = HALVES.map(|half| chosen_wave(&self.genes.rules, bits, half));
        // Before the first decision there are no waves to blend from.
        if observation.step == 0 {
            self.before = self.chosen;
        }
        let joints = self.joints();
        for (wave, joints) in self.chosen.into_iter().zip([front_joints, joints - front_joints]) {
            if joints > 0 {
                self.uses.count(wave);
            }
        }
    }

    fn joints(&self) -> usize {
        self.genes.library.first().map_or(0, |waves| waves.joints.len())
    }

    /// Returns the number of joints in the front half.
    fn front_joints(&self) -> usize {
        self.joints().div_ceil(2)
    }

    /// Returns the target of a joint while its half blends from one wave to the next; `share` of the blend is done.
    fn target_rad(&self, joint: usize, half: usize, share: f64, periods: &[f64]) -> [f32; 2] {
        let of = |wave: usize| {
            let joint = &self.genes.library[wave].joints[joint];
            [joint.bend.at(periods[wave]), joint.twist.at(periods[wave])]
        };
        let (before, chosen) = (self.before[half], self.chosen[half]);
        let target_rad = of(chosen);
        if before == chosen || share >= 1.0 {
            return target_rad;
        }
        let [old_bend, old_twist] = of(before);
        let [bend, twist] = target_rad;
        let share = share as f32;
        [old_bend + (bend - old_bend) * share, old_twist + (twist - old_twist) * share]
    }
}

/// Returns the index of the rule that decides for a half of the joints: the strongest rule that holds, the lowest index among equal ones;
/// `None` if no rule holds.
fn deciding_rule(rules: &[WaveRule], bits: u32, half: JointGroup) -> Option<usize> {
    let mut strongest: Option<(usize, &WaveRule)> = None;
    for (index, rule) in rules.iter().enumerate().filter(|(_, rule)| rule.holds(bits, half)) {
        if strongest.is_none_or(|(_, other)| rule.strength > other.strength) {
            strongest = Some((index, rule));
        }
    }
    strongest.map(|(index, _)| index)
}

/// Returns the index of the wave for a half of the joints: that of the deciding rule, or the first wave if no rule decides.
fn chosen_wave(rules: &[WaveRule], bits: u32, half: JointGroup) -> usize {
    let rule = deciding_rule(rules, bits, half).and_then(|index| rules.get(index));
    rule.map_or(0, |rule| (rule.wave as usize).saturating_sub(1))
}

/// Returns the bits to which the conditions of rules refer, in the order of [`RULE_SENSES`].
fn bits(senses: &Perception, way_m: f32) -> u32 {
    let limb = |index: usize| senses.limbs.get(index).copied().unwrap_or_default();
    let (head, middle) = (limb(0), limb(senses.limbs.len() / 2));
    let tail = limb(senses.limbs.len().saturating_sub(1));
    let bits: [bool; RULE_SENSES.len()] = [
        head.gap < 1.0 / GAP_SCALE_M,
        head.gap < 0.25 / GAP_SCALE_M,
        head.step_up > 0.05,
        head.step_up > 0.6,
        head.pitch > 0.3,
        head.blocked > 0.5,
        middle.touch > 0.5,
        tail.touch > 0.5,
        middle.gap < 1.0 / GAP_SCALE_M,
        way_m > MOVED_M,
    ];
    bits_of(&bits)
}

impl Controller for RuleFollower {
    fn needs(&self) -> Senses {
        Senses::ALL
    }

    fn act(&mut self, observation: &Observation, torques: &mut [JointTorque]) {
        let (joints, front_joints) = (self.joints(), self.front_joints());
        // Decisions are due at multiples of their period, whatever the step rate.
        let steps_per_s = u64::from(observation.steps_per_s);
        let time = u64::from(observation.step) * DECISIONS_PER_S;
        if time % steps_per_s < DECISIONS_PER_S {
            self.decide(observation, front_joints);
        }
        let since_s = (time % steps_per_s) as f64 / (steps_per_s * DECISIONS_PER_S) as f64;
        let share = since_s / BLEND_S;
        let periods: Vec<f64> = self
            .genes
            .library
            .iter()
            .map(|waves| observation.periods(waves.frequency_hz))
            .collect();
        let targets: Vec<[f32; 2]> = (0..joints)
            .map(|joint| {
                self.target_rad(joint, usize::from(joint >= front_joints), share, &periods)
            })
            .collect();
        self.servo.pull(observation, targets.into_iter(), torques);
        self.way_m += way_m(&observation.perception, observation.steps_per_s);
    }

    fn activity(&self, observation: &Observation, joint: usize) -> Option<Activity> {
        self.choice(observation, joint).map(Activity::Waves)
    }

    fn wave_uses(&self) -> Option<WaveUses> {
        Some(self.uses)
    }
}

#[cfg(test)]
mod tests;
