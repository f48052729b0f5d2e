//! The camera: orbit, pan, zoom, follow.
//!
//! The scene uses the axes of the core, in which z points up.

pub mod mouse;
pub mod rig;
pub mod view;

use bevy::camera::visibility::RenderLayers;
use bevy::camera::{CameraOutputMode, SubCameraView, Viewport};
use bevy::core_pipeline::tonemapping::Tonemapping;
use bevy::input::gestures::PinchGesture;
use bevy::input::mouse::{AccumulatedMouseScroll, MouseScrollUnit};
use bevy::pbr::{DistanceFog, FogFalloff};
use bevy::prelude::*;
use bevy::render::render_resource::BlendState;
use bevy::window::PrimaryWindow;
use bevy_egui::{EguiGlobalSettings, PrimaryEguiContext};

use super::quality::StageQuality;
use crate::studio::commands::camera_mode::CameraMode;
use crate::studio::commands::quality::Quality;
use crate::studio::schedule::FrameSet;
use crate::studio::stage::lane::Lane;
use crate::studio::stage::selection::Selection;
use crate::studio::ui::theme::{Palette, Theme};
use crate::studio::ui::viewport::StageArea;

use rig::CameraRig;
use view::{CameraView, VERTICAL_VIEW_RAD, middle_of};

/// Returns the transform of a fixed camera, from the default side, that shows the range of y from `from_y_m` to `to_y_m`, in metres.
pub(crate) fn overview_transform(from_y_m: f32, to_y_m: f32) -> Transform {
    // At this ratio the range of y, seen at an angle, fills the width of a 16:9 picture.
    const DISTANCE_PER_LENGTH: f32 = 0.95;
    let distance_m =
        ((to_y_m - from_y_m) * DISTANCE_PER_LENGTH).max(*CameraView::DISTANCE_M.start());
    let view = CameraView { distance_m, ..CameraView::of(CameraMode::Follow, 1) };
    view.looking_at(Vec3::new(0.0, (from_y_m + to_y_m) / 2.0, 1.5))
}

/// Returns the components that every camera of the scene shares: fog that hides the end of the ground.
pub(crate) fn camera_components(palette: &Palette) -> impl Bundle {
    (
        Camera3d::default(),
        Tonemapping::None,
        DistanceFog {
            color: palette.horizon,
            falloff: FogFalloff::Linear { start: 50.0, end: 190.0 },
            ..default()
        },
    )
}

/// Marks the camera that draws the stage.
#[derive(Component)]
pub(crate) struct StageCamera;

/// Rotation per pixel of dragging, in radians.
const TURN_RAD_PER_PIXEL: f32 = 0.006;
/// Movement of the target per pixel of dragging, as a fraction of the camera's distance from it.
const PAN_PER_PIXEL: f32 = 0.0012;
/// Change of the zoom per line of the mouse wheel, as a fraction.
const ZOOM_PER_LINE: f32 = 0.12;
/// Trackpad scroll that equals one line of the mouse wheel, in pixels.
const PIXELS_PER_LINE: f32 = 40.0;
/// Follow rate, in 1/s. In a short time t the camera covers the fraction `rate * t` of its distance from the goal.
const FOLLOW_PER_S: f32 = 4.0;
/// Distance from the goal below which the camera stops moving, in metres.
const FOLLOWED_M: f32 = 0.005;
/// Length of the lanes that stays visible ahead of and behind the snakes, in metres.
const AHEAD_M: f32 = 9.0;
const BEHIND_M: f32 = 6.0;
/// Rate at which the camera approaches its target view, in 1/s.
const GLIDE_PER_S: f32 = 14.0;
/// Zoom factor of a pinch over the whole trackpad.
const ZOOM_PER_PINCH: f32 = 1.0;

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<CameraRig>()
        .init_resource::<StageArea>()
        .add_systems(Startup, set_up)
        .add_systems(Update, (steer, follow, glide, fit_to_area).chain().in_set(FrameSet::Draw));
}

