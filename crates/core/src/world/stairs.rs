//! The staircase: its shape, and what a position on it means.

mod editing;
mod limits;
mod shape;

pub use shape::{StairBox, StairSolid};

use crate::check::Invalid;
use crate::schema::{
    Need, Parts, PerPart, Section, SettingGroup, Walk, is_default, number, per_part, setting_group,
    settings, whole,
};

setting_group! {
    /// A straight staircase towards +y, with a landing behind its last step. A deep tread is an intermediate landing. A negative rise is a
    /// step down. A step down to the ground with a higher step behind it makes a gap, as if a step were missing.
    pub struct Stairs {
        /// Number of steps. The report has ten steps.
        steps: u32 = 10;
        /// Height of each step over the one below, in metres, lowest first, or one height for all; negative for a step down. In the
        /// report, the rise is 0.5 m.
        rise_m: PerPart = 0.5.into();
        /// Depth of each step along y, in metres, lowest first, or one depth for all. The default follows Table 1 of the report: one step
        /// per 2 m.
        tread_m: PerPart = 2.0.into();
        /// Width of the stairs across x, in metres. In the report, the width is 5 m.
        width_m: f32 = 5.0;
        /// Position of the first riser on the y axis, in metres. The default follows Table 1 of the report: the snake, 10 m long, touches
        /// the stairs with its centre at y = -2, so the riser is at y = 3.
        first_riser_y_m: f32 = 3.0;
        /// Depth of the landing behind the last tread, in metres. By default the whole snake (10 m) fits on it.
        landing_m: f32 = 14.0;
        /// How far each tread overhangs its riser, in metres. Sloping rises and steps down have no nosing.
        #[serde(default, skip_serializing_if = "is_default")]
        nosing_m: f32 = 0.0;
        /// Depth over which each rise slopes, in metres, lowest first, or one depth for all; 0 is a vertical riser.
        #[serde(default = "no_slope", skip_serializing_if = "is_vertical")]
        slope_m: PerPart = no_slope();
    }
}

fn no_slope() -> PerPart {
    0.0.into()
}

fn is_vertical(slope_m: &PerPart) -> bool {
    *slope_m == no_slope()
}

impl Stairs {
    /// Section of the settings of the stairs.
    pub const SECTION: Section =
        Section { title: "Stairs", about: "Shape and position of the staircase." };
    /// Stairs that do not evolve. Stairs that evolve begin low and without nosing or slopes; the trial sets their number of steps and
    /// their treads.
    pub const GIVEN: Need = Need("stairs that do not evolve");
}

impl SettingGroup for Stairs {
    fn walk(&mut self, walk: &mut Walk<'_>) {
        let each_step = Parts::Steps(self.steps as usize);
        let Self { steps, rise_m, tread_m, width_m, first_riser_y_m, landing_m, nosing_m, slope_m } =
            self;
        walk.section(Self::SECTION);
        settings! { walk,
            // The range ends at a hundred steps, far more than any snake climbs, and still computed quickly.
            steps: whole("Steps", 0..=100)
                .hint("Number of steps; 0 gives flat ground")
                .slider(0.0, 20.0);
            // The range goes from a doorsill to a wall.
            rise_m: per_part("Rise", -5.0..=5.0, each_step).needs(Self::GIVEN)
                .without(-LEAST_RISE_M, LEAST_RISE_M)
                .unit("m")
                .hint("Height of a step over the one below it; a negative rise leads down, at most to the ground")
                .slider(0.05, 2.0);
            tread_m: per_part("Tread", 0.1..=20.0, each_step)
                .unit("m")
                .hint("Depth of a step. A deep tread gives the snake more room")
                .slider(0.2, 5.0);
            // The range goes from a block's own width to a hall's.
            width_m: number("Width", 1.0..=100.0)
                .unit("m")
                .hint("Width of the stairs. A snake that drifts sideways falls off narrow stairs")
                .slider(1.0, 20.0);
            // The range ends at a hundred metres, within which 32-bit floats still resolve a hundredth of a millimetre.
            first_riser_y_m: number("Position of the first riser", -100.0..=100.0).advanced()
                .unit("m")
                .hint("Distance (y) at which the stairs begin")
                .slider(0.0, 20.0);
            landing_m: number("Landing", 0.0..=100.0).advanced()
                .unit("m")
                .hint("Depth of the landing beyond the last step")
                .slider(0.0, 60.0);
            nosing_m: number("Nosing", 0.0..=0.3).advanced().needs(Self::GIVEN)
                .unit("m")
                .hint("How far each tread overhangs its riser. Sloping rises have no nosing")
                .slider(0.0, 0.3);
            slope_m: per_part("Slope", 0.0..=19.9, each_step).advanced().needs(Self::GIVEN)
                .without(0.0, LEAST_SLOPE_M)
                .unit("m")
                .hint("Depth over which a rise slopes like a ramp; 0 is a vertical riser")
                .slider(0.0, 2.0);
        }
    }

