//! One snake on one staircase, advanced by one constant step at a time.
//!
//! Everything that scores, replays, shows or tests a snake goes through [`Simulation::step`].

use rapier3d::prelude::*;

use super::bounce::{Velocity, finish_bounce};
use super::contact::{ContactLaws, Hooks, joint_coefficients, soften};
use super::surface::ContactLaw;
use super::{
    BodyPlan, Disqualification, Effort, HealthLimits, JointPlan, PhysicsSettings, PhysicsWorld,
    Skin, Stairs, Surface,
};

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

/// How a joint stands, as the snake feels it: the rear limb as seen from the front limb.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct JointState {
    /// Bend about the front limb's x axis, in radians.
    pub bend_rad: f32,
    /// Twist about the front limb's y axis, in radians.
    pub twist_rad: f32,
    /// Rate of turn about the front limb's x axis, in rad/s.
    pub bend_rad_s: f32,
    /// Rate of turn about the front limb's y axis, in rad/s.
    pub twist_rad_s: f32,
}

/// A running world.
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
        for stair in plan.stairs.boxes() {
            let min = Vector::from(stair.min_m);
            let half = (Vector::from(stair.max_m) - min) / 2.0;
            let shape = ColliderBuilder::cuboid(half.x, half.y, half.z).translation(min + half);
            physics.insert_collider(material(shape, &plan.surface, &laws.stairs), None);
        }

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

    /// The pose of each limb's centre, head first.
    pub fn poses(&self) -> impl ExactSizeIterator<Item = Pose> + '_ {
        self.limbs.iter().map(|&limb| *self.physics.bodies[limb].position())
    }

    /// How each joint stands, from the head: see [`universal_joint`] for what its angles are.
    pub fn joint_states(&self) -> impl ExactSizeIterator<Item = JointState> + '_ {
        self.limbs.windows(2).map(|pair| {
            let [front, rear] = [pair[0], pair[1]].map(|limb| &self.physics.bodies[limb]);
            let into_front = front.rotation().inverse();
            let turn = into_front * *rear.rotation();
            let rate = into_front * (rear.angvel() - front.angvel());
            // A rotation and its negative are the same; the one with w ≥ 0 is the short way round.
            let sign = if turn.w < 0.0 { -1.0 } else { 1.0 };
            let angle_rad = |part: f32| 2.0 * libm::atan2f(sign * part, sign * turn.w);
            JointState {
                bend_rad: angle_rad(turn.x),
                twist_rad: angle_rad(turn.y),
                bend_rad_s: rate.x,
                twist_rad_s: rate.y,
            }
        })
    }

    /// How many limbs touch the ground or the stairs.
    pub fn limbs_in_contact(&self) -> usize {
        let touches = |&&limb: &&RigidBodyHandle| {
            let collider = self.physics.bodies[limb].colliders()[0];
            self.physics.narrow_phase.contact_pairs_with(collider).any(|pair| {
                let other =
                    if pair.collider1 == collider { pair.collider2 } else { pair.collider1 };
                let is_world = other == self.contacts.ground
                    || self.physics.colliders[other].parent().is_none();
                is_world && pair.has_any_active_contact()
            })
        };
        self.limbs.iter().filter(touches).count()
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

/// Gives a collider of the world its material.
fn material(collider: ColliderBuilder, surface: &Surface, law: &ContactLaw) -> ColliderBuilder {
    let collider = collider
        .friction(surface.friction)
        .friction_combine_rule(CoefficientCombineRule::Multiply)
        .restitution(surface.bounce)
        .restitution_combine_rule(CoefficientCombineRule::Max);
    with_hook(collider, law)
}

/// Lets the collider's contacts pass the hooks, if they have to.
fn with_hook(collider: ColliderBuilder, law: &ContactLaw) -> ColliderBuilder {
    let hooks =
        if law.needs_hook() { ActiveHooks::MODIFY_SOLVER_CONTACTS } else { ActiveHooks::empty() };
    collider.active_hooks(hooks)
}

/// Inserts the ground, an endless plane at z = 0: see [`ContactLaws::ground_is_apart`].
fn insert_ground(
    physics: &mut PhysicsWorld,
    plan: &WorldPlan,
    laws: &ContactLaws,
) -> ColliderHandle {
    let plane = ColliderBuilder::new(SharedShape::halfspace(Vector::Z));
    let plane = material(plane, &plan.ground, &laws.ground);
    if laws.ground_is_apart() {
        let body = RigidBodyBuilder::dynamic()
            .lock_translations()
            .lock_rotations()
            .gravity_scale(0.0)
            .can_sleep(false);
        physics.insert(body, plane.density(0.0)).1
    } else {
        physics.insert_collider(plane, None)
    }
}

/// Inserts the straight snake, head first, lying on the ground.
fn insert_limbs(
    physics: &mut PhysicsWorld,
    plan: &WorldPlan,
    law: &ContactLaw,
) -> Vec<RigidBodyHandle> {
    let axis_z_m = plan.body.axis_height_m();
    let middle = Vector::new(plan.start_x_m, plan.start_y_m, 0.0);
    let (sin, cos) = libm::sincosf(plan.start_turn_rad);
    let (half_sin, half_cos) = libm::sincosf(plan.start_turn_rad / 2.0);
    let turn = Rotation::from_xyzw(0.0, 0.0, half_sin, half_cos);
    let mut front_y_m = plan.start_y_m + plan.body.length_m() / 2.0;
    plan.body
        .limbs
        .iter()
        .map(|limb| {
            let straight_y_m = front_y_m - limb.length_m / 2.0;
            front_y_m -= limb.length_m;
            let centre = if plan.start_turn_rad == 0.0 {
                // Not around the middle and back: rounding would make other bits of it.
                Vector::new(plan.start_x_m, straight_y_m, axis_z_m)
            } else {
                let along_m = straight_y_m - plan.start_y_m;
                middle + Vector::new(-sin * along_m, cos * along_m, axis_z_m)
            };
            let body = RigidBodyBuilder::dynamic()
                .pose(Pose::from_parts(centre, turn))
                .angular_damping(plan.body.angular_damping_per_s)
                .can_sleep(false);
            let collider = ColliderBuilder::cuboid(
                limb.width_m / 2.0,
                limb.length_m / 2.0,
                limb.height_m / 2.0,
            )
            .density(limb.density_kg_m3)
            .friction(plan.skin.friction)
            .friction_combine_rule(CoefficientCombineRule::Multiply)
            .restitution(plan.skin.bounce)
            .restitution_combine_rule(CoefficientCombineRule::Max);
            physics.insert(body, with_hook(collider, law)).0
        })
        .collect()
}

/// Joins neighbours, head first. See [`universal_joint`].
fn insert_joints(physics: &mut PhysicsWorld, limbs: &[RigidBodyHandle], plan: &WorldPlan) {
    let body = &plan.body;
    for (index, joint) in body.joints.iter().enumerate() {
        let (front, rear) = (&body.limbs[index], &body.limbs[index + 1]);
        let mut built = universal_joint(joint, front.length_m / 2.0, rear.length_m / 2.0);
        built.softness = joint_coefficients(
            joint.cfm_m_s_per_n,
            plan.physics.step_s(),
            front.mass_kg(),
            rear.mass_kg(),
        );
        physics.insert_impulse_joint(limbs[index], limbs[index + 1], built);
    }
}

/// A universal joint between the rear face of the front limb and the front face of the rear limb.
///
/// Rapier has no such joint among its multibodies, so it is an impulse joint with all axes locked but
/// the rotations about x (bend) and y (twist). Its lock keeps the z part of the relative quaternion at
/// zero, which makes it a constant-velocity universal joint. With `q` that quaternion the bend is
/// `2 atan(q.x / q.w)`, the twist `2 atan(q.y / q.w)`; both limits are symmetric (asymmetric ones would
/// make rapier call the C library's sine, whose bits differ between machines).
///
/// The damping is a motor that wants zero joint rate, which the solver integrates implicitly. Rapier takes
/// a motor without damping for an infinitely stiff one, so an undamped joint's motor gets no force. It
/// stays, because joints without motors are solved four at a time, by code that calls the C library's
/// arc tangent.
fn universal_joint(plan: &JointPlan, front_half_m: f32, rear_half_m: f32) -> GenericJoint {
    let locked = JointAxesMask::LIN_AXES | JointAxesMask::ANG_Z;
    let mut joint = GenericJointBuilder::new(locked)
        .local_anchor1(Vector::new(0.0, -front_half_m, 0.0))
        .local_anchor2(Vector::new(0.0, rear_half_m, 0.0))
        .limits(JointAxis::AngX, [-plan.bend_limit_rad, plan.bend_limit_rad])
        .limits(JointAxis::AngY, [-plan.twist_limit_rad, plan.twist_limit_rad])
        // Neighbours touch with a whole face; their contact would block the bend.
        .contacts_enabled(false)
        .build();
    for axis in [JointAxis::AngX, JointAxis::AngY] {
        joint.set_motor_model(axis, MotorModel::ForceBased);
        joint.set_motor_velocity(axis, 0.0, plan.damping_nms_per_rad);
        if plan.damping_nms_per_rad == 0.0 {
            joint.set_motor_max_force(axis, 0.0);
        }
    }
    joint
}

#[cfg(test)]
mod tests;
