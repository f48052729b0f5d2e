//! Lanes that replace earlier ones and reuse their computed steps, and lanes of an earlier scene.

use std::sync::Arc;

use super::{Lane, Readings, Replay, StagedChampion};
use snakes_core::score::Rollout;
use snakes_lab::run::Lookahead;

impl Lane {
    /// Returns whether the computed steps of this lane can be reused for a lane with this champion.
    pub fn suits(&self, staged: &StagedChampion) -> bool {
        !self.is_ghost && !self.is_broken && self.staged == *staged
    }

    /// Creates a lane like this one at the start of a replay. The new lane takes over the lookahead of this one.
    pub fn renewed(&mut self) -> Self {
        let lookahead = std::mem::take(&mut self.lookahead);
        Self {
            is_checked: self.is_checked,
            ..Self::with(self.staged.clone(), self.number, lookahead)
        }
    }

    /// Continues the lane from the original's state at the time of the change. The lane's own past is simulated only
    /// when the user goes back to it.
    pub fn after_change(mut self, original: &Lane) -> Self {
        let step = self.staged.changes_at_step();
        let state = step.map(|step| original.rollout_at(step));
        if let Some(rollout) = state.and_then(|state| self.staged.continued_from(state)) {
            self.replay = Replay::Simulated(Box::new(rollout));
            self.before = self.replay.poses().to_vec();
            self.readings = Readings::new(&self.replay, self.trial().physics.steps_per_s);
        }
        self
    }

    /// Copies the lane in its present state, with the effect of all pulls, for a scene that may come back.
    pub fn kept(&self) -> Self {
        Self {
            staged: self.staged.clone(),
            body: self.body.clone(),
            replay: self.replay.clone(),
            lookahead: self.lookahead.kept(),
            before: self.before.clone(),
            readings: self.readings.clone(),
            detour_m: self.detour_m.clone(),
            is_back: true,
            ..*self
        }
    }

    /// Begins the lookahead of a kept lane again, unless it is complete or the lane needs none.
    pub fn back(self) -> Self {
        let needs_none = self.is_ghost || self.history().is_some();
        if needs_none || self.staged.recording().is_some() {
            return self;
        }
        Self { lookahead: Lookahead::of(self.staged.rollout()), ..self }
    }

    /// Returns the undisturbed rollout after `step` steps, simulated by this engine.
    pub fn rollout_at(&self, step: u32) -> Rollout {
        self.replay.rollout_at(step, &self.staged, self.history().map(Arc::as_ref))
    }

    /// Returns whether this lane can replace `other` unnoticed: the same snake in the same world at the same place.
    pub fn is_like(&self, other: &Self) -> bool {
        let of = |lane: &Self| (lane.number, lane.is_ghost, lane.offset_x_m);
        of(self) == of(other) && self.staged == other.staged
    }
}
