//! Tests of the lessons panel: guesses, results and worksheets.

use super::*;
use crate::studio::panels::testing::{self, Sent, clicked, panel};
use crate::studio::state::current_run::prepared_run;
use crate::studio::state::lessons::Lessons;
use crate::studio::state::undo::UndoHistory;
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;

fn panel_of(of: &Lessons) -> Sent<'_> {
    panel([theme::PANEL_WIDTH, 1600.0], move |ui| lessons(ui, of))
}

/// Clicks on `label`, and returns the commands that were sent.
fn sent(of: &Lessons, label: &str) -> Vec<Command> {
    clicked(&mut panel_of(of), label)
}

#[test]
fn each_lesson_can_be_started_from_the_list() {
    for index in 0..LESSONS.len() {
        let label = format!("Begin lesson {}", index + 1);
        let begin = Command::Lesson(LessonCommand::Begin(index));
        assert_eq!(sent(&Lessons::default(), &label), [begin]);
    }
}

/// Returns the lessons after these commands.
fn after(commands: &[LessonCommand]) -> Lessons {
    let mut run = prepared_run();
    let mut of = Lessons::default();
    for command in commands {
        of.apply(command, &mut run, &mut UndoHistory::default()).expect("allowed");
    }
    of
}

/// Returns whether the panel shows a label that contains `part`.
fn shows(of: &Lessons, part: &str) -> bool {
    testing::shows(&panel_of(of), part)
}

#[test]
fn lesson_buttons_guess_watch_change_the_scene_and_leave() {
    let of = after(&[LessonCommand::Begin(0)]);
    for (label, command) in [
        (LESSONS[0].scenes[1].label, LessonCommand::ShowScene(1)),
        ("Guess: original", LessonCommand::Guess(1)),
        ("Watch without a guess", LessonCommand::Watch),
        ("Next lesson", LessonCommand::Begin(1)),
        ("Back to my own run", LessonCommand::Leave),
    ] {
        assert_eq!(sent(&of, label), [Command::Lesson(command)], "{label}");
    }
    let guessed = after(&[LessonCommand::Begin(0), LessonCommand::Guess(1)]);
    let now = Command::Lesson(LessonCommand::ShowResult);
    assert_eq!(sent(&guessed, "Show the result now"), [now]);
    let print = Command::File(FileCommand::PrintWorksheet(0));
    assert_eq!(sent(&of, "Print the worksheet"), [print]);
    let copied = Command::Notify("Worksheet 1 copied.".to_owned());
    assert_eq!(sent(&of, "Copy worksheet"), [copied]);
}

#[test]
fn findings_follow_each_result_and_the_conclusion_all_of_them() {
    let finding = |scene: usize| LESSONS[0].scenes[scene].question.as_ref().expect("asks").finding;
    let conclusion = LESSONS[0].conclusion;
    let mut commands = vec![LessonCommand::Begin(0)];
    for step in [LessonCommand::Guess(2), LessonCommand::ShowResult] {
        let of = after(&commands);
        for hidden in [finding(0), conclusion, "Ends at"] {
            assert!(!shows(&of, hidden), "before {step:?}: {hidden}");
        }
        commands.push(step);
    }
    let of = after(&commands);
    assert!(shows(&of, finding(0)) && shows(&of, "Ends at"));
    assert!(shows(&of, "You guessed \"friction 5\", but \"original\" gets furthest"));
    assert!(!shows(&of, conclusion), "the second experiment is still to come");
    commands.push(LessonCommand::ShowScene(1));
    assert!(!shows(&after(&commands), finding(1)));
    commands.extend([LessonCommand::Guess(1), LessonCommand::ShowResult]);
    let of = after(&commands);
    assert!(shows(&of, finding(1)) && !shows(&of, finding(0)) && shows(&of, conclusion));
    commands.push(LessonCommand::ShowScene(0));
    assert!(shows(&after(&commands), "You guessed \"friction 5\""), "the answer stays");
}

#[test]
fn the_result_of_playback_speeds_cannot_be_asked_for_before_two_were_watched() {
    let commands = [
        LessonCommand::Begin(7),
        LessonCommand::ShowScene(1),
        LessonCommand::Guess(0),
        LessonCommand::ShowResult,
    ];
    let of = after(&commands);
    assert!(shows(&of, "Play it to its end. The result appears after two speeds."));
    let finding = LESSONS[7].scenes[1].question.as_ref().expect("asks").finding;
    assert!(!shows(&of, "Show the result now") && !shows(&of, finding));
}

#[test]
fn finished_playbacks_are_listed_with_every_digit_and_their_hash() {
    let mut of = Plays::default();
    let end = Evaluation {
        centre_y_m: 34.312_345,
        trace_hash: 0x0123_4567_89ab_cdef,
        ..Evaluation::of_fitness(26.0)
    };
    of.follow(0.25, 1.0, None);
    of.follow(0.25, 15.0, Some(&end));
    let harness = Harness::builder().build_ui(|ui| plays(ui, &of));
    for part in ["× 0.25", "34.312344 m", "0123456789abcdef"] {
        assert!(harness.query_by_label(part).is_some(), "{part}");
    }
}

#[test]
fn results_have_the_colours_of_their_lanes() {
    let progress = Progress {
        runs: vec![Found::of("one"), Found::of("two")],
        lanes: [("three", 1.0), ("four", 2.0)]
            .map(|(name, end_m)| (name.to_owned(), Evaluation::of_fitness(end_m)))
            .into(),
        is_revealed: true,
        ..Progress::default()
    };
    for part in ["lanes", "runs"] {
        let mut harness = Harness::builder().build_ui(|ui| match part {
            "lanes" => lanes(ui, &progress.lanes, Fitness::Climb),
            _ => runs(ui, &progress, Some(Asks::BestRun), false),
        });
        harness.run();
        let palette = theme::of_context(&harness.ctx);
        let fills: Vec<_> = harness
            .output()
            .shapes
            .iter()
            .filter_map(|clipped| match &clipped.shape {
                egui::Shape::Circle(circle) => Some(circle.fill),
                _ => None,
            })
            .collect();
        assert_eq!(fills, [palette.lane_color(0), palette.lane_color(1)], "{part}");
    }
}
