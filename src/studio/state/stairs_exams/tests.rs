//! Exams that the user begins, cancels and watches.

use super::*;
use crate::studio::stage::StageMode;
use crate::studio::state::current_run::climber;
use snakes_core::save::shipped_champion;
use snakes_core::score::{Ending, EndingKind, Trial};

/// End of a trial without a landing.
pub(crate) const NOT_LANDED: ExamEnd = ExamEnd {
    is_disqualified: false,
    ending: Ending { kind: EndingKind::OutOfTime, step: 3, reason: None, ..Ending::CRASHED },
    ..ExamEnd::CRASHED
};

/// Creates an exam in which no snake lands, without simulating it.
pub(crate) fn made_up(suite: ExamSuite, own: &Trial) -> StairsGrid {
    let conditions = suite.conditions(own);
    StairsGrid::of(suite, own, &conditions, &vec![NOT_LANDED; conditions.len()])
}

#[test]
fn an_exam_shows_its_progress_and_can_be_cancelled() {
    let (mut exams, mut notices) = (StairsExams::default(), Notices::default());
    let staged = climber(0);
    assert!(exams.apply(&ExamCommand::Examine, Some(&staged)).expect("begun").is_none());
    let (name, [_, trials]) = exams.progress().expect("under way");
    assert_eq!((name, trials), ("climber", 100));
    let refused = exams.apply(&ExamCommand::Examine, Some(&staged)).expect_err("in progress");
    assert!(refused.contains("in progress"), "{refused}");
    assert!(exams.apply(&ExamCommand::Cancel, Some(&staged)).expect("allowed").is_none());
    while exams.progress().is_some() {
        exams.take_in(&mut notices);
    }
    assert_eq!(notices.last(), Some("The exam was cancelled."));
    assert!(exams.of(staged.champion()).is_none());
}

#[test]
fn a_cell_is_watched_on_its_stairs_and_the_way_back_leads_to_the_own_ones() {
    let mut exams = StairsExams::default();
    let staged = climber(0);
    let own = &staged.champion().trial;
    exams.keep(staged.champion().clone(), vec![made_up(ExamSuite::Stairs, own)]);
    // The cell has the fourth rise and the first tread.
    let watch = ExamCommand::Watch { suite: ExamSuite::Stairs, cell: 12 };
    let show = exams.apply(&watch, Some(&staged)).expect("allowed").expect("examined");
    let [there] = show.champions.as_slice() else { panic!("a single lane") };
    assert_eq!(show.mode, StageMode::Solo);
    let stairs = &there.trial().stairs;
    assert_eq!((stairs.step_rise_m(0), stairs.step_tread_m(0)), (0.6, 1.5));
    there.check().expect("it can be shown");
    assert!(there.is_on_stairs_of_exam() && !there.must_match_record());
    let score = staged.champion().score();
    assert_eq!(
        there.caption(),
        format!("climber on other stairs: rise 0.6 m, tread 1.5 m (on its own: {score})")
    );
    assert!(exams.of(there.champion()).is_some(), "the exam is still that of the champion");
    let back = exams.apply(&ExamCommand::BackToOwnStairs, Some(there)).expect("allowed");
    assert_eq!(back.expect("the champion").champions, std::slice::from_ref(&staged));
    let without = ExamCommand::Watch { suite: ExamSuite::Lesion, cell: 12 };
    let none = exams.apply(&without, Some(&staged)).expect("allowed");
    assert!(none.is_none(), "there is no such exam");
}

#[test]
fn only_the_latest_exams_are_kept() {
    let mut exams = StairsExams::default();
    let staged = climber(0);
    let trial = |duration_s| Trial { duration_s, ..staged.trial().clone() };
    let champion = |duration_s| Champion { trial: trial(duration_s), ..staged.champion().clone() };
    for number in 0..=MOST_KEPT {
        exams.keep(champion(number as f32 + 1.0), Vec::new());
    }
    assert!(exams.of(&champion(1.0)).is_none(), "the oldest");
    assert!(exams.of(&champion(2.0)).is_some() && exams.of(&champion(9.0)).is_some());
}

#[test]
fn a_champion_without_stairs_or_of_another_engine_is_refused() {
    let mut loaded = shipped_champion().expect("well formed");
    loaded.champion.trial.stairs.steps = 0;
    let flat = StagedChampion::from_file(&loaded, 0, "flat");
    let mut exams = StairsExams::default();
    let refused = exams.apply(&ExamCommand::Examine, Some(&flat)).expect_err("no stairs");
    assert!(refused.contains("without stairs"), "{refused}");
    assert!(exams.apply(&ExamCommand::Examine, None).is_err(), "nothing is on the stage");
    loaded.engine = snakes_core::Engine { version: 1, ..snakes_core::Engine::THIS };
    let other = StagedChampion::from_file(&loaded, 0, "old");
    assert!(no_exam_because(&other).expect("refused").contains("engine 1"));
}

#[test]
fn an_end_is_said_in_a_few_words() {
    let landed = |landed_s, has_landed| ExamEnd { landed_s, has_landed, ..NOT_LANDED };
    let fell = Ending { kind: EndingKind::OffTheSide, step: 3, reason: None, ..Ending::CRASHED };
    for (end, words) in [
        (landed(Some(12.34), true), "reaches the top after 12.3 s"),
        (landed(Some(12.34), false), "reaches the top after 12.3 s, but does not stay"),
        (ExamEnd { ending: fell, ..NOT_LANDED }, "fell off the side from step 3"),
        (ExamEnd::CRASHED, "disqualified: simulation failed"),
    ] {
        assert_eq!(end_in_words(&end), words);
    }
}
