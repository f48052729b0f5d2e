//! The physics engine's own drawing of every lane: shapes, joints, contacts, as it sees them.
//!
//! bevy_rapier3d's plugin draws all contexts in one place; lanes are side by side.

use bevy::prelude::*;
use bevy_rapier3d::plugin::context::{
    RapierContextColliders, RapierContextJoints, RapierContextSimulation, RapierRigidBodySet,
};
use rapier3d::pipeline::{
    DebugRenderBackend, DebugRenderMode, DebugRenderObject, DebugRenderPipeline, DebugRenderStyle,
};
use rapier3d::prelude::Vector;

use super::Frame;
use super::lane::Lane;
use super::overlay::{Overlay, Overlays};

pub(super) fn plugin(app: &mut App) {
    app.add_systems(Update, draw.in_set(Frame::Draw));
}

/// Draws lines at a lane's place.
struct Lines<'a, 'w, 's> {
    gizmos: &'a mut Gizmos<'w, 's>,
    offset: Vec3,
}

impl DebugRenderBackend for Lines<'_, '_, '_> {
    fn draw_line(&mut self, _: DebugRenderObject, from: Vector, to: Vector, hsla: [f32; 4]) {
        let [hue, saturation, lightness, alpha] = hsla;
        let color = Color::hsla(hue, saturation, lightness, alpha);
        self.gizmos.line(from + self.offset, to + self.offset, color);
    }
}

fn draw(
    overlays: Res<Overlays>,
    lanes: Query<(
        &Lane,
        &RapierContextSimulation,
        &RapierContextColliders,
        &RapierContextJoints,
        &RapierRigidBodySet,
    )>,
    mut gizmos: Gizmos,
) {
    if !overlays.shows(Overlay::Wireframe) {
        return;
    }
    let mode = DebugRenderMode::default() | DebugRenderMode::CONTACTS;
    let mut pipeline = DebugRenderPipeline::new(DebugRenderStyle::default(), mode);
    for (lane, simulation, colliders, joints, bodies) in &lanes {
        pipeline.render(
            &mut Lines { gizmos: &mut gizmos, offset: lane.offset() },
            &bodies.bodies,
            &colliders.colliders,
            &joints.impulse_joints,
            &joints.multibody_joints,
            &simulation.narrow_phase,
        );
    }
}
