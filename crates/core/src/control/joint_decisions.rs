//! The controller with decisions of each joint: it chooses bends four times a second, and records the experience.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::decision_clock::DecisionClock;
use super::network::servos;
use super::rewards::RewardMeter;
use super::sense::{ANGLE_SCALE_RAD, GAP_SCALE_M};
use super::servo::JointServos;
use super::situation::{MOVED_M, way_m};
use super::{
    ActiveRule, Activity, Controller, DecisionActivity, Observation, Perception, RulePlace, Senses,
};
use crate::genome::controllers::{
    Explorer, JOINT_BENDS, JOINT_BITS, JointDecisionGenes, bits_in_words, bits_of,
};
use crate::learn::Episode;
use crate::learn::classifiers::{EpisodeEnd, RecordedDecision};
use crate::world::JointTorque;

/// Bend from which on a joint counts as bent, in radians.
const BENT_RAD: f32 = 0.4;
/// Gap below which a riser counts as near a limb, in metres.
const NEAR_M: f32 = 1.0;
/// Height from which on a step counts as being ahead, in metres.
const STEP_M: f32 = 0.05;
/// Sine of the pitch from which on a limb counts as raised.
const RAISED: f32 = 0.3;

/// Lets each joint decide by its own rules. Explorers sometimes decide at random.
#[derive(Debug, Clone)]
pub struct JointDecisionController {
    genes: JointDecisionGenes,
    servo: JointServos,
    rng: Option<ChaCha8Rng>,
    clock: DecisionClock,
    /// Situation of each joint at the present decision; `None` before the first decision.
    bits: Option<Vec<u32>>,
    /// Bend of each joint, as an index of [`JOINT_BENDS`]; `None` before the joint's first choice.
    chosen: Vec<Option<usize>>,
    /// Bends of each joint at the last decision and the target bends of this decision, in radians.
    bends_rad: Vec<[f32; 2]>,
    moved_m: f32,
    rewards: RewardMeter,
    /// Experience of each joint so far.
    decisions: Vec<Vec<RecordedDecision>>,
    /// Whether the episode has ended, so that nothing more is learned.
    is_over: bool,
}

impl JointDecisionController {
    /// Creates the controller before the first step.
    pub fn new(genes: JointDecisionGenes) -> Self {
        let joints = genes.systems.len();
        Self {
            servo: servos(&genes.servo),
            rng: genes.explorer.as_ref().map(Explorer::rng),
            clock: DecisionClock::default(),
            bits: None,
            chosen: vec![None; joints],
            bends_rad: vec![[0.0; 2]; joints],
            moved_m: 0.0,
            rewards: RewardMeter::default(),
            decisions: vec![Vec::new(); joints],
            is_over: false,
            genes,
        }
    }

    /// Ends the present decisions, and takes the next ones, from the head.
    fn decide(&mut self, senses: &Perception) {
        self.close(false);
        self.rewards.begin_decision();
        let moved = std::mem::take(&mut self.moved_m) > MOVED_M;
        let bits: Vec<u32> =
            (0..self.chosen.len()).map(|joint| situation(senses, joint, moved)).collect();
        for (joint, system) in self.genes.systems.iter().enumerate() {
            let explorer = self.genes.explorer.as_ref().zip(self.rng.as_mut());
            let action = explored(explorer, JOINT_BENDS.len(), system.frozen_action(bits[joint]));
            let [from, to] = &mut self.bends_rad[joint];
            *from = *to;
            // Without a matching rule, a joint keeps its bend. Covering is not possible, because it would change the champion.
            self.chosen[joint] = action.or(self.chosen[joint]);
            if let Some(action) = action {
                *to = [0.0, 1.0, -1.0][action.min(2)] * self.genes.servo.bend_range_rad;
            }
        }
        self.bits = Some(bits);
    }

    /// Adds the experience of the decisions that end.
    fn close(&mut self, is_end: bool) {
        let Some(bits) = self.bits.as_ref().filter(|_| !self.is_over) else { return };
        let reward = self.rewards.of_rules(is_end);
        for ((decisions, bits), chosen) in self.decisions.iter_mut().zip(bits).zip(&self.chosen) {
            // A joint that was never moved is straight.
            let action = chosen.unwrap_or(0) as u16;
            decisions.push(RecordedDecision { bits: *bits, action, reward });
        }
        self.is_over = is_end;
    }
}

/// Returns the action of rules whose frozen action is `frozen`. For an explorer, it is sometimes a random action, and always if there is
/// no frozen one.
fn explored(
    explorer: Option<(&Explorer, &mut ChaCha8Rng)>,
    actions: usize,
    frozen: Option<usize>,
) -> Option<usize> {
    // An explorer draws both numbers in each decision, so that its stream does not depend on what it has learned.
    let random = explorer.map(|(explorer, rng)| {
        let is_random = rng.random::<f32>() < explorer.epsilon;
        (is_random, rng.random_range(0..actions as u32) as usize)
    });
    match (random, frozen) {
        (Some((true, random)), _) | (Some((false, random)), None) => Some(random),
        (_, frozen) => frozen,
    }
}

