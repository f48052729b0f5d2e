//! Copies beside the original: added, kept beside the next copy, kept alone, and discarded.

use super::*;
use crate::studio::state::current_run::{climber, prepared_run};
use snakes_core::save::library::{SavePlace, load_entry};
use snakes_core::world::PhysicsEngine;

/// Returns the built-in champion alone.
pub(in crate::studio::state) fn solo() -> Show {
    Show::solo(climber(0))
}

/// Returns a stage on which changes are tried from the start.
pub(in crate::studio::state) fn stage(show: &Show) -> ChangedStage<'_> {
    ChangedStage { show, moment: None }
}

fn field<'a>(field: &'a str, text: &'a str) -> WorldChange<'a> {
    WorldChange::Fields(vec![(field, text)])
}

/// Applies a change to a stage. The change must affect the stage.
pub(in crate::studio::state) fn changed_by(
    run: &mut CurrentRun,
    show: &Show,
    change: &WorldChange,
) -> Show {
    what_if(run, stage(show), change).expect("allowed").expect("it matters")
}

/// Applies a change of one setting: see [`changed_by`].
pub(in crate::studio::state) fn changed(
    run: &mut CurrentRun,
    show: &Show,
    name: &str,
    text: &str,
) -> Show {
    changed_by(run, show, &field(name, text))
}

/// Tries a friction of 0.3 with the built-in champion. Returns the run, the plan before the change, and the stage.
pub(in crate::studio::state) fn tried() -> (CurrentRun, RunPlan, Show) {
    let mut run = prepared_run();
    let start = run.plan_next.clone();
    let show = changed(&mut run, &solo(), "surface.friction", "0.3");
    (run, start, show)
}

/// Returns the built-in champion with a copy that is changed after this number of steps.
fn changed_at(step: u32, name: &str, text: &str) -> Show {
    let mut rollout = climber(0).rollout();
    while rollout.step() < step {
        assert!(rollout.advance());
    }
    let on_show = solo();
    let stage = ChangedStage { moment: Some(&rollout), ..stage(&on_show) };
    let shown = what_if(&mut prepared_run(), stage, &field(name, text));
    shown.expect("allowed").expect("it matters")
}

pub(in crate::studio::state) fn labels(show: &Show) -> Vec<&str> {
    show.champions.iter().map(StagedChampion::label).collect()
}

#[test]
fn changes_add_up_beside_the_original_and_can_be_kept_or_dropped() {
    let (mut run, plan, first) = tried();
    assert_eq!(labels(&first)[1], "friction 0.3");
    let second = changed(&mut run, &first, "stairs.rise_m", "0.7");
    let [original, copy] = &second.champions[..] else { panic!("two lanes") };
    assert!(!original.is_changed() && copy.is_changed());
    assert_eq!(copy.label(), "rise 0.7, friction 0.3");
    let third = changed(&mut run, &second, "ground.friction", "1");
    assert_eq!(labels(&third)[1], "separate ground, rise 0.7 and 1 more");
    assert_eq!(copy.trial().surface.friction, 0.3);
    assert_eq!(copy.trial().duration_s, original.trial().duration_s, "nothing else");
    let kept = kept(&second).expect("kept");
    assert_eq!(kept.champions[0].trial(), copy.trial());
    let shown = dropped(&mut run, &second);
    let shown = shown.expect("allowed").expect("the original");
    assert_eq!(shown.champions[0].trial(), original.trial());
    assert_eq!(run.plan_next, plan, "as it was before the first change");
    // Other settings that were changed meanwhile are kept.
    changed(&mut run, &solo(), "surface.friction", "0.3");
    run.set_seed(77);
    run.set_field("evolution.population", "9").expect("allowed");
    dropped(&mut run, &second).expect("allowed");
    assert_eq!((run.plan_next.seed, run.next_settings().evolution.population), (77, 9));
    assert_eq!(run.next_settings().trial, plan.settings.trial);
}

#[test]
fn a_second_change_names_the_first_one_that_was_kept() {
    let (mut run, _, first) = tried();
    let kept = kept(&first).expect("kept");
    let second = changed(&mut run, &kept, "stairs.rise_m", "0.7");
    assert_eq!(labels(&second), ["friction 0.3", "rise 0.7, friction 0.3"]);
}

#[test]
fn a_world_that_the_genome_does_not_fit_is_refused_with_the_reason() {
    let mut run = prepared_run();
    let refusal = what_if(&mut run, stage(&solo()), &field("agent.limbs", "7"));
    let refusal = refusal.expect_err("refused");
    assert!(refusal.contains("joints is 4 joints") && refusal.contains("7 limbs"), "{refusal}");
    let preset = changed_by(&mut run, &solo(), &WorldChange::Preset("ice"));
    assert_eq!(labels(&preset)[1], "ice");
}

