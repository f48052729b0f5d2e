//! The constraint rows of the universal joints and of the springs in soft limbs. Each row has a relative velocity of two parts that it does
//! not allow, and the impulse that prevents this velocity.

use super::angle::{beyond, of_sine};
use super::chain::{Chain, LanesCommon, MOST_CORRECTION_PER_S};
use super::joint::Hold;
use super::part::{WidePart, both};
use super::wide::{Wide, WideRotation, WideVector};

/// A row that only concerns rotations. Its axis is the same for both parts.
#[derive(Debug, Clone, Copy, Default)]
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
#[derive(Debug, Clone, Copy, Default)]
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

/// One universal joint per lane, or one spring in each lane. A spring has the same rows, but the two of the motors and the lock yield: each
/// is elastic about one axis.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct WideJoint<const N: usize> {
    /// Indices of the two connected parts, the front one first.
    pub parts: [usize; 2],
    /// Whether this is a spring, in all lanes.
    is_spring: bool,
    /// Place and rotation of the joint on the front part, if they are its own in all lanes.
    mount: Option<(WideVector<N>, WideRotation<N>)>,
    /// Share of the angle that a spring takes back per second, and its compliance, about each axis.
    elastic: [[Wide<N>; 2]; 3],
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
    /// Builds a row about an axis, and returns it with its inverse mass.
    #[inline(always)]
    fn about(axis: WideVector<N>, [front, rear]: [&WidePart<N>; 2]) -> (Self, Wide<N>) {
        let by_inertia = [front.inverse_inertia.of(axis), rear.inverse_inertia.of(axis)];
        let inverse_mass = by_inertia[0].dot(axis) + by_inertia[1].dot(axis);
        (Self { axis, by_inertia, ..Self::default() }, inverse_mass)
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

impl<const N: usize> WideJoint<N> {
    /// Loads joint or spring number `index` of a snake into a lane.
    pub fn load(&mut self, lane: usize, chain: &Chain, index: usize) {
        let joint = &chain.joints[index];
        let substep_s = chain.common.step_s / chain.common.substeps as f32;
        // The snakes of all lanes have joints of the same shapes, so this joint connects the same two parts in the same way in every lane.
        self.parts = joint.parts;
        (self.is_spring, self.mount) = match joint.hold {
            Hold::Straight => (false, None),
            Hold::Mounted { at_m, turn } => {
                let (mut place_m, mut rotation) = self.mount.unwrap_or_default();
                place_m.set(lane, at_m);
                rotation.set(lane, turn);
                (false, Some((place_m, rotation)))
            }
            Hold::Spring(elastic) => {
                for (wide, values) in self.elastic.iter_mut().zip(elastic) {
                    wide[0].0[lane] = values[0];
                    wide[1].0[lane] = values[1];
                }
                (true, None)
            }
        };
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
        let (mounted_turn, mounted_axes);
        let (of_front, a, frame) = match &self.mount {
            Some((place_m, rotation)) => {
                mounted_turn = front.turn.product(*rotation);
                mounted_axes = mounted_turn.axes();
                (place_m.out_of_frame(&front.axes), &mounted_turn, &mounted_axes)
            }
            None => (front.axes[1] * self.anchors_m[0], &front.turn, &front.axes),
        };
        let levers = [of_front, rear.axes[1] * self.anchors_m[1]];
        let gap = (rear.at + levers[1]) - (front.at + levers[0]);
        for (motor, axis) in self.motors.iter_mut().zip(frame) {
            let (row, inverse_mass) = TurnRow::about(*axis, ends);
            let inverse = self.is_damped / (inverse_mass + self.damping);
            *motor = TurnRow { inverse, compliance: self.damping, ..row };
        }

        // The rotation of the rear part as seen from the joint's frame on the front part, with a positive real part.
        let b = &rear.turn;
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
        if self.is_spring {
            self.build_spring(frame, ends, [x, y, z]);
        }

        let inverse_kg = front.inverse_kg + rear.inverse_kg;
        for (row, direction) in self.anchors.iter_mut().zip(frame) {
            let direction = *direction;
            let axes = [levers[0].cross(direction), levers[1].cross(direction)];
            let by_inertia = [front.inverse_inertia.of(axes[0]), rear.inverse_inertia.of(axes[1])];
            let bias = direction.dot(gap) * self.correction_per_s;
            *row = JointRow { direction, axes, by_inertia, bias, ..JointRow::default() };
            if !self.is_spring {
                row.take_out_turn(&self.lock, lock_inverse);
            }
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
            let direction = frame[axis];
            let by_inertia =
                [front.inverse_inertia.of(direction), rear.inverse_inertia.of(direction)];
            let row = &mut self.limits[axis];
            *row = JointRow { axes: [direction; 2], by_inertia, bias, ..JointRow::default() };
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

    /// Replaces the rows of the motors and the lock by those of a spring, which are elastic about the axes of its frame. `sines` is the
    /// imaginary part of the spring's rotation.
    #[inline(always)]
    fn build_spring(
        &mut self,
        frame: &[WideVector<N>; 3],
        ends: [&WidePart<N>; 2],
        sines: [Wide<N>; 3],
    ) {
        let [x, y] = &mut self.motors;
        for (axis, of_axis) in [x, y, &mut self.lock].into_iter().enumerate() {
            let [correction_per_s, compliance] = self.elastic[axis];
            let (row, inverse_mass) = TurnRow::about(frame[axis], ends);
            let inverse = (inverse_mass + compliance).inverse();
            let bias = of_sine(sines[axis]) * correction_per_s;
            *of_axis = TurnRow { inverse, compliance, bias, ..row };
        }
    }

    /// Makes one pass over the rows, with or without the correction of positions. A spring acts in every pass.
    #[inline(always)]
    pub fn solve(&mut self, parts: &mut [WidePart<N>], is_biased: bool) {
        let [front, rear] = self.parts;
        let Some((front, rear)) = both(parts, front, rear) else { return };
        let bias = |of: Wide<N>| if is_biased { of } else { Wide::ZERO };
        for motor in &mut self.motors {
            let of_motor = motor.bias;
            motor.solve(front, rear, of_motor);
        }
        let of_lock = if self.is_spring { self.lock.bias } else { bias(self.lock.bias) };
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