    fn check_together(&self) -> Result<(), Invalid> {
        self.check_shape()
    }
}

/// Height over the ground, in metres, below which a tread counts as the ground itself: sums of rises are not exact.
const GROUND_M: f32 = 1.0e-4;
/// Least height difference between two steps, up or down, in metres. Below a centimetre, the engine's tolerances are as large as the step.
pub const LEAST_RISE_M: f32 = 0.01;
/// Least depth of a slope, in metres: a shallower slope would be a board without depth.
const LEAST_SLOPE_M: f32 = 0.01;

impl Stairs {
    /// Returns the position of riser number `index` (0 is the first) on the y axis, in metres.
    pub fn riser_y_m(&self, index: u32) -> f32 {
        match &self.tread_m {
            // The product, not a sum, keeps the bits of stairs of engine version 2 and earlier.
            PerPart::All(tread_m) => self.first_riser_y_m + index as f32 * tread_m,
            PerPart::Each(_) => (0..index)
                .fold(self.first_riser_y_m, |riser_m, step| riser_m + self.step_tread_m(step)),
        }
    }

    /// Returns the position at which the flat part of tread number `index` (0 is the first) begins, on the y axis, in metres: at its
    /// riser, or at the end of its slope.
    pub fn tread_y_m(&self, index: u32) -> f32 {
        let slope_m = self.step_slope_m(index);
        if slope_m > 0.0 { self.riser_y_m(index) + slope_m } else { self.riser_y_m(index) }
    }

    /// Returns the depth of step number `index` (0 is the first) along y, in metres.
    pub fn step_tread_m(&self, index: u32) -> f32 {
        self.tread_m.at(index as usize)
    }

    /// Returns the sum of the depths of all steps along y, in metres.
    pub fn treads_m(&self) -> f32 {
        (0..self.steps).map(|step| self.step_tread_m(step)).sum()
    }

    /// Returns the mean depth of the steps along y, in metres.
    pub fn mean_tread_m(&self) -> f32 {
        match &self.tread_m {
            PerPart::All(tread_m) => *tread_m,
            PerPart::Each(_) => {
                (self.riser_y_m(self.steps) - self.first_riser_y_m) / self.steps.max(1) as f32
            }
        }
    }

    /// Returns the depth over which the rise of step number `index` (0 is the first) slopes, in metres.
    pub fn step_slope_m(&self, index: u32) -> f32 {
        self.slope_m.at(index as usize)
    }

    /// Returns how far the tread of step number `index` (0 is the first) overhangs its riser, in metres. Steps down, sloping steps and
    /// steps followed by a slope down have no nosing.
    pub fn step_nosing_m(&self, index: u32) -> f32 {
        let leads_down = |step| self.step_rise_m(step) < 0.0;
        let slopes = |step| self.step_slope_m(step) > 0.0;
        let next = index + 1;
        let has_none = leads_down(index)
            || slopes(index)
            || (next < self.steps && leads_down(next) && slopes(next));
        if has_none { 0.0 } else { self.nosing_m }
    }

    /// Returns the height of step number `index` (0 is the first) over the one below it, in metres.
    pub fn step_rise_m(&self, index: u32) -> f32 {
        self.rise_m.at(index as usize)
    }

    /// Returns the height of the tread after this number of steps over the ground, in metres; 0 for no steps.
    pub fn height_m(&self, steps: u32) -> f32 {
        match &self.rise_m {
            // The product, not a sum, keeps the bits of stairs of engine version 2 and earlier.
            PerPart::All(rise_m) => rise_m * steps as f32,
            PerPart::Each(_) => {
                let sum_m = (0..steps).map(|step| self.step_rise_m(step)).sum::<f32>();
                if sum_m.abs() < GROUND_M { 0.0 } else { sum_m }
            }
        }
    }

    /// Returns the greatest height of a tread over the ground, in metres.
    pub fn highest_m(&self) -> f32 {
        (0..=self.steps).map(|steps| self.height_m(steps)).fold(0.0, f32::max)
    }

    /// Returns the position on the y axis, in metres, from which on a snake's middle block is on the landing: the beginning of the last
    /// tread, which is level with the landing and belongs to it. Without steps, it is where the stairs would begin.
    pub fn landing_y_m(&self) -> f32 {
        match self.steps {
            0 => self.first_riser_y_m,
            steps => self.tread_y_m(steps - 1),
        }
    }

