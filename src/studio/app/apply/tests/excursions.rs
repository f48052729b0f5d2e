//! Excursions from the scene on the stage and back, each within each other.

use super::*;
use crate::studio::commands::camera_mode::CameraMode;
use crate::studio::commands::{ExamCommand, StageCommand};
use crate::studio::stage;
use crate::studio::state::current_run::{explored_run, run_in, small_run};
use crate::studio::state::stairs_exams::tests::made_up;
use bevy::time::TimeUpdateStrategy;
use snakes_core::save::SavesFolder;
use snakes_core::score::ExamSuite;
use std::collections::BTreeMap;
use std::time::Duration;

/// Everything that a person sees on the stage, by name.
type Seen = BTreeMap<&'static str, String>;

fn seen(app: &mut App) -> Seen {
    let mut query = app.world_mut().query::<&Lane>();
    let lanes = query.iter(app.world()).sort_by_key::<&Lane, _>(|lane| lane.number);
    let lanes: Vec<&Lane> = lanes.collect();
    let world = app.world();
    let (playback, selection) = (world.resource::<Playback>(), world.resource::<Selection>());
    let labels = lanes.iter().map(|lane| lane.staged.label());
    let poses = lanes.iter().map(|lane| lane.replay.poses());
    let next = world.resource::<CurrentRun>().next_settings();
    BTreeMap::from([
        ("labels", format!("{:?}", labels.collect::<Vec<_>>())),
        ("poses", format!("{:?}", poses.collect::<Vec<_>>())),
        ("mode", format!("{:?}", world.resource::<StageMode>())),
        ("time", playback.time_s().to_string()),
        ("playing", playback.is_playing.to_string()),
        ("camera", format!("{:?}", world.resource::<CameraRig>())),
        ("selection", format!("{:?}", (selection.lane, selection.limb))),
        ("following", world.resource::<Following>().follows_evolution().to_string()),
        ("friction", next.trial.surface.friction.to_string()),
        ("presenting", world.resource::<Workspace>().is_presenting.to_string()),
    ])
}

/// Sends a command, and lets the stage draw frames of 0 s until it is there.
fn send(app: &mut App, command: &Command) {
    app.world_mut().write_message(command.clone());
    (0..4).for_each(|_| app.update());
}

/// Creates a paused stage with the snakes of a generation after 0.5 s, seen by an unusual camera, while evolution is
/// followed.
fn studio() -> App {
    let mut app = app();
    app.add_plugins((MinimalPlugins, stage::plugin))
        .insert_resource(TimeUpdateStrategy::ManualDuration(Duration::ZERO))
        .insert_resource(explored_run());
    let champion = climber(0).champion().clone();
    let grid = made_up(ExamSuite::Stairs, &champion.trial);
    app.world_mut().resource_mut::<StairsExams>().keep(champion, vec![grid]);
    app.update();
    send(&mut app, &Command::Stage(StageCommand::ShowGeneration(Some(1))));
    settle(&mut app);
    app
}

/// Goes to 0.5 s and pauses there, turns the camera, and selects a limb.
fn settle(app: &mut App) {
    app.world_mut().resource_mut::<Playback>().hold_at(0.5);
    app.world_mut().resource_mut::<CameraRig>().take(CameraMode::Top);
    app.world_mut().resource_mut::<Selection>().limb = Some(2);
    app.world_mut().resource_mut::<Following>().follow_evolution();
    (0..4).for_each(|_| app.update());
}

/// Returns the kind of each excursion, the command that begins it, and the one that ends it.
fn excursions() -> Vec<(&'static str, Command, Command)> {
    let leave = Command::Stage(StageCommand::Leave);
    let present = Command::Window(WindowCommand::TogglePresenting);
    let watch = ExamCommand::Watch { suite: ExamSuite::Stairs, cell: 12 };
    let sweep = StageCommand::Sweep("trial.surface.friction".to_owned());
    let (learn, end) = (LessonCommand::Begin(0), LessonCommand::Leave);
    let back = ExamCommand::BackToOwnStairs;
    vec![
        ("race", Command::Stage(sweep), leave.clone()),
        ("race", Command::Stage(StageCommand::RaceStairs), leave.clone()),
        ("race", Command::Stage(StageCommand::RaceGenerations), leave.clone()),
        ("snake", Command::Stage(StageCommand::Single), leave),
        ("what-if", set("0.31"), Command::Plan(PlanCommand::DropChange)),
        ("what-if", set("0.32"), Command::Undo),
        ("lesson", Command::Lesson(learn), Command::Lesson(end)),
        ("presenting", present.clone(), present),
        ("exam", Command::Exam(watch), Command::Exam(back)),
    ]
}

