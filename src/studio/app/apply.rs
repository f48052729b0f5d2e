//! Executes all commands.

pub mod stage;

use bevy::prelude::*;

use crate::studio::commands::Command;
use crate::studio::commands::library::LibraryCommand;
use crate::studio::commands::modal::Modal;
use crate::studio::commands::panel::PanelKind;
use crate::studio::panels::help::tour::highlighted_panel;
use crate::studio::schedule::FrameSet;
use crate::studio::stage::opening::OpeningChampions;
use crate::studio::state::current_run::{CurrentRun, RunStatus};
use crate::studio::state::lessons::Lessons;
use crate::studio::state::library::{Library, found_run};
use crate::studio::state::lineup::champion_of;
use crate::studio::state::undo::{UndoDirection, UndoHistory, UndoStep};
use crate::studio::state::what_if::WorldChange;
use crate::studio::ui::notifications::Notices;
use crate::studio::workspace::Workspace;

use stage::{StageParams, on_stage};

pub(crate) fn plugin(app: &mut App) {
    app.add_message::<Command>().add_systems(Update, apply.in_set(FrameSet::Apply));
}

/// Shown when the user leaves a what-if without discarding the change.
const CHANGE_STAYS: &str = "The next run keeps the change: see the World panel.";

/// Executes the commands in the order in which they were sent.
fn apply(
    mut commands: MessageReader<Command>,
    mut run: ResMut<CurrentRun>,
    mut notices: ResMut<Notices>,
    mut history: ResMut<UndoHistory>,
    mut exit: MessageWriter<AppExit>,
    opening: Res<OpeningChampions>,
    mut workspace: ResMut<Workspace>,
    mut lessons: ResMut<Lessons>,
    mut library: ResMut<Library>,
    mut stage: StageParams,
) {
    for command in commands.read() {
        let before = run.next_plan().clone();
        let done = match command {
            command if lessons.view().is_some() && changes_own_run(command) => {
                Err(LESSON.to_owned())
            }
            Command::Start => {
                if run.status() == RunStatus::Finished {
                    stage.settle();
                }
                run.start()
            }
            Command::Pause => run.pause(),
            Command::SingleGeneration => run.single_generation(),
            Command::Reset => {
                stage.settle();
                run.reset()
            }
            Command::SetSeed(seed) => run.set_seed(*seed),
            Command::SetPopulation(population) => run.set_population(*population),
            Command::Continue(folder) => {
                stage.settle();
                run.go_on_with(folder)
            }
            Command::ListRuns => run.list_runs(),
            Command::Compare(folder) => run.compare_with(folder),
            Command::ExportChart(chart) => run.export(chart).map(|path| {
                notices.info(format!("Chart saved to {}", path.display()));
            }),
            Command::SetField { field, text } => {
                stage.try_out(&mut run, &WorldChange::Field { field, text })
            }
            Command::SetThreads(threads) => run.set_threads(*threads),
            Command::StartFrom(pick) => match champion_of(pick, &run, &opening) {
                Some(founder) => {
                    let found = run.found_run(founder.champion(), founder.name());
                    if found.is_ok() {
                        notices.info(format!("The next run starts from {}.", founder.name()));
                    }
                    found
                }
                None => Ok(()),
            },
            Command::ForgetFounder => run.forget_founder(),
            Command::SetFields(changes) => stage.try_out(&mut run, &WorldChange::Fields(changes)),
            Command::SetPreset(name) => stage.try_out(&mut run, &WorldChange::Preset(name)),
            Command::StorePreset(name) => run.store_preset(name),
            Command::ListPresets => {
                run.list_presets();
                Ok(())
            }
            // A running batch operation is not on the undo stack yet, and an earlier step would be the wrong one.
            Command::Undo | Command::Redo if let Some(busy) = library.busy() => Err(busy),
            Command::Undo | Command::Redo => {
                let way = if *command == Command::Undo {
                    UndoDirection::Back
                } else {
                    UndoDirection::Forth
                };
                if history.next_is_of_library(way) {
                    let done = undo_in(&mut library, way, &mut notices);
                    if done.is_ok() {
                        history.take(way);
                    }
                    done
                } else {
                    let step = history.take(way);
                    let said =
                        step.as_ref().map_or(way.nothing().to_owned(), |step| way.taken(step));
                    notices.info(said);
                    step.map_or(Ok(()), |step| stage.step(&mut run, &step, way))
                }
            }
            Command::Library(request @ (LibraryCommand::Undo | LibraryCommand::Redo)) => {
                let way = if *request == LibraryCommand::Undo {
                    UndoDirection::Back
                } else {
                    UndoDirection::Forth
                };
                let done = undo_in(&mut library, way, &mut notices);
                if done.is_ok() {
                    history.take_of_library(way);
                }
                done
            }
            Command::Library(LibraryCommand::StartFrom(place)) => {
                stage.settle();
                found_run(&mut run, place, library.best_of(place))
                    .and_then(|()| run.begin_next())
                    .map(|()| notices.info(format!("A run started from {}.", place.name())))
            }
            Command::Library(request) => library.apply(request, &mut notices).map(|show| {
                if show.is_some() && stage.leaves_change(command) {
                    notices.info(CHANGE_STAYS.to_owned());
                }
                stage.present(show);
            }),
            Command::DropChange => stage.drop_change(&mut run),
            Command::BeginLesson(index) => {
                workspace.is_bare = false;
                workspace.layout.open(PanelKind::Lessons);
                let on_show = stage.on_show();
                let shown = lessons.begin(*index, &mut run, on_show, &mut history);
                shown.map(|show| stage.present(show))
            }
            Command::ShowLessonScene(scene) => {
                lessons.try_out(*scene).map(|show| stage.present(show))
            }
            Command::Notify(text) => {
                notices.info(text.clone());
                Ok(())
            }
            Command::ShowLessonAnswer => {
                lessons.tell();
                Ok(())
            }
            Command::LeaveLesson => {
                let shown = lessons.leave(&mut run, &mut history);
                shown.map(|show| stage.present(show))
            }
            Command::Quit => {
                exit.write(AppExit::Success);
                Ok(())
            }
            command if apply_to_workspace(command, &mut workspace) => Ok(()),
            command => {
                let shown = on_stage(command, &mut stage, &run, &opening);
                if shown == Ok(true) && stage.leaves_change(command) {
                    notices.info(CHANGE_STAYS.to_owned());
                }
                shown.map(drop)
            }
        };
        history.note(command, before, run.next_plan());
        notices.problems(done.err());
    }
    // Imports and exports finish some time after their command.
    for label in library.take_done() {
        history.push(UndoStep::Library { label });
    }
    for (way, label) in library.take_left() {
        history.put_back(way, UndoStep::Library { label });
    }
    if library.busy().is_some() {
        // A running undo is on neither stack.
        return;
    }
    let (undoable, redoable) = library.counts();
    if history.agree_with_library(undoable, redoable) > 0 {
        // A newer change has cleared the redo stack here, so clear the library's as well.
        library.forget_undone();
    }
}

