//! The section before, during and after an exam.

use super::*;
use crate::studio::panels::settings::tests::assert_nothing_is_wider_than;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use snakes_core::evolve::with_fields;
use snakes_core::rng::{Purpose, stream};
use snakes_core::save::{LoadedChampion, load_preset, shipped_champion};
use snakes_core::score::ExamEnd;

type Section<'a> = Harness<'a, Vec<Command>>;

/// The built-in champion, a gait.
fn gait() -> StagedChampion {
    StagedChampion::from_file(&shipped_champion().expect("well formed"), 0, "climber")
}

/// A snake with senses.
fn sensing() -> StagedChampion {
    let settings = load_preset("climb").expect("shipped").settings;
    let settings = with_fields(&settings, [("genome.controller", "reflex")]).expect("allowed");
    let mut rng = stream(1, 1, 3, Purpose::Birth);
    let LoadedChampion { mut champion, .. } = shipped_champion().expect("well formed");
    champion.genome = settings.genome.random_genome(settings.trial.genome_shape(), &mut rng);
    champion.trial = settings.trial;
    let loaded = LoadedChampion { champion, ..shipped_champion().expect("well formed") };
    StagedChampion::from_file(&loaded, 0, "reflex")
}

/// Made-up results: on the lowest stairs all land, on the highest none.
fn made_up(suite: ExamSuite, staged: &StagedChampion) -> StairsGrid {
    let own = &staged.champion().trial;
    let conditions = suite.conditions(own);
    let end = |index: usize| {
        let has_landed = index % 5 < 5 - index / 20;
        let landed_s = has_landed.then_some(12.0);
        let steps = if has_landed { 10 } else { 3 };
        ExamEnd { steps, way: 0.5, landed_s, arrived_s: None, has_landed, is_disqualified: false }
    };
    let ends: Vec<ExamEnd> = (0..conditions.len()).map(end).collect();
    StairsGrid::of(suite, own, &conditions, &ends)
}

/// The section `width` points wide.
fn section<'a>(staged: StagedChampion, exams: &'a StairsExams, width: f32) -> Section<'a> {
    let lane = Lane::new(staged, 0);
    let mut section = Harness::builder().with_size(egui::vec2(width, 500.0)).build_ui_state(
        move |ui, commands| {
            theme::apply(ui.ctx());
            exam(ui, &lane, exams, commands);
        },
        Vec::new(),
    );
    section.run();
    section
}

fn shows(section: &Section, label: &str) -> bool {
    section.query_all_by_label_contains(label).next().is_some()
}

#[test]
fn before_the_exam_a_button_begins_it_for_every_controller() {
    let exams = StairsExams::default();
    for (staged, is_sensing) in [(gait(), false), (sensing(), true)] {
        let mut section = section(staged, &exams, theme::PANEL_WIDTH);
        assert_eq!(shows(&section, "with its senses and without them"), is_sensing);
        assert_nothing_is_wider_than(&section, theme::PANEL_WIDTH);
        section.get_by_label("Examine on 100 staircases").click();
        section.run();
        assert_eq!(*section.state(), [Command::Exam(ExamCommand::Examine)]);
    }
}

#[test]
fn during_the_exam_its_progress_is_shown_and_a_button_cancels_it() {
    let mut exams = StairsExams::default();
    exams.apply(&ExamCommand::Examine, Some(&gait())).expect("begun");
    // Another snake on the stage shows it, too.
    for staged in [gait(), sensing()] {
        let mut section = section(staged, &exams, theme::PANEL_WIDTH);
        assert!(shows(&section, "Examining climber"));
        assert!(!shows(&section, "Examine on"));
        section.get_by_label("Cancel").click();
        section.run();
        assert_eq!(*section.state(), [Command::Exam(ExamCommand::Cancel)]);
    }
}

#[test]
fn a_cell_tells_its_landings_and_a_click_watches_it() {
    let (mut exams, staged) = (StairsExams::default(), gait());
    exams.keep(staged.champion().clone(), vec![made_up(ExamSuite::Stairs, &staged)]);
    let mut section = section(staged, &exams, theme::PANEL_WIDTH);
    assert_nothing_is_wider_than(&section, theme::PANEL_WIDTH);
    for (stairs, landed) in [
        ("Rise 0.3 m, tread 1.5 m", "5 of 5 landed, median 10 of 10 steps"),
        ("Rise 0.6 m, tread 2 m", "2 of 5 landed, median 3 of 10 steps"),
        ("Rise 0.7 m, tread 3 m", "1 of 5 landed, median 3 of 10 steps"),
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
    let typical = "with the first step as far away as on its own, the snake ends on step 3.";
    assert!(shows(&section, typical));
}

#[test]
fn a_snake_with_senses_is_compared_with_itself_without_them() {
    let (mut exams, staged) = (StairsExams::default(), sensing());
    let grids = ExamSuite::OF_STAIRS.map(|suite| made_up(suite, &staged));
    exams.keep(staged.champion().clone(), grids.into());
    for width in [theme::PANEL_WIDTH, 700.0] {
        let mut section = section(staged.clone(), &exams, width);
        assert_nothing_is_wider_than(&section, width);
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
    section.get_by_label("Back to its own stairs").click();
    section.run();
    assert_eq!(*section.state(), [Command::Exam(ExamCommand::BackToOwnStairs)]);
}
