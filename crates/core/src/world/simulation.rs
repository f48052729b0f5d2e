//! One snake on one staircase, advanced by one constant step at a time.
//!
//! All code that scores, replays, shows or tests a snake calls [`Simulation::step`].

use rapier3d::prelude::*;

mod balance;
mod build;
mod climb;
mod continued;
mod damping;
mod health_check;
mod lanes;
mod lanes_patches;
pub(super) mod mirror;
pub(super) mod observe;
pub(super) mod patches;
pub(super) mod sensing;
mod settle;
mod shove;
mod torques;

use super::bounce::{LimbVelocity, finish_bounce};
use super::contact::{ContactHooks, ContactLaws, soft_contacts};
use super::damping::HalfStepDamping;
use super::energy::{EnergyBalance, LimbTurn};
use super::stair_profile::StairProfile;
use super::torque::{AppliedTorque, JointTorque};
use super::{BodyPlan, Disqualification, Effort, HealthLimits, PhysicsWorld, Pull, WorldPlan};
use build::{insert_ground, insert_joints, insert_parts, insert_stairs};
use lanes::LanesWorld;
pub use lanes::{LANES, LockStep, SeenPoint};

/// A running world. A clone continues with the same bits as the original.
pub struct Simulation {
    physics: PhysicsWorld,
    /// Whether something besides velocities and torques changed since the last step.
    is_changed: bool,
    contacts: ContactSettings,
    profile: StairProfile,
    damping: HalfStepDamping,
    /// Share of the joints' damping that acts as an explicit torque, outside the solver.
    damping_as_torque: f32,
    body: BodyPlan,
    /// The engine's bodies of the parts, in the order of the plan's parts.
    parts: Vec<RigidBodyHandle>,
    health: HealthLimits,
    arena_front_y_m: f32,
    /// Torque of the joints' drives on each part, in N·m.
    torques_in_world: Vec<Vector>,
    /// Torque of the joints' damping on each part, in N·m. It is added to the torque of the drives.
    damping_in_world: Vec<Vector>,
    applied: Vec<AppliedTorque>,
    effort: Effort,
    balance: EnergyBalance,
    /// The user's pull on a part, or `None`. `was_pulled` tells whether there was a pull in the last step.
    pull: Option<Pull>,
    was_pulled: bool,
    /// Whether the user has ever pulled a part.
    is_disturbed: bool,
    /// Forces on each part in another engine, if this world mirrors one; empty otherwise.
    mirrored: Vec<Option<Vector>>,
    /// The snake in the engine *lanes*, if *lanes* computes the motion. Rapier's bodies then hold the state, but rapier takes no steps.
    lanes: Option<Box<LanesWorld>>,
    /// Rotations and angular velocities of the limbs before the step. The memory is reused in each step.
    turns_before: Vec<LimbTurn>,
}

/// Settings of the contacts that each step needs.
#[derive(Debug, Clone)]
struct ContactSettings {
    laws: ContactLaws,
    /// Whether any material has restitution.
    bounces: bool,
    ground: ColliderHandle,
    substeps: u32,
    snake_kg: f32,
}

