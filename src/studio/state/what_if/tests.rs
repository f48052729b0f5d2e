//! Copies beside the original: made, left beside the next, kept and discarded.

use super::*;
use crate::studio::state::current_run::prepared_run;
use snakes_core::save::library::{SavePlace, load_entry};
use snakes_core::save::shipped_champion;
use snakes_core::world::PhysicsEngine;

/// The stage with these champions, whose changes are tried from the start.
fn stage<'a>(on_show: &'a [StagedChampion], mode: &'a StageMode) -> ChangedStage<'a> {
    ChangedStage { on_show, mode, moment: None }
}

fn saved(index: usize) -> StagedChampion {
    StagedChampion::from_file(&shipped_champion().expect("well formed"), index, "climber")
}

#[test]
fn changes_add_up_beside_the_original_and_can_be_kept_or_dropped() {
    let mut run = prepared_run();
    let plan = run.next_plan().clone();
    let field = |field, text| WorldChange::Fields(vec![(field, text)]);
    let first =
        what_if(&mut run, stage(&[saved(0)], &StageMode::Solo), &field("surface.friction", "0.3"))
            .expect("allowed")
            .expect("it matters");
    assert_eq!(first.champions[1].label(), "friction 0.3");
    let second =
        what_if(&mut run, stage(&first.champions, &first.mode), &field("stairs.rise_m", "0.7"))
            .expect("allowed")
            .expect("it matters");
    let [original, changed] = &second.champions[..] else { panic!("two lanes") };
    assert!(!original.is_changed() && changed.is_changed());
    assert_eq!(changed.label(), "rise 0.7, friction 0.3");
    let ground = field("ground.friction", "1");
    let third = what_if(&mut run, stage(&second.champions, &second.mode), &ground);
    let third = third.expect("allowed").expect("it matters");
    assert_eq!(third.champions[1].label(), "separate ground, rise 0.7 and 1 more");
    assert_eq!(changed.trial().surface.friction, 0.3);
    assert_eq!(changed.trial().duration_s, original.trial().duration_s, "nothing else");
    let kept = kept(&second.champions, &second.mode).expect("kept");
    assert_eq!(kept.champions[0].trial(), changed.trial());
    let shown = dropped(&mut run, &second.champions, &second.mode);
    let shown = shown.expect("allowed").expect("the original");
    assert_eq!(shown.champions[0].trial(), original.trial());
    assert_eq!(*run.next_plan(), plan, "as it was before the first change");
    // Other settings changed meanwhile stay.
    what_if(&mut run, stage(&[saved(0)], &StageMode::Solo), &field("surface.friction", "0.3"))
        .expect("allowed");
    run.set_seed(77).expect("allowed");
    run.set_population(9).expect("allowed");
    dropped(&mut run, &second.champions, &second.mode).expect("allowed");
    assert_eq!((run.next_seed(), run.next_settings().evolution.population), (77, 9));
    assert_eq!(run.next_settings().trial, plan.settings.trial);
}

#[test]
fn a_second_change_names_the_first_one_that_was_kept() {
    let mut run = prepared_run();
    let change = |field, text| WorldChange::Fields(vec![(field, text)]);
    let first = change("surface.friction", "0.3");
    let first = what_if(&mut run, stage(&[saved(0)], &StageMode::Solo), &first);
    let first = first.expect("allowed").expect("it matters");
    let kept = kept(&first.champions, &first.mode).expect("kept");
    let second = change("stairs.rise_m", "0.7");
    let second = what_if(&mut run, stage(&kept.champions, &kept.mode), &second);
    let second = second.expect("allowed").expect("it matters");
    let labels: Vec<&str> = second.champions.iter().map(StagedChampion::label).collect();
    assert_eq!(labels, ["friction 0.3", "rise 0.7, friction 0.3"]);
}

