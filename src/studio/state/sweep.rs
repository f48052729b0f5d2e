//! Sweep: one setting of the world at five values, in five lanes side by side.

use super::lineup::race_of;
use crate::studio::stage::Show;
use crate::studio::stage::staged_champion::StagedChampion;
use snakes_core::evolve::{Settings, fields, with_fields, world_in_words};
use snakes_core::schema::{NumberRange, SettingKind, SettingValue, list};
use snakes_core::score::Trial;

/// Number of values in a sweep, including the present value.
const VALUES: u8 = 5;
/// Ratios of a sweep's values to the present value, for a setting with a logarithmic slider.
const RATIOS: [f32; VALUES as usize] = [0.2, 0.5, 1.0, 2.0, 5.0];

/// Shows the champion in five worlds that differ in one setting, which is named by its full dotted name. The label "(as before)" marks the
/// world in which the stage shows the champion; the next run may have another value.
///
/// # Errors
/// The setting is no number of the world, has a separate value for each part, or has only one possible value. The error
/// is a sentence for the user.
pub(crate) fn sweep(champion: &StagedChampion, field: &str) -> Result<Show, String> {
    let settings = settings_of(champion.trial());
    let all = list(&settings);
    let listed = all.iter().find(|listed| listed.path == field && field.starts_with("trial."));
    let listed = listed.ok_or_else(|| format!("{field} is no setting of the world."))?;
    let label = listed.setting.label;
    let SettingKind::Number(range) = &listed.setting.kind else {
        return Err(format!("{label} is no number, so it cannot be swept."));
    };
    let now = match (&listed.value, range.begins_with) {
        (SettingValue::Number(now), _) => *now,
        (SettingValue::Whole(now), _) => *now as f32,
        (SettingValue::None, Some(first)) => first,
        _ => {
            return Err(format!(
                "{label} has a value for each part; give it a single value first."
            ));
        }
    };
    let world = |value: f32| -> Option<StagedChampion> {
        let trial = with_fields(&settings, [(field, &*value.to_string())]).ok()?.trial;
        let words = if trial == *champion.trial() {
            let value = listed.setting.value_in_words(&listed.value);
            format!("{} {value} (as before)", listed.setting.short_name())
        } else {
            world_in_words(champion.trial(), &trial)
        };
        let staged = if trial == champion.champion().trial {
            champion.as_found().simulated().named(words)
        } else {
            champion.in_world(&trial, words)
        };
        staged.check().is_ok().then_some(staged)
    };
    let refusal = format!("The snake on the stage fits no other value of {label}.");
    race_of(values(range, now).into_iter().filter_map(world), refusal)
}

/// Returns the values of a sweep in ascending order. With a logarithmic slider they are ratios of the present value.
/// Otherwise they are spread evenly over the slider, and the nearest is replaced by the present value.
fn values(range: &NumberRange, now: f32) -> Vec<f32> {
    let [from, to] = range.slider.unwrap_or([range.least, range.most]);
    let (from, to) = (from.min(now), to.max(now));
    let is_of_proportion = range.logarithmic_from.is_some() && now > 0.0;
    let mut values: Vec<f32> = if is_of_proportion {
        RATIOS.map(|ratio| if ratio == 1.0 { now } else { rounded(now * ratio) }).into()
    } else {
        let step = (to - from) / f32::from(VALUES - 1);
        let mut spread: Vec<f32> =
            (0..VALUES).map(|index| rounded(from + f32::from(index) * step)).collect();
        let distance = |value: &f32| (value - now).abs();
        let nearest = spread.iter_mut().min_by(|a, b| distance(a).total_cmp(&distance(b)));
        nearest.into_iter().for_each(|nearest| *nearest = now);
        spread
    };
    for value in &mut values {
        let whole = if range.is_whole { value.round() } else { *value };
        *value = whole.clamp(range.least, range.most);
    }
    values.sort_by(f32::total_cmp);
    values.dedup();
    values
}

/// Rounds a value to three significant digits, which fit into a label.
fn rounded(value: f32) -> f32 {
    format!("{value:.2e}").parse().unwrap_or(value)
}

/// Returns the settings in which a lane's world differs from the one in which its champion was found: full dotted names
/// and values as text.
pub(crate) fn changes_of(staged: &StagedChampion) -> Vec<(String, String)> {
    let found = fields(&settings_of(&staged.champion().trial));
    let mut shown = fields(&settings_of(staged.trial()));
    shown.retain(|field| !found.contains(field));
    shown
}

fn settings_of(trial: &Trial) -> Settings {
    Settings { trial: trial.clone(), ..Settings::default() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::stage::StageMode;
    use crate::studio::state::current_run::climber;
    use snakes_core::world::PhysicsEngine;

    #[test]
    fn a_sweep_shows_five_values_of_one_setting_and_names_them() {
        let show = sweep(&climber(0), "trial.surface.friction").expect("a number");
        let labels: Vec<&str> = show.champions.iter().map(StagedChampion::label).collect();
        assert_eq!(
            labels,
            ["friction 0.2", "friction 0.5", "friction 1 (as before)", "friction 2", "friction 5"]
        );
        assert_eq!(show.mode, StageMode::Race);
        let changed = &show.champions[0];
        let changes = changes_of(changed);
        assert_eq!(changes, [("trial.surface.friction".to_owned(), "0.2".to_owned())]);
    }

    #[test]
    fn every_number_of_the_world_gives_several_worlds_or_a_reason() {
        let champion = climber(0);
        for listed in list(&settings_of(champion.trial())) {
            match sweep(&champion, &listed.path) {
                Ok(show) => {
                    assert!((2..=5).contains(&show.champions.len()), "{}", listed.path);
                    let is_now = |staged: &&StagedChampion| !staged.is_changed();
                    assert!(show.champions.iter().filter(is_now).count() <= 1, "{}", listed.path);
                }
                Err(reason) => assert!(reason.ends_with('.'), "{reason}"),
            }
        }
        assert!(sweep(&champion, "evolution.population").is_err(), "it is not of the world");
    }

    #[test]
    fn softness_is_swept_in_the_engine_of_the_champion() {
        let mut trial = climber(0).trial().clone();
        trial.physics.engine = PhysicsEngine::Lanes;
        let in_lanes = climber(0).in_world(&trial, "lanes".to_owned());
        let show = sweep(&in_lanes, "trial.agent.youngs_modulus_pa").expect("soft snakes");
        let engines = show.champions.iter().map(|staged| staged.trial().physics.engine);
        assert!(engines.eq(show.champions.iter().map(|_| PhysicsEngine::Lanes)));
    }

    #[test]
    fn values_have_three_digits_and_stay_within_the_range() {
        assert_eq!([0.12345, 1234.5, 0.0].map(rounded), [0.123, 1230.0, 0.0]);
    }
}
