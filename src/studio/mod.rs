//! The window: a stage that shows rollouts side by side, and panels that control an experiment.
//!
//! Each concern is one file with one `plugin` function. The folders are ordered, and each uses only those before it:
//! `commands < ui < stage < state < {workspace, failure, scene} < {pictures, panels} < app`, with [`schedule`] and
//! [`error`] beside `commands`; `tests/it/architecture.rs` checks it. The studio has no physics of its own: a lane
//! advances the same [`snakes_core::score::Rollout`] that scores to the time of the shared clock. Evolution runs on its own
//! threads ([`snakes_lab::run::BackgroundRun`]). Panels and keys send a [`commands::Command`]; one system applies them.
//!
//! [`schedule::FrameSet`] orders the systems within a frame.

mod app;
mod commands;
mod error;
mod failure;
mod panels;
mod pictures;
mod scene;
mod schedule;
mod stage;
mod state;
mod ui;
mod workspace;

use std::sync::{Arc, PoisonError};

use bevy::log::{Level, LogPlugin};
use bevy::prelude::*;
use bevy::window::{PresentMode, WindowResolution};
use bevy::winit::WinitSettings;

use snakes_core::save::{PreferencesFile, shipped_champion};

use app::preferences::StoredPreferences;
use app::ui_dump::UiDumpFile;
use stage::opening::OpeningChampions;
use state::current_run::CurrentRun;
use state::following::Following;
use state::turns::Turns;
use ui::notifications::Notices;
use workspace::Workspace;

pub use commands::camera_mode::CameraMode;
pub use commands::overlay::Overlay;
pub use error::StudioError;
pub use failure::variables::correct as correct_variables;
pub use pictures::{figures, film, render};
pub use stage::MAX_LANES;
pub use state::options::Options;
pub use state::shares::StageLook;
pub use ui::theme::Theme;

/// Name of the built-in champion.
const SHIPPED: &str = "climber (built-in)";

/// Opens the studio and returns when its window is closed.
///
/// # Errors
/// See [`StudioError`].
pub fn run(options: Options) -> Result<(), StudioError> {
    let has_champions = !options.champions.is_empty();
    let mut saved = options.champions.clone();
    if saved.is_empty() {
        saved.push((SHIPPED.to_owned(), shipped_champion()?));
    }
    let mut remembered = StoredPreferences::read(&options.preferences);
    if options.exit_after_frames.is_some() {
        // Automated runs have no user, so preferences are not saved.
        remembered.file = PreferencesFile::nowhere();
    }
    let chosen = remembered.stored.clone();
    let theme = options.theme.unwrap_or_else(|| chosen.theme.parse().unwrap_or_default());
    let size = options.window_size.or(chosen.window_size).unwrap_or(WINDOW_SIZE);
    // Skip the tour in automated runs.
    let tour_is_over = chosen.tour_is_over || options.exit_after_frames.is_some();
    let run = CurrentRun::new(&options);
    let run_folder = Arc::clone(&run.context.run_folder);
    let exit_after = options.exit_after_frames;
    let problems = options.problems.clone();
    let exit = failure::panic_guard::guarded(&run_folder, move || {
        let mut app = App::new();
        app.add_plugins(
            DefaultPlugins
                .set(WindowPlugin {
                    primary_window: Some(window(size)),
                    // The command to quit closes the window.
                    close_when_requested: false,
                    ..default()
                })
                .set(LogPlugin { level: Level::WARN, ..default() }),
        )
        // Keep drawing while another window has the focus.
        .insert_resource(WinitSettings::continuous())
        .insert_resource(theme)
        .insert_resource(remembered)
        .insert_resource(UiDumpFile(options.places.clone()))
        .insert_resource(Workspace::new(tour_is_over, options.presents))
        .insert_resource(OpeningChampions(saved))
        // If the studio was opened with champions, they stay on the stage; otherwise it follows the run.
        .insert_resource(if has_champions { Following::default() } else { Following::from_start() })
        .insert_resource(Turns::new(has_champions))
        .insert_resource(options)
        .insert_resource(run)
        .add_plugins((
            schedule::plugin,
            app::plugin,
            failure::gpu_loss::plugin,
            failure::panic_guard::plugin,
            panels::plugin,
            pictures::screenshot::plugin,
            scene::plugin,
            stage::plugin,
            state::plugin,
            ui::plugin,
            workspace::plugin,
        ));
        let mut notices = app.world_mut().resource_mut::<Notices>();
        problems.into_iter().for_each(|problem| notices.problem(problem));
        if let Some(frames) = exit_after {
            app::frame_times::plugin(&mut app, frames);
        }
        app.run()
    })?;
    match exit {
        AppExit::Success => Ok(()),
        AppExit::Error(code) => Err(match failure::gpu_loss::failure() {
            Some(message) => {
                let run = run_folder.lock().unwrap_or_else(PoisonError::into_inner).take();
                StudioError::Crashed { message, run }
            }
            None => StudioError::Ended(code.get()),
        }),
    }
}

/// Default window size, in logical pixels.
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
