//! The beat of decisions, and how an explorer takes them.

use rand::RngExt;
use rand_chacha::ChaCha8Rng;

use super::Observation;
use crate::genome::controllers::{DECISIONS_PER_S, Explorer};

/// Tells when the next decision is due.
#[derive(Debug, Clone, Default)]
pub struct DecisionClock {
    /// Number of the decision that holds; none before the first step.
    decision: Option<u64>,
}

impl DecisionClock {
    /// Whether a decision is due at this step. Each is due once.
    pub fn is_due(&mut self, observation: &Observation) -> bool {
        let decision = Some(quarters(observation) / u64::from(observation.steps_per_s));
        let is_due = self.decision != decision;
        self.decision = decision;
        is_due
    }

    /// The share of the way from the last bends to the next ones at the end of this step: they move on a straight line,
    /// and arrive with the next decision.
    pub fn share(observation: &Observation) -> f32 {
        let rate = u64::from(observation.steps_per_s);
        let within = quarters(observation) % rate + u64::from(DECISIONS_PER_S);
        within.min(rate) as f32 / rate as f32
    }
}

/// The step times the decisions per second: the time, in a unit in which steps and decisions are whole numbers.
fn quarters(observation: &Observation) -> u64 {
    u64::from(observation.step) * u64::from(DECISIONS_PER_S)
}

/// The action of rules that would take the frozen one: an explorer's random one now and then, and where there is none.
pub fn explored(
    explorer: Option<(&Explorer, &mut ChaCha8Rng)>,
    actions: usize,
    frozen: Option<usize>,
) -> Option<usize> {
    // An explorer draws both numbers in each decision, so that its stream does not depend on what it knows.
    let random = explorer.map(|(explorer, rng)| {
        let is_random = rng.random::<f32>() < explorer.epsilon;
        (is_random, rng.random_range(0..actions as u32) as usize)
    });
    match (random, frozen) {
        (Some((true, random)), _) | (Some((false, random)), None) => Some(random),
        (_, frozen) => frozen,
    }
}
