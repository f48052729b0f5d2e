//! Expresses those surface parameters that rapier lacks in terms that rapier knows.
//!
//! Softness becomes contact springs of the solver ([`soften`]); bounce velocity and slip act through
//! contact hooks ([`ContactHooks`]), which are switched on only where a contact needs them.

use rapier3d::geometry::NEW_CONTACT_BIT;
use rapier3d::prelude::*;

use super::surface::{ContactLaw, ERP_TIME_S, Softness, Spring, spring};
use super::{PartPlan, PhysicsSettings, WorldPlan};

/// Returns the collider of a contact pair that is not `collider`.
pub(super) fn other_collider(pair: &ContactPair, collider: ColliderHandle) -> ColliderHandle {
    if pair.collider1 == collider { pair.collider2 } else { pair.collider1 }
}

/// The laws of all contacts in a world.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ContactLaws {
    /// Law of contacts between the snake and the stairs.
    pub stairs: ContactLaw,
    /// Law of contacts between the snake and the ground.
    pub ground: ContactLaw,
    /// Law of contacts between limbs of the snake.
    pub limbs: ContactLaw,
    /// Whether at least one joint of the snake is a spring.
    pub joints_are_soft: bool,
}

impl ContactLaws {
    /// Returns whether any contact or joint is a spring. The solver then runs without its velocity-only passes, which would make every
    /// contact rigid again and let every soft joint drift apart.
    pub fn has_springs(&self) -> bool {
        self.joints_are_soft
            || [self.stairs, self.ground, self.limbs].iter().any(|law| law.softness.is_soft())
    }

    /// Returns whether ground and stairs differ in softness. Rapier knows two softnesses, one for contacts with fixed bodies and one for
    /// all others. If ground and stairs differ, the ground is therefore an immovable body that is not fixed, and contacts between limbs
    /// are as soft as contacts with the ground.
    pub fn ground_is_apart(&self) -> bool {
        self.ground.softness != self.stairs.softness
    }
}

/// How the solver makes contacts as soft as the laws say. The springs are computed for the weight of a reference limb.
pub(super) struct ContactSoftness {
    /// The laws of all contacts.
    pub laws: ContactLaws,
    corner_kg: f32,
    quarter_kg: f32,
}

/// Returns the softness of all contacts of a plan. Its middle part is the reference for the springs.
pub(super) fn soft_contacts(plan: &WorldPlan) -> ContactSoftness {
    let laws = ContactLaws {
        stairs: ContactLaw::between(&plan.surface, &plan.skin),
        ground: ContactLaw::between(&plan.ground, &plan.skin),
        limbs: ContactLaw::within(&plan.skin),
        joints_are_soft: plan.body.joints.iter().any(|joint| joint.cfm_m_s_per_n > 0.0),
    };
    let reference = plan.body.parts.get(plan.body.middle_part);
    let [corner_kg, quarter_kg] =
        reference.map_or([1.0; 2], |part| [corner_mass_kg(part), part.mass_kg() / 4.0]);
    ContactSoftness { laws, corner_kg, quarter_kg }
}

impl ContactSoftness {
    /// Returns rapier's coefficients for contacts of this softness.
    pub fn of(&self, softness: Softness, physics: &PhysicsSettings) -> SpringCoefficients<Real> {
        let soft = |softness| {
            soft_coefficients(softness, physics.substep_s(), self.corner_kg, self.quarter_kg)
        };
        if softness.is_soft() {
            soft(softness)
        } else if self.laws.has_springs() {
            // A rigid contact beside soft ones must be a very stiff spring, because the solver has one mode for all contacts.
            soft(Softness { cfm_m_s_per_n: HARD_CFM_M_S_PER_N, ..softness })
        } else {
            hard_coefficients(softness.erp, physics)
        }
    }

