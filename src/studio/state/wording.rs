//! Short descriptions of changed settings, for titles and labels.

use crate::evolve::Settings;
use crate::schema::list;
use crate::score::Trial;

/// Maximum number of settings named in a description; more are counted.
const MOST_NAMED: usize = 2;

/// Description of the differences between two worlds: "friction 0.5, rise 0.7".
pub(crate) fn world_in_words(original: &Trial, changed: &Trial) -> String {
    let of = |trial: &Trial| Settings { trial: trial.clone(), ..Settings::default() };
    changes_in_words(&of(original), &of(changed))
}

/// Description of the differences between two settings.
pub(crate) fn changes_in_words(original: &Settings, changed: &Settings) -> String {
    let (before, mut after) = (list(original), list(changed));
    after.sort_by(|a, b| a.path.cmp(&b.path));
    let mut other: Vec<String> = after
        .into_iter()
        .filter_map(|listed| {
            let was = before.iter().find(|before| before.path == listed.path);
            let name = listed.setting.short_name();
            match was {
                Some(was) if was.value == listed.value => None,
                Some(_) => Some(format!("{name} {}", listed.setting.value_in_words(&listed.value))),
                // A new group is named as a whole.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::with_field;

    #[test]
    fn a_changed_angle_is_named_in_degrees() {
        let original = Settings::default();
        let limits = with_field(&original, "bend_limit_rad", "1").expect("allowed");
        assert_eq!(changes_in_words(&original, &limits), "bend limit 57.3°");
        let rise = with_field(&original, "rise_m", "0.7").expect("allowed");
        assert_eq!(changes_in_words(&original, &rise), "rise 0.7");
    }
}
