//! Faults of a snake's drives, and pushes from the side: what differs from step to step in a perturbed trial.

use std::collections::VecDeque;

use rand::RngExt;
use rand_chacha::ChaCha8Rng;
use serde::{Deserialize, Serialize};

use crate::check::{Invalid, within};
use crate::rng::{Purpose, stream};
use crate::world::{JointPlan, JointTorque, Shove, Vector};

/// Greatest number of steps by which torques can be late.
pub const MOST_DELAY_STEPS: u32 = 10;

/// Faults of the drives in one trial. Each joint axis has its own gain and offset, which stay the same during the trial.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DriveFaults {
    /// Greatest relative change of a torque, to either side.
    pub gain: f32,
    /// Greatest torque that is added to a torque, to either side, as a share of the greatest torque of the axis.
    pub offset: f32,
    /// Greatest random torque of a step, to either side, as a share of the greatest torque of the axis.
    pub noise: f32,
    /// Number of steps by which the torques are late. Before the first torques arrive, the joints are not driven.
    pub delay_steps: u32,
    /// Number from which gains, offsets and noise are drawn.
    pub seed: u64,
}

impl DriveFaults {
    /// Checks that every value is one that a range of perturbations can draw.
    ///
    /// # Errors
    /// Returns the first value that is not allowed.
    pub fn check(&self) -> Result<(), Invalid> {
        for (field, share) in [("gain", self.gain), ("offset", self.offset), ("noise", self.noise)]
        {
            within(field, share, 0.0..=1.0)?;
        }
        within("delay_steps", self.delay_steps, 0..=MOST_DELAY_STEPS)
    }
}

/// The faulty drives of one snake during a trial.
#[derive(Debug, Clone)]
pub(super) struct FaultyDrives {
    faults: DriveFaults,
    /// Gain and offset of each joint's bend and twist; an offset is a share of the axis's greatest torque.
    constant: Vec<[[f32; 2]; 2]>,
    noise: ChaCha8Rng,
    /// Torques that have not arrived yet, the earliest first.
    late: VecDeque<Vec<JointTorque>>,
}

impl FaultyDrives {
    /// Draws the faults of a snake with this number of joints.
    pub fn new(faults: DriveFaults, joints: usize) -> Self {
        let mut rng = stream(faults.seed, 0, 0, Purpose::Drives);
        let mut around_zero = |most: f32| rng.random_range(-most..=most);
        let mut of_axis = || [1.0 + around_zero(faults.gain), around_zero(faults.offset)];
        let constant = (0..joints).map(|_| [of_axis(), of_axis()]).collect();
        let none = vec![JointTorque::default(); joints];
        Self {
            constant,
            noise: stream(faults.seed, 1, 0, Purpose::Drives),
            late: vec![none; faults.delay_steps as usize].into(),
            faults,
        }
    }

    /// Replaces the torques of a step, one per joint, by those that arrive at the joints.
    pub fn distort(&mut self, torques: &mut [JointTorque], joints: &[JointPlan]) {
        let most = self.faults.noise;
        for ((torque, joint), [bend, twist]) in torques.iter_mut().zip(joints).zip(&self.constant) {
            let mut arrives = |torque_nm: f32, [gain, offset]: &[f32; 2], greatest_nm: f32| {
                let noise = if most > 0.0 { self.noise.random_range(-most..=most) } else { 0.0 };
                torque_nm.clamp(-greatest_nm, greatest_nm) * gain + (offset + noise) * greatest_nm
            };
            torque.bend_nm = arrives(torque.bend_nm, bend, joint.max_bend_torque_nm);
            torque.twist_nm = arrives(torque.twist_nm, twist, joint.max_twist_torque_nm);
        }
        if let Some(mut arrived) = self.late.pop_front() {
            arrived.swap_with_slice(torques);
            self.late.push_back(arrived);
        }
    }
}

/// Pushes from the side: once in each second, a limb is pushed to the left or to the right.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SidePushes {
    /// Greatest change of a limb's velocity by a push, in m/s.
    pub change_m_s: f32,
    /// Number from which limbs and changes are drawn.
    pub seed: u64,
}

impl SidePushes {
    /// Checks that every value is one that a range of perturbations can draw.
    ///
    /// # Errors
    /// Returns the first value that is not allowed.
    pub fn check(&self) -> Result<(), Invalid> {
        within("change_m_s", self.change_m_s, 0.0..=10.0)
    }

