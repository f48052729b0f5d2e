//! A whole rollout, computed in advance: its torques, its path, and keyframes from which any moment is simulated again, bit for bit.

use super::{Evaluation, Rollout, Trial};
use crate::genome::Genome;
use crate::world::{JointTorque, Vector};

/// A rollout from its start to its end, with keyframes for seeking.
pub struct KeyframeHistory {
    /// Rollouts in intervals of [`Self::keyframe_steps`] steps, beginning with step 0.
    keyframes: Vec<Rollout>,
    keyframe_steps: u32,
    sample_steps: u32,
    joints: usize,
    /// Torques of each sample, one per joint.
    torques: Vec<JointTorque>,
    /// Positions of the middle limb's centre in each sample, in metres, beginning with the start.
    middles_m: Vec<Vector>,
    landed_at_step: Option<u32>,
    touched_stairs_at_step: Option<u32>,
    evaluation: Evaluation,
}

/// Minimum number of steps between two keyframes: a quarter of a second at the report's 60 steps per second, which is simulated again
/// within a millisecond.
const MIN_STEPS_BETWEEN_KEYFRAMES: u32 = 15;
/// Maximum number of keyframes. Each keyframe holds a whole physics world in memory.
const MAX_KEYFRAMES: u32 = 60;
/// Maximum number of samples. A screen could not show more of them separately.
const MAX_SAMPLES: u32 = 6000;

impl KeyframeHistory {
    /// Runs a genome's rollout to its end. Genome and trial must have passed their checks. `goes_on` is called after every step with the
    /// number of the step; if it returns `false`, the result is `None`.
    pub fn of(genome: &Genome, trial: &Trial, goes_on: impl FnMut(u32) -> bool) -> Option<Self> {
        Self::of_rollout(Rollout::new(genome, trial), goes_on)
    }

    /// Runs a rollout from its start to its end. `goes_on` is called after every step with the number of the step; if it returns `false`,
    /// the result is `None`.
    pub fn of_rollout(mut rollout: Rollout, mut goes_on: impl FnMut(u32) -> bool) -> Option<Self> {
        let steps = rollout.last_step();
        let keyframe_steps = steps.div_ceil(MAX_KEYFRAMES).max(MIN_STEPS_BETWEEN_KEYFRAMES);
        let sample_steps = steps.div_ceil(MAX_SAMPLES);
        let mut history = Self {
            keyframes: vec![rollout.clone()],
            keyframe_steps,
            sample_steps,
            joints: rollout.body().joints.len(),
            torques: Vec::new(),
            middles_m: vec![rollout.middle_m()],
            landed_at_step: None,
            touched_stairs_at_step: None,
            evaluation: rollout.evaluation(),
        };
        while rollout.advance() {
            let step = rollout.step();
            if !goes_on(step) {
                return None;
            }
            if (step - 1).is_multiple_of(sample_steps) {
                history.torques.extend(rollout.simulation().applied_torques());
            }
            if step.is_multiple_of(sample_steps) {
                history.middles_m.push(rollout.middle_m());
            }
            if step.is_multiple_of(keyframe_steps) {
                history.keyframes.push(rollout.clone());
            }
            if history.landed_at_step.is_none() && rollout.is_on_landing() {
                history.landed_at_step = Some(step);
            }
            if history.touched_stairs_at_step.is_none() && touches_stairs(&rollout) {
                history.touched_stairs_at_step = Some(step);
            }
        }
        history.evaluation = rollout.evaluation();
        Some(history)
    }

    /// Returns the rollout after `step` healthy steps, or at its end if the end comes earlier.
    pub fn rollout_at(&self, step: u32) -> Rollout {
        let last = self.keyframes.len() - 1;
        let index = ((step / self.keyframe_steps) as usize).min(last);
        let mut rollout = self.keyframes[index].clone();
        while rollout.step() < step && rollout.advance() {}
        rollout
    }

    /// Returns the step of the last keyframe at or before `step`.
    pub fn keyframe_before(&self, step: u32) -> u32 {
        let last = self.keyframes.len() as u32 - 1;
        (step / self.keyframe_steps).min(last) * self.keyframe_steps
    }

    /// Returns the evaluation at the end of the rollout.
    pub fn evaluation(&self) -> &Evaluation {
        &self.evaluation
    }

    /// Returns the step after which the middle limb first stood on the landing; `None` if it never did.
    pub fn landed_at_step(&self) -> Option<u32> {
        self.landed_at_step
    }

    /// Returns the step after which a limb first touched the stairs; `None` if none ever did.
    pub fn touched_stairs_at_step(&self) -> Option<u32> {
        self.touched_stairs_at_step
    }

    /// Returns the number of physics steps from one sample to the next.
    pub fn sample_steps(&self) -> u32 {
        self.sample_steps
    }

    /// Returns the torques on the joints in each sample: those of the step that begins at the sample.
    pub fn torques(&self) -> impl ExactSizeIterator<Item = &[JointTorque]> {
        self.torques.chunks_exact(self.joints.max(1))
    }

    /// Returns the positions of the middle limb's centre in each sample, in metres, beginning with the start.
    pub fn middles_m(&self) -> &[Vector] {
        &self.middles_m
    }
}

/// Distance before the first riser within which a contact counts as one with the stairs, in metres, because limbs sink in a little.
const RISER_MARGIN_M: f32 = 0.02;

