//! What a person can ask for, and the one place where it is done.

use std::path::PathBuf;

use bevy::ecs::system::SystemParam;
use bevy::prelude::*;

use super::camera::{CameraRig, StageCamera};
use super::casting::{Change, what_if};
use super::casting::{Pick, all_generations, dropped, exhibit_of, kept, leaders, with_one_more};
use super::desk::{Desk, Over};
use super::evolution::{Evolution, Status};
use super::exhibit::Exhibit;
use super::export::Export;
use super::hands::Hands;
use super::lane::Lane;
use super::lessons::Lessons;
use super::library::{Ask, Library, found_run};
use super::look::Theme;
use super::notice::Notices;
use super::overlay::{Overlay, Overlays};
use super::panels::{PanelKind, shown_in};
use super::playback::Playback;
use super::screenshot::Photograph;
use super::stage::{Programme, Show, end_s};
use super::undo::{History, Step, Way, followed, stepped};
use super::view::Shot;
use super::{Frame, Opening};

/// Something a panel or a key asks for.
#[derive(Message, Debug, Clone, PartialEq)]
pub(super) enum Command {
    /// Evolve until paused or finished; after the end of a run, begin the next.
    Start,
    /// Hold evolution.
    Pause,
    /// Evolve to the end of the current generation.
    SingleGeneration,
    /// Throw the current run away and prepare a fresh one.
    Reset,
    /// Use this seed for the next run.
    SetSeed(u64),
    /// Use this population for the next run.
    SetPopulation(u32),
    /// Change one setting of the next run, by its name, and show what it does to what is on the stage.
    SetField {
        /// The setting's name: see [`crate::evolve::with_field`].
        field: String,
        /// Its value as text.
        text: String,
    },
    /// Change one setting of the run under way, by its full dotted name, from its next generation on. The next run
    /// keeps what it has.
    #[expect(dead_code, reason = "for panels that change the run alone")]
    ChangeRun {
        /// The setting's full dotted name: see [`crate::evolve::fields`].
        field: String,
        /// Its value as text.
        text: String,
    },
    /// Evolve on so many worker threads, from the next generation on.
    SetThreads(usize),
    /// Let the next run descend from somebody, in whose world it takes place.
    Found(Pick),
    /// Let the next run begin from nothing again.
    ForgetFounder,
    /// Change several settings of the next run at once, and show what they do to what is on the stage.
    SetFields(Vec<(String, String)>),
    /// Take this preset for the next run, and show what it does to what is on the stage.
    SetPreset(String),
    /// Keep the next run's settings as a preset of this name.
    StorePreset(String),
    /// Look for presets anew.
    ListPresets,
    /// Undo the latest change of the next run's plan.
    Undo,
    /// Do again what was undone last.
    Redo,
    /// Go on with what was changed: it stays alone on the stage.
    KeepChange,
    /// Forget what was changed.
    DropChange,
    /// Show what is on the stage as it was found.
    ShowAsFound,
    /// Let this engine simulate what is on the stage, which another engine found.
    Simulate,
    /// Look for runs that were stopped before their end.
    ListStoppedRuns,
    /// Go on with the run in this folder.
    Continue(PathBuf),
    /// Look for all runs in the folder of saves.
    ListRuns,
    /// Lay the run in this folder over the current one in a chart, or take it away again.
    Compare(PathBuf),
    /// Write a chart into a file.
    Export(Export),
    /// Do something with the saves.
    Library(Ask),
    /// Put somebody on the stage.
    Show(Pick),
    /// Put somebody beside those who are on the stage, or take them off again.
    Join(Pick),
    /// Let the champions of the run's generations race.
    RaceGenerations,
    /// Let the best of this generation race, or of the latest one; the first is 1.
    RaceLeaders(Option<u32>),
    /// Show the numbers and signals of this lane; the first is 0.
    Focus(usize),
    /// Keep only the lane whose numbers are shown.
    Single,
    /// Hold or resume what is on the stage.
    TogglePlayback,
    /// Play what is on the stage from its start.
    Restart,
    /// Show the stage at this moment, in simulated seconds.
    Seek(f64),
    /// Hold, and go to the end.
    SeekEnd,
    /// Hold, and go one physics step forward or back.
    Step {
        /// Or else back.
        forward: bool,
    },
    /// Play so many simulated seconds in a second.
    SetSpeed(f32),
    /// Play at the next higher or lower speed.
    ChangeSpeed {
        /// Or else slower.
        faster: bool,
    },
    /// Begin again after the end, or stay there.
    ToggleLoop,
    /// Look at the stage like this.
    Look(Shot),
    /// Look at the stage in the next way.
    NextShot,
    /// Let the camera follow the snake, or stop it.
    ToggleFollow,
    /// Put the camera where it was at the start.
    ResetCamera,
    /// Show or hide something over the scene.
    Toggle(Overlay),
    /// Smooth the edges of what is drawn, or draw faster.
    ToggleSmoothEdges,
    /// From the light theme to the dark one, or back.
    ToggleTheme,
    /// Take a picture of the stage alone, or of the window.
    TakePicture(Photograph),
    /// Say something to the person.
    Say(String),
    /// Bring a panel to the front.
    Open(PanelKind),
    /// Bring the settings to the front that are about this.
    FindSetting(&'static str),
    /// Close the panel that was used last.
    ClosePanel,
    /// Put the panels back where they are at first.
    ResetLayout,
    /// Show the stage alone, or the panels again.
    ToggleBare,
    /// Draw the panels by a step larger or smaller.
    ChangeScale {
        /// Or else smaller.
        larger: bool,
    },
    /// Draw the panels as large as usual.
    ResetScale,
    /// Lay something over the window, or take it away.
    Cover(Over),
    /// Leave what lies over the window.
    Uncover,
    /// Begin a lesson; the first is 0.
    BeginLesson(usize),
    /// Show one of the lesson's scenes; the first is 0.
    TryLesson(usize),
    /// Tell the lesson's answer.
    TellLesson,
    /// End the lesson: everything is as it was before.
    LeaveLesson,
    /// Close the window.
    Quit,
}

/// Who leaves a change by the way has not dropped it.
const CHANGE_STAYS: &str = "The next run keeps the change: see the World tab.";

pub(super) fn plugin(app: &mut App) {
    app.add_message::<Command>().add_systems(Update, apply.in_set(Frame::Apply));
}

/// What is on the stage, and how it is looked at.
#[derive(SystemParam)]
struct StageParams<'w, 's> {
    lanes: Query<'w, 's, &'static Lane>,
    programme: Res<'w, Programme>,
    show: MessageWriter<'w, Show>,
    playback: ResMut<'w, Playback>,
    rig: ResMut<'w, CameraRig>,
    overlays: ResMut<'w, Overlays>,
    hands: ResMut<'w, Hands>,
    theme: ResMut<'w, Theme>,
    photographs: MessageWriter<'w, Photograph>,
    smoothing: Query<'w, 's, &'static mut Msaa, With<StageCamera>>,
}

impl StageParams<'_, '_> {
    /// What is on the stage, the first lane first.
    fn exhibits(&self) -> Vec<Exhibit> {
        let mut lanes: Vec<&Lane> = self.lanes.iter().collect();
        lanes.sort_by_key(|lane| lane.number());
        lanes.into_iter().map(|lane| lane.exhibit().clone()).collect()
    }

