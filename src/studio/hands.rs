//! Hands on the snake: click a limb to see its numbers, drag it to pull it by a spring, double click to look at it.
//!
//! A ray through the pointer is cast at what is drawn: the limbs' boxes, the steps, the ground. So it hits what a person
//! sees, in a simulation and in a recording, at the start as at the end.

use bevy::input::mouse::MouseButtonInput;
use bevy::prelude::*;
use bevy::window::PrimaryWindow;
use rapier3d::parry::query::{Ray, RayCast};
use rapier3d::parry::shape::{Cuboid, HalfSpace};

use super::Frame;
use super::camera::{CameraRig, StageCamera};
use super::lane::Lane;
use super::notice::Notices;
use super::playback::Playback;
use super::stage_area::StageArea;
use crate::world::{Pose, Pull, StairBox, Vector};

/// What is selected, and what is held.
#[derive(Resource, Debug, Default)]
pub(super) struct Hands {
    /// The lane whose numbers and signals are shown; the first is 0.
    pub lane: usize,
    /// The selected limb of that lane; the head is 0.
    pub limb: Option<usize>,
    held: Option<Held>,
    /// Where the button went down beside all limbs, in pixels: a click there lets the selected one go.
    pressed_beside: Option<Vec2>,
    /// When and where the button went down last, in seconds and pixels.
    last_press: Option<(f32, Vec2)>,
}

/// A limb in the hand.
#[derive(Debug, Clone, Copy)]
struct Held {
    lane: Entity,
    /// Where the pull begins and ends, in the lane's own coordinates.
    pull: Pull,
    /// Where the button went down, in pixels.
    pressed_at: Vec2,
    /// Whether the pointer has moved far enough for a pull; before, it is a click.
    is_pulling: bool,
}

/// What a ray hits first.
struct Hit {
    entity: Entity,
    lane: usize,
    /// The limb, if it is one; else it is the stairs or the ground.
    limb: Option<usize>,
    /// Along the ray, in metres.
    distance_m: f32,
}

/// A pointer that moves less than this has clicked, in pixels.
const CLICK_PIXELS: f32 = 5.0;
/// Two presses within this time, in seconds, at one place are a double click, on the stage and in panels.
pub(super) const DOUBLE_CLICK_S: f32 = 0.4;

impl Hands {
    /// What pulls at a lane, in its own coordinates.
    pub fn pull_on(&self, lane: Entity) -> Option<Pull> {
        self.held.filter(|held| held.is_pulling && held.lane == lane).map(|held| held.pull)
    }

    /// Takes a limb into the hand and pulls.
    #[cfg(test)]
    pub fn hold(&mut self, lane: Entity, pull: Pull) {
        self.held = Some(Held { lane, pull, pressed_at: Vec2::ZERO, is_pulling: true });
    }

    /// Holds nothing any more.
    #[cfg(test)]
    pub fn open(&mut self) {
        self.held = None;
    }

    /// Whether a limb is in the hand: a drag then is no turn of the camera.
    pub fn are_full(&self) -> bool {
        self.held.is_some()
    }
}

pub(super) fn plugin(app: &mut App) {
    app.init_resource::<Hands>()
        .add_systems(Update, (grasp, drag, let_go).chain().in_set(Frame::Apply))
        .add_systems(Update, forget.in_set(Frame::Draw));
}

/// The ray through the pointer.
fn ray_at(cursor: Vec2, (camera, place): (&Camera, &GlobalTransform)) -> Option<Ray3d> {
    camera.viewport_to_world(place, cursor).ok()
}

/// What a ray hits first in any lane.
fn first_hit(ray: Ray3d, lanes: &Query<(Entity, &Lane)>) -> Option<Hit> {
    let mut first: Option<Hit> = None;
    for (entity, lane) in lanes {
        let ray = Ray::new(ray.origin - lane.offset(), *ray.direction);
        let nearest_m = |first: &Option<Hit>| first.as_ref().map_or(f32::MAX, |hit| hit.distance_m);
        let mut hit = |limb: Option<usize>, shape: &dyn RayCast, pose: &Pose| {
            if let Some(distance_m) = shape.cast_ray(pose, &ray, nearest_m(&first), true) {
                first = Some(Hit { entity, lane: lane.number(), limb, distance_m });
            }
        };
        for (limb, pose) in lane.drawn_poses().enumerate() {
            let size = Vector::from(lane.trial().agent.limb_size_m(limb));
            hit(Some(limb), &Cuboid::new(size / 2.0), &pose);
        }
        for StairBox { min_m, max_m } in lane.trial().stairs.boxes() {
            let (min, max) = (Vector::from(min_m), Vector::from(max_m));
            let pose = Pose::from_translation((min + max) / 2.0);
            hit(None, &Cuboid::new((max - min) / 2.0), &pose);
        }
        hit(None, &HalfSpace::new(Vector::Z), &Pose::IDENTITY);
    }
    first
}

