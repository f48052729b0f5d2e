//! Limits between the settings of a staircase: which stairs can be built.

use super::{GROUND_M, LEAST_RISE_M, LEAST_SLOPE_M, Stairs, no_slope};
use crate::check::Invalid;
use crate::schema::PerPart;

/// Least depth of the flat part of a tread, in metres.
const LEAST_FLAT_M: f32 = 0.1;

impl Stairs {
    /// Checks that no step leads below the ground, and that slopes and nosings have room.
    pub(super) fn check_shape(&self) -> Result<(), Invalid> {
        let mut below_m = 0.0;
        for step in 0..self.steps {
            let (rise_m, top_m) = (self.step_rise_m(step), self.height_m(step + 1));
            if top_m < -GROUND_M || (GROUND_M..LEAST_RISE_M).contains(&top_m) {
                let down = if below_m > 0.0 {
                    format!("-{below_m}, down to the ground, or ")
                } else {
                    String::new()
                };
                let allowed =
                    format!("{down}a rise that ends at least {LEAST_RISE_M} m over the ground");
                return Err(Invalid::new(format!("rise_m of step {}", step + 1), rise_m, allowed));
            }
            below_m = top_m;
            self.check_slope(step)?;
            let most_m = (self.step_tread_m(step) - self.step_slope_m(step)) / 2.0;
            if self.nosing_m > most_m {
                let allowed = format!("0 to {most_m} m, half the flat tread of step {}", step + 1);
                return Err(Invalid::new("nosing_m", self.nosing_m, allowed));
            }
        }
        Ok(())
    }

    /// Checks that the tread above a slope has a flat part that is deep enough to hide the end of the slope's board.
    fn check_slope(&self, step: u32) -> Result<(), Invalid> {
        let slope_m = self.step_slope_m(step);
        if slope_m == 0.0 {
            return Ok(());
        }
        let rise_m = self.step_rise_m(step);
        let own_m = self.deepest_slope_m(step);
        if slope_m > own_m {
            let tread_m = self.step_tread_m(step);
            let allowed = format!("0, or {LEAST_SLOPE_M} m to {own_m} m of a tread of {tread_m} m");
            return Err(Invalid::new(format!("slope_m of step {}", step + 1), slope_m, allowed));
        }
        let flat_m = LEAST_FLAT_M.max(rise_m.abs() / 2.0);
        let before = step.saturating_sub(1);
        let above_m = self.step_tread_m(before) - self.step_slope_m(before);
        if rise_m < 0.0 && above_m < flat_m {
            let allowed = format!("0, or a flat tread of at least {flat_m} m before a slope down");
            return Err(Invalid::new(format!("slope_m of step {}", step + 1), slope_m, allowed));
        }
        Ok(())
    }

    /// Returns the stairs with each slope limited to the greatest allowed depth, for use after rises have grown.
    #[must_use]
    pub fn with_room_for_slopes(mut self) -> Self {
        if self.slope_m != no_slope() {
            let fitting = |step| {
                let slope_m = self.step_slope_m(step).min(self.deepest_slope_m(step));
                if slope_m < LEAST_SLOPE_M { 0.0 } else { slope_m }
            };
            self.slope_m = PerPart::Each((0..self.steps).map(fitting).collect());
        }
        self
    }

    /// Returns the greatest depth of the slope of a step, in metres: a flat part of the step's tread has to remain.
    fn deepest_slope_m(&self, step: u32) -> f32 {
        let rise_m = self.step_rise_m(step);
        let flat_m = if rise_m > 0.0 { LEAST_FLAT_M.max(rise_m / 2.0) } else { LEAST_FLAT_M };
        (self.step_tread_m(step) - flat_m).max(0.0)
    }
}
