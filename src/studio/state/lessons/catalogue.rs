//! Texts and scenes of the lessons. Tests in [`super`] check that the conclusions are true.

mod report;
mod senses;

use crate::evolve::{RunPlan, Settings, with_fields};
use crate::save::library::{SavePlace, load_entry};
use crate::save::load_preset;
use crate::studio::stage::staged_champion::StagedChampion;

use super::lesson::{Lesson, Side};

/// Why a snake that ends further may not have more fitness.
pub(crate) const FITNESS_OF_THE_LANDED: &str = "Fitness is the distance, but it stops counting at 26.00 m, where the \
    whole snake is on the landing.";

/// All lessons. Only findings and conclusions may state a result: the other texts are read before the experiments.
pub(crate) const LESSONS: [Lesson; 7] = [
    report::FRICTION,
    report::FRAME_RATE,
    report::JOINT_LIMITS,
    report::MUTATIONS,
    report::REPETITION,
    senses::LEARNED_BY_HEART,
    senses::BLINDFOLD,
];

/// A built-in champion in each of these worlds.
pub(super) fn champions(
    champion: &'static str,
    lanes: &[Side],
) -> Result<Vec<StagedChampion>, String> {
    let place = SavePlace::Shipped(champion);
    let (loaded, _) = load_entry(&place).map_err(|error| error.to_string())?;
    let original = StagedChampion::from_lesson(&loaded.champion).named("original".to_owned());
    lanes
        .iter()
        .map(|Side { name, changes, .. }| {
            let settings = Settings { trial: original.trial().clone(), ..Settings::default() };
            let settings = with_fields(&settings, changes.iter().copied())
                .map_err(|error| error.to_string())?;
            let same = original.clone().named("The same snake".to_owned());
            let changed = same.in_world(&settings.trial, (*name).to_owned());
            let staged = if changed.is_changed() { changed } else { original.clone() };
            staged.check().map_err(|error| error.to_string())?;
            Ok(staged)
        })
        .collect()
}

/// Plan and thread count of a run: the preset "quick" with changes.
pub(super) fn plan(side: &Side) -> Result<(RunPlan, usize), String> {
    let preset = load_preset("quick").map_err(|error| error.to_string())?;
    let settings = with_fields(&preset.settings, side.changes.iter().copied())
        .map_err(|error| error.to_string())?;
    Ok((RunPlan::new(&preset.name, side.seed, settings), side.threads))
}
