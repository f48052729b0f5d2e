//! Worlds whose motion the engine *lanes* computes, alone or several side by side.

use rapier3d::prelude::*;

use super::Simulation;
use crate::world::lanes::{
    Chain, Contact, LaneSolver, LanesCommon, PartState, Touching, VectorLevel,
};
use crate::world::turning::{product, turned};
use crate::world::{Disqualification, JointPlan, JointTorque, PhysicsEngine, WorldPlan};

/// Number of snakes that are advanced side by side: as many as AVX has lanes, and twice as many as SSE2 and NEON have. On web pages, where
/// the size of the code counts, it is the number of lanes of WebAssembly.
pub const LANES: usize = if cfg!(target_arch = "wasm32") { 4 } else { 8 };

/// A point of a contact, for drawing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SeenPoint {
    /// Points on the touched body and on the part, in the world, in metres.
    pub on_m: [Vector; 2],
    /// Unit vector along which the part is pushed.
    pub normal: Vector,
}

/// A snake in the engine *lanes*, with a solver of its own for steps that it takes alone.
#[derive(Clone)]
pub(super) struct LanesWorld {
    chain: Chain,
    solver: LaneSolver<1>,
}

impl LanesWorld {
    /// Builds the world of a plan that selects the engine *lanes*; `None` if it selects rapier.
    pub fn of(plan: &WorldPlan) -> Option<Box<Self>> {
        let is_chosen = plan.physics.engine == PhysicsEngine::Lanes;
        let solver = || LaneSolver::at(VectorLevel::in_use());
        is_chosen.then(|| Box::new(Self { chain: Chain::new(plan), solver: solver() }))
    }

    /// Returns the contacts of the last step.
    pub fn contacts(&self) -> &[Contact] {
        &self.chain.contacts
    }
}

impl Simulation {
    /// Returns the settings and sizes that all worlds of a lock step must have in common; `None` for worlds of rapier.
    pub(crate) fn common(&self) -> Option<LanesCommon> {
        self.lanes.as_ref().map(|lanes| lanes.chain.common())
    }

    /// Advances this snake alone by one step of the engine *lanes*.
    pub(super) fn advance_alone(&mut self) {
        self.state_to_lanes();
        if let Some(lanes) = &mut self.lanes {
            let LanesWorld { chain, solver } = &mut **lanes;
            solver.advance(&mut [chain]);
        }
        self.state_from_lanes();
    }

    /// Copies the state of the bodies, including forces and torques, to the engine *lanes*.
    fn state_to_lanes(&mut self) {
        let Some(lanes) = &mut self.lanes else { return };
        lanes.chain.gravity = self.physics.gravity;
        for (state, &part) in lanes.chain.state.iter_mut().zip(&self.parts) {
            let body = &self.physics.bodies[part];
            *state = PartState {
                at: body.translation(),
                turn: body.rotation().to_array(),
                linear: body.linvel(),
                angular: body.angvel(),
                force_n: body.user_force(),
                torque_nm: body.user_torque(),
                is_held: !body.is_dynamic(),
            };
        }
    }

    /// Copies the state that the engine *lanes* has computed to the bodies, and lets limbs bounce.
    fn state_from_lanes(&mut self) {
        let Some(mut lanes) = self.lanes.take() else { return };
        for (state, &part) in lanes.chain.state.iter().zip(&self.parts) {
            let body = &mut self.physics.bodies[part];
            body.set_position(Pose::from_parts(state.at, Rotation::from_array(state.turn)), false);
            body.set_linvel(state.linear, false);
            body.set_angvel(state.angular, false);
        }
        self.add_to_balance();
        if lanes.chain.bounce() {
            for (state, &part) in lanes.chain.state.iter().zip(&self.parts) {
                let body = &mut self.physics.bodies[part];
                body.set_linvel(state.linear, false);
                body.set_angvel(state.angular, false);
            }
        }
        self.lanes = Some(lanes);
    }

    /// Continues with the contacts of another world, if both are simulated by *lanes* and have the same stairs.
    pub(super) fn take_contacts_of(&mut self, other: &Self) {
        if let (Some(lanes), Some(other)) = (&mut self.lanes, &other.lanes)
            && lanes.chain.has_solids_of(&other.chain)
        {
            lanes.chain.take_contacts_of(&other.chain);
        }
    }

