//! A rollout whose trial changes on the way: moment and state stay the same, and the world becomes another.

use std::sync::Arc;

use super::Rollout;
use crate::control::ActiveSenses;
use crate::genome::Genome;
use crate::score::ending::Watch;
use crate::score::trial::steps_in;
use crate::score::way_up::WayUp;
use crate::score::{Fitness, Trial};
use crate::world::{Discontinuity, WorldPlan};

/// The conditions of a rollout: the values of its trial that are needed at every step.
pub(super) struct Conditions {
    pub world: WorldPlan,
    pub fitness: Fitness,
    pub energy_cost_per_kj: f32,
    pub senses: ActiveSenses,
    /// Number of steps of the whole rollout.
    pub last_step: u32,
}

impl Conditions {
    /// Extracts the conditions of a trial in this world.
    pub fn of(trial: &Trial, world: WorldPlan) -> Self {
        Self {
            last_step: steps_in(trial.duration_s, &world.physics),
            world,
            fitness: trial.fitness,
            energy_cost_per_kj: trial.energy_cost_per_kj,
            senses: trial.agent.senses,
        }
    }
}

/// New conditions that apply from a step on.
#[derive(Clone)]
pub(super) struct TrialChange {
    at_step: u32,
    pub to: Arc<Conditions>,
}

impl Rollout {
    /// Checks whether this rollout of a genome can continue in another trial, in its present state.
    ///
    /// # Errors
    /// Returns the reason if the rollout cannot continue.
    pub fn can_continue(&self, genome: &Genome, trial: &Trial) -> Result<(), Discontinuity> {
        let world = trial.world_plan(genome);
        self.simulation.can_continue(&self.conditions.world, &world)?;
        if self.is_over() || self.step >= trial.steps() {
            Err(Discontinuity::Duration)
        } else {
            Ok(())
        }
    }

    /// Returns this rollout of a genome with another trial from `step` on, which must not be in the past. Limbs, controller, energy and
    /// furthest position continue from their state at this step.
    ///
    /// The evaluation then belongs to no trial, and must not be compared with a record.
    ///
    /// # Errors
    /// Returns the reason if the worlds of the two trials can never continue one another. Whether other stairs are possible also depends
    /// on the moment: see [`Self::can_continue`].
    pub fn changing_at(
        mut self,
        step: u32,
        genome: &Genome,
        trial: &Trial,
    ) -> Result<Self, Discontinuity> {
        let to = Conditions::of(trial, trial.world_plan(genome));
        self.conditions.world.can_continue(&to.world)?;
        if step < self.step || step >= to.last_step {
            return Err(Discontinuity::Duration);
        }
        self.change = Some(TrialChange { at_step: step, to: Arc::new(to) });
        Ok(self)
    }