/// Spawns a camera for the stage, and one for egui over the whole window.
fn set_up(
    mut commands: Commands,
    mut egui_settings: ResMut<EguiGlobalSettings>,
    theme: Res<Theme>,
) {
    egui_settings.auto_create_primary_context = false;
    commands.spawn((StageCamera, camera_components(theme.palette())));
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

/// State of a mouse drag.
#[derive(Debug, Default)]
pub(crate) struct CameraDrag {
    last_cursor: Option<Vec2>,
    /// Whether the mouse button was pressed over the stage. Otherwise the drag belongs to a panel.
    began_on_stage: bool,
}

/// Applies drags, the mouse wheel and trackpad gestures to the view, unless a panel or a held limb uses them.
fn steer(
    mut rig: ResMut<CameraRig>,
    (buttons, keys): (Res<ButtonInput<MouseButton>>, Res<ButtonInput<KeyCode>>),
    window: Single<&Window, With<PrimaryWindow>>,
    area: Res<StageArea>,
    selection: Res<Selection>,
    mut grip: Local<CameraDrag>,
    scroll: Res<AccumulatedMouseScroll>,
    mut pinches: MessageReader<PinchGesture>,
) {
    // The cursor position is used, because tablets and remote desktops report no relative motion.
    let cursor = window.cursor_position();
    let drag = match (grip.last_cursor, cursor) {
        (Some(last), Some(now)) => now - last,
        _ => Vec2::ZERO,
    };
    grip.last_cursor = cursor;
    let is_over_stage = cursor.is_some_and(|cursor| area.has_pointer_at(cursor));
    let drag_buttons = [MouseButton::Left, MouseButton::Right, MouseButton::Middle];
    if buttons.any_just_pressed(drag_buttons) {
        grip.began_on_stage = is_over_stage && selection.held.is_none();
    }
    let pinched: f32 = pinches.read().map(|pinch| pinch.0).sum();
    let view = &mut rig.view;
    if is_over_stage {
        // Horizontal trackpad scrolling rotates; the wheel, vertical scrolling and pinching zoom.
        let (lines, sideways) = match scroll.unit {
            MouseScrollUnit::Line => (scroll.delta.y, 0.0),
            MouseScrollUnit::Pixel => (scroll.delta.y / PIXELS_PER_LINE, scroll.delta.x),
        };
        view.yaw_rad -= sideways * TURN_RAD_PER_PIXEL;
        let factor = 1.0 - lines.clamp(-4.0, 4.0) * ZOOM_PER_LINE;
        let factor = factor * (1.0 - pinched.clamp(-0.5, 0.5) * ZOOM_PER_PINCH);
        let distance_m = view.distance_m * factor;
        view.distance_m =
            distance_m.clamp(*CameraView::DISTANCE_M.start(), *CameraView::DISTANCE_M.end());
        rig.turned_by_hand();
    }
    if !grip.began_on_stage {
        return;
    }
    let view = &mut rig.view;
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
        view.pitch_rad =
            pitch_rad.clamp(*CameraView::PITCH_RAD.start(), *CameraView::PITCH_RAD.end());
        rig.turned_by_hand();
    }
}