/// A press on a limb selects it and takes it into the hand; a double click looks at what is under the pointer.
fn grasp(
    mut hands: ResMut<Hands>,
    mut rig: ResMut<CameraRig>,
    mut presses: MessageReader<MouseButtonInput>,
    window: Single<&Window, With<PrimaryWindow>>,
    camera: Single<(&Camera, &GlobalTransform), With<StageCamera>>,
    area: Res<StageArea>,
    lanes: Query<(Entity, &Lane)>,
    time: Res<Time<Real>>,
) {
    let is_press =
        |press: &&MouseButtonInput| press.button == MouseButton::Left && press.state.is_pressed();
    let presses = presses.read().filter(is_press).count();
    if presses == 0 {
        return;
    }
    let Some(cursor) = window.cursor_position().filter(|cursor| area.has_pointer_at(*cursor))
    else {
        return;
    };
    let Some(ray) = ray_at(cursor, *camera) else { return };
    let hit = first_hit(ray, &lanes);
    let now_s = time.elapsed_secs();
    // Where frames are slow, presses are seen late, or two at once.
    let follows_another = hands.last_press.is_some_and(|(then_s, at)| {
        now_s - then_s < DOUBLE_CLICK_S + time.delta_secs() && at.distance(cursor) < CLICK_PIXELS
    });
    let is_double = presses > 1 || follows_another;
    hands.last_press = (!is_double).then_some((now_s, cursor));
    if is_double && let Some(hit) = &hit {
        let lane = hit.limb.map(|_| hit.lane);
        rig.focus_on(lane, ray.get_point(hit.distance_m));
    }
    let Some(Hit { entity, lane, limb: Some(limb), distance_m }) = hit else {
        hands.pressed_beside = Some(cursor);
        return;
    };
    (hands.lane, hands.limb) = (lane, Some(limb));
    let Ok((_, lane)) = lanes.get(entity) else { return };
    let Some(pose) = lane.drawn_poses().nth(limb) else { return };
    let point = ray.get_point(distance_m) - lane.offset();
    let pull = Pull { limb, held_at_m: pose.inverse() * point, to_m: point };
    hands.held = Some(Held { lane: entity, pull, pressed_at: cursor, is_pulling: false });
}

/// The pointer moves what is held in the plane that faces the camera.
fn drag(
    mut hands: ResMut<Hands>,
    window: Single<&Window, With<PrimaryWindow>>,
    camera: Single<(&Camera, &GlobalTransform), With<StageCamera>>,
    lanes: Query<&Lane>,
    playback: Res<Playback>,
    mut notices: ResMut<Notices>,
) {
    let Some(held) = &mut hands.held else { return };
    let Some(cursor) = window.cursor_position() else { return };
    if !held.is_pulling && held.pressed_at.distance(cursor) < CLICK_PIXELS {
        return;
    }
    let Ok(lane) = lanes.get(held.lane) else { return };
    if !held.is_pulling && !playback.is_playing() {
        notices.news("The stage is held: play it (Space), then pull.".to_owned());
    }
    if !held.is_pulling && lane.exhibit().recording().is_some() {
        notices
            .news("A recording cannot be pulled; \"Simulate here\" makes it a simulation.".into());
    }
    held.is_pulling = true;
    let Some(ray) = ray_at(cursor, *camera) else { return };
    let point: Vec3 = lane.point_of(held.pull.limb, held.pull.held_at_m) + lane.offset();
    let facing = InfinitePlane3d::new(camera.1.back());
    if let Some(distance_m) = ray.intersect_plane(point, facing) {
        held.pull.to_m = Vector::from(ray.get_point(distance_m) - lane.offset());
    }
}

/// A button that is up holds nothing; nor does a hand hold what is gone. A click beside all limbs selects none; a drag
/// there turns the camera, and leaves the selection.
fn let_go(
    mut hands: ResMut<Hands>,
    buttons: Res<ButtonInput<MouseButton>>,
    window: Single<&Window, With<PrimaryWindow>>,
    lanes: Query<&Lane>,
) {
    let is_up = !buttons.pressed(MouseButton::Left);
    if hands.held.is_some_and(|held| is_up || !lanes.contains(held.lane)) {
        hands.held = None;
    }
    if is_up && let Some(pressed_at) = hands.pressed_beside.take() {
        let is_click =
            window.cursor_position().is_some_and(|now| now.distance(pressed_at) < CLICK_PIXELS);
        if is_click {
            hands.limb = None;
        }
    }
}

/// When other lanes take the stage, nothing of the earlier ones stays selected.
fn forget(mut hands: ResMut<Hands>, added: Query<(), Added<Lane>>) {
    if !added.is_empty() {
        (hands.lane, hands.limb) = (0, None);
    }
}
