//! The plan from which a world is built.

use super::{BodyPlan, HealthLimits, PhysicsSettings, Skin, Stairs, Surface};

/// Everything that determines a world. Two worlds built from one plan and stepped with the same torques agree in every bit.
#[derive(Debug, Clone, PartialEq)]
pub struct WorldPlan {
    /// Settings of the physics: step length, substeps, gravity.
    pub physics: PhysicsSettings,
    /// Shape and position of the staircase.
    pub stairs: Stairs,
    /// The material of the stairs.
    pub surface: Surface,
    /// The material of the ground.
    pub ground: Surface,
    /// The material of the snake.
    pub skin: Skin,
    /// Tolerances beyond which the agent is disqualified.
    pub health: HealthLimits,
    /// The body of the snake.
    pub body: BodyPlan,
    /// Whether the snake comes to rest without commanded torques before its trial begins.
    pub settles: bool,
    /// Position of the middle of the straight snake on the y axis at the start, in metres.
    pub start_y_m: f32,
    /// Position of the middle of the straight snake on the x axis at the start, in metres; 0 is in front of the middle of the stairs.
    pub start_x_m: f32,
    /// Turn of the snake about the vertical axis at the start, in radians, counterclockwise seen from above; at 0 it heads for the stairs.
    pub start_turn_rad: f32,
}

impl WorldPlan {
    /// Returns the position of the middle part's centre on the y axis at the start, in metres. A turn of the snake and its settling are
    /// not counted.
    pub fn middle_start_y_m(&self) -> f32 {
        if self.settles {
            self.start_y_m + self.body.length_m() / 2.0 - self.body.front_to_middle_m()
        } else {
            // Returned directly for equal limbs, so that sums of lengths add no rounding.
            self.start_y_m
        }
    }
}