    /// Rotates a vector. With the engine *lanes*, the result has the same bits on every processor.
    pub(super) fn turned(&self, rotation: Rotation, vector: Vector) -> Vector {
        if self.lanes.is_some() { turned(rotation, vector) } else { rotation * vector }
    }

    /// Returns the product of two rotations: `second` acts first, and `first` after it. With the engine *lanes*, the result has the same
    /// bits on every processor.
    pub(super) fn product(&self, first: Rotation, second: Rotation) -> Rotation {
        if self.lanes.is_some() { product(first, second) } else { first * second }
    }

    /// Returns the axes of a joint in the world, given the rotation of its parent: the joint bends about x and twists about y.
    pub(super) fn joint_axes(&self, joint: &JointPlan, parent: Rotation) -> Rotation {
        joint.mount.map_or(parent, |mount| self.product(parent, mount.turn))
    }

    /// Returns the inertia of a part about its own axes in the engine *lanes*, in kg·m²; `None` in worlds of rapier.
    pub(super) fn inertia_in_lanes_kg_m2(&self, part: usize) -> Option<Vector> {
        Some(self.lanes.as_ref()?.chain.mass_of(part)?.1)
    }

    /// Returns the kinetic and potential energy of a part in the engine *lanes*, in J. Positions are half a substep ahead of velocities.
    pub(super) fn energy_in_lanes_j(&self, part: usize, substep_s: f32) -> f64 {
        let mass = self.lanes.as_ref().and_then(|lanes| lanes.chain.mass_of(part));
        let Some((mass_kg, inertia)) = mass else { return 0.0 };
        let body = &self.physics.bodies[self.parts[part]];
        let rate = self.turned(body.rotation().inverse(), body.angvel());
        let velocity = body.linvel();
        let kinetic_j = (mass_kg * velocity.dot(velocity) + (inertia * rate).dot(rate)) / 2.0;
        let at = body.translation() - velocity * (substep_s / 2.0);
        f64::from(kinetic_j) + f64::from(-mass_kg * self.physics.gravity.dot(at))
    }

    /// Returns the points of the contacts in the engine *lanes*. The list is empty in worlds of rapier, whose narrow phase holds the
    /// contacts.
    pub fn contacts_in_lanes(&self) -> Vec<SeenPoint> {
        let place = |part: usize| *self.physics.bodies[self.parts[part]].position();
        let contacts = self.lanes_contacts().iter();
        let points = contacts.flat_map(|contact| {
            let other = match contact.other {
                Touching::Part(front) => place(front),
                Touching::Ground | Touching::Solid(_) => Pose::IDENTITY,
            };
            contact.points().iter().map(move |point| SeenPoint {
                on_m: [other * point.on_other, place(contact.part) * point.on_part],
                normal: contact.normal,
            })
        });
        points.collect()
    }

    /// Returns the contacts of the engine *lanes*; empty in worlds of rapier.
    pub(super) fn lanes_contacts(&self) -> &[Contact] {
        self.lanes.as_ref().map_or(&[], |lanes| lanes.contacts())
    }
}

/// Steps several worlds of the engine *lanes* side by side.
pub struct LockStep {
    solver: LaneSolver<LANES>,
}

impl Default for LockStep {
    fn default() -> Self {
        Self::at(VectorLevel::in_use())
    }
}

impl LockStep {
    /// Makes a lock step that computes with these vector instructions. They change no bit.
    pub fn at(level: VectorLevel) -> Self {
        Self { solver: LaneSolver::at(level) }
    }

    /// Advances up to [`LANES`] worlds by one step each, with the same bits as [`Simulation::step`]. All worlds must have the same
    /// [`Simulation::common`].
    pub fn step(
        &mut self,
        worlds: &mut [(&mut Simulation, &[JointTorque])],
    ) -> Vec<Result<(), Disqualification>> {
        debug_assert!(worlds.len() <= LANES, "more worlds than lanes");
        for (world, torques) in worlds.iter_mut() {
            world.apply(torques);
            world.read_turns();
            world.state_to_lanes();
        }
        let mut chains: Vec<&mut Chain> = worlds
            .iter_mut()
            .filter_map(|(world, _)| world.lanes.as_mut().map(|lanes| &mut lanes.chain))
            .collect();
        self.solver.advance(&mut chains);
        let ends = worlds.iter_mut().map(|(world, _)| {
            world.state_from_lanes();
            world.dampen_half_step();
            world.take_in_step()
        });
        ends.collect()
    }
}
