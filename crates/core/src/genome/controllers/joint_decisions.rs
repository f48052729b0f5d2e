//! Decisions of each joint: every joint decides four times a second whether it bends up, bends down or straightens, by rules of its own
//! about what it senses nearby.
//!
//! The method is this project's own variant of XCS (Wilson, 1995), not a published method: one system of rules per joint. The systems see
//! different situations and share one reward.

use std::sync::Arc;

use serde::{Deserialize, Serialize};
use xxhash_rust::xxh3::Xxh3Default;

use super::decisions::{DECISIONS_PER_S, Explorer, hash_xcs, shared};
use super::encoding::{ControllerEncoding, SERVO_SETTINGS, SettingNames};
use super::servo::ServoGenes;
use crate::check::{Invalid, within};
use crate::genome::gene::{Genes, GenomeShape};
use crate::genome::space::GenomeSpace;
use crate::learn::classifiers::{Xcs, XcsSettings};

/// Names of the bends among which a joint decides, in their order. An arched joint lies above its neighbours, a sagging one below.
pub const JOINT_BENDS: [&str; 3] = ["straight", "arch", "sag"];

/// Bits of the situation of a joint, in their order: the words for a bit that is set, and for one that is not.
pub const JOINT_BITS: [[&str; 2]; 12] = [
    ["arched", "not arched"],
    ["sagging", "not sagging"],
    ["joint ahead arched", "joint ahead not arched"],
    ["joint ahead sagging", "joint ahead not sagging"],
    ["joint behind arched", "joint behind not arched"],
    ["joint behind sagging", "joint behind not sagging"],
    ["block ahead touches", "block ahead does not touch"],
    ["block behind touches", "block behind does not touch"],
    ["riser within a metre of the block ahead", "no riser within a metre of the block ahead"],
    ["step ahead", "no step ahead"],
    ["block ahead raised", "block ahead not raised"],
    ["moving", "not moving"],
];

/// The rules of all joints, and the servos that move the joints. This controller does not evolve: it has no genes, but learns from the
/// outcome of its decisions.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct JointDecisionGenes {
    /// Servos of the joints. Their bend range is the angle of a full bend.
    pub servo: ServoGenes,
    /// Systems of rules, one per joint, from the head.
    #[serde(with = "shared")]
    pub systems: Arc<Vec<Xcs>>,
    /// How the controller explores; `None` for play without chance.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub explorer: Option<Explorer>,
}

impl JointDecisionGenes {
    /// Creates the systems of rules of joints that have not learned anything yet.
    ///
    /// # Errors
    /// Returns a parameter that is out of range.
    pub fn empty_systems(settings: &XcsSettings, joints: usize) -> Result<Vec<Xcs>, Invalid> {
        (0..joints)
            .map(|_| Xcs::new(settings.clone(), JOINT_BITS.len(), JOINT_BENDS.len()))
            .collect()
    }

    /// Checks that these are the systems of rules of `joints` joints.
    ///
    /// # Errors
    /// Returns the first number that differs.
    pub fn check_systems(systems: &[Xcs], joints: usize) -> Result<(), Invalid> {
        within("systems", systems.len(), joints..=joints)?;
        for (joint, system) in systems.iter().enumerate() {
            let at = |error: Invalid| error.inside(&format!("systems[{joint}]"));
            let (bits, actions) = (JOINT_BITS.len(), JOINT_BENDS.len());
            within("situation_bits", system.situation_bits, bits..=bits).map_err(at)?;
            within("actions", system.actions, actions..=actions).map_err(at)?;
        }
        Ok(())
    }
}

impl ControllerEncoding for JointDecisionGenes {
    fn settings() -> SettingNames {
        &[SERVO_SETTINGS]
    }

    fn zeroed(space: &GenomeSpace, shape: GenomeShape) -> Self {
        let systems = Self::empty_systems(&XcsSettings::default(), shape.joints);
        Self {
            servo: ServoGenes { twist_range_rad: 0.0, ..ServoGenes::zeroed(space) },
            // The default parameters are in range, so the systems are never missing.
            systems: Arc::new(systems.unwrap_or_default()),
            explorer: None,
        }
    }

    fn genes(&mut self, space: &GenomeSpace, genes: &mut Genes<'_>) {
        self.servo.genes_without_twist(space, genes);
    }

    fn joints(&self) -> usize {
        self.systems.len()
    }

    /// Returns half the rate of decisions: the frequency of a bend that changes with each decision.
    fn estimated_frequency_hz(&self) -> Option<f32> {
        Some(DECISIONS_PER_S as f32 / 2.0)
    }

    fn compact(&mut self) {
        self.systems = Arc::new(self.systems.iter().map(Xcs::compacted).collect());
    }

    fn check_rest(&self) -> Result<(), Invalid> {
        Self::check_systems(&self.systems, self.systems.len())?;
        self.explorer.as_ref().map_or(Ok(()), Explorer::check)
    }

    fn widen(&self, space: &mut GenomeSpace) {
        self.servo.widen_without_twist(space);
    }

    fn hash_learned(&self, hash: &mut Xxh3Default) {
        self.systems.iter().for_each(|system| hash_xcs(system, hash));
        if let Some(explorer) = &self.explorer {
            explorer.hash(hash);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn systems_of_other_situations_or_actions_are_refused() {
        let settings = XcsSettings::default();
        let mut systems = JointDecisionGenes::empty_systems(&settings, 4).expect("allowed");
        assert_eq!(JointDecisionGenes::check_systems(&systems, 4), Ok(()));
        let refusal = |systems: &[Xcs], joints| {
            JointDecisionGenes::check_systems(systems, joints).expect_err("refused").to_string()
        };
        assert_eq!(refusal(&systems, 5), "systems is 4; allowed: 5 to 5");
        systems[2] = Xcs::new(settings.clone(), 24, JOINT_BENDS.len()).expect("allowed");
        assert_eq!(refusal(&systems, 4), "systems[2].situation_bits is 24; allowed: 12 to 12");
        systems[2] = Xcs::new(settings, JOINT_BITS.len(), 5).expect("allowed");
        assert_eq!(refusal(&systems, 4), "systems[2].actions is 5; allowed: 3 to 3");
    }
}
