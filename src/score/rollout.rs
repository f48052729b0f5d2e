//! One genome going through one trial, step by step.

use xxhash_rust::xxh3::Xxh3Default;

use super::behaviour::Observer;
use super::fitness::Ending;
use super::{Behaviour, Fitness, Perturbation, Trial};
use crate::control::Driver;
use crate::genome::Genome;
use crate::rng::{Purpose, stream};
use crate::world::{
    Disqualification, Effort, JointState, JointTorque, LimbPlan, Pose, Pull, Simulation, Stairs,
    Vector, WorldPlan,
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
    /// How it went about it. None in what was recorded before it was observed.
    pub behaviour: Option<Behaviour>,
}

impl Evaluation {
    /// What somebody healthy has who reached so far, and of whom nothing else is known: for tests.
    #[cfg(test)]
    pub fn of_fitness(fitness: f32) -> Self {
        Self {
            fitness,
            centre_y_m: fitness,
            disqualified: None,
            trace_hash: 0,
            steps: 1,
            effort: None,
            behaviour: None,
        }
    }

    /// Whether both are of the same bits. What one of them did not measure does not count.
    pub fn agrees_with(&self, other: &Self) -> bool {
        fn agree<T: PartialEq>(a: Option<T>, b: Option<T>) -> bool {
            a.is_none() || b.is_none() || a == b
        }
        let bare = |evaluation: &Self| Self { effort: None, behaviour: None, ..*evaluation };
        bare(self) == bare(other)
            && agree(self.effort, other.effort)
            && agree(self.behaviour, other.behaviour)
    }

    /// Whether the agent ended in good health with all steps of the stairs under its middle limb.
    pub fn is_on_landing(&self, stairs: &Stairs) -> bool {
        let climbed = self.behaviour.map_or(0, |behaviour| behaviour.steps_climbed);
        self.disqualified.is_none() && stairs.steps > 0 && climbed == stairs.steps
    }
}

