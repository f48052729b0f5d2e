//! Damping of the limbs by the air and by surfaces.

use super::Simulation;
use crate::world::turning::turned;

impl Simulation {
    /// Slows the limbs by the damping of air and surfaces for half a step.
    pub(super) fn dampen_half_step(&mut self) {
        let damping = self.damping;
        if damping.is_none() {
            return;
        }
        for (part, inertia) in self.engine.parts_mut().iter_mut().zip(&self.inertias_kg_m2) {
            let surface = damping.of_surfaces(&part.touch).map_or(1.0, |(_, factor)| factor);
            let rate = turned(part.turn.inverse(), part.angular);
            let turning_j = (*inertia * rate).dot(rate) / 2.0;
            self.balance.rotation_damping_j +=
                f64::from(turning_j * (1.0 - damping.air * damping.air));
            part.angular *= damping.air * surface;
            if surface < 1.0 {
                part.linear *= surface;
            }
        }
    }
}
