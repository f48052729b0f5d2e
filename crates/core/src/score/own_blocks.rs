//! Trials of bodies with blocks in the genome, and the conversion of a common body to such blocks.

use super::Trial;
use crate::check::Invalid;
use crate::genome::{BodyGenes, ControllerKind, Genome, Segment};
use crate::schema::PerPart;
use crate::world::{BodyPlan, JointPlan};

impl Trial {
    /// Checks that bodies with blocks in the genome can be evaluated: all joints have the same settings, and joints and surfaces are not
    /// soft.
    ///
    /// Returns the first setting that does not fit.
    pub fn check_own_bodies(&self) -> Result<(), Invalid> {
        let agent = &self.agent;
        for (field, value) in [
            ("max_bend_torque_nm", &agent.max_bend_torque_nm),
            ("max_twist_torque_nm", &agent.max_twist_torque_nm),
            ("joint_damping_nms_per_rad", &agent.joint_damping_nms_per_rad),
            ("joint_cfm_m_s_per_n", &agent.joint_cfm_m_s_per_n),
        ] {
            if let PerPart::Each(values) = value {
                let value = format!("a list of {}", values.len());
                let field = format!("agent.{field}");
                return Err(Invalid::new(field, value, "one value while bodies evolve"));
            }
        }
        // The engine computes the springs of all soft joints and surfaces for one mass, but the masses of evolving limbs differ.
        for (field, cfm) in [
            ("agent.joint_cfm_m_s_per_n", agent.joint_cfm_m_s_per_n.at(0)),
            ("surface.soft_cfm_m_s_per_n", self.surface.soft_cfm_m_s_per_n),
            ("ground.soft_cfm_m_s_per_n", self.ground().soft_cfm_m_s_per_n),
            ("agent.skin.soft_cfm_m_s_per_n", agent.skin.soft_cfm_m_s_per_n),
            ("repeats.off.softness_m_s_per_n", self.repeats.off.softness_m_s_per_n),
        ] {
            if cfm > 0.0 {
                return Err(Invalid::new(field, cfm, "0 while bodies evolve"));
            }
        }
        Ok(())
    }

    /// Returns a genome with the same body as blocks in the genome, so that each block can change separately. A genome that already has
    /// blocks stays as it is.
    ///
    /// Returns an error if the controller cannot follow a changing body, if a setting does not fit blocks in the genome, or if such blocks
    /// would have joints of another strength.
    pub fn with_own_blocks(&self, genome: &Genome) -> Result<Genome, Invalid> {
        let kind = genome.controller.kind();
        if !matches!(kind, ControllerKind::Wave | ControllerKind::Gait) {
            return Err(Invalid::new(
                "controller",
                kind,
                "wave, gait: they follow a changing body",
            ));
        }
        self.check_own_bodies()?;
        if genome.body.has_own_blocks() {
            return Ok(genome.clone());
        }
        let body = self.agent.body_plan(genome);
        let segment = |index: usize| {
            // The genes of the head's joint have no effect until a block comes before the head, so they are copied from the first joint.
            let joint = body.joints.get(index.saturating_sub(1));
            let [width_m, length_m, height_m] = body.limb_size_m(index);
            Segment {
                id: index as u64 + 1,
                length_m,
                width_m,
                height_m,
                density_kg_m3: body.limb_density_kg_m3(index),
                bend_limit_rad: joint.map_or(0.0, |joint| joint.bend_limit_rad),
                twist_limit_rad: joint.map_or(0.0, |joint| joint.twist_limit_rad),
                strength: 1.0,
                youngs_modulus_pa: self.agent.youngs_modulus_pa.as_ref().map(|of| of.at(index)),
            }
        };
        let segments = (0..body.limbs()).map(segment).collect();
        let own = Genome { body: BodyGenes::of_blocks(segments), ..genome.clone() };
        let built = self.agent.body_plan(&own);
        let strengths = |of: &BodyPlan| -> Vec<[f32; 3]> {
            let joint = |of: &JointPlan| {
                [of.max_bend_torque_nm, of.max_twist_torque_nm, of.damping_nms_per_rad]
            };
            of.joints.iter().map(joint).collect()
        };
        if strengths(&built) != strengths(&body)
            || built.contact_free_pairs != body.contact_free_pairs
        {
            let allowed = "blocks of 1 m by 1 m within the torque budget: a joint of a block of its own is as strong as \
                           its cross-section";
            return Err(Invalid::new("the body", "stronger or weaker than its blocks", allowed));
        }
        Ok(own)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_snake_with_blocks_of_its_own_has_the_same_body() {
        let champion = crate::save::shipped_champion().expect("shipped").champion;
        let (trial, genome) = (&champion.trial, &champion.genome);
        let own = trial.with_own_blocks(genome).expect("a gait");
        assert_eq!(trial.agent.body_plan(&own), trial.agent.body_plan(genome));
        assert_eq!(own.body.check(), Ok(()));
        assert_eq!(trial.with_own_blocks(&own), Ok(own));
    }

    #[test]
    fn a_snake_whose_joints_would_change_keeps_its_common_blocks() {
        let champion = crate::save::shipped_champion().expect("shipped").champion;
        let refused = |change: fn(&mut Trial)| {
            let mut trial = champion.trial.clone();
            change(&mut trial);
            trial.with_own_blocks(&champion.genome).expect_err("refused").to_string()
        };
        let wide = refused(|trial| trial.agent.limb_width_m = PerPart::All(1.5));
        assert!(wide.starts_with("the body is stronger or weaker than its blocks"), "{wide}");
        let poor = refused(|trial| trial.agent.torque_budget_nm = 4000.0);
        assert!(poor.starts_with("the body is stronger or weaker than its blocks"), "{poor}");
        let soft = refused(|trial| trial.agent.skin.soft_cfm_m_s_per_n = 0.001);
        assert_eq!(soft, "agent.skin.soft_cfm_m_s_per_n is 0.001; allowed: 0 while bodies evolve");
        let list = refused(|trial| trial.agent.max_bend_torque_nm = PerPart::Each(vec![900.0; 4]));
        assert!(list.starts_with("agent.max_bend_torque_nm is a list of 4"), "{list}");
    }
}
