//! One snake on one staircase, advanced by one constant step at a time.
//!
//! All code that scores, replays, shows or tests a snake calls [`Simulation::step`].

use std::any::Any;
use std::borrow::Cow;

mod balance;
mod continued;
mod damping;
mod health_check;
pub(super) mod mirror;
pub(super) mod observe;
pub(super) mod patches;
pub(super) mod sensing;
mod settle;
mod shove;
mod torques;

use super::damping::HalfStepDamping;
use super::energy::EnergyBalance;
use super::engine::{PartState, WorldEngine};
use super::lanes::{LaneSolver, LanesWorld};
use super::stair_profile::StairProfile;
use super::torque::{AppliedTorque, JointTorque};
use super::{
    BodyPlan, Disqualification, Effort, LANES, LanesCommon, PartPlan, PhysicsEngine, Pull,
    RapierWorld, Vector, VectorLevel, WorldPlan,
};

/// A running world. A clone continues with the same bits as the original.
#[derive(Clone)]
pub struct Simulation {
    engine: Box<dyn WorldEngine>,
    plan: WorldPlan,
    profile: StairProfile,
    damping: HalfStepDamping,
    /// Share of the joints' damping that acts as an explicit torque, outside the solver.
    damping_as_torque: f32,
    /// Moments of inertia of each part about its own axes, in kg·m².
    inertias_kg_m2: Vec<Vector>,
    arena_front_y_m: f32,
    /// Torque of the joints' drives on each part, in N·m.
    torques_in_world: Vec<Vector>,
    /// Torque of the joints' damping on each part, in N·m. It is added to the torque of the drives.
    damping_in_world: Vec<Vector>,
    applied: Vec<AppliedTorque>,
    effort: Effort,
    balance: EnergyBalance,
    /// The user's pull on a part, or `None`. `was_pulled` tells whether there was a pull in the last step.
    pull: Option<Pull>,
    was_pulled: bool,
    /// Whether the user has ever pulled a part.
    is_disturbed: bool,
    /// The parts before the last step of the engine.
    earlier: Vec<PartState>,
    /// Angular velocities of the limbs at the beginning of the last step, on average over it, and at its end. The memory is reused.
    rates: Vec<[Vector; 3]>,
}

impl Simulation {
    /// Builds the world of a plan, in the engine that the plan names.
    pub fn new(plan: &WorldPlan) -> Self {
        let parts = plan.body.parts.len();
        let mut simulation = Self {
            engine: match plan.physics.engine {
                PhysicsEngine::Rapier => Box::new(RapierWorld::new(plan)),
                PhysicsEngine::Lanes => Box::new(LanesWorld::new(plan)),
            },
            profile: StairProfile::of(&plan.stairs),
            damping: HalfStepDamping::of_rates(
                plan.body.angular_damping_per_s,
                plan.surface.dampen_per_s,
                plan.ground.dampen_per_s,
                plan.physics.step_s(),
            ),
            damping_as_torque: 1.0 - plan.physics.joint_damping_in_solver(),
            inertias_kg_m2: plan.body.parts.iter().map(PartPlan::inertia_kg_m2).collect(),
            arena_front_y_m: plan.stairs.end_y_m() + 10.0,
            torques_in_world: vec![Vector::ZERO; parts],
            damping_in_world: vec![Vector::ZERO; parts],
            applied: vec![AppliedTorque::default(); plan.body.joints.len()],
            effort: Effort::default(),
            balance: EnergyBalance::default(),
            pull: None,
            was_pulled: false,
            is_disturbed: false,
            earlier: Vec::with_capacity(parts),
            rates: Vec::with_capacity(parts),
            plan: plan.clone(),
        };
        simulation.begin_balance();
        simulation
    }

    /// Applies the torques, one per joint, clamped to each joint's limits, and advances the world by one
    /// step.
    ///
    /// # Errors
    /// Returns the reason if this step disqualified the agent. The world must not be stepped any further then.
    pub fn step(&mut self, torques: &[JointTorque]) -> Result<(), Disqualification> {
        self.apply(torques);
        self.advance();
        self.take_in_step()
    }

    /// Checks the state after a step, and adds the effort of the step to the total.
    fn take_in_step(&mut self) -> Result<(), Disqualification> {
        let mut effort = match self.check_health() {
            // No trial contains a pull, so the limits of a trial do not end it.
            Err(limit) if self.is_disturbed && limit != Disqualification::NotFinite => {
                return Ok(());
            }
            checked => checked?,
        };
        let motion_j = self.motion_energy_j();
        self.balance.motion_j += motion_j;
        effort.energy_j = motion_j + self.holding_energy_j();
        let effort = self.effort.and(effort);
        if !self.balance.has_unknown_work
            && self.energy_lost().is_from_nothing(self.balance.motion_j)
        {
            return Err(Disqualification::EnergyFromNothing);
        }
        self.effort = effort;
        Ok(())
    }

