//! Commands that the user can give, as plain data, in groups. `app::apply` passes each to the part of the studio that
//! executes its group.

pub mod actions;
mod block_size;
pub mod camera_mode;
pub mod chart_export;
pub mod files;
pub mod library;
pub mod modal;
pub mod overlay;
pub mod panel;
pub mod pick;
pub mod screenshot_area;
pub mod share;
pub mod turn;

use std::path::PathBuf;

use bevy::prelude::*;

use snakes_core::genome::BodyChange;
use snakes_core::save::library::SavePlace;
use snakes_core::score::ExamSuite;

pub(super) use block_size::BlockSize;
use camera_mode::CameraMode;
use chart_export::ChartExport;
use files::FileCommand;
use library::LibraryCommand;
use modal::Modal;
use overlay::Overlay;
use panel::PanelKind;
use pick::Pick;
use screenshot_area::ScreenshotArea;
use share::ShareCommand;
use turn::Turn;

/// A command from a panel, a menu or a key.
#[derive(Message, Debug, Clone, PartialEq)]
pub(super) enum Command {
    /// To the current run.
    Run(RunCommand),
    /// To the plan of the next run.
    Plan(PlanCommand),
    /// To the lanes of the stage.
    Stage(StageCommand),
    /// To the clock of the stage.
    Player(PlayerCommand),
    /// To the view of the stage.
    View(ViewCommand),
    /// To the layout of the window.
    Window(WindowCommand),
    /// To the library of saves.
    Library(LibraryCommand),
    /// To the system's dialogs for files, its file manager and its clipboard.
    File(FileCommand),
    /// To the files of other formats that are written from the stage.
    Share(ShareCommand),
    /// To the lessons.
    Lesson(LessonCommand),
    /// To the exams of champions on unseen stairs.
    Exam(ExamCommand),
    /// To the editor of bodies.
    Body(BodyCommand),
    /// To the connection with other computers.
    Machines(MachinesCommand),
    /// Undo the latest change of the next run's plan or of the saves.
    Undo,
    /// Redo the latest undone change.
    Redo,
    /// Show a message.
    Notify(String),
    /// Close the window.
    Quit,
}

/// A command to the current run.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum RunCommand {
    /// Evolve until paused or finished. After the end of a run, start the next one.
    Start,
    /// Pause evolution.
    Pause,
    /// Evolve to the end of the current generation.
    SingleGeneration,
    /// Discard the current run and prepare a fresh one.
    Reset,
    /// Continue the run in this folder.
    Continue(PathBuf),
    /// Set the number of worker threads, from the next generation on.
    SetThreads(usize),
    /// List all runs in the folder of saves.
    ListRuns,
    /// Add the run in this folder to the comparison chart, or remove it.
    Compare(PathBuf),
    /// Write a chart to a file.
    ExportChart(ChartExport),
}

/// A command to the plan of the next run. The stage shows the effect of a changed setting.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum PlanCommand {
    /// Set the seed.
    SetSeed(u64),
    /// Set the population size.
    SetPopulation(u32),
    /// Change one setting.
    SetField {
        /// Name of the setting: see [`snakes_core::evolve::with_field`].
        field: String,
        /// New value, as text.
        text: String,
    },
    /// Change several settings at once.
    SetFields(Vec<(String, String)>),
    /// Use this preset.
    SetPreset(String),
    /// Store the settings as a preset with this name.
    StorePreset(String),
    /// Reread the list of presets.
    ListPresets,
    /// Store the stairs among the user's own under this name.
    StoreStairs(String),
    /// Reread the list of the user's stairs.
    ListStairs,
    /// Start from this individual, in its world.
    StartFrom(Pick),
    /// Start from the champion of this entry of the library, now.
    StartFromSave(SavePlace),
    /// Start from random genomes again.
    ForgetFounder,
    /// Keep only this changed lane of a what-if, and its world for the next run; the first lane is 0.
    KeepLane(usize),
    /// Discard the latest change of a what-if.
    DropChange,
    /// Use the world of the selected lane for the next run.
    UseWorldOfLane,
}

impl PlanCommand {
    /// The command that changes one setting.
    pub fn set(field: &str, text: &str) -> Self {
        Self::SetField { field: field.to_owned(), text: text.to_owned() }
    }
}

