//! One snake as the solver sees it: its boxes, joints, springs and stairs, and the contacts of its last step.

use std::sync::Arc;

use super::block::Block;
use super::contact::Contact;
use super::joint::{Joint, JointShape, in_groups};
use crate::world::contact::soft_contacts;
use crate::world::engine::{PartState, Touch, Touching};
use crate::world::surface::ContactLaw;
use crate::world::{Vector, WorldPlan};

/// Greatest speed with which an error of position is corrected, as in rapier: in m/s for a contact, in rad/s for a joint beyond its limit.
pub(super) const MOST_CORRECTION_PER_S: f32 = 3.0;

/// Size and mass of a part of the snake, which is a box.
#[derive(Debug, Clone)]
pub(super) struct ChainPart {
    pub half_m: Vector,
    pub mass_kg: f32,
    /// Moments of inertia of the part about its own axes, in kg·m².
    pub inertia_kg_m2: Vector,
}

/// Parameters of a contact: friction, bounce and softness.
#[derive(Debug, Clone, Copy)]
pub(super) struct Law {
    pub contact: ContactLaw,
    pub friction: f32,
    pub bounce: f32,
    /// Share of a penetration that is corrected, per second.
    pub correction_per_s: f32,
    /// Factor on the impulse of a touching point: 1 for a rigid contact, less for a spring.
    pub softening: f32,
}

/// The laws of the contacts with everything that the snake can touch.
#[derive(Debug, Clone, Copy)]
pub(super) struct Laws {
    pub stairs: Law,
    pub ground: Law,
    pub limbs: Law,
}

/// A solid of the stairs, with the box around it.
#[derive(Debug, Clone)]
pub(super) struct Solid {
    pub block: Block,
    /// Least corner of the axis-aligned box around the solid, in metres; `high` is its greatest corner.
    pub low: Vector,
    pub high: Vector,
}

/// Settings and sizes that all snakes which are stepped side by side have in common.
#[derive(Debug, Clone, PartialEq)]
pub struct LanesCommon {
    /// Length of a physics step, in s.
    pub step_s: f32,
    /// Number of substeps of a step.
    pub substeps: u32,
    /// Number of passes over all joints and contacts in a substep.
    pub iterations: u32,
    /// Number of parts of a snake.
    pub parts: usize,
    /// The joints and springs of a snake, in the order in which they are solved.
    pub joints: Arc<[JointShape]>,
    /// Whether a contact or a universal joint is a spring. If one is, each pass solves friction, and no pass takes the corrections of
    /// positions out of the velocities again.
    pub has_springs: bool,
}

/// One snake on its stairs.
#[derive(Debug, Clone)]
pub(crate) struct Chain {
    pub(super) common: LanesCommon,
    pub(super) parts: Vec<ChainPart>,
    /// Joints and springs, in the order in which they are solved.
    pub(super) joints: Vec<Joint>,
    /// Pairs of parts that can touch, the front one first.
    pub(super) pairs: Vec<[usize; 2]>,
    pub(super) solids: Arc<[Solid]>,
    pub(super) laws: Laws,
    /// Gravity, in m/s².
    pub(super) gravity: Vector,
    /// State of the parts: after the last step, and before the next one.
    pub state: Vec<PartState>,
    /// Contacts of the last step: first the contacts between parts, then those of each part with the world.
    pub contacts: Vec<Contact>,
    /// Contacts of the step before the last one, whose memory is used again.
    pub(super) earlier: Vec<Contact>,
    /// Boxes of the parts, and half the sizes of the axis-aligned boxes around them. The memory is reused in each step.
    pub(super) blocks: Vec<(Block, Vector)>,
    /// Indices of the solids near the snake. The memory is reused in each step.
    pub(super) near: Vec<usize>,
}

