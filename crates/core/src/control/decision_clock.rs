//! The clock of decisions.

use super::Observation;
use crate::genome::controllers::DECISIONS_PER_S;

/// Determines when the next decision is due.
#[derive(Debug, Clone, Default)]
pub struct DecisionClock {
    /// Number of the present decision; `None` before the first step.
    decision: Option<u64>,
}

impl DecisionClock {
    /// Returns whether a decision is due at this step. Each decision is due once.
    pub fn is_due(&mut self, observation: &Observation) -> bool {
        let decision = Some(quarters(observation) / u64::from(observation.steps_per_s));
        let is_due = self.decision != decision;
        self.decision = decision;
        is_due
    }

    /// Returns the share of the change from the last bends to the next ones at the end of this step. Bends change linearly, and reach
    /// their targets with the next decision.
    pub fn share(observation: &Observation) -> f32 {
        let rate = u64::from(observation.steps_per_s);
        let within = quarters(observation) % rate + u64::from(DECISIONS_PER_S);
        within.min(rate) as f32 / rate as f32
    }
}

/// Returns the step times the decisions per second. In this unit of time, steps and decisions are whole numbers.
fn quarters(observation: &Observation) -> u64 {
    u64::from(observation.step) * u64::from(DECISIONS_PER_S)
}
