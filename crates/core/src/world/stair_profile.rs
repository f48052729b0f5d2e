//! The staircase in profile, as a snake senses it: the next riser, and the height of the surface below a point.
//!
//! All results are computed from the shape of the stairs, without a ray through the engine. With equal treads the time is constant;
//! otherwise it grows with the logarithm of the number of treads.

use super::Stairs;
use crate::schema::PerPart;

/// The profile of a staircase.
#[derive(Debug, Clone, PartialEq)]
pub struct StairProfile {
    first_riser_y_m: f32,
    /// Places where the flat parts of the treads begin.
    treads: Treads,
    mean_tread_m: f32,
    /// Half the width of the stairs, in metres.
    pub half_width_m: f32,
    end_y_m: f32,
    /// Height over the ground after each number of steps, from none to all, in metres.
    heights_m: Vec<f32>,
    /// Depth of the slope and of the nosing before each tread, in metres; empty if there are none.
    edges_m: Vec<[f32; 2]>,
}

/// Places where the flat parts of the treads begin, on the y axis, in metres.
#[derive(Debug, Clone, PartialEq)]
enum Treads {
    /// All treads have this depth, in metres, and vertical risers.
    Equal(f32),
    /// The flat parts of the treads begin at these places on the y axis, in metres.
    At(Vec<f32>),
}

/// The next step ahead of a point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NextStep {
    /// Distance along y to the front of the step, in metres.
    pub gap_m: f32,
    /// Height of the step's tread over the ground, in metres.
    pub top_z_m: f32,
}

/// The progress of a limb up the stairs, usually of the middle limb.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ClimbProgress {
    /// Number of steps under the limb.
    pub steps: u32,
    /// Position of the limb on the y axis, in metres; without a step under the limb, at most the position of the first riser.
    pub way_m: f32,
    /// Mean depth of the steps, in metres.
    pub tread_m: f32,
    /// Whether all steps are under the limb.
    pub is_on_landing: bool,
}

impl StairProfile {
    /// Computes the profile of a staircase.
    pub fn of(stairs: &Stairs) -> Self {
        let steps = || 0..stairs.steps;
        let edge_m = |step| [stairs.step_slope_m(step), stairs.step_nosing_m(step)];
        let has_edges = steps().any(|step| edge_m(step) != [0.0; 2]);
        let slopes = steps().any(|step| stairs.step_slope_m(step) > 0.0);
        Self {
            first_riser_y_m: stairs.first_riser_y_m,
            treads: match &stairs.tread_m {
                PerPart::All(tread_m) if !slopes => Treads::Equal(*tread_m),
                _ => Treads::At(steps().map(|step| stairs.tread_y_m(step)).collect()),
            },
            mean_tread_m: stairs.mean_tread_m(),
            half_width_m: stairs.width_m / 2.0,
            end_y_m: stairs.end_y_m(),
            heights_m: (0..=stairs.steps).map(|steps| stairs.height_m(steps)).collect(),
            edges_m: if has_edges { steps().map(edge_m).collect() } else { Vec::new() },
        }
    }

    /// Finds the next step ahead of a point of the floor plan, in metres. The step begins at its riser, at the edge of its nosing, or at
    /// the foot of its slope. `None` on the landing, beside the stairs and behind them.
    pub fn next_step(&self, x_m: f32, y_m: f32) -> Option<NextStep> {
        if !self.is_in_line(x_m, y_m) {
            return None;
        }
        let passed = self.treads_passed(y_m);
        let top_z_m = *self.heights_m.get(passed + 1)?;
        let [slope_m, nosing_m] = self.edge_m(passed);
        let edge_y_m = self.tread_y_m(passed) - slope_m - nosing_m;
        Some(NextStep { gap_m: edge_y_m - y_m, top_z_m })
    }

    /// Returns the height of the tread, the slope, the landing or the ground at a point of the floor plan, all in metres.
    pub fn surface_z_m(&self, x_m: f32, y_m: f32) -> f32 {
        if self.is_in_line(x_m, y_m) {
            self.surface_after_m(self.treads_passed(y_m), y_m)
        } else {
            0.0
        }
    }

    /// Returns the height of the surface within the width of the stairs, in metres, at a y with this number of treads passed.
    fn surface_after_m(&self, passed: usize, y_m: f32) -> f32 {
        let below_m = self.heights_m.get(passed).copied().unwrap_or(0.0);
        let Some(top_m) = self.heights_m.get(passed + 1) else { return below_m };
        let [slope_m, nosing_m] = self.edge_m(passed);
        let before_tread_m = self.tread_y_m(passed) - y_m;
        if slope_m > 0.0 && before_tread_m <= slope_m {
            below_m + (top_m - below_m) * (1.0 - before_tread_m / slope_m)
        } else if nosing_m > 0.0 && before_tread_m <= nosing_m {
            *top_m
        } else {
            below_m
        }
    }