impl Chain {
    /// Builds the snake of a plan.
    pub fn new(plan: &WorldPlan) -> Self {
        let WorldPlan { body, physics, skin, .. } = plan;
        let parts: Vec<ChainPart> = body
            .parts
            .iter()
            .map(|part| {
                let half_m = Vector::from(part.size_m()) / 2.0;
                let (mass_kg, inertia_kg_m2) = (part.mass_kg(), part.inertia_kg_m2());
                ChainPart { half_m, mass_kg, inertia_kg_m2 }
            })
            .collect();
        let joints = body.joints.iter().map(|joint| {
            let masses_kg = [joint.parent, joint.child].map(|part| parts[part].mass_kg);
            Joint::universal(joint, physics, masses_kg)
        });
        let springs = body.springs.iter().map(|spring| Joint::spring(spring, physics.substep_s()));
        let joints = in_groups(joints.chain(springs).collect(), parts.len());
        let soft = soft_contacts(plan);
        let law = |contact: ContactLaw, friction: f32, bounce: f32| {
            let spring = soft.of(contact.softness, physics);
            Law {
                contact,
                friction: friction * skin.friction,
                bounce: bounce.max(skin.bounce),
                correction_per_s: spring.erp_inv_dt(physics.substep_s()),
                softening: spring.cfm_factor(physics.substep_s()),
            }
        };
        let laws = Laws {
            stairs: law(soft.laws.stairs, plan.surface.friction, plan.surface.bounce),
            ground: law(soft.laws.ground, plan.ground.friction, plan.ground.bounce),
            limbs: law(soft.laws.limbs, skin.friction, skin.bounce),
        };
        // Parts of one soft limb pass through each other, and so do parts that a joint connects, and limbs of a contact-free pair.
        let touch = |front: usize, rear: usize| {
            let limbs = [front, rear].map(|part| body.parts[part].limb);
            limbs[0] != limbs[1]
                && !joints.iter().any(|joint| joint.parts == [front, rear])
                && !body.contact_free_pairs.contains(&limbs)
        };
        let count = parts.len();
        let pairs = (0..count).flat_map(|front| (front + 1..count).map(move |rear| [front, rear]));
        Self {
            common: LanesCommon {
                step_s: physics.step_s(),
                substeps: physics.substeps.max(1),
                iterations: physics.iterations,
                parts: count,
                joints: joints.iter().map(Joint::shape).collect(),
                has_springs: soft.laws.has_springs(),
            },
            pairs: pairs.filter(|[front, rear]| touch(*front, *rear)).collect(),
            joints,
            solids: solids(plan),
            laws,
            gravity: physics.gravity(),
            state: plan.start_poses().into_iter().map(PartState::at_rest).collect(),
            contacts: Vec::new(),
            earlier: Vec::new(),
            blocks: Vec::with_capacity(count),
            near: Vec::new(),
            parts,
        }
    }

    /// Returns the settings and sizes that all lanes of a solver must have in common.
    pub fn common(&self) -> LanesCommon {
        self.common.clone()
    }

    /// Returns the box of a part in its present state.
    pub(super) fn block(&self, part: usize) -> Block {
        Block::at(self.state[part].pose(), self.parts[part].half_m)
    }

    /// Computes what each part touches.
    pub(super) fn read_touches(&mut self) {
        for state in &mut self.state {
            state.touch = Touch::default();
        }
        for contact in &self.contacts {
            let touch = &mut self.state[contact.part].touch;
            match contact.other {
                Touching::Ground => touch.ground = true,
                Touching::Solid(_) => touch.stairs = true,
                Touching::Part(_) => continue,
            }
            let pressed_ns: f32 = contact.points().iter().map(|point| point.impulse_ns).sum();
            if pressed_ns > 0.0 {
                touch.force_n += contact.normal * pressed_ns + contact.friction_ns;
            }
        }
        let substep_s = self.common.step_s / self.common.substeps as f32;
        for state in &mut self.state {
            state.touch.force_n /= substep_s;
        }
    }

    /// Continues with the contacts of a snake with the same body, if both have the same stairs.
    pub fn continue_from(&mut self, earlier: &Self) {
        let places = |of: &Self| {
            let solids = of.solids.iter().map(|solid| &solid.block);
            solids.map(|block| (block.centre, block.half_m, block.axes)).collect::<Vec<_>>()
        };
        if places(self) == places(earlier) {
            self.contacts.clone_from(&earlier.contacts);
            self.read_touches();
        }
    }
}

fn solids(plan: &WorldPlan) -> Arc<[Solid]> {
    let solids = plan.stairs.solids().into_iter().map(|solid| {
        let block = Block::at(solid.pose, solid.half_m);
        let reach_m = block.reach_m();
        Solid { low: block.centre - reach_m, high: block.centre + reach_m, block }
    });
    solids.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::save::library::shipped_champions;
    use crate::world::rapier::RapierWorld;

    /// The plans of all built-in champions: rigid limbs in a row, some of them short, creatures and soft snakes.
    fn plans() -> impl Iterator<Item = (&'static str, WorldPlan)> {
        shipped_champions()
            .into_iter()
            .map(|(name, loaded)| (name, loaded.champion.trial.world_plan(&loaded.champion.genome)))
    }

    #[test]
    fn the_same_parts_can_touch_as_in_rapier() {
        let mut soft = 0;
        for (name, plan) in plans() {
            let world = RapierWorld::new(&plan);
            let physics = world.physics();
            let groups = world.bodies().iter().map(|&part| {
                physics.colliders[physics.bodies[part].colliders()[0]].collision_groups()
            });
            let groups: Vec<_> = groups.collect();
            let joined = |pair: [usize; 2]| {
                let bodies = pair.map(|part| world.bodies()[part]);
                let mut joints = physics.impulse_joints.iter();
                joints
                    .any(|(_, of)| !of.data.contacts_enabled && [of.body1(), of.body2()] == bodies)
            };
            let count = groups.len();
            let pairs =
                (0..count).flat_map(|front| (front + 1..count).map(move |rear| [front, rear]));
            let expected: Vec<[usize; 2]> = pairs
                .filter(|[front, rear]| groups[*front].test(groups[*rear]))
                .filter(|pair| !joined(*pair))
                .collect();
            assert_eq!(Chain::new(&plan).pairs, expected, "{name}");
            soft += usize::from(!plan.body.springs.is_empty());
        }
        assert!(soft >= 3, "{soft} soft snakes");
    }
}
