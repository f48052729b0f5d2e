//! Tests of the section before, during and after an exam.

use super::*;
use crate::studio::panels::testing::{
    Sent, assert_fits, clicked, climber, panel, random_snake, shows,
};
use crate::studio::state::stairs_exams::tests::NOT_LANDED;
use egui_kittest::kittest::Queryable;
use snakes_core::genome::ControllerKind;
use snakes_core::score::{ExamEnd, ExamSuite, StairsGrid};

/// Returns the built-in champion, which has a gait and no senses.
fn gait() -> StagedChampion {
    climber(0, "climber")
}

/// Returns a snake with senses.
fn sensing() -> StagedChampion {
    random_snake(ControllerKind::Reflex, &[], |_| ())
}

/// Creates results without simulation: all snakes land on the lowest stairs, none on the highest.
fn made_up(suite: ExamSuite, staged: &StagedChampion) -> StairsGrid {
    let own = &staged.champion().trial;
    let conditions = suite.conditions(own);
    let end = |index: usize| {
        let has_landed = index % 5 < 5 - index / 20;
        let landed_s = has_landed.then_some(12.0);
        let steps = if has_landed { 10 } else { 3 };
        ExamEnd { steps, way: 0.5, landed_s, has_landed, ..NOT_LANDED }
    };
    let ends: Vec<ExamEnd> = (0..conditions.len()).map(end).collect();
    StairsGrid::of(suite, own, &conditions, &ends)
}

/// Creates the section, `width` points wide.
fn section(staged: StagedChampion, exams: &StairsExams, width: f32) -> Sent<'_> {
    let lane = Lane::new(staged, 0);
    panel([width, 500.0], move |ui| {
        theme::apply(ui.ctx());
        exam(ui, &lane, exams);
    })
}

#[test]
fn before_the_exam_a_button_begins_it_for_every_controller() {
    let exams = StairsExams::default();
    for (staged, is_sensing) in [(gait(), false), (sensing(), true)] {
        let mut section = section(staged, &exams, theme::PANEL_WIDTH);
        assert_eq!(shows(&section, "with its senses and without them"), is_sensing);
        assert_fits(&section, theme::PANEL_WIDTH);
        let sent = clicked(&mut section, "Examine on 100 staircases");
        assert_eq!(sent, [Command::Exam(ExamCommand::Examine)]);
    }
}

#[test]
fn during_the_exam_its_progress_is_shown_and_a_button_cancels_it() {
    let mut exams = StairsExams::default();
    exams.apply(&ExamCommand::Examine, Some(&gait())).expect("begun");
    // The section of another snake shows the progress as well.
    for staged in [gait(), sensing()] {
        let mut section = section(staged, &exams, theme::PANEL_WIDTH);
        assert!(shows(&section, "Examining climber"));
        assert!(!shows(&section, "Examine on"));
        assert_eq!(clicked(&mut section, "Cancel"), [Command::Exam(ExamCommand::Cancel)]);
    }
}

#[test]
fn a_cell_tells_its_landings_and_a_click_watches_it() {
    let (mut exams, staged) = (StairsExams::default(), gait());
    exams.keep(staged.champion().clone(), vec![made_up(ExamSuite::Stairs, &staged)]);
    let mut section = section(staged, &exams, theme::PANEL_WIDTH);
    assert_fits(&section, theme::PANEL_WIDTH);
    for (stairs, landed) in [
        ("Rise 0.3 m, tread 1.5 m", "5 of 5 climbed, median 10 of 10 steps"),
        ("Rise 0.6 m, tread 2 m", "2 of 5 climbed, median 3 of 10 steps"),
        ("Rise 0.7 m, tread 3 m", "1 of 5 climbed, median 3 of 10 steps"),
    ] {
        assert!(shows(&section, &format!("On other stairs. {stairs}: {landed}")), "{stairs}");
    }
    let lowest = section.get_by_label_contains("Rise 0.3 m, tread 2.5 m").rect();
    let highest = section.get_by_label_contains("Rise 0.7 m, tread 2.5 m").rect();
    assert!(highest.bottom() < lowest.top(), "rises go upwards");
    section.get_by_label_contains("Rise 0.6 m, tread 1.5 m").click();
    section.run();
    let watch = ExamCommand::Watch { suite: ExamSuite::Stairs, cell: 12 };
    assert_eq!(*section.state(), [Command::Exam(watch)]);
    section.get_by_label_contains("Rise 0.6 m, tread 1.5 m").hover();
    section.run();
    let typical = "with the first step as far away as on its own: out of time on step 3.";
    assert!(shows(&section, typical));
}

#[test]
fn a_snake_with_senses_is_compared_with_itself_without_them() {
    let (mut exams, staged) = (StairsExams::default(), sensing());
    let grids = ExamSuite::OF_STAIRS.map(|suite| made_up(suite, &staged));
    exams.keep(staged.champion().clone(), grids.into());
    for width in [theme::PANEL_WIDTH, 700.0] {
        let mut section = section(staged.clone(), &exams, width);
        assert_fits(&section, width);
        let with = section.get_by_label_contains("With senses. Rise 0.4 m, tread 2 m").rect();
        let without = section.get_by_label_contains("Without senses. Rise 0.4 m, tread 2 m").rect();
        assert!(with.right() < without.left() && with.top() == without.top(), "side by side");
        section.get_by_label_contains("Without senses. Rise 0.3 m, tread 2 m").click();
        section.run();
        let watch = ExamCommand::Watch { suite: ExamSuite::Lesion, cell: 1 };
        assert_eq!(*section.state(), [Command::Exam(watch)]);
    }
}

#[test]
fn on_stairs_of_the_exam_a_button_leads_back() {
    let (mut exams, staged) = (StairsExams::default(), gait());
    let grid = made_up(ExamSuite::Stairs, &staged);
    let there = staged.on_stairs_of_exam(&grid.cells[3].typical, "rise 0.3 m".to_owned());
    exams.keep(staged.champion().clone(), vec![grid]);
    assert!(!shows(&section(staged, &exams, theme::PANEL_WIDTH), "Back to its own stairs"));
    let mut section = section(there, &exams, theme::PANEL_WIDTH);
    assert!(shows(&section, "Rise 0.7 m, tread 3 m"), "the results stay");
    let sent = clicked(&mut section, "Back to its own stairs");
    assert_eq!(sent, [Command::Exam(ExamCommand::BackToOwnStairs)]);
}
