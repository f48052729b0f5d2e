//! The camera: orbit, pan, zoom, follow.
//!
//! The world keeps the core's axes, so the camera has z up instead of everything being turned.

use bevy::camera::visibility::RenderLayers;
use bevy::camera::{CameraOutputMode, Viewport};
use bevy::core_pipeline::tonemapping::Tonemapping;
use bevy::input::gestures::PinchGesture;
use bevy::input::mouse::{AccumulatedMouseScroll, MouseScrollUnit};
use bevy::pbr::{DistanceFog, FogFalloff};
use bevy::prelude::*;
use bevy::render::render_resource::BlendState;
use bevy::render::renderer::RenderAdapterInfo;
use bevy::window::PrimaryWindow;
use bevy_egui::{EguiGlobalSettings, PrimaryEguiContext};

use super::Frame;
use super::hands::Hands;
use super::lane::Lane;
use super::look::{Palette, Theme};
use super::quality::Quality;
use super::stage_area::StageArea;
use super::view::{Shot, View};

/// A fixed camera's place, from the usual side, that has a stretch of the y axis in view, in metres.
pub(super) fn overlooking(from_y_m: f32, to_y_m: f32) -> Transform {
    // At this distance the stretch, seen at an angle, fills the width of a 16:9 picture.
    const DISTANCE_PER_LENGTH: f32 = 0.95;
    let distance_m = ((to_y_m - from_y_m) * DISTANCE_PER_LENGTH).max(*View::DISTANCE_M.start());
    let view = View { distance_m, ..View::of(Shot::Follow, 1) };
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
    shot: Shot,
    /// The view that was asked for.
    view: View,
    /// The view that is shown, on its way there.
    shown: View,
    /// Whether the snake is kept in view, or all of them.
    follows: bool,
    /// The one lane that is followed, if not all are.
    lane: Option<usize>,
    /// What is followed, smoothed, in metres.
    anchor: Option<Vec3>,
    lanes: usize,
}

impl Default for CameraRig {
    fn default() -> Self {
        let view = View::of(Shot::Follow, 1);
        Self {
            shot: Shot::Follow,
            view,
            shown: view,
            follows: true,
            lane: None,
            anchor: None,
            lanes: 1,
        }
    }
}

impl CameraRig {
    /// How the stage is looked at.
    pub fn shot(&self) -> Shot {
        self.shot
    }

    /// Looks at the stage in another way.
    pub fn take(&mut self, shot: Shot) {
        self.shot = shot;
        self.follows = shot != Shot::Free;
        if self.follows {
            // It goes the short way round.
            let turn = std::f32::consts::TAU;
            self.shown.yaw_rad -= libm::roundf(self.shown.yaw_rad / turn) * turn;
            self.view = View::of(shot, self.lanes);
            self.lane = None;
        } else {
            // It stays where it is, however it came there.
            self.view = self.shown;
        }
    }

    /// Looks at a lane's snake or, without one, at a point that stays where it is, in metres.
    pub fn focus_on(&mut self, lane: Option<usize>, point: Vec3) {
        self.view.distance_m = self.view.distance_m.min(FOCUS_M);
        self.lane = lane;
        if lane.is_some() {
            self.view.offset = Vec3::ZERO;
            (self.shot, self.follows) = (Shot::Follow, true);
        } else {
            (self.shot, self.follows) = (Shot::Free, false);
            // From where the camera looks now it glides to the point.
            self.view.offset = point - self.anchor.unwrap_or_default();
        }
    }

    /// Whether all lanes are kept in view.
    fn frames_all(&self) -> bool {
        self.follows && self.lane.is_none() && self.lanes > 1
    }

    /// Where the camera stands now.
    pub fn place(&self) -> Transform {
        self.shown.looking_at(self.anchor.unwrap_or_default() + self.shown.offset)
    }
}

/// Distance to what was double-clicked, in metres.
const FOCUS_M: f32 = 12.0;

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
/// How eagerly the camera follows, in 1/s: in a short time t it covers the share `this * t` of the way.
const FOLLOW_PER_S: f32 = 4.0;
/// Nearer than this the camera is where it wants to be, in metres.
const FOLLOWED_M: f32 = 0.005;
/// So much of the lanes before and behind the snakes is in view, in metres.
const AHEAD_M: f32 = 9.0;
const BEHIND_M: f32 = 6.0;
/// At most this share of the picture makes room for a card.
const MOST_ASIDE: f32 = 0.25;
/// How eagerly the camera goes to where it was asked to, in 1/s.
const GLIDE_PER_S: f32 = 14.0;
/// A pinch of a trackpad's whole scale zooms by this factor.
const ZOOM_PER_PINCH: f32 = 1.0;

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<CameraRig>()
        .init_resource::<StageArea>()
        .add_systems(Startup, set_up)
        .add_systems(Update, (steer, follow, glide, fit_to_area).chain().in_set(Frame::Draw));
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