/// Error message for evolution commands during a lesson.
const LESSON: &str =
    "A lesson is open and your own run is paused: \"Back to my own run\" ends the lesson.";

/// Whether a command would start or change the user's own run.
fn changes_own_run(command: &Command) -> bool {
    matches!(
        command,
        Command::Start
            | Command::SingleGeneration
            | Command::Reset
            | Command::Continue(_)
            | Command::StartFrom(_)
            | Command::ForgetFounder
            | Command::SetSeed(_)
            | Command::Library(LibraryCommand::StartFrom(_))
    )
}

/// Undoes or redoes a change of saves.
fn undo_in(library: &mut Library, way: UndoDirection, notices: &mut Notices) -> Result<(), String> {
    let said = library.step(way)?;
    notices.info(said.unwrap_or(way.nothing().to_owned()));
    Ok(())
}

/// Executes commands about the layout of the window. Returns whether the command was one.
fn apply_to_workspace(command: &Command, workspace: &mut Workspace) -> bool {
    match command {
        Command::OpenPanel(kind) => {
            workspace.is_bare = false;
            workspace.layout.open(*kind);
        }
        Command::FindSetting(label) => {
            workspace.is_bare = false;
            workspace.layout.open(PanelKind::World);
            workspace.sought = Some(label);
        }
        Command::ClosePanel => workspace.layout.close_front(),
        Command::ResetLayout => workspace.layout.reset(),
        Command::TogglePanels => workspace.is_bare = !workspace.is_bare,
        Command::ChangeScale { larger } => workspace.change_scale(*larger),
        Command::ResetScale => workspace.scale = 1.0,
        Command::ToggleModal(modal) => {
            if let Modal::Tour(step) = modal {
                workspace.is_bare = false;
                highlighted_panel(*step).into_iter().for_each(|kind| workspace.layout.open(kind));
            }
            workspace.toggle_modal(*modal);
        }
        Command::CloseModal if workspace.modal().is_none() => workspace.is_bare = false,
        Command::CloseModal => workspace.close_modal(),
        _ => return false,
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::save::library::SavePlace;
    use crate::save::shipped_champion;
    use crate::studio::commands::pick::Pick;
    use crate::studio::commands::screenshot_area::ScreenshotArea;
    use crate::studio::scene::camera::CameraRig;
    use crate::studio::scene::overlays::Overlays;
    use crate::studio::stage::opening::NamedChampion;
    use crate::studio::stage::playback::Playback;
    use crate::studio::stage::selection::Selection;
    use crate::studio::stage::{Show, StageMode};
    use crate::studio::state::current_run::prepared_run;
    use crate::studio::ui::theme::Theme;

    /// An app that executes commands, with an empty stage.
    fn app() -> App {
        let loaded = shipped_champion().expect("well formed");
        let mut app = App::new();
        app.add_message::<Command>()
            .add_message::<Show>()
            .add_message::<ScreenshotArea>()
            .add_message::<AppExit>()
            .insert_resource(prepared_run())
            .insert_resource(OpeningChampions(vec![NamedChampion {
                name: "climber".to_owned(),
                loaded,
            }]))
            .insert_resource(Library::new(crate::save::SavesFolder::find(None)))
            .init_resource::<Notices>()
            .init_resource::<StageMode>()
            .init_resource::<Playback>()
            .init_resource::<CameraRig>()
            .init_resource::<Overlays>()
            .init_resource::<Selection>()
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
        let set = |text: &str| Command::SetField {
            field: "trial.surface.friction".to_owned(),
            text: text.to_owned(),
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
        assert_eq!(app.world().resource::<Notices>().len(), 4, "each said what it did");
    }

    #[test]
    fn a_preset_a_seed_and_a_group_of_settings_are_one_undo_step_each() {
        let mut app = app();
        let plan = |app: &App| app.world().resource::<CurrentRun>().next_plan().clone();
        let back = [("trial.surface.friction", "0.7"), ("trial.surface.bounce", "0.1")];
        let back = back.map(|(field, text)| (field.to_owned(), text.to_owned()));
        let mut plans = vec![plan(&app)];
        for command in [
            Command::SetPreset("ice".to_owned()),
            Command::SetSeed(77),
            Command::SetPopulation(9),
            Command::SetFields(back.to_vec()),
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
        let wrong =
            Command::SetField { field: "trial.surface.friction".to_owned(), text: "-1".to_owned() };
        friction_after(&mut app, &[wrong, Command::SetThreads(0)]);
        assert_eq!(app.world().resource::<UndoHistory>().next(UndoDirection::Back), None);
        assert_eq!(app.world().resource::<Notices>().len(), 2);
    }

    #[test]
    fn a_lesson_leaves_the_own_run_untouched() {
        let mut app = app();
        let friction = friction_after(&mut app, &[]);
        let plan = |app: &App| app.world().resource::<CurrentRun>().next_plan().clone();
        let number = |app: &App| app.world().resource::<CurrentRun>().number();
        let set = |text: &str| Command::SetField {
            field: "trial.surface.friction".to_owned(),
            text: text.to_owned(),
        };
        friction_after(&mut app, &[set("0.5")]);
        let (own, run) = (plan(&app), number(&app));
        friction_after(&mut app, &[Command::BeginLesson(0), Command::Reset, Command::Start]);
        assert_eq!(number(&app), run, "refused, in a sentence");
        assert!(app.world().resource::<Notices>().len() > 0);
        friction_after(&mut app, &[set("0.2"), Command::Undo, Command::Undo, set("0.3")]);
        friction_after(&mut app, &[Command::LeaveLesson]);
        assert_eq!(plan(&app), own);
        assert_eq!(friction_after(&mut app, &[Command::Undo]), friction, "one's own step");
    }

    #[test]
    fn pausing_in_the_frame_of_a_new_show_pauses_that_show() {
        let mut app = app();
        let commands = [Command::Show(Pick::Opened(0)), Command::TogglePlayback];
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
