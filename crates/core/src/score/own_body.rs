//! The body of a genome that contains the blocks of its body.

use super::AgentSettings;
use crate::genome::{BodyNode, Segment, grow, grown_body};
use crate::world::{BodyPlan, JointPlan, PartPlan, neighbours_pass};

/// Builds the body of these blocks, with the torques, the damping and the softness of the agent's joints.
///
/// Torque and damping of a joint grow with the cross-section of its weaker block, and with the block's height as the lever:
/// `min(A1, A2) · min(h1, h2) / 1 m³`. This factor is 1 for the blocks of the report. The strength of a muscle grows with its
/// cross-section (Sims 1994).
pub(super) fn own_body(agent: &AgentSettings, segments: &[Segment]) -> BodyPlan {
    let limb = |(limb, segment): (usize, &Segment)| PartPlan {
        limb,
        width_m: segment.width_m,
        length_m: segment.length_m,
        height_m: segment.height_m,
        density_kg_m3: segment.density_kg_m3,
    };
    let limbs: Vec<PartPlan> = segments.iter().enumerate().map(limb).collect();
    let joint = |(index, pair): (usize, &[PartPlan])| {
        let (front, rear, genes) = (&pair[0], &pair[1], &segments[index + 1]);
        let scale = strength_of([front, rear]);
        JointPlan {
            parent: index,
            child: index + 1,
            mount: None,
            bend_limit_rad: genes.bend_limit_rad,
            twist_limit_rad: genes.twist_limit_rad,
            max_bend_torque_nm: agent.max_bend_torque_nm.at(index) * scale * genes.strength,
            max_twist_torque_nm: agent.max_twist_torque_nm.at(index) * scale * genes.strength,
            damping_nms_per_rad: agent.joint_damping_nms_per_rad.at(index) * scale,
            gap_scale: front.smallest_side_m().min(rear.smallest_side_m()),
            cfm_m_s_per_n: agent.joint_cfm_m_s_per_n.at(index),
        }
    };
    let mut body = BodyPlan {
        joints: limbs.windows(2).enumerate().map(joint).collect(),
        contact_free_pairs: contact_free_pairs(&limbs),
        middle_part: BodyPlan::middle_by_mass(&limbs),
        parts: limbs,
        springs: Vec::new(),
        angular_damping_per_s: agent.angular_damping_per_s,
        holding_w_per_n2m2: agent.holding_w_per_n2m2(),
    };
    keep_torque_budget(&mut body, agent.torque_budget_nm);
    body.with_soft_limbs(|limb| {
        segments[limb].youngs_modulus_pa.map(|modulus_pa| agent.elasticity(modulus_pa))
    })
}

/// Builds the body of a creature from the parts that grow from its nodes, with torques and damping that grow as in `own_body`.
pub(super) fn creature_body(agent: &AgentSettings, nodes: &[BodyNode]) -> BodyPlan {
    let grown = grow(nodes);
    let mut body = grown_body(nodes, &grown);
    body.angular_damping_per_s = agent.angular_damping_per_s;
    body.holding_w_per_n2m2 = agent.holding_w_per_n2m2();
    for joint in &mut body.joints {
        let ends = [&body.parts[joint.parent], &body.parts[joint.child]];
        let (scale, node) = (strength_of(ends), &nodes[grown[joint.child].node]);
        let [bends, twists] = node.joint.turns();
        let torque_nm = |turns: bool, most_nm: f32| {
            if turns { most_nm * scale * node.strength } else { 0.0 }
        };
        joint.max_bend_torque_nm = torque_nm(bends, agent.max_bend_torque_nm.at(0));
        joint.max_twist_torque_nm = torque_nm(twists, agent.max_twist_torque_nm.at(0));
        joint.damping_nms_per_rad = agent.joint_damping_nms_per_rad.at(0) * scale;
        joint.cfm_m_s_per_n = agent.joint_cfm_m_s_per_n.at(0);
    }
    keep_torque_budget(&mut body, agent.torque_budget_nm);
    body
}

