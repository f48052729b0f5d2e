//! The camera: orbit, pan, zoom, follow.
//!
//! The world keeps the core's axes, so the camera has z up instead of everything being turned.

use bevy::camera::visibility::RenderLayers;
use bevy::camera::{CameraOutputMode, Viewport};
use bevy::core_pipeline::tonemapping::Tonemapping;
use bevy::input::mouse::{AccumulatedMouseScroll, MouseScrollUnit};
use bevy::pbr::{DistanceFog, FogFalloff};
use bevy::prelude::*;
use bevy::render::render_resource::BlendState;
use bevy::render::renderer::RenderAdapterInfo;
use bevy::window::PrimaryWindow;
use bevy_egui::input::EguiWantsInput;
use bevy_egui::{EguiGlobalSettings, PrimaryEguiContext};

use super::Frame;
use super::look::{Palette, Theme};
use super::panels::StageArea;
use super::quality::Quality;
use super::stage::Stage;

/// Where the camera is, relative to what it looks at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct View {
    /// Turn about z, in radians: 0 looks from +x, so that the stairs rise to the right.
    yaw_rad: f32,
    /// Height above the horizon, in radians.
    pitch_rad: f32,
    /// Distance from the target, in metres.
    distance_m: f32,
    /// What is looked at, beside the snake if the camera follows it, in metres.
    offset: Vec3,
}

impl Default for View {
    /// From the right side, a little behind and above: stairs and snake at a glance.
    fn default() -> Self {
        Self { yaw_rad: -0.55, pitch_rad: 0.36, distance_m: 24.0, offset: Vec3::new(0.0, 3.0, 0.5) }
    }
}

impl View {
    /// Where the camera stands to look at a target like this.
    fn looking_at(&self, target: Vec3) -> Transform {
        let turn = Quat::from_rotation_z(self.yaw_rad) * Quat::from_rotation_y(-self.pitch_rad);
        let eye = target + turn * Vec3::X * self.distance_m;
        Transform::from_translation(eye).looking_at(target, Vec3::Z)
    }
}

/// A fixed camera's place, from the usual side, that has a stretch of the y axis in view, in metres.
pub(super) fn overlooking(from_y_m: f32, to_y_m: f32) -> Transform {
    // At this distance the stretch, seen at an angle, fills the width of a 16:9 picture.
    const DISTANCE_PER_LENGTH: f32 = 0.95;
    let distance_m = ((to_y_m - from_y_m) * DISTANCE_PER_LENGTH).max(*DISTANCE_M.start());
    let view = View { distance_m, ..View::default() };
    view.looking_at(Vec3::new(0.0, (from_y_m + to_y_m) / 2.0, 1.5))
}

/// What every camera that draws the world has in common: no tone mapping, fog that hides the end of the
/// ground.
pub(super) fn eye(msaa: Msaa, palette: &Palette) -> impl Bundle {
    (
        Camera3d::default(),
        Tonemapping::None,
        msaa,
        DistanceFog {
            color: palette.horizon,
            falloff: FogFalloff::Linear { start: 50.0, end: 190.0 },
            ..default()
        },
    )
}

/// How the camera moves.
#[derive(Resource, Debug)]
pub(super) struct CameraRig {
    /// The view that was asked for.
    pub view: View,
    /// Whether the snake is kept in view.
    pub follows: bool,
    /// What is followed, smoothed, in metres.
    anchor: Option<Vec3>,
}

impl Default for CameraRig {
    fn default() -> Self {
        Self { view: View::default(), follows: true, anchor: None }
    }
}

/// The camera that draws the stage.
#[derive(Component)]
pub(super) struct StageCamera;

/// A full drag across 1000 pixels turns by this much, in radians.
const TURN_RAD_PER_PIXEL: f32 = 0.006;
/// A drag moves the target by this share of the distance per pixel.
const PAN_PER_PIXEL: f32 = 0.0012;
/// Zoom factor per wheel line.
const ZOOM_PER_LINE: f32 = 0.12;
/// Pixels of a trackpad's scroll that count as a wheel line.
const PIXELS_PER_LINE: f32 = 40.0;
/// Nearest and farthest distance, in metres.
const DISTANCE_M: std::ops::RangeInclusive<f32> = 3.0..=90.0;
/// Highest and lowest pitch, in radians: never quite overhead, never below the ground.
const PITCH_RAD: std::ops::RangeInclusive<f32> = 0.02..=1.55;
/// How eagerly the camera follows, in 1/s: in a short time t it covers the share `this * t` of the way.
const FOLLOW_PER_S: f32 = 4.0;
/// Nearer than this the camera is where it wants to be, in metres.
const FOLLOWED_M: f32 = 0.005;

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<CameraRig>()
        .add_systems(Startup, set_up)
        .add_systems(Update, (steer, follow, place, fit_to_area).chain().in_set(Frame::Draw));
}

/// One camera for the stage, beside the panel, and one for egui, over the whole window.
fn set_up(
    mut commands: Commands,
    mut egui_settings: ResMut<EguiGlobalSettings>,
    adapter: Res<RenderAdapterInfo>,
    theme: Res<Theme>,
) {
    egui_settings.auto_create_primary_context = false;
    commands.spawn((StageCamera, eye(Quality::suiting(&adapter).msaa, theme.palette())));
    commands.spawn((
        PrimaryEguiContext,
        Camera2d,
        RenderLayers::none(),
        Msaa::Off,
        Camera {
            order: 1,
            output_mode: CameraOutputMode::Write {
                blend_state: Some(BlendState::ALPHA_BLENDING),
                clear_color: ClearColorConfig::None,
            },
            clear_color: ClearColorConfig::Custom(Color::NONE),
            ..default()
        },
    ));
}

