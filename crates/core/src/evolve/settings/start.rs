//! The check of where snakes start.

use super::Settings;
use crate::check::Invalid;
use crate::score::FRONT_M;

/// Length by which a snake may reach into the stairs at its start, in metres: sums of lengths are not exact.
const TOLERANCE_M: f32 = 1.0e-3;

impl Settings {
    /// Checks that no snake of a new run starts inside the stairs, where it could only be thrown out or be stuck. Files of earlier runs
    /// may have such a start, so [`Self::check`] allows it.
    ///
    /// # Errors
    /// A snake at the start, or one that is moved along the stairs by the variations of repeated trials, would reach into the stairs.
    pub fn check_start(&self) -> Result<(), Invalid> {
        let trial = &self.trial;
        let (stairs, repeats) = (&trial.stairs, &trial.repeats);
        // A body of its own starts with its front where that of the report's snake is.
        let half_m = if self.genome.bodies.vary { FRONT_M } else { trial.agent.length_m() / 2.0 };
        let is_moved = repeats.trials > 1 || repeats.champion_trials > 0;
        let reach_m = half_m + if is_moved { repeats.off.start_m } else { 0.0 };
        let start_m = trial.start_y_m;
        let [rear_m, front_m] = [start_m - reach_m + TOLERANCE_M, start_m + reach_m - TOLERANCE_M];
        let outline = stairs.outline_m();
        let is_inside = |ends: &[[f32; 2]]| match ends {
            [[from_m, from_z_m], [to_m, to_z_m]] => {
                from_z_m.max(*to_z_m) > 0.0 && front_m > *from_m && rear_m < *to_m
            }
            _ => false,
        };
        if !outline.windows(2).any(is_inside) {
            return Ok(());
        }
        let [first_m, end_m] = [stairs.first_riser_y_m, stairs.end_y_m()];
        let allowed = format!(
            "a start outside the stairs, which reach from {first_m} to {end_m} m: up to {} m or from {} m, because a snake reaches \
             {reach_m} m to either side",
            first_m - reach_m,
            end_m + reach_m,
        );
        Err(Invalid::new("trial.start_y_m", start_m, allowed))
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
    fn f14_a_start_inside_the_stairs_is_refused_with_the_places_that_are_allowed() {
        assert_eq!(
            start_of(&[("first_riser_y_m", "-50")]),
            Err("trial.start_y_m is -7.23; allowed: a start outside the stairs, which reach from -50 to -16 m: up to -55 m or from \
                 -11 m, because a snake reaches 5 m to either side"
                .to_owned())
        );
        for (changes, is_allowed) in [
            (&[("start_y_m", "-2")][..], true),
            (&[("start_y_m", "-1.9")], false),
            (&[("start_y_m", "20")], false),
            (&[("start_y_m", "42")], true),
            (&[("start_y_m", "41.9")], false),
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
        // Between the two parts of these stairs is the ground.
        let gap =
            [("stairs.steps", "3"), ("rise_m", "[0.5, -0.5, 0.5]"), ("tread_m", "[1, 12, 1]")];
        let with = |start_m| [&gap[..], &[("start_y_m", start_m)]].concat();
        assert_eq!(start_of(&with("10")), Ok(()));
        assert!(start_of(&with("11.5")).is_err());
    }

    #[test]
    fn f14_every_preset_starts_outside_its_stairs() {
        for preset in shipped_presets().expect("well formed") {
            assert_eq!(preset.settings.check_start(), Ok(()), "{}", preset.name);
        }
    }
}