    /// Sets the parameters of rapier's solver.
    pub fn set_up(&self, parameters: &mut IntegrationParameters, physics: &PhysicsSettings) {
        let laws = &self.laws;
        parameters.static_contact_softness = self.of(laws.stairs.softness, physics);
        let others =
            if laws.ground_is_apart() { laws.ground.softness } else { laws.limbs.softness };
        parameters.contact_softness = self.of(others, physics);
        if laws.has_springs() {
            parameters.num_internal_stabilization_iterations = 0;
            // Rapier caps the speed at which a spring pushes back. The cap would weaken a spring the more, the deeper it is pressed.
            parameters.normalized_max_corrective_velocity = Real::MAX;
        }
    }
}

/// CFM that the engine manual of the report calls hard, in m/s per N.
const HARD_CFM_M_S_PER_N: f32 = 1.0e-5;

/// Returns rapier's softness for a hard contact that corrects the share `erp` of a penetration in [`ERP_TIME_S`], that is
/// `1 - (1 - erp)^(s / ERP_TIME_S)` in each substep of length s.
///
/// Rapier has `erp = dt·w / (dt·w + 2z)` for the angular frequency w and the damping ratio z; a large z
/// makes the contact's compliance vanish.
fn hard_coefficients(erp: f32, physics: &PhysicsSettings) -> SpringCoefficients<Real> {
    let substep_s = physics.substep_s();
    let left = libm::powf((1.0 - erp).max(1.0e-3), substep_s / ERP_TIME_S);
    let damping_ratio = 1.0e3;
    let angular_frequency = 2.0 * damping_ratio * (1.0 - left) / (left * substep_s);
    SpringCoefficients {
        natural_frequency: angular_frequency / std::f32::consts::TAU,
        damping_ratio,
    }
}

/// Returns rapier's softness for a contact with the spring and damper that ERP and CFM describe (see [`spring`]).
///
/// Rapier scales its springs with the effective mass at each contact, `w² m` and `2 z w m`; so the conversion holds
/// exactly for one mass, `effective_kg`: see [`corner_mass_kg`]. `moved_kg` is the mass that the spring moves.
///
/// Rapier integrates a spring k and a damper c in substeps of length h as the force `-k x - (c + h k) v'`, with the
/// velocity v' after the substep. The term `h k` damps as much as the damper of a trampoline, and the more the longer
/// the substep. Without it the motion is that of the symplectic Euler method, which keeps the energy of a spring, with
/// for that to be stable; there the motion is too fast to be seen. The damper itself is made stronger, so that implicit integration takes
/// `exp(-c h / m)` of a velocity.
fn soft_coefficients(
    softness: Softness,
    substep_s: f32,
    effective_kg: f32,
    moved_kg: f32,
) -> SpringCoefficients<Real> {
    const LEAST_DAMPING: f32 = 2.0e-3;
    const LEAST_RATIO: f32 = 1.0e-3;
    let Spring { kp_n_per_m, kd_ns_per_m } = spring(softness);
    // If the motion is over within one substep, the exponential would overflow.
    let lost = (kd_ns_per_m * substep_s / moved_kg).min(1.0);
    let stronger = if lost > 1.0e-3 { libm::expm1f(lost) / lost } else { 1.0 };
    // Without any damping (with an ERP of 1), rapier would divide by zero.
    let damper = (stronger * kd_ns_per_m).max(LEAST_DAMPING * kp_n_per_m * ERP_TIME_S);
    let turned_rad = substep_s * (kp_n_per_m / moved_kg).sqrt();
    let taken = (2.0 - 2.0 * turned_rad).clamp(0.0, 1.0);
    let damper = damper - taken * substep_s * kp_n_per_m;
    // With values near zero, rapier would divide zero by zero, or lose precision.
    let least = LEAST_RATIO * substep_s * kp_n_per_m;
    let damper = if damper.abs() < least { least } else { damper };
    let angular_frequency = (kp_n_per_m / effective_kg).sqrt();
    SpringCoefficients {
        natural_frequency: angular_frequency / std::f32::consts::TAU,
        damping_ratio: damper / (2.0 * angular_frequency * effective_kg),
    }
}

