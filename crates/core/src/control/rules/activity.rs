//! The choice of waves by rules at a moment, for display.

use super::{HALVES, RuleFollower, deciding_rule};
use crate::control::{ActiveWave, ActiveWaveRule, Observation, WaveChoiceActivity, WaveUses};
use crate::genome::controllers::{JointGroup, WaveRule, Waves};

impl RuleFollower {
    /// Returns the last decision, with the waves of a joint; `None` before the first decision.
    pub(super) fn choice(
        &self,
        observation: &Observation,
        joint: usize,
    ) -> Option<WaveChoiceActivity> {
        let bits = self.bits?;
        let front_joints = self.front_joints();
        let shares = shares(&self.uses);
        let wave = |(index, waves): (usize, &Waves)| {
            let periods = observation.periods(waves.frequency_hz);
            Some(ActiveWave {
                frequency_hz: waves.frequency_hz,
                phase: (periods - libm::floor(periods)) as f32,
                targets: waves.joints.get(joint)?.clone(),
                share: shares.get(index).copied().unwrap_or(0.0),
            })
        };
        let winners = HALVES.map(|half| deciding_rule(&self.genes.rules, bits, half));
        // A half without joints has no decision.
        let counts = [front_joints, self.joints() - front_joints];
        let decides = |index: usize| {
            let [front, rear] = [0, 1].map(|i| counts[i] > 0 && winners[i] == Some(index));
            match (front, rear) {
                (true, true) => Some(JointGroup::All),
                (true, false) => Some(JointGroup::Front),
                (false, true) => Some(JointGroup::Rear),
                (false, false) => None,
            }
        };
        let rule = |(index, rule): (usize, &WaveRule)| ActiveWaveRule {
            rule: *rule,
            holds: rule.condition.matches(bits),
            decides: decides(index),
        };
        Some(WaveChoiceActivity {
            joint,
            waves: self.genes.library.iter().enumerate().map(wave).collect::<Option<_>>()?,
            of_joints: (0..self.joints())
                .map(|joint| self.chosen[usize::from(joint >= front_joints)])
                .collect(),
            front_joints,
            rules: self.genes.rules.iter().enumerate().map(rule).collect(),
        })
    }
}

/// Returns the share of each wave in all decisions.
fn shares(uses: &WaveUses) -> Vec<f32> {
    let total: f32 = uses.counts().iter().map(|count| *count as f32).sum();
    uses.counts().iter().map(|count| *count as f32 / total.max(1.0)).collect()
}
