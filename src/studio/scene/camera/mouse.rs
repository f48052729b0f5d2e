//! Mouse control of the snake. A click on a limb shows its numbers, a drag pulls it by a spring, and a double click
//! turns the camera to it.
//!
//! A ray through the pointer is cast into the worlds of the lanes as they are drawn. It therefore hits the visible
//! surface in simulations and in recordings.

use bevy::input::mouse::MouseButtonInput;
use bevy::prelude::*;
use bevy::window::PrimaryWindow;

use super::StageCamera;
use super::rig::CameraRig;
use crate::studio::schedule::FrameSet;
use crate::studio::stage::StageMode;
use crate::studio::stage::lane::Lane;
use crate::studio::stage::selection::{HeldLimb, Selection};
use crate::studio::stage::staged_world::{RayHit, StagedWorld};
use crate::studio::ui::notifications::Notices;
use crate::studio::ui::viewport::StageArea;
use snakes_core::world::{Pull, Vector};

/// Earlier presses of the mouse button, with which later presses and releases are compared.
#[derive(Resource, Debug, Default)]
struct MousePresses {
    /// Where the button was pressed beside all limbs, in pixels. A release at the same place is a click, which clears the selection.
    beside: Option<Vec2>,
    /// Time and position of the last press, in seconds and pixels; `None` before the first one.
    last: Option<(f32, Vec2)>,
}

/// Maximum movement of the pointer between press and release of a click, in pixels.
const CLICK_PIXELS: f32 = 5.0;
/// Maximum time between the two presses of a double click, in seconds, on the stage and in panels.
pub(crate) const DOUBLE_CLICK_S: f32 = 0.5;

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<Selection>()
        .init_resource::<MousePresses>()
        .add_systems(Update, (press, drag, release).chain().in_set(FrameSet::Apply))
        .add_systems(Update, clear_selection.in_set(FrameSet::Draw));
}

/// Selects and holds the limb that is pressed. A double click turns the camera to the surface under the pointer.
fn press(
    mut selection: ResMut<Selection>,
    mut earlier: ResMut<MousePresses>,
    mut rig: ResMut<CameraRig>,
    mut presses: MessageReader<MouseButtonInput>,
    window: Single<&Window, With<PrimaryWindow>>,
    camera: Single<(&Camera, &GlobalTransform), With<StageCamera>>,
    area: Res<StageArea>,
    mut worlds: Query<StagedWorld>,
    time: Res<Time<Real>>,
) {
    let is_press =
        |press: &&MouseButtonInput| press.button == MouseButton::Left && press.state.is_pressed();
    let presses = presses.read().filter(is_press).count();
    if presses == 0 {
        return;
    }
    let cursor = window.cursor_position().filter(|cursor| area.has_pointer_at(*cursor));
    let Some(cursor) = cursor else { return };
    let Ok(ray) = camera.0.viewport_to_world(camera.1, cursor) else { return };
    let hits = worlds.iter_mut().filter_map(|mut world| world.cast_ray(ray));
    // Among ghosts at the same place, the last one is hit.
    let hit = hits.max_by(|a, b| b.distance_m.total_cmp(&a.distance_m));
    let now_s = time.elapsed_secs();
    // A slow frame can deliver a press late, or two presses at once.
    let follows_another = earlier.last.is_some_and(|(then_s, at)| {
        now_s - then_s < DOUBLE_CLICK_S + time.delta_secs() && at.distance(cursor) < CLICK_PIXELS
    });
    let is_double = presses > 1 || follows_another;
    earlier.last = (!is_double).then_some((now_s, cursor));
    if is_double && let Some(hit) = &hit {
        let lane = hit.part.map(|_| hit.lane.number);
        rig.focus_on(lane, ray.get_point(hit.distance_m));
    }
    let Some(RayHit { entity, lane, part: Some(part), distance_m }) = hit else {
        earlier.beside = Some(cursor);
        return;
    };
    let Some(pose) = lane.drawn_poses().nth(part) else { return };
    let point = ray.get_point(distance_m) - lane.offset();
    let pull = Pull { part, held_at_m: pose.inverse() * point, to_m: point };
    let held = HeldLimb { lane: entity, pull, pressed_at: cursor, is_pulling: false };
    let limb = lane.body.parts.get(part).map_or(0, |part| part.limb);
    selection.grab(lane.number, limb, held);
}

