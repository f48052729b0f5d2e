//! Short descriptions of changed settings, for titles and labels.

use crate::evolve::Settings;
use crate::schema::list;
use crate::score::Trial;

/// A change is named by so many settings; more are counted.
const MOST_NAMED: usize = 2;

/// What is other in a world, in a few words: "friction 0.5, rise 0.7".
pub(crate) fn world_in_words(original: &Trial, changed: &Trial) -> String {
    let of = |trial: &Trial| Settings { trial: trial.clone(), ..Settings::default() };
    changes_in_words(&of(original), &of(changed))
}

/// What is other in some settings, in a few words.
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
                Some(_) => Some(format!("{name} {}", listed.value)),
                // A group that was not there before is named as a whole.
                None => Some(format!("own {}", listed.path.rsplit('.').nth(1).unwrap_or(&name))),
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
