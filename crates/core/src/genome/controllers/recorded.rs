//! The actions of a policy outside this program as genes, which play them back to the bit.

use super::ControllerGenes;
use super::signal::{JointSignals, TorqueSignals, point_at};
use super::targets::{JointTargets, TargetSignals};
use crate::genome::space::{GenomeSpace, POINTS_PER_S_RANGE};

/// Actions of a policy in an episode.
#[derive(Debug, Clone, Copy)]
pub struct RecordedActions<'a> {
    /// One action after another: bend and twist of each joint, from the head. An action is a target angle in radians if there is a
    /// servo, otherwise a torque in N·m.
    pub values: &'a [f32],
    /// Number of joints.
    pub joints: usize,
    /// Physics steps for which an action holds.
    pub steps_per_action: u32,
    /// Physics steps per simulated second.
    pub steps_per_s: u32,
    /// Length of the trial, in seconds. If the episode ended before, its last action holds to the end.
    pub duration_s: f32,
    /// Stiffness in N·m/rad and damping in N·m·s/rad of the servo that followed the actions.
    pub servo: Option<[f32; 2]>,
}

impl RecordedActions<'_> {
    /// Returns the genes that play the actions back.
    pub fn genes(&self) -> ControllerGenes {
        let (points_per_s, copies) = self.rate();
        let points = GenomeSpace { points_per_s, ..GenomeSpace::default() }.points(self.duration_s);
        let signal = |axis: usize| -> Vec<f32> {
            let values = self.values.iter().skip(axis).step_by((2 * self.joints).max(1));
            let mut signal: Vec<f32> =
                values.flat_map(|value| std::iter::repeat_n(*value, copies)).take(points).collect();
            signal.resize(points, signal.last().copied().unwrap_or(0.0));
            signal
        };
        let axes = (0..self.joints).map(|joint| [signal(2 * joint), signal(2 * joint + 1)]);
        match self.servo {
            Some([stiffness_nm_per_rad, servo_damping_nms_per_rad]) => {
                let joints = axes
                    .map(|[bend_rad, twist_rad]| JointTargets { bend_rad, twist_rad })
                    .collect();
                ControllerGenes::Targets(TargetSignals {
                    stiffness_nm_per_rad,
                    servo_damping_nms_per_rad,
                    points_per_s,
                    joints,
                })
            }
            None => {
                let joints =
                    axes.map(|[bend_nm, twist_nm]| JointSignals { bend_nm, twist_nm }).collect();
                ControllerGenes::Signal(TorqueSignals { points_per_s, joints })
            }
        }
    }

    /// Returns the points per second at which each action begins in its step, and the number of points for each action. A rate that 32 bits
    /// cannot hold is rounded up, so that no action begins a step late.
    fn rate(&self) -> (f32, usize) {
        let Self { steps_per_action, steps_per_s, .. } = *self;
        let steps = self.duration_s * steps_per_s as f32;
        let in_time = |rate: &f32| {
            let at = |step| point_at(step, *rate, steps_per_s);
            let actions = 0..=steps as u32 / steps_per_action.max(1);
            POINTS_PER_S_RANGE.contains(rate)
                && actions.into_iter().all(|action| {
                    let first = action * steps_per_action;
                    [at(first), at(first + steps_per_action - 1)] == [action as usize; 2]
                })
        };
        let nearest = (f64::from(steps_per_s) / f64::from(steps_per_action)) as f32;
        let found = [nearest, nearest.next_up()].into_iter().find(in_time);
        found.map_or((steps_per_s as f32, steps_per_action as usize), |rate| (rate, 1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn r10_each_action_begins_in_its_step_and_the_last_holds_to_the_end() {
        for steps_per_s in [60_u32, 100, 120, 240] {
            for steps_per_action in [1, 2, 3, 4, 7, 11, 49, 59, 700, 1000] {
                let steps = 30 * steps_per_s;
                // The episode ends after half of the trial.
                let actions = (steps / 2).div_ceil(steps_per_action);
                let values: Vec<f32> = (0..2 * actions).map(|index| index as f32).collect();
                for servo in [None, Some([100.0, 10.0])] {
                    let recorded = RecordedActions {
                        values: &values,
                        joints: 1,
                        steps_per_action,
                        steps_per_s,
                        duration_s: 30.0,
                        servo,
                    };
                    let (rate, [bend, twist]) = match recorded.genes() {
                        ControllerGenes::Signal(TorqueSignals { points_per_s, mut joints }) => {
                            let JointSignals { bend_nm, twist_nm } = joints.remove(0);
                            (points_per_s, [bend_nm, twist_nm])
                        }
                        ControllerGenes::Targets(mut genes) => {
                            assert_eq!(genes.stiffness_nm_per_rad, 100.0);
                            let JointTargets { bend_rad, twist_rad } = genes.joints.remove(0);
                            (genes.points_per_s, [bend_rad, twist_rad])
                        }
                        other => panic!("{}", other.kind()),
                    };
                    for step in 0..steps {
                        let action = (step / steps_per_action).min(actions - 1) as f32;
                        let point = point_at(step, rate, steps_per_s);
                        let played = [&bend, &twist].map(|signal| signal[point]);
                        let case = format!("{steps_per_s}, {steps_per_action}, step {step}");
                        assert_eq!(played, [2.0 * action, 2.0 * action + 1.0], "{case}");
                    }
                }
            }
        }
    }
}
