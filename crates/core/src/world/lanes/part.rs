//! A part of the snake in each lane, and how it moves.

use super::chain::Chain;
use super::wide::{Wide, WideRotation, WideSymmetric, WideVector};

/// Greatest speed of a part, in m/s, as in rapier. `MOST_TURN_RAD` is its greatest turn within a step, in radians.
const MOST_M_S: f32 = 400.0;
pub(super) const MOST_TURN_RAD: f32 = std::f32::consts::FRAC_PI_4;

/// One part of the snake per lane.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct WidePart<const N: usize> {
    pub at: WideVector<N>,
    /// Position of the centre at the beginning of the step.
    pub began_at: WideVector<N>,
    pub turn: WideRotation<N>,
    /// Axes of the part in the world, at its present rotation.
    pub axes: [WideVector<N>; 3],
    pub linear: WideVector<N>,
    pub angular: WideVector<N>,
    pub inverse_kg: Wide<N>,
    /// 1, or 0 for a part that is held.
    moves: Wide<N>,
    /// Inverse inertia in the world, at the beginning of the step.
    pub inverse_inertia: WideSymmetric<N>,
    inertia: WideVector<N>,
    /// Changes of the linear velocity, and in `adds_angular` of the angular velocity, in a substep by gravity, forces and torques.
    adds_linear: WideVector<N>,
    adds_angular: WideVector<N>,
}

/// Borrows two different parts, so that both can be changed; `None` if there are no such parts.
#[inline(always)]
pub(super) fn both<const N: usize>(
    parts: &mut [WidePart<N>],
    front: usize,
    rear: usize,
) -> Option<(&mut WidePart<N>, &mut WidePart<N>)> {
    let (before, after) = parts.split_at_mut_checked(rear)?;
    Some((before.get_mut(front)?, after.first_mut()?))
}

impl<const N: usize> WidePart<N> {
    pub fn load(&mut self, lane: usize, chain: &Chain, index: usize) {
        let (part, state) = (&chain.parts[index], &chain.state[index]);
        self.at.set(lane, state.at);
        self.turn.set(lane, state.turn.to_array());
        self.linear.set(lane, state.linear);
        self.angular.set(lane, state.angular);
        let moves = if state.is_held { 0.0 } else { 1.0 };
        self.moves.0[lane] = moves;
        self.inverse_kg.0[lane] = moves / part.mass_kg;
        self.inertia.set(lane, part.inertia_kg_m2);
        self.adds_linear.set(lane, chain.gravity * moves + state.force_n * (moves / part.mass_kg));
        self.adds_angular.set(lane, state.torque_nm);
    }

    pub fn store(&self, lane: usize, chain: &mut Chain, index: usize) {
        let state = &mut chain.state[index];
        state.at = self.at.get(lane);
        state.turn = self.turn.get(lane);
        state.linear = self.linear.get(lane);
        state.angular = self.angular.get(lane);
    }

    /// Prepares a step. It is called after all lanes were loaded.
    #[inline(always)]
    pub fn begin_step(&mut self, substep_s: Wide<N>) {
        self.began_at = self.at;
        self.axes = self.turn.axes();
        let inverse = WideVector {
            x: self.moves / self.inertia.x,
            y: self.moves / self.inertia.y,
            z: self.moves / self.inertia.z,
        };
        self.inverse_inertia = WideSymmetric::along(&self.axes, inverse);
        self.adds_linear = self.adds_linear * substep_s;
        self.adds_angular = self.inverse_inertia.of(self.adds_angular) * substep_s;
    }

    /// Adds the effect of forces, torques and the gyroscopic torque in a substep to the velocities.
    #[inline(always)]
    pub fn accelerate(&mut self, substep_s: Wide<N>) {
        self.linear += self.adds_linear;
        self.angular += self.adds_angular;
        // The explicit step of Euler's equations, rescaled to the length of the angular momentum before it, as in rapier.
        let rate = self.angular.into_frame(&self.axes);
        let momentum = self.inertia.times(rate);
        let turned = momentum - rate.cross(momentum) * substep_s;
        let (before, after) = (momentum.dot(momentum), turned.dot(turned));
        let scale = Wide::where_less(
            Wide::ZERO,
            after,
            (before / after.max(Wide::all(f32::MIN_POSITIVE))).sqrt(),
            Wide::ONE,
        );
        let rate = WideVector {
            x: turned.x * scale / self.inertia.x,
            y: turned.y * scale / self.inertia.y,
            z: turned.z * scale / self.inertia.z,
        };
        self.angular = rate.out_of_frame(&self.axes);
    }

    /// Moves the part by its velocities for the length of a substep.
    #[inline(always)]
    pub fn advance(&mut self, substep_s: Wide<N>, most_rad_s: f32) {
        self.linear = within(self.linear, MOST_M_S);
        self.angular = within(self.angular, most_rad_s);
        self.at += self.linear * substep_s;
        self.turn = self.turn.turned(self.angular, substep_s);
        self.axes = self.turn.axes();
    }

    #[inline(always)]
    pub fn end_step(&mut self) {
        self.at = self.at.without_signed_zeros();
        self.turn = self.turn.without_signed_zeros();
        self.linear = self.linear.without_signed_zeros();
        self.angular = self.angular.without_signed_zeros();
    }
}

/// Shortens a vector to at most the length `most`.
#[inline(always)]
fn within<const N: usize>(vector: WideVector<N>, most: f32) -> WideVector<N> {
    let square = vector.dot(vector);
    let (most, most_square) = (Wide::all(most), Wide::all(most * most));
    if !square.any_greater(most_square) {
        return vector;
    }
    vector * Wide::where_less(most_square, square, most / square.sqrt(), Wide::ONE)
}
