//! Where what was asked for is done.

use bevy::prelude::*;

use super::Command;
use super::stage::{StageParams, on_stage};
use crate::studio::casting::{Change, exhibit_of};
use crate::studio::desk::{Desk, Over};
use crate::studio::evolution::{Evolution, Status};
use crate::studio::lessons::Lessons;
use crate::studio::library::{Ask, Library, found_run};
use crate::studio::notice::Notices;
use crate::studio::panels::{PanelKind, shown_in};
use crate::studio::undo::{History, Step, Way};
use crate::studio::{Frame, Opening};

pub(in crate::studio) fn plugin(app: &mut App) {
    app.add_message::<Command>().add_systems(Update, apply.in_set(Frame::Apply));
}

/// Who leaves a change by the way has not dropped it.
const CHANGE_STAYS: &str = "The next run keeps the change: see the World tab.";

/// Does what was asked for, in the order in which it was asked.
fn apply(
    mut asked: MessageReader<Command>,
    mut evolution: ResMut<Evolution>,
    mut notices: ResMut<Notices>,
    mut history: ResMut<History>,
    mut exit: MessageWriter<AppExit>,
    opening: Res<Opening>,
    mut desk: ResMut<Desk>,
    mut lessons: ResMut<Lessons>,
    mut library: ResMut<Library>,
    mut stage: StageParams,
) {
    for command in asked.read() {
        let before = evolution.next_plan().clone();
        let done = match command {
            command if lessons.view().is_some() && begins_something(command) => {
                Err(LESSON.to_owned())
            }
            Command::Start => {
                if evolution.status() == Status::Finished {
                    stage.settle();
                }
                evolution.start()
            }
            Command::Pause => evolution.pause(),
            Command::SingleGeneration => evolution.single_generation(),
            Command::Reset => {
                stage.settle();
                evolution.reset()
            }
            Command::SetSeed(seed) => evolution.set_seed(*seed),
            Command::SetPopulation(population) => evolution.set_population(*population),
            Command::Continue(folder) => {
                stage.settle();
                evolution.go_on_with(folder)
            }
            Command::ListRuns => evolution.list_runs(),
            Command::Compare(folder) => evolution.compare_with(folder),
            Command::Export(chart) => evolution.export(chart).map(|path| {
                notices.news(format!("Chart saved to {}", path.display()));
            }),
            Command::SetField { field, text } => {
                stage.try_out(&mut evolution, &Change::Field { field, text })
            }
            Command::SetThreads(threads) => evolution.set_threads(*threads),
            Command::Found(pick) => match exhibit_of(pick, &evolution, &opening) {
                Some(founder) => {
                    let found = evolution.found_run(founder.champion(), founder.name());
                    if found.is_ok() {
                        notices.news(format!("The next run begins from {}.", founder.name()));
                    }
                    found
                }
                None => Ok(()),
            },
            Command::ForgetFounder => evolution.forget_founder(),
            Command::SetFields(changes) => stage.try_out(&mut evolution, &Change::Fields(changes)),
            Command::SetPreset(name) => stage.try_out(&mut evolution, &Change::Preset(name)),
            Command::StorePreset(name) => evolution.store_preset(name),
            Command::ListPresets => {
                evolution.list_presets();
                Ok(())
            }
            // What is being done is no step yet that could be undone, and what comes after it is not meant.
            Command::Undo | Command::Redo if let Some(busy) = library.busy() => Err(busy),
            Command::Undo | Command::Redo => {
                let way = if *command == Command::Undo { Way::Back } else { Way::Forth };
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
                    notices.news(said);
                    step.map_or(Ok(()), |step| stage.step(&mut evolution, &step, way))
                }
            }
            Command::Library(ask @ (Ask::Undo | Ask::Redo)) => {
                let way = if *ask == Ask::Undo { Way::Back } else { Way::Forth };
                let done = undo_in(&mut library, way, &mut notices);
                if done.is_ok() {
                    history.take_of_library(way);
                }
                done
            }
            Command::Library(Ask::FoundRun(place)) => {
                stage.settle();
                found_run(&mut evolution, place, library.best_of(place))
                    .and_then(|()| evolution.begin_next())
                    .map(|()| notices.news(format!("A run begins from {}.", place.name())))
            }
            Command::Library(ask) => library.apply(ask, &mut notices).map(|show| {
                if show.is_some() && stage.leaves_change(command) {
                    notices.news(CHANGE_STAYS.to_owned());
                }
                stage.present(show);
            }),
            Command::DropChange => stage.drop_change(&mut evolution),
            Command::BeginLesson(index) => {
                desk.is_bare = false;
                desk.layout.open(PanelKind::Lessons);
                let on_show = stage.on_show();
                let shown = lessons.begin(*index, &mut evolution, on_show, &mut history);
                shown.map(|show| stage.present(show))
            }
            Command::TryLesson(scene) => lessons.try_out(*scene).map(|show| stage.present(show)),
            Command::Say(text) => {
                notices.news(text.clone());
                Ok(())
            }
            Command::TellLesson => {
                lessons.tell();
                Ok(())
            }
            Command::LeaveLesson => {
                let shown = lessons.leave(&mut evolution, &mut history);
                shown.map(|show| stage.present(show))
            }
            Command::Quit => {
                exit.write(AppExit::Success);
                Ok(())
            }
            command if arrange(command, &mut desk) => Ok(()),
            command => {
                let shown = on_stage(command, &mut stage, &evolution, &opening);
                if shown == Ok(true) && stage.leaves_change(command) {
                    notices.news(CHANGE_STAYS.to_owned());
                }
                shown.map(drop)
            }
        };
        history.note(command, before, evolution.next_plan());
        notices.problems(done.err());
    }
    // An import or an export is done some time after it was asked for.
    for label in library.take_done() {
        history.push(Step::Library { label });
    }
    for (way, label) in library.take_left() {
        history.put_back(way, Step::Library { label });
    }
    if library.busy().is_some() {
        // What is being taken back is neither done nor undone.
        return;
    }
    let (undoable, redoable) = library.counts();
    if history.agree_with_library(undoable, redoable) > 0 {
        // Something else was done since: it cannot be done again in its place.
        library.forget_undone();
    }
}

