//! One genome in one trial, step by step.

#[cfg(test)]
mod audit;
mod continued;

use std::collections::VecDeque;
use std::sync::Arc;

use xxhash_rust::xxh3::Xxh3Default;

use super::behaviour::{BehaviourMoment, BehaviourObserver};
use super::ending::{Ending, Watch};
use super::faults::{FaultyDrives, SidePushes};
use super::fitness::FinalState;
use super::trial::steps_in;
use super::way_up::WayUp;
use super::{Evaluation, Fitness, Perturbation, Trial};
use crate::control::{ActiveSenses, Activity, ControlLoop, Perception};
use crate::genome::Genome;
use crate::learn::Episode;
use crate::world::{
    BodyPlan, Disqualification, JointTorque, LanesCommon, LockStep, Pose, Pull, Shove, Simulation,
    Stairs, Vector, WorldPlan,
};
use continued::{Conditions, TrialChange};

/// Time at the end of a trial whose scores make the fitness, in s. A snake that is thrown up the stairs in the last instant has not
/// climbed them.
const SCORED_S: f32 = 0.5;

/// A rollout in progress. A clone continues with the same bits as the original.
///
/// Its trial can change on the way, to show what would have happened: see [`Rollout::changing_at`].
#[derive(Clone)]
pub struct Rollout {
    simulation: Simulation,
    control: ControlLoop,
    torques: Vec<JointTorque>,
    poses: Vec<Pose>,
    conditions: Arc<Conditions>,
    /// Change of the trial that is still to come; `None` without one.
    change: Option<TrialChange>,
    /// Shove that is still to come; `None` without one.
    shove: Option<Shove>,
    /// Pushes from the side in a perturbed trial.
    pushes: Option<SidePushes>,
    /// Drives that do not do what the controller commands, in a perturbed trial.
    drives: Option<FaultyDrives>,
    frequency_hz: f32,
    observer: BehaviourObserver,
    furthest_y_m: f32,
    /// Progress of the body over the stairs, which is observed if the fitness depends on it.
    way: WayUp,
    /// Observes how the trial ends.
    watch: Watch,
    /// Scores of the last [`SCORED_S`], the earliest first.
    recent: VecDeque<f32>,
    trace: Xxh3Default,
    step: u32,
    disqualified: Option<Disqualification>,
}

impl Rollout {
    /// Builds the trial's world with the genome's body. Genome and trial must have passed their checks.
    pub fn new(genome: &Genome, trial: &Trial) -> Self {
        Self::in_world(genome, trial, trial.world_plan(genome))
    }

    /// Builds a perturbed form of the trial's world with the genome's body. Genome and trial must have passed their
    /// checks.
    pub fn perturbed(genome: &Genome, trial: &Trial, perturbation: &Perturbation) -> Self {
        let mut plan = trial.world_plan(genome);
        perturbation.apply(&mut plan);
        let mut rollout = Self::in_world(genome, trial, plan);
        rollout.pushes = perturbation.pushes;
        let joints = rollout.body().joints.len();
        rollout.drives = perturbation.drives.map(|faults| FaultyDrives::new(faults, joints));
        rollout.shove = perturbation.shove.map(|shove| {
            // The limb was drawn for the number of limbs of the trial. A body from the genome is shoved at the same share of its length.
            let (own, drawn_for) = (rollout.body().limbs(), trial.agent.limbs.max(1) as usize);
            let is_own = genome.body.has_own_blocks();
            let limb = if is_own { shove.limb * own / drawn_for } else { shove.limb };
            Shove { limb, ..shove }
        });
        rollout
    }

