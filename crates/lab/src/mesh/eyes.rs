//! The eyes of a head.

use super::{LIMB_EDGE, MeshBuilder};
use snakes_core::world::Vector;

/// The eyes of a head, at its upper edges. They protrude at the top and at the sides.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Eyes {
    /// Radius of an eye, in metres.
    pub radius_m: f32,
    /// Centres of the eyes in the frame of the head, in metres.
    pub centres_m: [Vector; 2],
}

impl Eyes {
    /// Returns the eyes of a head with this size and radius of its edges, both in metres.
    pub fn of(size_m: Vector, edge_m: f32) -> Self {
        let radius_m = size_m.x.min(size_m.z) * 0.2;
        // The rounder the edges, the further inside is the surface of the head.
        let inwards_m = (edge_m - size_m.min_element() * LIMB_EDGE) * 0.3;
        let (y, z) = (size_m.y / 2.0 - radius_m * 1.9, size_m.z / 2.0 - radius_m * 0.2 - inwards_m);
        let x = size_m.x / 2.0 - radius_m * 0.35 - inwards_m;
        Self { radius_m, centres_m: [-1.0, 1.0].map(|side| Vector::new(side * x, y, z)) }
    }

    /// Adds the eyes as spheres with this number of sides.
    pub fn add_to(&self, solid: &mut MeshBuilder, sides: usize) {
        self.centres_m.into_iter().for_each(|eye| solid.ball(eye, self.radius_m, sides));
    }

    /// Adds the pupils, which look forward and to the side.
    pub fn add_pupils_to(&self, solid: &mut MeshBuilder, sides: usize) {
        self.pupils_m().into_iter().for_each(|(pupil, radius)| solid.ball(pupil, radius, sides));
    }

    /// Returns centre and radius of each pupil in the frame of the head, in metres.
    pub fn pupils_m(&self) -> [(Vector, f32); 2] {
        self.centres_m.map(|eye| {
            let gaze = Vector::new(eye.x.signum() * 0.8, 0.62, 0.22).normalize();
            (eye + gaze * self.radius_m * 0.5, self.radius_m * 0.64)
        })
    }
}
