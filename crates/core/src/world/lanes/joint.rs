//! Universal joints between limbs, the springs within soft limbs, and the order in which they are solved.

use crate::world::contact::joint_coefficients;
use crate::world::{JointPlan, PhysicsSettings, SpringPlan, Vector};

/// A joint or a spring that holds a part on the part before it, and its place there.
#[derive(Debug, Clone, Copy)]
pub(super) enum Hold {
    /// A universal joint at the rear face of the front part, with the axes of that part.
    Straight,
    /// A universal joint at a place on the front part, in metres from its centre. The quaternion turns the front part's axes to those of
    /// the joint.
    Mounted { at_m: Vector, turn: [f32; 4] },
    /// A spring at the rear face of the front part. For each of the axes of that part, it has the share of the angle that the spring
    /// takes back per second, and the compliance, in 1/(N·m·s): how much angular velocity the spring lets pass per angular impulse.
    Spring([[f32; 2]; 3]),
}

/// The two parts that a joint or a spring connects, and how it holds them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct JointShape {
    /// Indices of the two connected parts, the front one first.
    pub parts: [usize; 2],
    /// Whether the joint has a place and axes of its own on its front part.
    pub is_mounted: bool,
    /// Whether it is a spring of a soft limb.
    pub is_spring: bool,
}

/// A universal joint, or a spring of a soft limb, between a part and the front face of a later one.
#[derive(Debug, Clone)]
pub(super) struct Joint {
    /// Indices of the two connected parts, the front one first.
    pub parts: [usize; 2],
    pub hold: Hold,
    /// Sine and cosine of half of the greatest bend and twist; `None` where the axis turns freely.
    pub half_limits: [Option<[f32; 2]>; 2],
    /// Damping that the solver integrates, in N·m·s/rad: a share of the joint's damping.
    pub damping_nms: f32,
    /// Share of a position error of the joint that is corrected, per second.
    pub correction_per_s: f32,
    /// Compliance of the joint, as a share of a row's own inverse mass.
    pub compliance: f32,
}

impl Joint {
    /// Builds a universal joint between parts with these masses, in kg.
    pub fn universal(
        plan: &JointPlan,
        physics: &PhysicsSettings,
        [front_kg, rear_kg]: [f32; 2],
    ) -> Self {
        let substep_s = physics.substep_s();
        let soft = joint_coefficients(plan.cfm_m_s_per_n, substep_s, front_kg, rear_kg);
        Self {
            parts: [plan.parent, plan.child],
            hold: plan.mount.map_or(Hold::Straight, |mount| Hold::Mounted {
                at_m: mount.at_m,
                turn: mount.turn.to_array(),
            }),
            half_limits: [plan.bend_limit_rad, plan.twist_limit_rad].map(half_limit),
            damping_nms: physics.joint_damping_in_solver() * plan.damping_nms_per_rad,
            correction_per_s: soft.erp_inv_dt(substep_s),
            compliance: soft.cfm_coeff(substep_s),
        }
    }

    /// Builds a spring, which the solver integrates implicitly: with the stiffness k, the damping c and the length h of a substep, it is a
    /// row that takes back the share `k / (h k + c)` of the angle per second and has the compliance `1 / (h² k + h c)`, as a motor of
    /// rapier.
    pub fn spring(plan: &SpringPlan, substep_s: f32) -> Self {
        let rigid = joint_coefficients(0.0, substep_s, 1.0, 1.0);
        let elastic = std::array::from_fn(|axis| {
            let stiffness = plan.stiffness_nm_per_rad[axis];
            let resisting = substep_s * stiffness + plan.damping_nms_per_rad[axis];
            [stiffness / resisting, 1.0 / (substep_s * resisting)]
        });
        Self {
            parts: [plan.parent, plan.child],
            hold: Hold::Spring(elastic),
            half_limits: [None; 2],
            damping_nms: 0.0,
            correction_per_s: rigid.erp_inv_dt(substep_s),
            compliance: rigid.cfm_coeff(substep_s),
        }
    }

    /// Returns which parts the joint connects, and how.
    pub fn shape(&self) -> JointShape {
        JointShape {
            parts: self.parts,
            is_mounted: matches!(self.hold, Hold::Mounted { .. }),
            is_spring: matches!(self.hold, Hold::Spring(_)),
        }
    }
}

/// Sorts joints into the order in which they are solved, which is that of rapier: from the head, each joint joins the first group none of
/// whose joints has a part in common with it, and the groups are solved one after another. In a row of parts, these are every second joint
/// and then the joints between them.
pub(super) fn in_groups(mut joints: Vec<Joint>, parts: usize) -> Vec<Joint> {
    joints.sort_by_key(|joint| joint.parts[1]);
    let mut groups_of = vec![Vec::new(); parts];
    let mut sorted: Vec<(usize, Joint)> = Vec::with_capacity(joints.len());
    for joint in joints {
        let [front, rear] = joint.parts;
        let is_taken =
            |group: &usize| [front, rear].iter().any(|of| groups_of[*of].contains(group));
        let group = (0..parts).find(|group| !is_taken(group)).unwrap_or(parts);
        groups_of[front].push(group);
        groups_of[rear].push(group);
        sorted.push((group, joint));
    }
    sorted.sort_by_key(|(group, _)| *group);
    sorted.into_iter().map(|(_, joint)| joint).collect()
}

/// Returns the sine and cosine of half a limit; `None` for a limit of half a turn or more, which no angle exceeds.
fn half_limit(limit_rad: f32) -> Option<[f32; 2]> {
    (limit_rad < std::f32::consts::PI).then(|| {
        let (sin, cos) = libm::sincosf(limit_rad / 2.0);
        [sin, cos]
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn joints_of_a_group_have_no_part_in_common() {
        let joint = |(child, parent): (usize, usize)| {
            let plan = SpringPlan {
                parent,
                child,
                stiffness_nm_per_rad: [1.0; 3],
                damping_nms_per_rad: [0.0; 3],
                gap_scale: 1.0,
            };
            Joint::spring(&plan, 0.01)
        };
        let order = |parents: &[usize]| -> Vec<[usize; 2]> {
            let joints = (1..).zip(parents.iter().copied()).map(joint).collect();
            in_groups(joints, parents.len() + 1).iter().map(|joint| joint.parts).collect()
        };
        assert_eq!(order(&[0, 1, 2, 3, 4]), [[0, 1], [2, 3], [4, 5], [1, 2], [3, 4]]);
        // The tree has three groups: of two joints, of two, and of one.
        assert_eq!(order(&[0, 0, 1, 2, 2]), [[0, 1], [2, 4], [0, 2], [1, 3], [2, 5]]);
    }
}
