//! Checks the state after a step against the limits of the trial.

use super::Simulation;
use crate::world::turning::turned;
use crate::world::{Disqualification, Effort, Mount, Vector, WorldPlan};

/// Height below which a part has fallen through the ground, in metres, because a contact failed.
const LOWEST_Z_M: f32 = -2.0;

impl Simulation {
    /// Returns half the length of a part, as a vector in the world from its centre to its front face, in metres.
    fn centre_to_front(&self, part: usize) -> Vector {
        let half_length = Vector::new(0.0, self.body().parts[part].length_m / 2.0, 0.0);
        turned(self.parts()[part].turn, half_length)
    }

    /// Returns the squared distance between the two anchors of a joint or a spring, in m².
    fn drift_squared(&self, [parent, child]: [usize; 2], mount: Option<Mount>) -> f32 {
        let [front, rear] = [parent, child].map(|part| &self.parts()[part]);
        let on_parent = match mount {
            Some(mount) => front.at + turned(front.turn, mount.at_m),
            None => front.at - self.centre_to_front(parent),
        };
        on_parent.distance_squared(rear.at + self.centre_to_front(child))
    }

    /// Checks the state after a step against the [`HealthLimits`] and returns the speeds and distances of this state.
    pub(super) fn check_health(&self) -> Result<Effort, Disqualification> {
        let mut seen = Effort::default();
        if self.engine.has_failed() {
            return Err(Disqualification::NotFinite);
        }
        let WorldPlan { body, health, .. } = &self.plan;
        let speed_limit_squared = health.speed_m_s * health.speed_m_s;
        for (index, part) in self.parts().iter().enumerate() {
            let (centre, speed_squared) = (part.at, part.linear.length_squared());
            let turns = part.turn.is_finite() && part.angular.is_finite();
            if !(centre.is_finite() && speed_squared.is_finite() && turns) {
                return Err(Disqualification::NotFinite);
            }
            if speed_squared > speed_limit_squared {
                return Err(Disqualification::TooFast);
            }
            if centre.x.abs() > health.arena_half_width_m
                || centre.y < -health.arena_back_m
                || centre.y > self.arena_front_y_m
                || centre.z < LOWEST_Z_M
            {
                return Err(Disqualification::LeftArena);
            }
            // The order of these checks decides which reason is reported, so it is part of the result of a run.
            let joints = body.joints.iter();
            let joints = joints.map(|of| ([of.parent, of.child], of.mount, of.gap_scale));
            let springs = body.springs.iter();
            let springs = springs.map(|of| ([of.parent, of.child], None, of.gap_scale));
            let to_parents = joints.chain(springs).filter(|([_, child], ..)| *child == index);
            let mut drift_squared = 0.0_f32;
            for (ends, mount, gap_scale) in to_parents {
                let limit_m = health.joint_drift_m * gap_scale;
                let of_joint = self.drift_squared(ends, mount);
                if of_joint > limit_m * limit_m {
                    return Err(Disqualification::JointBroke);
                }
                drift_squared = drift_squared.max(of_joint);
            }
            seen = seen.and(Effort {
                energy_j: 0.0,
                top_speed_m_s: speed_squared.sqrt(),
                joint_drift_m: drift_squared.sqrt(),
                sideways_m: centre.x.abs(),
            });
        }
        Ok(seen)
    }
}