    /// Returns the position of the end of the landing on the y axis, in metres.
    pub fn end_y_m(&self) -> f32 {
        self.riser_y_m(self.steps) + self.landing_m
    }

    /// Counts the steps climbed by a snake whose centre is at `y_m`, in metres.
    ///
    /// A step counts as climbed once the centre has passed its riser. This rule reproduces Table 1 of the report: 3.84 is one step, 5.79
    /// two, 8.05 three. Only y counts, as in the report: a snake that crawls past the stairs counts, too.
    pub fn steps_climbed(&self, y_m: f64) -> u32 {
        if let PerPart::All(_) = self.tread_m {
            let is_passed = |index: &u32| y_m >= f64::from(self.tread_y_m(*index));
            return (0..self.steps).take_while(is_passed).count() as u32;
        }
        let mut riser_m = self.first_riser_y_m;
        for step in 0..self.steps {
            let slope_m = self.step_slope_m(step);
            let tread_m = if slope_m > 0.0 { riser_m + slope_m } else { riser_m };
            if y_m < f64::from(tread_m) || y_m.is_nan() {
                return step;
            }
            riser_m += self.step_tread_m(step);
        }
        self.steps
    }

    /// Converts a point's y, in metres, to its way along the stairs in steps: the distance from the first riser, measured in treads.
    /// Before the first riser the way is negative, in depths of the first step; behind the last tread it goes on in depths of the last
    /// step.
    pub fn way_steps(&self, y_m: f32) -> f32 {
        match &self.tread_m {
            PerPart::All(tread_m) => (y_m - self.first_riser_y_m) / tread_m,
            PerPart::Each(_) => {
                let mut riser_m = self.first_riser_y_m;
                for step in 0..self.steps.saturating_sub(1) {
                    let next_m = riser_m + self.step_tread_m(step);
                    if y_m < next_m {
                        return step as f32 + (y_m - riser_m) / self.step_tread_m(step);
                    }
                    riser_m = next_m;
                }
                let last = self.steps.saturating_sub(1);
                last as f32 + (y_m - riser_m) / self.step_tread_m(last)
            }
        }
    }

    /// Counts the steps under a point at `at_m`, in metres: the point is past their risers, above the tread of the last of them, and
    /// within the width. Beside the stairs the number is 0.
    pub fn steps_under(&self, at_m: [f32; 3]) -> u32 {
        let [x_m, y_m, z_m] = at_m;
        let climbed = self.steps_climbed(f64::from(y_m));
        // The surface of a slope down lies below the last tread. On a slope up, the tread counts only from the end of the slope.
        let least_z_m = self.surface_after_m(climbed, y_m).min(self.height_m(climbed));
        let is_over = z_m >= least_z_m && x_m.abs() <= self.width_m / 2.0;
        if is_over && y_m <= self.end_y_m() { climbed } else { 0 }
    }

    /// Returns whether a point at `at_m`, in metres, is above the stairs: past the first riser, above the tread or slope below it, and
    /// within the width.
    pub fn is_over(&self, at_m: [f32; 3]) -> bool {
        let [x_m, y_m, z_m] = at_m;
        let is_along = y_m >= self.first_riser_y_m && y_m <= self.end_y_m();
        self.steps > 0
            && is_along
            && x_m.abs() <= self.width_m / 2.0
            && z_m >= self.surface_z_m(x_m, y_m)
    }

    /// Returns the height of the tread, the slope, the landing or the ground at a point of the floor plan, all in metres.
    pub fn surface_z_m(&self, x_m: f32, y_m: f32) -> f32 {
        if x_m.abs() > self.width_m / 2.0 || y_m > self.end_y_m() {
            return 0.0;
        }
        self.surface_after_m(self.steps_climbed(f64::from(y_m)), y_m)
    }

    /// Returns the height of the surface within the width of the stairs at `y_m`, in metres, for a point with this number of steps behind
    /// it.
    fn surface_after_m(&self, climbed: u32, y_m: f32) -> f32 {
        let below_m = self.height_m(climbed);
        if climbed == self.steps {
            return below_m;
        }
        let (into_m, slope_m) = (y_m - self.riser_y_m(climbed), self.step_slope_m(climbed));
        let top_m = self.height_m(climbed + 1);
        if slope_m > 0.0 && into_m >= 0.0 {
            below_m + (top_m - below_m) * (into_m / slope_m)
        } else if self.nosing_m > 0.0 && into_m >= -self.step_nosing_m(climbed) {
            top_m
        } else {
            below_m
        }
    }

