//! The window: a stage that shows rollouts side by side, panels that steer an experiment.
//!
//! One concern is one file with one `plugin` function. The studio has no physics of its own: a lane of the stage
//! advances the very [`crate::score::Rollout`] that scores, to the moment of the one clock of all lanes, and
//! evolution runs on threads of its own ([`crate::run::Background`]). Panels and keys send a
//! [`command::Command`]; one system applies them.
//!
//! What happens in a frame, in this order, is [`Frame`].

mod access;
mod actions;
mod camera;
mod casting;
mod command;
mod desk;
mod engine;
mod evolution;
mod exhibit;
mod export;
pub mod figures;
mod frame_times;
mod graphics;
mod ground;
mod hands;
mod keys;
mod lane;
mod lessons;
mod lettering;
mod library;
mod limb;
mod look;
mod marks;
mod name_tags;
mod nosing;
mod notice;
mod now;
mod offscreen;
mod overlay;
mod paint;
mod panels;
mod performance;
mod places;
mod playback;
mod preferences;
mod presets;
mod quality;
pub mod render;
mod rounded;
mod scene;
mod screenshot;
mod sky;
mod snake;
mod solid;
mod stage;
mod stage_area;
mod start_up;
mod title;
mod undo;
mod view;
mod wireframe;

use std::path::PathBuf;
use std::sync::PoisonError;

use bevy::log::{Level, LogPlugin};
use bevy::prelude::*;
use bevy::window::{PresentMode, WindowResolution};
use bevy::winit::WinitSettings;

use crate::run::RunSource;
use crate::run::headless::HeadlessError;
use crate::save::{
    Comparison, LoadedChampion, PreferencesFile, SaveError, SavesFolder, shipped_champion,
};

use casting::{Opening, Saved};
use desk::Desk;
pub use look::Theme;
pub use overlay::Overlay;
use places::Places;
use preferences::Remembered;
pub use stage::MOST_LANES;
pub use view::Shot;

/// With what the studio opens.
#[derive(Debug, Clone)]
pub struct Options {
    /// The first run.
    pub run: RunSource,
    /// Worker threads for evolution.
    pub threads: usize,
    /// Where the next runs are saved.
    pub saves: SavesFolder,
    /// The champions to open with, and what they are called; several race. Without one, the shipped one.
    pub champions: Vec<(String, LoadedChampion)>,
    /// A comparison of methods to show.
    pub comparison: Option<Comparison>,
    /// Size of the window, in logical pixels; none: as it was before.
    pub window_size: Option<(u32, u32)>,
    /// The colours to open with; none: as they were before.
    pub theme: Option<Theme>,
    /// Where it is kept what a person has chosen for the window.
    pub preferences: PreferencesFile,
    /// Where to write what the panels show, for scripts and tests.
    pub places: Option<PathBuf>,
    /// After how many frames to close by itself.
    pub exit_after_frames: Option<u32>,
}

#[cfg(test)]
impl Options {
    /// Those of a test: this run, on one thread, and nothing of a person's own.
    fn of_test(run: RunSource, saves: SavesFolder) -> Self {
        Self {
            run,
            threads: 1,
            saves,
            champions: Vec::new(),
            comparison: None,
            window_size: None,
            theme: None,
            preferences: PreferencesFile::nowhere(),
            places: None,
            exit_after_frames: None,
        }
    }
}

/// Why the studio could not open, or ended badly.
#[derive(Debug, thiserror::Error)]
pub enum StudioError {
    /// There is no display, or no graphics driver.
    #[error("no window can be opened ({0}); use --no-render to work in the terminal")]
    NoWindow(String),
    /// No picture can be drawn.
    #[error(
        "no picture can be drawn ({0}); drawing needs a graphics driver, a software one will do"
    )]
    NoPicture(String),
    /// A champion cannot be built.
    #[error("{0}")]
    Unfit(String),
    /// The champion to open with could not be read.
    #[error(transparent)]
    Champion(#[from] SaveError),
    /// The threads could not be started.
    #[error(transparent)]
    Threads(#[from] HeadlessError),
    /// The program failed while the window was open.
    #[error("the studio failed: {message}; {}", match run {
        Some(folder) => format!("the run is safe, it goes on with --resume {}", folder.display()),
        None => "no run was going on".to_owned(),
    })]
    Crashed {
        /// What the program said.
        message: String,
        /// The folder of the run that was going on.
        run: Option<PathBuf>,
    },
    /// The window closed with an error.
    #[error("the studio ended with an error (exit code {0})")]
    Ended(u8),
}

