//! Tests of the leaderboard: ranking, buttons, split times.

use super::*;
use crate::studio::panels::testing::{Sent, clicked, climber_lane, panel};
use egui_kittest::kittest::Queryable;
use snakes_core::evolve::{RunPlan, Settings};

/// Creates the leaderboard of these lanes at this time in simulated seconds, with the first lane selected.
fn board<'a>(lanes: &'a [Lane], mode: StageMode, time_s: f64, is_narrow: bool) -> Sent<'a> {
    panel([800.0, 600.0], move |ui| {
        let lanes: Vec<&Lane> = lanes.iter().collect();
        leaderboard(ui, &lanes, &mode, 0, time_s, (is_narrow, true));
    })
}

fn plan() -> RunPlan {
    RunPlan::new("climb", 1, Settings::default())
}

#[test]
fn a_click_focuses_a_lane_and_buttons_keep_or_discard_a_change() {
    let lanes = [climber_lane(0, "snake 0"), climber_lane(1, "snake 1")];
    let what_if = StageMode::what_if(plan());
    for (mode, label, command) in [
        (StageMode::Race, "snake 1", Command::Stage(StageCommand::Focus(1))),
        (StageMode::Race, "Leave race", Command::Stage(StageCommand::Leave)),
        (StageMode::Race, "Only this one", Command::Stage(StageCommand::Single)),
        (what_if.clone(), "Keep", Command::Stage(StageCommand::KeepChange)),
        (what_if.clone(), "Try another", Command::Stage(StageCommand::TryAnother)),
        (what_if, "Discard", Command::Plan(PlanCommand::DropChange)),
    ] {
        assert_eq!(clicked(&mut board(&lanes, mode, 0.0, false), label), [command], "{label}");
    }
}

#[test]
fn each_of_several_copies_can_be_kept_and_the_board_says_when_none_changes() {
    let lanes = [climber_lane(0, "climber"), climber_lane(1, "ice"), climber_lane(2, "glue")];
    for (current, says_so) in [(1, true), (2, false)] {
        let (before, beside) = (Box::new(plan()), vec![plan()]);
        let mode = StageMode::WhatIf { before, beside, current };
        let mut board = board(&lanes, mode, 0.0, false);
        assert_eq!(board.query_by_label(NEXT_LANE).is_some(), says_so);
        assert_eq!(board.query_by_label("Try another").is_some(), !says_so);
        assert!(board.query_by_label("Keep climber").is_none(), "it is no copy");
        let keep = Command::Plan(PlanCommand::KeepLane(2));
        assert_eq!(clicked(&mut board, "Keep glue"), [keep]);
    }
}

#[test]
fn the_winner_has_a_flag_and_only_the_selected_snake_the_look_of_a_selection() {
    let mut lanes = [climber_lane(1, "snake 1"), climber_lane(2, "snake 2")];
    lanes.iter_mut().for_each(Lane::finish_lookahead);
    let end_s = lanes[0].end_s();
    for (time_s, flags) in [(0.0, 0), (end_s, 1)] {
        let board = board(&lanes, StageMode::Race, time_s, false);
        assert_eq!(board.query_all_by_label(WINNER).count(), flags, "at {time_s} s");
        // Whether a text has a background colour.
        let is_marked = |clipped: &egui::epaint::ClippedShape| {
            let egui::Shape::Text(text) = &clipped.shape else { return false };
            text.galley.job.sections.iter().any(|section| section.format.background.a() > 0)
        };
        assert!(!board.output().shapes.iter().any(is_marked), "at {time_s} s");
    }
}

#[test]
fn the_latest_result_of_a_race_stays_after_playback_went_back() {
    let mut lanes = [climber_lane(1, "first"), climber_lane(2, "second")];
    lanes.iter_mut().for_each(Lane::finish_lookahead);
    let end_s = lanes[0].end_s();
    let time_s = std::cell::Cell::new(end_s);
    let mut board = panel([800.0, 600.0], |ui| {
        let lanes: Vec<&Lane> = lanes.iter().collect();
        leaderboard(ui, &lanes, &StageMode::Race, 1, time_s.get(), (false, true));
    });
    let result = format!("At {end_s:.1} s: first wins: reached the top after ");
    board.get_by_label_contains(&result);
    time_s.set(0.5);
    board.run();
    board.get_by_label_contains(&result);
}

#[test]
fn split_times_grow_with_the_steps_and_end_at_the_present() {
    let mut lane = climber_lane(0, "one");
    lane.finish_lookahead();
    let history = lane.history().expect("it has finished");
    let stairs = &lane.trial().stairs;
    let all_s = splits_s(stairs, history, lane.step_s, 15.0);
    assert_eq!(all_s.len() as u32, stairs.steps, "the shipped champion lands");
    assert!(all_s.windows(2).all(|pair| pair[0] <= pair[1]), "{all_s:?}");
    let landed_s = lane.landed_s(15.0).expect("it lands");
    assert!((all_s[9] - landed_s).abs() < 0.2, "{} and {landed_s}", all_s[9]);
    let some_s = splits_s(stairs, history, lane.step_s, all_s[4] + 0.01);
    assert_eq!(some_s, all_s[..some_s.len()]);
    assert!((5..10).contains(&some_s.len()), "{some_s:?}");
}

#[test]
fn ghosts_are_not_ranked() {
    let lanes = [climber_lane(0, "racer"), climber_lane(1, "ghost").into_ghost()];
    let board = board(&lanes, StageMode::Race, 0.0, false);
    board.get_by_label("racer");
    assert!(board.query_by_label("ghost").is_none());
}

#[test]
fn the_leaderboard_is_narrower_over_a_narrow_stage() {
    let lanes = [climber_lane(0, "one")];
    let width = |is_narrow| {
        let board = board(&lanes, StageMode::what_if(plan()), 0.0, is_narrow);
        let (name, value) = (board.get_by_label("one"), board.get_by_label_contains(" m"));
        value.rect().right() - name.rect().left()
    };
    assert!(width(true) + 30.0 < width(false), "{} of {}", width(true), width(false));
}
