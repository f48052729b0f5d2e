//! One snake on one staircase, advanced by one constant step at a time.
//!
//! Everything that scores, replays, shows or tests a snake goes through [`Simulation::step`].

use rapier3d::prelude::*;

mod build;
mod observe;

use super::bounce::{Velocity, finish_bounce};
use super::contact::{ContactLaws, Hooks, soften};
use super::surface::ContactLaw;
use super::{
    BodyPlan, Disqualification, Effort, HealthLimits, JointPlan, PhysicsSettings, PhysicsWorld,
    Pull, Skin, Stairs, Surface,
};
use build::{insert_ground, insert_joints, insert_limbs, insert_stairs};
pub use observe::{ContactForce, JointState};

/// All that determines a world: build it twice and step it with the same torques, and the two agree
/// in every bit.
#[derive(Debug, Clone, PartialEq)]
pub struct WorldPlan {
    /// Step length, substeps, gravity.
    pub physics: PhysicsSettings,
    /// The staircase.
    pub stairs: Stairs,
    /// The material of the stairs.
    pub surface: Surface,
    /// The material of the ground.
    pub ground: Surface,
    /// The material of the snake.
    pub skin: Skin,
    /// When the agent is disqualified.
    pub health: HealthLimits,
    /// The snake.
    pub body: BodyPlan,
    /// Where the middle of the straight snake starts on the y axis, in metres.
    pub start_y_m: f32,
    /// Where it starts on the x axis, in metres; 0 is in front of the middle of the stairs.
    pub start_x_m: f32,
    /// How far the snake is turned at the start, in radians, counterclockwise seen from above; at 0 it heads for the
    /// stairs.
    pub start_turn_rad: f32,
}

/// The torques a controller commands at one joint, in N·m, positive by the right-hand rule about the
/// joint's own axes. They act on the rear limb, and their opposites on the front limb.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct JointTorque {
    /// About the front limb's x axis.
    pub bend_nm: f32,
    /// About the front limb's y axis.
    pub twist_nm: f32,
}

/// A running world. A clone goes on with the bits of the original.
pub struct Simulation {
    physics: PhysicsWorld,
    contacts: Contacts,
    /// Bodies of the limbs, head first.
    limbs: Vec<RigidBodyHandle>,
    joints: Vec<JointPlan>,
    /// Distance from a limb's centre to its front and rear joint anchors, in metres.
    half_lengths_m: Vec<f32>,
    health: HealthLimits,
    arena_front_y_m: f32,
    torques_in_world: Vec<Vector>,
    /// The torques of this step after clamping, joint by joint, and the turns of the front limbs about whose
    /// axes they act.
    applied: Vec<(Rotation, JointTorque)>,
    effort: Effort,
    /// What pulls a limb beside the joints, and whether anything did in the last step.
    pull: Option<Pull>,
    was_pulled: bool,
}

/// What a step needs to know of the contacts.
#[derive(Debug, Clone)]
struct Contacts {
    laws: ContactLaws,
    /// Whether anything bounces.
    bounces: bool,
    ground: ColliderHandle,
    substeps: u32,
    snake_kg: f32,
}

/// A snake this far below the ground has fallen through it; only a broken contact does that.
const LOWEST_Z_M: f32 = -2.0;

impl Simulation {
    /// Builds the world: ground, stairs from the lowest up, limbs from the head, joints from the head.
    ///
    /// The order of insertion is part of the bits of every run.
    pub fn new(plan: &WorldPlan) -> Self {
        let laws = ContactLaws {
            stairs: ContactLaw::between(&plan.surface, &plan.skin),
            ground: ContactLaw::between(&plan.ground, &plan.skin),
            limbs: ContactLaw::within(&plan.skin),
            joints_are_soft: plan.body.joints.iter().any(|joint| joint.cfm_m_s_per_n > 0.0),
        };
        let mut physics = PhysicsWorld {
            gravity: Vector::new(0.0, 0.0, -plan.physics.gravity_m_s2),
            integration_parameters: IntegrationParameters {
                dt: plan.physics.step_s(),
                num_solver_iterations: plan.physics.substeps as usize,
                ..Default::default()
            },
            ..Default::default()
        };
        if let Some(middle) = plan.body.limbs.get(plan.body.middle_limb()) {
            soften(&mut physics.integration_parameters, &laws, &plan.physics, middle);
        }
        let bounces = [plan.surface.bounce, plan.ground.bounce, plan.skin.bounce]
            .iter()
            .any(|&bounce| bounce > 0.0);
        if bounces {
            // Contacts that the engine recycles keep saying that they are new: see `bounce`.
            physics.integration_parameters.contact_recycling = false;
        }
        let ground = insert_ground(&mut physics, plan, &laws);
        insert_stairs(&mut physics, plan, &laws.stairs);
        let limbs = insert_limbs(&mut physics, plan, &laws.limbs);
        insert_joints(&mut physics, &limbs, plan);

        Self {
            physics,
            contacts: Contacts {
                laws,
                bounces,
                ground,
                substeps: plan.physics.substeps,
                snake_kg: plan.body.mass_kg(),
            },
            torques_in_world: vec![Vector::ZERO; limbs.len()],
            applied: vec![(Rotation::IDENTITY, JointTorque::default()); plan.body.joints.len()],
            effort: Effort::default(),
            pull: None,
            was_pulled: false,
            limbs,
            joints: plan.body.joints.clone(),
            half_lengths_m: plan.body.limbs.iter().map(|limb| limb.length_m / 2.0).collect(),
            health: plan.health.clone(),
            arena_front_y_m: plan.stairs.end_y_m() + 10.0,
        }
    }