    /// Returns the push before a step, if one is due. `limbs` is the number of limbs.
    pub fn due(&self, step: u32, steps_per_s: u32, limbs: usize) -> Option<Shove> {
        let second = step / steps_per_s;
        if second == 0 || !step.is_multiple_of(steps_per_s) {
            return None;
        }
        let mut rng = stream(self.seed, second, 0, Purpose::Drives);
        let limb = rng.random_range(0..limbs as u32) as usize;
        let change_m_s = Vector::X * rng.random_range(-self.change_m_s..=self.change_m_s);
        Some(Shove { limb, at_s: second as f32, change_m_s })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::save::shipped_champion;
    use crate::score::{Evaluation, Perturbation, Rollout};

    const NONE: DriveFaults =
        DriveFaults { gain: 0.0, offset: 0.0, noise: 0.0, delay_steps: 0, seed: 1 };

    /// Returns the evaluation of the shipped climber over five seconds, with this perturbation.
    fn with(off: Perturbation) -> Evaluation {
        let champion = shipped_champion().expect("shipped").champion;
        let mut trial = champion.trial;
        trial.duration_s = 5.0;
        off.check().expect("allowed");
        let mut rollout = Rollout::perturbed(&champion.genome, &trial, &off);
        while rollout.advance() {}
        rollout.evaluation()
    }

    fn with_drives(faults: DriveFaults) -> Evaluation {
        with(Perturbation { drives: Some(faults), ..Perturbation::default() })
    }

    #[test]
    fn each_fault_of_the_drives_changes_the_trial_by_its_seed_and_none_leaves_its_bits() {
        let whole = with(Perturbation::default());
        assert_eq!(with_drives(NONE), whole);
        for faults in [
            DriveFaults { gain: 0.2, ..NONE },
            DriveFaults { offset: 0.05, ..NONE },
            DriveFaults { noise: 0.1, ..NONE },
        ] {
            let found = with_drives(faults).trace_hash;
            assert_ne!(found, whole.trace_hash, "{faults:?}");
            assert_eq!(found, with_drives(faults).trace_hash, "{faults:?}");
            assert_ne!(found, with_drives(DriveFaults { seed: 2, ..faults }).trace_hash);
        }
        let late = with_drives(DriveFaults { delay_steps: 2, ..NONE });
        assert_ne!(late.trace_hash, whole.trace_hash);
    }

    #[test]
    fn late_torques_arrive_unchanged_after_their_delay() {
        let champion = shipped_champion().expect("shipped").champion;
        let joints = &champion.trial.world_plan(&champion.genome).body.joints[..1];
        let mut drives = FaultyDrives::new(DriveFaults { delay_steps: 2, ..NONE }, 1);
        let arrived: Vec<f32> = (1..6_u8)
            .map(|step| {
                let mut torques = [JointTorque { bend_nm: step.into(), twist_nm: 0.0 }];
                drives.distort(&mut torques, joints);
                torques[0].bend_nm
            })
            .collect();
        assert_eq!(arrived, [0.0, 0.0, 1.0, 2.0, 3.0]);
    }

    #[test]
    fn a_push_comes_once_in_each_second_and_goes_to_either_side() {
        let pushes = SidePushes { change_m_s: 2.0, seed: 7 };
        let due: Vec<Shove> = (0..1200).filter_map(|step| pushes.due(step, 60, 5)).collect();
        assert_eq!(due.len(), 19);
        assert!(due.iter().all(|push| push.limb < 5 && push.change_m_s.x.abs() <= 2.0));
        assert!(due.iter().any(|push| push.change_m_s.x > 0.2));
        assert!(due.iter().any(|push| push.change_m_s.x < -0.2));
        let pushed = with(Perturbation { pushes: Some(pushes), ..Perturbation::default() });
        assert_ne!(pushed.trace_hash, with(Perturbation::default()).trace_hash);
    }

    #[test]
    fn gravity_contacts_and_joints_differ_where_a_perturbation_says_so() {
        let whole = with(Perturbation::default()).trace_hash;
        let none = Perturbation::default;
        for off in [
            Perturbation { gravity: 1.05, ..none() },
            Perturbation { bounce: 0.2, ..none() },
            Perturbation { softness_m_s_per_n: 1.0e-4, ..none() },
            Perturbation { joint_damping: 1.5, ..none() },
        ] {
            assert_ne!(with(off).trace_hash, whole, "{off:?}");
        }
    }
}
