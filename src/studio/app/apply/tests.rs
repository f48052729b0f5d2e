//! Commands as the user gives them, frame by frame.

mod excursions;

use super::*;
use crate::studio::commands::pick::Pick;
use crate::studio::commands::{BlockSize, ScreenshotArea, StageCommand};
use crate::studio::scene::camera::rig::CameraRig;
use crate::studio::scene::overlays::Overlays;
use crate::studio::scene::quality::StageQuality;
use crate::studio::scene::way_back::WayBack;
use crate::studio::stage::lane::Lane;
use crate::studio::stage::playback::{Playback, REST_S};
use crate::studio::stage::selection::Selection;
use crate::studio::stage::staged_champion::StagedChampion;
use crate::studio::stage::{Show, StageMode};
use crate::studio::state::current_run::{climber, prepared_run};
use crate::studio::state::following::Following;
use crate::studio::state::turns::Turns;
use crate::studio::ui::theme::Theme;
use snakes_core::evolve::RunPlan;
use snakes_core::save::shipped_champion;

/// Creates an app that executes commands, with an empty stage.
pub(in crate::studio::app) fn app() -> App {
    let loaded = shipped_champion().expect("well formed");
    let mut app = App::new();
    app.add_message::<Command>()
        .add_message::<Show>()
        .add_message::<ScreenshotArea>()
        .init_resource::<QuitRequest>()
        .insert_resource(prepared_run())
        .insert_resource(OpeningChampions(vec![("climber".to_owned(), loaded)]))
        .insert_resource(Library::new(snakes_core::save::SavesFolder::find(None)))
        .init_resource::<Files>()
        .init_resource::<Notices>()
        .init_resource::<StageMode>()
        .init_resource::<Playback>()
        .init_resource::<CameraRig>()
        .init_resource::<Overlays>()
        .init_resource::<StageQuality>()
        .init_resource::<Selection>()
        .init_resource::<Following>()
        .init_resource::<Workspace>()
        .init_resource::<Lessons>()
        .init_resource::<StairsExams>()
        .init_resource::<BodyEditor>()
        .init_resource::<Shares>()
        .init_resource::<Turns>()
        .init_resource::<WayBack>()
        .init_resource::<MachinesLink>()
        .init_resource::<UndoHistory>()
        .init_resource::<Theme>()
        .add_plugins((crate::studio::schedule::plugin, super::plugin));
    app
}

/// Creates a command that sets the friction of the next run.
fn set(friction: &str) -> Command {
    Command::Plan(PlanCommand::set("trial.surface.friction", friction))
}

fn plan(app: &App) -> RunPlan {
    app.world().resource::<CurrentRun>().plan_next.clone()
}

/// Sends one command per frame and returns the friction of the next run.
fn friction_after(app: &mut App, commands: &[Command]) -> f32 {
    for command in commands {
        app.world_mut().write_message(command.clone());
        app.update();
    }
    app.world().resource::<CurrentRun>().next_settings().trial.surface.friction
}

#[test]
fn settings_are_undone_and_redone_drag_by_drag() {
    let mut app = app();
    let first = friction_after(&mut app, &[]);
    // A drag of a slider with a pause.
    assert_eq!(friction_after(&mut app, &[set("0.5"), set("0.4"), set("0.3")]), 0.3);
    app.world_mut().resource_mut::<UndoHistory>().is_settled = true;
    assert_eq!(friction_after(&mut app, &[set("0.2")]), 0.2);
    assert_eq!(friction_after(&mut app, &[Command::Undo]), 0.3);
    assert_eq!(friction_after(&mut app, &[Command::Undo]), first);
    assert_eq!(friction_after(&mut app, &[Command::Undo]), first, "there is nothing more");
    assert_eq!(friction_after(&mut app, &[Command::Redo, Command::Redo]), 0.2);
    let said = app.world().resource::<Notices>();
    assert_eq!((said.len(), said.last()), (1, Some("Redone: friction 0.2")), "the latest");
}

