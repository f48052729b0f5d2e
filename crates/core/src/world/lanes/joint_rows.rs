//! The constraint rows of the universal joints. Each row has a relative velocity of two parts that it does not allow, and the impulse that
//! prevents this velocity.

use super::chain::{Chain, LanesCommon, MOST_CORRECTION_PER_S};
use super::part::{WidePart, both};
use super::wide::{Wide, WideVector};

/// A row that only concerns rotations. Its axis is the same for both parts.
#[derive(Debug, Clone, Copy)]
struct TurnRow<const N: usize> {
    axis: WideVector<N>,
    /// Products of both parts' inverse inertias with the axis.
    by_inertia: [WideVector<N>; 2],
    inverse: Wide<N>,
    /// Velocity that corrects an error of position.
    bias: Wide<N>,
    compliance: Wide<N>,
    impulse: Wide<N>,
}

/// A row that concerns linear and angular velocities.
#[derive(Debug, Clone, Copy)]
struct JointRow<const N: usize> {
    direction: WideVector<N>,
    axes: [WideVector<N>; 2],
    by_inertia: [WideVector<N>; 2],
    inverse: Wide<N>,
    bias: Wide<N>,
    compliance: Wide<N>,
    impulse: Wide<N>,
    /// Least and greatest impulse of the row.
    range: [Wide<N>; 2],
}

/// One universal joint per lane.
#[derive(Debug, Clone, Copy)]
pub(super) struct WideJoint<const N: usize> {
    /// Indices of the two connected parts, the front one first.
    pub parts: [usize; 2],
    /// Distances along y from the parts' centres to the joint's anchors, in metres: backwards from the front part, forwards from the rear
    /// part.
    anchors_m: [Wide<N>; 2],
    /// Compliance of the damping, `1 / (damping · substep)`.
    damping: Wide<N>,
    /// 1 in lanes whose joint has damping, 0 in the others.
    is_damped: Wide<N>,
    half_limits: [[Wide<N>; 2]; 2],
    correction_per_s: Wide<N>,
    compliance: Wide<N>,
    motors: [TurnRow<N>; 2],
    lock: TurnRow<N>,
    anchors: [JointRow<N>; 3],
    limits: [JointRow<N>; 2],
    /// Whether the bend and the twist are beyond a limit in any lane.
    is_limited: [bool; 2],
}

impl<const N: usize> TurnRow<N> {
    const EMPTY: Self = Self {
        axis: WideVector::ZERO,
        by_inertia: [WideVector::ZERO; 2],
        inverse: Wide::ZERO,
        bias: Wide::ZERO,
        compliance: Wide::ZERO,
        impulse: Wide::ZERO,
    };

    /// Builds a row about an axis, and returns it with its inverse mass.
    #[inline(always)]
    fn about(axis: WideVector<N>, [front, rear]: [&WidePart<N>; 2]) -> (Self, Wide<N>) {
        let by_inertia = [front.inverse_inertia.of(axis), rear.inverse_inertia.of(axis)];
        let inverse_mass = by_inertia[0].dot(axis) + by_inertia[1].dot(axis);
        (Self { axis, by_inertia, ..Self::EMPTY }, inverse_mass)
    }

    #[inline(always)]
    fn solve(&mut self, front: &mut WidePart<N>, rear: &mut WidePart<N>, bias: Wide<N>) {
        let speed = self.axis.dot(rear.angular - front.angular) + bias;
        let change = self.inverse * (speed - self.compliance * self.impulse);
        self.impulse += change;
        front.angular += self.by_inertia[0] * change;
        rear.angular -= self.by_inertia[1] * change;
    }
}

impl<const N: usize> JointRow<N> {
    const EMPTY: Self = Self {
        direction: WideVector::ZERO,
        axes: [WideVector::ZERO; 2],
        by_inertia: [WideVector::ZERO; 2],
        inverse: Wide::ZERO,
        bias: Wide::ZERO,
        compliance: Wide::ZERO,
        impulse: Wide::ZERO,
        range: [Wide::ZERO; 2],
    };

    /// Returns the product of two rows, weighted by the inverse masses of both parts. The product of a row with itself is its inverse
    /// mass.
    #[inline(always)]
    fn product(&self, other: &Self, inverse_kg: Wide<N>) -> Wide<N> {
        self.direction.dot(other.direction) * inverse_kg
            + self.by_inertia[0].dot(other.axes[0])
            + self.by_inertia[1].dot(other.axes[1])
    }

