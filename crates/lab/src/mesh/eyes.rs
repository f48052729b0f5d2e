//! The eyes of a head.

use super::{LIMB_EDGE, MeshBuilder};
use snakes_core::world::Vector;

/// The eyes of a head at its upper edges, which stand out at the top and at the side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Eyes {
    /// Radius of an eye, in metres.
    pub radius_m: f32,
    /// Their places in the frame of the head, in metres.
    pub centres_m: [Vector; 2],
}

impl Eyes {
    /// The eyes of a head of a size whose edges have a radius, both in metres.
    pub fn of(size_m: Vector, edge_m: f32) -> Self {
        let radius_m = size_m.x.min(size_m.z) * 0.2;
        // Where edges are rounder, the block ends further inside.
        let inwards_m = (edge_m - size_m.min_element() * LIMB_EDGE) * 0.3;
        let (y, z) = (size_m.y / 2.0 - radius_m * 1.9, size_m.z / 2.0 - radius_m * 0.2 - inwards_m);
        let x = size_m.x / 2.0 - radius_m * 0.35 - inwards_m;
        Self { radius_m, centres_m: [-1.0, 1.0].map(|side| Vector::new(side * x, y, z)) }
    }

    /// Adds the eyes as balls of this many sides.
    pub fn add_to(&self, solid: &mut MeshBuilder, sides: usize) {
        self.centres_m.into_iter().for_each(|eye| solid.ball(eye, self.radius_m, sides));
    }

    /// Adds their pupils, which look ahead and aside.
    pub fn add_pupils_to(&self, solid: &mut MeshBuilder, sides: usize) {
        for eye in self.centres_m {
            let gaze = Vector::new(eye.x.signum() * 0.8, 0.62, 0.22).normalize();
            solid.ball(eye + gaze * self.radius_m * 0.5, self.radius_m * 0.64, sides);
        }
    }
}
