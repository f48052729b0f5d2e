//! Scoring a genome: its evaluation, and the experience of its episode.

use std::collections::VecDeque;

use super::{Evaluation, Rollout, Trial};
use crate::genome::Genome;
use crate::learn::Episode;
use crate::world::{LANES, LanesCommon, LockStep};

/// The result of scoring a genome.
#[derive(Debug, Clone, PartialEq)]
pub struct Scored {
    /// Evaluation of the genome.
    pub evaluation: Evaluation,
    /// Experience of the nominal trial, for a controller that learns from it; otherwise `None`.
    pub episode: Option<Episode>,
}

/// A genome during its scoring, with the results of its trials so far.
struct Scoring<'a> {
    genome: &'a Genome,
    trial: &'a Trial,
    /// Result of the nominal trial; `None` before its end.
    nominal: Option<Scored>,
    /// Fitness of each trial, beginning with the nominal one; `None` for a trial that has not ended.
    fitnesses: Vec<Option<f32>>,
}

/// A running trial of a genome.
struct TrialRun {
    /// Number of the trial; the nominal one is 0.
    number: u32,
    rollout: Rollout,
    /// Fitness at the start of the trial; only computed for perturbed trials.
    at_start: f32,
}

impl<'a> Scoring<'a> {
    fn of(genome: &'a Genome, trial: &'a Trial) -> Self {
        Self { genome, trial, nominal: None, fitnesses: Vec::new() }
    }

    /// Begins trial number `number`.
    fn begin(&self, number: u32) -> TrialRun {
        let (genome, trial) = (self.genome, self.trial);
        if number == 0 {
            return TrialRun { number, rollout: Rollout::new(genome, trial), at_start: 0.0 };
        }
        let repeats = &trial.repeats;
        let mut rng = repeats.stream(genome.hash(), number);
        let perturbation = repeats.off.draw(trial.duration_s, trial.agent.limbs, &mut rng);
        let rollout = Rollout::perturbed(genome, trial, &perturbation);
        let at_start = rollout.evaluation().fitness;
        TrialRun { number, rollout, at_start }
    }

    /// Takes in the result of a trial that has ended.
    fn take_in(&mut self, run: &mut TrialRun) {
        let evaluation = run.rollout.evaluation();
        if run.number == 0 {
            self.nominal = Some(Scored { evaluation, episode: run.rollout.finish() });
            self.fitnesses = vec![None; self.trial.simulations_of(&evaluation) as usize];
        }
        // A disqualified trial scores at most its fitness at the start. With a cost of energy, it may score less.
        let fitness = if run.number > 0 && evaluation.disqualified.is_some() {
            run.at_start.min(evaluation.fitness)
        } else {
            evaluation.fitness
        };
        if let Some(slot) = self.fitnesses.get_mut(run.number as usize) {
            *slot = Some(fitness);
        }
    }

    /// Returns the numbers of the perturbed trials, which are made if the nominal trial ended without disqualification. It must be called
    /// after the end of the nominal trial.
    fn perturbed(&self) -> std::ops::Range<u32> {
        1..self.fitnesses.len() as u32
    }

    /// Returns the result after the end of all trials; `None` before.
    fn outcome(&self) -> Option<Scored> {
        let fitnesses: Vec<f32> = self.fitnesses.iter().copied().collect::<Option<_>>()?;
        let nominal = self.nominal.as_ref()?;
        if fitnesses.len() == 1 {
            return Some(nominal.clone());
        }
        let fitness = self.trial.repeats.counts.of(&fitnesses);
        let evaluation = Evaluation { fitness, ..nominal.evaluation };
        Some(Scored { evaluation, episode: nominal.episode.clone() })
    }
}

/// Scores a genome: runs its nominal trial to the end, and then the perturbed trials that the settings demand. Of the perturbed trials,
/// only the fitness counts: see [`super::Repeats`].
///
/// The perturbations are derived from the genome's own bits, from a fixed seed, or from the number of a generation's list, which the trial
/// contains. A champion's file is therefore enough to score it again.
pub fn score(genome: &Genome, trial: &Trial) -> Scored {
    let mut scored = Vec::with_capacity(1);
    score_together(&[(genome, trial)], || true, |_, found| scored.push(found));
    // Each job is reported exactly once.
    scored.remove(0)
}

/// Scores several genomes, each in its trial, with the same results as [`score`]. `report` gets each result with the index of its job, in
/// the order in which the jobs end. If the physics engine can step several snakes side by side, their trials run side by side. Before each
/// trial it calls `goes_on`, and returns without further results if that is false.
pub fn score_together(
    jobs: &[(&Genome, &Trial)],
    goes_on: impl FnMut() -> bool,
    report: impl FnMut(usize, Scored),
) {
    score_in(LockStep::default(), jobs, goes_on, report);
}