/// Returns the bits of a joint's situation: see [`JOINT_BITS`].
fn situation(senses: &Perception, joint: usize, moved: bool) -> u32 {
    let bend_rad = |joint: Option<usize>| {
        let of = joint.and_then(|joint| senses.joints.get(joint).copied());
        of.unwrap_or_default().bend * ANGLE_SCALE_RAD
    };
    let limb = |index: usize| senses.limbs.get(index).copied().unwrap_or_default();
    let (own, ahead, behind) =
        (bend_rad(Some(joint)), bend_rad(joint.checked_sub(1)), bend_rad(Some(joint + 1)));
    let (front, rear) = (limb(joint), limb(joint + 1));
    let bits: [bool; JOINT_BITS.len()] = [
        own >= BENT_RAD,
        own <= -BENT_RAD,
        ahead >= BENT_RAD,
        ahead <= -BENT_RAD,
        behind >= BENT_RAD,
        behind <= -BENT_RAD,
        front.touch > 0.5,
        rear.touch > 0.5,
        front.gap * GAP_SCALE_M < NEAR_M,
        front.step_up >= STEP_M,
        front.pitch >= RAISED,
        moved,
    ];
    bits_of(&bits)
}

/// Describes the situation of a joint in words, by all bits that are set.
fn in_words(bits: u32) -> String {
    bits_in_words(&JOINT_BITS, bits, bits, "nothing near")
}

impl Controller for JointDecisionController {
    fn needs(&self) -> Senses {
        Senses { climb: true, ..Senses::ALL }
    }

    fn act(&mut self, observation: &Observation, torques: &mut [JointTorque]) {
        self.rewards.observe(&observation.climb);
        if self.rewards.has_landed() {
            self.close(true);
        }
        if self.clock.is_due(observation) {
            self.decide(&observation.perception);
        }
        self.moved_m += way_m(&observation.perception, observation.steps_per_s);
        let share = DecisionClock::share(observation);
        let targets = self.bends_rad.iter().map(|[from, to]| [from + (to - from) * share, 0.0]);
        self.servo.pull(observation, targets, torques);
    }

    fn finish(&mut self, observation: &Observation, is_disqualified: bool) -> Option<Episode> {
        let senses = &observation.perception;
        if is_disqualified {
            self.rewards.disqualify();
        } else if !self.is_over {
            self.rewards.observe(&observation.climb);
        }
        let was_over = self.is_over;
        self.close(is_disqualified);
        // The end of time does not end the task: the snake could continue.
        let end = |bits: u32| match was_over || is_disqualified {
            true => EpisodeEnd::Terminal,
            false => EpisodeEnd::TimeOut { bits },
        };
        let moved = self.moved_m > MOVED_M;
        let of_joint = |(joint, decisions): (usize, &mut Vec<RecordedDecision>)| {
            (std::mem::take(decisions), end(situation(senses, joint, moved)))
        };
        Some(Episode::Joints(self.decisions.iter_mut().enumerate().map(of_joint).collect()))
    }

    fn activity(&self, _observation: &Observation, joint: usize) -> Option<Activity> {
        let (bits, system) = (*self.bits.as_ref()?.get(joint)?, self.genes.systems.get(joint)?);
        let at = RulePlace { bits, names: &JOINT_BITS, chosen: self.chosen[joint] };
        let rules = at.rules_of_xcs(system);
        Some(Activity::Decision(DecisionActivity {
            joint: Some(joint),
            situation: in_words(bits),
            postures: ActiveRule::worths(&JOINT_BENDS, system.prediction_array(bits), &rules),
            chosen: self.chosen[joint].unwrap_or(0),
            barred: None,
            rules,
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::super::perception::{JointSenses, LimbSenses};
    use super::*;

    #[test]
    fn the_situation_of_a_joint_is_what_is_near_it() {
        let mut senses = Perception::default();
        senses.joints = vec![JointSenses::default(); 4];
        senses.limbs = vec![LimbSenses { gap: 1.0, ..LimbSenses::default() }; 5];
        assert_eq!(in_words(situation(&senses, 0, false)), "nothing near");
        senses.joints[1].bend = 0.5 / ANGLE_SCALE_RAD;
        senses.limbs[2].touch = 1.0;
        senses.limbs[1].gap = 0.4;
        senses.limbs[1].step_up = 0.5;
        let words = |joint| in_words(situation(&senses, joint, joint == 3));
        assert_eq!(words(0), "joint behind arched");
        let second =
            "arched, block behind touches, riser within a metre of the block ahead, step ahead";
        assert_eq!(words(1), second);
        assert_eq!(words(2), "joint ahead arched, block ahead touches");
        assert_eq!(words(3), "moving");
    }
}
