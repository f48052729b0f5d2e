//! Finds the contacts of a snake at the beginning of a step, and gives each contact its initial impulses.

use super::block::{Block, of_blocks, on_ground};
use super::chain::{Chain, Law, Solid};
use super::shared_points::{MOST_POINTS, SharedPoints};
use crate::world::Vector;
use crate::world::contact::SlippingPatch;
use crate::world::engine::{PartContact, PartContactPoint, Touching};

/// Distance up to which approaching bodies count as a contact, in metres, as in rapier.
const WITHIN_M: f32 = 0.02;

/// A point of a contact, with its impulses.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct ContactPoint {
    pub(super) features: u16,
    /// Point midway between both surfaces at the beginning of the step, in the world, in metres.
    pub(super) at: Vector,
    /// Point on the part, in the part's own frame, in metres.
    pub on_part: Vector,
    /// Point on the other body, in metres: in the frame of the touched part, or in the world.
    pub on_other: Vector,
    /// Distance between the surfaces at the beginning of the step, in metres; negative where they overlap.
    pub(super) distance_m: f32,
    /// Impulse along the normal in the last substep, in N·s.
    pub impulse_ns: f32,
    /// Impulse along the normal in the whole step, in N·s.
    pub total_ns: f32,
    /// Whether the point carried no load in the step before.
    pub is_new: bool,
    /// Speed at which the bodies approached each other at the point when the step began, in m/s. It is computed only if something bounces.
    pub(super) incoming_m_s: f32,
}

/// A contact of a part: up to four points along one normal, which share their friction.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Contact {
    /// Index of the part. For a contact of two parts, it is the rear one.
    pub part: usize,
    /// The body that the part touches.
    pub other: Touching,
    /// Unit vector in the world along which the part is pushed.
    pub normal: Vector,
    /// Coulomb coefficient of the materials.
    pub material_friction: f32,
    /// Coulomb coefficient in this step. It is lower than that of the materials where the surface lets the part slip.
    pub(super) friction: f32,
    pub(super) bounce: f32,
    pub(super) correction_per_s: f32,
    pub(super) softening: f32,
    points: [ContactPoint; MOST_POINTS],
    count: usize,
    /// Friction on the part in the last substep, in N·s, in the world.
    pub friction_ns: Vector,
    /// Angular impulse of the friction on the part about the normal in the last substep, in N·m·s.
    pub twist_nms: f32,
}

impl Contact {
    /// Returns the points of the contact.
    pub fn points(&self) -> &[ContactPoint] {
        &self.points[..self.count]
    }

    /// Returns the contact as it is read after a step.
    pub fn seen(&self) -> PartContact {
        let Self { part, other, normal, friction_ns, twist_nms, .. } = *self;
        let points = self.points().iter().map(|point| {
            let ContactPoint { on_part, on_other, impulse_ns, .. } = *point;
            PartContactPoint { on_part, on_other, impulse_ns }
        });
        let (points, friction) = (points.collect(), self.material_friction);
        let has_bounced = Chain::bounces(self);
        PartContact { part, other, normal, friction, friction_ns, twist_nms, has_bounced, points }
    }

    pub(super) fn points_mut(&mut self) -> &mut [ContactPoint] {
        &mut self.points[..self.count]
    }
}

/// Two bodies between which a contact is searched: `part` with the block `second`, and the body that it touches, with the block `first`;
/// `None` for the ground.
struct Bodies<'a> {
    part: usize,
    other: Touching,
    first: Option<&'a Block>,
    second: &'a Block,
    law: Law,
}

impl Solid {
    /// Returns whether an axis-aligned box between these corners is too far away for a contact.
    fn is_far(&self, low: Vector, high: Vector) -> bool {
        self.low.y - high.y > WITHIN_M
            || low.y - self.high.y > WITHIN_M
            || low.z - self.high.z > WITHIN_M
            || self.low.x - high.x > WITHIN_M
            || low.x - self.high.x > WITHIN_M
            || self.low.z - high.z > WITHIN_M
    }
}

