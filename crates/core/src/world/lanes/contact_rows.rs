//! The constraint rows of the contacts: a row for each point prevents approach, and friction holds the contact as a whole.

use super::chain::{Chain, LanesCommon, MOST_CORRECTION_PER_S};
use super::contact::Touching;
use super::part::WidePart;
use super::shared_points::{MOST_POINTS, basis};
use super::wide::{Wide, WideVector};
use crate::world::Vector;

/// One point of a contact per lane.
#[derive(Debug, Clone, Copy)]
struct WidePoint<const N: usize> {
    /// Levers from the centres of the two touching bodies to the point, at the beginning of the step, in the world.
    levers: [WideVector<N>; 2],
    /// The levers at the beginning of the step, each in the frame of its own body.
    own: [WideVector<N>; 2],
    axes: [WideVector<N>; 2],
    by_inertia: [WideVector<N>; 2],
    /// Effective mass along the normal; 0 in lanes without this point.
    mass: Wide<N>,
    distance_m: Wide<N>,
    /// Distance from the middle of the contact, in metres.
    from_middle_m: Wide<N>,
    /// Speed that is added to the speed of approach: the speed at which the gap closes within a substep, or at which a penetration is
    /// corrected.
    bias: Wide<N>,
    softening: Wide<N>,
    impulse: Wide<N>,
    total: Wide<N>,
}

/// One contact in each lane: in all lanes between the same part and the world, or between the same two parts.
#[derive(Debug, Clone)]
pub(super) struct WideContact<const N: usize> {
    /// Index of the contact in the list of its snake; `None` in lanes without this contact.
    contacts: [Option<usize>; N],
    part: usize,
    other: Option<usize>,
    normal: WideVector<N>,
    tangents: [WideVector<N>; 2],
    friction: Wide<N>,
    correction_per_s: Wide<N>,
    softening: Wide<N>,
    points: [WidePoint<N>; MOST_POINTS],
    /// Number of points in the lane that has most.
    count: usize,
    /// Levers of the middle of the points in the world. `own` has these levers in the frames of the two bodies.
    levers: [WideVector<N>; 2],
    own: [WideVector<N>; 2],
    /// Axes of both tangents for the part and for the other body. `tangents_by_inertia` has their products with the inverse inertias.
    tangent_axes: [[WideVector<N>; 2]; 2],
    tangents_by_inertia: [[WideVector<N>; 2]; 2],
    /// Inverse of the 2 by 2 matrix of inverse masses along the tangents: the elements xx, xy and yy.
    tangent_masses: [Wide<N>; 3],
    tangent_bias: [Wide<N>; 2],
    tangent_impulse: [Wide<N>; 2],
    twist_by_inertia: [WideVector<N>; 2],
    twist_mass: Wide<N>,
    twist_impulse: Wide<N>,
}

impl<const N: usize> WidePoint<N> {
    const EMPTY: Self = Self {
        levers: [WideVector::ZERO; 2],
        own: [WideVector::ZERO; 2],
        axes: [WideVector::ZERO; 2],
        by_inertia: [WideVector::ZERO; 2],
        mass: Wide::ZERO,
        distance_m: Wide::ZERO,
        from_middle_m: Wide::ZERO,
        bias: Wide::ZERO,
        softening: Wide::ZERO,
        impulse: Wide::ZERO,
        total: Wide::ZERO,
    };
}

/// Returns how far a point of a part has moved since the beginning of the step.
#[inline(always)]
fn moved<const N: usize>(
    part: &WidePart<N>,
    own: WideVector<N>,
    lever: WideVector<N>,
) -> WideVector<N> {
    (part.at - part.began_at) + (own.out_of_frame(&part.axes) - lever)
}

impl<const N: usize> WideContact<N> {
    pub const EMPTY: Self = Self {
        contacts: [None; N],
        part: 0,
        other: None,
        normal: WideVector::ZERO,
        tangents: [WideVector::ZERO; 2],
        friction: Wide::ZERO,
        correction_per_s: Wide::ZERO,
        softening: Wide::ZERO,
        points: [WidePoint::EMPTY; MOST_POINTS],
        count: 0,
        levers: [WideVector::ZERO; 2],
        own: [WideVector::ZERO; 2],
        tangent_axes: [[WideVector::ZERO; 2]; 2],
        tangents_by_inertia: [[WideVector::ZERO; 2]; 2],
        tangent_masses: [Wide::ZERO; 3],
        tangent_bias: [Wide::ZERO; 2],
        tangent_impulse: [Wide::ZERO; 2],
        twist_by_inertia: [WideVector::ZERO; 2],
        twist_mass: Wide::ZERO,
        twist_impulse: Wide::ZERO,
    };