/// Enters an excursion, and changes whatever a person can change within it.
fn enter(app: &mut App, command: &Command) {
    app.world_mut().resource_mut::<UndoHistory>().is_settled = true;
    send(app, command);
    app.world_mut().resource_mut::<UndoHistory>().is_settled = true;
}

/// Returns the names of what differs.
fn differences(a: &Seen, b: &Seen) -> Vec<&'static str> {
    a.iter().zip(b).filter(|(a, b)| a != b).map(|((name, _), _)| *name).collect()
}

#[test]
fn a1_every_excursion_within_every_other_returns_to_exactly_the_scene_before() {
    for (kind, first, end_first) in excursions() {
        for (other_kind, second, end_second) in excursions() {
            if (kind, other_kind) == ("presenting", "presenting") {
                // The command that presents would end the presentation.
                continue;
            }
            let mut app = studio();
            let home = seen(&mut app);
            enter(&mut app, &first);
            let entered = seen(&mut app);
            settle(&mut app);
            let there = seen(&mut app);
            enter(&mut app, &second);
            let within = seen(&mut app);
            let is_within = within != there;
            // A lesson ends a presentation, so that it leads back to the scene before both.
            let is_ended = there["presenting"] == "true" && within["presenting"] == "false";
            let back = if is_ended { &home } else { &there };
            app.world_mut().resource_mut::<CameraRig>().take(CameraMode::Side);
            app.world_mut().resource_mut::<Playback>().restart();
            if is_within {
                send(&mut app, &end_second);
                // An excursion within one of its own kind leads back to the scene before both.
                if kind != other_kind {
                    let other = differences(&seen(&mut app), back);
                    assert!(other.is_empty(), "{other:?} after {second:?} in {first:?}");
                }
            }
            if entered != home && seen(&mut app) != home {
                send(&mut app, &end_first);
                let said = app.world().resource::<Notices>().last().map(str::to_owned);
                let other = differences(&seen(&mut app), &home);
                assert!(other.is_empty(), "{other:?} after {first:?} with {second:?}: {said:?}");
            }
        }
    }
}

#[test]
fn commands_of_one_frame_that_enter_and_leave_excursions_leave_no_lanes_behind() {
    let end = Command::Window(WindowCommand::EndPresenting);
    // The snakes of a generation have no exam.
    for (kind, begin, leave) in excursions().into_iter().filter(|(kind, ..)| *kind != "exam") {
        let leave = if kind == "presenting" { end.clone() } else { leave };
        let mut app = studio();
        let home = seen(&mut app);
        app.world_mut().resource_mut::<UndoHistory>().is_settled = true;
        for command in [begin.clone(), leave.clone(), begin, leave.clone()] {
            app.world_mut().write_message(command);
        }
        (0..12).for_each(|_| app.update());
        let other = differences(&seen(&mut app), &home);
        assert!(other.is_empty(), "{kind}, {leave:?}: {other:?}");
    }
}

#[test]
fn the_speed_that_was_set_within_an_excursion_stays_after_it() {
    for (kind, begin, end) in excursions() {
        let mut app = studio();
        enter(&mut app, &begin);
        send(&mut app, &Command::Player(PlayerCommand::SetSpeed(0.25)));
        send(&mut app, &end);
        assert_eq!(app.world().resource::<Playback>().speed(), 0.25, "{kind}");
    }
}

#[test]
fn a5_a6_one_snake_of_a_crowd_keeps_its_moment_and_leads_back_to_the_crowd() {
    let mut app = studio();
    let crowd = seen(&mut app);
    send(&mut app, &Command::Stage(StageCommand::Single));
    let alone = seen(&mut app);
    assert_eq!(["mode", "time", "playing"].map(|name| &alone[name]), ["Solo", "0.5", "false"]);
    let poses = alone["poses"].strip_suffix(']').expect("a list");
    assert!(crowd["poses"].starts_with(poses), "where the crowd stood");
    assert_ne!(crowd["labels"], alone["labels"]);
    send(&mut app, &Command::Stage(StageCommand::Leave));
    assert_eq!(differences(&seen(&mut app), &crowd), Vec::<&str>::new());
}

#[test]
fn a_new_run_leads_back_to_no_scene_of_the_one_before_and_a_refused_one_changes_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let missing = RunCommand::Continue(folder.path().join("missing"));
    for (command, can_leave) in
        [(RunCommand::New, false), (RunCommand::Reset, false), (missing, true)]
    {
        let mut app = studio();
        let saves = SavesFolder::find(Some(folder.path()));
        app.insert_resource(run_in(&saves, small_run(&saves, 1, 3)));
        send(&mut app, &Command::Stage(StageCommand::RaceStairs));
        assert!(app.world().resource::<WayBack>().can_leave());
        send(&mut app, &Command::Run(command.clone()));
        assert_eq!(app.world().resource::<WayBack>().can_leave(), can_leave, "{command:?}");
    }
}