    /// Returns the built body: its parts, joints, springs, sizes, masses and limits.
    pub fn body(&self) -> &BodyPlan {
        &self.plan.body
    }

    /// Returns the effort of the healthy steps so far.
    pub fn effort(&self) -> Effort {
        self.effort
    }

    /// Advances the engine by one step, and then slows the limbs by the damping of air and surfaces.
    pub(crate) fn advance(&mut self) {
        self.keep_parts();
        self.engine.step();
        self.finish_step();
    }

    /// Keeps the state of the parts before a step of the engine.
    fn keep_parts(&mut self) {
        self.earlier.clear();
        self.earlier.extend_from_slice(self.engine.parts());
    }

    /// Completes a step of the engine: the energy balance, bounces and the damping of its second half.
    fn finish_step(&mut self) {
        self.add_to_balance();
        self.engine.bounce(&self.earlier);
        self.dampen_half_step();
    }

    /// Applies torques and advances a world of rapier by one step of rapier alone, for benchmarks: without the laws of contacts that rapier
    /// does not know, and without energy balance and checks. Worlds of other engines stay as they are.
    pub fn step_bare(&mut self, torques: &[JointTorque]) {
        self.apply(torques);
        let engine: &mut dyn Any = &mut *self.engine;
        if let Some(rapier) = engine.downcast_mut::<RapierWorld>() {
            rapier.step_bare();
            self.dampen_half_step();
        }
    }

    /// Returns the state of the parts, in the order of the plan's parts.
    pub fn parts(&self) -> &[PartState] {
        self.engine.parts()
    }

    /// Changes the state of each part, given its index. From then on the energy balance is meaningless.
    pub fn change_parts(&mut self, change: impl FnMut((usize, &mut PartState))) {
        self.balance.has_unknown_work = true;
        self.engine.parts_mut().iter_mut().enumerate().for_each(change);
    }

    /// Returns the world in the form of rapier, for debug drawing and picking: itself in worlds of rapier, and otherwise a world of the
    /// same plan with its parts at the start.
    pub fn in_rapier(&self) -> Cow<'_, RapierWorld> {
        match self.rapier() {
            Some(rapier) => Cow::Borrowed(rapier),
            None => Cow::Owned(RapierWorld::new(&self.plan)),
        }
    }

    fn rapier(&self) -> Option<&RapierWorld> {
        let engine: &dyn Any = &*self.engine;
        engine.downcast_ref()
    }

    /// Sets or ends the user's pull on a part, from the next step on. A pulled snake no longer runs its trial, and only a state that is
    /// not finite ends the simulation.
    pub fn pull(&mut self, pull: Option<Pull>) {
        self.is_disturbed |= pull.is_some();
        self.pull = pull;
    }

    /// Returns whether the user has ever pulled a part.
    pub fn is_disturbed(&self) -> bool {
        self.is_disturbed
    }

    fn apply_pull(&mut self) {
        for part in self.engine.parts_mut() {
            part.force_n = Vector::ZERO;
        }
        self.was_pulled = false;
        let Some(pull) = self.pull else { return };
        let Some(part) = self.engine.parts_mut().get_mut(pull.part) else { return };
        pull.act_on(part, self.plan.body.parts[pull.part].mass_kg(), self.plan.physics.step_s());
        self.was_pulled = true;
        self.balance.has_unknown_work = true;
    }

    /// Returns the settings and sizes that all worlds of a lock step must have in common; `None` if the engine takes each step alone.
    pub(crate) fn common(&self) -> Option<LanesCommon> {
        LanesWorld::common_of(&*self.engine)
    }
}

/// Steps several worlds of the engine *lanes* side by side.
pub struct LockStep {
    solver: LaneSolver<LANES>,
}

impl Default for LockStep {
    fn default() -> Self {
        Self::at(VectorLevel::in_use())
    }
}

impl LockStep {
    /// Makes a lock step that computes with these vector instructions. They change no bit.
    pub fn at(level: VectorLevel) -> Self {
        Self { solver: LaneSolver::at(level) }
    }

    /// Advances up to [`LANES`] worlds by one step each, with the same bits and ends as [`Simulation::step`]. All worlds must have the same
    /// [`Simulation::common`].
    pub fn step(
        &mut self,
        worlds: &mut [(&mut Simulation, &[JointTorque])],
    ) -> [Result<(), Disqualification>; LANES] {
        debug_assert!(worlds.len() <= LANES, "more worlds than lanes");
        let mut chains = [const { None }; LANES];
        for (chain, (world, torques)) in chains.iter_mut().zip(worlds.iter_mut()) {
            world.apply(torques);
            world.keep_parts();
            *chain = LanesWorld::chain_of(&mut *world.engine);
        }
        self.solver.advance(&mut chains);
        let mut ends = [Ok(()); LANES];
        for (end, (world, _)) in ends.iter_mut().zip(worlds.iter_mut()) {
            world.finish_step();
            *end = world.take_in_step();
        }
        ends
    }
}

#[cfg(test)]
mod tests;
