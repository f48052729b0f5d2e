//! Bounces at the end of a step. They are rare, so they are computed for one snake at a time.
//!
//! A point that arrived in this step under pressure leaves with the share of its speed that the restitution gives. Each point disturbs the
//! points before it, so a block that lands on a whole face needs several rounds over its corners until all agree.

use super::block::out_of;
use super::chain::Chain;
use super::contact::{Contact, ContactPoint};
use crate::world::Vector;
use crate::world::engine::{PartState, Touching};

/// Number of rounds over the points of a step. After ten, the speeds of a block's four corners agree to a thousandth.
const ROUNDS: u32 = 16;

/// A point of a contact that bounces.
struct Bounce {
    part: usize,
    front: Option<usize>,
    /// Vectors from the centres of the two touching bodies to the point, in metres.
    levers: [Vector; 2],
    normal: Vector,
    leaving_m_s: f32,
    /// Impulse on the point in the whole step, in N·s. It never becomes negative, because a surface does not pull.
    total_ns: f32,
    contact: usize,
    point: usize,
}

impl Chain {
    /// Returns whether a contact bounces in this step.
    pub fn bounces(contact: &Contact) -> bool {
        let mut points = contact.points().iter();
        contact.bounce > 0.0 && points.any(|point| Self::bounces_at(contact, point))
    }

    fn bounces_at(contact: &Contact, point: &ContactPoint) -> bool {
        // A point that already carried load in the step before does not bounce, unless the restitution is 1.
        (point.is_new || contact.bounce >= 1.0) && point.incoming_m_s > 0.0 && point.total_ns > 0.0
    }

    /// Returns the change of angular velocity by a unit impulse at a point: the product of the inverse inertia with `lever × normal`.
    fn turning(&self, part: usize, lever: Vector, normal: Vector) -> Vector {
        let axes = self.block(part).axes;
        let around = lever.cross(normal);
        let inertia = self.parts[part].inertia_kg_m2;
        axes[0] * (axes[0].dot(around) / inertia.x)
            + axes[1] * (axes[1].dot(around) / inertia.y)
            + axes[2] * (axes[2].dot(around) / inertia.z)
    }

    /// Lets points bounce. It must be called after the step.
    pub fn bounce(&mut self) {
        if !self.contacts.iter().any(Self::bounces) {
            return;
        }
        let mut bounces = self.bouncing_points();
        for _ in 0..ROUNDS {
            for bounce in &mut bounces {
                self.solve(bounce);
            }
        }
        for bounce in bounces {
            if let Some(point) = self
                .contacts
                .get_mut(bounce.contact)
                .and_then(|contact| contact.points_mut().get_mut(bounce.point))
            {
                point.total_ns = bounce.total_ns;
            }
        }
    }

    fn bouncing_points(&self) -> Vec<Bounce> {
        let mut bounces = Vec::new();
        for (index, contact) in self.contacts.iter().enumerate() {
            let front = match contact.other {
                Touching::Part(front) => Some(front),
                Touching::Ground | Touching::Solid(_) => None,
            };
            for (number, point) in contact.points().iter().enumerate() {
                let is_held = self.state[contact.part].is_held
                    || front.is_some_and(|front| self.state[front].is_held);
                if is_held || contact.bounce <= 0.0 || !Self::bounces_at(contact, point) {
                    continue;
                }
                let lever = |part: usize, own: Vector| out_of(&self.block(part).axes, own);
                bounces.push(Bounce {
                    part: contact.part,
                    front,
                    levers: [
                        lever(contact.part, point.on_part),
                        front.map_or(Vector::ZERO, |front| lever(front, point.on_other)),
                    ],
                    normal: contact.normal,
                    leaving_m_s: contact.bounce * point.incoming_m_s,
                    total_ns: point.total_ns,
                    contact: index,
                    point: number,
                });
            }
        }
        bounces
    }

    /// Changes the impulse at a point so that the point leaves with its required speed, or carries no impulse.
    fn solve(&mut self, bounce: &mut Bounce) {
        let Bounce { part, front, levers, normal, leaving_m_s, .. } = *bounce;
        let speed = |state: &PartState, lever: Vector| {
            (state.linear + state.angular.cross(lever)).dot(normal)
        };
        let turning = self.turning(part, levers[0], normal);
        let mut inverse_mass =
            1.0 / self.parts[part].mass_kg + turning.cross(levers[0]).dot(normal);
        let mut speed_m_s = speed(&self.state[part], levers[0]);
        let of_front = front.map(|front| {
            let turning = self.turning(front, levers[1], normal);
            inverse_mass += 1.0 / self.parts[front].mass_kg + turning.cross(levers[1]).dot(normal);
            speed_m_s -= speed(&self.state[front], levers[1]);
            (front, turning)
        });
        let wanted_ns = bounce.total_ns + (leaving_m_s - speed_m_s) / inverse_mass;
        let change_ns = wanted_ns.max(0.0) - bounce.total_ns;
        bounce.total_ns += change_ns;
        let state = &mut self.state[part];
        state.linear += normal * (change_ns / self.parts[part].mass_kg);
        state.angular += turning * change_ns;
        if let Some((front, turning)) = of_front {
            let state = &mut self.state[front];
            state.linear -= normal * (change_ns / self.parts[front].mass_kg);
            state.angular -= turning * change_ns;
        }
    }
}
