//! Lanes that take the places of earlier ones, with what those have already computed.

use std::sync::Arc;

use super::{Lane, Readings, Replay, StagedChampion};
use snakes_core::score::Rollout;

impl Lane {
    /// Whether what this lane has computed is also of use for a lane with this champion.
    pub fn suits(&self, staged: &StagedChampion) -> bool {
        !self.is_ghost && !self.is_broken && self.staged == *staged
    }

    /// This lane at the start of a replay. The new lane takes over the steps that this one has computed in advance.
    pub fn renewed(&mut self) -> Self {
        let lookahead = std::mem::take(&mut self.lookahead);
        Self {
            is_checked: self.is_checked,
            ..Self::with(self.staged.clone(), self.number, lookahead)
        }
    }

    /// The lane at the moment of its change, with the state of the original at that moment. Its own past is simulated
    /// only when it is sought.
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

    /// The undisturbed rollout after `step` steps, simulated by this engine.
    pub fn rollout_at(&self, step: u32) -> Rollout {
        self.replay.rollout_at(step, &self.staged, self.history().map(Arc::as_ref))
    }

    /// Whether this lane can go on in the place of `other`: the same snake in the same world at the same place.
    pub fn is_like(&self, other: &Self) -> bool {
        let of = |lane: &Self| (lane.number, lane.is_ghost, lane.offset_x_m);
        of(self) == of(other) && self.staged == other.staged
    }
}
