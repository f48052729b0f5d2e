//! Commands that the user can give, as plain data, in groups. `app::apply` passes each command to the module that
//! executes its group.

pub mod actions;
mod block_size;
pub mod camera_mode;
pub mod chart_export;
pub mod files;
pub mod hinted;
pub mod library;
pub mod modal;
pub mod overlay;
pub mod panel;
pub mod pick;
pub mod quality;

use std::path::PathBuf;

use bevy::prelude::*;

use snakes_core::genome::BodyChange;
use snakes_core::save::library::SavePlace;
use snakes_core::score::ExamSuite;
use snakes_lab::export::ExportFormat;

pub(super) use block_size::BlockSize;
use camera_mode::CameraMode;
use chart_export::ChartExport;
use files::FileCommand;
use library::LibraryCommand;
use modal::Modal;
use overlay::Overlay;
use panel::PanelKind;
use pick::Pick;
use quality::Quality;

/// A command from a panel, a menu or a key.
#[derive(Message, Debug, Clone, PartialEq)]
pub(super) enum Command {
    /// Command to the current run.
    Run(RunCommand),
    /// Command to the plan of the next run.
    Plan(PlanCommand),
    /// Command to the lanes of the stage.
    Stage(StageCommand),
    /// Command to the clock of the stage.
    Player(PlayerCommand),
    /// Command to the view of the stage.
    View(ViewCommand),
    /// Command to the layout of the window.
    Window(WindowCommand),
    /// Command to the library of saves.
    Library(LibraryCommand),
    /// Command to the operating system's file dialogs, file manager and clipboard.
    File(FileCommand),
    /// Command to the writer of files in other formats, for the champions on the stage.
    Share(ShareCommand),
    /// Command to the lessons.
    Lesson(LessonCommand),
    /// Command to the exams of champions on unseen stairs.
    Exam(ExamCommand),
    /// Command to the editor of bodies.
    Body(BodyCommand),
    /// Command to the connection with other computers.
    Machines(MachinesCommand),
    /// Undo the latest change of the next run's plan or of the saves.
    Undo,
    /// Redo the latest undone change.
    Redo,
    /// Show a message.
    Notify(String),
    /// Close the window. If work would be lost, the first request asks, and the second one closes.
    Quit,
}

/// A command to the current run.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum RunCommand {
    /// Evolve until paused or finished.
    Start,
    /// Pause evolution.
    Pause,
    /// Evolve to the end of the current generation.
    SingleGeneration,
    /// Evolve the finished run further, by as many generations as it began with.
    Extend,
    /// Start another run: with the settings of the next run or, if they are unchanged, with the next seed. The current
    /// run stays saved.
    New,
    /// Discard the current run and prepare it again.
    Reset,
    /// Continue the run in this folder.
    Continue(PathBuf),
    /// Set the number of worker threads, from the next generation on.
    SetThreads(usize),
    /// Show the hash of the finished run.
    ShowHash,
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
    /// Set the seed of the next run.
    SetSeed(u64),
    /// Change one setting.
    SetField {
        /// Name of the setting: see [`snakes_core::evolve::with_field`].
        field: String,
        /// New value of the setting, as text.
        text: String,
    },
    /// Change several settings at once. Each pair is the name of a setting and its new value as text.
    SetFields(Vec<(String, String)>),
    /// Use the preset with this name.
    SetPreset(String),
    /// Store the settings of the next run as a preset with this name.
    StorePreset(String),
    /// Reread the list of presets.
    ListPresets,
    /// Store the stairs among the user's own under this name.
    StoreStairs(String),
    /// Reread the list of the user's stairs.
    ListStairs,
    /// Start the next run from this individual, in its world.
    StartFrom(Pick),
    /// Start the next run from the champion of this library entry at once.
    StartFromSave(SavePlace),
    /// Start the next run from random genomes again.
    ForgetFounder,
    /// Keep only this changed lane of a what-if, and use its world for the next run; the first lane is 0.
    KeepLane(usize),
    /// Discard the latest change of a what-if.
    DropChange,
    /// Use the world of the selected lane for the next run.
    UseWorldOfLane,
}

impl PlanCommand {
    /// Creates the command that changes one setting.
    pub fn set(field: &str, text: &str) -> Self {
        Self::SetField { field: field.to_owned(), text: text.to_owned() }
    }
}

/// A command to the lanes of the stage.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum StageCommand {
    /// Show this individual alone on the stage.
    Show(Pick),
    /// Add a lane with this individual, or remove its lane if it has one.
    Join(Pick),
    /// Show all snakes of this generation at once; `None` for the latest one. The first generation is 1.
    ShowGeneration(Option<u32>),
    /// Show each better generation of the run from now on, or stop following the run.
    ToggleFollowEvolution,
    /// Show the first, a middle and the latest of the generations that improved the run, one after another.
    TellStory,
    /// Race the champions of the run's generations.
    RaceGenerations,
    /// Race the best snakes of this generation; `None` for the latest one. The first generation is 1.
    RaceLeaders(Option<u32>),
    /// Show the snake at five values of this world setting, side by side. The text is the setting's full dotted name.
    Sweep(String),
    /// Show the snake on its own stairs and on the built-in ones, side by side.
    RaceStairs,
    /// Show the snake beside copies that each lack the torque of one joint or for one kind of motion.
    RaceKnockOuts,
    /// Accept the change of a what-if, and remove the lane without it.
    KeepChange,
    /// Keep the changed lane of a what-if. The next change then adds another lane beside it.
    TryAnother,
    /// Show the next, the previous or the first champion in the presenting mode.
    TakeTurn(Turn),
    /// Return to the scene before the race, the what-if or the single snake on the stage.
    Leave,
    /// Remove all lanes except the selected one.
    Single,
    /// Show the snake in the world in which it was found.
    ShowAsFound,
    /// Simulate the snake with this engine instead of playing another engine's recording.
    Simulate,
    /// Select the lane whose numbers and signals are shown; the first is 0.
    Focus(usize),
}

