//! Overlays of the scene: forces, torques, trail, fitness line.

use std::collections::BTreeSet;

use bevy::prelude::*;

use super::props::in_scene;
use crate::studio::commands::overlay::Overlay;
use crate::studio::schedule::FrameSet;
use crate::studio::stage::lane::Lane;
use crate::studio::stage::selection::Selection;
use crate::studio::ui::theme::{Palette, Theme};

/// Overlays that are visible.
#[derive(Resource, Debug, Default, Deref, DerefMut)]
pub(crate) struct Overlays(BTreeSet<Overlay>);

/// Gizmo group of lines that are drawn in front of everything.
#[derive(Default, Reflect, GizmoConfigGroup)]
struct OnTop;

impl Overlays {
    /// Shows or hides an overlay.
    pub fn toggle(&mut self, overlay: Overlay) {
        if !self.0.remove(&overlay) {
            self.0.insert(overlay);
        }
    }
}

/// Width of the overlays' lines, in pixels.
const LINE_PIXELS: f32 = 3.0;
/// Length of the arrow for a force that equals the snake's weight, in metres.
pub(crate) const WEIGHT_M: f32 = 3.0;
/// Maximum length of a force's arrow, in metres. The force of an impact can be a hundred times the weight.
const LONGEST_ARROW_M: f32 = 6.0;
/// Radius of the arrow around a joint's axis, as a fraction of the longer side of the limb's cross-section.
const TORQUE_RADIUS: f32 = 0.8;
/// Angle that the arrow of the maximum torque covers, in radians.
const FULL_TORQUE_RAD: f32 = 4.7;
/// Smallest torque that is drawn, as a fraction of the maximum torque.
const MIN_TORQUE_SHARE: f32 = 0.02;
/// Height of the fitness line above a tread, in metres.
const ABOVE_M: f32 = 0.04;

pub(crate) fn plugin(app: &mut App) {
    let line = GizmoLineConfig { width: LINE_PIXELS, ..default() };
    let usual = GizmoConfig { line, ..default() };
    app.init_resource::<Overlays>()
        .insert_gizmo_config(OnTop, GizmoConfig { depth_bias: -1.0, ..usual.clone() })
        .insert_gizmo_config(DefaultGizmoConfigGroup, usual)
        .add_systems(Update, draw.in_set(FrameSet::Draw));
}

fn draw(
    overlays: Res<Overlays>,
    selection: Option<Res<Selection>>,
    lanes: Query<(Entity, &Lane)>,
    theme: Res<Theme>,
    mut on_top: Gizmos<OnTop>,
    mut hidden: Gizmos,
) {
    let palette = theme.palette();
    for (entity, lane) in &lanes {
        let draws = |overlay| overlays.contains(&overlay) && !lane.is_ghost;
        if draws(Overlay::Contacts) {
            contacts(lane, palette, &mut on_top);
        }
        if draws(Overlay::Torques) {
            torques(lane, palette, &mut on_top);
        }
        if draws(Overlay::Trail) {
            let color = if lane.replay.is_disturbed() { palette.pull } else { palette.trail };
            let way = lane.trail_m().into_iter().map(|at| at + lane.offset());
            hidden.linestrip(way, color);
        }
        if draws(Overlay::FitnessLine) {
            fitness_line(lane, palette, &mut on_top);
        }
        if let Some(selection) = &selection
            && selection.lane == lane.number
            && let Some(limb) = selection.limb
        {
            outline(lane, limb, palette, &mut on_top);
        }
        let pull = selection.as_ref().and_then(|selection| selection.pull_on(entity));
        if let Some(pull) = pull {
            let from = lane.point_of(pull.part, pull.held_at_m) + lane.offset();
            let to = pull.to_m + lane.offset();
            on_top.line(from, to, palette.pull);
            on_top.sphere(Isometry3d::from_translation(to), 0.12, palette.pull).resolution(12);
        }
    }
}

/// Draws the outlines of the selected limb's parts.
fn outline(lane: &Lane, limb: usize, palette: &Palette, gizmos: &mut Gizmos<OnTop>) {
    for (pose, part) in lane.drawn_poses().zip(&lane.body.parts) {
        if part.limb == limb {
            let size = Vec3::from(part.size_m()) * 1.02;
            let at = Transform::from_translation(pose.translation + lane.offset());
            let cube = at.with_rotation(pose.rotation).with_scale(size);
            gizmos.cube(cube, in_scene(palette.second));
        }
    }
}

/// Draws a cross at every contact, with an arrow for the force on the limb.
fn contacts(lane: &Lane, palette: &Palette, gizmos: &mut Gizmos<OnTop>) {
    let weight_n = lane.body.mass_kg() * lane.trial().physics.gravity_m_s2.max(0.1);
    for contact in &lane.readings.contacts {
        let at = contact.at_m + lane.offset();
        let arrow = (contact.force_n * (WEIGHT_M / weight_n)).clamp_length_max(LONGEST_ARROW_M);
        gizmos.cross(Isometry3d::from_translation(at), 0.1, palette.force);
        if arrow.length() > 0.05 {
            gizmos.arrow(at, at + arrow, palette.force).with_tip_length(0.18);
        }
    }
}

