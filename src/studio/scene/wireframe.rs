//! The physics engine's debug drawing of every lane: shapes, joints, contacts.

use bevy::prelude::*;
use rapier3d::pipeline::{
    DebugRenderBackend, DebugRenderMode, DebugRenderObject, DebugRenderPipeline, DebugRenderStyle,
};
use rapier3d::prelude::Vector;

use super::overlays::Overlays;
use crate::studio::commands::overlay::Overlay;
use crate::studio::schedule::FrameSet;
use crate::studio::stage::lane::Lane;
use snakes_core::world::SeenPoint;

pub(crate) fn plugin(app: &mut App) {
    app.add_systems(Update, draw.in_set(FrameSet::Draw));
}

/// Colour of the collision shapes of the snake's blocks.
pub(crate) fn block_color() -> Color {
    of_engine(DebugRenderStyle::default().collider_dynamic_color)
}

/// Colour of the collision shapes of stairs and ground.
pub(crate) fn stairs_color() -> Color {
    of_engine(DebugRenderStyle::default().collider_fixed_color)
}

fn of_engine([hue, saturation, lightness, alpha]: [f32; 4]) -> Color {
    Color::hsla(hue, saturation, lightness, alpha)
}

/// Draws lines with a lane's offset.
struct CollisionLines<'a, 'w, 's> {
    gizmos: &'a mut Gizmos<'w, 's>,
    offset: Vec3,
}

impl DebugRenderBackend for CollisionLines<'_, '_, '_> {
    fn draw_line(&mut self, _: DebugRenderObject, from: Vector, to: Vector, hsla: [f32; 4]) {
        self.gizmos.line(from + self.offset, to + self.offset, of_engine(hsla));
    }
}

/// Draws contacts that rapier does not know, as it draws its own: the gap or the overlap of each point, and its normal.
fn draw_contacts(contacts: &[SeenPoint], lines: &mut CollisionLines<'_, '_, '_>) {
    let style = DebugRenderStyle::default();
    for contact in contacts {
        let [from, to] = contact.on_m;
        let along = from + contact.normal * style.contact_normal_length;
        for (to, color) in [(to, style.contact_depth_color), (along, style.contact_normal_color)] {
            lines.gizmos.line(from + lines.offset, to + lines.offset, of_engine(color));
        }
    }
}

fn draw(overlays: Res<Overlays>, lanes: Query<&Lane>, mut gizmos: Gizmos) {
    if !overlays.shows(Overlay::Wireframe) {
        return;
    }
    let mode = DebugRenderMode::default() | DebugRenderMode::CONTACTS;
    let mut pipeline = DebugRenderPipeline::new(DebugRenderStyle::default(), mode);
    for lane in &lanes {
        let Some(simulation) = lane.simulation() else { continue };
        let physics = simulation.physics();
        let mut lines = CollisionLines { gizmos: &mut gizmos, offset: lane.offset() };
        draw_contacts(&simulation.contacts_in_lanes(), &mut lines);
        pipeline.render(
            &mut lines,
            &physics.bodies,
            &simulation.colliders(),
            &physics.impulse_joints,
            &physics.multibody_joints,
            &physics.narrow_phase,
        );
    }
}
