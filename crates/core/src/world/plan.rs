//! The plan from which a world is built.

use super::{
    BodyPlan, HealthLimits, PartPlan, PhysicsSettings, Pose, Rotation, Skin, Stairs, Surface,
    Vector,
};

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

    /// Returns the poses of the parts before the first step: a straight row that lies on the ground, head first, or the tree of a
    /// branching body.
    pub fn start_poses(&self) -> Vec<Pose> {
        let body = &self.body;
        let middle = Vector::new(self.start_x_m, self.start_y_m, 0.0);
        let (sin, cos) = libm::sincosf(self.start_turn_rad);
        let (half_sin, half_cos) = libm::sincosf(self.start_turn_rad / 2.0);
        let turn = Rotation::from_xyzw(0.0, 0.0, half_sin, half_cos);
        let half_length_m = body.length_m() / 2.0;
        if body.is_branching() {
            let front = Vector::new(0.0, half_length_m, 0.0);
            let place = |pose: Pose| {
                Pose::from_parts(middle + turn * (pose.translation + front), turn * pose.rotation)
            };
            return body.rest_poses().into_iter().map(place).collect();
        }
        let axis_z_m = body.axis_height_m();
        let mut front_y_m = self.start_y_m + half_length_m;
        let place = |part: &PartPlan| {
            let straight_y_m = front_y_m - part.length_m / 2.0;
            front_y_m -= part.length_m;
            let centre = if self.start_turn_rad == 0.0 {
                // Computed directly, because the detour over the middle of the snake would change the bits by rounding.
                Vector::new(self.start_x_m, straight_y_m, axis_z_m)
            } else {
                let along_m = straight_y_m - self.start_y_m;
                middle + Vector::new(-sin * along_m, cos * along_m, axis_z_m)
            };
            Pose::from_parts(centre, turn)
        };
        body.parts.iter().map(place).collect()
    }
}
