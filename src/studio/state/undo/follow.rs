//! Updates the stage after an undo or redo of the next run's plan.

use std::collections::BTreeMap;

use crate::studio::stage::{Show, StageMode};
use crate::studio::state::what_if::{ChangedStage, unsuited};
use snakes_core::evolve::{RunPlan, Settings, fields, with_fields, world_in_words};
use snakes_core::score::Trial;

/// Returns the champions to show after the plan changed from `from` to `to`. The world settings that differ also change
/// on the stage. `None` if this does not affect the stage.
///
/// # Errors
/// The champion on the stage does not fit the changed world.
pub(crate) fn followed(
    stage: ChangedStage,
    from: &RunPlan,
    to: &RunPlan,
) -> Result<Option<Show>, String> {
    let Some(first) = stage.show.champions.first() else { return Ok(None) };
    let shown = stage.current().unwrap_or(first);
    let (original, begins) = match &stage.show.mode {
        // In a race, no lane belongs to a change.
        StageMode::Race => return Ok(None),
        StageMode::WhatIf { before, .. } => (first.clone(), Some(&**before)),
        StageMode::Solo | StageMode::Generation { .. } => (first.simulated(), None),
    };
    let trial = taken_over(shown.trial(), original.trial(), begins, from, to).map_err(unsuited)?;
    if trial == *shown.trial() {
        return Ok(None);
    }
    let label = world_in_words(&original.champion().trial, &trial);
    if begins.is_none() && first.is_changed() {
        // After a change was kept, its lane is alone on the stage, and undo changes the lane's world.
        let restored = original.in_world(&trial, label);
        restored.check().map_err(unsuited)?;
        return Ok(Some(Show::solo(restored)));
    }
    stage.with_world(from, &trial, label).map(Some)
}

/// Applies the differences between two plans to the world on the stage. A setting that returns to its value from the
/// start of the what-if gets the value of the original lane.
fn taken_over(
    shown: &Trial,
    original: &Trial,
    begins: Option<&RunPlan>,
    from: &RunPlan,
    to: &RunPlan,
) -> Result<Trial, String> {
    let named = |trial: &Trial| -> BTreeMap<String, String> {
        // A separate ground is compared as a whole further below.
        let trial = Trial { ground: None, ..trial.clone() };
        fields(&Settings { trial, ..Settings::default() }).into_iter().collect()
    };
    let (old, new) = (named(&from.settings.trial), named(&to.settings.trial));
    // After a change of the preset, the whole world on the stage changes.
    let is_other_preset = from.preset != to.preset && from.settings.trial != to.settings.trial;
    let begins = begins.filter(|begins| !is_other_preset || begins.preset == to.preset);
    let (originally, at_first) =
        (named(original), begins.map(|begins| named(&begins.settings.trial)));
    let other = new.iter().filter(|(field, value)| {
        if is_other_preset { !stays_with_a_preset(field) } else { old.get(*field) != Some(value) }
    });
    let restored: Vec<(&str, &str)> = other
        .map(|(field, value)| {
            let is_as_at_first =
                at_first.as_ref().is_some_and(|at_first| at_first.get(field) == Some(value));
            let own = originally.get(field).filter(|_| is_as_at_first);
            (field.as_str(), own.unwrap_or(value).as_str())
        })
        .collect();
    let mut trial = shown.clone();
    let (old_ground, new_ground) = (&from.settings.trial.ground, &to.settings.trial.ground);
    if old_ground != new_ground || is_other_preset {
        let is_as_at_first =
            begins.is_some_and(|begins| begins.settings.trial.ground == *new_ground);
        trial.ground = if is_as_at_first { original.ground.clone() } else { new_ground.clone() };
    }
    let settings = Settings { trial, ..to.settings.clone() };
    Ok(with_fields(&settings, restored)?.trial)
}