/// Why nothing is evolved meanwhile.
const LESSON: &str =
    "A lesson is going on, and your own run waits: \"Back to my own run\" ends it.";

/// Whether a command would make something else of one's own run.
fn begins_something(command: &Command) -> bool {
    matches!(
        command,
        Command::Start
            | Command::SingleGeneration
            | Command::Reset
            | Command::Continue(_)
            | Command::Found(_)
            | Command::ForgetFounder
            | Command::SetSeed(_)
            | Command::Library(Ask::FoundRun(_))
    )
}

/// Takes back what was done with saves, or does it again.
fn undo_in(library: &mut Library, way: Way, notices: &mut Notices) -> Result<(), String> {
    let said = library.step(way)?;
    notices.news(said.unwrap_or(way.nothing().to_owned()));
    Ok(())
}

/// Does what concerns how the window is arranged. Says whether it was that.
fn arrange(command: &Command, desk: &mut Desk) -> bool {
    match command {
        Command::Open(kind) => {
            desk.is_bare = false;
            desk.layout.open(*kind);
        }
        Command::FindSetting(label) => {
            desk.is_bare = false;
            desk.layout.open(PanelKind::World);
            desk.sought = Some(label);
        }
        Command::ClosePanel => desk.layout.close_front(),
        Command::ResetLayout => desk.layout.reset(),
        Command::ToggleBare => desk.is_bare = !desk.is_bare,
        Command::ChangeScale { larger } => desk.change_scale(*larger),
        Command::ResetScale => desk.scale = 1.0,
        Command::Cover(over) => {
            if let Over::Tour(step) = over {
                desk.is_bare = false;
                shown_in(*step).into_iter().for_each(|kind| desk.layout.open(kind));
            }
            desk.cover(*over);
        }
        Command::Uncover if desk.over().is_none() => desk.is_bare = false,
        Command::Uncover => desk.uncover(),
        _ => return false,
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::save::library::Place;
    use crate::save::shipped_champion;
    use crate::studio::camera::CameraRig;
    use crate::studio::casting::{Pick, Saved};
    use crate::studio::evolution::prepared_run;
    use crate::studio::hands::Hands;
    use crate::studio::look::Theme;
    use crate::studio::overlay::Overlays;
    use crate::studio::playback::Playback;
    use crate::studio::screenshot::Photograph;
    use crate::studio::stage::{Programme, Show};

    /// The place where commands are done, with nobody on the stage.
    fn app() -> App {
        let loaded = shipped_champion().expect("well formed");
        let mut app = App::new();
        app.add_message::<Command>()
            .add_message::<Show>()
            .add_message::<Photograph>()
            .add_message::<AppExit>()
            .insert_resource(prepared_run())
            .insert_resource(Opening(vec![Saved { name: "climber".to_owned(), loaded }]))
            .insert_resource(Library::new(crate::save::SavesFolder::find(None)))
            .init_resource::<Notices>()
            .init_resource::<Programme>()
            .init_resource::<Playback>()
            .init_resource::<CameraRig>()
            .init_resource::<Overlays>()
            .init_resource::<Hands>()
            .init_resource::<Desk>()
            .init_resource::<Lessons>()
            .init_resource::<History>()
            .init_resource::<Theme>()
            .add_systems(Update, apply);
        app
    }

    /// Asks for something, frame by frame, and returns the next run's friction.
    fn friction_after(app: &mut App, asked: &[Command]) -> f32 {
        for command in asked {
            app.world_mut().write_message(command.clone());
            app.update();
        }
        app.world().resource::<Evolution>().next_settings().trial.surface.friction
    }

    #[test]
    fn what_was_set_is_undone_and_redone_drag_by_drag() {
        let mut app = app();
        let set = |text: &str| Command::SetField {
            field: "trial.surface.friction".to_owned(),
            text: text.to_owned(),
        };
        let first = friction_after(&mut app, &[]);
        // A drag that rests twice.
        assert_eq!(friction_after(&mut app, &[set("0.5"), set("0.4"), set("0.3")]), 0.3);
        app.world_mut().resource_mut::<History>().settle();
        assert_eq!(friction_after(&mut app, &[set("0.2")]), 0.2);
        assert_eq!(friction_after(&mut app, &[Command::Undo]), 0.3);
        assert_eq!(friction_after(&mut app, &[Command::Undo]), first);
        assert_eq!(friction_after(&mut app, &[Command::Undo]), first, "there is nothing more");
        assert_eq!(friction_after(&mut app, &[Command::Redo, Command::Redo]), 0.2);
        assert_eq!(app.world().resource::<Notices>().len(), 4, "each said what it did");
    }

    #[test]
    fn a_preset_a_seed_and_several_settings_at_once_are_a_step_each() {
        let mut app = app();
        let plan = |app: &App| app.world().resource::<Evolution>().next_plan().clone();
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
    fn what_is_refused_is_no_step() {
        let mut app = app();
        let wrong =
            Command::SetField { field: "trial.surface.friction".to_owned(), text: "-1".to_owned() };
        friction_after(&mut app, &[wrong, Command::SetThreads(0)]);
        assert_eq!(app.world().resource::<History>().next(Way::Back), None);
        assert_eq!(app.world().resource::<Notices>().len(), 2);
    }

    #[test]
    fn within_a_lesson_nothing_is_made_of_ones_own_run_and_it_is_given_back() {
        let mut app = app();
        let friction = friction_after(&mut app, &[]);
        let plan = |app: &App| app.world().resource::<Evolution>().next_plan().clone();
        let number = |app: &App| app.world().resource::<Evolution>().number();
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
    fn who_holds_the_stage_in_the_frame_in_which_others_come_holds_them() {
        let mut app = app();
        let asked = [Command::Show(Pick::Opening(0)), Command::TogglePlayback];
        app.world_mut().write_message_batch(asked);
        app.update();
        assert_eq!(app.world().resource::<Messages<Show>>().len(), 1, "somebody is shown");
        assert!(!app.world().resource::<Playback>().is_playing(), "and held");
    }

    #[test]
    fn a_save_of_the_library_takes_the_stage_and_one_that_is_gone_is_said() {
        let mut app = app();
        let gone = Place::Champion("nowhere.ron".into());
        for place in [Place::Shipped("fast"), gone] {
            app.world_mut().write_message(Command::Library(Ask::Replay(place)));
        }
        app.update();
        let shown: Vec<Show> = app.world_mut().resource_mut::<Messages<Show>>().drain().collect();
        assert_eq!(shown.len(), 1);
        assert_eq!(shown[0].exhibits[0].name(), "fast");
        assert_eq!(app.world().resource::<Notices>().len(), 1, "the other is not there");
    }
}