/// Returns rapier's softness for a joint between limbs with these masses, in kg. It is exact for a pull along the snake, where the
/// effective mass is the reduced mass of the pair. The ERP is [`JOINT_ERP`].
pub(super) fn joint_coefficients(
    cfm_m_s_per_n: f32,
    substep_s: f32,
    front_kg: f32,
    rear_kg: f32,
) -> SpringCoefficients<Real> {
    if cfm_m_s_per_n == 0.0 {
        return SpringCoefficients::joint_defaults();
    }
    let reduced_kg = front_kg * rear_kg / (front_kg + rear_kg);
    soft_coefficients(Softness { erp: JOINT_ERP, cfm_m_s_per_n }, substep_s, reduced_kg, reduced_kg)
}

/// Share of a soft joint's error that is corrected in [`ERP_TIME_S`]: ODE's default per step.
pub(super) const JOINT_ERP: f32 = 0.2;

/// Returns the effective mass, in kg, at a contact in a corner of a limb that lies flat:
/// `1 / m_eff = (1 + 3 l² / (l² + h²) + 3 w² / (w² + h²)) / m`, from the inertia of a box. For a limb of the report, 1 by 2 by 1, the
/// result is m / 4.9.
fn corner_mass_kg(limb: &PartPlan) -> f32 {
    let [w2, l2, h2] = limb.size_m().map(|size| size * size);
    limb.mass_kg() / (1.0 + 3.0 * l2 / (l2 + h2) + 3.0 * w2 / (w2 + h2))
}

/// Adjusts the contacts of a world before they are solved.
pub(super) struct ContactHooks<'a> {
    pub laws: &'a ContactLaws,
    pub ground: ColliderHandle,
    pub step_s: f32,
    pub substeps: u32,
    /// Mass of the whole snake, in kg.
    pub snake_kg: f32,
}

impl PhysicsHooks for ContactHooks<'_> {
    fn modify_solver_contacts(&self, context: &mut ContactModificationContext) {
        let law = if context.collider1 == self.ground || context.collider2 == self.ground {
            &self.laws.ground
        } else if [context.rigid_body1, context.rigid_body2]
            .iter()
            .flatten()
            .all(|body| context.bodies[*body].is_dynamic())
            && context.rigid_body1.is_some()
            && context.rigid_body2.is_some()
        {
            &self.laws.limbs
        } else {
            &self.laws.stairs
        };
        if law.softness.is_soft() {
            // The engine stops an approaching contact rigidly before the bodies touch; a spring pushes only once they touch.
            context.solver_contacts.retain(|contact| contact.dist <= 0.0);
        }
        if law.bounce_velocity_m_s > 0.0 && incoming_m_s(context) < law.bounce_velocity_m_s {
            *context.restitution = 0.0;
        }
        if law.slip_m_s_per_n > 0.0 {
            self.let_slip(law.slip_m_s_per_n, context);
        }
    }
}

/// Returns the velocity of the first body's surface relative to the second's at a point, in m/s.
fn relative_velocity(context: &ContactModificationContext, at: Vector) -> Vector {
    let velocity = |body: Option<RigidBodyHandle>| {
        body.map_or(Vector::ZERO, |body| context.bodies[body].velocity_at_point(at))
    };
    velocity(context.rigid_body1) - velocity(context.rigid_body2)
}

/// Returns the greatest speed at which the bodies approach each other at their contacts, in m/s.
fn incoming_m_s(context: &ContactModificationContext) -> f32 {
    // The normal points from the first body to the second.
    let approach =
        |contact: &SolverContact| relative_velocity(context, contact.anchor2).dot(*context.normal);
    context.solver_contacts.iter().map(approach).fold(0.0, f32::max)
}