    /// Describes in words where a snake lies whose centre has passed risers, but has no step under it ([`Stairs::steps_under`]): beside
    /// the stairs or behind them. Returns `None` before the first riser.
    pub fn meaning_off_the_stairs(&self, y_m: f64) -> Option<String> {
        match self.steps_climbed(y_m) {
            0 => None,
            _ if y_m > f64::from(self.end_y_m()) => Some("lies behind the stairs".to_owned()),
            passed => Some(format!("lies beside step {passed} of the stairs")),
        }
    }

    /// Describes in words the centre position `y_m` of a snake of length `snake_length_m` that started at `start_y_m`, in metres. The
    /// words are those of Table 1 of the report.
    pub fn meaning(&self, y_m: f64, start_y_m: f64, snake_length_m: f64) -> String {
        let to_first_riser_m = f64::from(self.first_riser_y_m) - snake_length_m / 2.0;
        let climbed = self.steps_climbed(y_m);
        if self.steps > 0 && climbed == self.steps {
            "stands on the landing".to_owned()
        } else if climbed == 1 {
            "climbs 1 step".to_owned()
        } else if climbed > 1 {
            format!("climbs {climbed} steps")
        } else if y_m >= to_first_riser_m - REACH_TOLERANCE_M {
            "reaches the stairs".to_owned()
        } else if y_m > start_y_m + START_TOLERANCE_M {
            "slightly forward".to_owned()
        } else if y_m >= start_y_m - START_TOLERANCE_M {
            "starting position".to_owned()
        } else {
            "moved backwards".to_owned()
        }
    }
}

/// Tolerance, in metres, for reaching the stairs. Table 1 says "reaches the stairs" for a mean of -2.05, although the head touches the
/// stairs at exactly -2.
const REACH_TOLERANCE_M: f64 = 0.1;
/// Distance from the start, in metres, up to which a mean counts as the starting position: Table 1 gives -7.23 for it.
const START_TOLERANCE_M: f64 = 0.25;

impl Stairs {
    /// Returns stairs with every kind of step, for tests: up by a slope, up by a riser with a nosing, down by a slope, down to the ground,
    /// up again.
    pub fn uneven() -> Self {
        Self {
            steps: 5,
            rise_m: PerPart::Each(vec![0.5, 0.5, -0.4, -0.6, 1.0]),
            tread_m: PerPart::Each(vec![2.0, 3.0, 2.5, 1.0, 2.0]),
            slope_m: PerPart::Each(vec![1.0, 0.0, 1.5, 0.0, 0.0]),
            nosing_m: 0.2,
            ..Self::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_stairs_with_every_kind_of_step_are_allowed() {
        crate::schema::check(&Stairs::uneven()).expect("allowed");
    }

    #[test]
    fn the_descriptions_of_table_1_follow_from_the_geometry() {
        let stairs = Stairs::default();
        let table_1 = [
            (-7.23, "starting position"),
            (-5.94, "slightly forward"),
            (-2.05, "reaches the stairs"),
            (3.84, "climbs 1 step"),
            (5.79, "climbs 2 steps"),
            (8.05, "climbs 3 steps"),
        ];
        for (mean_y_m, words) in table_1 {
            assert_eq!(stairs.meaning(mean_y_m, -7.23, 10.0), words, "at {mean_y_m}");
        }
        assert_eq!(stairs.meaning(-9.0, -7.23, 10.0), "moved backwards");
        assert_eq!(stairs.meaning(20.9, -7.23, 10.0), "climbs 9 steps");
        assert_eq!(stairs.landing_y_m(), 21.0);
        assert_eq!(stairs.meaning(21.0, -7.23, 10.0), "stands on the landing");
        assert_eq!(Stairs { steps: 0, ..stairs }.meaning(50.0, -7.23, 10.0), "reaches the stairs");
    }

    #[test]
    fn steps_of_different_heights_lie_on_one_another() {
        let rise_m = PerPart::Each(vec![0.5, 0.75, 0.25]);
        let stairs = Stairs { steps: 3, rise_m, ..Stairs::default() };
        crate::schema::check(&stairs).expect("a height for each step");
        let tops = stairs.boxes().iter().map(|step| step.max_m[2]).collect::<Vec<_>>();
        assert_eq!(tops, [0.5, 1.25, 1.5]);
        assert_eq!(stairs.surface_z_m(0.0, 5.5), 1.25);
        let under = |z_m| stairs.steps_under([0.0, 5.5, z_m]);
        assert_eq!((under(1.3), under(1.2)), (2, 0), "inside the second step");
        let error = crate::schema::check(&Stairs { steps: 4, ..stairs }).expect_err("a step more");
        assert!(error.to_string().starts_with("rise_m is "), "{error}");
    }
}