#[test]
fn changes_are_tried_from_one_moment_until_the_user_goes_to_another() {
    let mut app = app();
    app.world_mut().spawn(Lane::new(climber(0), 0));
    let mut tried = |friction: &str, act: &dyn Fn(&mut Playback)| {
        act(&mut app.world_mut().resource_mut::<Playback>());
        app.world_mut().write_message(set(friction));
        app.world_mut().resource_mut::<UndoHistory>().is_settled = true;
        app.update();
        let show = app.world_mut().resource_mut::<Messages<Show>>().drain().last();
        let Show { champions, mode } = show.expect("a what-if");
        let current = champions.last().expect("a copy");
        let step = current.changes_at_step();
        *app.world_mut().resource_mut::<StageMode>() = mode;
        let playback = app.world().resource::<Playback>();
        assert!(playback.is_playing, "or there would be nothing to see");
        (step, playback.time_s())
    };
    let goes_to =
        |time_s| move |of: &mut Playback| of.apply(&PlayerCommand::Seek(time_s), 1.0 / 60.0, 15.0);
    assert_eq!(tried("0.3", &|playback| playback.hold_at(5.0)), (Some(300), 5.0));
    let plays_on =
        |playback: &mut Playback| (0..8).for_each(|_| playback.pass(0.5, 1.0, 15.0, REST_S));
    assert_eq!(tried("0.4", &plays_on), (Some(300), 5.0));
    assert_eq!(tried("0.5", &goes_to(3.0)), (Some(180), 3.0));
    assert_eq!(tried("0.6", &plays_on), (Some(180), 3.0));
    assert_eq!(tried("0.7", &goes_to(15.0)), (None, 0.0), "nothing follows the end");
}

#[test]
fn a_preset_a_seed_and_a_group_of_settings_are_one_undo_step_each() {
    let mut app = app();
    let back = [("trial.surface.friction", "0.7"), ("trial.surface.bounce", "0.1")]
        .map(|(field, text)| (field.to_owned(), text.to_owned()));
    let mut plans = vec![plan(&app)];
    for command in [
        Command::Plan(PlanCommand::SetPreset("ice".to_owned())),
        Command::Plan(PlanCommand::SetSeed(77)),
        Command::Plan(PlanCommand::set("evolution.population", "9")),
        Command::Plan(PlanCommand::SetFields(back.to_vec())),
    ] {
        friction_after(&mut app, &[command]);
        plans.push(plan(&app));
    }
    while let Some(expected) = plans.pop() {
        assert_eq!(plan(&app), expected);
        friction_after(&mut app, &[Command::Undo]);
    }
}

#[test]
fn a_rejected_command_is_no_undo_step() {
    let mut app = app();
    friction_after(&mut app, &[set("-1"), Command::Run(RunCommand::SetThreads(0))]);
    assert_eq!(app.world().resource::<UndoHistory>().next(UndoDirection::Back), None);
    assert_eq!(app.world().resource::<Notices>().len(), 2);
}

#[test]
fn quitting_asks_first_while_a_changed_body_would_be_lost() {
    let mut app = app();
    let is_over = |app: &App| app.world().resource::<QuitRequest>().0;
    let change = BodyCommand::Set { block: 1, size: BlockSize::Height, value: 0.9 };
    show_after(&mut app, Show::solo(climber(0)), Command::Body(BodyCommand::Edit));
    friction_after(&mut app, &[Command::Body(change), Command::Quit]);
    let modal = |app: &App| app.world().resource::<Workspace>().modal();
    assert_eq!((modal(&app), is_over(&app)), (Some(Modal::Quit), false));
    friction_after(&mut app, &[Command::Window(WindowCommand::CloseModal), Command::Quit]);
    assert_eq!((modal(&app), is_over(&app)), (Some(Modal::Quit), false), "it asks again");
    let mut idle = super::tests::app();
    for app in [&mut app, &mut idle] {
        friction_after(app, &[Command::Quit]);
        assert!(is_over(app), "after the answer, or without anything to lose");
    }
}

#[test]
fn a_lesson_leaves_the_own_run_untouched() {
    let mut app = app();
    let friction = friction_after(&mut app, &[]);
    let number = |app: &App| app.world().resource::<CurrentRun>().number;
    friction_after(&mut app, &[set("0.5")]);
    let (own, run) = (plan(&app), number(&app));
    let [reset, start] = [RunCommand::Reset, RunCommand::Start].map(Command::Run);
    friction_after(&mut app, &[Command::Lesson(LessonCommand::Begin(0)), reset, start]);
    assert_eq!(number(&app), run, "refused, in a sentence");
    assert!(app.world().resource::<Notices>().len() > 0);
    friction_after(&mut app, &[set("0.2"), Command::Undo, Command::Undo, set("0.3")]);
    friction_after(&mut app, &[Command::Lesson(LessonCommand::Leave)]);
    assert_eq!(plan(&app), own);
    assert_eq!(friction_after(&mut app, &[Command::Undo]), friction, "one's own step");
}

