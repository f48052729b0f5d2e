//! Branching bodies: where a joint holds its child on its parent, and how a branching body stands before its trial.

use super::turning::product;
use super::{BodyPlan, JointPlan, PartPlan, Pose, Rotation, Vector};

/// Where a joint holds a part of a branching body. The child always begins at the joint with its front face, and extends
/// backwards from there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Mount {
    /// Place of the joint on the parent, in metres from the parent's centre, along its axes.
    pub at_m: Vector,
    /// Rotation of the child against its parent in the middle of the joint's range. The joint bends about the x axis of the
    /// rotated frame and twists about its y axis.
    pub turn: Rotation,
    /// Bend and twist at the start, measured from the middle of the range, in radians. The built pose need not be the middle of a joint's
    /// range. The limits are symmetric about the middle, as the engine needs them to compute equal bits everywhere.
    pub start_rad: [f32; 2],
}

impl Mount {
    /// Returns the pose before a trial of a child of this length, in metres, given the pose of its parent.
    pub fn place(&self, parent: &Pose, length_m: f32) -> Pose {
        let turn = parent.rotation * (self.turn * joint_turn(self.start_rad));
        let at = parent.translation + parent.rotation * self.at_m;
        Pose::from_parts(at - turn * Vector::new(0.0, length_m / 2.0, 0.0), turn)
    }

    /// Returns the mount of a part of a chain or of a soft limb: straight behind a parent of this length, in metres.
    fn straight_behind(length_m: f32) -> Self {
        let at_m = Vector::new(0.0, -length_m / 2.0, 0.0);
        Self { at_m, turn: Rotation::IDENTITY, start_rad: [0.0; 2] }
    }
}

/// Returns the rotation of a universal joint at a bend and a twist, in radians. The quaternion has no z part.
pub fn joint_turn([bend_rad, twist_rad]: [f32; 2]) -> Rotation {
    let [x, y] = [bend_rad, twist_rad].map(|angle_rad| libm::tanf(angle_rad / 2.0));
    Rotation::from_xyzw(x, y, 0.0, 1.0).normalize()
}

impl PartPlan {
    /// Returns half the extent of the part along each axis of a frame in which the part has this rotation, in metres.
    pub(super) fn reach_m(&self, turn: Rotation) -> Vector {
        let axes = [Vector::X, Vector::Y, Vector::Z].into_iter().zip(self.size_m());
        axes.map(|(axis, size_m)| (turn * axis).abs() * (size_m / 2.0)).sum()
    }
}

impl JointPlan {
    /// Returns the axes of the joint in a frame in which its parent has this rotation: the joint bends about x and twists about y.
    pub fn axes(&self, parent: Rotation) -> Rotation {
        self.mount.map_or(parent, |mount| product(parent, mount.turn))
    }

    /// Returns the place of the joint on its parent, in metres from the parent's centre, for a parent of this length in metres.
    pub fn anchor_m(&self, parent_length_m: f32) -> Vector {
        self.mount.unwrap_or_else(|| Mount::straight_behind(parent_length_m)).at_m
    }
}

impl BodyPlan {
    /// Returns whether the body's parts form a tree instead of a row.
    pub fn is_branching(&self) -> bool {
        self.joints.iter().any(|joint| joint.mount.is_some())
    }

    /// Computes the poses of the parts of a body before its trial. The body's foremost point lies at y = 0, its lowest at z = 0, its
    /// centre of mass at x = 0.
    pub fn rest_poses(&self) -> Vec<Pose> {
        let mut poses = vec![Pose::from_parts(Vector::ZERO, Rotation::IDENTITY); self.parts.len()];
        let joints = self.joints.iter().map(|joint| ([joint.parent, joint.child], joint.mount));
        let springs = self.springs.iter().map(|spring| ([spring.parent, spring.child], None));
        let mut all: Vec<_> = joints.chain(springs).collect();
        all.sort_by_key(|([_, child], _)| *child);
        for ([front, rear], mount) in all {
            let [front_m, rear_m] = [front, rear].map(|part| self.parts[part].length_m);
            let mount = mount.unwrap_or_else(|| Mount::straight_behind(front_m));
            poses[rear] = mount.place(&poses[front], rear_m);
        }
        let (mut front_y_m, mut lowest_z_m) = (f32::NEG_INFINITY, f32::INFINITY);
        let mut moment_x = 0.0;
        for (pose, part) in poses.iter().zip(&self.parts) {
            let reach = part.reach_m(pose.rotation);
            front_y_m = front_y_m.max(pose.translation.y + reach.y);
            lowest_z_m = lowest_z_m.min(pose.translation.z - reach.z);
            moment_x += pose.translation.x * part.mass_kg();
        }
        let shift = Vector::new(moment_x / self.mass_kg(), front_y_m, lowest_z_m);
        poses.iter_mut().for_each(|pose| pose.translation -= shift);
        poses
    }

    /// Returns the least and the greatest corner of a box around each part before the trial, in metres: see [`Self::rest_poses`].
    pub fn rest_boxes_m(&self) -> Vec<[Vector; 2]> {
        let parts = self.rest_poses().into_iter().zip(&self.parts);
        let around = |(pose, part): (Pose, &PartPlan)| {
            let reach = part.reach_m(pose.rotation);
            [pose.translation - reach, pose.translation + reach]
        };
        parts.map(around).collect()
    }

    /// Returns the extent of a branching body along y before its trial, in metres.
    pub(super) fn branching_length_m(&self) -> f32 {
        // The front of the body lies at y = 0.
        -self.rest_boxes_m().into_iter().map(|[rear, _]| rear.y).fold(0.0, f32::min)
    }

    /// Returns the index of the part whose centre is nearest to the centre of mass of a branching body before its trial; of several, the
    /// first.
    pub fn branching_middle(&self) -> usize {
        let poses = self.rest_poses();
        let moments = poses.iter().zip(&self.parts);
        let moment: Vector = moments.map(|(pose, part)| pose.translation * part.mass_kg()).sum();
        let centre = moment / self.mass_kg();
        let off = |index: &usize| poses[*index].translation.distance_squared(centre);
        (0..poses.len()).min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(0)
    }
}