/// Turns drags, the wheel and a trackpad's gestures into a new view, unless they belong to a panel or to a limb.
fn steer(
    mut rig: ResMut<CameraRig>,
    (buttons, keys): (Res<ButtonInput<MouseButton>>, Res<ButtonInput<KeyCode>>),
    window: Single<&Window, With<PrimaryWindow>>,
    area: Res<StageArea>,
    hands: Res<Hands>,
    mut grip: Local<Grip>,
    scroll: Res<AccumulatedMouseScroll>,
    mut pinches: MessageReader<PinchGesture>,
) {
    // The cursor, not the device: a tablet or a remote desktop reports no relative motion.
    let cursor = window.cursor_position();
    let drag = match (grip.last_cursor, cursor) {
        (Some(last), Some(now)) => now - last,
        _ => Vec2::ZERO,
    };
    grip.last_cursor = cursor;
    let is_over_stage = cursor.is_some_and(|cursor| area.has_pointer_at(cursor));
    let drag_buttons = [MouseButton::Left, MouseButton::Right, MouseButton::Middle];
    if buttons.any_just_pressed(drag_buttons) {
        grip.began_on_stage = is_over_stage && !hands.are_full();
    }
    let pinched: f32 = pinches.read().map(|pinch| pinch.0).sum();
    let view = &mut rig.view;
    if is_over_stage {
        // Two fingers sideways turn; a wheel, or two fingers up and down, zooms; so does a pinch.
        let (lines, sideways) = match scroll.unit {
            MouseScrollUnit::Line => (scroll.delta.y, 0.0),
            MouseScrollUnit::Pixel => (scroll.delta.y / PIXELS_PER_LINE, scroll.delta.x),
        };
        view.yaw_rad -= sideways * TURN_RAD_PER_PIXEL;
        let factor = 1.0 - lines.clamp(-4.0, 4.0) * ZOOM_PER_LINE;
        let factor = factor * (1.0 - pinched.clamp(-0.5, 0.5) * ZOOM_PER_PINCH);
        let distance_m = view.distance_m * factor;
        view.distance_m = distance_m.clamp(*View::DISTANCE_M.start(), *View::DISTANCE_M.end());
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
        view.pitch_rad = pitch_rad.clamp(*View::PITCH_RAD.start(), *View::PITCH_RAD.end());
    }
}

/// Keeps the middle of the snake in view, or of all snakes.
fn follow(mut rig: ResMut<CameraRig>, lanes: Query<Ref<Lane>>, time: Res<Time<Real>>) {
    let count = lanes.iter().len();
    if count == 0 {
        return;
    }
    let is_new = lanes.iter().any(|lane| lane.is_added());
    if is_new && (count > 1) != (rig.lanes > 1) {
        // What suits one lane does not suit many.
        rig.lanes = count;
        let shot = rig.shot;
        rig.take(if shot == Shot::Free { Shot::Follow } else { shot });
    }
    rig.lanes = count;
    rig.lane = rig.lane.filter(|lane| *lane < count && !is_new);
    let of_one = |lane: &Lane| {
        // Sideways wobble is the snake's own; following it would make the viewer seasick.
        let middle = lane.drawn_middle();
        Vec3::new(lane.offset().x, middle.y, middle.z.max(0.0))
    };
    let chosen = lanes.iter().filter(|lane| rig.lane.is_none_or(|number| number == lane.number()));
    let (mut least, mut most) = (Vec3::MAX, Vec3::MIN);
    chosen.map(|lane| of_one(&lane)).for_each(|middle| {
        least = least.min(middle);
        most = most.max(middle);
    });
    let goal = (least + most) / 2.0;
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

/// Glides to the view that was asked for; with all lanes in view, as far away as that takes.
fn glide(
    mut rig: ResMut<CameraRig>,
    lanes: Query<&Lane>,
    area: Res<StageArea>,
    time: Res<Time<Real>>,
    mut camera: Single<&mut Transform, With<StageCamera>>,
) {
    let mut goal = rig.view;
    if rig.frames_all() {
        let points = lanes.iter().flat_map(|lane| {
            let half_width = Vec3::X * (lane.trial().stairs.width_m / 2.0);
            let middle = lane.drawn_middle() + lane.offset();
            let around = [Vec3::Y * AHEAD_M, Vec3::NEG_Y * BEHIND_M].map(|along| middle + along);
            let ends = lane.last_poses().iter().map(move |pose| pose.translation + lane.offset());
            ends.chain([middle - half_width, middle + half_width]).chain(around)
        });
        // The card there is low, and nothing of the lanes is in the corner but a tail: half its width is enough.
        let left_share = (area.card_share() / 2.0).min(MOST_ASIDE);
        goal = goal.framing(rig.anchor.unwrap_or_default(), points, area.aspect(), left_share);
    }
    let share = 1.0 - (1.0 + GLIDE_PER_S * time.delta_secs()).recip();
    rig.shown = if rig.shown.is_near(&goal) { goal } else { rig.shown.towards(&goal, share) };
    let place = rig.place();
    if **camera != place {
        **camera = place;
    }
}

/// Draws the stage beside the panels, not under them.
fn fit_to_area(
    area: Res<StageArea>,
    window: Single<&Window, With<PrimaryWindow>>,
    mut camera: Single<&mut Camera, With<StageCamera>>,
) {
    let scale = window.scale_factor();
    let place = area.in_window();
    let pixels = |at: Vec2| (at * scale).max(Vec2::ZERO).as_uvec2().min(window.physical_size());
    let (start, end) = (pixels(place.min), pixels(place.max));
    let size = end.saturating_sub(start);
    if size.x == 0 || size.y == 0 {
        return;
    }
    let viewport = Viewport { physical_position: start, physical_size: size, ..default() };
    let is_new = camera.viewport.as_ref().is_none_or(|now| {
        (now.physical_position, now.physical_size)
            != (viewport.physical_position, viewport.physical_size)
    });
    if is_new {
        camera.viewport = Some(viewport);
    }
}