/// Draws an arrow around each axis of each joint. The angle of the arrow is proportional to the torque.
fn torques(lane: &Lane, palette: &Palette, gizmos: &mut Gizmos<OnTop>) {
    let body = &lane.body;
    let poses: Vec<_> = lane.drawn_poses().collect();
    for (joint, torque) in body.joints.iter().zip(&lane.readings.torques) {
        let Some(front) = poses.get(joint.parent) else { continue };
        let [width_m, length_m, height_m] = body.parts[joint.parent].size_m();
        let at = *front * joint.anchor_m(length_m) + lane.offset();
        let turn = joint.axes(front.rotation);
        let radius_m = width_m.max(height_m) * TORQUE_RADIUS;
        // The bend arrow turns about x and starts at the top. It is drawn at the limb's sides, where it is visible.
        let share = torque.bend_nm / joint.max_bend_torque_nm.max(1.0e-6);
        for side in [-1.0, 1.0] {
            let centre = at + turn * Vec3::X * (side * (width_m / 2.0 + 0.1));
            let (up, ahead) = (turn * Vec3::Z, turn * Vec3::NEG_Y);
            bent_arrow(gizmos, centre, [up, ahead], radius_m * 0.75, share, palette);
        }
        // The twist arrow turns about y and starts at the top.
        let share = torque.twist_nm / joint.max_twist_torque_nm.max(1.0e-6);
        let (up, aside) = (turn * Vec3::Z, turn * Vec3::X);
        bent_arrow(gizmos, at, [up, aside], radius_m * 1.1, share, palette);
    }
}

/// Maximum number of lines side by side in a torque's arrow, and their spacing in metres.
const MOST_LINES: f32 = 6.0;
const LINES_APART_M: f32 = 0.03;

/// Returns the number of lines side by side in a torque's arrow. `share` is the torque as a fraction of the maximum.
fn lines_of(share: f32) -> u32 {
    (share.abs().min(1.0) * MOST_LINES).ceil() as u32
}

/// Draws an arrow along a circle, from the direction `from` towards `towards`, or in reverse if `share` is negative.
/// The colour shows the direction of the torque; the length and width show its size.
fn bent_arrow(
    gizmos: &mut Gizmos<OnTop>,
    centre: Vec3,
    [from, towards]: [Vec3; 2],
    radius_m: f32,
    share: f32,
    palette: &Palette,
) {
    const PARTS: u32 = 20;
    if share.abs() < MIN_TORQUE_SHARE {
        return;
    }
    let color = in_scene(if share > 0.0 { palette.torque_plus } else { palette.torque_minus });
    let lines = lines_of(share);
    let point = |part: f32, radius_m: f32| {
        let angle_rad = share.clamp(-1.0, 1.0) * FULL_TORQUE_RAD * part / PARTS as f32;
        let (sin, cos) = libm::sincosf(angle_rad);
        centre + (from * cos + towards * sin) * radius_m
    };
    for line in 0..lines {
        let out_m = (line as f32 - (lines - 1) as f32 / 2.0) * LINES_APART_M;
        gizmos.linestrip((0..PARTS).map(|part| point(part as f32, radius_m + out_m)), color);
    }
    let (before, end) = (point(PARTS as f32 - 1.0, radius_m), point(PARTS as f32, radius_m));
    // The head is wider than the lines.
    let tip_m = 0.16 + lines as f32 * LINES_APART_M;
    gizmos.arrow(before, end, color).with_tip_length(tip_m);
}

/// Returns the left and the right end of the fitness line in the scene, in metres. Its label is drawn at the right end.
pub(crate) fn fitness_line_ends(lane: &Lane) -> [Vec3; 2] {
    let (y_m, stairs) = (lane.drawn_middle().y, &lane.trial().stairs);
    let middle = Vec3::new(0.0, y_m, stairs.surface_z_m(0.0, y_m) + ABOVE_M) + lane.offset();
    [-0.5, 0.5].map(|side| middle + Vec3::X * (stairs.width_m * side))
}

/// Draws a line across the lane below the centre of the middle limb, and a line from there up to the centre.
fn fitness_line(lane: &Lane, palette: &Palette, gizmos: &mut Gizmos<OnTop>) {
    let ([left, right], middle) = (fitness_line_ends(lane), lane.drawn_middle() + lane.offset());
    let color = in_scene(palette.accent);
    gizmos.line(left, right, color);
    gizmos.line(left.with_x(middle.x), middle, color);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_arrow_of_a_larger_torque_is_wider() {
        let widths = [0.02, 0.3, -0.5, 0.7, -1.0, 4.0].map(lines_of);
        assert_eq!(widths, [1, 2, 3, 5, 6, 6]);
    }
}
