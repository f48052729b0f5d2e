//! The rewards of an episode, from which decisions are learned.
//!
//! Contacts, height and speed are not rewarded: each can be had without climbing.

use crate::learn::q_table::shaped;
use crate::world::Climb;

/// Cost of each decision, so that a shorter way is worth more.
const DECISION: f32 = -0.02;
/// Reward of each step that is climbed for the first time in the episode.
const STEP: f32 = 1.0;
/// Reward of the landing.
const LANDING: f32 = 10.0;
/// Cost of a disqualification. A greater one would teach to lie still.
const DISQUALIFICATION: f32 = -5.0;
/// Potential of a tread's depth of way. Differences of potential are added to the reward, which leaves the best policy as
/// it is (Ng, Harada and Russell, 1999).
const POTENTIAL_PER_TREAD: f32 = 0.5;
/// Reward of rules for a tread's depth of new ground, and for the landing.
const RULE_REWARD: f32 = 1000.0;
/// What is left of a reward after a decision.
pub const DISCOUNT: f32 = 0.98;

/// Adds up the rewards of the decision that holds.
#[derive(Debug, Clone, Default)]
pub struct RewardMeter {
    start_m: Option<f32>,
    now: Climb,
    most_steps: u32,
    /// Reward of the decision so far, without its potential.
    reward: f32,
    /// Potential at the beginning of the decision.
    potential: f32,
    /// The furthest way so far, in treads from the start, and that at the beginning of the decision.
    record: [f32; 2],
}

impl RewardMeter {
    /// Takes in the progress before a step.
    pub fn observe(&mut self, climb: &Climb) {
        self.now = *climb;
        if self.start_m.is_none() {
            self.start_m = Some(climb.way_m);
            self.most_steps = climb.steps;
        }
        if climb.steps > self.most_steps {
            self.reward += STEP * (climb.steps - self.most_steps) as f32;
            self.most_steps = climb.steps;
        }
        self.record[0] = self.record[0].max(self.treads());
    }

    /// Whether the snake is on the landing.
    pub fn has_landed(&self) -> bool {
        self.now.is_on_landing
    }

    /// Takes in a disqualification.
    pub fn disqualify(&mut self) {
        self.reward += DISQUALIFICATION;
    }

    /// Begins a decision.
    pub fn begin_decision(&mut self) {
        self.reward = 0.0;
        self.potential = self.potential_now();
        self.record[1] = self.record[0];
    }

    /// The reward of the decision that ends now. At the end of an episode the potential is 0: otherwise it could change
    /// the best policy.
    pub fn of_decision(&self, is_end: bool) -> f32 {
        let landing = if is_end && self.has_landed() { LANDING } else { 0.0 };
        let next = if is_end { 0.0 } else { self.potential_now() };
        shaped(DECISION + self.reward + landing, self.potential, next, DISCOUNT)
    }

    /// The reward of the decision that ends now, for rules: 0 or more, because a roulette needs it, and only for ground
    /// that is won for the first time, so that nothing is gained by going back and forth.
    pub fn of_rules(&self, is_end: bool) -> f32 {
        let won = (self.record[0] - self.record[1]).clamp(0.0, 1.0);
        let landing = if is_end && self.has_landed() { RULE_REWARD } else { 0.0 };
        RULE_REWARD * won + landing
    }

    fn potential_now(&self) -> f32 {
        POTENTIAL_PER_TREAD * self.treads()
    }

    /// The way from the start, in treads.
    fn treads(&self) -> f32 {
        let way_m = self.now.way_m - self.start_m.unwrap_or(self.now.way_m);
        if self.now.tread_m > 0.0 { way_m / self.now.tread_m } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(steps: u32, way_m: f32) -> Climb {
        Climb { steps, way_m, tread_m: 2.0, is_on_landing: steps == 10 }
    }

    #[test]
    fn each_step_is_rewarded_once_and_the_way_by_its_potential() {
        let mut rewards = RewardMeter::default();
        rewards.observe(&at(0, -7.0));
        rewards.begin_decision();
        rewards.observe(&at(0, -5.0));
        let expected = DECISION + DISCOUNT * 0.5;
        assert!((rewards.of_decision(false) - expected).abs() < 1e-6);
        rewards.begin_decision();
        for steps in [1, 2, 1, 2] {
            rewards.observe(&at(steps, -5.0));
        }
        let expected = DECISION + 2.0 + DISCOUNT * 0.5 - 0.5;
        assert!((rewards.of_decision(false) - expected).abs() < 1e-6);
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

    #[test]
    fn ends_have_no_potential() {
        let mut rewards = RewardMeter::default();
        rewards.observe(&at(9, 19.0));
        rewards.begin_decision();
        rewards.observe(&at(10, 21.0));
        assert!(rewards.has_landed());
        assert!((rewards.of_decision(true) - (DECISION + STEP + LANDING)).abs() < 1e-6);
        let mut rewards = RewardMeter::default();
        rewards.observe(&at(0, -7.0));
        rewards.observe(&at(0, -3.0));
        rewards.begin_decision();
        rewards.disqualify();
        let expected = DECISION + DISQUALIFICATION - 1.0;
        assert!((rewards.of_decision(true) - expected).abs() < 1e-6);
    }
}
