//! Passes each command to the part of the studio that executes its group.

pub mod stage;

use bevy::prelude::*;

use super::quit::QuitRequest;
use crate::studio::commands::files::FileCommand;
use crate::studio::commands::modal::Modal;
use crate::studio::commands::panel::PanelKind;
use crate::studio::commands::{
    Command, LessonCommand, PlanCommand, PlayerCommand, RunCommand, WindowCommand,
};
use crate::studio::panels::help::tour::highlighted_panel;
use crate::studio::scene::view_commands::ViewParams;
use crate::studio::schedule::FrameSet;
use crate::studio::stage::opening::OpeningChampions;
use crate::studio::state::current_run::{CurrentRun, RunStatus};
use crate::studio::state::files::Files;
use crate::studio::state::lessons::Lessons;
use crate::studio::state::library::Library;
use crate::studio::state::undo::{UNDO_SUBJECT, UndoDirection, UndoHistory, UndoStep};
use crate::studio::ui::notifications::Notices;
use crate::studio::workspace::Workspace;

use stage::StageParams;

pub(crate) fn plugin(app: &mut App) {
    app.add_message::<Command>().add_systems(Update, apply.in_set(FrameSet::Apply));
}

/// Executes the commands in the order in which they were sent.
pub(super) fn apply(
    mut commands: MessageReader<Command>,
    mut run: ResMut<CurrentRun>,
    mut notices: ResMut<Notices>,
    mut history: ResMut<UndoHistory>,
    (opening, mut quit): (Res<OpeningChampions>, ResMut<QuitRequest>),
    mut workspace: ResMut<Workspace>,
    mut lessons: ResMut<Lessons>,
    (mut library, mut files): (ResMut<Library>, ResMut<Files>),
    mut stage: StageParams,
    mut view: ViewParams,
) {
    let notices = &mut *notices;
    for command in commands.read() {
        let before = run.next_plan().clone();
        let done = match command {
            command if lessons.view().is_some() && changes_own_run(command) => {
                Err(LESSON.to_owned())
            }
            Command::Run(command) => {
                if replaces_run(command, &run) {
                    stage.settle();
                }
                run.apply(command, notices)
            }
            Command::Plan(command) => {
                stage.apply_to_plan(command, &mut run, (&library, &opening), &history, notices)
            }
            Command::Stage(command) => stage.apply(command, &run, &opening, notices),
            Command::Player(command) => {
                stage.apply_to_player(command);
                Ok(())
            }
            Command::View(command) => {
                view.apply(command);
                Ok(())
            }
            Command::Window(command) => {
                if let WindowCommand::ToggleModal(Modal::Tour(step)) = command {
                    highlighted_panel(*step).into_iter().for_each(|kind| workspace.open(kind));
                    workspace.is_bare = false;
                }
                if let Some(news) = workspace.apply(command) {
                    notices.update("panel size", news.to_owned());
                }
                Ok(())
            }
            Command::Library(command) => library
                .apply(command, &mut history, notices)
                .map(|show| stage.present_others(show, notices)),
            Command::File(command) => {
                if *command == FileCommand::AskExport {
                    workspace.open(PanelKind::Library);
                }
                files
                    .apply(command, &mut library, &mut history, notices)
                    .map(|show| stage.present_others(show, notices))
            }
            Command::Lesson(command) => {
                if matches!(command, LessonCommand::Begin(_)) {
                    workspace.open(PanelKind::Lessons);
                }
                let show = lessons.apply(command, &mut run, stage.on_show(), &mut history);
                show.map(|show| {
                    let is_new = show.is_some();
                    stage.present_for_now(show);
                    if is_new && lessons.awaits_guess() {
                        // The race waits at its start until the reader has guessed.
                        stage.apply_to_player(&PlayerCommand::Toggle);
                    }
                })
            }
            // A running batch operation is not in the history yet, and an earlier step would be the wrong one.
            Command::Undo | Command::Redo if let Some(busy) = library.busy() => Err(busy),
            Command::Undo | Command::Redo => {
                let way = match command {
                    Command::Undo => UndoDirection::Back,
                    _ => UndoDirection::Forth,
                };
                match history.take(way) {
                    Some(UndoStep::Plan(step)) => {
                        notices.update(UNDO_SUBJECT, step.message(way));
                        history.complete(way, Some(UndoStep::Plan(step.clone())), None);
                        stage.step(&mut run, &step, way, &history)
                    }
                    Some(UndoStep::Files { label, steps }) => {
                        library.step(way, label, steps, &mut history, notices)
                    }
                    None => {
                        notices.update(UNDO_SUBJECT, way.nothing().to_owned());
                        Ok(())
                    }
                }
            }
            Command::Notify(text) => {
                notices.info(text.clone());
                Ok(())
            }
            Command::Quit => {
                quit.0 = true;
                Ok(())
            }
        };
        history.note(command, before, run.next_plan());
        notices.refusal(done.err());
    }
}