    fn in_world(genome: &Genome, trial: &Trial, plan: WorldPlan) -> Self {
        let mut simulation = Simulation::new(&plan);
        let settled = if plan.settles { simulation.settle() } else { Ok(()) };
        let poses: Vec<Pose> = simulation.poses().collect();
        let mut rollout = Self {
            control: ControlLoop::new(genome, &plan, trial.agent.senses),
            torques: vec![JointTorque::default(); plan.body.joints.len()],
            way: WayUp::begin(&plan.body, &poses, &plan.stairs),
            watch: Watch::new(&plan.body, &plan.stairs, plan.physics.gravity_m_s2),
            poses,
            simulation,
            conditions: Arc::new(Conditions::of(trial, plan)),
            change: None,
            shove: None,
            pushes: None,
            drives: None,
            frequency_hz: genome.controller.frequency_hz(),
            observer: BehaviourObserver::default(),
            furthest_y_m: f32::MIN,
            recent: VecDeque::new(),
            trace: Xxh3Default::new(),
            step: 0,
            disqualified: settled.err(),
        };
        rollout.furthest_y_m = rollout.middle_m().y;
        rollout
    }

    /// Takes one step, unless the rollout is over. Returns whether it took a healthy step.
    pub fn advance(&mut self) -> bool {
        if self.is_over() {
            return false;
        }
        self.begin_step();
        self.take_step()
    }

    /// Takes one step of each rollout, side by side, with the same bits as each alone. None of the rollouts may be over, and all their
    /// worlds must have the same [`Simulation::common`].
    pub(crate) fn advance_together(rollouts: &mut [&mut Self], lock_step: &mut LockStep) {
        for rollout in rollouts.iter_mut() {
            rollout.begin_step();
        }
        let mut worlds: Vec<_> = rollouts
            .iter_mut()
            .map(|rollout| (&mut rollout.simulation, rollout.torques.as_slice()))
            .collect();
        let ends = lock_step.step(&mut worlds);
        for (rollout, end) in rollouts.iter_mut().zip(ends) {
            rollout.take_in_step(end);
        }
    }

    /// Returns the settings and sizes that the world must have in common with those beside which it advances; `None` if its engine takes
    /// each step alone.
    pub(crate) fn common(&self) -> Option<LanesCommon> {
        self.simulation.common()
    }

    /// Takes one step, unless the rollout is over, with torques from outside instead of those of the genome's controller, one per joint
    /// from the head. A joint without a torque is not driven. Returns whether it took a healthy step. The evaluation then describes the
    /// controller outside.
    pub fn advance_with(&mut self, torques: &[JointTorque]) -> bool {
        if self.is_over() {
            return false;
        }
        self.enter_step();
        self.torques.fill(JointTorque::default());
        for (kept, torque) in self.torques.iter_mut().zip(torques) {
            *kept = *torque;
        }
        self.distort_torques();
        self.take_step()
    }

    /// Applies what is due before this step, and computes the torques of the step.
    fn begin_step(&mut self) {
        self.enter_step();
        self.control.act(self.step, &self.simulation, &mut self.torques);
        self.distort_torques();
    }

    /// Replaces the commanded torques by those that arrive at the joints.
    fn distort_torques(&mut self) {
        if let Some(drives) = &mut self.drives {
            drives.distort(&mut self.torques, &self.simulation.body().joints);
        }
    }

    /// Applies changes and shoves that are due before this step.
    fn enter_step(&mut self) {
        self.enter_change();
        let now_s = self.time_s();
        if let Some(shove) = self.shove.take_if(|shove| shove.at_s <= now_s) {
            self.simulation.shove(&shove);
        }
        if let Some(pushes) = self.pushes {
            let steps_per_s = self.conditions.world.physics.steps_per_s;
            let push = pushes.due(self.step, steps_per_s, self.body().limbs());
            push.into_iter().for_each(|push| self.simulation.shove(&push));
        }
    }

    /// Steps the world with the torques of this step, and returns whether the step was healthy.
    fn take_step(&mut self) -> bool {
        let end = self.simulation.step(&self.torques);
        self.take_in_step(end)
    }