    /// Applies the torques, one per joint from the head, clamped to each joint's limits, and advances
    /// the world by one step.
    ///
    /// # Errors
    /// The reason why this step disqualified the agent. The world must not be stepped further then.
    pub fn step(&mut self, torques: &[JointTorque]) -> Result<(), Disqualification> {
        self.apply(torques);
        self.advance();
        let mut effort = self.check_health()?;
        effort.energy_j = self.energy_j();
        self.effort = self.effort.and(effort);
        Ok(())
    }

    /// What the healthy steps so far demanded.
    pub fn effort(&self) -> Effort {
        self.effort
    }

    /// Energy that the joints spent in the last step, in J. A torque acts through the whole step about the
    /// axes at its start, and the engine moves limbs by their velocity at its end; so this is the
    /// rectangle rule with the rates at the end.
    fn energy_j(&self) -> f32 {
        let turn = |index: usize| self.physics.bodies[self.limbs[index]].angvel();
        let joints = self.applied.iter().enumerate();
        let power_w = joints.map(|(index, (front, torque))| {
            let rate = front.inverse() * (turn(index + 1) - turn(index));
            (torque.bend_nm * rate.x).abs() + (torque.twist_nm * rate.y).abs()
        });
        power_w.sum::<f32>() * self.physics.integration_parameters.dt
    }

    /// Lets the engine take one step, and what touches a damping surface slow down.
    pub(crate) fn advance(&mut self) {
        let Contacts { laws, ground, substeps, snake_kg, .. } = &self.contacts;
        let hooks = Hooks {
            laws,
            ground: *ground,
            step_s: self.physics.integration_parameters.dt,
            substeps: *substeps,
            snake_kg: *snake_kg,
        };
        if !self.contacts.bounces {
            self.physics.step_with_events(&hooks, &());
        } else {
            let velocity = |&limb: &RigidBodyHandle| {
                let body = &self.physics.bodies[limb];
                Velocity { linear: body.linvel(), angular: body.angvel() }
            };
            let before: Vec<Velocity> = self.limbs.iter().map(velocity).collect();
            self.physics.step_with_events(&hooks, &());
            for (&limb, before) in self.limbs.iter().zip(before) {
                finish_bounce(&mut self.physics, limb, before);
            }
        }
        if laws.stairs.dampen_per_s > 0.0 || laws.ground.dampen_per_s > 0.0 {
            self.dampen();
        }
    }

    /// Slows each limb that touches a damping surface, once, by the stronger one that it touches.
    fn dampen(&mut self) {
        let Contacts { laws, ground, .. } = &self.contacts;
        let step_s = self.physics.integration_parameters.dt;
        for &limb in &self.limbs {
            let collider = self.physics.bodies[limb].colliders()[0];
            let touched = self.physics.narrow_phase.contact_pairs_with(collider);
            let dampen_per_s = touched
                .filter(|pair| pair.has_any_active_contact())
                .map(|pair| {
                    let other =
                        if pair.collider1 == collider { pair.collider2 } else { pair.collider1 };
                    if other == *ground {
                        laws.ground.dampen_per_s
                    } else if self.physics.colliders[other].parent().is_none() {
                        laws.stairs.dampen_per_s
                    } else {
                        0.0
                    }
                })
                .fold(0.0, f32::max);
            if dampen_per_s > 0.0 {
                let factor = 1.0 - dampen_per_s * step_s;
                let body = &mut self.physics.bodies[limb];
                body.set_linvel(body.linvel() * factor, false);
                body.set_angvel(body.angvel() * factor, false);
            }
        }
    }

    /// Handles of the limbs in the physics world's body set, head first.
    pub fn limb_handles(&self) -> &[RigidBodyHandle] {
        &self.limbs
    }

    /// The engine's state, for those who look: debug drawing, picking, the bench.
    pub fn physics(&self) -> &PhysicsWorld {
        &self.physics
    }