/// Returns whether a limb touches the stairs now.
fn touches_stairs(rollout: &Rollout) -> bool {
    let stairs = rollout.stairs();
    let is_on_stairs = |at_m: Vector| {
        let is_behind_riser = at_m.y >= stairs.first_riser_y_m - RISER_MARGIN_M;
        stairs.steps > 0
            && is_behind_riser
            && at_m.y <= stairs.end_y_m()
            && at_m.x.abs() <= stairs.width_m / 2.0
    };
    // Contacts are listed only if a limb may be near the stairs, because listing them takes time.
    let reach_m = rollout.body().length_m();
    let is_near = rollout.middle_m().y >= stairs.first_riser_y_m - reach_m;
    is_near
        && rollout.simulation().contact_forces().iter().any(|contact| is_on_stairs(contact.at_m))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::save::shipped_champion;
    use crate::score::evaluate;

    fn whole(genome: &Genome, trial: &Trial) -> KeyframeHistory {
        KeyframeHistory::of(genome, trial, |_| true).expect("not stopped")
    }

    /// Returns every bit of the bodies' motion.
    fn state(rollout: &Rollout) -> Vec<[u32; 13]> {
        let parts = rollout.simulation().parts().iter();
        parts
            .map(|part| {
                let (at, turn, speed, spin) = (part.at, part.turn, part.linear, part.angular);
                [
                    at.x, at.y, at.z, turn.x, turn.y, turn.z, turn.w, speed.x, speed.y, speed.z,
                    spin.x, spin.y, spin.z,
                ]
                .map(f32::to_bits)
            })
            .collect()
    }

    #[test]
    fn seeking_to_a_step_gives_the_bits_of_playing_to_it_and_of_all_later_steps() {
        let champion = shipped_champion().expect("well formed").champion;
        let history = whole(&champion.genome, &champion.trial);
        let mut played = Rollout::new(&champion.genome, &champion.trial);
        let steps = champion.trial.steps();
        for target in [0, 1, 14, 15, 16, steps / 2, steps - 1, steps] {
            while played.step() < target {
                assert!(played.advance());
            }
            let mut sought = history.rollout_at(target);
            assert_eq!(sought.step(), target);
            assert_eq!(sought.evaluation(), played.evaluation(), "after {target} steps");
            assert_eq!(state(&sought), state(&played), "after {target} steps");
            while sought.advance() {}
            assert_eq!(sought.evaluation(), *history.evaluation(), "on from {target}");
        }
        assert_eq!(*history.evaluation(), evaluate(&champion.genome, &champion.trial));
        assert_eq!(history.rollout_at(u32::MAX).step(), steps, "beyond the end is the end");
    }

    #[test]
    fn a_history_holds_the_torques_the_path_and_the_landing() {
        let champion = shipped_champion().expect("well formed").champion;
        let history = whole(&champion.genome, &champion.trial);
        let steps = champion.trial.steps() as usize;
        assert_eq!(history.torques().len(), steps);
        assert_eq!(history.middles_m().len(), steps + 1);
        let last = history.middles_m().last().expect("the end");
        assert_eq!(last.y, history.evaluation().centre_y_m);
        let landed = history.landed_at_step().expect("it climbs");
        let before = history.rollout_at(landed - 1);
        assert!(!before.is_on_landing() && history.rollout_at(landed).is_on_landing());
        let mut at = history.rollout_at(99);
        at.advance();
        let torques: Vec<_> = at.simulation().applied_torques().collect();
        assert_eq!(history.torques().nth(99), Some(&torques[..]));
    }

    #[test]
    fn a_history_can_be_stopped_and_a_long_one_has_no_more_keyframes_than_a_short_one() {
        let champion = shipped_champion().expect("well formed").champion;
        let stopped = KeyframeHistory::of(&champion.genome, &champion.trial, |step| step < 7);
        assert!(stopped.is_none());
        let long = Trial { duration_s: 120.0, ..champion.trial };
        let history = whole(&champion.genome, &long);
        assert!(history.keyframes.len() as u32 <= MAX_KEYFRAMES + 1);
        assert!(history.middles_m().len() as u32 <= MAX_SAMPLES + 1);
    }

    #[test]
    fn a_pull_disturbs_a_rollout_from_its_first_step_on() {
        let champion = shipped_champion().expect("well formed").champion;
        let history = whole(&champion.genome, &champion.trial);
        let mut rollout = history.rollout_at(60);
        rollout.pull(None);
        assert!(!rollout.is_disturbed());
        let limb = 2;
        let above = rollout.poses()[limb].translation + Vector::new(0.0, 0.0, 3.0);
        rollout.pull(Some(crate::world::Pull { part: limb, held_at_m: Vector::ZERO, to_m: above }));
        for _ in 0..60 {
            assert!(rollout.advance(), "{:?}", rollout.evaluation().disqualified);
        }
        let undisturbed = history.rollout_at(120);
        assert!(rollout.is_disturbed() && !undisturbed.is_disturbed());
        let lifted = rollout.poses()[limb].translation.z - undisturbed.poses()[limb].translation.z;
        assert!(lifted > 0.5, "{lifted} m");
        rollout.pull(None);
        for _ in 0..120 {
            assert!(rollout.advance(), "{:?}", rollout.evaluation().disqualified);
        }
        assert!(rollout.poses()[limb].translation.z < above.z - 1.0, "it falls again");
    }

    #[test]
    fn a8_no_pull_disqualifies_however_far_it_goes() {
        let champion = shipped_champion().expect("well formed").champion;
        let mut rollout = Rollout::new(&champion.genome, &champion.trial);
        let targets_m = [[60.0, 0.0, 2.0], [-60.0, -60.0, 40.0], [0.0, 90.0, -20.0]];
        while rollout.step() < rollout.last_step() {
            let to_m = Vector::from(targets_m[rollout.step() as usize / 60 % targets_m.len()]);
            rollout.pull(Some(crate::world::Pull { part: 0, held_at_m: Vector::ZERO, to_m }));
            rollout.advance();
            assert_eq!(rollout.evaluation().disqualified, None, "step {}", rollout.step());
        }
    }
}
