//! The boundary between a world and the engine that moves its parts. Damping, energy balance, health, senses and readings know no engine:
//! they read the [`PartState`]s and the [`PartContact`]s, which every engine holds.

use std::any::Any;

use super::turning::turned;
use super::{Pose, Rotation, Vector};

/// The state of a part: what moves it in the next step, and what it touched in the last one.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PartState {
    /// Centre of the part, in metres.
    pub at: Vector,
    /// Rotation of the part.
    pub turn: Rotation,
    /// Velocity of the part's centre, in m/s.
    pub linear: Vector,
    /// Angular velocity of the part in the world, in rad/s.
    pub angular: Vector,
    /// Force on the part's centre besides gravity, in N. It acts until it is changed.
    pub force_n: Vector,
    /// Torque on the part in the world, in N·m. [`super::Simulation::step`] sets it before each step.
    pub torque_nm: Vector,
    /// Whether the part is held in its place, so that nothing moves it.
    pub is_held: bool,
    /// Contacts of the part with ground and stairs in the last step.
    pub touch: Touch,
}

/// The contacts of a part with ground and stairs in the last step.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Touch {
    /// Whether the part touches the ground.
    pub ground: bool,
    /// Whether the part touches the stairs.
    pub stairs: bool,
    /// Force of ground and stairs on the part in the last substep, in N.
    pub force_n: Vector,
}

impl Touch {
    /// Returns whether the part touches the ground or the stairs.
    pub fn any(&self) -> bool {
        self.ground || self.stairs
    }
}

impl PartState {
    /// Returns the state of a part at rest.
    pub(super) fn at_rest(pose: Pose) -> Self {
        Self { at: pose.translation, turn: pose.rotation, ..Self::default() }
    }

    /// Returns the pose of the part's centre.
    pub fn pose(&self) -> Pose {
        Pose::from_parts(self.at, self.turn)
    }

    /// Returns the energy of the part's motion, in J, given its mass in kg and its moments of inertia about its own axes in kg·m².
    pub(super) fn kinetic_energy_j(&self, mass_kg: f32, inertia_kg_m2: Vector) -> f32 {
        let rate = turned(self.turn.inverse(), self.angular);
        let turning = (inertia_kg_m2 * rate).dot(rate);
        (mass_kg * self.linear.dot(self.linear) + turning) / 2.0
    }

    /// Returns the velocity of the part at a place in the world, in m/s.
    pub fn velocity_at(&self, at: Vector) -> Vector {
        self.linear + self.angular.cross(at - self.at)
    }
}

/// A surface that a limb touches.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TouchedSurface {
    /// A step of the stairs.
    Stairs,
    /// The ground.
    Ground,
    /// Another limb, with this index.
    Limb(usize),
}

/// A body that a part touches.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Touching {
    Ground,
    /// The solid of the stairs with this index.
    Solid(usize),
    /// The part with this index, which is closer to the head.
    Part(usize),
}

/// A contact of a part after a step: points along one normal, which share their friction.
#[derive(Debug, Clone)]
pub(super) struct PartContact {
    /// Index of the part. For a contact of two parts, it is the rear one.
    pub part: usize,
    /// The body that the part touches.
    pub other: Touching,
    /// Unit vector in the world along which the part is pushed.
    pub normal: Vector,
    /// Coulomb coefficient of the materials.
    pub friction: f32,
    /// Friction on the part in the last substep, in N·s, in the world.
    pub friction_ns: Vector,
    /// Angular impulse of the friction on the part about the normal in the last substep, in N·m·s.
    pub twist_nms: f32,
    /// Whether a point has bounced in the last step.
    pub has_bounced: bool,
    pub points: Vec<PartContactPoint>,
}

/// A point of a contact after a step.
#[derive(Debug, Clone, Copy)]
pub(super) struct PartContactPoint {
    /// Point on the part, in the part's own frame, in metres.
    pub on_part: Vector,
    /// Point on the other body, in metres: in the frame of the touched part, or in the world.
    pub on_other: Vector,
    /// Impulse along the normal in the last substep, in N·s.
    pub impulse_ns: f32,
}

/// An engine with one snake on its stairs. A clone continues with the same bits as the original.
pub(super) trait WorldEngine: Any + Send + Sync {
    /// Returns the parts, in the order of the plan's parts.
    fn parts(&self) -> &[PartState];

    /// Gives write access to the parts. The next step begins with their changed state.
    fn parts_mut(&mut self) -> &mut [PartState];

    /// Advances the parts by one step, without their bounces.
    fn step(&mut self);

    /// Lets parts bounce that have landed in the last step, given the parts before it. It changes velocities only.
    fn bounce(&mut self, earlier: &[PartState]);

    /// Returns whether the engine has found a number that is not finite, and has discarded it.
    fn has_failed(&self) -> bool {
        false
    }

    /// Returns the contacts after the last step.
    fn contacts(&self) -> Vec<PartContact>;

    /// Continues with the contacts of the same engine under another plan, if they are at the same places there. `earlier` has parts in the
    /// same state.
    fn continue_from(&mut self, earlier: &dyn WorldEngine);

    /// Returns a clone.
    fn cloned(&self) -> Box<dyn WorldEngine>;
}

impl Clone for Box<dyn WorldEngine> {
    fn clone(&self) -> Self {
        self.cloned()
    }
}