/// Whether a command puts another run in the place of the current one.
fn replaces_run(command: &RunCommand, run: &CurrentRun) -> bool {
    match command {
        RunCommand::Start => run.status() == RunStatus::Finished,
        RunCommand::Reset | RunCommand::Continue(_) => true,
        _ => false,
    }
}

/// Error message for evolution commands during a lesson.
const LESSON: &str =
    "A lesson is open and your own run is paused: \"Back to my own run\" ends the lesson.";

/// Whether a command would start or change the user's own run.
fn changes_own_run(command: &Command) -> bool {
    matches!(
        command,
        Command::Run(
            RunCommand::Start
                | RunCommand::SingleGeneration
                | RunCommand::Reset
                | RunCommand::Continue(_)
        ) | Command::Plan(
            PlanCommand::StartFrom(_)
                | PlanCommand::StartFromSave(_)
                | PlanCommand::ForgetFounder
                | PlanCommand::SetSeed(_)
        )
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::save::library::SavePlace;
    use crate::save::shipped_champion;
    use crate::studio::commands::StageCommand;
    use crate::studio::commands::library::LibraryCommand;
    use crate::studio::commands::pick::Pick;
    use crate::studio::commands::screenshot_area::ScreenshotArea;
    use crate::studio::scene::camera::CameraRig;
    use crate::studio::scene::overlays::Overlays;
    use crate::studio::stage::lane::Lane;
    use crate::studio::stage::opening::NamedChampion;
    use crate::studio::stage::playback::Playback;
    use crate::studio::stage::selection::Selection;
    use crate::studio::stage::{Show, StageMode};
    use crate::studio::state::current_run::prepared_run;
    use crate::studio::state::following::Following;
    use crate::studio::ui::theme::Theme;

    /// An app that executes commands, with an empty stage.
    fn app() -> App {
        let loaded = shipped_champion().expect("well formed");
        let mut app = App::new();
        app.add_message::<Command>()
            .add_message::<Show>()
            .add_message::<ScreenshotArea>()
            .init_resource::<QuitRequest>()
            .insert_resource(prepared_run())
            .insert_resource(OpeningChampions(vec![NamedChampion {
                name: "climber".to_owned(),
                loaded,
            }]))
            .insert_resource(Library::new(crate::save::SavesFolder::find(None)))
            .init_resource::<Files>()
            .init_resource::<Notices>()
            .init_resource::<StageMode>()
            .init_resource::<Playback>()
            .init_resource::<CameraRig>()
            .init_resource::<Overlays>()
            .init_resource::<Selection>()
            .init_resource::<Following>()
            .init_resource::<Workspace>()
            .init_resource::<Lessons>()
            .init_resource::<UndoHistory>()
            .init_resource::<Theme>()
            .add_systems(Update, apply);
        app
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
        let set = |text: &str| {
            Command::Plan(PlanCommand::SetField {
                field: "trial.surface.friction".to_owned(),
                text: text.to_owned(),
            })
        };
        let first = friction_after(&mut app, &[]);
        // A drag that pauses twice.
        assert_eq!(friction_after(&mut app, &[set("0.5"), set("0.4"), set("0.3")]), 0.3);
        app.world_mut().resource_mut::<UndoHistory>().settle();
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
        let staged = app.world().resource::<OpeningChampions>().staged(0).expect("a champion");
        app.world_mut().spawn(Lane::new(staged, 0));
        let mut tried = |friction: &str, act: &dyn Fn(&mut Playback)| {
            act(&mut app.world_mut().resource_mut::<Playback>());
            app.world_mut().write_message(Command::Plan(PlanCommand::SetField {
                field: "trial.surface.friction".to_owned(),
                text: friction.to_owned(),
            }));
            app.world_mut().resource_mut::<UndoHistory>().settle();
            app.update();
            let show = app.world_mut().resource_mut::<Messages<Show>>().drain().last();
            let Show { champions, mode } = show.expect("a what-if");
            let current = champions.last().expect("a copy");
            let step = current.changes_at_step();
            *app.world_mut().resource_mut::<StageMode>() = mode;
            let playback = app.world().resource::<Playback>();
            assert!(playback.is_playing(), "or there would be nothing to see");
            (step, playback.time_s())
        };
        let goes_to = |time_s| {
            move |playback: &mut Playback| {
                playback.apply(&PlayerCommand::Seek(time_s), 1.0 / 60.0, 15.0);
            }
        };
        assert_eq!(tried("0.3", &|playback| playback.hold_at(5.0)), (Some(300), 5.0));
        let plays_on = |playback: &mut Playback| {
            (0..8).for_each(|_| {
                playback.pass(0.5, 1.0, 15.0);
            })
        };
        assert_eq!(tried("0.4", &plays_on), (Some(300), 5.0));
        assert_eq!(tried("0.5", &goes_to(3.0)), (Some(180), 3.0));
        assert_eq!(tried("0.6", &plays_on), (Some(180), 3.0));
        assert_eq!(tried("0.7", &goes_to(15.0)), (None, 0.0), "nothing follows the end");
    }

    #[test]
    fn a_preset_a_seed_and_a_group_of_settings_are_one_undo_step_each() {
        let mut app = app();
        let plan = |app: &App| app.world().resource::<CurrentRun>().next_plan().clone();
        let back = [("trial.surface.friction", "0.7"), ("trial.surface.bounce", "0.1")];
        let back = back.map(|(field, text)| (field.to_owned(), text.to_owned()));
        let mut plans = vec![plan(&app)];
        for command in [
            Command::Plan(PlanCommand::SetPreset("ice".to_owned())),
            Command::Plan(PlanCommand::SetSeed(77)),
            Command::Plan(PlanCommand::SetPopulation(9)),
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
        let wrong = Command::Plan(PlanCommand::SetField {
            field: "trial.surface.friction".to_owned(),
            text: "-1".to_owned(),
        });
        friction_after(&mut app, &[wrong, Command::Run(RunCommand::SetThreads(0))]);
        assert_eq!(app.world().resource::<UndoHistory>().next(UndoDirection::Back), None);
        assert_eq!(app.world().resource::<Notices>().len(), 2);
    }

    #[test]
    fn a_lesson_leaves_the_own_run_untouched() {
        let mut app = app();
        let friction = friction_after(&mut app, &[]);
        let plan = |app: &App| app.world().resource::<CurrentRun>().next_plan().clone();
        let number = |app: &App| app.world().resource::<CurrentRun>().number();
        let set = |text: &str| {
            Command::Plan(PlanCommand::SetField {
                field: "trial.surface.friction".to_owned(),
                text: text.to_owned(),
            })
        };
        friction_after(&mut app, &[set("0.5")]);
        let (own, run) = (plan(&app), number(&app));
        friction_after(
            &mut app,
            &[
                Command::Lesson(LessonCommand::Begin(0)),
                Command::Run(RunCommand::Reset),
                Command::Run(RunCommand::Start),
            ],
        );
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
        app.update();
        assert_eq!(app.world().resource::<Messages<Show>>().len(), 1, "one show request");
        assert!(!app.world().resource::<Playback>().is_playing(), "and paused");
    }

    #[test]
    fn a_save_is_shown_and_a_missing_one_is_reported() {
        let mut app = app();
        let gone = SavePlace::Champion("nowhere.ron".into());
        for place in [SavePlace::Shipped("fast"), gone] {
            app.world_mut().write_message(Command::Library(LibraryCommand::Replay(place)));
        }
        app.update();
        let shown: Vec<Show> = app.world_mut().resource_mut::<Messages<Show>>().drain().collect();
        assert_eq!(shown.len(), 1);
        assert_eq!(shown[0].champions[0].name(), "fast");
        assert_eq!(app.world().resource::<Notices>().len(), 1, "the other is not there");
    }
}
