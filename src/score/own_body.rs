//! The built body of a genome with blocks of its own.

use super::AgentSettings;
use crate::genome::Segment;
use crate::world::{BodyPlan, JointPlan, LimbPlan};

/// The body of some blocks, with the torques, the damping and the softness of the agent's joints.
///
/// Torque and damping of a joint grow with the cross-section of its weaker block, and with its height as the lever:
/// `min(A1, A2) · min(h1, h2) / 1 m³`. That is 1 for the blocks of the report. The strength of a muscle grows with its
/// cross-section (Sims 1994).
pub(super) fn own_body(agent: &AgentSettings, segments: &[Segment]) -> BodyPlan {
    let limb = |segment: &Segment| LimbPlan {
        width_m: segment.width_m,
        length_m: segment.length_m,
        height_m: segment.height_m,
        density_kg_m3: segment.density_kg_m3,
    };
    let limbs: Vec<LimbPlan> = segments.iter().map(limb).collect();
    let joint = |(index, pair): (usize, &[LimbPlan])| {
        let (front, rear, genes) = (&pair[0], &pair[1], &segments[index + 1]);
        let section_m2 = (front.width_m * front.height_m).min(rear.width_m * rear.height_m);
        let scale = section_m2 * front.height_m.min(rear.height_m);
        let smallest_side =
            |limb: &LimbPlan| limb.size_m().into_iter().fold(f32::INFINITY, f32::min);
        JointPlan {
            parent: index,
            child: index + 1,
            bend_limit_rad: genes.bend_limit_rad,
            twist_limit_rad: genes.twist_limit_rad,
            max_bend_torque_nm: agent.max_bend_torque_nm.at(index) * scale * genes.strength,
            max_twist_torque_nm: agent.max_twist_torque_nm.at(index) * scale * genes.strength,
            damping_nms_per_rad: agent.joint_damping_nms_per_rad.at(index) * scale,
            gap_scale: smallest_side(front).min(smallest_side(rear)),
            cfm_m_s_per_n: agent.joint_cfm_m_s_per_n.at(index),
        }
    };
    let mut joints: Vec<JointPlan> = limbs.windows(2).enumerate().map(joint).collect();
    let sum_nm: f32 =
        joints.iter().map(|joint| joint.max_bend_torque_nm + joint.max_twist_torque_nm).sum();
    if sum_nm > agent.torque_budget_nm {
        let share = agent.torque_budget_nm / sum_nm;
        for joint in &mut joints {
            joint.max_bend_torque_nm *= share;
            joint.max_twist_torque_nm *= share;
        }
    }
    BodyPlan {
        middle_limb: BodyPlan::middle_by_mass(&limbs),
        limbs,
        joints,
        angular_damping_per_s: agent.angular_damping_per_s,
    }
}
