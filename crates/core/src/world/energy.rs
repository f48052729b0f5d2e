//! Energy balance of the snake: the work of its joints, its mechanical energy, and the energy lost.

/// Terms of the energy balance that accumulate from step to step. They never influence the simulation.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct EnergyBalance {
    /// Mechanical energy at the start of the trial, in J.
    pub start_j: f64,
    /// Work of the joint torques, in J: positive where the torques drive, negative where they brake.
    pub joint_work_j: f64,
    /// Energy that the joints spent on motion, in J. Driving and braking both count as spent.
    pub motion_j: f32,
    /// Energy that the damping of the joints has turned into heat, in J.
    pub joint_damping_j: f64,
    /// Energy that the damping of the limbs' rotation has turned into heat, in J.
    pub rotation_damping_j: f64,
    /// Whether something acted on the snake whose work is not counted: a user's pull, or a change of the engine's state from outside.
    pub has_unknown_work: bool,
}

/// Unexplained gain of energy that is tolerated as the error of the balance, as a share of the energy that the joints spent.
const GAIN_SHARE: f32 = 0.05;
/// Unexplained gain of energy that is tolerated in addition to `GAIN_SHARE`, in J, because contacts settle at the start.
const GAIN_J: f32 = 1.0;

/// Mechanical energy that the snake has lost since the start.
///
/// The damping of rotation is exact. The work of the joints and their damping are integrals over each step, from the
/// rates at both ends and the angle turned in between, accurate to a few hundredths of the joints' work. The work of a
/// user's pull is not counted: after a pull, these numbers are meaningless.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct EnergyLost {
    /// Everything that turned into heat, in J: `E(0) + W - E(t)`, with the kinetic and potential energy E of all limbs, including that of
    /// springs in soft limbs, and the work W of the joint torques. A dent or a soft joint under load holds a little of this energy, and
    /// may return it.
    pub total_j: f32,
    /// Energy that the joints' damping turned into heat, in J: the integral of `c ω²` over all joint axes, for the damping c and the rate
    /// ω.
    pub joint_damping_j: f32,
    /// Energy that the damping of the limbs' rotation turned into heat, in J: the integral of `2 d E_rot`, for the rate d at which
    /// rotation is damped and the energy of rotation E_rot.
    pub rotation_damping_j: f32,
}

impl EnergyLost {
    /// Returns the energy lost in other ways than by damping of joints and rotation, in J: in contacts (friction, impacts, dents, damping
    /// of surfaces), at the stops of the joints, and in the springs of soft limbs. The balance cannot separate these losses;
    /// [`super::Simulation::contact_patches`] has the power of friction.
    pub fn elsewhere_j(&self) -> f32 {
        self.total_j - self.joint_damping_j - self.rotation_damping_j
    }

    /// Returns whether the mechanical energy has risen by more than the work of the joints, plus 5 % of the energy that they spent, plus 1
    /// J. Physics does not allow it: the simulation has failed, and evolution would exploit the failure.
    pub fn is_from_nothing(&self, spent_j: f32) -> bool {
        -self.total_j > GAIN_SHARE * spent_j + GAIN_J
    }
}
