//! Energy balance of the snake: the work of its joints, its mechanical energy, and what was lost.

use rapier3d::prelude::*;

/// Terms of the energy balance that only stepping knows, since the start. They never act back on the simulation.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct EnergyBalance {
    /// Mechanical energy at the start, in J.
    pub start_j: f64,
    /// Work of the joint torques, in J: positive where they drive, negative where they brake.
    pub joint_work_j: f64,
    /// Energy that the joints spent on motion, in J, driving or braking.
    pub motion_j: f32,
    /// Energy that the damping of the joints took, in J.
    pub joint_damping_j: f64,
    /// Energy that the damping of the limbs' rotation took, in J.
    pub rotation_damping_j: f64,
    /// Whether something acted whose work is not counted: a user's pull, or a change of the engine's state.
    pub has_unknown_work: bool,
}

/// Energy that may come from nothing, as a share of the energy that the joints spent: the error of the balance.
const GAIN_SHARE: f32 = 0.05;
/// Energy that may come from nothing beside that share, in J: the contacts settle at the start.
const GAIN_J: f32 = 1.0;

/// Rotation of a limb before a step.
#[derive(Debug, Clone, Copy)]
pub(super) struct LimbTurn {
    /// Rotation of the limb in the world.
    pub rotation: Rotation,
    /// Angular velocity of the limb in the world, in rad/s.
    pub rate: Vector,
}

/// Mechanical energy that the snake has lost since the start.
///
/// The damping of rotation is exact. The work of the joints and their damping are integrals over each step, from the
/// rates at both ends and the angle turned in between, accurate to a few hundredths of the joints' work. The work of a
/// user's pull is not counted: after a pull the numbers say nothing.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct EnergyLost {
    /// Everything that turned into heat, in J: `E(0) + W - E(t)`, with the kinetic and potential energy E of all limbs, the
    /// springs of soft ones included, and the work W of the joint torques. A dent or a soft joint under load holds a little
    /// of it, which may come back.
    pub total_j: f32,
    /// The part of the joints' damping, in J: the integral of `c ω²` over all joint axes, for the damping c and the
    /// rate ω.
    pub joint_damping_j: f32,
    /// The part of the damping of the limbs' rotation, in J: the integral of `2 d E_rot`, for the rate d at which
    /// rotation is damped and the energy of rotation.
    pub rotation_damping_j: f32,
}

impl EnergyLost {
    /// Energy that neither damping took, in J: the loss in contacts (friction, impacts, dents, damping of surfaces), at
    /// the stops of the joints, and in the springs of soft limbs. The balance cannot separate these;
    /// [`super::Simulation::contact_patches`] has the power of friction.
    pub fn elsewhere_j(&self) -> f32 {
        self.total_j - self.joint_damping_j - self.rotation_damping_j
    }

    /// Whether the mechanical energy has risen beyond the work of the joints: by more than 5 % of what they spent, and
    /// 1 J. No physics does that; the simulation has failed, and the snake would exploit it.
    pub fn is_from_nothing(&self, spent_j: f32) -> bool {
        -self.total_j > GAIN_SHARE * spent_j + GAIN_J
    }
}
