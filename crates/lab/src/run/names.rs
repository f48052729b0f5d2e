//! Readable names of presets and runs: "Climb 1, 27 Nov, 26 m".

use std::collections::BTreeMap;
use std::path::Path;
use std::time::Duration;

use snakes_core::save::{RunSummary, load_log};
use snakes_core::score::Fitness;

/// The built-in presets by group, each with its readable title. The first group is for a first look.
pub const PRESET_TITLES: [(&str, &[(&str, &str)]); 6] = [
    (
        "",
        &[
            ("climb", "Climb"),
            ("ice", "Smooth ice"),
            ("mud", "Deep mud"),
            ("house", "Stairs of a house"),
            ("bodies", "Bodies that evolve"),
            ("creatures", "Branching creatures"),
        ],
    ),
    (
        "Surfaces",
        &[
            ("rubber", "Rubber mat"),
            ("trampoline", "Trampoline"),
            ("moon", "The Moon"),
            ("thick-air", "Thick air"),
            ("panda-manual", "Surface of the engine's manual"),
        ],
    ),
    (
        "Stairs",
        &[
            ("ladder", "Steps that grow"),
            ("mixed-stairs", "Many stairs, blocks with neurons"),
            ("generalist", "Any stairs"),
            ("poet", "Stairs that evolve, too (POET)"),
        ],
    ),
    ("Bodies", &[("squishy", "Soft blocks")]),
    (
        "Brains",
        &[
            ("senses", "Reflexes"),
            ("limb-neurons", "Neurons in the blocks"),
            ("neat", "Networks that grow (NEAT)"),
            ("q-learning", "Trial and error (Q-learning)"),
            ("xcs", "Rules by accuracy (XCS)"),
            ("zcs", "Rules by strength (ZCS)"),
            ("waves-by-rules", "Rules that choose waves"),
        ],
    ),
    (
        "Research",
        &[
            ("report", "The report's experiment"),
            ("steady", "The report's method, calmer snake"),
            ("quick", "A quick try"),
        ],
    ),
];

/// Returns the readable title of a preset, or its name if it is one of the user's.
pub fn preset_title(name: &str) -> &str {
    let mut all = PRESET_TITLES.iter().flat_map(|(_, presets)| presets.iter());
    all.find(|(of, _)| *of == name).map_or(name, |(_, title)| title)
}

/// Replaces the name of the preset, with which a description of settings begins, by its readable title.
pub fn with_title(settings: &str) -> String {
    let preset = settings.split(", ").next().unwrap_or_default();
    format!("{}{}", preset_title(preset), &settings[preset.len()..])
}

/// Returns the readable name of a run: title of the preset, seed, day, best result, and in brackets the settings that
/// differ from the preset. `settings` are the run's settings in words; a zero `saved_at` is an unknown day.
pub fn run_name(
    settings: &str,
    seed: u64,
    saved_at: Duration,
    best: Option<(Fitness, f32)>,
) -> String {
    let (preset, changes) = settings.split_once(", ").unwrap_or((settings, ""));
    let mut name = format!("{} {seed}", preset_title(preset));
    let day = date(saved_at);
    let day = day.rsplit_once(' ').filter(|_| !saved_at.is_zero()).map(|(day, _)| day.to_owned());
    let best = best.map(|(rewarded, best)| way_in_words(rewarded, best));
    for part in day.into_iter().chain(best) {
        name += &format!(", {part}");
    }
    if changes.is_empty() { name } else { format!("{name} ({changes})") }
}

/// Returns the readable name of a listed run, or the user's own name for it. Only a run that can be resumed is named with its best result,
/// for which its whole log is read: there may be many finished ones.
pub fn name_of_listed(run: &RunSummary, settings: &str) -> String {
    let best = || {
        let (_, records) = run.is_stopped().then(|| load_log(&run.folder).ok())??;
        let each = records.iter().filter_map(|record| Some(record.statistics?.best as f32));
        each.reduce(f32::max).map(|best| (run.plan.settings.trial.fitness, best))
    };
    let readable = || run_name(settings, run.plan.seed, run.saved_at, best());
    run.name.clone().unwrap_or_else(readable)
}

