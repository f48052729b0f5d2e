//! One genome going through one trial, step by step.

use xxhash_rust::xxh3::Xxh3Default;

use super::fitness::Ending;
use super::{Fitness, Perturbation, Trial};
use crate::control::SignalPlayer;
use crate::genome::Genome;
use crate::world::{
    Disqualification, Effort, JointTorque, LimbPlan, Pose, Simulation, Stairs, WorldPlan,
};

/// What a rollout ended with.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Evaluation {
    /// What the trial rewards: see [`Fitness`] for the unit. For a disqualified agent, what it had when
    /// it was last seen in good health.
    pub fitness: f32,
    /// y of the middle limb's centre at the end, in metres, whatever is rewarded.
    pub centre_y_m: f32,
    /// Why the agent was disqualified, if it was.
    pub disqualified: Option<Disqualification>,
    /// Hash (XXH3, 64 bits) over the bits of every limb's pose after every healthy step, the final
    /// one included.
    pub trace_hash: u64,
    /// Healthy physics steps taken.
    pub steps: u32,
    /// What these steps demanded of the snake. None in what was recorded before it was measured.
    pub effort: Option<Effort>,
}

impl Evaluation {
    /// Whether both are of the same bits. What one of them did not measure does not count.
    pub fn agrees_with(&self, other: &Self) -> bool {
        let is_unknown = self.effort.is_none() || other.effort.is_none();
        Self { effort: None, ..*self } == Self { effort: None, ..*other }
            && (is_unknown || self.effort == other.effort)
    }
}

/// A rollout on its way.
pub struct Rollout {
    simulation: Simulation,
    player: SignalPlayer,
    torques: Vec<JointTorque>,
    poses: Vec<Pose>,
    fitness: Fitness,
    stairs: Stairs,
    masses_kg: Vec<f32>,
    middle_limb: usize,
    furthest_y_m: f32,
    trace: Xxh3Default,
    step: u32,
    last_step: u32,
    disqualified: Option<Disqualification>,
}

impl Rollout {
    /// Builds the trial's world around the genome. Both must have passed their checks.
    pub fn new(genome: &Genome, trial: &Trial) -> Self {
        Self::in_world(genome, trial, trial.world_plan(genome))
    }

    /// The same in a world that is a little otherwise.
    pub fn perturbed(genome: &Genome, trial: &Trial, perturbation: &Perturbation) -> Self {
        let mut plan = trial.world_plan(genome);
        perturbation.apply(&mut plan);
        Self::in_world(genome, trial, plan)
    }

    fn in_world(genome: &Genome, trial: &Trial, plan: WorldPlan) -> Self {
        let simulation = Simulation::new(&plan);
        let mut rollout = Self {
            player: SignalPlayer::new(genome.signals.clone(), trial.physics.steps_per_s),
            torques: vec![JointTorque::default(); plan.body.joints.len()],
            poses: simulation.poses().collect(),
            simulation,
            fitness: trial.fitness,
            stairs: plan.stairs,
            masses_kg: plan.body.limbs.iter().map(LimbPlan::mass_kg).collect(),
            middle_limb: plan.body.middle_limb(),
            furthest_y_m: f32::MIN,
            trace: Xxh3Default::new(),
            step: 0,
            last_step: trial.steps(),
            disqualified: None,
        };
        rollout.furthest_y_m = rollout.poses[rollout.middle_limb].translation.y;
        rollout
    }

    /// Takes one step, unless the rollout is over. Returns whether it took a healthy one.
    pub fn advance(&mut self) -> bool {
        if self.is_over() {
            return false;
        }
        self.player.torques(self.step, &mut self.torques);
        if let Err(reason) = self.simulation.step(&self.torques) {
            self.disqualified = Some(reason);
            return false;
        }
        self.step += 1;
        for (kept, pose) in self.poses.iter_mut().zip(self.simulation.poses()) {
            *kept = pose;
            let (at, turn) = (pose.translation, pose.rotation);
            let mut bytes = [0; 28];
            let numbers = [at.x, at.y, at.z, turn.x, turn.y, turn.z, turn.w];
            for (slot, number) in bytes.chunks_exact_mut(4).zip(numbers) {
                slot.copy_from_slice(&number.to_bits().to_le_bytes());
            }
            self.trace.update(&bytes);
        }
        self.furthest_y_m = self.furthest_y_m.max(self.poses[self.middle_limb].translation.y);
        true
    }

    /// Whether the trial's time is up or the agent is disqualified.
    pub fn is_over(&self) -> bool {
        self.step >= self.last_step || self.disqualified.is_some()
    }

    /// The poses of the limbs after the last healthy step, head first.
    pub fn poses(&self) -> &[Pose] {
        &self.poses
    }

    /// Healthy steps taken so far.
    pub fn step(&self) -> u32 {
        self.step
    }

    /// What there is to say so far; after the end, the result.
    pub fn evaluation(&self) -> Evaluation {
        let ending = Ending {
            poses: &self.poses,
            masses_kg: &self.masses_kg,
            middle_limb: self.middle_limb,
            furthest_y_m: self.furthest_y_m,
            stairs: &self.stairs,
        };
        Evaluation {
            fitness: ending.score(self.fitness),
            centre_y_m: self.poses[self.middle_limb].translation.y,
            disqualified: self.disqualified,
            trace_hash: self.trace.digest(),
            steps: self.step,
            effort: Some(self.simulation.effort()),
        }
    }

    /// How many steps are under the middle limb now: see [`Stairs::steps_under`].
    pub fn steps_under(&self) -> u32 {
        self.stairs.steps_under(self.poses[self.middle_limb].translation.to_array())
    }

    /// The world, to look at.
    pub fn simulation(&self) -> &Simulation {
        &self.simulation
    }

    /// The world, to be lent out between steps: see [`Simulation::physics_mut`].
    pub fn simulation_mut(&mut self) -> &mut Simulation {
        &mut self.simulation
    }
}

/// Scores a genome: runs its rollout to the end.
pub fn evaluate(genome: &Genome, trial: &Trial) -> Evaluation {
    let mut rollout = Rollout::new(genome, trial);
    while rollout.advance() {}
    rollout.evaluation()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::genome::GenomeSpace;
    use crate::rng::{Purpose, stream};

    fn newborn(individual: u32, trial: &Trial) -> Genome {
        let mut rng = stream(1, 1, individual, Purpose::Birth);
        GenomeSpace::default().birth(trial.agent.joints(), trial.duration_s, &mut rng)
    }

    #[test]
    fn scoring_twice_gives_the_same_bits() {
        let trial = Trial::default();
        for individual in 0..5 {
            let genome = newborn(individual, &trial);
            assert_eq!(evaluate(&genome, &trial), evaluate(&genome, &trial));
        }
    }

    #[test]
    fn different_genomes_leave_different_traces() {
        let trial = Trial::default();
        let first = evaluate(&newborn(0, &trial), &trial);
        let second = evaluate(&newborn(1, &trial), &trial);
        assert_ne!(first.trace_hash, second.trace_hash);
    }

    #[test]
    fn without_torque_the_snake_stays_where_it_starts() {
        let trial = Trial::default();
        let mut genome = newborn(0, &trial);
        genome.signals.all_mut().for_each(|signal| signal.fill(0.0));
        let evaluation = evaluate(&genome, &trial);
        assert_eq!(evaluation.disqualified, None);
        assert_eq!(evaluation.steps, 300);
        assert!((evaluation.fitness - trial.start_y_m).abs() < 0.01, "{evaluation:?}");
    }
}