/// What happens in a frame, in this order.
#[derive(SystemSet, Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum Frame {
    /// What evolution found meanwhile is taken in.
    TakeIn,
    /// Keys and the last frame's panels have asked for something; it is done.
    Apply,
    /// The stage catches up with the clock.
    Advance,
    /// What is on the stage is drawn where it is now.
    Draw,
}

/// The comparison of methods that the studio was opened with.
#[derive(Resource, Debug, Clone, Default)]
struct Opened(Option<Comparison>);

/// What the champion is called that is part of the program.
const SHIPPED: &str = "Saved champion";

/// Opens the studio and returns when its window is closed.
///
/// # Errors
/// See [`StudioError`].
pub fn run(options: Options) -> Result<(), StudioError> {
    let mut saved: Vec<Saved> = options.champions.clone().into_iter().map(Saved::from).collect();
    if saved.is_empty() {
        saved.push(Saved::from((SHIPPED.to_owned(), shipped_champion()?)));
    }
    let mut remembered = Remembered::read(&options.preferences);
    if options.exit_after_frames.is_some() {
        // Nobody sits before it who chooses anything.
        remembered = remembered.only_read();
    }
    let chosen = remembered.chosen().clone();
    let theme = options.theme.unwrap_or_else(|| chosen.theme.parse().unwrap_or_default());
    let size = options.window_size.or(chosen.window_size).unwrap_or(WINDOW_SIZE);
    // Who has the window opened for some frames is no newcomer.
    let tour_is_over = chosen.tour_is_over || options.exit_after_frames.is_some();
    let engine = engine::Engine::new(&options)?;
    let run_folder = engine.run_folder();
    let exit_after = options.exit_after_frames;
    let failure = graphics::Failure::default();
    let failed = failure.clone();
    let exit = start_up::guarded(&run_folder, move || {
        let mut app = App::new();
        app.add_plugins(
            DefaultPlugins
                .set(WindowPlugin { primary_window: Some(window(size)), ..default() })
                .set(LogPlugin { level: Level::WARN, ..default() }),
        )
        // A champion that climbs while the presenter types elsewhere goes on climbing.
        .insert_resource(WinitSettings::continuous())
        .insert_resource(theme)
        .insert_resource(remembered)
        .insert_resource(Places(options.places.clone()))
        .insert_resource(Desk::new(tour_is_over))
        .insert_resource(Opening(saved))
        .insert_resource(Opened(options.comparison.clone()))
        .insert_resource(engine)
        .insert_resource(failure)
        .configure_sets(Update, (Frame::TakeIn, Frame::Apply, Frame::Advance, Frame::Draw).chain())
        .add_plugins((
            (command::plugin, undo::plugin),
            (evolution::plugin, library::plugin),
            stage::plugin,
            scene::plugin,
            snake::plugin,
            camera::plugin,
            hands::plugin,
            (overlay::plugin, wireframe::plugin, screenshot::plugin),
            keys::plugin,
            (panels::plugin, name_tags::plugin, notice::plugin),
            (desk::plugin, preferences::plugin, access::plugin, places::plugin, lessons::plugin),
            (title::plugin, graphics::plugin, start_up::plugin),
        ));
        if let Some(frames) = exit_after {
            frame_times::plugin(&mut app, frames);
        }
        app.run()
    })?;
    match exit {
        AppExit::Success => Ok(()),
        AppExit::Error(code) => Err(match failed.message() {
            Some(message) => {
                let run = run_folder.lock().unwrap_or_else(PoisonError::into_inner).take();
                StudioError::Crashed { message, run }
            }
            None => StudioError::Ended(code.get()),
        }),
    }
}

/// Size of a window for which nobody has asked for another, in logical pixels.
const WINDOW_SIZE: (u32, u32) = (1280, 720);

fn window((width, height): (u32, u32)) -> Window {
    Window {
        title: "Snakes & Stairs".to_owned(),
        name: Some("snakes-and-stairs".to_owned()),
        resolution: WindowResolution::new(width, height),
        present_mode: PresentMode::AutoVsync,
        ..default()
    }
}