/// Returns the torque and damping of the joint of two parts, relative to a joint of the report's blocks.
fn strength_of([front, rear]: [&PartPlan; 2]) -> f32 {
    let section_m2 = (front.width_m * front.height_m).min(rear.width_m * rear.height_m);
    section_m2 * front.height_m.min(rear.height_m)
}

/// Reduces all torques by one factor if their sum exceeds the budget in N·m.
fn keep_torque_budget(body: &mut BodyPlan, budget_nm: f32) {
    let sum_nm = body.torque_nm();
    if sum_nm > budget_nm {
        let share = budget_nm / sum_nm;
        for joint in &mut body.joints {
            joint.max_bend_torque_nm *= share;
            joint.max_twist_torque_nm *= share;
        }
    }
}

/// Returns the pairs of neighbours of each short block.
fn contact_free_pairs(limbs: &[PartPlan]) -> Vec<[usize; 2]> {
    let triples = limbs.windows(3).enumerate();
    triples
        .filter(|(_, triple)| {
            neighbours_pass(triple[1].length_m, [triple[0].height_m, triple[2].height_m])
        })
        .map(|(index, _)| [index, index + 2])
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn block(length_m: f32, height_m: f32) -> PartPlan {
        PartPlan { limb: 0, width_m: 1.0, length_m, height_m, density_kg_m3: 2.5 }
    }

    #[test]
    fn neighbours_of_a_short_block_pass_through_each_other() {
        let pairs = |lengths_m: &[f32]| {
            let limbs: Vec<_> = lengths_m.iter().map(|&length_m| block(length_m, 1.0)).collect();
            contact_free_pairs(&limbs)
        };
        assert_eq!(pairs(&[2.0, 0.7, 2.0, 0.5, 2.0]), [[2, 4]]);
        assert_eq!(
            pairs(&[0.5, 2.0, 0.5]),
            Vec::<[usize; 2]>::new(),
            "ends have no two neighbours"
        );
        assert_eq!(pairs(&[2.0, 0.5, 0.5, 2.0]), [[0, 2], [1, 3]]);
        // The height of the taller neighbour counts.
        assert_eq!(
            contact_free_pairs(&[block(2.0, 0.4), block(0.7, 0.4), block(2.0, 1.5)]),
            [[0, 2]]
        );
    }

    /// Torque and damping depend on the cross-section of the weaker block and its height, the allowed gap on the smallest side.
    #[test]
    fn joints_are_as_strong_as_their_weaker_block() {
        let agent = AgentSettings { torque_budget_nm: f32::INFINITY, ..AgentSettings::default() };
        let segment = |width_m: f32, height_m: f32, strength: f32| Segment {
            width_m,
            length_m: 2.0,
            height_m,
            strength,
            id: 0,
            density_kg_m3: 2.5,
            bend_limit_rad: 1.0,
            twist_limit_rad: 0.5,
            youngs_modulus_pa: None,
        };
        let body = own_body(
            &agent,
            &[segment(1.0, 1.0, 0.1), segment(1.0, 1.0, 1.0), segment(0.5, 0.8, 0.5)],
        );
        let [first, second] = &body.joints[..] else { panic!("two joints") };
        assert_eq!(first.max_bend_torque_nm, agent.max_bend_torque_nm.at(0));
        assert_eq!(first.damping_nms_per_rad, agent.joint_damping_nms_per_rad.at(0));
        assert_eq!(first.gap_scale, 1.0);
        let scale = 0.5_f32 * 0.8 * 0.8;
        assert!(
            (second.max_bend_torque_nm / agent.max_bend_torque_nm.at(1) - 0.5 * scale).abs() < 1e-6
        );
        assert!(
            (second.damping_nms_per_rad / agent.joint_damping_nms_per_rad.at(1) - scale).abs()
                < 1e-6
        );
        assert_eq!(second.gap_scale, 0.5);
    }
}