#[test]
fn a_world_that_the_genome_does_not_fit_is_refused_with_the_reason() {
    let mut run = prepared_run();
    let limbs = WorldChange::Fields(vec![("agent.limbs", "7")]);
    let refusal = what_if(&mut run, stage(&[saved(0)], &StageMode::Solo), &limbs);
    let refusal = refusal.expect_err("refused");
    assert!(refusal.contains("joints is 4 joints") && refusal.contains("7 limbs"), "{refusal}");
    let preset =
        what_if(&mut run, stage(&[saved(0)], &StageMode::Solo), &WorldChange::Preset("ice"));
    let preset = preset.expect("allowed").expect("another world");
    assert_eq!(preset.champions[1].label(), "ice");
}

#[test]
fn the_engine_of_a_champion_changes_only_where_its_body_demands_it() {
    let mut run = prepared_run();
    let solo = StageMode::Solo;
    let ice = WorldChange::Preset("ice");
    let engine_of = |show: &Show| show.champions[1].trial().physics.engine;
    for name in ["climber", "crawler"] {
        let (loaded, _) = load_entry(&SavePlace::Shipped(name)).expect("built in");
        let original = StagedChampion::from_file(&loaded, 0, name);
        let shown = what_if(&mut run, stage(&[original], &solo), &ice);
        let shown = shown.expect("allowed").expect("another world");
        assert_eq!(engine_of(&shown), PhysicsEngine::Rapier, "{name}");
        assert_eq!(run.next_settings().trial.physics.engine, PhysicsEngine::Lanes);
    }
    let in_lanes = changed(&mut run, stage(&[saved(0)], &solo), Trial::ENGINE_FIELD, "lanes");
    let kept = kept(&in_lanes.champions, &in_lanes.mode).expect("kept");
    // The next run has rapier already.
    run.set_preset("squishy").expect("shipped");
    let soft = changed(&mut run, stage(&kept.champions, &kept.mode), "youngs_modulus_pa", "90000");
    assert_eq!(engine_of(&soft), PhysicsEngine::Rapier);
}

#[test]
fn settings_outside_the_world_do_not_affect_the_stage() {
    let mut run = prepared_run();
    let parents = WorldChange::Fields(vec![("evolution.population", "7")]);
    let shown = what_if(&mut run, stage(&[saved(0)], &StageMode::Solo), &parents).expect("allowed");
    assert!(shown.is_none());
    assert_eq!(run.next_settings().evolution.population, 7);
}

/// Applies a change of a field to a stage, which it must affect.
fn changed(run: &mut CurrentRun, stage: ChangedStage, field: &str, text: &str) -> Show {
    let shown = what_if(run, stage, &WorldChange::Fields(vec![(field, text)]));
    shown.expect("allowed").expect("it matters")
}

fn labels(show: &Show) -> Vec<&str> {
    show.champions.iter().map(StagedChampion::label).collect()
}

/// The shipped champion's rollout after this number of steps.
fn moment(step: u32) -> Rollout {
    let mut rollout = saved(0).rollout();
    while rollout.step() < step {
        assert!(rollout.advance());
    }
    rollout
}

#[test]
fn a_change_is_tried_from_the_moment_on_and_kept_from_the_start() {
    let mut run = prepared_run();
    let (on_show, moment) = ([saved(0)], moment(312));
    let stage = ChangedStage { moment: Some(&moment), ..stage(&on_show, &StageMode::Solo) };
    let show = changed(&mut run, stage, "surface.friction", "0.3");
    let copy = &show.champions[1];
    assert_eq!((copy.changes_at_step(), copy.label()), (Some(312), "friction 0.3"));
    assert_eq!(copy.caption(), "What if: friction 0.3, from 5.20 s on (climber)");
    assert!(!copy.must_match_record(), "its result is that of no trial");
    let kept = kept(&show.champions, &show.mode).expect("a what-if");
    assert_eq!((kept.champions[0].changes_at_step(), kept.mode), (None, StageMode::Solo));
    assert_eq!(kept.champions[0].trial(), copy.trial());
}

#[test]
fn a_state_that_does_not_fit_starts_from_the_beginning_and_says_why() {
    let mut run = prepared_run();
    let (on_show, moment) = ([saved(0)], moment(700));
    let stage = ChangedStage { moment: Some(&moment), ..stage(&on_show, &StageMode::Solo) };
    let show = changed(&mut run, stage, "stairs.rise_m", "0.7");
    let copy = &show.champions[1];
    let reason = "from the start, because the snake has already reached the stairs";
    assert_eq!(copy.beginning_in_words().as_deref(), Some(reason));
    assert_eq!(copy.changes_at_step(), None);
}