    /// The engine's state, to be lent to another owner between steps and given back unchanged. The
    /// stage keeps it in its rapier context so that the window's tools see the very world that scores.
    pub fn physics_mut(&mut self) -> &mut PhysicsWorld {
        &mut self.physics
    }

    /// Sets the torque of each limb: the sum of the couples of its joints.
    pub(crate) fn apply(&mut self, torques: &[JointTorque]) {
        self.torques_in_world.fill(Vector::ZERO);
        for (index, (joint, torque)) in self.joints.iter().zip(torques).enumerate() {
            let bend_nm = torque.bend_nm.clamp(-joint.max_bend_torque_nm, joint.max_bend_torque_nm);
            let twist_nm =
                torque.twist_nm.clamp(-joint.max_twist_torque_nm, joint.max_twist_torque_nm);
            let front = self.physics.bodies[self.limbs[index]].rotation();
            let couple = *front * Vector::new(bend_nm, twist_nm, 0.0);
            self.applied[index] = (*front, JointTorque { bend_nm, twist_nm });
            self.torques_in_world[index] -= couple;
            self.torques_in_world[index + 1] += couple;
        }
        for (&limb, &torque) in self.limbs.iter().zip(&self.torques_in_world) {
            let body = &mut self.physics.bodies[limb];
            body.reset_torques(false);
            body.add_torque(torque, false);
        }
        if self.pull.is_some() || self.was_pulled {
            self.apply_pull();
        }
    }

    /// Lets a spring pull a limb from the next step on, or no more. What is pulled is no trial any more.
    pub fn pull(&mut self, pull: Option<Pull>) {
        self.pull = pull;
    }

    fn apply_pull(&mut self) {
        for &limb in &self.limbs {
            self.physics.bodies[limb].reset_forces(false);
        }
        self.was_pulled = false;
        let Some(pull) = self.pull else { return };
        let Some(&limb) = self.limbs.get(pull.limb) else { return };
        let step_s = self.physics.integration_parameters.dt;
        let body = &mut self.physics.bodies[limb];
        let (force, point) = pull.force_on(body, step_s);
        body.add_force_at_point(force, point, false);
        self.was_pulled = true;
    }

    /// Looks for what disqualifies: see [`HealthLimits`].
    fn check_health(&self) -> Result<Effort, Disqualification> {
        let mut seen = Effort::default();
        // Rapier rolls a body with a non-finite state back and reports it here.
        if !self.physics.quarantine().is_empty() {
            return Err(Disqualification::NotFinite);
        }
        let speed_limit_squared = self.health.speed_m_s * self.health.speed_m_s;
        let drift_limit_squared = self.health.joint_drift_m * self.health.joint_drift_m;
        let mut rear_anchor_of_previous: Option<Vector> = None;
        for (&limb, &half_length_m) in self.limbs.iter().zip(&self.half_lengths_m) {
            let body = &self.physics.bodies[limb];
            let (centre, speed_squared) = (body.translation(), body.linvel().length_squared());
            if !(centre.is_finite() && speed_squared.is_finite()) {
                return Err(Disqualification::NotFinite);
            }
            if speed_squared > speed_limit_squared {
                return Err(Disqualification::TooFast);
            }
            if centre.x.abs() > self.health.arena_half_width_m
                || centre.y < -self.health.arena_back_m
                || centre.y > self.arena_front_y_m
                || centre.z < LOWEST_Z_M
            {
                return Err(Disqualification::LeftArena);
            }
            let forward = *body.rotation() * Vector::new(0.0, half_length_m, 0.0);
            let drift_squared = rear_anchor_of_previous
                .map_or(0.0, |rear_anchor| rear_anchor.distance_squared(centre + forward));
            if drift_squared > drift_limit_squared {
                return Err(Disqualification::JointBroke);
            }
            seen = seen.and(Effort {
                energy_j: 0.0,
                top_speed_m_s: speed_squared.sqrt(),
                joint_drift_m: drift_squared.sqrt(),
                sideways_m: centre.x.abs(),
            });
            rear_anchor_of_previous = Some(centre - forward);
        }
        Ok(seen)
    }
}

impl Clone for Simulation {
    fn clone(&self) -> Self {
        let physics = &self.physics;
        Self {
            physics: PhysicsWorld {
                gravity: physics.gravity,
                integration_parameters: physics.integration_parameters,
                // It holds working memory only; a new one reads everything from the rest.
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
            contacts: self.contacts.clone(),
            limbs: self.limbs.clone(),
            joints: self.joints.clone(),
            half_lengths_m: self.half_lengths_m.clone(),
            health: self.health.clone(),
            arena_front_y_m: self.arena_front_y_m,
            torques_in_world: self.torques_in_world.clone(),
            applied: self.applied.clone(),
            effort: self.effort,
            pull: self.pull,
            was_pulled: self.was_pulled,
        }
    }
}

#[cfg(test)]
mod tests;