/// A rollout on its way. A clone goes on with the bits of the original.
#[derive(Clone)]
pub struct Rollout {
    simulation: Simulation,
    driver: Driver,
    felt: Vec<JointState>,
    torques: Vec<JointTorque>,
    poses: Vec<Pose>,
    fitness: Fitness,
    energy_cost_per_kj: f32,
    frequency_hz: f32,
    observer: Observer,
    stairs: Stairs,
    masses_kg: Vec<f32>,
    length_m: f32,
    middle_limb: usize,
    furthest_y_m: f32,
    trace: Xxh3Default,
    step: u32,
    last_step: u32,
    disqualified: Option<Disqualification>,
    is_disturbed: bool,
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
            driver: Driver::new(genome, trial.physics.steps_per_s),
            felt: Vec::new(),
            torques: vec![JointTorque::default(); plan.body.joints.len()],
            poses: simulation.poses().collect(),
            simulation,
            fitness: trial.fitness,
            energy_cost_per_kj: trial.energy_cost_per_kj,
            frequency_hz: genome.controller.frequency_hz(),
            observer: Observer::default(),
            stairs: plan.stairs,
            masses_kg: plan.body.limbs.iter().map(LimbPlan::mass_kg).collect(),
            length_m: plan.body.length_m(),
            middle_limb: plan.body.middle_limb(),
            furthest_y_m: f32::MIN,
            trace: Xxh3Default::new(),
            step: 0,
            last_step: trial.steps(),
            disqualified: None,
            is_disturbed: false,
        };
        rollout.furthest_y_m = rollout.poses[rollout.middle_limb].translation.y;
        rollout
    }

    /// Takes one step, unless the rollout is over. Returns whether it took a healthy one.
    pub fn advance(&mut self) -> bool {
        if self.is_over() {
            return false;
        }
        if self.driver.feels() {
            self.felt.clear();
            self.felt.extend(self.simulation.joint_states());
        }
        self.driver.torques(self.step, &self.felt, &mut self.torques);
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
        self.observer.see(&self.simulation, &self.stairs, self.middle_limb);
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
            length_m: self.length_m,
            stairs: &self.stairs,
        };
        let effort = self.simulation.effort();
        let middle = self.poses[self.middle_limb].translation;
        let cost = self.energy_cost_per_kj * effort.energy_j / 1000.0;
        let behaviour = self.observer.behaviour(&self.stairs, middle.to_array(), self.frequency_hz);
        Evaluation {
            fitness: ending.score(self.fitness) - cost,
            centre_y_m: middle.y,
            disqualified: self.disqualified,
            trace_hash: self.trace.digest(),
            steps: self.step,
            effort: Some(effort),
            behaviour: Some(behaviour),
        }
    }

    /// Lets a hand pull a limb from the next step on, or no more. From then on the rollout is disturbed: it
    /// says nothing of the genome any more.
    pub fn pull(&mut self, pull: Option<Pull>) {
        self.is_disturbed |= pull.is_some();
        self.simulation.pull(pull);
    }

    /// Whether a hand has interfered.
    pub fn is_disturbed(&self) -> bool {
        self.is_disturbed
    }

    /// How many steps it lasts, unless the agent is disqualified before.
    pub fn last_step(&self) -> u32 {
        self.last_step
    }

    /// Where the middle limb's centre is after the last healthy step, in metres.
    pub fn middle_m(&self) -> Vector {
        self.poses[self.middle_limb].translation
    }

    /// Whether all steps of the stairs are under the middle limb now.
    pub fn is_on_landing(&self) -> bool {
        let steps = self.stairs.steps;
        steps > 0 && self.stairs.steps_under(self.middle_m().to_array()) == steps
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

/// Scores a genome: runs its rollout to the end, and those of the trials that are off, if there are any.
/// Of these only the fitness counts: see [`super::Repeats`].
///
/// How they are off is derived from the genome's own bits, so that a champion's file is enough to score it
/// again, and no two genomes have learned the same few exceptions by heart.
pub fn evaluate(genome: &Genome, trial: &Trial) -> Evaluation {
    let nominal = finished(Rollout::new(genome, trial));
    let repeats = &trial.repeats;
    if repeats.trials <= 1 || nominal.disqualified.is_some() {
        return nominal;
    }
    let mut fitnesses = vec![nominal.fitness];
    let seed = genome.hash();
    fitnesses.extend((1..repeats.trials).map(|number| {
        let perturbation = repeats.off.draw(&mut stream(seed, 0, number, Purpose::Repeat));
        let mut rollout = Rollout::perturbed(genome, trial, &perturbation);
        let at_start = rollout.evaluation().fitness;
        while rollout.advance() {}
        let evaluation = rollout.evaluation();
        // Who is disqualified there has got nowhere; nor does it pay where energy costs.
        if evaluation.disqualified.is_some() {
            at_start.min(evaluation.fitness)
        } else {
            evaluation.fitness
        }
    }));
    Evaluation { fitness: repeats.counts.of(&fitnesses), ..nominal }
}

fn finished(mut rollout: Rollout) -> Evaluation {
    while rollout.advance() {}
    rollout.evaluation()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::genome::{Controller, GenomeSpace};
    use crate::rng::{Purpose, stream};

    fn newborn(individual: u32, trial: &Trial) -> Genome {
        let mut rng = stream(1, 1, individual, Purpose::Birth);
        GenomeSpace::default().birth(trial.descent(), &mut rng)
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
        let Controller::Signal(signals) = &mut genome.controller else { panic!("no signals") };
        signals.all_mut().for_each(|signal| signal.fill(0.0));
        let evaluation = evaluate(&genome, &trial);
        assert_eq!(evaluation.disqualified, None);
        assert_eq!(evaluation.steps, 300);
        assert!((evaluation.fitness - trial.start_y_m).abs() < 0.01, "{evaluation:?}");
    }
}
