//! Continues a running world under another plan.

use super::Simulation;
use crate::world::engine::{PartState, Touch};
use crate::world::{Discontinuity, Vector, WorldPlan};

impl Simulation {
    /// Checks whether this world, which was built from `plan`, can continue under `next` in its present state.
    ///
    /// # Errors
    /// Returns the reason if the world cannot continue.
    pub fn can_continue(&self, plan: &WorldPlan, next: &WorldPlan) -> Result<(), Discontinuity> {
        plan.can_continue(next)?;
        let first_riser_y_m = plan.stairs.first_riser_y_m.min(next.stairs.first_riser_y_m);
        if plan.stairs != next.stairs && self.front_y_m() >= first_riser_y_m {
            return Err(Discontinuity::Stairs);
        }
        Ok(())
    }

    /// Returns the largest y of any part, in metres.
    fn front_y_m(&self) -> f32 {
        let parts = self.body().parts.iter().zip(self.poses());
        let fronts = parts.map(|(part, pose)| pose.translation.y + part.reach_m(pose.rotation).y);
        fronts.fold(f32::MIN, f32::max)
    }

    /// Returns a world with the present state of this one under another plan, for which [`Self::can_continue`] holds. If only materials,
    /// masses, limits or the solver differ, the engine's contacts continue, too, so that under an unchanged plan the world continues with
    /// the bits of this one. A user's pull ends.
    pub fn continued_in(&self, plan: &WorldPlan) -> Self {
        let mut continued = Self::new(plan);
        for (part, old) in continued.engine.parts_mut().iter_mut().zip(self.parts()) {
            *part = PartState { touch: Touch::default(), ..*old };
        }
        continued.engine.continue_from(&*self.engine);
        for part in continued.engine.parts_mut() {
            part.force_n = Vector::ZERO;
        }
        continued.applied.clone_from(&self.applied);
        continued.effort = self.effort;
        continued.is_disturbed = self.is_disturbed;
        continued.take_balance_of(self);
        continued
    }
}