/// Moves the camera's anchor towards the middle of the followed snake or of all snakes.
fn follow(mut rig: ResMut<CameraRig>, lanes: Query<Ref<Lane>>, time: Res<Time<Real>>) {
    // Ghosts are ignored, because they surround the lane that the camera follows.
    let lanes = || lanes.iter().filter(|lane| !lane.is_ghost);
    let count = lanes().count();
    if count == 0 {
        return;
    }
    let is_new = lanes().any(|lane| lane.is_added() && !lane.is_back);
    if is_new && (count > 1) != (rig.lanes > 1) {
        // The view for one lane does not suit several, and the reverse.
        rig.lanes = count;
        let camera_mode = rig.camera_mode;
        rig.take(if camera_mode == CameraMode::Free { CameraMode::Follow } else { camera_mode });
    }
    rig.lanes = count;
    rig.lane = rig.lane.filter(|of| !is_new && lanes().any(|lane| lane.number == *of));
    let of_one = |lane: &Lane| {
        // The sideways motion of the snake is ignored, because following it would make viewers seasick.
        let middle = lane.drawn_middle();
        Vec3::new(lane.offset().x, middle.y, middle.z.max(0.0))
    };
    let chosen = lanes().filter(|lane| rig.lane.is_none_or(|number| number == lane.number));
    let goal = middle_of(chosen.map(|lane| of_one(&lane)));
    match rig.anchor {
        None => rig.anchor = Some(goal),
        Some(anchor) if rig.follows() => {
            let share = 1.0 - (1.0 + FOLLOW_PER_S * time.delta_secs()).recip();
            // The camera stops at a small distance. Otherwise a paused picture would keep changing by single pixels.
            let is_there = anchor.distance(goal) < FOLLOWED_M;
            rig.anchor = Some(if is_there { goal } else { anchor.lerp(goal, share) });
        }
        Some(_) => {}
    }
}

/// Points that must be in view. The buffers are reused, so that no frame allocates.
#[derive(Debug, Default)]
struct InView {
    points: Vec<Vec3>,
    snakes: Vec<Vec3>,
    /// Rectangles of the cards over the stage: see [`StageArea::covers`].
    covers: Vec<Rect>,
}

/// Moves the camera towards the target view. If it follows all lanes, it goes far enough away to show them all. It also
/// keeps the followed snakes clear of the cards over the stage.
fn glide(
    mut rig: ResMut<CameraRig>,
    lanes: Query<&Lane>,
    (area, selection): (Res<StageArea>, Res<Selection>),
    time: Res<Time<Real>>,
    mut camera: Single<&mut Transform, With<StageCamera>>,
    mut in_view: Local<InView>,
) {
    let mut goal = rig.view;
    let InView { points, snakes, covers } = &mut *in_view;
    points.clear();
    snakes.clear();
    // If the camera moved aside while the mouse holds a limb, it would pull the limb along.
    if selection.held.is_none() {
        covers.clear();
        covers.extend(area.covers());
    }
    if rig.follows() {
        let followed = lanes.iter().filter(|lane| !lane.is_ghost);
        for lane in followed.filter(|lane| rig.lane.is_none_or(|of| of == lane.number)) {
            let half_width = Vec3::X * (lane.trial().stairs.width_m / 2.0);
            let middle = lane.drawn_middle() + lane.offset();
            let ends = [half_width, -half_width, Vec3::Y * AHEAD_M, Vec3::NEG_Y * BEHIND_M];
            points.extend(ends.map(|end| middle + end));
            snakes.extend(lane.replay.poses().iter().map(|pose| pose.translation + lane.offset()));
        }
        points.extend(snakes.iter());
        let anchor = rig.anchor.unwrap_or_default();
        goal = if rig.follows() && rig.lane.is_none() && rig.lanes > 1 {
            goal.framing(anchor, points, snakes, area.aspect(), covers)
        } else {
            goal.beside(anchor, snakes, area.aspect(), covers)
        };
    }
    let share = 1.0 - (1.0 + GLIDE_PER_S * time.delta_secs()).recip();
    rig.shown = if rig.shown.is_near(&goal) { goal } else { rig.shown.towards(&goal, share) };
    let place = rig.place();
    if **camera != place {
        **camera = place;
    }
}