#[test]
fn a_value_set_back_ends_the_what_if() {
    let mut run = prepared_run();
    let on_show = [saved(0)];
    let first = changed(&mut run, stage(&on_show, &StageMode::Solo), "surface.friction", "0.3");
    let own = saved(0).trial().surface.friction.to_string();
    let back = changed(&mut run, stage(&first.champions, &first.mode), "surface.friction", &own);
    assert_eq!((labels(&back), &back.mode), (vec!["climber"], &StageMode::Solo));
}

#[test]
fn two_settings_stand_side_by_side_and_each_can_be_kept_or_discarded() {
    let mut run = prepared_run();
    let start = run.next_plan().clone();
    let on_show = [saved(0)];
    let ice = changed(&mut run, stage(&on_show, &StageMode::Solo), "surface.friction", "0.3");
    let fixed = another_beside(&run, ice.champions, &ice.mode).expect("a copy");
    assert!(
        another_beside(&run, fixed.champions.clone(), &fixed.mode).is_err(),
        "it stays already"
    );
    // The further lane has the changes of the latest one, too.
    let both = changed(&mut run, stage(&fixed.champions, &fixed.mode), "stairs.rise_m", "0.7");
    assert_eq!(labels(&both), ["climber", "friction 0.3", "rise 0.7, friction 0.3"]);
    // Another value replaces the lane that does not stay.
    let both = changed(&mut run, stage(&both.champions, &both.mode), "surface.friction", "2");
    assert_eq!(labels(&both), ["climber", "friction 0.3", "rise 0.7, friction 2"]);
    let after_both = run.next_plan().clone();

    let kept = kept_lane(&mut run, &both.champions, &both.mode, 1).expect("allowed");
    assert_eq!(labels(&kept.expect("a lane")), ["friction 0.3"]);
    let world = &run.next_settings().trial;
    assert_eq!(
        (world.surface.friction, world.stairs.rise_m.clone()),
        (0.3, start.settings.trial.stairs.rise_m.clone())
    );

    run.set_next_plan(after_both).expect("allowed");
    let kept = kept_lane(&mut run, &both.champions, &both.mode, 2).expect("allowed");
    assert_eq!(labels(&kept.expect("a lane")), ["rise 0.7, friction 2"]);
    assert_eq!(run.next_settings().trial.surface.friction, 2.0);

    let one = dropped(&mut run, &both.champions, &both.mode).expect("allowed").expect("lanes");
    assert_eq!(labels(&one), ["climber", "friction 0.3"]);
    assert_eq!(run.next_settings().trial.surface.friction, 0.3, "that of the lane before it");
    let none = dropped(&mut run, &one.champions, &one.mode).expect("allowed").expect("lanes");
    assert_eq!((labels(&none), &none.mode), (vec!["climber"], &StageMode::Solo));
    assert_eq!(run.next_settings().trial, start.settings.trial);
}

#[test]
fn five_lanes_are_the_most() {
    let mut run = prepared_run();
    let on_show = [saved(0)];
    let mut show = changed(&mut run, stage(&on_show, &StageMode::Solo), "surface.friction", "0.2");
    for friction in ["0.3", "0.4", "0.5"] {
        show = another_beside(&run, show.champions, &show.mode).expect("there is room");
        show = changed(&mut run, stage(&show.champions, &show.mode), "surface.friction", friction);
    }
    assert_eq!(show.champions.len(), 5);
    let refusal = another_beside(&run, show.champions.clone(), &show.mode).expect_err("full");
    assert!(refusal.contains("no room"), "{refusal}");
    show = changed(&mut run, stage(&show.champions, &show.mode), "surface.friction", "0.6");
    let expected = ["climber", "friction 0.2", "friction 0.3", "friction 0.4", "friction 0.6"];
    assert_eq!(labels(&show), expected, "the latest still changes");
}