    /// Makes this row independent of `other` by subtracting the share that `other` already prevents.
    #[inline(always)]
    fn take_out(&mut self, other: &Self, inverse_of_other: Wide<N>, inverse_kg: Wide<N>) {
        let share = self.product(other, inverse_kg) * inverse_of_other;
        self.direction -= other.direction * share;
        for end in 0..2 {
            self.axes[end] -= other.axes[end] * share;
            self.by_inertia[end] -= other.by_inertia[end] * share;
        }
        self.bias -= other.bias * share;
    }

    #[inline(always)]
    fn take_out_turn(&mut self, other: &TurnRow<N>, inverse_of_other: Wide<N>) {
        let share = (self.by_inertia[0].dot(other.axis) + self.by_inertia[1].dot(other.axis))
            * inverse_of_other;
        for end in 0..2 {
            self.axes[end] -= other.axis * share;
            self.by_inertia[end] -= other.by_inertia[end] * share;
        }
        self.bias -= other.bias * share;
    }

    #[inline(always)]
    fn change(&self, front: &WidePart<N>, rear: &WidePart<N>, bias: Wide<N>) -> Wide<N> {
        let speed = self.direction.dot(rear.linear - front.linear)
            + (self.axes[1].dot(rear.angular) - self.axes[0].dot(front.angular))
            + bias;
        self.inverse * (speed - self.compliance * self.impulse)
    }

    #[inline(always)]
    fn push(&self, front: &mut WidePart<N>, rear: &mut WidePart<N>, change: Wide<N>) {
        let along = self.direction * change;
        front.linear += along * front.inverse_kg;
        front.angular += self.by_inertia[0] * change;
        rear.linear -= along * rear.inverse_kg;
        rear.angular -= self.by_inertia[1] * change;
    }

    #[inline(always)]
    fn solve(&mut self, front: &mut WidePart<N>, rear: &mut WidePart<N>, bias: Wide<N>) {
        let change = self.change(front, rear, bias);
        self.impulse += change;
        self.push(front, rear, change);
    }

    #[inline(always)]
    fn solve_in_range(&mut self, front: &mut WidePart<N>, rear: &mut WidePart<N>, bias: Wide<N>) {
        let wanted = self.impulse + self.change(front, rear, bias);
        let impulse = wanted.max(self.range[0]).min(self.range[1]);
        let change = impulse - self.impulse;
        self.impulse = impulse;
        self.push(front, rear, change);
    }
}

/// Returns how far a joint is beyond a limit about one axis, in radians, from the imaginary part x of its rotation about the axis and the
/// real part w; 0 within the limits, and negative beyond the lower limit. `None` if no lane is beyond a limit. The angle is
/// `2 atan(x / w)`. The addition theorem subtracts half the limit from half the angle, and the sign of the result tells whether the limit
/// is exceeded, without trigonometric functions.
#[inline(always)]
fn beyond<const N: usize>(x: Wide<N>, w: Wide<N>, [sin, cos]: [Wide<N>; 2]) -> Option<Wide<N>> {
    let (over, under) = (x * cos - w * sin, -(x * cos + w * sin));
    if !over.max(under).any_greater(Wide::ZERO) {
        return None;
    }
    let two = Wide::all(2.0);
    let above = arc(over, w * cos + x * sin) * two;
    let below = arc(under, w * cos - x * sin) * two;
    Some(above - below)
}

/// Returns the angle whose sine and cosine have this ratio if the sine is positive, else 0. With a positive sine, the cosine is not
/// negative, because neither a half angle nor half a limit is more than a quarter of a turn.
#[inline(always)]
fn arc<const N: usize>(sin: Wide<N>, cos: Wide<N>) -> Wide<N> {
    let sin = sin.max(Wide::ZERO);
    let smaller = Wide::where_less(sin, cos, sin, cos);
    let greater = Wide::where_less(sin, cos, cos, sin);
    let ratio = smaller / greater.max(Wide::all(1.0e-12));
    let square = ratio * ratio;
    // Abramowitz and Stegun, Handbook of Mathematical Functions, 4.4.49: within 2e-8 of the arc tangent for arguments up to 1.
    let mut sum = Wide::all(0.002_866_225_7);
    for coefficient in [
        -0.016_165_737,
        0.042_909_614,
        -0.075_289_64,
        0.106_562_64,
        -0.142_089,
        0.199_935_51,
        -0.333_331_45,
        1.0,
    ] {
        sum = sum * square + Wide::all(coefficient);
    }
    let angle = ratio * sum;
    let angle = Wide::where_less(sin, cos, angle, Wide::all(std::f32::consts::FRAC_PI_2) - angle);
    Wide::where_less(Wide::ZERO, sin, angle, Wide::ZERO)
}

