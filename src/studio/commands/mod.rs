//! Commands that the user can give, as plain data. `app::apply` is the only place that executes them.

pub mod actions;
pub mod camera_mode;
pub mod chart_export;
pub mod library;
pub mod modal;
pub mod overlay;
pub mod panel;
pub mod pick;
pub mod screenshot_area;

use std::path::PathBuf;

use bevy::prelude::*;

use camera_mode::CameraMode;
use chart_export::ChartExport;
use library::LibraryCommand;
use modal::Modal;
use overlay::Overlay;
use panel::PanelKind;
use pick::Pick;
use screenshot_area::ScreenshotArea;

/// A command from a panel, a menu or a key.
#[derive(Message, Debug, Clone, PartialEq)]
pub(super) enum Command {
    /// Evolve until paused or finished. After the end of a run, start the next one.
    Start,
    /// Pause evolution.
    Pause,
    /// Evolve to the end of the current generation.
    SingleGeneration,
    /// Discard the current run and prepare a fresh one.
    Reset,
    /// Set the seed of the next run.
    SetSeed(u64),
    /// Set the population size of the next run.
    SetPopulation(u32),
    /// Change one setting of the next run and show its effect on the stage.
    SetField {
        /// Name of the setting: see [`crate::evolve::with_field`].
        field: String,
        /// New value, as text.
        text: String,
    },
    /// Set the number of worker threads, from the next generation on.
    SetThreads(usize),
    /// Start the next run from this individual, in its world.
    StartFrom(Pick),
    /// Start the next run from random genomes again.
    ForgetFounder,
    /// Change several settings of the next run at once and show their effect on the stage.
    SetFields(Vec<(String, String)>),
    /// Use this preset for the next run and show its effect on the stage.
    SetPreset(String),
    /// Store the settings of the next run as a preset with this name.
    StorePreset(String),
    /// Reread the list of presets.
    ListPresets,
    /// Undo the latest change of the next run's plan.
    Undo,
    /// Redo the latest undone change.
    Redo,
    /// Accept the change of a what-if: only the changed lane stays on the stage.
    KeepChange,
    /// Discard the change of a what-if.
    DropChange,
    /// Show the snake on the stage in the world in which it was found.
    ShowAsFound,
    /// Simulate the snake on the stage with this engine instead of playing another engine's recording.
    Simulate,
    /// Continue the run in this folder.
    Continue(PathBuf),
    /// List all runs in the folder of saves.
    ListRuns,
    /// Add the run in this folder to the comparison chart, or remove it.
    Compare(PathBuf),
    /// Write a chart to a file.
    ExportChart(ChartExport),
    /// Do something with the saves.
    Library(LibraryCommand),
    /// Show this individual alone on the stage.
    Show(Pick),
    /// Add a lane with this individual to the stage, or remove its lane.
    Join(Pick),
    /// Race the champions of the run's generations.
    RaceGenerations,
    /// Race the best of this generation, or of the latest one; the first generation is 1.
    RaceLeaders(Option<u32>),
    /// Select the lane whose numbers and signals are shown; the first is 0.
    Focus(usize),
    /// Keep only the selected lane.
    Single,
    /// Pause or play the stage.
    TogglePlayback,
    /// Play the stage from its start.
    Restart,
    /// Go to this moment, in simulated seconds.
    Seek(f64),
    /// Pause and go to the end.
    SeekEnd,
    /// Pause and move by one physics step.
    Step {
        /// Forward, or else back.
        forward: bool,
    },
    /// Set the playback speed, in simulated seconds per second.
    SetSpeed(f32),
    /// Select the next higher or lower playback speed.
    ChangeSpeed {
        /// Higher, or else lower.
        faster: bool,
    },
    /// Repeat from the start after the end, or stop there.
    ToggleLoop,
    /// Select this camera mode.
    SetCamera(CameraMode),
    /// Select the next camera mode.
    NextCameraMode,
    /// Let the camera follow the snake, or stop following.
    ToggleFollow,
    /// Return the camera to its initial view.
    ResetCamera,
    /// Show or hide an overlay of the scene.
    ToggleOverlay(Overlay),
    /// Turn anti-aliasing on or off.
    ToggleSmoothEdges,
    /// Switch between the light and the dark theme.
    ToggleTheme,
    /// Save a picture of the stage or of the window.
    TakePicture(ScreenshotArea),
    /// Show a message.
    Notify(String),
    /// Bring a panel to the front.
    OpenPanel(PanelKind),
    /// Bring the section of the settings with this label to the front.
    FindSetting(&'static str),
    /// Close the panel that was used last.
    ClosePanel,
    /// Return the panels to their initial layout.
    ResetLayout,
    /// Hide all panels, or show them again.
    TogglePanels,
    /// Select the next larger or smaller UI scale.
    ChangeScale {
        /// Larger, or else smaller.
        larger: bool,
    },
    /// Reset the UI scale to 1.
    ResetScale,
    /// Open a modal view, or close it if it is open.
    ToggleModal(Modal),
    /// Close the modal view.
    CloseModal,
    /// Begin a lesson; the first is 0.
    BeginLesson(usize),
    /// Show one of the lesson's scenes; the first is 0.
    ShowLessonScene(usize),
    /// Show the lesson's answer.
    ShowLessonAnswer,
    /// End the lesson and restore the state from before it.
    LeaveLesson,
    /// Close the window.
    Quit,
}
