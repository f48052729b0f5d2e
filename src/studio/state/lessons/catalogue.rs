//! Texts and scenes of the lessons. Tests in [`super`] check that the conclusions are true.

mod bodies;
mod ladder;
mod report;
mod senses;

use crate::studio::stage::staged_champion::StagedChampion;
use crate::studio::state::body_editor::changed_body;
use snakes_core::evolve::{Champion, RunPlan, Settings, with_fields};
use snakes_core::genome::BodyChange;
use snakes_core::save::library::{SavePlace, load_entry};
use snakes_core::save::load_preset;
use snakes_core::score::evaluate;

use super::lesson::{Lesson, Side};

/// Explanation why a snake that ends further does not always have greater fitness.
pub(crate) const FITNESS_OF_THE_LANDED: &str = "Fitness is the distance, but it stops counting at 26.00 m, where the \
    whole snake is on the landing.";

/// Order of the lessons in the panel, by their indices: first those that need no knowledge, last those about programming.
pub(crate) const LESSON_ORDER: [usize; LESSONS.len()] = [0, 3, 5, 6, 8, 2, 7, 1, 4];

/// All lessons. Only findings and conclusions may state a result, because the other texts are shown before the experiments.
pub(crate) const LESSONS: [Lesson; 9] = [
    report::FRICTION,
    report::FRAME_RATE,
    report::JOINT_LIMITS,
    report::MUTATIONS,
    report::REPETITION,
    senses::LEARNED_BY_HEART,
    senses::BLINDFOLD,
    bodies::PROTECTION,
    ladder::LADDER,
];

/// Returns a built-in champion in each of these worlds or bodies.
pub(super) fn champions(
    champion: &'static str,
    lanes: &[Side],
) -> Result<Vec<StagedChampion>, String> {
    let place = SavePlace::Shipped(champion);
    let (loaded, _) = load_entry(&place).map_err(|error| error.to_string())?;
    let original = StagedChampion::from_lesson(&loaded.champion).named("original".to_owned());
    lanes
        .iter()
        .map(|Side { name, changes, body_change, .. }| {
            if let Some((change, block)) = *body_change {
                return with_changed_body(&loaded.champion, change, block)
                    .map(|staged| staged.named((*name).to_owned()));
            }
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

/// Returns a champion with a changed body and its old gait.
fn with_changed_body(
    champion: &Champion,
    change: BodyChange,
    block: usize,
) -> Result<StagedChampion, String> {
    let own = champion.trial.with_own_blocks(&champion.genome);
    let own = own.map_err(|error| error.to_string())?;
    let genome = changed_body(&own, change, block)
        .ok_or_else(|| format!("{} is not possible at block {block}.", change.name()))?;
    let evaluation = evaluate(&genome, &champion.trial);
    Ok(StagedChampion::from_lesson(&Champion { genome, evaluation, ..champion.clone() }))
}

/// Returns the plan and the thread count of a run: a preset with changes.
pub(super) fn plan(preset: &str, side: &Side) -> Result<(RunPlan, usize), String> {
    let preset = load_preset(preset).map_err(|error| error.to_string())?;
    let settings = with_fields(&preset.settings, side.changes.iter().copied())
        .map_err(|error| error.to_string())?;
    Ok((RunPlan::new(&preset.name, side.seed, settings), side.threads))
}