    /// Applies new conditions if their step has come.
    pub(super) fn enter_change(&mut self) {
        if let Some(change) = self.change.take_if(|change| change.at_step == self.step) {
            self.simulation = self.simulation.continued_in(&change.to.world);
            // Scores of different measures or on different stairs cannot be averaged.
            if self.conditions.fitness != change.to.fitness
                || self.conditions.world.stairs != change.to.world.stairs
            {
                self.recent.clear();
                let body = self.simulation.body();
                self.way = WayUp::begin(body, &self.poses, &change.to.world.stairs);
            }
            let WorldPlan { stairs, physics, .. } = &change.to.world;
            if self.conditions.world.stairs != *stairs {
                self.watch = Watch::new(self.simulation.body(), stairs, physics.gravity_m_s2);
            }
            self.watch.take_gravity(physics.gravity_m_s2);
            self.control.continue_in(&change.to.world.physics, change.to.senses);
            self.conditions = change.to;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::{Champion, Settings, with_fields};
    use crate::save::shipped_champion;

    fn champion() -> Champion {
        shipped_champion().expect("well formed").champion
    }

    /// Returns the champion's trial with other values.
    fn with(trial: &Trial, changes: &[(&str, &str)]) -> Trial {
        let settings = Settings { trial: trial.clone(), ..Settings::default() };
        with_fields(&settings, changes.iter().copied()).expect("allowed").trial
    }

    /// Returns a rollout after this number of steps.
    fn after(mut rollout: Rollout, step: u32) -> Rollout {
        while rollout.step() < step {
            assert!(rollout.advance());
        }
        rollout
    }

    /// Returns the evaluation at the end, whose trace covers the pose of every limb after every step.
    fn end(mut rollout: Rollout) -> crate::score::Evaluation {
        while rollout.advance() {}
        rollout.evaluation()
    }

    #[test]
    fn continued_in_an_unchanged_world_a_rollout_keeps_its_bits() {
        let Champion { genome, trial, evaluation, .. } = champion();
        for step in [0, 1, 200, 437, trial.steps() - 1] {
            let same = Rollout::new(&genome, &trial).changing_at(step, &genome, &trial);
            let found = end(same.expect("the same world"));
            assert!(found.agrees_with(&evaluation), "at step {step}: {found:?}");
            // Without the contacts that the engine holds, the end would differ.
            let given = after(Rollout::new(&genome, &trial), step);
            let given = given.changing_at(step, &genome, &trial).expect("the same world");
            assert!(end(given).agrees_with(&evaluation), "from step {step}");
        }
    }

    /// Changes that each replace another part of the engine's world.
    const CHANGES: [&[(&str, &str)]; 12] = [
        &[("surface.friction", "0.3")],
        &[("surface.bounce", "0.5")],
        &[("surface.soft_cfm_m_s_per_n", "0.001")],
        &[("surface.slip_m_s_per_n", "0.001")],
        &[("surface.dampen_per_s", "3")],
        &[("ground.soft_cfm_m_s_per_n", "0.001")],
        &[("gravity_m_s2", "1.6")],
        &[("agent.density_kg_m3", "7")],
        &[("agent.bend_limit_rad", "0.1")],
        &[("joint_damping_nms_per_rad", "3")],
        &[("angular_damping_per_s", "4")],
        &[("substeps", "9"), ("joint_cfm_m_s_per_n", "0.0001")],
    ];

    #[test]
    fn a_change_before_the_first_step_is_a_rollout_of_the_other_trial() {
        let Champion { genome, trial, .. } = champion();
        for changes in CHANGES {
            let other = with(&trial, changes);
            let changed = Rollout::new(&genome, &trial).changing_at(0, &genome, &other);
            let whole = Rollout::new(&genome, &other);
            assert_eq!(end(changed.expect("continues")), end(whole), "{changes:?}");
        }
    }

    #[test]
    fn until_the_change_a_rollout_is_the_original_and_then_every_change_has_an_effect() {
        let Champion { genome, trial, .. } = champion();
        let original = after(Rollout::new(&genome, &trial), 300);
        for changes in CHANGES {
            let other = with(&trial, changes);
            let changed = Rollout::new(&genome, &trial).changing_at(300, &genome, &other);
            let mut changed = after(changed.expect("continues"), 300);
            assert_eq!(changed.evaluation().trace_hash, original.evaluation().trace_hash);
            assert_eq!(original.can_continue(&genome, &other), Ok(()), "{changes:?}");
            let mut beside = original.clone();
            let speed =
                |rollout: &Rollout| -> Vec<f32> { rollout.simulation().speeds_m_s().collect() };
            assert_eq!(speed(&changed), speed(&beside));
            assert!(changed.advance() && beside.advance());
            // Limbs continue with their positions and velocities, so nothing jumps within a step.
            for (a, b) in changed.poses().iter().zip(beside.poses()) {
                assert!(a.translation.distance(b.translation) < 0.05, "{changes:?}");
            }
            while changed.advance() && beside.advance() {}
            assert_ne!(changed.poses(), beside.poses(), "{changes:?}");
        }
    }

    #[test]
    fn other_friction_takes_effect_at_once_on_limbs_that_rest() {
        // The engine recycles the contacts of resting limbs, with their friction.
        let Champion { genome, trial, .. } = champion();
        let still = with(&trial, &[("max_bend_torque_nm", "0"), ("max_twist_torque_nm", "0")]);
        let resting = after(Rollout::new(&genome, &still), 120);
        let slid_m = |friction: &str| {
            let pushed = with(&still, &[("surface.friction", friction)]);
            let mut pushed = resting.clone().changing_at(120, &genome, &pushed).expect("continues");
            assert!(pushed.advance());
            let from_m = pushed.middle_m();
            let push = crate::world::Vector::new(0.3, 0.0, 0.0);
            pushed.simulation.change_parts(|(_, part)| part.linear = push);
            (0..10).for_each(|_| assert!(pushed.advance()));
            pushed.middle_m().distance(from_m)
        };
        let (stuck_m, slid_m) = (slid_m("5"), slid_m("0"));
        assert!(slid_m > 0.045 && stuck_m < 0.01, "{slid_m} m on ice, {stuck_m} m on glue");
    }

    #[test]
    fn other_gravity_or_density_is_no_loss_and_no_gain_of_energy() {
        let Champion { genome, trial, .. } = champion();
        let given = after(Rollout::new(&genome, &trial), 200);
        let lost_j = given.simulation().energy_lost().total_j;
        for change in [
            ("trial.physics.gravity_m_s2", "3"),
            ("trial.agent.density_kg_m3", "8"),
            ("trial.stairs.rise_m", "0.4"),
        ] {
            let plan = with(&trial, &[change]).world_plan(&genome);
            let continued = given.simulation().continued_in(&plan);
            let difference_j = continued.energy_lost().total_j - lost_j;
            assert!(difference_j.abs() < 0.01, "{change:?}: {difference_j} J at the change");
        }
    }

    #[test]
    fn a_state_that_does_not_fit_the_other_trial_is_refused_with_the_reason() {
        let Champion { genome, trial, .. } = champion();
        let (early, late) = (
            after(Rollout::new(&genome, &trial), 10),
            after(Rollout::new(&genome, &trial), trial.steps() - 1),
        );
        for (changes, of_early, of_late) in [
            (("agent.limb_width_m", "2"), Err(Discontinuity::Body), Err(Discontinuity::Body)),
            (("steps_per_s", "61"), Err(Discontinuity::StepLength), Err(Discontinuity::StepLength)),
            (("trial.start_y_m", "-9"), Err(Discontinuity::Start), Err(Discontinuity::Start)),
            (("stairs.rise_m", "0.7"), Ok(()), Err(Discontinuity::Stairs)),
            (("trial.duration_s", "5"), Ok(()), Err(Discontinuity::Duration)),
            (("trial.duration_s", "20"), Ok(()), Ok(())),
        ] {
            let other = with(&trial, &[changes]);
            assert_eq!(early.can_continue(&genome, &other), of_early, "{changes:?} early");
            assert_eq!(late.can_continue(&genome, &other), of_late, "{changes:?} late");
        }
    }

    #[test]
    fn before_other_stairs_are_reached_the_snake_goes_on_towards_them() {
        let Champion { genome, trial, .. } = champion();
        let lower = with(&trial, &[("stairs.rise_m", "0.1")]);
        let mut rollout = after(Rollout::new(&genome, &trial), 10);
        let mut changed = rollout.clone().changing_at(10, &genome, &lower).expect("continues");
        assert!(changed.advance() && rollout.advance());
        assert_eq!(changed.stairs(), &lower.stairs);
        // At the stairs, the world is built anew, without the impulses of the engine's last step.
        for (a, b) in changed.poses().iter().zip(rollout.poses()) {
            let apart_m = a.translation.distance(b.translation);
            assert!(apart_m < 0.005, "{apart_m} m after a step");
        }
        while changed.advance() {}
        assert_eq!(changed.step(), lower.steps());
    }
}
