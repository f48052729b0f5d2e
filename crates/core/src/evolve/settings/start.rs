//! The check of where snakes start.

use super::Settings;
use crate::check::Invalid;
use crate::score::FRONT_M;

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
        let (stairs, repeats) = (&trial.stairs, &trial.repeats);
        // A body of its own starts with its front where that of the report's snake is.
        let half_m = if self.genome.bodies.vary { FRONT_M } else { trial.agent.length_m() / 2.0 };
        let is_moved = repeats.trials > 1 || repeats.champion_trials > 0;
        let reach_m = half_m + if is_moved { repeats.off.start_m } else { 0.0 };
        let edge_m = stairs.first_riser_y_m;
        if stairs.steps == 0 || trial.start_y_m + reach_m <= edge_m + TOLERANCE_M {
            return Ok(());
        }
        let allowed = format!(
            "up to {} m, because the stairs begin at {edge_m} m, and a snake reaches {reach_m} m ahead of its middle",
            edge_m - reach_m,
        );
        Err(Invalid::new("trial.start_y_m", trial.start_y_m, allowed))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::with_fields;
    use crate::save::shipped_presets;

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
    fn f14_every_preset_starts_before_its_stairs() {
        for preset in shipped_presets().expect("well formed") {
            assert_eq!(preset.settings.check_start(), Ok(()), "{}", preset.name);
        }
    }
}