/// Does what [`score_together`] does, with this lock step for trials that run side by side.
fn score_in(
    mut lock_step: LockStep,
    jobs: &[(&Genome, &Trial)],
    mut goes_on: impl FnMut() -> bool,
    mut report: impl FnMut(usize, Scored),
) {
    let mut scorings: Vec<_> =
        jobs.iter().map(|(genome, trial)| Scoring::of(genome, trial)).collect();
    let mut queue = TrialQueue::of(jobs.len());
    let mut together: Vec<(usize, TrialRun)> = Vec::with_capacity(LANES);
    loop {
        while together.len() < LANES {
            let beside = together.first().map(|(_, run)| run.rollout.common());
            if beside == Some(None) {
                // Rapier takes each step alone, so no second trial is added.
                break;
            }
            if queue.is_empty() {
                break;
            }
            if !goes_on() {
                return;
            }
            let Some(next) = queue.next_beside(beside.as_ref(), &scorings) else { break };
            together.push(next);
        }
        if together.is_empty() {
            return;
        }
        advance(&mut together, &mut lock_step);
        let mut index = 0;
        while index < together.len() {
            if !together[index].1.rollout.is_over() {
                index += 1;
                continue;
            }
            let (job, mut run) = together.swap_remove(index);
            let scoring = &mut scorings[job];
            scoring.take_in(&mut run);
            if run.number == 0 {
                queue.add_perturbed(job, scoring);
            }
            if let Some(scored) = scoring.outcome() {
                report(job, scored);
            }
        }
    }
}

/// Trials that still have to run.
struct TrialQueue {
    /// Index of the job and number of the trial. Perturbed trials are added after the nominal trial of their genome.
    waiting: VecDeque<(usize, u32)>,
    /// Trials that have been built, but could not run beside the running trials.
    set_aside: Vec<(usize, TrialRun)>,
}

/// Maximum number of trials in `set_aside`.
const MOST_SET_ASIDE: usize = 4 * LANES;

impl TrialQueue {
    /// Creates a queue of the nominal trials of this number of jobs.
    fn of(jobs: usize) -> Self {
        let waiting = (0..jobs).map(|job| (job, 0)).collect();
        Self { waiting, set_aside: Vec::new() }
    }

    fn is_empty(&self) -> bool {
        self.waiting.is_empty() && self.set_aside.is_empty()
    }

    /// Adds the perturbed trials of a genome, in front of other genomes, so that results come roughly in the order of the jobs.
    fn add_perturbed(&mut self, job: usize, scoring: &Scoring<'_>) {
        for number in scoring.perturbed().rev() {
            self.waiting.push_front((job, number));
        }
    }

