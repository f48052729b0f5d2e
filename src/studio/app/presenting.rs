//! The presenting mode outside the panels: the full screen, a camera that follows, repetition, and a pointer that hides
//! while it rests. Its end brings everything back as it was.

use std::time::Duration;

use bevy::prelude::*;
use bevy::window::{CursorOptions, MonitorSelection, PrimaryWindow, WindowMode};

use super::apply::apply;
use crate::studio::commands::camera_mode::CameraMode;
use crate::studio::scene::camera::rig::CameraRig;
use crate::studio::scene::camera::setup::CameraSetup;
use crate::studio::schedule::FrameSet;
use crate::studio::stage::playback::Playback;
use crate::studio::state::following::Following;
use crate::studio::ui::notifications::Notices;
use crate::studio::workspace::Workspace;

/// Time after which a resting pointer is hidden.
const POINTER_RESTS: Duration = Duration::from_secs(2);

/// What the presenting mode changes, as it was before.
#[derive(Debug)]
struct BeforePresenting {
    window_mode: WindowMode,
    camera: CameraSetup,
    loops: bool,
}

pub(crate) fn plugin(app: &mut App) {
    app.add_systems(
        Update,
        (present, hide_resting_pointer).chain().in_set(FrameSet::Apply).after(apply),
    );
}

/// Begins and ends the presenting mode.
fn present(
    workspace: Res<Workspace>,
    mut before: Local<Option<BeforePresenting>>,
    mut window: Single<&mut Window, With<PrimaryWindow>>,
    mut rig: ResMut<CameraRig>,
    (mut playback, mut following): (ResMut<Playback>, ResMut<Following>),
    mut notices: ResMut<Notices>,
) {
    let is_presenting = workspace.is_presenting();
    if is_presenting == before.is_some() {
        return;
    }
    following.set_repeats(is_presenting);
    notices.set_quiet(is_presenting);
    if let Some(BeforePresenting { window_mode, camera, loops }) = before.take() {
        window.mode = window_mode;
        rig.restore(camera);
        if playback.loops() != loops {
            playback.toggle_loop();
        }
        return;
    }
    *before = Some(BeforePresenting {
        window_mode: window.mode,
        camera: rig.setup(),
        loops: playback.loops(),
    });
    window.mode = WindowMode::BorderlessFullscreen(MonitorSelection::Current);
    rig.take(CameraMode::Follow);
    if !playback.loops() {
        playback.toggle_loop();
    }
}

/// Position of the pointer at its last move, and the time since then.
#[derive(Debug, Default)]
struct RestingPointer {
    at: Option<Vec2>,
    rested: Duration,
}

impl RestingPointer {
    /// Whether the pointer at `at` has rested long enough to be hidden. `passed` is the time since the last call.
    fn is_to_hide(&mut self, at: Option<Vec2>, passed: Duration) -> bool {
        self.rested = if self.at == at { self.rested + passed } else { Duration::ZERO };
        self.at = at;
        self.rested >= POINTER_RESTS
    }
}

fn hide_resting_pointer(
    workspace: Res<Workspace>,
    mut pointer: Local<RestingPointer>,
    time: Res<Time<Real>>,
    window: Single<(&Window, &mut CursorOptions), With<PrimaryWindow>>,
) {
    let (window, mut cursor) = window.into_inner();
    let rests = pointer.is_to_hide(window.cursor_position(), time.delta());
    let is_visible = !(rests && workspace.is_presenting());
    if cursor.visible != is_visible {
        cursor.visible = is_visible;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::commands::WindowCommand;

    fn app() -> App {
        let mut app = App::new();
        app.init_resource::<Workspace>()
            .init_resource::<CameraRig>()
            .init_resource::<Playback>()
            .init_resource::<Following>()
            .init_resource::<Notices>()
            .add_systems(Update, present);
        app.world_mut().spawn((Window::default(), PrimaryWindow));
        app
    }

    fn toggle(app: &mut App) {
        app.world_mut().resource_mut::<Workspace>().apply(&WindowCommand::TogglePresenting);
        app.update();
    }

    /// The window's mode, the camera's mode, and whether playback loops.
    fn state(app: &mut App) -> (WindowMode, CameraMode, bool) {
        let mut windows = app.world_mut().query::<&Window>();
        let mode = windows.single(app.world()).expect("one window").mode;
        let world = app.world();
        (mode, world.resource::<CameraRig>().camera_mode(), world.resource::<Playback>().loops())
    }

    #[test]
    fn presenting_fills_the_screen_follows_and_loops_and_its_end_restores_the_window() {
        let mut app = app();
        app.world_mut().resource_mut::<CameraRig>().take(CameraMode::Side);
        app.world_mut().resource_mut::<Playback>().toggle_loop();
        app.update();
        let before = state(&mut app);
        assert_eq!(before, (WindowMode::Windowed, CameraMode::Side, false));
        toggle(&mut app);
        let full = WindowMode::BorderlessFullscreen(MonitorSelection::Current);
        assert_eq!(state(&mut app), (full, CameraMode::Follow, true));
        app.world_mut().resource_mut::<CameraRig>().take(CameraMode::Top);
        app.update();
        assert_eq!(state(&mut app).1, CameraMode::Top, "another camera may be chosen meanwhile");
        toggle(&mut app);
        assert_eq!(state(&mut app), before);
    }

    #[test]
    fn the_pointer_hides_while_it_rests_and_appears_when_it_moves() {
        let mut pointer = RestingPointer::default();
        let (here, there) = (Some(Vec2::ZERO), Some(Vec2::X));
        assert!(!pointer.is_to_hide(here, POINTER_RESTS), "it has just come");
        assert!(pointer.is_to_hide(here, POINTER_RESTS));
        assert!(!pointer.is_to_hide(there, POINTER_RESTS));
    }
}