    /// Begins a contact that no lane has loaded yet. It clears all values that `load` sets, so that a lane without the contact keeps no
    /// numbers of an earlier snake; all other values are computed from these.
    pub fn begin(&mut self, part: usize, other: Option<usize>) {
        (self.part, self.other, self.count, self.contacts) = (part, other, 0, [None; N]);
        self.normal = WideVector::ZERO;
        self.tangents = [WideVector::ZERO; 2];
        self.levers = [WideVector::ZERO; 2];
        for value in [&mut self.friction, &mut self.correction_per_s, &mut self.softening] {
            *value = Wide::ZERO;
        }
        (self.tangent_impulse, self.tangent_bias) = ([Wide::ZERO; 2], [Wide::ZERO; 2]);
        self.twist_impulse = Wide::ZERO;
        for point in &mut self.points {
            point.levers = [WideVector::ZERO; 2];
            (point.mass, point.distance_m) = (Wide::ZERO, Wide::ZERO);
            (point.from_middle_m, point.impulse) = (Wide::ZERO, Wide::ZERO);
        }
    }

    /// Loads contact number `index` of a snake into a lane.
    pub fn load(&mut self, lane: usize, chain: &Chain, index: usize) {
        let contact = &chain.contacts[index];
        self.contacts[lane] = Some(index);
        self.normal.set(lane, contact.normal);
        let tangents = basis(contact.normal);
        for (wide, tangent) in self.tangents.iter_mut().zip(tangents) {
            wide.set(lane, tangent);
        }
        self.friction.0[lane] = contact.friction;
        self.correction_per_s.0[lane] = contact.correction_per_s;
        self.softening.0[lane] = contact.softening;
        let points = contact.points();
        self.count = self.count.max(points.len());
        let part_at = chain.state[contact.part].at;
        let other_at = match contact.other {
            Touching::Part(front) => chain.state[front].at,
            Touching::Ground | Touching::Solid(_) => Vector::ZERO,
        };
        let middle = points.iter().map(|point| point.at).sum::<Vector>() / points.len() as f32;
        self.levers[0].set(lane, middle - part_at);
        self.levers[1].set(lane, middle - other_at);
        for (wide, point) in self.points.iter_mut().zip(points) {
            wide.levers[0].set(lane, point.at - part_at);
            wide.levers[1].set(lane, point.at - other_at);
            wide.mass.0[lane] = 1.0;
            wide.distance_m.0[lane] = point.distance_m;
            let from_middle = middle - point.at;
            wide.from_middle_m.0[lane] = from_middle.dot(from_middle).sqrt();
            wide.impulse.0[lane] = point.impulse_ns;
        }
        for (impulse, tangent) in self.tangent_impulse.iter_mut().zip(tangents) {
            impulse.0[lane] = contact.friction_ns.dot(tangent);
        }
        // A single point has no lever with which it could resist a twist.
        self.twist_impulse.0[lane] = if points.len() > 1 { contact.twist_nms } else { 0.0 };
    }

    /// Writes the impulses of a lane back to its contact.
    pub fn store(&self, lane: usize, chain: &mut Chain) {
        let Some(contact) = self.contacts[lane].and_then(|index| chain.contacts.get_mut(index))
        else {
            return;
        };
        let [x, y] = [0, 1].map(|axis| {
            self.tangents[axis].get(lane)
                * self.tangent_impulse[axis].without_signed_zeros().0[lane]
        });
        contact.friction_ns = x + y;
        contact.twist_nms = self.twist_impulse.without_signed_zeros().0[lane];
        for (point, wide) in contact.points_mut().iter_mut().zip(&self.points) {
            point.impulse_ns = wide.impulse.without_signed_zeros().0[lane];
            point.total_ns = (wide.total + wide.impulse).without_signed_zeros().0[lane];
        }
    }

