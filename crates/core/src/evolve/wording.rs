//! Short descriptions of changed settings, for titles and labels.

use super::settings::Settings;
use crate::schema::{ListedSetting, SettingKind, SettingValue, list};
use crate::score::Trial;

/// Maximum number of settings that a description names. Further ones are counted.
const MOST_NAMED: usize = 2;
/// Maximum number of values that a description names, for a setting with a separate value for each part.
const MOST_VALUES: usize = 5;

/// Describes the differences between two worlds: "friction 0.5, rise 0.7".
pub fn world_in_words(original: &Trial, changed: &Trial) -> String {
    let of = |trial: &Trial| Settings { trial: trial.clone(), ..Settings::default() };
    changes_in_words(&of(original), &of(changed))
}

/// Describes the differences between two settings.
pub fn changes_in_words(original: &Settings, changed: &Settings) -> String {
    let (before, mut after) = (list(original), list(changed));
    after.sort_by(|a, b| a.path.cmp(&b.path));
    let is_of_stairs = |listed: &ListedSetting| listed.path.starts_with("trial.stairs.");
    let differs = |listed: &ListedSetting| {
        !before.iter().any(|before| before.path == listed.path && before.value == listed.value)
    };
    let stairs = after.iter().filter(|listed| is_of_stairs(listed) && differs(listed)).count();
    let mut other: Vec<String> = after
        .into_iter()
        .filter_map(|listed| {
            if stairs > 1 && is_of_stairs(&listed) {
                return differs(&listed).then(|| "other stairs".to_owned());
            }
            let was = before.iter().find(|before| before.path == listed.path);
            // The names of switches and choices say little without their labels in the panels.
            let name = match listed.setting.kind {
                SettingKind::Choice(_) | SettingKind::Switch => listed.setting.label.to_lowercase(),
                _ => listed.setting.short_name(),
            };
            match was {
                Some(was) if was.value == listed.value => None,
                Some(_) => Some(match (&listed.value, listed.setting.kind) {
                    (SettingValue::List(values), SettingKind::Number(range))
                        if values.len() > MOST_VALUES =>
                    {
                        let part = range.parts.word();
                        match was.and_then(|was| only_other(&was.value, values)) {
                            Some(index) => format!("{name} of {part} {}", index + 1),
                            None => format!("{name} of each {part}"),
                        }
                    }
                    _ => format!("{name} {}", listed.setting.value_in_words(&listed.value)),
                }),
                // A new group of settings is named as a whole.
                None => {
                    Some(format!("separate {}", listed.path.rsplit('.').nth(1).unwrap_or(&name)))
                }
            }
        })
        .collect();
    other.dedup();
    let mut text = other.iter().take(MOST_NAMED).cloned().collect::<Vec<_>>().join(", ");
    if other.len() > MOST_NAMED {
        text += &format!(" and {} more", other.len() - MOST_NAMED);
    }
    text
}

/// Returns the index of the only value that differs from the one before the change; `None` if several do.
fn only_other(before: &SettingValue, now: &[f32]) -> Option<usize> {
    let was = |index: usize| match before {
        SettingValue::List(before) => before.get(index).copied(),
        SettingValue::Number(of_all) => Some(*of_all),
        _ => None,
    };
    let mut others = (0..now.len()).filter(|index| was(*index) != Some(now[*index]));
    others.next().filter(|_| others.next().is_none())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::{with_field, with_fields};
    use crate::genome::ControllerKind;

    #[test]
    fn a_changed_angle_is_named_in_degrees() {
        let original = Settings::default();
        let limits = with_field(&original, "bend_limit_rad", "1").expect("allowed");
        assert_eq!(changes_in_words(&original, &limits), "bend limit 57.3°");
        let rise = with_field(&original, "rise_m", "0.7").expect("allowed");
        assert_eq!(changes_in_words(&original, &rise), "rise 0.7");
    }

    #[test]
    fn a_choice_and_a_switch_are_named_as_the_panels_show_them() {
        let mut original = Settings::default();
        original.genome.controller = ControllerKind::Gait;
        let changes = [("evolution.strategy", "body_ga"), ("genome.bodies.vary", "true")];
        let bodies = with_fields(&original, changes).expect("allowed");
        let words = "strategy Genetic algorithm of bodies, evolve bodies on";
        assert_eq!(changes_in_words(&original, &bodies), words);
    }

    #[test]
    fn a21_long_lists_are_not_spelled_out_and_one_other_step_is_named() {
        let original = Settings::default();
        let list = format!("[{}0.7]", "0.5, ".repeat(9));
        let uneven = with_field(&original, "rise_m", &list).expect("allowed");
        assert_eq!(changes_in_words(&original, &uneven), "rise of step 10", "a21");
        let list = format!("[0.4, {}0.7]", "0.5, ".repeat(8));
        let several = with_field(&original, "rise_m", &list).expect("allowed");
        assert_eq!(changes_in_words(&original, &several), "rise of each step");
        assert_eq!(changes_in_words(&several, &uneven), "rise of step 1", "a21");
        let damping = with_field(&original, "joint_damping_nms_per_rad", "[30, 30, 20, 10]");
        let damping = damping.expect("allowed");
        let words = changes_in_words(&original, &damping);
        assert!(words.starts_with("joint damping [30, 30, 20, 10]"), "{words}");
        let nosing = with_field(&uneven, "nosing_m", "0.1").expect("allowed");
        assert_eq!(changes_in_words(&original, &nosing), "other stairs");
        let friction = with_field(&nosing, "surface.friction", "0.5").expect("allowed");
        assert_eq!(changes_in_words(&original, &friction), "other stairs, friction 0.5");
    }
}