/// Describes a fitness in a few letters: whole metres, a share of the way, or steps.
fn way_in_words(rewarded: Fitness, fitness: f32) -> String {
    match rewarded {
        Fitness::Share if fitness >= 1.0 => "at the top".to_owned(),
        Fitness::Share => format!("{:.0} %", fitness * 100.0),
        Fitness::StepsClimbed => rewarded.text(fitness),
        // Adding zero removes the sign of a negative zero.
        other => format!("{}{}", fitness.round_ties_even() + 0.0, other.unit()),
    }
}

/// Returns the part of a run's folder that tells the run apart from others of the same name: eight hexadecimal digits for
/// runs of the same preset and seed, or the name of the folder for runs that the user named.
pub fn difference(folder: &Path, is_named_by_user: bool) -> String {
    let name = folder.file_name().unwrap_or_default().to_string_lossy();
    let of_run = name.split_once("-seed").and_then(|(_, rest)| rest.split_once('-'));
    let of_run = of_run.filter(|_| !is_named_by_user);
    of_run.map_or(name.as_ref(), |(_, digits)| digits).to_owned()
}

/// Adds the [`difference`] of its folder to each name that several runs have.
pub fn tell_apart<'a>(runs: impl Iterator<Item = (&'a mut String, String)>) {
    let mut same: BTreeMap<String, Vec<(&mut String, String)>> = BTreeMap::new();
    for (name, folder) in runs {
        same.entry(name.clone()).or_default().push((name, folder));
    }
    for (name, folder) in same.into_values().filter(|same| same.len() > 1).flatten() {
        *name += &format!(" ({folder})");
    }
}

/// Formats the time since the beginning of 1970 as a date in UTC: "21 Nov 2026".
pub fn date(since_1970: Duration) -> String {
    const MONTHS: [&str; 12] =
        ["Mar", "Apr", "May", "Jun", "Jul", "Aug", "Sep", "Oct", "Nov", "Dec", "Jan", "Feb"];
    // Days since the first of March of the year 0. If years begin in March, a leap day is the last day of its year.
    let days = since_1970.as_secs() / 86_400 + 719_468;
    let (era, day_of_era) = (days / 146_097, days % 146_097);
    let year_of_era =
        (day_of_era - day_of_era / 1460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let month = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * month + 2) / 5 + 1;
    let year = era * 400 + year_of_era + u64::from(month >= 10);
    let month = MONTHS.get(month as usize).copied().unwrap_or_default();
    format!("{day} {month} {year}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates_are_those_of_the_calendar() {
        for (seconds, expected) in [
            (0, "1 Jan 1970"),
            (951_782_400, "29 Feb 2000"),
            (1_709_251_199, "29 Feb 2024"),
            (1_709_251_200, "1 Mar 2024"),
            (1_798_761_599, "31 Dec 2026"),
            (4_107_542_400, "1 Mar 2100"),
        ] {
            assert_eq!(date(Duration::from_secs(seconds)), expected);
        }
    }

    #[test]
    fn a_run_is_named_by_its_experiment_seed_day_and_best_result() {
        let day = Duration::from_secs(1_795_737_600);
        for (settings, saved_at, best, name) in [
            ("climb", day, Some((Fitness::Climb, 26.04)), "Climb 1, 27 Nov, 26 m"),
            ("neat", day, None, "Networks that grow (NEAT) 1, 27 Nov"),
            ("my-own", Duration::ZERO, Some((Fitness::Share, 0.449)), "my-own 1, 45 %"),
            ("climb", day, Some((Fitness::Share, 1.013)), "Climb 1, 27 Nov, at the top"),
            (
                "ice, friction 0.2",
                day,
                Some((Fitness::Centre, -0.2)),
                "Smooth ice 1, 27 Nov, 0 m (friction 0.2)",
            ),
        ] {
            assert_eq!(run_name(settings, 1, saved_at, best), name);
        }
        assert_eq!(with_title("ice, friction 0.2"), "Smooth ice, friction 0.2");
    }

    #[test]
    fn two_runs_never_read_alike() {
        let mut names = ["Climb 1", "Climb 2", "Climb 1"].map(str::to_owned);
        tell_apart(names.iter_mut().zip(["a", "b", "c"].map(str::to_owned)));
        assert_eq!(names, ["Climb 1 (a)", "Climb 2", "Climb 1 (c)"]);
    }
}
