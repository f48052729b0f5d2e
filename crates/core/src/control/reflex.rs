//! The controller with a gait whose targets and phases are changed by the senses.

use super::perception::{JointSenses, LimbSenses};
use super::servo::JointServos;
use super::{Activity, Controller, Observation, ReflexActivity, ReflexPush, Senses};
use crate::genome::controllers::{REFLEX_INPUTS, ReflexGait, Wave, tanh_each};
use crate::world::JointTorque;

/// Follows a gait with reflexes.
#[derive(Debug, Clone)]
pub struct ReflexFollower {
    genes: ReflexGait,
    servo: JointServos,
    /// Shift of each joint's phase since the start, in radians.
    shifts_rad: Vec<f64>,
    /// Share of the reach by which the reflex moves the bend and the twist target of each joint, from -1 to 1: working memory.
    shares: Vec<f32>,
}

impl ReflexFollower {
    /// Creates the follower before the first step.
    pub fn new(genes: ReflexGait) -> Self {
        let servo =
            JointServos::new(genes.gait.stiffness_nm_per_rad, genes.gait.servo_damping_nms_per_rad);
        let joints = genes.gait.waves.joints.len();
        Self { servo, shifts_rad: vec![0.0; joints], shares: vec![0.0; 2 * joints], genes }
    }
}

/// Returns the weighted sum of the senses. Its hyperbolic tangent is the share of the reach by which a reflex moves a target.
fn weigh(weights: &[f32; REFLEX_INPUTS.len()], own: [f32; 2], around: [f32; 6]) -> f32 {
    let inputs = own.into_iter().chain(around).chain([1.0]);
    let mut sum = 0.0;
    for (input, weight) in inputs.zip(weights) {
        sum += input * weight;
    }
    sum
}

/// Returns the senses of the limbs before and behind a joint that a reflex uses.
fn around(front: &LimbSenses, rear: &LimbSenses) -> [f32; 6] {
    [front.touch, front.blocked, front.gap, front.step_up, rear.touch, rear.pitch]
}

/// Returns the phase of a wave's fundamental, in radians, after this many periods.
fn phase_rad(wave: &Wave, periods: f64) -> f64 {
    let start_rad = wave.harmonics.first().map_or(0.0, |harmonic| f64::from(harmonic.phase_rad));
    std::f64::consts::TAU * periods + start_rad
}

impl Controller for ReflexFollower {
    fn needs(&self) -> Senses {
        Senses::ALL
    }

    fn act(&mut self, observation: &Observation, torques: &mut [JointTorque]) {
        let ReflexGait { gait, reach_rad: reach, bend_weights, twist_weights, .. } = &self.genes;
        let waves = &gait.waves;
        let periods = observation.periods(waves.frequency_hz);
        let senses = &observation.perception;
        let pairs = || senses.limbs.iter().zip(senses.limbs.iter().skip(1));
        let sensed = senses.joints.iter().zip(pairs());
        for (shares, (own, (front, rear))) in self.shares.chunks_exact_mut(2).zip(sensed) {
            let JointSenses { bend, twist, bend_rate, twist_rate } = *own;
            let around = around(front, rear);
            shares[0] = weigh(bend_weights, [bend, bend_rate], around);
            shares[1] = weigh(twist_weights, [twist, twist_rate], around);
        }
        tanh_each(&mut self.shares);
        let moves = self.shares.chunks_exact(2).zip(&self.shifts_rad);
        let targets = waves.joints.iter().zip(moves).map(|(joint, (shares, shift_rad))| {
            // Without a shift, the result has the same bits as the target of a gait.
            let shifted = periods + shift_rad / std::f64::consts::TAU;
            let [bend, twist] = [reach * shares[0], reach * shares[1]];
            [joint.bend.at(shifted) + bend, joint.twist.at(shifted) + twist]
        });
        self.servo.pull(observation, targets, torques);
        let step_s = 1.0 / f64::from(observation.steps_per_s);
        let [load, blocked] = [self.genes.load_phase_rad_per_s, self.genes.blocked_phase_rad_per_s];
        for ((joint, (front, rear)), shift_rad) in
            waves.joints.iter().zip(pairs()).zip(&mut self.shifts_rad)
        {
            let phase_rad = phase_rad(&joint.bend, periods) + *shift_rad;
            let drawn = f64::from(load * rear.load) * libm::cos(phase_rad);
            *shift_rad -= (drawn + f64::from(blocked * front.blocked)) * step_s;
        }
    }

    fn activity(&self, observation: &Observation, joint: usize) -> Option<Activity> {
        let senses = &observation.perception;
        let own = senses.joints.get(joint)?;
        let around = around(senses.limbs.get(joint)?, senses.limbs.get(joint + 1)?);
        let (own, weights) = ([own.bend, own.bend_rate], &self.genes.bend_weights);
        let inputs = own.into_iter().chain(around).chain([1.0]);
        let pushes = REFLEX_INPUTS.iter().zip(inputs).zip(weights);
        Some(Activity::Reflex(ReflexActivity {
            joint,
            pushes: pushes
                .map(|((name, value), weight)| ReflexPush { name, value, push: value * weight })
                .collect(),
            moved_rad: self.genes.reach_rad * libm::tanhf(weigh(weights, own, around)),
            reach_rad: self.genes.reach_rad,
            shift_rad: self.shifts_rad.get(joint).map_or(0.0, |shift_rad| *shift_rad as f32),
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::Champion;
    use crate::genome::{ControllerGenes, Genome};
    use crate::save::shipped_champion;
    use crate::score::evaluate;

    fn with_reflexes(genome: &Genome, change: impl FnOnce(&mut ReflexGait)) -> Genome {
        let ControllerGenes::Gait(gait) = &genome.controller else { panic!("a gait") };
        let mut reflexes = ReflexGait {
            gait: gait.clone(),
            reach_rad: 0.0,
            bend_weights: [0.0; REFLEX_INPUTS.len()],
            twist_weights: [0.0; REFLEX_INPUTS.len()],
            load_phase_rad_per_s: 0.0,
            blocked_phase_rad_per_s: 0.0,
        };
        change(&mut reflexes);
        Genome { controller: ControllerGenes::Reflex(reflexes), ..genome.clone() }
    }

    #[test]
    fn without_weights_a_reflex_gait_leaves_the_trace_of_its_gait() {
        let Champion { genome, trial, evaluation, .. } =
            shipped_champion().expect("well formed").champion;
        let trace = |genome: &Genome| evaluate(genome, &trial).trace_hash;
        assert_eq!(trace(&genome), evaluation.trace_hash);
        assert_eq!(trace(&with_reflexes(&genome, |_| ())), evaluation.trace_hash);
        // A reach without weights moves nothing, and neither do weights without a reach.
        let only_reach = with_reflexes(&genome, |genes| genes.reach_rad = 0.5);
        assert_eq!(trace(&only_reach), evaluation.trace_hash);
        let only_weights = with_reflexes(&genome, |genes| genes.bend_weights = [2.0; 9]);
        assert_eq!(trace(&only_weights), evaluation.trace_hash);
        for change in [
            |genes: &mut ReflexGait| (genes.reach_rad, genes.bend_weights[4]) = (0.1, 1.0),
            |genes: &mut ReflexGait| genes.load_phase_rad_per_s = 0.5,
            |genes: &mut ReflexGait| genes.blocked_phase_rad_per_s = 0.5,
        ] {
            assert_ne!(trace(&with_reflexes(&genome, change)), evaluation.trace_hash);
        }
    }
}