#[test]
fn pausing_in_the_frame_of_a_new_show_pauses_that_show() {
    let mut app = app();
    let commands = [
        Command::Stage(StageCommand::Show(Pick::Opened(0))),
        Command::Player(PlayerCommand::Toggle),
    ];
    app.world_mut().write_message_batch(commands);
    (0..2).for_each(|_| app.update());
    assert_eq!(app.world().resource::<Messages<Show>>().len(), 1, "one show request");
    assert!(!app.world().resource::<Playback>().is_playing, "and paused");
}

/// Puts champions on the stage, side by side, and executes a command. Returns the last request that it sends to the stage.
fn show_after(app: &mut App, show: Show, command: Command) -> Option<Show> {
    let old: Vec<Entity> =
        app.world_mut().query_filtered::<Entity, With<Lane>>().iter(app.world()).collect();
    old.into_iter().for_each(|lane| assert!(app.world_mut().despawn(lane)));
    for (number, staged) in show.champions.into_iter().enumerate() {
        app.world_mut().spawn(Lane::new(staged, number));
    }
    *app.world_mut().resource_mut::<StageMode>() = show.mode;
    app.world_mut().write_message(command);
    app.update();
    app.world_mut().resource_mut::<Messages<Show>>().drain().last()
}

#[test]
fn a_new_run_names_the_change_that_was_tried_and_takes_it() {
    let mut app = app();
    let what_if = show_after(&mut app, Show::solo(climber(0)), set("0.25")).expect("a what-if");
    show_after(&mut app, what_if, Command::Run(RunCommand::Reset)).expect("the kept change");
    let said = app.world().resource::<Notices>().last();
    assert_eq!(said, Some("The new run has the change that was tried: friction 0.25."));
    assert_eq!(friction_after(&mut app, &[]), 0.25);
}

#[test]
fn in_a_what_if_races_vary_the_selected_copy_and_sweeps_the_one_of_the_sliders() {
    let race = |command: &StageCommand, lane: usize| {
        let mut app = app();
        app.world_mut().resource_mut::<Playback>().hold_at(5.0);
        let what_if = show_after(&mut app, Show::solo(climber(0)), set("0.05")).expect("a what-if");
        assert_eq!(what_if.champions[1].changes_at_step(), Some(300));
        app.world_mut().resource_mut::<Selection>().lane = lane;
        let race = show_after(&mut app, what_if, Command::Stage(command.clone())).expect("a race");
        assert!(race.champions.iter().all(|lane| lane.changes_at_step().is_none()));
        race.champions
    };
    for command in [StageCommand::RaceStairs, StageCommand::RaceKnockOuts] {
        for (lane, friction) in [(0, 1.0), (1, 0.05)] {
            let race = race(&command, lane);
            assert!(race.len() > 2, "{command:?}");
            assert!(race.iter().all(|of| of.trial().surface.friction == friction), "{command:?}");
        }
    }
    for lane in [0, 1] {
        let sweep = race(&StageCommand::Sweep("trial.surface.friction".to_owned()), lane);
        let labels: Vec<&str> = sweep.iter().map(StagedChampion::label).collect();
        let before = "friction 0.05 (as before)";
        assert_eq!(
            labels,
            ["friction 0.01", "friction 0.025", before, "friction 0.1", "friction 0.25"]
        );
    }
}

#[test]
fn a_change_after_the_landing_is_tried_from_the_start() {
    for (held_s, changes_at_step) in [(5.0, Some(300)), (14.5, None)] {
        let mut app = app();
        app.world_mut().resource_mut::<Playback>().hold_at(held_s);
        let what_if = show_after(&mut app, Show::solo(climber(0)), set("0.05")).expect("a what-if");
        assert_eq!(what_if.champions[1].changes_at_step(), changes_at_step, "{held_s} s");
    }
}

#[test]
fn a_lane_that_stays_after_a_race_offers_its_world() {
    let mut app = app();
    let sweep = Command::Stage(StageCommand::Sweep("trial.surface.friction".to_owned()));
    let race = show_after(&mut app, Show::solo(climber(0)), sweep).expect("five lanes");
    app.world_mut().resource_mut::<Selection>().lane = 0;
    let left = Command::Stage(StageCommand::Single);
    let alone = show_after(&mut app, race, left).expect("one lane");
    assert_eq!(alone.champions[0].label(), "friction 0.2");
    let take = Command::Plan(PlanCommand::UseWorldOfLane);
    let offers = app.world().resource::<Notices>().last_offers().to_vec();
    assert_eq!(offers, [("Use this world".to_owned(), take.clone())]);
    show_after(&mut app, alone, take);
    assert_eq!(friction_after(&mut app, &[]), 0.2);
}
