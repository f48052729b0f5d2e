//! One snake as the solver sees it: its boxes, joints, springs and stairs, and the contacts of its last step.

use std::sync::Arc;

use super::block::Block;
use super::contact::Contact;
use super::joint::{Joint, JointShape, in_groups};
use super::wide::{Wide, WideRotation};
use crate::world::contact::soft_contacts;
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

/// The state of a part at the beginning and at the end of a step.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct PartState {
    /// Centre of the part, in metres.
    pub at: Vector,
    /// Rotation of the part as a quaternion: x, y, z and w.
    pub turn: [f32; 4],
    /// Velocity of the part's centre, in m/s.
    pub linear: Vector,
    /// Angular velocity of the part in the world, in rad/s.
    pub angular: Vector,
    /// Force on the part's centre besides gravity, in N.
    pub force_n: Vector,
    /// Torque on the part in the world, in N·m.
    pub torque_nm: Vector,
    /// Whether the part is held in its place, so that nothing moves it.
    pub is_held: bool,
}

impl PartState {
    /// Returns the velocity of the part at a place in the world, in m/s.
    pub fn velocity_at(&self, at: Vector) -> Vector {
        self.linear + self.angular.cross(at - self.at)
    }

    /// Returns the axes of the part in the world.
    pub fn axes(&self) -> [Vector; 3] {
        let [x, y, z, w] = self.turn.map(|part| Wide([part]));
        WideRotation { x, y, z, w }.axes().map(|axis| axis.get(0))
    }
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
    /// Gravity, in m/s². It is set before each step, together with the state.
    pub gravity: Vector,
    /// State of the parts: after the last step, and before the next one.
    pub state: Vec<PartState>,
    /// Contacts of the last step: first the contacts between parts, then those of each part with the world.
    pub contacts: Vec<Contact>,
    /// Contacts of the step before the last one, whose memory is used again.
    pub(super) earlier: Vec<Contact>,
    /// Boxes of the parts, and half the sizes of the axis-aligned boxes around them. The memory is reused in each step.
    pub(super) blocks: Vec<(Block, Vector)>,
}

impl Chain {
    /// Builds the snake of a plan.
    pub fn new(plan: &WorldPlan) -> Self {
        let WorldPlan { body, physics, skin, .. } = plan;
        let parts: Vec<ChainPart> = body
            .parts
            .iter()
            .map(|part| {
                let [w2, l2, h2] = part.size_m().map(|size_m| size_m * size_m);
                let mass_kg = part.mass_kg();
                let inertia_kg_m2 = Vector::new(l2 + h2, w2 + h2, w2 + l2) * (mass_kg / 12.0);
                ChainPart { half_m: Vector::from(part.size_m()) / 2.0, mass_kg, inertia_kg_m2 }
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
            gravity: Vector::ZERO,
            state: vec![PartState::default(); count],
            contacts: Vec::new(),
            earlier: Vec::new(),
            blocks: Vec::with_capacity(count),
            parts,
        }
    }

    /// Returns the settings and sizes that all lanes of a solver must have in common.
    pub fn common(&self) -> LanesCommon {
        self.common.clone()
    }

    /// Returns the mass of a part, in kg, and its inertia about its own axes, in kg·m²; `None` if the snake has no such part.
    pub fn mass_of(&self, part: usize) -> Option<(f32, Vector)> {
        self.parts.get(part).map(|part| (part.mass_kg, part.inertia_kg_m2))
    }

    /// Returns the box of a part in its present state.
    pub(super) fn block(&self, part: usize) -> Block {
        let state = &self.state[part];
        Block { centre: state.at, axes: state.axes(), half_m: self.parts[part].half_m }
    }

    /// Copies the contacts of a snake with the same body on the same stairs, so that this snake continues with their impulses.
    pub fn take_contacts_of(&mut self, other: &Self) {
        self.contacts.clone_from(&other.contacts);
    }

    /// Returns whether both snakes have the same stairs.
    pub fn has_solids_of(&self, other: &Self) -> bool {
        let places = |of: &Self| {
            of.solids
                .iter()
                .map(|solid| (solid.block.centre, solid.block.half_m, solid.block.axes))
                .collect::<Vec<_>>()
        };
        places(self) == places(other)
    }
}

fn solids(plan: &WorldPlan) -> Arc<[Solid]> {
    let solids = plan.stairs.solids().into_iter().map(|solid| {
        let state = PartState {
            at: solid.pose.translation,
            turn: solid.pose.rotation.to_array(),
            ..PartState::default()
        };
        let block = Block { centre: state.at, axes: state.axes(), half_m: solid.half_m };
        let reach_m = block.reach_m();
        Solid { low: block.centre - reach_m, high: block.centre + reach_m, block }
    });
    solids.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::save::library::shipped_champions;
    use crate::world::{PhysicsEngine, Simulation};

    /// The plans of all built-in champions: rigid limbs in a row, some of them short, creatures and soft snakes.
    fn plans() -> impl Iterator<Item = (&'static str, WorldPlan)> {
        shipped_champions().into_iter().map(|(name, loaded)| {
            let mut plan = loaded.champion.trial.world_plan(&loaded.champion.genome);
            plan.physics.engine = PhysicsEngine::Rapier;
            (name, plan)
        })
    }

    #[test]
    fn the_same_parts_can_touch_as_in_rapier() {
        let mut soft = 0;
        for (name, plan) in plans() {
            let simulation = Simulation::new(&plan);
            let physics = simulation.physics();
            let groups = simulation.parts().iter().map(|&part| {
                physics.colliders[physics.bodies[part].colliders()[0]].collision_groups()
            });
            let groups: Vec<_> = groups.collect();
            let joined = |pair: [usize; 2]| {
                let bodies = pair.map(|part| simulation.parts()[part]);
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