impl Simulation {
    /// Builds the world: the ground, the stairs from the lowest up, the parts from the head, and the joints and springs from the head.
    ///
    /// The order of insertion influences the bits of every run.
    pub fn new(plan: &WorldPlan) -> Self {
        let softness = soft_contacts(plan);
        let laws = softness.laws;
        let mut physics = PhysicsWorld {
            gravity: Vector::new(0.0, 0.0, -plan.physics.gravity_m_s2),
            integration_parameters: IntegrationParameters {
                dt: plan.physics.step_s(),
                num_solver_iterations: plan.physics.substeps as usize,
                num_internal_pgs_iterations: plan.physics.iterations as usize,
                ..Default::default()
            },
            ..Default::default()
        };
        softness.set_up(&mut physics.integration_parameters, &plan.physics);
        let bounces = [plan.surface.bounce, plan.ground.bounce, plan.skin.bounce]
            .iter()
            .any(|&bounce| bounce > 0.0);
        if bounces {
            // Without recycling, contacts keep the mark that they are new. The bounce correction needs this mark.
            physics.integration_parameters.contact_recycling = false;
        }
        let ground = insert_ground(&mut physics, plan, &laws);
        insert_stairs(&mut physics, plan, &laws.stairs);
        let parts = insert_parts(&mut physics, plan, &laws.limbs);
        insert_joints(&mut physics, &parts, plan);

        let mut simulation = Self {
            physics,
            is_changed: true,
            contacts: ContactSettings {
                laws,
                bounces,
                ground,
                substeps: plan.physics.substeps,
                snake_kg: plan.body.mass_kg(),
            },
            profile: StairProfile::of(&plan.stairs),
            damping: HalfStepDamping::of_rates(
                plan.body.angular_damping_per_s,
                plan.surface.dampen_per_s,
                plan.ground.dampen_per_s,
                plan.physics.step_s(),
            ),
            damping_as_torque: 1.0 - plan.physics.joint_damping_in_solver(),
            torques_in_world: vec![Vector::ZERO; parts.len()],
            damping_in_world: vec![Vector::ZERO; parts.len()],
            applied: vec![AppliedTorque::default(); plan.body.joints.len()],
            effort: Effort::default(),
            balance: EnergyBalance::default(),
            pull: None,
            was_pulled: false,
            is_disturbed: false,
            mirrored: Vec::new(),
            lanes: LanesWorld::of(plan),
            turns_before: Vec::with_capacity(parts.len()),
            parts,
            body: plan.body.clone(),
            health: plan.health.clone(),
            arena_front_y_m: plan.stairs.end_y_m() + 10.0,
        };
        simulation.begin_balance();
        simulation
    }

    /// Applies the torques, one per joint, clamped to each joint's limits, and advances the world by one
    /// step.
    ///
    /// # Errors
    /// Returns the reason if this step disqualified the agent. The world must not be stepped any further then.
    pub fn step(&mut self, torques: &[JointTorque]) -> Result<(), Disqualification> {
        self.apply(torques);
        self.advance();
        self.take_in_step()
    }

    /// Checks the state after a step, and adds the effort of the step to the total.
    fn take_in_step(&mut self) -> Result<(), Disqualification> {
        let mut effort = match self.check_health() {
            // No trial contains a pull, so the limits of a trial do not end it.
            Err(limit) if self.is_disturbed && limit != Disqualification::NotFinite => {
                return Ok(());
            }
            checked => checked?,
        };
        let motion_j = self.motion_energy_j();
        self.balance.motion_j += motion_j;
        effort.energy_j = motion_j + self.holding_energy_j();
        let effort = self.effort.and(effort);
        if !self.balance.has_unknown_work
            && self.energy_lost().is_from_nothing(self.balance.motion_j)
        {
            return Err(Disqualification::EnergyFromNothing);
        }
        self.effort = effort;
        Ok(())
    }

    /// Returns the built body: its parts, joints, springs, sizes, masses and limits.
    pub fn body(&self) -> &BodyPlan {
        &self.body
    }

    /// Returns the effort of the healthy steps so far.
    pub fn effort(&self) -> Effort {
        self.effort
    }

    /// Advances the engine by one step, and then slows the limbs by the damping of air and surfaces.
    pub(crate) fn advance(&mut self) {
        self.read_turns();
        if self.lanes.is_some() {
            self.advance_alone();
        } else {
            self.advance_rapier();
        }
        self.dampen_half_step();
    }

    fn advance_rapier(&mut self) {
        let ContactSettings { laws, ground, substeps, snake_kg, .. } = &self.contacts;
        let hooks = ContactHooks {
            laws,
            ground: *ground,
            step_s: self.physics.integration_parameters.dt,
            substeps: *substeps,
            snake_kg: *snake_kg,
        };
        if self.is_changed {
            mark_all_bodies(&mut self.physics.bodies);
        } else {
            unmark_all_bodies(&mut self.physics.bodies);
        }
        self.is_changed = false;
        if !self.contacts.bounces {
            self.physics.step_with_events(&hooks, &());
            self.add_to_balance();
        } else {
            let velocity = |&limb: &RigidBodyHandle| {
                let body = &self.physics.bodies[limb];
                LimbVelocity { linear: body.linvel(), angular: body.angvel() }
            };
            let before: Vec<LimbVelocity> = self.parts.iter().map(velocity).collect();
            self.physics.step_with_events(&hooks, &());
            self.add_to_balance();
            for (&limb, before) in self.parts.iter().zip(before) {
                finish_bounce(&mut self.physics, limb, before);
            }
        }
    }

