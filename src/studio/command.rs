//! What a person can ask for; [`apply`] is the one place where it is done.

mod apply;
mod stage;

use std::path::PathBuf;

use bevy::prelude::*;

use super::casting::Pick;
use super::desk::Over;
use super::export::Export;
use super::library::Ask;
use super::overlay::Overlay;
use super::panels::PanelKind;
use super::screenshot::Photograph;
use super::view::Shot;

pub(super) use apply::plugin;

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