#[test]
fn a_change_of_the_world_keeps_the_engine_of_a_champion() {
    let mut run = prepared_run();
    let engine_of = |show: &Show| show.champions[1].trial().physics.engine;
    for name in ["climber", "crawler"] {
        let (loaded, _) = load_entry(&SavePlace::Shipped(name)).expect("built in");
        let original = Show::solo(StagedChampion::from_file(&loaded, 0, name));
        let shown = changed_by(&mut run, &original, &WorldChange::Preset("ice"));
        assert_eq!(engine_of(&shown), PhysicsEngine::Rapier, "{name}");
        assert_eq!(run.next_settings().trial.physics.engine, PhysicsEngine::Lanes);
    }
    let in_lanes = changed(&mut run, &solo(), Trial::ENGINE_FIELD, "lanes");
    let kept = kept(&in_lanes).expect("kept");
    // The next run already has the engine rapier.
    run.set_preset("squishy").expect("shipped");
    let soft = changed(&mut run, &kept, "youngs_modulus_pa", "90000");
    assert_eq!(engine_of(&soft), PhysicsEngine::Lanes);
}

#[test]
fn settings_outside_the_world_do_not_affect_the_stage() {
    let mut run = prepared_run();
    let shown = what_if(&mut run, stage(&solo()), &field("evolution.population", "7"));
    assert!(shown.expect("allowed").is_none());
    assert_eq!(run.next_settings().evolution.population, 7);
}

#[test]
fn a_change_is_tried_from_the_moment_on_and_kept_from_the_start() {
    let show = changed_at(312, "surface.friction", "0.3");
    let copy = &show.champions[1];
    assert_eq!((copy.changes_at_step(), copy.label()), (Some(312), "friction 0.3"));
    assert_eq!(copy.caption(), "What if: friction 0.3, from 5.20 s on (climber)");
    assert!(!copy.must_match_record(), "its result is that of no trial");
    let kept = kept(&show).expect("a what-if");
    assert_eq!((kept.champions[0].changes_at_step(), kept.mode), (None, StageMode::Solo));
    assert_eq!(kept.champions[0].trial(), copy.trial());
}

#[test]
fn a_state_that_does_not_fit_starts_from_the_beginning_and_says_why() {
    let show = changed_at(700, "stairs.rise_m", "0.7");
    let copy = &show.champions[1];
    let reason = "from the start, because the snake has already reached the stairs";
    assert_eq!(copy.beginning_in_words().as_deref(), Some(reason));
    assert_eq!(copy.changes_at_step(), None);
}

#[test]
fn a_value_set_back_ends_the_what_if() {
    let (mut run, _, first) = tried();
    let own = climber(0).trial().surface.friction.to_string();
    let back = changed(&mut run, &first, "surface.friction", &own);
    assert_eq!((labels(&back), &back.mode), (vec!["climber"], &StageMode::Solo));
}

#[test]
fn two_settings_stand_side_by_side_and_each_can_be_kept_or_discarded() {
    let (mut run, start, ice) = tried();
    let fixed = another_beside(&run, ice).expect("a copy");
    let again = another_beside(&run, fixed.clone());
    assert!(again.is_err(), "it stays already");
    // The further lane also has the changes of the latest one.
    let both = changed(&mut run, &fixed, "stairs.rise_m", "0.7");
    assert_eq!(labels(&both), ["climber", "friction 0.3", "rise 0.7, friction 0.3"]);
    // Another value replaces the lane that is not kept.
    let both = changed(&mut run, &both, "surface.friction", "2");
    assert_eq!(labels(&both), ["climber", "friction 0.3", "rise 0.7, friction 2"]);
    let after_both = run.plan_next.clone();

    let kept = kept_lane(&mut run, &both, 1).expect("allowed");
    assert_eq!(labels(&kept.expect("a lane")), ["friction 0.3"]);
    let world = &run.next_settings().trial;
    assert_eq!(world.surface.friction, 0.3);
    assert_eq!(world.stairs.rise_m, start.settings.trial.stairs.rise_m);

    run.set_next_plan(after_both).expect("allowed");
    let kept = kept_lane(&mut run, &both, 2).expect("allowed");
    assert_eq!(labels(&kept.expect("a lane")), ["rise 0.7, friction 2"]);
    assert_eq!(run.next_settings().trial.surface.friction, 2.0);

    let one = dropped(&mut run, &both).expect("allowed").expect("lanes");
    assert_eq!(labels(&one), ["climber", "friction 0.3"]);
    assert_eq!(run.next_settings().trial.surface.friction, 0.3, "that of the lane before it");
    let none = dropped(&mut run, &one).expect("allowed").expect("lanes");
    assert_eq!((labels(&none), &none.mode), (vec!["climber"], &StageMode::Solo));
    assert_eq!(run.next_settings().trial, start.settings.trial);
}

#[test]
fn five_lanes_are_the_most() {
    let mut run = prepared_run();
    let mut show = changed(&mut run, &solo(), "surface.friction", "0.2");
    for friction in ["0.3", "0.4", "0.5"] {
        show = another_beside(&run, show).expect("there is room");
        show = changed(&mut run, &show, "surface.friction", friction);
    }
    assert_eq!(show.champions.len(), 5);
    let refusal = another_beside(&run, show.clone()).expect_err("full");
    assert!(refusal.contains("no room"), "{refusal}");
    show = changed(&mut run, &show, "surface.friction", "0.6");
    let expected = ["climber", "friction 0.2", "friction 0.3", "friction 0.4", "friction 0.6"];
    assert_eq!(labels(&show), expected, "the latest still changes");
}