    /// Puts others on the stage, from their start. Whoever holds the stage after that, in the same frame, holds them.
    fn present(&mut self, show: Option<Show>) {
        if let Some(show) = show {
            self.playback.restart();
            self.show.write(show);
        }
    }

    fn end_s(&self) -> f64 {
        end_s(self.lanes.iter())
    }

    /// Length of a step of the lane in focus, in seconds.
    fn step_s(&self) -> f64 {
        let focused = self.lanes.iter().find(|lane| lane.number() == self.hands.lane);
        focused.map_or(1.0, Lane::step_s)
    }

    /// The lane in focus in another manner, the others as they are.
    fn in_place(&self, manner: impl Fn(&Exhibit) -> Exhibit) -> Show {
        let mut exhibits = self.exhibits();
        if let Some(focused) = exhibits.get_mut(self.hands.lane) {
            *focused = manner(focused);
        }
        Show { exhibits, programme: self.programme.clone() }
    }

    /// Whether a change that is being tried out is left by the way, neither kept nor dropped.
    fn leaves_change(&self, command: &Command) -> bool {
        let stays =
            matches!(command, Command::KeepChange | Command::ShowAsFound | Command::Simulate);
        matches!(*self.programme, Programme::WhatIf { .. }) && !stays
    }

    /// Whoever begins a run while a change is tried out goes on with it.
    fn settle(&mut self) {
        let kept = kept(&self.exhibits(), &self.programme);
        self.present(kept);
    }

