//! What a person can ask for, and the one place where it is done.

use std::path::PathBuf;

use bevy::prelude::*;

use super::camera::{CameraRig, View};
use super::evolution::Evolution;
use super::exhibit::Exhibit;
use super::look::Theme;
use super::notice::Notices;
use super::stage::{ShowExhibit, Stage};
use super::{Frame, Opening};
use crate::evolve::Champion;

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
    /// Take this shipped preset for the next run, and show what it does to what is on the stage.
    SetPreset(String),
    /// Show what is on the stage as it was found.
    ShowAsFound,
    /// Let this engine simulate what is on the stage, which another engine found.
    Simulate,
    /// Look for runs that were stopped before their end.
    ListStoppedRuns,
    /// Go on with the run in this folder.
    Continue(PathBuf),
    /// Put the champion that the studio opened with on the stage.
    ShowOpening,
    /// Put the champion of this generation on the stage; the first is 1.
    ShowGeneration(u32),
    /// Put somebody of the front of distance and energy on the stage.
    ShowFront {
        /// The generation that found it; the first is 1.
        generation: u32,
        /// Its index in that generation.
        individual: u32,
    },
    /// Put the best of a cell of the archive on the stage.
    ShowElite(u32),
    /// Hold or resume what is on the stage.
    TogglePlayback,
    /// Play what is on the stage from its start.
    Restart,
    /// Let the camera follow the snake, or stop it.
    ToggleFollow,
    /// Put the camera where it was at the start.
    ResetCamera,
    /// Show or hide the physics engine's own drawing.
    ToggleWireframe,
    /// From the light theme to the dark one, or back.
    ToggleTheme,
    /// Close the window.
    Quit,
}

pub(super) fn plugin(app: &mut App) {
    app.add_message::<Command>().add_systems(Update, apply.in_set(Frame::Apply));
}

/// Does what was asked for, in the order in which it was asked.
fn apply(
    mut asked: MessageReader<Command>,
    mut evolution: ResMut<Evolution>,
    mut notices: ResMut<Notices>,
    mut rig: ResMut<CameraRig>,
    mut wireframe: ResMut<bevy_rapier3d::render::DebugRenderContext>,
    mut stages: Query<&mut Stage>,
    mut show: MessageWriter<ShowExhibit>,
    mut exit: MessageWriter<AppExit>,
    opening: Res<Opening>,
    mut theme: ResMut<Theme>,
) {
    for command in asked.read() {
        let done = match command {
            Command::Start => evolution.start(),
            Command::Pause => evolution.pause(),
            Command::SingleGeneration => evolution.single_generation(),
            Command::Reset => evolution.reset(),
            Command::SetSeed(seed) => evolution.set_seed(*seed),
            Command::SetPopulation(population) => evolution.set_population(*population),
            Command::SetField { field, text } => evolution
                .set_field(field, text)
                .map(|()| show_changed(&evolution, &stages, &mut show, &mut notices)),
            Command::SetPreset(name) => evolution
                .set_preset(name)
                .map(|()| show_changed(&evolution, &stages, &mut show, &mut notices)),
            Command::ShowAsFound => {
                let found = stages.iter().map(|stage| stage.exhibit().as_found());
                show.write_batch(found.map(ShowExhibit));
                Ok(())
            }
            Command::Simulate => {
                let simulated = stages.iter().map(|stage| stage.exhibit().simulated());
                show.write_batch(simulated.map(ShowExhibit));
                Ok(())
            }
            Command::ListStoppedRuns => evolution.list_stopped(),
            Command::Continue(folder) => evolution.go_on_with(folder),
            Command::ShowOpening => {
                show.write(ShowExhibit(Exhibit::saved(&opening.0)));
                Ok(())
            }
            Command::ShowGeneration(generation) => {
                show_found(&evolution, evolution.champion_of(*generation), &mut show)
            }
            Command::ShowFront { generation, individual } => {
                let member = evolution.front_member(*generation, *individual);
                show_found(&evolution, member.as_ref(), &mut show)
            }
            Command::ShowElite(cell) => {
                show_found(&evolution, evolution.elite(*cell).as_ref(), &mut show)
            }
            Command::TogglePlayback => {
                stages.iter_mut().for_each(|mut stage| stage.toggle_playback());
                Ok(())
            }
            Command::Restart => {
                stages.iter_mut().for_each(|mut stage| stage.ask_for_restart());
                Ok(())
            }
            Command::ToggleFollow => {
                rig.follows = !rig.follows;
                Ok(())
            }
            Command::ResetCamera => {
                rig.view = View::default();
                rig.follows = true;
                Ok(())
            }
            Command::ToggleTheme => {
                *theme = theme.other();
                Ok(())
            }
            Command::Quit => {
                exit.write(AppExit::Success);
                Ok(())
            }
            Command::ToggleWireframe => {
                wireframe.enabled = !wireframe.enabled;
                Ok(())
            }
        };
        if let Err(problem) = done {
            notices.problem(problem);
        }
    }
}

/// Shows somebody that the current run has found. Who is not found any more is not missed: somebody better has
/// taken the place since the click.
fn show_found(
    evolution: &Evolution,
    champion: Option<&Champion>,
    show: &mut MessageWriter<ShowExhibit>,
) -> Result<(), String> {
    let exhibit = champion.map(|champion| Exhibit::found(champion, evolution.number()));
    show.write_batch(exhibit.map(ShowExhibit));
    Ok(())
}

/// Shows what is on the stage in the world of the next run, if its genome fits into that.
fn show_changed(
    evolution: &Evolution,
    stages: &Query<&mut Stage>,
    show: &mut MessageWriter<ShowExhibit>,
    notices: &mut Notices,
) {
    let trial = &evolution.next_settings().trial;
    for stage in stages {
        match stage.exhibit().in_world(trial) {
            Some(changed) => {
                show.write(ShowExhibit(changed));
            }
            None => notices.news(format!(
                "What is on show has {} limbs and stays in its own world; a new run will show this one.",
                stage.trial().agent.limbs
            )),
        }
    }
}