/// A step through the champions that the presenting mode shows one after another.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Turn {
    /// Show the next champion; after the last, show the first.
    Next,
    /// Show the previous champion; before the first, show the last.
    Previous,
    /// Show the first champion.
    First,
}

/// A command to the clock of the stage.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum PlayerCommand {
    /// Pause or play.
    Toggle,
    /// Play from the start.
    Restart,
    /// Go to this time, in simulated seconds.
    Seek(f64),
    /// Pause and go to the end of the rollout.
    SeekEnd,
    /// Pause and move by one physics step.
    Step {
        /// Whether the step goes forward rather than back.
        forward: bool,
    },
    /// Set the playback speed, in simulated seconds per real second.
    SetSpeed(f32),
    /// Select the next higher or lower playback speed.
    ChangeSpeed {
        /// Whether the speed becomes higher rather than lower.
        faster: bool,
    },
    /// Turn the loop on or off: playback repeats from the start after the end, or stops there.
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
    /// Return the camera to the initial view of its mode.
    ResetCamera,
    /// Show or hide an overlay of the scene.
    ToggleOverlay(Overlay),
    /// Draw the stage at this quality; `None` for the quality that suits the device.
    SetQuality(Option<Quality>),
    /// Select the next quality of the stage's picture.
    NextQuality,
    /// Switch between the light and the dark theme.
    ToggleTheme,
    /// Save a picture of the stage or of the window.
    TakePicture(ScreenshotArea),
}

/// The part of the window to save as a picture.
#[derive(Message, Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ScreenshotArea {
    /// Only the stage, without panels.
    Stage,
    /// The whole window.
    Window,
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
    /// Return from the presenting mode to the window.
    EndPresenting,
    /// Make the presented screen black, or show the stage again.
    ToggleBlack,
    /// Select the next larger or smaller UI scale.
    ChangeScale {
        /// Whether the scale becomes larger rather than smaller.
        larger: bool,
    },
    /// Make all texts a quarter larger than usual, or reset them.
    ToggleLarger,
    /// Reset the UI scale to 1.
    ResetScale,
    /// Show or hide the torques of each joint over time, in the player.
    ToggleTorques,
    /// Remember whether a fold is open.
    Fold {
        /// Key of the fold, such as the title of a section.
        section: &'static str,
        /// Whether the fold is open.
        is_open: bool,
    },
    /// Open a modal view, or close it if it is open.
    ToggleModal(Modal),
    /// Close the modal view.
    CloseModal,
}

/// Maximum size of a small GIF, in MB.
pub(super) const SMALL_GIF_MB: u32 = 2;

/// Length and size of a film.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum FilmSize {
    /// The usual ones of its format.
    Usual,
    /// A GIF of about [`SMALL_GIF_MB`] at most, which plays twice as fast.
    Small,
}

/// A command about sharing the champions on the stage as a file of another format.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ShareCommand {
    /// Ask where to save a file of this format, and write it.
    Ask(ExportFormat, FilmSize),
    /// Cancel the file that is being written.
    Cancel,
}

/// A command to the lessons.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum LessonCommand {
    /// Begin a lesson; the first is 0.
    Begin(usize),
    /// Show one of the lesson's scenes; the first is 0.
    ShowScene(usize),
    /// Select this answer to the scene's question and begin the experiment; the first answer is 0.
    Guess(usize),
    /// Begin the scene's experiment without a guess.
    Watch,
    /// Show the result of the scene now.
    ShowResult,
    /// End the lesson and restore the state from before it.
    Leave,
}

/// A command to the exam of the selected snake on unseen stairs.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum ExamCommand {
    /// Begin the exam of the selected snake in the background.
    Examine,
    /// Stop the exam that is in progress.
    Cancel,
    /// Show the snake on the stairs of one cell of the exam's results.
    Watch {
        /// Group of the exam's stairs, with or without senses.
        suite: ExamSuite,
        /// Index of the cell in the exam's grid; the first is 0.
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
    /// Set a number of a block.
    Set {
        /// Index of the block; the head is 0.
        block: usize,
        /// Which number of the block to set.
        size: BlockSize,
        /// New value, in the unit of that number.
        value: f32,
    },
    /// Make a block rigid.
    MakeRigid {
        /// Index of the block; the head is 0.
        block: usize,
    },
    /// Change the structure of the body at a block.
    Change {
        /// Index of the block, or of the first of two; the head is 0.
        block: usize,
        /// Change of the structure.
        change: BodyChange,
    },
    /// Undo the latest change of the body.
    Undo,
    /// Redo the latest undone change.
    Redo,
    /// Show the edited body beside the original.
    Preview,
    /// Save the edited snake in the library.
    Save,
    /// Adapt the gait to the edited body by a few evaluations, in the background.
    Tune,
    /// Stop adapting the gait, and keep the best one found.
    CancelTuning,
    /// Start a run from the edited body at once, and close the editor.
    Evolve,
    /// Close the editor, and show the original body alone.
    Close,
}

/// A command to the connection with other computers.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum MachinesCommand {
    /// Connect to the server at this address. Runs then also use the server's workers.
    Connect(String),
    /// Disconnect from the server. Runs then use this computer only.
    Disconnect,
}
