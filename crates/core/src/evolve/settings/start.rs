//! The check of where snakes start.

use super::Settings;
use crate::check::Invalid;
use crate::evolve::Champion;
use crate::score::{FRONT_M, Trial};

/// Length by which a snake may reach beyond the first riser at its start, in metres: sums of lengths are not exact.
const TOLERANCE_M: f32 = 1.0e-3;

impl Settings {
    /// Checks that the snakes of a new run start before the stairs: inside them a snake could only be thrown out or be stuck, and behind them
    /// it could not reach them. Files of earlier runs may have such a start, so [`Self::check`] allows it.
    ///
    /// # Errors
    /// A snake at the start, or one that is moved along the stairs by the variations of repeated trials, would reach beyond the first riser.
    pub fn check_start(&self) -> Result<(), Invalid> {
        let trial = &self.trial;
        let (edge_m, repeats) = (trial.stairs.first_riser_y_m, &trial.repeats);
        let is_moved = repeats.trials > 1 || repeats.champion_trials > 0;
        let shift_m = if is_moved { repeats.off.start_m } else { 0.0 };
        let room_m = trial.room_m(self.genome.bodies.vary);
        if room_m.is_none_or(|room_m| shift_m <= room_m + TOLERANCE_M) {
            return Ok(());
        }
        let reach_m = reach_m(trial, self.genome.bodies.vary) + shift_m;
        let allowed = format!(
            "up to {} m, because the stairs begin at {edge_m} m, and a snake reaches {reach_m} m ahead of its middle",
            edge_m - reach_m,
        );
        Err(Invalid::new("trial.start_y_m", trial.start_y_m, allowed))
    }
}

/// Returns how far a snake reaches ahead of where it starts, in metres. A body of its own starts with its front where that of the report's
/// snake is.
fn reach_m(trial: &Trial, has_own_body: bool) -> f32 {
    if has_own_body { FRONT_M } else { trial.agent.length_m() / 2.0 }
}

impl Trial {
    /// Returns the room between the front of a snake at its start and the stairs, in metres: negative for a start inside or behind them, and
    /// `None` without stairs.
    fn room_m(&self, has_own_body: bool) -> Option<f32> {
        let front_m = self.start_y_m + reach_m(self, has_own_body);
        (self.stairs.steps > 0).then_some(self.stairs.first_riser_y_m - front_m)
    }
}

impl Champion {
    /// Checks that trials whose start moves by up to `shift_m`, in metres, begin before the stairs. `field` names the shift.
    ///
    /// # Errors
    /// The champion's snake, moved along the stairs, would reach beyond the first riser.
    pub fn check_shift(&self, field: &str, shift_m: f32) -> Result<(), Invalid> {
        match self.trial.room_m(self.genome.body.has_own_blocks()) {
            Some(room_m) if shift_m > 0.0 && shift_m > room_m + TOLERANCE_M => {
                let most = format!("0 to {}", (room_m.max(0.0) * 1000.0).floor() / 1000.0);
                let allowed =
                    format!("{most} m, because the stairs begin {room_m} m ahead of this snake");
                Err(Invalid::new(field, shift_m, allowed))
            }
            _ => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::with_fields;
    use crate::save::{shipped_champion, shipped_presets};

    fn start_of(changes: &[(&str, &str)]) -> Result<(), String> {
        let settings = with_fields(&Settings::default(), changes.iter().copied()).expect("allowed");
        settings.check_start().map_err(|error| error.to_string())
    }

    #[test]
    fn f14_a_start_inside_or_behind_the_stairs_is_refused_with_the_places_that_are_allowed() {
        let refused = "trial.start_y_m is -7.23; allowed: up to -55 m, because the stairs begin at -50 m, and a snake reaches 5 m \
                       ahead of its middle";
        assert_eq!(start_of(&[("first_riser_y_m", "-50")]), Err(refused.to_owned()));
        for (changes, is_allowed) in [
            (&[("start_y_m", "-2")][..], true),
            (&[("start_y_m", "-1.9")], false),
            (&[("start_y_m", "20")], false),
            (&[("start_y_m", "42")], false),
            (&[("start_y_m", "20"), ("stairs.steps", "0")], true),
            (&[("start_y_m", "-2"), ("repeats.trials", "2")], false),
            (&[("start_y_m", "-2.2"), ("repeats.trials", "2")], true),
            (&[("start_y_m", "-2.2"), ("champion_trials", "2"), ("off.start_m", "1")], false),
            (&[("start_y_m", "-7"), ("agent.limbs", "10")], true),
            (&[("start_y_m", "-6.9"), ("agent.limbs", "10")], false),
            (&[("start_y_m", "-1.5"), ("slope_m", "0.5")], false),
        ] {
            assert_eq!(start_of(changes).is_ok(), is_allowed, "{changes:?}");
        }
    }

    #[test]
    fn f14_a_trial_of_the_exam_never_begins_inside_the_stairs() {
        let mut champion = shipped_champion().expect("well formed").champion;
        let told = |champion: &Champion, shift_m| {
            champion.check_shift("--off-start", shift_m).map_err(|error| error.to_string())
        };
        assert_eq!(told(&champion, 5.0), Ok(()));
        // The front of the snake, whose middle is 5 m behind it, is 0.5 m before the stairs.
        champion.trial.start_y_m = -2.5;
        assert_eq!(told(&champion, 0.5), Ok(()));
        let refused = "--off-start is 0.6; allowed: 0 to 0.5 m, because the stairs begin 0.5 m ahead of this snake";
        assert_eq!(told(&champion, 0.6), Err(refused.to_owned()));
        champion.trial.start_y_m = 20.0;
        assert_eq!(told(&champion, 0.0), Ok(()), "its own start is that of its run");
        assert!(told(&champion, 0.1).is_err());
        champion.trial.stairs.steps = 0;
        assert_eq!(told(&champion, 5.0), Ok(()));
    }

    #[test]
    fn f14_every_preset_starts_before_its_stairs() {
        for preset in shipped_presets().expect("well formed") {
            assert_eq!(preset.settings.check_start(), Ok(()), "{}", preset.name);
        }
    }
}