impl Chain {
    /// Finds the contacts of the snake's present state. The contacts of the last step become the earlier ones.
    pub(super) fn find_contacts(&mut self) {
        std::mem::swap(&mut self.contacts, &mut self.earlier);
        let mut contacts = std::mem::take(&mut self.contacts);
        contacts.clear();
        let mut found = SharedPoints::default();
        let mut blocks = std::mem::take(&mut self.blocks);
        blocks.clear();
        blocks.extend((0..self.parts.len()).map(|part| {
            let block = self.block(part);
            (block, block.reach_m())
        }));
        for &[front, rear] in &self.pairs {
            let ((first, of_first), (second, of_second)) = (&blocks[front], &blocks[rear]);
            let apart = (first.centre - second.centre).abs();
            if (apart - (*of_first + *of_second)).max_element() > WITHIN_M {
                continue;
            }
            if of_blocks(first, second, WITHIN_M, &mut found) {
                let (other, law) = (Touching::Part(front), self.laws.limbs);
                let bodies = Bodies { part: rear, other, first: Some(first), second, law };
                self.add_contact(&bodies, &found, &mut contacts);
            }
        }
        // The solids that no part can touch are left out for all parts at once.
        let mut near = std::mem::take(&mut self.near);
        near.clear();
        let ends = |of: fn(Vector, Vector) -> Vector, corner: fn(&(Block, Vector)) -> Vector| {
            blocks.iter().map(corner).reduce(of).unwrap_or(Vector::ZERO)
        };
        let low = ends(Vector::min, |(block, reach_m)| block.centre - *reach_m);
        let high = ends(Vector::max, |(block, reach_m)| block.centre + *reach_m);
        near.extend((0..self.solids.len()).filter(|index| !self.solids[*index].is_far(low, high)));
        for (part, (block, reach_m)) in blocks.iter().enumerate() {
            let (low, high) = (block.centre - *reach_m, block.centre + *reach_m);
            if low.z <= WITHIN_M && on_ground(block, WITHIN_M, &mut found) {
                let (other, law) = (Touching::Ground, self.laws.ground);
                let bodies = Bodies { part, other, first: None, second: block, law };
                self.add_contact(&bodies, &found, &mut contacts);
            }
            for &index in &near {
                let solid = &self.solids[index];
                if solid.is_far(low, high) {
                    continue;
                }
                if of_blocks(&solid.block, block, WITHIN_M, &mut found) {
                    let (other, law) = (Touching::Solid(index), self.laws.stairs);
                    let first = Some(&solid.block);
                    let bodies = Bodies { part, other, first, second: block, law };
                    self.add_contact(&bodies, &found, &mut contacts);
                }
            }
        }
        self.contacts = contacts;
        self.blocks = blocks;
        self.near = near;
    }

