//! Reasons why a running world cannot continue under another plan, and the check for the reasons that follow from the plans alone.

use super::{BodyPlan, WorldPlan};

/// The reason why a running world cannot continue under another plan.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Discontinuity {
    /// The other snake has another number, size or arrangement of limbs.
    Body,
    /// The physics steps have another length, so the steps of both worlds have different times.
    StepLength,
    /// The snake starts in another place.
    Start,
    /// The stairs have another shape, and a limb has already reached them, so it could end up inside a step.
    Stairs,
    /// The other trial is already over by the current step.
    Duration,
}

impl Discontinuity {
    /// Returns the reason in words, to follow "because ".
    pub fn words(self) -> &'static str {
        match self {
            Self::Body => "the snake has another shape",
            Self::StepLength => "its physics steps have another length",
            Self::Start => "the snake starts elsewhere",
            Self::Stairs => "the snake has already reached the stairs",
            Self::Duration => "its trial is over by then",
        }
    }
}

impl WorldPlan {
    /// Checks whether a world of this plan can continue under `next`, whatever its state. The shape of the stairs is not compared, because
    /// it matters only once a limb has reached them: see [`Simulation::can_continue`](super::Simulation::can_continue).
    ///
    /// # Errors
    /// Returns the reason if the world cannot continue.
    pub fn can_continue(&self, next: &Self) -> Result<(), Discontinuity> {
        let start = |plan: &Self| (plan.start_x_m, plan.start_y_m, plan.start_turn_rad);
        if !self.body.has_shape_of(&next.body) {
            Err(Discontinuity::Body)
        } else if self.physics.steps_per_s != next.physics.steps_per_s {
            Err(Discontinuity::StepLength)
        } else if start(self) != start(next) {
            Err(Discontinuity::Start)
        } else {
            Ok(())
        }
    }
}

impl BodyPlan {
    /// Returns whether the parts of two bodies have the same sizes, and their joints and springs connect the same parts in the same
    /// places.
    fn has_shape_of(&self, other: &Self) -> bool {
        let sizes = |body: &Self| {
            body.parts.iter().map(|part| (part.limb, part.size_m())).collect::<Vec<_>>()
        };
        let ends = |body: &Self| {
            let joints = body.joints.iter().map(|joint| (joint.parent, joint.child, joint.mount));
            let springs = body.springs.iter().map(|spring| (spring.parent, spring.child));
            (joints.collect::<Vec<_>>(), springs.collect::<Vec<_>>())
        };
        sizes(self) == sizes(other) && ends(self) == ends(other)
    }
}