impl<const N: usize> WideJoint<N> {
    pub const EMPTY: Self = Self {
        parts: [0; 2],
        anchors_m: [Wide::ZERO; 2],
        damping: Wide::ZERO,
        is_damped: Wide::ZERO,
        half_limits: [[Wide::ZERO; 2]; 2],
        correction_per_s: Wide::ZERO,
        compliance: Wide::ZERO,
        motors: [TurnRow::EMPTY; 2],
        lock: TurnRow::EMPTY,
        anchors: [JointRow::EMPTY; 3],
        limits: [JointRow::EMPTY; 2],
        is_limited: [false; 2],
    };

    /// Loads joint number `index` of a snake into a lane.
    pub fn load(&mut self, lane: usize, chain: &Chain, index: usize) {
        let joint = &chain.joints[index];
        let substep_s = chain.common.step_s / chain.common.substeps as f32;
        // The snakes of all lanes have the same number of parts, so this joint connects the same two parts in every lane.
        self.parts = joint.parts;
        self.anchors_m[0].0[lane] = -chain.parts[joint.parts[0]].half_m.y;
        self.anchors_m[1].0[lane] = chain.parts[joint.parts[1]].half_m.y;
        let is_damped = joint.damping_nms > 0.0;
        self.damping.0[lane] = if is_damped { 1.0 / (substep_s * joint.damping_nms) } else { 0.0 };
        self.is_damped.0[lane] = if is_damped { 1.0 } else { 0.0 };
        for (axis, limits) in joint.half_limits.iter().enumerate() {
            // Without a limit, the limit is set to the greatest rotation, half a turn, as sine 1 and cosine 0. It is never exceeded.
            let [sin, cos] = limits.unwrap_or([1.0, 0.0]);
            self.half_limits[axis][0].0[lane] = sin;
            self.half_limits[axis][1].0[lane] = cos;
        }
        self.correction_per_s.0[lane] = joint.correction_per_s;
        self.compliance.0[lane] = joint.compliance;
    }