/// Fits the picture of the stage's camera to the area beside the panels: by a viewport or, if the effects of the picture's quality need
/// the whole window, by a larger angle of view, whose middle is that of the area.
fn fit_to_area(
    area: Res<StageArea>,
    quality: Res<StageQuality>,
    window: Single<&Window, With<PrimaryWindow>>,
    camera: Single<(&mut Camera, &mut Projection), With<StageCamera>>,
) {
    let (mut camera, mut projection) = camera.into_inner();
    let scale = window.scale_factor();
    let place = area.in_window();
    let whole = window.physical_size();
    let pixels = |at: Vec2| (at * scale).max(Vec2::ZERO).as_uvec2().min(whole);
    let (start, end) = (pixels(place.min), pixels(place.max));
    let size = end.saturating_sub(start);
    if size.x == 0 || size.y == 0 {
        return;
    }
    let fitted = if quality.now() == Quality::Beautiful {
        Fitted::around(start, size, whole)
    } else {
        let viewport = Viewport { physical_position: start, physical_size: size, ..default() };
        Fitted { viewport: Some(viewport), part: None, angle_rad: VERTICAL_VIEW_RAD }
    };
    fitted.apply(&mut camera, &mut projection);
}

/// Settings of a camera by which its picture fits the stage.
struct Fitted {
    viewport: Option<Viewport>,
    part: Option<SubCameraView>,
    angle_rad: f32,
}

impl Fitted {
    /// Returns the settings of a camera that draws the whole window, so that the part of this position and size, in pixels, has the
    /// stage's angle of view.
    fn around(start: UVec2, size: UVec2, window: UVec2) -> Self {
        let (whole, size) = (window.as_vec2(), size.as_vec2());
        let aspect = whole.x / whole.y;
        // The smallest rectangle around the stage with the window's aspect ratio, which the renderer uses to find what is visible.
        let width = size.x.max(size.y * aspect).round();
        let full = Vec2::new(width, (width / aspect).round());
        let half = libm::tanf(VERTICAL_VIEW_RAD / 2.0) * full.y / size.y;
        let middle = start.as_vec2() + size / 2.0;
        let part =
            SubCameraView { full_size: full.as_uvec2(), offset: full / 2.0 - middle, size: window };
        Self { viewport: None, part: Some(part), angle_rad: 2.0 * libm::atanf(half) }
    }

    /// Changes a camera, unless it has these settings.
    fn apply(self, camera: &mut Mut<Camera>, projection: &mut Mut<Projection>) {
        let place =
            |of: &Option<Viewport>| of.as_ref().map(|of| (of.physical_position, of.physical_size));
        if place(&camera.viewport) != place(&self.viewport) || camera.sub_camera_view != self.part {
            (camera.viewport, camera.sub_camera_view) = (self.viewport, self.part);
        }
        if let Projection::Perspective(of) = &**projection
            && of.fov != self.angle_rad
        {
            let fitted = PerspectiveProjection { fov: self.angle_rad, ..of.clone() };
            **projection = Projection::Perspective(fitted);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy::camera::CameraProjection;

    #[test]
    fn a_camera_that_draws_the_whole_window_shows_the_stage_as_one_with_a_viewport() {
        let (start, size, window) =
            (UVec2::new(385, 29), UVec2::new(895, 584), UVec2::new(1280, 720));
        let fitted = Fitted::around(start, size, window);
        let own = PerspectiveProjection {
            fov: VERTICAL_VIEW_RAD,
            aspect_ratio: size.x as f32 / size.y as f32,
            ..default()
        };
        let whole = PerspectiveProjection { fov: fitted.angle_rad, ..own.clone() };
        let part = fitted.part.expect("a part");
        let pixel = |clip: Mat4, at: Vec3, size: UVec2| {
            let ndc = clip.project_point3(at).truncate();
            (ndc * Vec2::new(0.5, -0.5) + 0.5) * size.as_vec2()
        };
        for at in
            [Vec3::new(0.0, 0.0, -9.0), Vec3::new(2.0, -1.0, -7.0), Vec3::new(-3.0, 2.0, -20.0)]
        {
            let in_stage = pixel(own.get_clip_from_view(), at, size) + start.as_vec2();
            let in_window = pixel(whole.get_clip_from_view_for_sub(&part), at, window);
            assert!(in_stage.distance(in_window) < 1.5, "{at}: {in_stage} and {in_window}");
        }
    }
}