    /// Shows what a change does, beside what it was before.
    fn try_out(&mut self, evolution: &mut Evolution, change: &Change) -> Result<(), String> {
        let mut on_show = self.exhibits();
        if *self.programme == Programme::Race && self.hands.lane < on_show.len() {
            // Of a race it is the one in focus that is tried.
            on_show.swap(0, self.hands.lane);
        }
        let show = what_if(evolution, &on_show, &self.programme, change)?;
        self.present(show);
        Ok(())
    }
}

impl StageParams<'_, '_> {
    /// Takes a step back or forth; the stage follows.
    fn step(&mut self, evolution: &mut Evolution, step: &Step, way: Way) -> Result<(), String> {
        match step {
            Step::Plan { before, after, .. } => {
                let (from, to) = if way == Way::Back { (after, before) } else { (before, after) };
                let now = evolution.next_plan().clone();
                evolution.set_next_plan(stepped(&now, from, to))?;
                let next = evolution.next_plan();
                let show = followed(&self.exhibits(), &self.programme, &now, next)?;
                self.present(show);
            }
            // No matter of the stage.
            Step::Library { .. } => {}
        }
        Ok(())
    }
}

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
            Command::ListStoppedRuns => evolution.list_stopped(),
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
            Command::ChangeRun { field, text } => evolution.change_running(field, text),
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
            Command::Undo | Command::Redo | Command::Library(Ask::Undo | Ask::Redo)
                if library.busy().is_some() =>
            {
                library.busy().map_or(Ok(()), Err)
            }
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
            Command::DropChange => dropped(&mut evolution, &stage.exhibits(), &stage.programme)
                .map(|show| stage.present(show)),
            Command::BeginLesson(index) => {
                desk.is_bare = false;
                desk.layout.open(PanelKind::Lessons);
                let programme = stage.programme.clone();
                let on_show = Show { exhibits: stage.exhibits(), programme };
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
            | Command::ChangeRun { .. }
            | Command::Library(Ask::FoundRun(_))
    )
}

/// Takes back what was done with saves, or does it again.
fn undo_in(library: &mut Library, way: Way, notices: &mut Notices) -> Result<(), String> {
    let said = match way {
        Way::Back => library.undo()?,
        Way::Forth => library.redo()?,
    };
    // Of many at once it is said once they are done.
    if let Some(said) = said.or_else(|| library.busy().is_none().then(|| way.nothing().to_owned()))
    {
        notices.news(said);
    }
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

/// Does what concerns the stage alone. Says whether others take the stage.
fn on_stage(
    command: &Command,
    stage: &mut StageParams,
    evolution: &Evolution,
    opening: &Opening,
) -> Result<bool, String> {
    let (end_s, step_s) = (stage.end_s(), stage.step_s());
    let on_show = || stage.exhibits();
    let show = match command {
        // Who is not found any more is not missed: somebody better has taken the place since the click.
        Command::Show(pick) => exhibit_of(pick, evolution, opening).map(Show::solo),
        Command::Join(pick) => {
            let mut on_show = on_show();
            if matches!(*stage.programme, Programme::WhatIf { .. }) {
                // The two are one.
                on_show.truncate(1);
            }
            let exhibit = exhibit_of(pick, evolution, opening);
            exhibit.map(|exhibit| with_one_more(on_show, exhibit)).transpose()?.flatten()
        }
        Command::RaceGenerations => Some(Show::race(all_generations(evolution)?)),
        Command::RaceLeaders(generation) => Some(Show::race(leaders(evolution, *generation)?)),
        Command::KeepChange => kept(&on_show(), &stage.programme),
        Command::Single if *stage.programme != Programme::Race => None,
        Command::Single => on_show().into_iter().nth(stage.hands.lane).map(Show::solo),
        Command::ShowAsFound => Some(stage.in_place(Exhibit::as_found)),
        Command::Simulate => Some(stage.in_place(Exhibit::simulated)),
        _ => None,
    };
    let is_new = show.is_some();
    stage.present(show);
    match command {
        Command::Focus(lane) => (stage.hands.lane, stage.hands.limb) = (*lane, None),
        Command::TogglePlayback => stage.playback.toggle(end_s),
        Command::Restart => stage.playback.restart(),
        Command::Seek(time_s) => stage.playback.seek(*time_s, end_s),
        Command::SeekEnd => stage.playback.hold_at(end_s),
        Command::Step { forward } => stage.playback.step(*forward, step_s, end_s),
        Command::SetSpeed(speed) => stage.playback.set_speed(*speed),
        Command::ChangeSpeed { faster } => stage.playback.change_speed(*faster),
        Command::ToggleLoop => stage.playback.toggle_loop(),
        Command::Look(shot) => stage.rig.take(*shot),
        Command::NextShot => {
            let next = stage.rig.shot().next();
            stage.rig.take(next);
        }
        Command::ToggleFollow => {
            let is_free = stage.rig.shot() == Shot::Free;
            stage.rig.take(if is_free { Shot::Follow } else { Shot::Free });
        }
        Command::ResetCamera => stage.rig.take(Shot::Follow),
        Command::Toggle(overlay) => stage.overlays.toggle(*overlay),
        Command::ToggleSmoothEdges => {
            for mut msaa in &mut stage.smoothing {
                *msaa = if *msaa == Msaa::Off { Msaa::Sample4 } else { Msaa::Off };
            }
        }
        Command::ToggleTheme => *stage.theme = stage.theme.other(),
        Command::TakePicture(of) => {
            stage.photographs.write(*of);
        }
        _ => {}
    }
    Ok(is_new)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::save::library::Place;
    use crate::save::shipped_champion;
    use crate::studio::casting::Saved;
    use crate::studio::evolution::prepared_run;

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
