//! The rewards of an episode, from which decisions are learned.
//!
//! Contacts, height and speed are not rewarded, because a snake can have each of them without climbing.

use crate::genome::controllers::DECISION_DISCOUNT;
use crate::learn::q_table::shaped;
use crate::world::ClimbProgress;

/// Reward of each decision. It is negative, so that a faster climb is worth more.
const DECISION: f32 = -0.02;
/// Reward for covering the depth of one tread for the first time.
const GROUND_PER_TREAD: f32 = 1.0;
/// Reward for reaching the landing.
const LANDING: f32 = 10.0;
/// Reward for a disqualification. A greater loss would teach the snake to lie still.
const DISQUALIFICATION: f32 = -5.0;
/// Loss of potential for each tread by which the snake is behind its furthest position. Differences of potential are added to the reward,
/// which leaves the best policy unchanged (Ng, Harada and Russell, 1999). A potential of the position itself would also leave it
/// unchanged. But the situations do not distinguish positions, so its size would be noise to a learner.
const POTENTIAL_PER_TREAD: f32 = 0.5;
/// Reward for rules for covering the depth of one tread for the first time, and for reaching the landing.
const RULE_REWARD: f32 = 1000.0;

/// Adds up the rewards of the present decision.
#[derive(Debug, Clone, Default)]
pub struct RewardMeter {
    start_m: Option<f32>,
    now: ClimbProgress,
    /// Furthest distance so far, in treads from the start, and its value at the beginning of the decision.
    furthest: [f32; 2],
    /// Potential of the snake's progress at the beginning of the decision.
    potential: f32,
    is_disqualified: bool,
}

impl RewardMeter {
    /// Takes in the progress before a step.
    pub fn observe(&mut self, climb: &ClimbProgress) {
        self.now = *climb;
        self.start_m = self.start_m.or(Some(climb.way_m));
        self.furthest[0] = self.furthest[0].max(self.treads());
    }

    /// Returns whether the snake is on the landing.
    pub fn has_landed(&self) -> bool {
        self.now.is_on_landing
    }

    /// Records a disqualification.
    pub fn disqualify(&mut self) {
        self.is_disqualified = true;
    }

    /// Begins a decision at the present state.
    pub fn begin_decision(&mut self) {
        self.potential = self.potential_now();
        self.furthest[1] = self.furthest[0];
    }

    /// Returns the reward of the decision that ends now. At the end of an episode the potential is 0, because shaping could otherwise
    /// change the best policy.
    pub fn of_decision(&self, is_end: bool) -> f32 {
        let mut reward = DECISION + GROUND_PER_TREAD * self.new_ground();
        if is_end && self.has_landed() {
            reward += LANDING;
        }
        if self.is_disqualified {
            reward += DISQUALIFICATION;
        }
        let next = if is_end { 0.0 } else { self.potential_now() };
        shaped(reward, self.potential, next, DECISION_DISCOUNT)
    }

    /// Returns the reward for rules of the decision that ends now. It is at least 0, because a roulette needs it, and only counts ground
    /// that is covered for the first time, so that moving back and forth gains nothing.
    pub fn of_rules(&self, is_end: bool) -> f32 {
        let landing = if is_end && self.has_landed() { RULE_REWARD } else { 0.0 };
        RULE_REWARD * self.new_ground().min(1.0) + landing
    }

    /// Returns the ground that the decision covered for the first time, in treads.
    fn new_ground(&self) -> f32 {
        self.furthest[0] - self.furthest[1]
    }

    fn potential_now(&self) -> f32 {
        POTENTIAL_PER_TREAD * (self.treads() - self.furthest[0])
    }

    /// Returns the distance from the start, in treads.
    fn treads(&self) -> f32 {
        let way_m = self.now.way_m - self.start_m.unwrap_or(self.now.way_m);
        if self.now.tread_m > 0.0 { way_m / self.now.tread_m } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(steps: u32, way_m: f32) -> ClimbProgress {
        ClimbProgress { steps, way_m, tread_m: 2.0, is_on_landing: steps == 10 }
    }

    fn near(found: f32, expected: f32) {
        assert!((found - expected).abs() < 1e-6, "{found} instead of {expected}");
    }

    #[test]
    fn ground_is_rewarded_once_and_being_behind_is_a_loss_of_potential() {
        let mut rewards = RewardMeter::default();
        rewards.observe(&at(0, -7.0));
        let mut decision = |ways_m: &[f32]| {
            rewards.begin_decision();
            ways_m.iter().for_each(|way_m| rewards.observe(&at(0, *way_m)));
            rewards.of_decision(false)
        };
        near(decision(&[-6.0, -5.0]), DECISION + 1.0);
        near(decision(&[-7.0]), DECISION - DECISION_DISCOUNT * 0.5);
        near(decision(&[-5.0]), DECISION + 0.5);
        near(decision(&[-4.0, -5.0]), DECISION + 0.5 - DECISION_DISCOUNT * 0.25);
    }

    #[test]
    fn ends_have_no_potential() {
        let mut rewards = RewardMeter::default();
        rewards.observe(&at(9, 19.0));
        rewards.begin_decision();
        rewards.observe(&at(10, 21.0));
        assert!(rewards.has_landed());
        near(rewards.of_decision(true), DECISION + 1.0 + LANDING);
        let mut rewards = RewardMeter::default();
        rewards.observe(&at(0, -3.0));
        rewards.observe(&at(0, -7.0));
        rewards.begin_decision();
        rewards.disqualify();
        near(rewards.of_decision(true), DECISION + DISQUALIFICATION + 1.0);
    }

    #[test]
    fn rules_are_paid_for_new_ground_only() {
        let mut rewards = RewardMeter::default();
        rewards.observe(&at(0, -7.0));
        let mut paid = |way_m: f32| {
            rewards.begin_decision();
            rewards.observe(&at(0, way_m));
            rewards.of_rules(false)
        };
        assert_eq!([paid(-6.0), paid(-8.0), paid(-6.0), paid(-5.5)], [500.0, 0.0, 0.0, 250.0]);
        assert_eq!(paid(5.0), 1000.0, "at most");
    }
}