impl ContactHooks<'_> {
    /// Lets a contact patch creep: see [`SlippingPatch`].
    fn let_slip(&self, slip_m_s_per_n: f32, context: &mut ContactModificationContext) {
        let count = context.solver_contacts.len() as f32;
        if count == 0.0 {
            return;
        }
        // The manifold also holds points that are near but do not touch, with the impulses of their last touch.
        let touching = context.solver_contacts.iter().filter_map(|contact| {
            context.manifold.points.get((contact.contact_id[0] & !NEW_CONTACT_BIT) as usize)
        });
        // The engine keeps the impulses of the last substep: for each point its own pressure, but the friction of the whole patch. (Its
        // sum over a step counts a persistent contact once too often.)
        let (mut friction_ns, mut pressed_ns) = (Vector::ZERO, 0.0);
        for point in touching {
            friction_ns += point.data.warmstart_tangent_world;
            pressed_ns += point.data.warmstart_impulse;
        }
        let anchors = context.solver_contacts.iter().map(|contact| contact.anchor2);
        let centre = anchors.sum::<Vector>() / count;
        let velocity = relative_velocity(context, centre);
        let along_normal = velocity.dot(*context.normal);
        let patch = SlippingPatch {
            friction_ns,
            points: count,
            pressed_ns,
            sliding_m_s: velocity - *context.normal * along_normal,
            approach_m_s: along_normal,
            mass_kg: self.limb_mass_kg(context),
            step_s: self.step_s,
            substeps: self.substeps,
        };
        if let Some(friction) = patch.friction(slip_m_s_per_n) {
            *context.friction = context.friction.min(friction);
        }
    }

    /// Returns the mass of the touching limb, in kg; if two limbs touch, the mass of the lighter one.
    fn limb_mass_kg(&self, context: &ContactModificationContext) -> f32 {
        let bodies = [context.rigid_body1, context.rigid_body2];
        let masses = bodies.iter().flatten().map(|body| context.bodies[*body].mass());
        masses.filter(|mass| *mass > 0.0).fold(self.snake_kg, f32::min)
    }
}

/// A contact patch that creeps with the speed slip times its tangential force. The creep is made by a lower friction.
///
/// Inside the friction cone the patch should behave as a viscous contact, F = v / slip. The solver can only stop a contact or let it
/// slide. Its friction is therefore limited to the viscous force that will act at the end of this step: with u = h / mass and the sliding
/// velocity that the patch would have without friction, v + u F (from the last step's F), `F' = |v + u F| / (slip + u)`. A steady push P
/// then makes the patch creep at slip · P. The roots of `x² - x + u / (slip + u)`, the growth of deviations per step, lie within the unit
/// circle for every slip. Friction never does more than stop a motion, so it cannot add energy, even where the estimates are poor, as in a
/// fall.
pub(super) struct SlippingPatch {
    /// Sum over the patch's points of their friction in the last substep, in N·s, on the body whose sliding is given. The engine gives
    /// each point the friction of the whole patch.
    pub friction_ns: Vector,
    /// Number of the patch's points.
    pub points: f32,
    /// Sum of the normal impulses of the points in the last substep, in N·s.
    pub pressed_ns: f32,
    /// Velocity of the limb along the surface, in m/s.
    pub sliding_m_s: Vector,
    /// Speed of the limb along the normal towards the surface, in m/s.
    pub approach_m_s: f32,
    /// Mass of the limb, in kg.
    pub mass_kg: f32,
    pub step_s: f32,
    pub substeps: u32,
}

impl SlippingPatch {
    /// Returns the coefficient of friction that lets the patch creep; `None` while nothing presses on it.
    pub fn friction(&self, slip_m_s_per_n: f32) -> Option<f32> {
        let per_s = self.substeps as f32 / self.step_s;
        let (force_n, pressed_n) =
            (self.friction_ns * (per_s / self.points), self.pressed_ns * per_s);
        let per_mass = self.step_s / (self.mass_kg * PATCH_SHARE_OF_MASS);
        // Friction opposes the sliding, so that without it the patch slides faster.
        let free_m_s = (self.sliding_m_s - force_n * per_mass).length();
        let viscous_n = free_m_s / (slip_m_s_per_n + per_mass);
        // The impact of a landing patch adds to the pressure.
        let impact_n = self.mass_kg * self.approach_m_s.max(0.0) / self.step_s;
        let pressed_n = pressed_n + impact_n;
        (pressed_n > 0.0).then(|| viscous_n / pressed_n)
    }
}

/// Share of a limb's mass that a push along the surface at its underside has to move: less than 1, because the limb also turns. Too large
/// a share would be unstable; too small a share only makes the creep slower.
const PATCH_SHARE_OF_MASS: f32 = 0.3;
