//! The constraint rows of the contacts: a row for each point prevents approach, and friction holds the contact as a whole.

use super::LANES;
use super::chain::{Chain, LanesCommon, MOST_CORRECTION_PER_S};
use super::part::WidePart;
use super::shared_points::{MOST_POINTS, basis};
use super::wide::{Wide, WideVector};
use crate::world::Vector;

/// One point of a contact per lane.
#[derive(Debug, Clone, Copy, Default)]
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
#[derive(Debug, Clone, Default)]
pub(super) struct WideContact<const N: usize> {
    /// Index of the contact in the list of its snake; `None` in lanes without this contact.
    contacts: [Option<usize>; LANES],
    /// Indices of the touching parts. The first `ends` of them count: two, or one for a contact with the world.
    bodies: [usize; 2],
    ends: usize,
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

/// Returns how far a point of a part has moved since the beginning of the step.
#[inline(always)]
fn moved<const N: usize>(
    part: &WidePart<N>,
    own: WideVector<N>,
    lever: WideVector<N>,
) -> WideVector<N> {
    (part.at - part.began_at) + (own.out_of_frame(&part.axes) - lever)
}

/// Returns a number as it counts for the part of a contact, end 0, or with the opposite sign for the other part, end 1.
#[inline(always)]
fn on_end<const N: usize>(end: usize, number: Wide<N>) -> Wide<N> {
    if end == 0 { number } else { -number }
}

impl<const N: usize> WideContact<N> {
    /// Begins a contact that no lane has loaded yet. It clears all values that `load` sets, so that a lane without the contact keeps no
    /// numbers of an earlier snake; all other values are computed from these. `load` itself clears each point that it loads first.
    pub fn begin(&mut self, part: usize, other: Option<usize>) {
        self.bodies = [part, other.unwrap_or(part)];
        self.ends = if other.is_some() { 2 } else { 1 };
        (self.count, self.contacts) = (0, [None; LANES]);
        self.normal = WideVector::ZERO;
        self.tangents = [WideVector::ZERO; 2];
        self.levers = [WideVector::ZERO; 2];
        for value in [&mut self.friction, &mut self.correction_per_s, &mut self.softening] {
            *value = Wide::ZERO;
        }
        (self.tangent_impulse, self.tangent_bias) = ([Wide::ZERO; 2], [Wide::ZERO; 2]);
        self.twist_impulse = Wide::ZERO;
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
        while self.count < points.len() {
            // No lane has loaded this point yet.
            let point = &mut self.points[self.count];
            point.levers = [WideVector::ZERO; 2];
            (point.mass, point.distance_m) = (Wide::ZERO, Wide::ZERO);
            (point.from_middle_m, point.impulse) = (Wide::ZERO, Wide::ZERO);
            self.count += 1;
        }
        let middle = points.iter().map(|point| point.at).sum::<Vector>() / points.len() as f32;
        for end in 0..self.ends {
            let centre = chain.state[self.bodies[end]].at;
            self.levers[end].set(lane, middle - centre);
            for (wide, point) in self.points.iter_mut().zip(points) {
                wide.levers[end].set(lane, point.at - centre);
            }
        }
        for (wide, point) in self.points.iter_mut().zip(points) {
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

    /// Builds the rows for a step.
    #[inline(always)]
    pub fn build(&mut self, parts: &[WidePart<N>]) {
        let (mut inverse_kg, mut twist) = (Wide::ZERO, Wide::ZERO);
        let [mut xx, mut xy, mut yy] = [Wide::ZERO; 3];
        for end in 0..self.ends {
            inverse_kg += parts[self.bodies[end]].inverse_kg;
        }
        for point in &mut self.points[..self.count] {
            let mut inverse_mass = inverse_kg;
            for end in 0..self.ends {
                let part = &parts[self.bodies[end]];
                point.axes[end] = point.levers[end].cross(self.normal);
                point.by_inertia[end] = part.inverse_inertia.of(point.axes[end]);
                point.own[end] = point.levers[end].into_frame(&part.axes);
                inverse_mass += point.by_inertia[end].dot(point.axes[end]);
            }
            point.mass = point.mass * inverse_mass.inverse();
            // The initial impulse comes from the step before and is not part of this step's total: the first substep adds it.
            point.total = -point.impulse;
        }
        for end in 0..self.ends {
            let part = &parts[self.bodies[end]];
            self.own[end] = self.levers[end].into_frame(&part.axes);
            for axis in 0..2 {
                let around = self.levers[end].cross(self.tangents[axis]);
                self.tangent_axes[axis][end] = around;
                self.tangents_by_inertia[axis][end] = part.inverse_inertia.of(around);
            }
            let [x, y] = self.tangents_by_inertia.map(|of| of[end]);
            let axes = self.tangent_axes.map(|of| of[end]);
            (xx, xy, yy) = (xx + x.dot(axes[0]), xy + x.dot(axes[1]), yy + y.dot(axes[1]));
            self.twist_by_inertia[end] = part.inverse_inertia.of(self.normal);
            twist += self.twist_by_inertia[end].dot(self.normal);
        }
        let (xx, yy) = (inverse_kg + xx, inverse_kg + yy);
        let of_determinant = (xx * yy - xy * xy).inverse();
        self.tangent_masses = [yy * of_determinant, -(xy * of_determinant), xx * of_determinant];
        self.twist_mass = twist.inverse();
    }

    /// Returns the present distance of a point along the normal.
    #[inline(always)]
    fn distance_m(&self, parts: &[WidePart<N>], point: &WidePoint<N>) -> Wide<N> {
        let mut by = Wide::ZERO;
        for end in 0..self.ends {
            let part = &parts[self.bodies[end]];
            let along = moved(part, point.own[end], point.levers[end]).dot(self.normal);
            by += on_end(end, along);
        }
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
            let mut by = WideVector::ZERO;
            for end in 0..self.ends {
                let way = moved(&parts[self.bodies[end]], self.own[end], self.levers[end]);
                by = if end == 0 { by + way } else { by - way };
            }
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
        for end in 0..self.ends {
            let (part, change) = (&mut parts[self.bodies[end]], on_end(end, change));
            part.linear += self.normal * (change * part.inverse_kg);
            part.angular += self.points[index].by_inertia[end] * change;
        }
    }

    #[inline(always)]
    fn push_along(&self, parts: &mut [WidePart<N>], change: [Wide<N>; 2]) {
        for end in 0..self.ends {
            let (part, [x, y]) = (&mut parts[self.bodies[end]], change.map(|of| on_end(end, of)));
            part.linear += (self.tangents[0] * x + self.tangents[1] * y) * part.inverse_kg;
            let [of_x, of_y] = self.tangents_by_inertia.map(|of| of[end]);
            part.angular += of_x * x + of_y * y;
        }
    }

    #[inline(always)]
    fn twist(&self, parts: &mut [WidePart<N>], change: Wide<N>) {
        for end in 0..self.ends {
            parts[self.bodies[end]].angular += self.twist_by_inertia[end] * on_end(end, change);
        }
    }

    /// Makes one pass over the rows of the points along the normal.
    #[inline(always)]
    pub fn solve_normal(&mut self, parts: &mut [WidePart<N>]) {
        for index in 0..self.count {
            let point = &mut self.points[index];
            let mut speed = Wide::ZERO;
            for end in 0..self.ends {
                let part = &parts[self.bodies[end]];
                speed += on_end(end, self.normal.dot(part.linear));
                speed += on_end(end, point.axes[end].dot(part.angular));
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
            let mut spin = parts[self.bodies[0]].angular;
            if self.ends == 2 {
                spin -= parts[self.bodies[1]].angular;
            }
            let wanted = self.twist_impulse - self.twist_mass * self.normal.dot(spin);
            let impulse = wanted.max(-most_twist).min(most_twist);
            let change = impulse - self.twist_impulse;
            self.twist_impulse = impulse;
            self.twist(parts, change);
        }
        let mut speeds = [Wide::ZERO; 2];
        for end in 0..self.ends {
            let part = &parts[self.bodies[end]];
            for (axis, speed) in speeds.iter_mut().enumerate() {
                *speed += on_end(end, self.tangents[axis].dot(part.linear));
                *speed += on_end(end, self.tangent_axes[axis][end].dot(part.angular));
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
