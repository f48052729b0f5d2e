//! Inserts the bodies, colliders and joints of a new world in a fixed order.

use rapier3d::prelude::*;

use crate::world::WorldPlan;
use crate::world::contact::{ContactLaws, joint_coefficients};
use crate::world::surface::ContactLaw;
use crate::world::{BodyPlan, JointPlan, PhysicsWorld, SpringPlan, StairSolid, Surface};

/// Gives the collider of the ground or of a step its material.
fn material(collider: ColliderBuilder, surface: &Surface, law: &ContactLaw) -> ColliderBuilder {
    let collider = collider
        .friction(surface.friction)
        .friction_combine_rule(CoefficientCombineRule::Multiply)
        .restitution(surface.bounce)
        .restitution_combine_rule(CoefficientCombineRule::Max);
    with_hook(collider, law)
}

/// Lets the collider's contacts pass the contact hooks, if the law needs the hooks.
fn with_hook(collider: ColliderBuilder, law: &ContactLaw) -> ColliderBuilder {
    let hooks =
        if law.needs_hook() { ActiveHooks::MODIFY_SOLVER_CONTACTS } else { ActiveHooks::empty() };
    collider.active_hooks(hooks)
}

/// Inserts the ground, an infinite plane at z = 0. It can be a body of its own: see [`ContactLaws::ground_is_apart`].
pub(super) fn insert_ground(
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

/// Inserts the steps, the lowest first, and then the slopes.
pub(super) fn insert_stairs(physics: &mut PhysicsWorld, plan: &WorldPlan, law: &ContactLaw) {
    for StairSolid { pose, half_m, .. } in plan.stairs.solids() {
        let shape = ColliderBuilder::cuboid(half_m.x, half_m.y, half_m.z).position(pose);
        physics.insert_collider(material(shape, &plan.surface, law), None);
    }
}

/// Inserts the parts in the order of the plan, with their poses at the start.
pub(super) fn insert_parts(
    physics: &mut PhysicsWorld,
    plan: &WorldPlan,
    law: &ContactLaw,
) -> Vec<RigidBodyHandle> {
    let parts = plan.body.parts.iter().zip(plan.start_poses());
    parts
        .map(|(part, pose)| {
            let body = RigidBodyBuilder::dynamic().pose(pose).can_sleep(false);
            let collider = ColliderBuilder::cuboid(
                part.width_m / 2.0,
                part.length_m / 2.0,
                part.height_m / 2.0,
            )
            .density(part.density_kg_m3)
            .friction(plan.skin.friction)
            .friction_combine_rule(CoefficientCombineRule::Multiply)
            .restitution(plan.skin.bounce)
            .restitution_combine_rule(CoefficientCombineRule::Max)
            .collision_groups(collision_groups(&plan.body, part.limb));
            physics.insert(body, with_hook(collider, law)).0
        })
        .collect()
}

/// Returns the collision groups of the colliders of a limb's parts. A limb of a contact-free pair has a group of its own, which its
/// partner ignores. A limb of several parts also has a group of its own, so that its parts ignore each other.
fn collision_groups(body: &BodyPlan, limb: usize) -> InteractionGroups {
    let is_free = body.contact_free_pairs.iter().any(|pair| pair.contains(&limb));
    let is_soft = body.parts_of(limb).len() > 1;
    if !is_free && !is_soft {
        return InteractionGroups::all();
    }
    let group = |limb: usize| Group::from_bits_retain(1 << limb);
    let mut touched = Group::ALL;
    if is_soft {
        touched.remove(group(limb));
    }
    for pair in &body.contact_free_pairs {
        match *pair {
            [front, rear] if front == limb => touched.remove(group(rear)),
            [front, rear] if rear == limb => touched.remove(group(front)),
            _ => {}
        }
    }
    InteractionGroups::new(group(limb), touched, InteractionTestMode::And)
}

/// Inserts the joints and springs in the order of their places from the head, so that the solver's sweeps follow the body: see
/// [`universal_joint`] and [`spring_joint`].
pub(super) fn insert_joints(
    physics: &mut PhysicsWorld,
    parts: &[RigidBodyHandle],
    plan: &WorldPlan,
) {
    let WorldPlan { body, physics: settings, .. } = plan;
    let half_m = |part: usize| body.parts[part].length_m / 2.0;
    let joints = body.joints.iter().map(|joint| {
        let [parent, child] = [joint.parent, joint.child].map(|part| body.parts[part].mass_kg());
        let solved = settings.joint_damping_in_solver();
        let anchor = joint.anchor_m(body.parts[joint.parent].length_m);
        let mut built = universal_joint(joint, solved, anchor, half_m(joint.child));
        built.softness =
            joint_coefficients(joint.cfm_m_s_per_n, settings.substep_s(), parent, child);
        ([joint.parent, joint.child], built)
    });
    let springs = body.springs.iter().map(|spring| {
        let built = spring_joint(spring, half_m(spring.parent), half_m(spring.child));
        ([spring.parent, spring.child], built)
    });
    let mut all: Vec<_> = joints.chain(springs).collect();
    all.sort_by_key(|([_, child], _)| *child);
    for ([parent, child], built) in all {
        physics.insert_impulse_joint(parts[parent], parts[child], built);
    }
}

/// Builds a spring: it holds the facing ends of two parts of a soft limb together, and has an elastic motor about each axis.
///
/// The solver integrates these motors implicitly, so that no stiffness makes them unstable, and they never supply energy. The angle about
/// each axis is twice the arc sine of the relative quaternion's part for that axis.
pub(super) fn spring_joint(
    plan: &SpringPlan,
    parent_half_m: f32,
    child_half_m: f32,
) -> GenericJoint {
    let mut joint = GenericJointBuilder::new(JointAxesMask::LIN_AXES)
        .local_anchor1(Vector::new(0.0, -parent_half_m, 0.0))
        .local_anchor2(Vector::new(0.0, child_half_m, 0.0))
        .contacts_enabled(false)
        .build();
    let axes = [JointAxis::AngX, JointAxis::AngY, JointAxis::AngZ];
    let values = plan.stiffness_nm_per_rad.into_iter().zip(plan.damping_nms_per_rad);
    for (axis, (stiffness, damping)) in axes.into_iter().zip(values) {
        joint.set_motor_model(axis, MotorModel::ForceBased);
        joint.set_motor_position(axis, 0.0, stiffness, damping);
    }
    joint
}

/// Builds a universal joint between its place on the parent, in a chain the parent's rear face, and the front face of the child.
///
/// Rapier has no such multibody joint, so an impulse joint is used, with all axes locked except the rotations about x (bend) and y
/// (twist). Its lock keeps the z part of the relative quaternion q at zero, which makes it a constant-velocity universal joint. The bend
/// is `2 atan(q.x / q.w)`, the twist `2 atan(q.y / q.w)`. Both limits are symmetric, because asymmetric ones would make rapier call the C
/// library's sine, whose bits differ between machines.
///
/// The share `solved` of the damping is a motor with a target rate of zero, which the solver integrates implicitly: see
/// [`PhysicsSettings::joint_damping_in_solver`](crate::world::PhysicsSettings::joint_damping_in_solver). Rapier treats
/// a motor without damping as infinitely stiff, so an undamped joint's motor gets no force. The motor
/// stays nevertheless, because joints without motors are solved four at a time, by code that calls the C
/// library's arc tangent.
fn universal_joint(
    plan: &JointPlan,
    solved: f32,
    anchor: Vector,
    child_half_m: f32,
) -> GenericJoint {
    let locked = JointAxesMask::LIN_AXES | JointAxesMask::ANG_Z;
    let mut joint = GenericJointBuilder::new(locked)
        .local_frame1(Pose::from_parts(anchor, plan.axes(Rotation::IDENTITY)))
        .local_anchor2(Vector::new(0.0, child_half_m, 0.0))
        .limits(JointAxis::AngX, [-plan.bend_limit_rad, plan.bend_limit_rad])
        .limits(JointAxis::AngY, [-plan.twist_limit_rad, plan.twist_limit_rad])
        // Joined limbs touch with a whole face. With contacts, the bend would be blocked.
        .contacts_enabled(false)
        .build();
    for axis in [JointAxis::AngX, JointAxis::AngY] {
        joint.set_motor_model(axis, MotorModel::ForceBased);
        joint.set_motor_velocity(axis, 0.0, solved * plan.damping_nms_per_rad);
        if plan.damping_nms_per_rad == 0.0 {
            joint.set_motor_max_force(axis, 0.0);
        }
    }
    joint
}