    /// Takes in the result of a step, and returns whether the step was healthy.
    fn take_in_step(&mut self, end: Result<(), Disqualification>) -> bool {
        if let Err(reason) = end {
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
        self.furthest_y_m = self.furthest_y_m.max(self.middle_m().y);
        self.observer.observe(&self.simulation, &self.conditions.world.stairs);
        let now_s = self.time_s();
        let flies = !self.simulation.parts().iter().any(|part| part.touch.any());
        self.watch.observe(now_s, &self.poses, self.simulation.parts_on_stairs(), flies);
        if self.conditions.fitness == Fitness::Share {
            let stairs = &self.conditions.world.stairs;
            self.way.observe(self.simulation.body(), &self.poses, stairs, now_s);
        }
        self.remember_score();
        true
    }

    /// Returns whether the trial's time is up or the agent is disqualified.
    pub fn is_over(&self) -> bool {
        self.step >= self.last_step() || self.disqualified.is_some()
    }

    /// Returns the poses of the parts after the last healthy step, from the head.
    pub fn poses(&self) -> &[Pose] {
        &self.poses
    }

    /// Returns the number of healthy steps taken so far.
    pub fn step(&self) -> u32 {
        self.step
    }

    /// Returns the simulated time so far, in s.
    pub fn time_s(&self) -> f32 {
        self.step as f32 * self.conditions.world.physics.step_s()
    }

    /// Returns the evaluation of the steps so far; after the end, this is the result.
    pub fn evaluation(&self) -> Evaluation {
        let effort = self.simulation.effort();
        let middle = self.middle_m();
        let world = &self.conditions.world;
        let moment = BehaviourMoment {
            middle_m: middle.to_array(),
            start_y_m: world.middle_start_y_m(),
            weight_n: self.body().mass_kg() * world.physics.gravity_m_s2,
            energy_j: effort.energy_j,
            frequency_hz: self.frequency_hz,
            wave_uses: self.control.wave_uses(),
        };
        let behaviour = self.observer.behaviour(self.stairs(), &moment);
        Evaluation {
            fitness: self.fitness(),
            centre_y_m: middle.y,
            disqualified: self.disqualified,
            trace_hash: self.trace.digest(),
            steps: self.step,
            effort: Some(effort),
            behaviour: Some(behaviour),
            ending: Some(self.ending()),
        }
    }

    /// Returns how the trial ended, if it ends now.
    pub fn ending(&self) -> Ending {
        self.watch.ending(self.disqualified, &self.poses)
    }

    /// Returns the fitness of the evaluation so far: by the trial's measure over the last half second, less the cost of energy.
    pub fn fitness(&self) -> f32 {
        let Conditions { fitness, energy_cost_per_kj, world, .. } = &*self.conditions;
        let cost = energy_cost_per_kj * self.simulation.effort().energy_j / 1000.0;
        let score = fitness.over(&self.recent).unwrap_or_else(|| self.score());
        let score = match fitness {
            Fitness::Share => {
                let duration_s = self.last_step() as f32 * world.physics.step_s();
                score + self.way.bonus(duration_s)
            }
            _ => score,
        };
        score - cost
    }

    /// Returns the score of the present state alone, by the trial's measure of fitness and without the cost of energy.
    pub fn score(&self) -> f32 {
        let state = FinalState {
            body: self.body(),
            poses: &self.poses,
            furthest_y_m: self.furthest_y_m,
            stairs: self.stairs(),
            way: &self.way,
            touched_steps: self.watch.touched(),
        };
        state.score(self.conditions.fitness)
    }

    /// Stores the score of the present state, and removes those from more than [`SCORED_S`] ago.
    fn remember_score(&mut self) {
        let scored = steps_in(SCORED_S, &self.conditions.world.physics) as usize;
        while self.recent.len() >= scored {
            self.recent.pop_front();
        }
        self.recent.push_back(self.score());
    }

    /// Sets or ends the user's pull on a part, from the next step on. A pull disturbs the rollout for good: its result no longer describes
    /// the genome.
    pub fn pull(&mut self, pull: Option<Pull>) {
        self.simulation.pull(pull);
    }

    /// Returns whether the user has pulled a part during the rollout.
    pub fn is_disturbed(&self) -> bool {
        self.simulation.is_disturbed()
    }

    /// Returns the number of steps of the whole rollout, unless the agent is disqualified earlier.
    pub fn last_step(&self) -> u32 {
        // If the trial changes, the duration of the new trial counts.
        self.change.as_ref().map_or(self.conditions.last_step, |change| change.to.last_step)
    }

    /// Returns the stairs of the present trial.
    pub fn stairs(&self) -> &Stairs {
        &self.conditions.world.stairs
    }

    /// Returns the built body.
    pub fn body(&self) -> &BodyPlan {
        self.simulation.body()
    }

    /// Returns the position of the middle limb's centre after the last healthy step, in metres.
    pub fn middle_m(&self) -> Vector {
        self.poses[self.body().middle_part].translation
    }

    /// Returns whether all steps of the stairs are under the middle limb now.
    pub fn is_on_landing(&self) -> bool {
        let steps = self.stairs().steps;
        steps > 0 && self.stairs().steps_under(self.middle_m().to_array()) == steps
    }

    /// Ends the episode and returns the experience of a controller that learns from it. `None` for other controllers, and for a disturbed
    /// rollout, from which nothing is learned.
    pub fn finish(&mut self) -> Option<Episode> {
        let is_disqualified = self.disqualified.is_some();
        let episode = self.control.finish(self.step, &self.simulation, is_disqualified);
        episode.filter(|_| !self.is_disturbed())
    }

    /// Returns the snake's perception before the last step; empty for a controller that does not sense its surroundings.
    pub fn perception(&self) -> &Perception {
        self.control.perception()
    }

    /// Returns the senses that work now.
    pub fn active_senses(&self) -> ActiveSenses {
        self.control.active_senses()
    }

    /// Returns the activity of the controller at a joint; the first joint is 0. `None` before the first step, and for a controller that
    /// has nothing to show.
    pub fn activity(&self, joint: usize) -> Option<Activity> {
        self.control.activity(joint)
    }

    /// Gives read access to the world.
    pub fn simulation(&self) -> &Simulation {
        &self.simulation
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::genome::ControllerGenes;
    use crate::score::evaluate;

    #[test]
    fn scoring_twice_gives_the_same_bits() {
        let trial = Trial::default();
        for individual in 0..5 {
            let genome = trial.random_genome(individual);
            assert_eq!(evaluate(&genome, &trial), evaluate(&genome, &trial));
        }
    }

    #[test]
    fn torques_from_outside_lead_to_the_same_evaluation() {
        let trial = Trial::default();
        let genome = trial.random_genome(2);
        let (mut inside, mut outside) =
            (Rollout::new(&genome, &trial), Rollout::new(&genome, &trial));
        while inside.advance() {
            assert!(outside.advance_with(&inside.torques));
            assert_eq!(outside.score(), inside.score());
        }
        // A joint without a torque is not driven.
        assert!(!outside.advance_with(&[]) && outside.is_over());
        assert_eq!(outside.evaluation(), inside.evaluation());
    }

    #[test]
    fn different_genomes_leave_different_traces() {
        let trial = Trial::default();
        let first = evaluate(&trial.random_genome(0), &trial);
        let second = evaluate(&trial.random_genome(1), &trial);
        assert_ne!(first.trace_hash, second.trace_hash);
    }

    #[test]
    fn without_torque_the_snake_stays_where_it_starts() {
        let trial = Trial::default();
        let mut genome = trial.random_genome(0);
        let ControllerGenes::Signal(signals) = &mut genome.controller else { panic!("no signals") };
        signals.all_mut().for_each(|signal| signal.fill(0.0));
        let evaluation = evaluate(&genome, &trial);
        assert_eq!(evaluation.disqualified, None);
        assert_eq!(evaluation.steps, 300);
        assert!((evaluation.fitness - trial.start_y_m).abs() < 0.01, "{evaluation:?}");
    }
}
