//! A rollout whose motion another engine computes. The controller senses and drives the limbs in this engine.

use super::ending::Watch;
use super::{ExamCondition, ExamEnd};
use crate::control::ControlLoop;
use crate::genome::Genome;
use crate::world::{Disqualification, JointTorque, LimbState, Pose, Simulation, WorldPlan};

/// A champion's controller that drives a snake in another engine.
pub struct MirroredRollout {
    /// Plan of the world that the other engine has to build.
    pub plan: WorldPlan,
    /// World that mirrors the state of the limbs at the start, or as it was last copied, from which the senses are read.
    world: Simulation,
    control: ControlLoop,
    torques: Vec<JointTorque>,
    step: u32,
    last_step: u32,
    watch: Watch,
    disqualified: Option<Disqualification>,
}

impl MirroredRollout {
    /// Prepares a rollout of a genome in a condition, before its first step. It ignores shoves, faults of the drives and pushes, which no judge
    /// draws.
    pub fn new(genome: &Genome, ExamCondition { trial, perturbation, .. }: &ExamCondition) -> Self {
        let mut plan = trial.world_plan(genome);
        perturbation.apply(&mut plan);
        Self {
            control: ControlLoop::new(genome, &plan, trial.agent.senses),
            torques: vec![JointTorque::default(); plan.body.joints.len()],
            last_step: super::trial::steps_in(trial.duration_s, &plan.physics),
            world: Simulation::new(&plan),
            watch: Watch::new(&plan.body, &plan.stairs, plan.physics.gravity_m_s2),
            plan,
            step: 0,
            disqualified: None,
        }
    }

    /// Returns whether the trial's time is up or the snake is disqualified.
    pub fn is_over(&self) -> bool {
        self.step >= self.last_step || self.disqualified.is_some()
    }

    /// Computes the torques of the step that begins, one per joint, clamped to the joints' limits.
    pub fn torques(&mut self) -> &[JointTorque] {
        self.control.act(self.step, &self.world, &mut self.torques);
        for (torque, joint) in self.torques.iter_mut().zip(&self.plan.body.joints) {
            let (bend, twist) = (joint.max_bend_torque_nm, joint.max_twist_torque_nm);
            torque.bend_nm = torque.bend_nm.clamp(-bend, bend);
            torque.twist_nm = torque.twist_nm.clamp(-twist, twist);
        }
        &self.torques
    }

    /// Copies the limbs after a step, head first. The snake is disqualified if a limb is faster than the trial allows or beyond the
    /// sideways or backward limit, or if a number is not finite. Gaps of joints and energy from nothing are not checked, because they are
    /// errors of this program's engine.
    pub fn take(&mut self, limbs: &[LimbState]) {
        let health = &self.plan.health;
        let trouble = |limb: &LimbState| {
            let (centre, speed_m_s) = (limb.pose.translation, limb.velocity_m_s.length());
            let is_finite = centre.is_finite()
                && limb.pose.rotation.is_finite()
                && limb.angular_velocity_rad_s.is_finite()
                && speed_m_s.is_finite();
            let is_inside =
                centre.x.abs() <= health.arena_half_width_m && centre.y >= -health.arena_back_m;
            match (is_finite, speed_m_s <= health.speed_m_s, is_inside) {
                (false, ..) => Some(Disqualification::NotFinite),
                (_, false, _) => Some(Disqualification::TooFast),
                (.., false) => Some(Disqualification::LeftArena),
                _ => None,
            }
        };
        self.disqualified = limbs.iter().find_map(trouble);
        if limbs.len() != self.plan.body.parts.len() {
            self.disqualify();
        }
        if self.disqualified.is_none() {
            self.world.mirror(limbs);
            self.step += 1;
            let poses: Vec<Pose> = limbs.iter().map(|limb| limb.pose).collect();
            let touching = limbs.iter().enumerate().filter(|(_, limb)| limb.contact_n.is_some());
            let touching = touching.map(|(part, _)| part);
            let flies = touching.clone().next().is_none();
            let now_s = self.step as f32 * self.plan.physics.step_s();
            self.watch.observe(now_s, &poses, touching, flies);
        }
    }

    /// Ends the trial with a disqualification, because the other engine cannot continue.
    pub fn disqualify(&mut self) {
        self.disqualified = Some(Disqualification::NotFinite);
    }

    /// Returns the end of the trial, if it ends now. The time of landing is not recorded.
    pub fn end(&self) -> ExamEnd {
        let poses: Vec<Pose> = self.world.poses().collect();
        let ending = self.watch.ending(self.disqualified, &poses);
        let middle = poses.get(self.plan.body.middle_part);
        match middle.filter(|_| self.disqualified.is_none()) {
            Some(middle) => {
                let middle_m = middle.translation.to_array();
                ExamEnd::at(middle_m, &self.plan.stairs, self.plan.middle_start_y_m(), ending)
            }
            None => ExamEnd { ending, ..ExamEnd::CRASHED },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::save::shipped_champion;
    use crate::score::Perturbation;
    use crate::world::Vector;

    #[test]
    fn a_limb_beyond_the_limits_of_the_arena_disqualifies_the_snake() {
        let champion = shipped_champion().expect("well formed").champion;
        let condition = ExamCondition {
            label: String::new(),
            trial: champion.trial,
            perturbation: Perturbation::default(),
        };
        let is_over_with_tail_at = |x: f32, y: f32| {
            let mut rollout = MirroredRollout::new(&champion.genome, &condition);
            let at_rest = |pose| LimbState {
                pose,
                velocity_m_s: Vector::ZERO,
                angular_velocity_rad_s: Vector::ZERO,
                contact_n: None,
            };
            let mut limbs: Vec<LimbState> = rollout.world.poses().map(at_rest).collect();
            let tail = limbs.last_mut().expect("a snake has limbs");
            (tail.pose.translation.x, tail.pose.translation.y) = (x, y);
            rollout.take(&limbs);
            rollout.is_over()
        };
        for (x, y, is_beyond) in [
            (11.9, -29.9, false),
            (12.1, -7.0, true),
            (-12.1, -7.0, true),
            (0.0, -30.1, true),
            (0.0, -29.9, false),
        ] {
            assert_eq!(is_over_with_tail_at(x, y), is_beyond, "at {x}, {y}");
        }
    }
}
