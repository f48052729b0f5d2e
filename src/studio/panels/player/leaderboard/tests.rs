//! The leaderboard: ranking, buttons, split times.

use super::*;
use crate::studio::stage::staged_champion::StagedChampion;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use snakes_core::evolve::{RunPlan, Settings};
use snakes_core::save::shipped_champion;

#[test]
fn a_click_focuses_a_lane_and_buttons_keep_or_discard_a_change() {
    let loaded = shipped_champion().expect("well formed");
    let lane = |number| {
        Lane::new(StagedChampion::from_file(&loaded, number, &format!("snake {number}")), number)
    };
    let lanes = [lane(0), lane(1)];
    let what_if = StageMode::what_if(RunPlan::new("climb", 1, Settings::default()));
    for (mode, label, command) in [
        (StageMode::Race, "snake 1", Command::Stage(StageCommand::Focus(1))),
        (StageMode::Race, "Leave race", Command::Stage(StageCommand::Single)),
        (what_if.clone(), "Keep", Command::Stage(StageCommand::KeepChange)),
        (what_if.clone(), "Try another", Command::Stage(StageCommand::TryAnother)),
        (what_if, "Discard", Command::Plan(PlanCommand::DropChange)),
    ] {
        let lanes: Vec<&Lane> = lanes.iter().collect();
        let mut harness = Harness::new_ui_state(
            |ui, commands| leaderboard(ui, &lanes, &mode, 0, 0.0, false, commands),
            Vec::new(),
        );
        harness.get_by_label(label).click();
        harness.run();
        assert_eq!(*harness.state(), [command], "{label}");
    }
}

#[test]
fn each_of_several_copies_can_be_kept_and_the_board_says_when_none_changes() {
    let loaded = shipped_champion().expect("well formed");
    let plan = RunPlan::new("climb", 1, Settings::default());
    let staged = |label: &str| StagedChampion::from_file(&loaded, 0, label);
    let lanes = ["climber", "ice", "glue"].iter().enumerate();
    let lanes: Vec<Lane> = lanes.map(|(number, label)| Lane::new(staged(label), number)).collect();
    let lanes: Vec<&Lane> = lanes.iter().collect();
    for (current, says_so) in [(1, true), (2, false)] {
        let (before, beside) = (Box::new(plan.clone()), vec![plan.clone()]);
        let mode = StageMode::WhatIf { before, beside, current };
        let mut harness = Harness::new_ui_state(
            |ui, commands| leaderboard(ui, &lanes, &mode, 0, 0.0, false, commands),
            Vec::new(),
        );
        assert_eq!(harness.query_by_label(NEXT_LANE).is_some(), says_so);
        assert_eq!(harness.query_by_label("Try another").is_some(), !says_so);
        assert!(harness.query_by_label("Keep climber").is_none(), "it is no copy");
        harness.get_by_label("Keep glue").click();
        harness.run();
        assert_eq!(*harness.state(), [Command::Plan(PlanCommand::KeepLane(2))]);
    }
}

#[test]
fn the_winner_has_a_flag_and_only_the_selected_snake_the_look_of_a_selection() {
    let loaded = shipped_champion().expect("well formed");
    let lane = |number: usize| {
        let name = format!("snake {number}");
        let mut lane = Lane::new(StagedChampion::from_file(&loaded, number, &name), number);
        lane.finish_lookahead();
        lane
    };
    let (lanes, end_s) = ([lane(0), lane(1)], lane(0).end_s());
    let lanes: Vec<&Lane> = lanes.iter().collect();
    for (time_s, flags) in [(0.0, 0), (end_s, 1)] {
        let mut harness = Harness::new_ui_state(
            |ui, commands| {
                leaderboard(ui, &lanes, &StageMode::Race, 1, time_s, false, commands);
            },
            Vec::new(),
        );
        harness.run();
        assert_eq!(harness.query_all_by_label(WINNER).count(), flags, "at {time_s} s");
        let is_marked =
            |clipped: &egui::epaint::ClippedShape| background_of(&clipped.shape).is_some();
        assert!(!harness.output().shapes.iter().any(is_marked), "at {time_s} s");
    }
}

/// The colour behind a text.
fn background_of(shape: &egui::Shape) -> Option<egui::Color32> {
    let egui::Shape::Text(text) = shape else { return None };
    let sections = text.galley.job.sections.iter();
    sections.map(|section| section.format.background).find(|color| color.a() > 0)
}

#[test]
fn split_times_grow_with_the_steps_and_end_at_the_present() {
    let loaded = shipped_champion().expect("well formed");
    let mut lane = Lane::new(StagedChampion::from_file(&loaded, 0, "one"), 0);
    lane.finish_lookahead();
    let history = lane.history().expect("it has finished");
    let stairs = &lane.trial().stairs;
    let all_s = splits_s(stairs, history, lane.step_s(), 15.0);
    assert_eq!(all_s.len() as u32, stairs.steps, "the shipped champion lands");
    assert!(all_s.windows(2).all(|pair| pair[0] <= pair[1]), "{all_s:?}");
    let landed_s = lane.landed_s(15.0).expect("it lands");
    assert!((all_s[9] - landed_s).abs() < 0.2, "{} and {landed_s}", all_s[9]);
    let some_s = splits_s(stairs, history, lane.step_s(), all_s[4] + 0.01);
    assert_eq!(some_s, all_s[..some_s.len()]);
    assert!((5..10).contains(&some_s.len()), "{some_s:?}");
}

#[test]
fn ghosts_are_not_ranked() {
    let loaded = shipped_champion().expect("well formed");
    let lane =
        |number, name: &str| Lane::new(StagedChampion::from_file(&loaded, number, name), number);
    let lanes = [lane(0, "racer"), lane(1, "ghost").into_ghost()];
    let lanes: Vec<&Lane> = lanes.iter().collect();
    let mut harness = Harness::new_ui_state(
        |ui, commands: &mut Vec<Command>| {
            leaderboard(ui, &lanes, &StageMode::Race, 0, 0.0, false, commands);
        },
        Vec::new(),
    );
    harness.run();
    harness.get_by_label("racer");
    assert!(harness.query_by_label("ghost").is_none());
}

#[test]
fn the_leaderboard_is_narrower_over_a_narrow_stage() {
    let loaded = shipped_champion().expect("well formed");
    let lane = Lane::new(StagedChampion::from_file(&loaded, 0, "one"), 0);
    let width = |is_narrow| {
        let mut harness = Harness::new_ui_state(
            |ui, commands: &mut Vec<Command>| {
                leaderboard(ui, &[&lane], &StageMode::Race, 0, 0.0, is_narrow, commands);
            },
            Vec::new(),
        );
        harness.run();
        let [name, value] = ["one", " m"].map(|label| harness.get_by_label_contains(label));
        value.rect().right() - name.rect().left()
    };
    assert!(width(true) + 30.0 < width(false), "{} of {}", width(true), width(false));
}
