//! Description of a snake's progress in words.

use super::Lane;
use crate::studio::ui::decimals::decimals;
use snakes_core::score::arrived_y_m;

/// Words for a snake that is on the landing as a whole, where its fitness no longer grows.
pub const AT_THE_TOP: &str = "at the top";

impl Lane {
    /// Returns the time at which the snake lands or, if it does not, at which it is furthest, in simulated seconds; the
    /// end of the lane if neither is known.
    pub fn climbed_s(&self) -> f64 {
        let furthest = || {
            let history = self.history()?;
            let ways_m = history.middles_m().iter().map(|middle| middle.y).enumerate();
            let (sample, _) = ways_m.max_by(|a, b| a.1.total_cmp(&b.1))?;
            Some(f64::from(history.sample_steps()) * sample as f64 * self.step_s)
        };
        self.landed_s(f64::INFINITY).or_else(furthest).unwrap_or_else(|| self.end_s())
    }

    /// Describes the place of the snake: the distance of its middle block, "12.3 m", until the whole snake is on the landing.
    pub fn place_in_words(&self) -> String {
        let (middle, stairs) = (self.drawn_middle(), &self.trial().stairs);
        let is_up = stairs.steps > 0 && stairs.steps_under(middle.to_array()) == stairs.steps;
        match is_up && middle.y >= arrived_y_m(stairs, &self.body) {
            true => AT_THE_TOP.to_owned(),
            false => format!("{} m", decimals(middle.y, 1)),
        }
    }

    /// Describes the progress of the snake at this time in a few words.
    pub fn progress_in_words(&self, time_s: f64) -> String {
        let stairs = &self.trial().stairs;
        let middle = self.drawn_middle();
        let is_disqualified = self.replay.is_over() && self.evaluation().disqualified.is_some();
        match (self.landed_s(time_s), stairs.steps_under(middle.to_array())) {
            _ if is_disqualified => "disqualified".to_owned(),
            _ if stairs.steps == 0 => format!("at {:.1} m", middle.y),
            (Some(landed_s), climbed) if climbed == stairs.steps => {
                format!("at the top after {landed_s:.1} s")
            }
            // The landing counts even if the snake has gone on beyond it, or has fallen from it.
            (Some(landed_s), _) => format!("reached the top after {landed_s:.1} s"),
            (None, 0) if self.replay.is_over() => "climbed no step".to_owned(),
            (None, 0) if middle.y < stairs.first_riser_y_m => "on its way to the stairs".to_owned(),
            (None, 0) => "no step climbed yet".to_owned(),
            (None, climbed) => format!("climbed {climbed} of {} steps", stairs.steps),
        }
    }
}