    /// Gives read access to the engine's state, for debug drawing, picking and benchmarks.
    pub fn physics(&self) -> &PhysicsWorld {
        &self.physics
    }

    /// Returns the engine's bodies of the parts, in the order of the plan's parts. The ground can be another body, which is not among
    /// them.
    pub fn parts(&self) -> &[RigidBodyHandle] {
        &self.parts
    }

    /// Gives write access to the engine's state, for benchmarks that step rapier alone. From then on the energy balance is meaningless.
    pub fn physics_mut(&mut self) -> &mut PhysicsWorld {
        self.balance.has_unknown_work = true;
        self.is_changed = true;
        &mut self.physics
    }

    /// Sets or ends the user's pull on a part, from the next step on. A pulled snake no longer runs its trial, and only a state that is
    /// not finite ends the simulation.
    pub fn pull(&mut self, pull: Option<Pull>) {
        self.is_disturbed |= pull.is_some();
        self.pull = pull;
    }

    /// Returns whether the user has ever pulled a part.
    pub fn is_disturbed(&self) -> bool {
        self.is_disturbed
    }

    fn apply_pull(&mut self) {
        for &limb in &self.parts {
            self.physics.bodies[limb].reset_forces(false);
        }
        self.was_pulled = false;
        let Some(pull) = self.pull else { return };
        let Some(&part) = self.parts.get(pull.part) else { return };
        let step_s = self.physics.integration_parameters.dt;
        let body = &mut self.physics.bodies[part];
        let (force, point) = pull.force_on(body, step_s);
        body.add_force_at_point(force, point, false);
        self.was_pulled = true;
        self.balance.has_unknown_work = true;
    }
}

/// Marks all bodies as changed, so that the engine's next step takes account of every change in them.
fn mark_all_bodies(bodies: &mut RigidBodySet) {
    bodies.iter_mut().for_each(drop);
}

/// Clears the engine's list of changed bodies. Torques and velocities take effect without a mark. With it, the engine would assemble the
/// joints anew in each step, with the same bits as a result.
fn unmark_all_bodies(bodies: &mut RigidBodySet) {
    // The iterator clears the list of changed bodies, and lists each body that it yields.
    drop(bodies.iter_mut());
}

impl Clone for Simulation {
    fn clone(&self) -> Self {
        let physics = &self.physics;
        Self {
            physics: PhysicsWorld {
                gravity: physics.gravity,
                integration_parameters: physics.integration_parameters,
                // The pipeline holds working memory only; a new pipeline gives the same bits.
                physics_pipeline: PhysicsPipeline::new(),
                islands: physics.islands.clone(),
                broad_phase: physics.broad_phase.clone(),
                narrow_phase: physics.narrow_phase.clone(),
                bodies: physics.bodies.clone(),
                colliders: physics.colliders.clone(),
                impulse_joints: physics.impulse_joints.clone(),
                multibody_joints: physics.multibody_joints.clone(),
                ccd_solver: physics.ccd_solver.clone(),
            },
            is_changed: self.is_changed,
            contacts: self.contacts.clone(),
            profile: self.profile.clone(),
            body: self.body.clone(),
            parts: self.parts.clone(),
            health: self.health.clone(),
            arena_front_y_m: self.arena_front_y_m,
            damping: self.damping,
            damping_as_torque: self.damping_as_torque,
            torques_in_world: self.torques_in_world.clone(),
            damping_in_world: self.damping_in_world.clone(),
            applied: self.applied.clone(),
            effort: self.effort,
            balance: self.balance,
            pull: self.pull,
            was_pulled: self.was_pulled,
            is_disturbed: self.is_disturbed,
            mirrored: self.mirrored.clone(),
            lanes: self.lanes.clone(),
            turns_before: Vec::with_capacity(self.parts.len()),
        }
    }
}

#[cfg(test)]
mod tests;
