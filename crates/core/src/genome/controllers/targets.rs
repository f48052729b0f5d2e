//! Target angles, point by point: the actions of a policy outside this program, played back.

use serde::{Deserialize, Serialize};

use super::encoding::{
    ControllerEncoding, JointCommands, LengthVisitor, SERVO_SETTINGS, SettingNames, TWIST_SETTINGS,
};
use super::signal::{held_points, point_genes, rhythm, sign_changes_hz, signal_lengths, strength};
use super::wave::ANGLE;
use crate::genome::gene::{Feature, GeneRange, Genes, GenomeShape};
use crate::genome::space::{GenomeSpace, POINTS_PER_S};

/// One signal of target angles per joint axis, and the servo that follows them: a torque of
/// `stiffness · (target − angle) − damping · rate`, clamped to the joint's limit. Each target holds until the next.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TargetSignals {
    /// Torque per angle by which a joint misses its target, in N·m/rad.
    pub stiffness_nm_per_rad: f32,
    /// Torque against the joint's rate, in N·m·s/rad.
    pub servo_damping_nms_per_rad: f32,
    /// Targets that take effect per simulated second.
    pub points_per_s: f32,
    /// The signals of each joint, from the head; all signals have the same number of points.
    pub joints: Vec<JointTargets>,
}

/// The two signals of one joint, in radians.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JointTargets {
    /// Target of the bend, point by point.
    pub bend_rad: Vec<f32>,
    /// Target of the twist, point by point.
    pub twist_rad: Vec<f32>,
}

impl JointTargets {
    /// Returns the signals with the names of their fields and of their axes.
    fn axes(&self) -> [(&'static str, &'static str, &Vec<f32>); 2] {
        [("bend_rad", "bend", &self.bend_rad), ("twist_rad", "twist", &self.twist_rad)]
    }
}

impl TargetSignals {
    /// Returns every signal of the snake in a fixed order: joints from the head, bend before twist.
    fn all(&self) -> impl Iterator<Item = &Vec<f32>> {
        self.joints.iter().flat_map(|joint| [&joint.bend_rad, &joint.twist_rad])
    }
}

/// Returns the greatest targets of bends and twists in a space. A joint that cannot turn needs no search.
fn ranges_rad(space: &GenomeSpace) -> [f32; 2] {
    let [bend_turns, twist_turns] = space.turning_axes();
    let within = |turns: bool, range_rad: f32| if turns { range_rad } else { 0.0 };
    [
        within(bend_turns, space.wave.angle_range_rad),
        within(twist_turns, space.wave.twist_range_rad),
    ]
}

impl ControllerEncoding for TargetSignals {
    fn settings() -> SettingNames {
        &[&["points_per_s"], SERVO_SETTINGS, TWIST_SETTINGS]
    }

    fn zeroed(space: &GenomeSpace, shape: GenomeShape) -> Self {
        let signal = vec![0.0; space.points(shape.duration_s)];
        let joint = JointTargets { bend_rad: signal.clone(), twist_rad: signal };
        Self {
            stiffness_nm_per_rad: 0.0,
            servo_damping_nms_per_rad: space.wave.servo_damping_nms_per_rad,
            points_per_s: space.points_per_s,
            joints: vec![joint; shape.joints],
        }
    }

    fn genes(&mut self, space: &GenomeSpace, genes: &mut Genes<'_>) {
        let servo = [&mut self.stiffness_nm_per_rad, &mut self.servo_damping_nms_per_rad];
        space.wave.servo_genes(servo, genes);
        let (range, name) = (GeneRange::Fixed(space.points_per_s), "points per second");
        genes.gene("points_per_s", name, POINTS_PER_S, range, &mut self.points_per_s);
        let [bend_rad, twist_rad] = ranges_rad(space).map(GeneRange::around_zero);
        for (joint, signals) in self.joints.iter_mut().enumerate() {
            let JointTargets { bend_rad: bend, twist_rad: twist } = signals;
            point_genes(joint, ["bend", "bend_rad"], ANGLE, bend_rad, bend, genes);
            point_genes(joint, ["twist", "twist_rad"], ANGLE, twist_rad, twist, genes);
        }
    }

    fn lengths(&self, visit: LengthVisitor<'_>) {
        signal_lengths(self.joints.iter().map(JointTargets::axes), "target points", visit);
    }

    fn joints(&self) -> usize {
        self.joints.len()
    }

    fn estimated_frequency_hz(&self) -> Option<f32> {
        Some(sign_changes_hz(self.points_per_s, self.all()))
    }

    fn widen(&self, space: &mut GenomeSpace) {
        space.points_per_s = self.points_per_s;
        let most = |range_rad: f32, signal: fn(&JointTargets) -> &Vec<f32>| {
            let targets = self.joints.iter().flat_map(signal);
            targets.map(|target_rad| target_rad.abs()).fold(range_rad, f32::max)
        };
        let wave = &mut space.wave;
        wave.angle_range_rad = most(wave.angle_range_rad, |joint| &joint.bend_rad);
        wave.twist_range_rad = most(wave.twist_range_rad, |joint| &joint.twist_rad);
    }

    fn summary(&self, space: &GenomeSpace) -> Option<Vec<Feature>> {
        let hz = sign_changes_hz(self.points_per_s, self.all());
        let (stiffness, range) = (self.stiffness_nm_per_rad, space.wave.stiffnesses());
        let mut features = Vec::new();
        if !range.is_point() {
            features.push(Feature::new("stiffness".to_owned(), "N·m/rad", stiffness, range));
        }
        features.push(rhythm(hz, self.points_per_s));
        for (joint, signals) in (1..).zip(&self.joints) {
            for ((_, axis, signal), most_rad) in signals.axes().into_iter().zip(ranges_rad(space)) {
                features.push(strength(joint, axis, "rad", signal, most_rad));
            }
        }
        Some(features)
    }

    fn commands(&self, _duration_s: f64) -> Option<JointCommands> {
        let points = |targets: &[f32]| held_points(targets, self.points_per_s);
        let joint = |joint: &JointTargets| [points(&joint.bend_rad), points(&joint.twist_rad)];
        let joints = self.joints.iter().map(joint).collect();
        let quantity = "target angle in rad";
        Some(JointCommands { quantity, least_range: 1.0, is_held: true, joints })
    }
}