/// A command to the lanes of the stage.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum StageCommand {
    /// Show this individual alone.
    Show(Pick),
    /// Add a lane with this individual, or remove its lane.
    Join(Pick),
    /// Show all snakes of this generation at once, or of the latest one; the first generation is 1.
    ShowGeneration(Option<u32>),
    /// Show each better generation of the run from now on, or stop doing so.
    ToggleFollowEvolution,
    /// Show the first, the middle and the latest of the better generations in turn.
    TellStory,
    /// Race the champions of the run's generations.
    RaceGenerations,
    /// Race the best of this generation, or of the latest one; the first generation is 1.
    RaceLeaders(Option<u32>),
    /// Show the snake at five values of this setting of the world, by its full dotted name, side by side.
    Sweep(String),
    /// Show the snake on its own stairs and on the built-in ones, side by side.
    RaceStairs,
    /// Accept the change of a what-if: only the changed lane stays.
    KeepChange,
    /// Leave the changed lane of a what-if as it is: the next change makes another lane beside it.
    TryAnother,
    /// Show the next, the previous or the first champion of a presentation.
    TakeTurn(Turn),
    /// Keep only the selected lane.
    Single,
    /// Show the snake in the world in which it was found.
    ShowAsFound,
    /// Simulate the snake with this engine instead of playing another engine's recording.
    Simulate,
    /// Select the lane whose numbers and signals are shown; the first is 0.
    Focus(usize),
}

/// A command to the clock of the stage.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum PlayerCommand {
    /// Pause or play.
    Toggle,
    /// Play from the start.
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
}

/// A command to the view of the stage.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum ViewCommand {
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
}

/// A command to the layout of the window.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum WindowCommand {
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
    /// Fill the screen with the stage and a large caption, or return to the window.
    TogglePresenting,
    /// Make the presented screen black, or show the stage again.
    ToggleBlack,
    /// Select the next larger or smaller UI scale.
    ChangeScale {
        /// Larger, or else smaller.
        larger: bool,
    },
    /// Reset the UI scale to 1.
    ResetScale,
    /// Remember whether the advanced settings of a section are unfolded.
    FoldAdvanced {
        /// Title of the section.
        section: &'static str,
        /// Unfolded, or else folded.
        is_open: bool,
    },
    /// Open a modal view, or close it if it is open.
    ToggleModal(Modal),
    /// Close the modal view.
    CloseModal,
}

/// A command to the lessons.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum LessonCommand {
    /// Begin a lesson; the first is 0.
    Begin(usize),
    /// Show one of the lesson's scenes; the first is 0.
    ShowScene(usize),
    /// Guess this answer to the scene's question and begin the experiment; the first answer is 0.
    Guess(usize),
    /// Begin the scene's experiment without a guess.
    Watch,
    /// Show the result of the scene now.
    ShowResult,
    /// End the lesson and restore the state from before it.
    Leave,
}

/// A command to the exam on unseen stairs of the selected snake.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum ExamCommand {
    /// Begin the exam, in the background.
    Examine,
    /// Stop the exam that is under way.
    Cancel,
    /// Show the snake on the stairs of a cell of the results.
    Watch {
        /// On other stairs, or there without senses.
        suite: ExamSuite,
        /// Index of the cell; the first is 0.
        cell: usize,
    },
    /// Show the snake on its own stairs again.
    BackToOwnStairs,
}

/// A command to the editor of bodies.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum BodyCommand {
    /// Edit the body of the selected snake on the stage.
    Edit,
    /// Set a number of a block; the head is 0.
    Set {
        /// The block.
        block: usize,
        /// The number.
        size: BlockSize,
        /// Its new value, in its unit.
        value: f32,
    },
    /// Make a block rigid; the head is 0.
    MakeRigid {
        /// The block.
        block: usize,
    },
    /// Change the structure at a block; the head is 0.
    Change {
        /// The block, or the first of two.
        block: usize,
        /// The change.
        change: BodyChange,
    },
    /// Undo the latest change of the body.
    Undo,
    /// Redo the latest undone change.
    Redo,
    /// Show the body beside the original.
    Preview,
    /// Adapt the gait to the body by a few evaluations, in the background.
    Tune,
    /// Stop adapting the gait; the best so far stays.
    CancelTuning,
    /// Start the next run from this body.
    Evolve,
    /// Close the editor, and show the original alone.
    Close,
}

/// A command to the connection with other computers.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum MachinesCommand {
    /// Connect to the server with this address. Runs then compute on its workers, too.
    Connect(String),
    /// Leave the server. Runs then compute on this computer only.
    Disconnect,
}
