//! The presenting mode outside the panels: full screen, a following camera, looping playback, and a hidden pointer
//! while the mouse rests. Its end restores the window; [`super::apply`] restores the scene.

use std::time::Duration;

use bevy::prelude::*;
use bevy::window::{CursorOptions, MonitorSelection, PrimaryWindow, WindowMode};

use super::apply::apply;
use crate::studio::commands::camera_mode::CameraMode;
use crate::studio::scene::camera::rig::CameraRig;
use crate::studio::schedule::FrameSet;
use crate::studio::stage::playback::Playback;
use crate::studio::state::following::Following;
use crate::studio::state::turns::Turns;
use crate::studio::ui::notifications::Notices;
use crate::studio::workspace::Workspace;

/// Time after which a resting mouse pointer is hidden.
const POINTER_RESTS: Duration = Duration::from_secs(2);

pub(crate) fn plugin(app: &mut App) {
    app.add_systems(
        Update,
        (present, sway, hide_resting_pointer).chain().in_set(FrameSet::Apply).after(apply),
    );
}

/// Begins and ends the presenting mode, after the scene was stored or brought back.
fn present(
    workspace: Res<Workspace>,
    mut before: Local<Option<WindowMode>>,
    mut window: Single<&mut Window, With<PrimaryWindow>>,
    mut rig: ResMut<CameraRig>,
    (mut playback, mut following): (ResMut<Playback>, ResMut<Following>),
    mut turns: ResMut<Turns>,
    mut notices: ResMut<Notices>,
) {
    turns.is_held = workspace.is_black();
    following.is_held = workspace.is_menu_open;
    let is_presenting = workspace.is_presenting;
    if is_presenting == before.is_some() {
        return;
    }
    following.repeats = is_presenting;
    turns.set_on(is_presenting);
    notices.is_quiet = is_presenting;
    if let Some(window_mode) = before.take() {
        window.mode = window_mode;
        return;
    }
    *before = Some(window.mode);
    window.mode = WindowMode::BorderlessFullscreen(MonitorSelection::Current);
    rig.take(CameraMode::Follow);
    playback.loops = true;
}

/// Maximum rotation of the slowly swaying camera to each side, in radians. Further round, the stairs would hide the snake.
const SWAY_RAD: f32 = 0.4;
/// Period of the camera's sway to both sides and back, in seconds.
const SWAY_S: f32 = 48.0;

/// Sways the camera slowly around the snake, from side to side, while the playback runs.
fn sway(
    workspace: Res<Workspace>,
    playback: Res<Playback>,
    mut rig: ResMut<CameraRig>,
    time: Res<Time<Real>>,
    mut swayed_s: Local<f32>,
) {
    if !workspace.is_presenting {
        *swayed_s = 0.0;
        return;
    }
    if playback.is_playing && rig.camera_mode == CameraMode::Follow {
        let from_s = *swayed_s;
        *swayed_s = (from_s + time.delta_secs()) % SWAY_S;
        rig.view.yaw_rad += sway_rad(*swayed_s) - sway_rad(from_s);
    }
}

/// Returns the rotation of the swaying camera at a time, in radians.
fn sway_rad(time_s: f32) -> f32 {
    SWAY_RAD * libm::sinf(time_s / SWAY_S * std::f32::consts::TAU)
}

/// Position of the pointer at its last move, and the time since the move.
#[derive(Debug, Default)]
struct RestingPointer {
    at: Option<Vec2>,
    rested: Duration,
}

impl RestingPointer {
    /// Returns whether the pointer at `at` has rested long enough to be hidden. `passed` is the time since the last call.
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
    let is_visible = !(rests && workspace.is_presenting);
    if cursor.visible != is_visible {
        cursor.visible = is_visible;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::app::apply::tests::app;
    use crate::studio::commands::WindowCommand;

    fn toggle(app: &mut App) {
        app.world_mut().resource_mut::<Workspace>().apply(&WindowCommand::TogglePresenting);
        app.update();
    }

    /// Returns the window's mode, the camera's mode, and whether playback loops.
    fn state(app: &mut App) -> (WindowMode, CameraMode, bool) {
        let mut windows = app.world_mut().query::<&Window>();
        let mode = windows.single(app.world()).expect("one window").mode;
        let world = app.world();
        (mode, world.resource::<CameraRig>().camera_mode, world.resource::<Playback>().loops)
    }

    #[test]
    fn presenting_fills_the_screen_follows_and_loops_and_its_end_restores_the_window() {
        let mut app = app();
        app.add_systems(Update, present);
        app.world_mut().spawn((Window::default(), PrimaryWindow));
        app.world_mut().resource_mut::<CameraRig>().take(CameraMode::Side);
        app.world_mut().resource_mut::<Playback>().loops = false;
        app.update();
        assert_eq!(state(&mut app), (WindowMode::Windowed, CameraMode::Side, false));
        toggle(&mut app);
        let full = WindowMode::BorderlessFullscreen(MonitorSelection::Current);
        assert_eq!(state(&mut app), (full, CameraMode::Follow, true));
        app.world_mut().resource_mut::<CameraRig>().take(CameraMode::Top);
        app.update();
        assert_eq!(state(&mut app).1, CameraMode::Top, "another camera may be chosen meanwhile");
        toggle(&mut app);
        assert_eq!(state(&mut app).0, WindowMode::Windowed);
    }

    #[test]
    fn the_camera_sways_slowly_to_both_sides_and_comes_back() {
        let times = (0..=480).map(|tenth| tenth as f32 / 10.0);
        let turns: Vec<f32> = times.map(sway_rad).collect();
        let most = turns.iter().copied().fold(0.0, f32::max);
        let least = turns.iter().copied().fold(0.0, f32::min);
        assert!((most - SWAY_RAD).abs() < 1.0e-3 && (least + SWAY_RAD).abs() < 1.0e-3);
        let fastest = turns.windows(2).map(|pair| (pair[1] - pair[0]).abs() * 10.0);
        assert!(fastest.fold(0.0, f32::max) < 0.06, "rad/s");
        assert!(turns[480].abs() < 1.0e-4, "no jump where it begins again");
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
