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

use super::lesson::{CommonPlan, Lesson, Side};

/// All lessons in the order of their numbers: first those that need no knowledge, last those about programming. Only findings and
/// conclusions may state a result, because the other texts are shown before the experiments.
pub(crate) const LESSONS: [Lesson; 9] = [
    report::FRICTION,
    report::MUTATIONS,
    senses::ONE_MOTION,
    senses::BLINDFOLD,
    ladder::LADDER,
    report::JOINT_LIMITS,
    bodies::PROTECTION,
    report::FRAME_RATE,
    report::REPETITION,
];

/// Returns a built-in champion in each of these worlds or bodies.
pub(super) fn champions(
    champion: &'static str,
    lanes: &[Side],
) -> Result<Vec<StagedChampion>, String> {
    let place = SavePlace::Shipped(champion);
    let (loaded, _) = load_entry(&place)?;
    let original = StagedChampion::from_lesson(&loaded.champion).named("original".to_owned());
    lanes
        .iter()
        .map(|Side { name, changes, body_change, .. }| {
            if let Some((change, block)) = *body_change {
                return with_changed_body(&loaded.champion, change, block)
                    .map(|staged| staged.named((*name).to_owned()));
            }
            let settings = Settings { trial: original.trial().clone(), ..Settings::default() };
            let settings = with_fields(&settings, changes.iter().copied())?;
            let same = original.clone().named("The same snake".to_owned());
            let changed = same.in_world(&settings.trial, (*name).to_owned());
            let staged = if changed.is_changed() { changed } else { original.clone() };
            staged.check()?;
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
    let own = champion.trial.with_own_blocks(&champion.genome)?;
    let genome = changed_body(&own, change, block)
        .ok_or_else(|| format!("{} is not possible at block {block}.", change.name()))?;
    let evaluation = evaluate(&genome, &champion.trial);
    Ok(StagedChampion::from_lesson(&Champion { genome, evaluation, ..champion.clone() }))
}

/// Returns the plan and the thread count of a run: a preset with changes.
pub(super) fn plan(common: &CommonPlan, side: &Side) -> Result<(RunPlan, usize), String> {
    let preset = load_preset(common.preset)?;
    let changes = common.changes.iter().chain(side.changes).copied();
    let settings = with_fields(&preset.settings, changes)?;
    Ok((RunPlan::new(&preset.name, common.seed, settings), side.threads))
}