    /// Builds the rows for the present poses. All impulses begin at zero, not at those of the substep before.
    #[inline(always)]
    pub fn build(&mut self, parts: &[WidePart<N>], common: &LanesCommon) {
        let ends = self.parts.map(|part| &parts[part]);
        let [front, rear] = ends;
        let levers = [front.axes[1] * self.anchors_m[0], rear.axes[1] * self.anchors_m[1]];
        let gap = (rear.at + levers[1]) - (front.at + levers[0]);
        for axis in 0..2 {
            let (row, inverse_mass) = TurnRow::about(front.axes[axis], ends);
            let inverse = self.is_damped / (inverse_mass + self.damping);
            self.motors[axis] = TurnRow { inverse, compliance: self.damping, ..row };
        }

        // The rotation of the rear part as seen from the front part, with a positive real part.
        let (a, b) = (&front.turn, &rear.turn);
        let w = a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z;
        let side = Wide::where_less(w, Wide::ZERO, -Wide::ONE, Wide::ONE);
        let x = (a.w * b.x - a.x * b.w - a.y * b.z + a.z * b.y) * side;
        let y = (a.w * b.y + a.x * b.z - a.y * b.w - a.z * b.x) * side;
        let z = (a.w * b.z - a.x * b.y + a.y * b.x - a.z * b.w) * side;
        let w = w * side;

        // The lock keeps the z part of the rotation at zero. Its axis is the derivative of z by the relative angular velocity.
        let half = Wide::all(0.5) * side;
        let axis = WideVector {
            x: (a.w * b.y + a.z * b.x + a.x * b.z + a.y * b.w) * half,
            y: (a.z * b.y + a.y * b.z - a.w * b.x - a.x * b.w) * half,
            z: (a.w * b.w + a.z * b.z - a.x * b.x - a.y * b.y) * half,
        };
        let (mut lock, lock_mass) = TurnRow::about(axis, ends);
        let lock_inverse = lock_mass.inverse();
        lock.compliance = lock_mass * self.compliance;
        lock.inverse = (lock_mass + lock.compliance).inverse();
        lock.bias = z * self.correction_per_s;
        self.lock = lock;

        let inverse_kg = front.inverse_kg + rear.inverse_kg;
        for axis in 0..3 {
            let direction = front.axes[axis];
            let axes = [levers[0].cross(direction), levers[1].cross(direction)];
            let by_inertia = [front.inverse_inertia.of(axes[0]), rear.inverse_inertia.of(axes[1])];
            let bias = direction.dot(gap) * self.correction_per_s;
            let row = &mut self.anchors[axis];
            *row = JointRow { direction, axes, by_inertia, bias, ..JointRow::EMPTY };
            row.take_out_turn(&self.lock, lock_inverse);
        }
        // Modified Gram-Schmidt makes each row independent of those before it, so that one pass solves them all.
        let mut inverses = [Wide::ZERO; 3];
        for axis in 0..3 {
            let (done, rest) = self.anchors.split_at_mut(axis + 1);
            let row = &mut done[axis];
            let mass = row.product(row, inverse_kg);
            row.compliance = mass * self.compliance;
            row.inverse = (mass + row.compliance).inverse();
            inverses[axis] = mass.inverse();
            for later in rest {
                later.take_out(row, inverses[axis], inverse_kg);
            }
        }

        for (axis, part) in [x, y].into_iter().enumerate() {
            let beyond = beyond(part, w, self.half_limits[axis]);
            self.is_limited[axis] = beyond.is_some();
            let Some(beyond) = beyond else { continue };
            let is_above = Wide::where_less(Wide::ZERO, beyond, Wide::ONE, Wide::ZERO);
            let is_below = Wide::where_less(beyond, Wide::ZERO, Wide::ONE, Wide::ZERO);
            let bias = beyond * self.correction_per_s;
            let most = Wide::all(MOST_CORRECTION_PER_S);
            let bias = if common.has_springs { bias } else { bias.max(-most).min(most) };
            let direction = front.axes[axis];
            let by_inertia =
                [front.inverse_inertia.of(direction), rear.inverse_inertia.of(direction)];
            let row = &mut self.limits[axis];
            *row = JointRow { axes: [direction; 2], by_inertia, bias, ..JointRow::EMPTY };
            row.take_out_turn(&self.lock, lock_inverse);
            for (anchor, inverse) in self.anchors.iter().zip(inverses) {
                row.take_out(anchor, inverse, inverse_kg);
            }
            let mass = row.product(row, inverse_kg);
            row.compliance = mass * self.compliance;
            row.inverse = (mass + row.compliance).inverse();
            row.range = [is_below * Wide::all(-f32::MAX), is_above * Wide::all(f32::MAX)];
        }
    }

    /// Makes one pass over the rows, with or without the correction of positions.
    #[inline(always)]
    pub fn solve(&mut self, parts: &mut [WidePart<N>], is_biased: bool) {
        let [front, rear] = self.parts;
        let Some((front, rear)) = both(parts, front, rear) else { return };
        let bias = |of: Wide<N>| if is_biased { of } else { Wide::ZERO };
        for motor in &mut self.motors {
            motor.solve(front, rear, Wide::ZERO);
        }
        let of_lock = bias(self.lock.bias);
        self.lock.solve(front, rear, of_lock);
        for row in &mut self.anchors {
            let of_row = bias(row.bias);
            row.solve(front, rear, of_row);
        }
        for (row, is_limited) in self.limits.iter_mut().zip(self.is_limited) {
            if is_limited {
                let of_row = bias(row.bias);
                row.solve_in_range(front, rear, of_row);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_way_beyond_a_limit_is_the_angle_minus_the_limit() {
        for limit_rad in [0.0_f32, 0.3, 1.0, 2.9, 3.1] {
            let (sin, cos) = libm::sincosf(limit_rad / 2.0);
            for number in -62..=62_i16 {
                let angle_rad = f32::from(number) * 0.05;
                let (x, w) = libm::sincosf(angle_rad / 2.0);
                let found = beyond(Wide([x]), Wide([w]), [Wide([sin]), Wide([cos])]);
                let expected = if angle_rad.abs() > limit_rad {
                    angle_rad - limit_rad.copysign(angle_rad)
                } else {
                    0.0
                };
                let found = found.map_or(0.0, |found| found.0[0]);
                assert!((found - expected).abs() < 1.0e-5, "{angle_rad} {limit_rad}: {found}");
            }
        }
    }

    #[test]
    fn a_joint_without_a_limit_is_never_beyond_it() {
        for number in -62..=62_i16 {
            let (x, w) = libm::sincosf(f32::from(number) * 0.025);
            assert!(beyond(Wide([x]), Wide([w]), [Wide([1.0]), Wide([0.0])]).is_none());
        }
    }
}