    /// Adds the contact of two bodies, with the impulses that its points had in the step before. Adds nothing if no point is near enough.
    fn add_contact(&self, bodies: &Bodies<'_>, found: &SharedPoints, contacts: &mut Vec<Contact>) {
        let Bodies { part, other, first, second, law } = bodies;
        let turned = |of: Vector| first.map_or(of, |first| first.turned(of));
        let placed = |at: Vector| first.map_or(at, |first| first.in_world(at));
        let normal = turned(found.normal);
        let mut contact = Contact {
            part: *part,
            other: *other,
            normal,
            material_friction: law.friction,
            friction: law.friction,
            bounce: law.bounce,
            correction_per_s: law.correction_per_s,
            softening: law.softening,
            points: [ContactPoint::default(); MOST_POINTS],
            count: 0,
            friction_ns: Vector::ZERO,
            twist_nms: 0.0,
        };
        let earlier = self.earlier.iter().find(|of| of.part == *part && of.other == *other);
        let mut kept = 0.0;
        let (chosen, count) = found.chosen(WITHIN_M);
        for &index in &chosen[..count] {
            let candidate = &found.points()[index];
            let [on_first, on_second] = [candidate.on_first, candidate.on_second].map(placed);
            if law.contact.softness.is_soft() {
                // A spring pushes only once the surfaces touch.
                if candidate.distance_m > 0.0 {
                    continue;
                }
            } else if candidate.distance_m >= WITHIN_M {
                let approach_m_s = self.approach_m_s(*part, *other, on_second, normal);
                if candidate.distance_m - approach_m_s * self.common.step_s >= WITHIN_M {
                    continue;
                }
            }
            let of_earlier = earlier
                .and_then(|of| of.points().iter().find(|of| of.features == candidate.features));
            let at = (on_first + on_second) * 0.5;
            let on_other = if matches!(other, Touching::Part(_)) {
                first.map_or(on_first, |first| first.in_own_frame(on_first))
            } else {
                on_first
            };
            contact.points[contact.count] = ContactPoint {
                features: candidate.features,
                at,
                on_part: second.in_own_frame(on_second),
                on_other,
                distance_m: candidate.distance_m,
                impulse_ns: of_earlier.map_or(0.0, |of| of.impulse_ns),
                total_ns: 0.0,
                is_new: of_earlier.is_none_or(|of| of.total_ns == 0.0),
                incoming_m_s: if law.bounce > 0.0 {
                    self.approach_m_s(*part, *other, at, normal)
                } else {
                    0.0
                },
            };
            contact.count += 1;
            kept += if of_earlier.is_some() { 1.0 } else { 0.0 };
        }
        if contact.count == 0 {
            return;
        }
        if let Some(earlier) = earlier {
            // Only the points that touched before carry friction at first; new points have none yet.
            let share = kept / contact.count as f32;
            contact.friction_ns = earlier.friction_ns * share;
            contact.twist_nms = earlier.twist_nms * share;
        }
        self.apply_law(&mut contact, law, earlier.map_or(Vector::ZERO, |of| of.friction_ns), kept);
        contacts.push(contact);
    }

    /// Returns the speed at which the bodies approach each other along the normal at a point, in m/s.
    pub(super) fn approach_m_s(
        &self,
        part: usize,
        other: Touching,
        at: Vector,
        normal: Vector,
    ) -> f32 {
        -self.relative_velocity(part, other, at).dot(normal)
    }

    /// Returns the velocity of the part's surface relative to the body that it touches, in m/s.
    fn relative_velocity(&self, part: usize, other: Touching, at: Vector) -> Vector {
        let of_other = match other {
            Touching::Part(front) => self.state[front].velocity_at(at),
            Touching::Ground | Touching::Solid(_) => Vector::ZERO,
        };
        self.state[part].velocity_at(at) - of_other
    }

    /// Applies the parameters of a surface that act before the contact is solved: the least speed for a bounce, and slip, which lowers the
    /// friction (see [`SlippingPatch`]). `friction_ns` is the friction in the last step; `kept` of the points had it.
    fn apply_law(&self, contact: &mut Contact, law: &Law, friction_ns: Vector, kept: f32) {
        let (part, other, normal) = (contact.part, contact.other, contact.normal);
        let law = law.contact;
        if law.bounce_velocity_m_s > 0.0 {
            let approach = |point: &ContactPoint| self.approach_m_s(part, other, point.at, normal);
            let incoming_m_s = contact.points().iter().map(approach).fold(0.0, f32::max);
            if incoming_m_s < law.bounce_velocity_m_s {
                contact.bounce = 0.0;
            }
        }
        if law.slip_m_s_per_n > 0.0 {
            let count = contact.count as f32;
            let pressed_ns: f32 = contact.points().iter().map(|point| point.impulse_ns).sum();
            let centre = contact.points().iter().map(|point| point.at).sum::<Vector>() / count;
            let velocity = self.relative_velocity(part, other, centre);
            let along_normal = velocity.dot(normal);
            let patch = SlippingPatch {
                friction_ns: friction_ns * kept,
                points: count,
                pressed_ns,
                sliding_m_s: velocity - normal * along_normal,
                approach_m_s: -along_normal,
                mass_kg: match other {
                    Touching::Part(front) => {
                        self.parts[part].mass_kg.min(self.parts[front].mass_kg)
                    }
                    Touching::Ground | Touching::Solid(_) => self.parts[part].mass_kg,
                },
                step_s: self.common.step_s,
                substeps: self.common.substeps,
            };
            if let Some(friction) = patch.friction(law.slip_m_s_per_n) {
                contact.friction = contact.friction.min(friction);
            }
        }
    }
}
