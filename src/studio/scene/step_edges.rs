//! Strips at the front edges of the steps. The strips of the steps below the snake are lit.

use std::f32::consts::PI;

use bevy::light::NotShadowCaster;
use bevy::prelude::*;

use super::meshes::to_fading_mesh;
use super::props::{Props, piece};
use crate::studio::stage::lane::Lane;
use snakes_core::world::Stairs;
use snakes_lab::mesh::MeshBuilder;

/// Strip on the edge of a step, with the index of the step; the lowest is 0.
#[derive(Component, Debug)]
pub(super) struct StepEdge(u32);

/// Depth of a strip along the tread, and its height along the riser, in metres.
const DEPTH_M: f32 = 0.12;
const HEIGHT_M: f32 = 0.06;
/// Thickness by which a strip stands out of tread and riser, in metres.
const OUT_M: f32 = 0.012;
/// Extent of the glow of a lit strip across the tread and down the riser, in metres.
const GLOW_BACK_M: f32 = 0.55;
const GLOW_DOWN_M: f32 = 0.3;
const GLOW_ON_NOSING_M: f32 = 0.1;

/// Spawns the strips of a new lane's stairs. `glow` is the mesh of [`glow`].
pub(super) fn spawn(
    lane: &mut ChildSpawnerCommands<'_>,
    stairs: &Stairs,
    props: &Props,
    glow: &Handle<Mesh>,
) {
    for step in 0..stairs.steps {
        // The middle of the step's front edge, or of the edge from which the step leads down.
        let [y_m, z_m] = stairs.edge_m(step);
        let edge = Vec3::new(0.0, y_m, z_m);
        let size = Vec3::new(stairs.width_m + OUT_M, DEPTH_M, HEIGHT_M);
        let ahead = if stairs.step_rise_m(step) < 0.0 { -1.0 } else { 1.0 };
        let to_middle = Vec3::new(0.0, (DEPTH_M / 2.0 - OUT_M) * ahead, OUT_M - HEIGHT_M / 2.0);
        lane.spawn((
            StepEdge(step),
            piece(&props.cube, &props.dark_strip),
            Transform::from_translation(edge + to_middle).with_scale(size),
            NotShadowCaster,
        ));
        lane.spawn((
            StepEdge(step),
            piece(glow, &props.glow),
            // Rotated, not mirrored: a mirrored mesh would show its back faces, which are not drawn.
            Transform::from_translation(edge)
                .with_rotation(Quat::from_rotation_z(if ahead < 0.0 { PI } else { 0.0 })),
            Visibility::Hidden,
            NotShadowCaster,
        ));
    }
}

/// Builds the glow of a strip: two patches over the tread and down the riser that fade out away from the edge.
pub(super) fn glow(stairs: &Stairs) -> Mesh {
    let mut solid = MeshBuilder::default();
    let half = Vec3::X * stairs.width_m / 2.0;
    let least = |of: &dyn Fn(u32) -> f32| (0..stairs.steps).map(of).fold(f32::MAX, f32::min);
    let back_m = GLOW_BACK_M.min(least(&|step| stairs.step_tread_m(step)));
    let lowest_m = least(&|step| stairs.step_rise_m(step).abs());
    // The front of a nosing is 0.1 m high, or half the rise.
    let down_m = if stairs.nosing_m > 0.0 {
        GLOW_ON_NOSING_M.min(lowest_m / 2.0)
    } else {
        GLOW_DOWN_M.min(lowest_m)
    };
    let out_m = OUT_M / 2.0;
    solid.sheet(Vec3::new(0.0, back_m / 2.0, out_m), half, Vec3::Y * back_m / 2.0);
    solid.sheet(Vec3::new(0.0, -out_m, -down_m / 2.0), half, Vec3::Z * down_m / 2.0);
    to_fading_mesh(solid, |at| if at.y > out_m || at.z < -out_m { 0.0 } else { GLOW_OPACITY })
}

/// Opacity of the glow at the edge.
const GLOW_OPACITY: f32 = 0.65;

/// Lights the strips of the steps under the middle limb, and darkens the others.
pub(super) fn light(
    lanes: Query<(&Lane, &Children)>,
    props: Res<Props>,
    mut edges: Query<(&StepEdge, &mut MeshMaterial3d<StandardMaterial>, &mut Visibility)>,
) {
    for (lane, children) in lanes.iter().filter(|(lane, _)| !lane.is_ghost) {
        let middle = lane.drawn_poses().nth(lane.body.middle_part);
        let stairs = &lane.trial().stairs;
        let climbed = middle.map_or(0, |pose| stairs.steps_under(pose.translation.to_array()));
        let mut edges = edges.iter_many_mut(children);
        while let Some((edge, mut material, mut visibility)) = edges.fetch_next() {
            let is_lit = edge.0 < climbed;
            if material.0 == props.glow {
                let shown = if is_lit { Visibility::Inherited } else { Visibility::Hidden };
                visibility.set_if_neq(shown);
                continue;
            }
            let strip = if is_lit { &props.lit_strip } else { &props.dark_strip };
            if material.0 != *strip {
                material.0 = strip.clone();
            }
        }
    }
}