/// What the mouse has hold of.
#[derive(Debug, Default)]
pub(super) struct Grip {
    last_cursor: Option<Vec2>,
    /// Whether the button that is down went down over the stage: a drag that began on the panel
    /// belongs to the panel.
    began_on_stage: bool,
}

/// Turns drags and the wheel into a new view, unless they belong to a panel.
fn steer(
    mut rig: ResMut<CameraRig>,
    buttons: Res<ButtonInput<MouseButton>>,
    keys: Res<ButtonInput<KeyCode>>,
    window: Single<&Window, With<PrimaryWindow>>,
    area: Res<StageArea>,
    mut grip: Local<Grip>,
    scroll: Res<AccumulatedMouseScroll>,
    egui: Res<EguiWantsInput>,
) {
    // The cursor, not the device: a tablet or a remote desktop reports no relative motion.
    let cursor = window.cursor_position();
    let drag = match (grip.last_cursor, cursor) {
        (Some(last), Some(now)) => now - last,
        _ => Vec2::ZERO,
    };
    grip.last_cursor = cursor;
    let is_over_stage = cursor.is_some_and(|cursor| cursor.x >= area.left_points)
        && !egui.wants_any_pointer_input();
    let drag_buttons = [MouseButton::Left, MouseButton::Right, MouseButton::Middle];
    if buttons.any_just_pressed(drag_buttons) {
        grip.began_on_stage = is_over_stage;
    }
    let view = &mut rig.view;
    if is_over_stage {
        let lines = match scroll.unit {
            MouseScrollUnit::Line => scroll.delta.y,
            MouseScrollUnit::Pixel => scroll.delta.y / PIXELS_PER_LINE,
        };
        let factor = 1.0 - lines.clamp(-4.0, 4.0) * ZOOM_PER_LINE;
        let distance_m = view.distance_m * factor;
        view.distance_m = distance_m.clamp(*DISTANCE_M.start(), *DISTANCE_M.end());
    }
    if !grip.began_on_stage {
        return;
    }
    let shift = keys.any_pressed([KeyCode::ShiftLeft, KeyCode::ShiftRight]);
    let pans = buttons.any_pressed([MouseButton::Right, MouseButton::Middle]);
    if pans || (shift && buttons.pressed(MouseButton::Left)) {
        let turn = Quat::from_rotation_z(view.yaw_rad);
        let (right, up) = (turn * Vec3::Y, Vec3::Z);
        view.offset += (up * drag.y - right * drag.x) * view.distance_m * PAN_PER_PIXEL;
        view.offset = view.offset.clamp(Vec3::splat(-60.0), Vec3::splat(60.0));
    } else if buttons.pressed(MouseButton::Left) {
        view.yaw_rad -= drag.x * TURN_RAD_PER_PIXEL;
        let pitch_rad = view.pitch_rad + drag.y * TURN_RAD_PER_PIXEL;
        view.pitch_rad = pitch_rad.clamp(*PITCH_RAD.start(), *PITCH_RAD.end());
    }
}

/// Keeps the middle of the snake in view.
fn follow(mut rig: ResMut<CameraRig>, stages: Query<&Stage>, time: Res<Time<Real>>) {
    let Some(stage) = stages.iter().next() else { return };
    let poses: Vec<_> = stage.drawn_poses().collect();
    let Some(middle) = poses.get(poses.len() / 2) else { return };
    // Sideways wobble is the snake's own; following it would make the viewer seasick.
    let goal = Vec3::new(0.0, middle.translation.y, middle.translation.z.max(0.0));
    match rig.anchor {
        None => rig.anchor = Some(goal),
        Some(anchor) if rig.follows => {
            let share = 1.0 - (1.0 + FOLLOW_PER_S * time.delta_secs()).recip();
            // Ever smaller moves would keep a held picture trembling by a pixel here and there.
            let is_there = anchor.distance(goal) < FOLLOWED_M;
            rig.anchor = Some(if is_there { goal } else { anchor.lerp(goal, share) });
        }
        Some(_) => {}
    }
}

fn place(rig: Res<CameraRig>, mut camera: Single<&mut Transform, With<StageCamera>>) {
    **camera = rig.view.looking_at(rig.anchor.unwrap_or_default() + rig.view.offset);
}

/// Draws the stage beside the panel, not under it.
fn fit_to_area(
    area: Res<StageArea>,
    window: Single<&Window, With<PrimaryWindow>>,
    mut camera: Single<&mut Camera, With<StageCamera>>,
) {
    let physical = window.physical_size();
    let left =
        ((area.left_points * window.scale_factor()) as u32).min(physical.x.saturating_sub(1));
    let size = UVec2::new(physical.x.saturating_sub(left), physical.y);
    if size.x == 0 || size.y == 0 {
        return;
    }
    camera.viewport =
        Some(Viewport { physical_position: UVec2::new(left, 0), physical_size: size, ..default() });
}