    /// Returns the next trial that can run beside trials with these common settings; `beside` is `None` if none runs, and then any trial
    /// fits.
    fn next_beside(
        &mut self,
        beside: Option<&Option<LanesCommon>>,
        scorings: &[Scoring<'_>],
    ) -> Option<(usize, TrialRun)> {
        let fits = |run: &TrialRun| beside.is_none_or(|beside| *beside == run.rollout.common());
        if let Some(index) = self.set_aside.iter().position(|(_, run)| fits(run)) {
            return Some(self.set_aside.remove(index));
        }
        while self.set_aside.len() < MOST_SET_ASIDE {
            let (job, number) = self.waiting.pop_front()?;
            let run = scorings[job].begin(number);
            if fits(&run) {
                return Some((job, run));
            }
            self.set_aside.push((job, run));
        }
        None
    }
}

/// Least number of trials for which a step of all lanes takes less time than a step of each trial alone.
const WORTH_A_LOCK_STEP: usize = 3;

/// Advances trials by one step; in rapier, which takes each step alone, to their ends.
fn advance(together: &mut [(usize, TrialRun)], lock_step: &mut LockStep) {
    let rollouts = together.iter_mut().map(|(_, run)| &mut run.rollout);
    let mut running: Vec<&mut Rollout> = rollouts.filter(|rollout| !rollout.is_over()).collect();
    if running.first().is_some_and(|rollout| rollout.common().is_none()) {
        for rollout in running {
            while rollout.advance() {}
        }
    } else if running.len() < WORTH_A_LOCK_STEP {
        for rollout in running {
            rollout.advance();
        }
    } else {
        Rollout::advance_together(&mut running, lock_step);
    }
}

/// Returns the evaluation of a genome: see [`score`].
pub fn evaluate(genome: &Genome, trial: &Trial) -> Evaluation {
    score(genome, trial).evaluation
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::{Purpose, stream};
    use crate::score::PerturbationList;
    use crate::world::{PhysicsEngine, VectorLevel};

    /// Returns snakes of three and five limbs in the engine *lanes*, on stairs in front of them. Some are disqualified before their trials
    /// end.
    fn jobs() -> Vec<(Genome, Trial)> {
        let job = |individual: u32| {
            let mut trial = Trial { duration_s: 2.0, ..Trial::default() };
            trial.physics.engine = PhysicsEngine::Lanes;
            trial.stairs.first_riser_y_m = -2.0;
            trial.agent.limbs = if individual % 5 == 4 { 3 } else { 5 };
            trial.surface.bounce = if individual % 2 == 1 { 0.5 } else { 0.0 };
            trial.surface.slip_m_s_per_n = if individual % 3 == 1 { 0.01 } else { 0.0 };
            trial.surface.soft_cfm_m_s_per_n = if individual % 4 == 1 { 0.01 } else { 0.0 };
            if individual % 7 == 3 {
                (trial.repeats.trials, trial.repeats.list) = (3, PerturbationList::Fixed);
                trial.repeats.off.step_rate = 0.2;
            }
            (trial.random_genome(individual), trial)
        };
        (0..30).map(job).collect()
    }

    fn together(jobs: &[&(Genome, Trial)]) -> Vec<Option<Scored>> {
        together_in(LockStep::default(), jobs)
    }

    fn together_in(lock_step: LockStep, jobs: &[&(Genome, Trial)]) -> Vec<Option<Scored>> {
        let pairs: Vec<_> = jobs.iter().map(|(genome, trial)| (genome, trial)).collect();
        let mut found = vec![None; jobs.len()];
        score_in(lock_step, &pairs, || true, |index, scored| found[index] = Some(scored));
        found
    }

    #[test]
    fn in_lanes_a_snake_has_the_same_bits_with_every_set_of_vector_instructions() {
        let jobs = jobs();
        let alone: Vec<_> = jobs.iter().map(|(genome, trial)| Some(score(genome, trial))).collect();
        let jobs: Vec<_> = jobs.iter().collect();
        for level in VectorLevel::all() {
            let found = together_in(LockStep::at(level), &jobs);
            assert_eq!(found, alone, "{}", level.name());
        }
    }

    #[test]
    fn in_lanes_a_snake_has_the_same_bits_alone_and_beside_any_others() {
        let jobs = jobs();
        let alone: Vec<_> = jobs.iter().map(|(genome, trial)| Some(score(genome, trial))).collect();
        let is_over_early = |scored: &Option<Scored>| {
            scored.as_ref().is_some_and(|scored| scored.evaluation.disqualified.is_some())
        };
        let early = alone.iter().filter(|scored| is_over_early(scored)).count();
        assert!(early > 3 && early < 27, "{early} of 30 are disqualified");
        assert_eq!(together(&jobs.iter().collect::<Vec<_>>()), alone);
        let reversed = together(&jobs.iter().rev().collect::<Vec<_>>());
        assert_eq!(reversed.into_iter().rev().collect::<Vec<_>>(), alone);
        for beside in 2..=9 {
            let few: Vec<_> = jobs.iter().take(beside).collect();
            assert_eq!(together(&few), alone[..beside]);
        }
    }

    /// Creatures and soft snakes of many shapes run beside those of the same shape.
    #[test]
    fn in_lanes_bodies_of_all_kinds_have_the_same_bits_alone_and_in_a_batch() {
        let mut jobs = Vec::new();
        for (preset, count) in [("creatures", 24), ("squishy", 4), ("bodies", 6)] {
            let settings = crate::save::load_preset(preset).expect("shipped").settings;
            let mut trial = Trial { duration_s: 1.0, ..settings.trial };
            trial.physics.engine = PhysicsEngine::Lanes;
            for individual in 0..count {
                let mut rng = stream(1, 1, individual, Purpose::Birth);
                let genome = settings.genome.random_genome(trial.genome_shape(), &mut rng);
                jobs.extend(std::iter::repeat_n((genome, trial.clone()), 2));
            }
        }
        let alone: Vec<_> = jobs.iter().map(|(genome, trial)| Some(score(genome, trial))).collect();
        let healthy = |scored: &&Option<Scored>| {
            scored.as_ref().is_some_and(|scored| scored.evaluation.disqualified.is_none())
        };
        assert!(alone.iter().filter(healthy).count() > 20);
        assert_eq!(together(&jobs.iter().collect::<Vec<_>>()), alone);
    }

    #[test]
    fn a_batch_ends_without_further_results_when_it_is_told_to() {
        let jobs = jobs();
        let pairs: Vec<_> = jobs.iter().map(|(genome, trial)| (genome, trial)).collect();
        let (mut begun, mut reported) = (0, 0);
        let goes_on = || {
            begun += 1;
            begun <= 12
        };
        score_together(&pairs, goes_on, |_, _| reported += 1);
        assert!(reported < 12, "{reported}");
        assert_eq!(begun, 13);
    }

    #[test]
    fn rapier_scores_together_what_it_scores_alone() {
        let mut jobs = jobs();
        jobs.truncate(6);
        jobs.iter_mut().for_each(|(_, trial)| trial.physics.engine = PhysicsEngine::Rapier);
        let alone: Vec<_> = jobs.iter().map(|(genome, trial)| Some(score(genome, trial))).collect();
        assert_eq!(together(&jobs.iter().collect::<Vec<_>>()), alone);
    }
}