/// Moves the held limb with the pointer, in a plane that faces the camera.
fn drag(
    mut selection: ResMut<Selection>,
    window: Single<&Window, With<PrimaryWindow>>,
    camera: Single<(&Camera, &GlobalTransform), With<StageCamera>>,
    lanes: Query<&Lane>,
    mut notices: ResMut<Notices>,
) {
    let Some(held) = selection.held.as_mut() else { return };
    let Some(cursor) = window.cursor_position() else { return };
    if !held.is_pulling && held.pressed_at.distance(cursor) < CLICK_PIXELS {
        return;
    }
    let Ok(lane) = lanes.get(held.lane) else { return };
    if !held.is_pulling && lane.staged.recording().is_some() {
        notices
            .info("A recording cannot be pulled; \"Simulate again\" makes it a simulation.".into());
    }
    held.is_pulling = true;
    let Ok(ray) = camera.0.viewport_to_world(camera.1, cursor) else { return };
    let point: Vec3 = lane.point_of(held.pull.part, held.pull.held_at_m) + lane.offset();
    let facing = InfinitePlane3d::new(camera.1.back());
    if let Some(distance_m) = ray.intersect_plane(point, facing) {
        held.pull.to_m = Vector::from(ray.get_point(distance_m) - lane.offset());
    }
}

/// Releases the limb when the button is up or the limb's lane is gone. A click beside all limbs clears the selection. A
/// drag there turns the camera and keeps the selection.
fn release(
    mut selection: ResMut<Selection>,
    mut earlier: ResMut<MousePresses>,
    buttons: Res<ButtonInput<MouseButton>>,
    window: Single<&Window, With<PrimaryWindow>>,
    lanes: Query<&Lane>,
) {
    let is_up = !buttons.pressed(MouseButton::Left);
    if selection.held.is_some_and(|held| is_up || !lanes.contains(held.lane)) {
        selection.held = None;
    }
    if is_up && let Some(pressed_at) = earlier.beside.take() {
        let is_click =
            window.cursor_position().is_some_and(|now| now.distance(pressed_at) < CLICK_PIXELS);
        if is_click {
            selection.limb = None;
        }
    }
}

/// Updates the selection when new lanes are added. In general it is cleared; in a race, the leader's lane is selected;
/// in a what-if, the latest copy, with the same limb as before.
fn clear_selection(
    mut selection: ResMut<Selection>,
    mode: Res<StageMode>,
    added: Query<&Lane, Added<Lane>>,
) {
    // An earlier scene comes back with its selection.
    if added.iter().all(|lane| lane.is_back) {
        return;
    }
    if matches!(*mode, StageMode::WhatIf { .. }) {
        // A what-if is restarted at every change.
        selection.lane = added.iter().map(|lane| lane.number).max().unwrap_or_default();
        return;
    }
    (selection.lane, selection.limb) = (0, None);
    if *mode == StageMode::Race {
        let racers = added.iter().filter(|lane| !lane.is_ghost);
        let fitness = |lane: &Lane| lane.staged.champion().evaluation.fitness;
        selection.lane = leader(racers.map(|lane| (lane.number, fitness(lane))));
    }
}

/// Returns the lane with the greatest recorded fitness; among equal ones the last, which is the latest generation.
fn leader(lanes: impl Iterator<Item = (usize, f32)>) -> usize {
    lanes.max_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0))).map_or(0, |(lane, _)| lane)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_race_selects_its_best_snake_and_not_the_first_generation() {
        let of = |fitness: &[f32]| leader(fitness.iter().copied().enumerate());
        assert_eq!(of(&[1.0, 2.5, 26.0, 7.0]), 2);
        assert_eq!(of(&[1.0, 26.0, 26.0]), 2, "the latest of equal ones");
        assert_eq!(of(&[]), 0);
    }
}
