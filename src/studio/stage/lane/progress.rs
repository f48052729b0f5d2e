//! Description of a snake's progress in words.

use super::Lane;

impl Lane {
    /// Describes the progress of the snake at this time in a few words.
    pub fn progress_in_words(&self, time_s: f64) -> String {
        let stairs = &self.trial().stairs;
        let middle = self.drawn_middle();
        let is_disqualified = self.is_over() && self.evaluation().disqualified.is_some();
        match (self.landed_s(time_s), stairs.steps_under(middle.to_array())) {
            _ if is_disqualified => "disqualified".to_owned(),
            _ if stairs.steps == 0 => format!("at {:.1} m", middle.y),
            (Some(landed_s), climbed) if climbed == stairs.steps => {
                format!("at the top after {landed_s:.1} s")
            }
            (_, 0) if self.is_over() => "climbed no step".to_owned(),
            (_, 0) => "no step climbed yet".to_owned(),
            (_, climbed) => format!("climbed {climbed} of {} steps", stairs.steps),
        }
    }
}