    /// Computes the progress up the stairs of a limb whose centre is at this point, in metres: see
    /// [`Stairs::steps_under`](super::Stairs::steps_under).
    pub fn climb(&self, [x_m, y_m, z_m]: [f32; 3]) -> ClimbProgress {
        let passed = if self.is_in_line(x_m, y_m) { self.treads_passed(y_m) } else { 0 };
        let least_z_m = |height_m: f32| height_m.min(self.surface_after_m(passed, y_m));
        let is_over =
            self.heights_m.get(passed).is_some_and(|height_m| z_m >= least_z_m(*height_m));
        let steps = if is_over { passed } else { 0 };
        ClimbProgress {
            steps: steps as u32,
            way_m: if steps > 0 { y_m } else { y_m.min(self.first_riser_y_m) },
            tread_m: self.mean_tread_m,
            is_on_landing: steps > 0 && steps + 1 == self.heights_m.len(),
        }
    }

    /// Returns whether a point is within the width of the stairs and not behind their landing.
    fn is_in_line(&self, x_m: f32, y_m: f32) -> bool {
        x_m.abs() <= self.half_width_m && y_m <= self.end_y_m
    }

    /// Counts the treads whose flat part begins at or before a place on the y axis.
    fn treads_passed(&self, y_m: f32) -> usize {
        let tread_m = match &self.treads {
            Treads::Equal(tread_m) => tread_m,
            Treads::At(places_m) => return places_m.partition_point(|place_m| *place_m <= y_m),
        };
        let steps = self.heights_m.len() - 1;
        if y_m < self.first_riser_y_m {
            return 0;
        }
        // The conversion cuts off the fraction. It turns NaN into 0, and infinity into the greatest number.
        let passed = ((y_m - self.first_riser_y_m) / tread_m) as usize;
        passed.saturating_add(1).min(steps)
    }

    /// Returns the position at which the flat part of tread number `index` begins, on the y axis, in metres.
    fn tread_y_m(&self, index: usize) -> f32 {
        match &self.treads {
            Treads::Equal(tread_m) => self.first_riser_y_m + index as f32 * tread_m,
            Treads::At(places_m) => places_m.get(index).copied().unwrap_or(self.end_y_m),
        }
    }

    /// Returns the depth of the slope and of the nosing before tread number `index`, in metres.
    fn edge_m(&self, index: usize) -> [f32; 2] {
        self.edges_m.get(index).copied().unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::schema::PerPart;

    #[test]
    fn the_next_step_is_ahead_and_as_high_as_the_tread_behind_its_riser() {
        let rise_m = PerPart::Each(vec![0.5, 0.75, 0.25]);
        let stairs = Stairs { steps: 3, rise_m, ..Stairs::default() };
        let profile = StairProfile::of(&stairs);
        let next = |y_m| profile.next_step(0.0, y_m).map(|next| (next.gap_m, next.top_z_m));
        assert_eq!(next(1.0), Some((2.0, 0.5)));
        assert_eq!(next(3.0), Some((2.0, 1.25)), "at a riser, the next one is ahead");
        assert_eq!(next(4.5), Some((0.5, 1.25)));
        assert_eq!(next(6.9), next(6.9).filter(|(gap_m, _)| (gap_m - 0.1).abs() < 1e-5));
        assert_eq!(next(7.0), None, "on the landing");
        assert_eq!(profile.next_step(2.6, 1.0), None, "beside the stairs");
        assert_eq!(next(stairs.end_y_m() + 1.0), None, "behind the stairs");
        assert_eq!(StairProfile::of(&Stairs { steps: 0, ..stairs }).next_step(0.0, 1.0), None);
    }

    #[test]
    fn the_climb_counts_steps_under_the_limb_and_beside_the_stairs_only_the_way_to_them() {
        let profile = StairProfile::of(&Stairs::default());
        let climb = |at| profile.climb(at);
        assert_eq!((climb([0.0, 5.5, 1.6]).steps, climb([0.0, 5.5, 1.6]).way_m), (2, 5.5));
        assert_eq!((climb([0.0, 5.5, 0.9]).steps, climb([0.0, 5.5, 0.9]).way_m), (0, 3.0));
        assert_eq!(climb([3.0, 5.5, 0.5]).way_m, 3.0, "beside the stairs");
        assert!(climb([0.0, 21.5, 5.5]).is_on_landing && !climb([0.0, 20.5, 5.5]).is_on_landing);
    }

    #[test]
    fn the_surface_is_that_of_the_stairs() {
        let nosed = Stairs { nosing_m: 0.3, ..Stairs::default() };
        for stairs in [Stairs::default(), nosed, Stairs::uneven()] {
            surface_is_that_of(&stairs);
        }
    }

    fn surface_is_that_of(stairs: &Stairs) {
        let profile = StairProfile::of(stairs);
        for x_m in [0.0, 2.4, -2.6] {
            for number in -40..500_i16 {
                // The points lie between the risers, where both computations agree whatever their rounding.
                let y_m = f32::from(number) * 0.1 + 0.05;
                let expected = stairs.surface_z_m(x_m, y_m);
                let found = profile.surface_z_m(x_m, y_m);
                // On slopes the two functions compute in different orders.
                assert!((found - expected).abs() < 1.0e-5, "at {x_m}, {y_m}: {found}, {expected}");
            }
        }
        assert_eq!(profile.surface_z_m(0.0, f32::NAN), 0.0);
    }
}