/// Returns whether a setting of the stage is kept when the preset changes, so that the lanes remain comparable.
fn stays_with_a_preset(field: &str) -> bool {
    let fields =
        ["trial.duration_s", "trial.fitness", "trial.energy_cost_per_kj", Trial::ENGINE_FIELD];
    fields.contains(&field) || field.starts_with("trial.repeats.")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::state::current_run::{climber, prepared_run};
    use crate::studio::state::what_if::tests::{changed, changed_by, labels, solo, stage, tried};
    use crate::studio::state::what_if::{WorldChange, another_beside, dropped};

    /// Returns the stage after a step from one plan to another, which must affect the stage.
    fn step(show: &Show, from: &RunPlan, to: &RunPlan) -> Show {
        followed(stage(show), from, to).expect("fits").expect("the world differs")
    }

    #[test]
    fn undo_reverts_the_changed_lane_step_by_step() {
        let (mut run, start, first) = tried();
        let one = run.plan_next.clone();
        let second = changed(&mut run, &first, "stairs.rise_m", "0.7");
        let back = step(&second, &run.plan_next, &one);
        assert_eq!(back.champions[1].trial(), first.champions[1].trial());
        assert_eq!(back.champions[1].label(), "friction 0.3");
        let end = step(&back, &one, &start);
        assert_eq!((end.champions.len(), &end.mode), (1, &StageMode::Solo));
        assert_eq!(end.champions[0].trial(), climber(0).trial());
        // The step is redone.
        let forth = step(&end, &start, &one);
        assert_eq!(forth.champions[1].trial(), first.champions[1].trial());
        assert_eq!(forth.mode, StageMode::what_if(start));
    }

    #[test]
    fn a_lane_that_stays_is_left_alone_by_undo() {
        let (mut run, start, tried) = tried();
        let fixed = another_beside(&run, tried).expect("there is a copy");
        let one = run.plan_next.clone();
        let three = changed(&mut run, &fixed, "surface.friction", "2");
        assert_eq!(labels(&three), ["climber", "friction 0.3", "friction 2"]);
        let two = run.plan_next.clone();
        let back = step(&three, &two, &one);
        assert_eq!(labels(&back), ["climber", "friction 0.3"]);
        // After a further undo, the next run has the world of the original, but the copy stays.
        let first = step(&back, &one, &start);
        assert_eq!(labels(&first), ["climber", "friction 0.3"]);
        assert!(matches!(first.mode, StageMode::WhatIf { current: 0, .. }), "{:?}", first.mode);
        let forth = step(&first, &start, &two);
        assert_eq!(labels(&forth), ["climber", "friction 0.3", "friction 2"]);
    }

    #[test]
    fn a_preset_is_undone_and_redone_and_the_engine_of_the_champion_stays() {
        let mut run = prepared_run();
        let start = run.plan_next.clone();
        let tried = changed_by(&mut run, &solo(), &WorldChange::Preset("ice"));
        let back = step(&tried, &run.plan_next, &start);
        assert_eq!((back.champions.len(), back.champions[0].trial()), (1, climber(0).trial()));
        let forth = step(&back, &start, &run.plan_next);
        assert_eq!(forth.champions[1].trial(), tried.champions[1].trial());
        let own = climber(0).trial().physics.engine;
        assert_eq!(forth.champions[1].trial().physics.engine, own);
        assert_ne!(run.next_settings().trial.physics.engine, own);
    }

    #[test]
    fn undoing_a_discard_shows_the_change_again() {
        let (mut run, _, tried) = tried();
        let with_change = run.plan_next.clone();
        let alone = dropped(&mut run, &tried).expect("allowed");
        let again = step(&alone.expect("the original"), &run.plan_next, &with_change);
        assert_eq!(again.champions[1].label(), "friction 0.3");
    }

    #[test]
    fn undoing_a_kept_change_leaves_one_lane() {
        let (run, start, tried) = tried();
        let kept = Show::solo(tried.champions[1].clone());
        let back = step(&kept, &run.plan_next, &start);
        assert_eq!((back.champions.len(), back.mode), (1, StageMode::Solo));
        let friction = start.settings.trial.surface.friction;
        assert_eq!(back.champions[0].trial().surface.friction, friction);
    }

    #[test]
    fn a_separate_ground_is_removed_as_a_whole() {
        let mut run = prepared_run();
        let start = run.plan_next.clone();
        let tried = changed(&mut run, &solo(), "ground.friction", "0.1");
        let back = step(&tried, &run.plan_next, &start);
        assert_eq!(back.champions[0].trial().ground, climber(0).trial().ground);
        assert_eq!(back.mode, StageMode::Solo);
    }

    #[test]
    fn races_and_changes_of_the_search_do_not_affect_the_stage() {
        let mut run = prepared_run();
        let before = run.plan_next.clone();
        run.set_field("evolution.population", "9").expect("allowed");
        let shown = followed(stage(&solo()), &before, &run.plan_next);
        assert!(shown.expect("fits").is_none());
        run.set_field("surface.friction", "0.3").expect("allowed");
        let race = Show::race(vec![climber(0), climber(1)]);
        let shown = followed(stage(&race), &before, &run.plan_next);
        assert!(shown.expect("fits").is_none());
    }
}