    /// Returns the part, and the other part if the contact is between two parts.
    #[inline(always)]
    fn ends<'a>(&self, parts: &'a [WidePart<N>]) -> (&'a WidePart<N>, Option<&'a WidePart<N>>) {
        (&parts[self.part], self.other.map(|other| &parts[other]))
    }

    /// Builds the rows for a step.
    #[inline(always)]
    pub fn build(&mut self, parts: &[WidePart<N>]) {
        let (part, other) = self.ends(parts);
        let normal = self.normal;
        let inverse_kg = part.inverse_kg + other.map_or(Wide::ZERO, |other| other.inverse_kg);
        for point in &mut self.points[..self.count] {
            let axis = point.levers[0].cross(normal);
            point.axes[0] = axis;
            point.by_inertia[0] = part.inverse_inertia.of(axis);
            point.own[0] = point.levers[0].into_frame(&part.axes);
            let mut inverse_mass = inverse_kg + point.by_inertia[0].dot(axis);
            if let Some(other) = other {
                let axis = point.levers[1].cross(normal);
                point.axes[1] = axis;
                point.by_inertia[1] = other.inverse_inertia.of(axis);
                point.own[1] = point.levers[1].into_frame(&other.axes);
                inverse_mass += point.by_inertia[1].dot(axis);
            }
            point.mass = point.mass * inverse_mass.inverse();
            // The initial impulse comes from the step before and is not part of this step's total: the first substep adds it.
            point.total = -point.impulse;
        }
        self.own[0] = self.levers[0].into_frame(&part.axes);
        if let Some(other) = other {
            self.own[1] = self.levers[1].into_frame(&other.axes);
        }
        for axis in 0..2 {
            let of_part = self.levers[0].cross(self.tangents[axis]);
            self.tangent_axes[axis][0] = of_part;
            self.tangents_by_inertia[axis][0] = part.inverse_inertia.of(of_part);
            if let Some(other) = other {
                let of_other = self.levers[1].cross(self.tangents[axis]);
                self.tangent_axes[axis][1] = of_other;
                self.tangents_by_inertia[axis][1] = other.inverse_inertia.of(of_other);
            }
        }
        let product = |a: usize, b: usize| {
            let of_part = self.tangents_by_inertia[a][0].dot(self.tangent_axes[b][0]);
            match other {
                Some(_) => of_part + self.tangents_by_inertia[a][1].dot(self.tangent_axes[b][1]),
                None => of_part,
            }
        };
        let (xx, xy, yy) = (inverse_kg + product(0, 0), product(0, 1), inverse_kg + product(1, 1));
        let of_determinant = (xx * yy - xy * xy).inverse();
        self.tangent_masses = [yy * of_determinant, -(xy * of_determinant), xx * of_determinant];

        self.twist_by_inertia[0] = part.inverse_inertia.of(normal);
        let mut twist = self.twist_by_inertia[0].dot(normal);
        if let Some(other) = other {
            self.twist_by_inertia[1] = other.inverse_inertia.of(normal);
            twist += self.twist_by_inertia[1].dot(normal);
        }
        self.twist_mass = twist.inverse();
    }

    /// Returns the present distance of a point along the normal.
    #[inline(always)]
    fn distance_m(&self, parts: &[WidePart<N>], point: &WidePoint<N>) -> Wide<N> {
        let (part, other) = self.ends(parts);
        let by = moved(part, point.own[0], point.levers[0]).dot(self.normal);
        let by = match other {
            Some(other) => by - moved(other, point.own[1], point.levers[1]).dot(self.normal),
            None => by,
        };
        point.distance_m + by
    }

    /// Prepares a substep, which begins with the impulses of the substep before.
    #[inline(always)]
    pub fn begin_substep(
        &mut self,
        parts: &mut [WidePart<N>],
        common: &LanesCommon,
        per_substep: Wide<N>,
    ) {
        let most = Wide::all(MOST_CORRECTION_PER_S);
        for index in 0..self.count {
            let distance_m = self.distance_m(parts, &self.points[index]);
            let point = &mut self.points[index];
            let correction = (distance_m * self.correction_per_s).min(Wide::ZERO);
            let correction = if common.has_springs { correction } else { correction.max(-most) };
            point.bias = distance_m.max(Wide::ZERO) * per_substep + correction;
            // A point that is still apart is stopped rigidly when it arrives, without softening.
            point.softening = Wide::where_less(Wide::ZERO, distance_m, Wide::ONE, self.softening);
            point.total += point.impulse;
            let impulse = point.impulse;
            self.push(parts, index, impulse);
        }
        if common.has_springs {
            let (part, other) = self.ends(parts);
            let by = moved(part, self.own[0], self.levers[0]);
            let by = match other {
                Some(other) => by - moved(other, self.own[1], self.levers[1]),
                None => by,
            };
            self.tangent_bias = self.tangents.map(|tangent| by.dot(tangent) * per_substep);
        }
        let (twist, along) = (self.twist_impulse, self.tangent_impulse);
        self.push_along(parts, along);
        self.twist(parts, twist);
    }

    /// Recomputes the gaps at the present poses, for the last pass, which corrects no positions.
    #[inline(always)]
    pub fn end_substep(&mut self, parts: &[WidePart<N>], per_substep: Wide<N>) {
        for index in 0..self.count {
            let distance_m = self.distance_m(parts, &self.points[index]);
            let point = &mut self.points[index];
            point.bias = distance_m.max(Wide::ZERO) * per_substep;
            point.softening = Wide::ONE;
        }
    }

    #[inline(always)]
    fn push(&self, parts: &mut [WidePart<N>], index: usize, change: Wide<N>) {
        let point = &self.points[index];
        let part = &mut parts[self.part];
        part.linear += self.normal * (change * part.inverse_kg);
        part.angular += point.by_inertia[0] * change;
        if let Some(other) = self.other {
            let other = &mut parts[other];
            other.linear -= self.normal * (change * other.inverse_kg);
            other.angular -= point.by_inertia[1] * change;
        }
    }

    #[inline(always)]
    fn push_along(&self, parts: &mut [WidePart<N>], change: [Wide<N>; 2]) {
        let along = self.tangents[0] * change[0] + self.tangents[1] * change[1];
        let turning = |end: usize| {
            self.tangents_by_inertia[0][end] * change[0]
                + self.tangents_by_inertia[1][end] * change[1]
        };
        let part = &mut parts[self.part];
        part.linear += along * part.inverse_kg;
        part.angular += turning(0);
        if let Some(other) = self.other {
            let other = &mut parts[other];
            other.linear -= along * other.inverse_kg;
            other.angular -= turning(1);
        }
    }

    #[inline(always)]
    fn twist(&self, parts: &mut [WidePart<N>], change: Wide<N>) {
        parts[self.part].angular += self.twist_by_inertia[0] * change;
        if let Some(other) = self.other {
            parts[other].angular -= self.twist_by_inertia[1] * change;
        }
    }

    /// Makes one pass over the rows of the points along the normal.
    #[inline(always)]
    pub fn solve_normal(&mut self, parts: &mut [WidePart<N>]) {
        for index in 0..self.count {
            let point = &mut self.points[index];
            let part = &parts[self.part];
            let mut speed = self.normal.dot(part.linear) + point.axes[0].dot(part.angular);
            if let Some(other) = self.other {
                let other = &parts[other];
                speed = speed - self.normal.dot(other.linear) - point.axes[1].dot(other.angular);
            }
            let wanted = point.impulse - point.mass * (speed + point.bias);
            let impulse = point.softening * wanted.max(Wide::ZERO);
            let change = impulse - point.impulse;
            point.impulse = impulse;
            self.push(parts, index, change);
        }
    }

    /// Makes one pass over the friction: first against a twist on the spot, then along the surface.
    #[inline(always)]
    pub fn solve_friction(&mut self, parts: &mut [WidePart<N>]) {
        let (mut most, mut most_twist) = (Wide::ZERO, Wide::ZERO);
        for point in &self.points[..self.count] {
            most += point.impulse;
            most_twist += point.impulse * point.from_middle_m;
        }
        let (most, most_twist) = (most * self.friction, most_twist * self.friction);
        if self.count > 1 {
            let mut spin = parts[self.part].angular;
            if let Some(other) = self.other {
                spin -= parts[other].angular;
            }
            let wanted = self.twist_impulse - self.twist_mass * self.normal.dot(spin);
            let impulse = wanted.max(-most_twist).min(most_twist);
            let change = impulse - self.twist_impulse;
            self.twist_impulse = impulse;
            self.twist(parts, change);
        }
        let part = &parts[self.part];
        let mut speeds = [0, 1].map(|axis| {
            self.tangents[axis].dot(part.linear) + self.tangent_axes[axis][0].dot(part.angular)
        });
        if let Some(other) = self.other {
            let other = &parts[other];
            for (axis, speed) in speeds.iter_mut().enumerate() {
                *speed = *speed
                    - self.tangents[axis].dot(other.linear)
                    - self.tangent_axes[axis][1].dot(other.angular);
            }
        }
        let [u, v] = [speeds[0] + self.tangent_bias[0], speeds[1] + self.tangent_bias[1]];
        let [xx, xy, yy] = self.tangent_masses;
        let wanted = [
            self.tangent_impulse[0] - (xx * u + xy * v),
            self.tangent_impulse[1] - (xy * u + yy * v),
        ];
        // The friction is limited to the friction cone.
        let square = wanted[0] * wanted[0] + wanted[1] * wanted[1];
        let scale = Wide::where_less(most * most, square, most / square.sqrt(), Wide::ONE);
        let impulse = wanted.map(|along| along * scale);
        let change = [impulse[0] - self.tangent_impulse[0], impulse[1] - self.tangent_impulse[1]];
        self.tangent_impulse = impulse;
        self.push_along(parts, change);
    }
}
