//! The physics engine's debug drawing of every lane, by bevy_rapier3d: shapes, joints, contacts.

use bevy::prelude::*;
use bevy_rapier3d::prelude::{
    DebugRenderContext, DebugRenderMode, DebugRenderStyle, RapierDebugRenderPlugin,
};

use super::overlays::Overlays;
use crate::studio::commands::overlay::Overlay;
use crate::studio::schedule::FrameSet;
use crate::studio::stage::lane::Lane;
use crate::studio::stage::staged_world::StagedWorld;

pub(crate) fn plugin(app: &mut App) {
    let mode = DebugRenderMode::default() | DebugRenderMode::CONTACTS;
    app.add_plugins(RapierDebugRenderPlugin { mode, ..default() }.disabled())
        .add_systems(Update, hold_worlds.in_set(FrameSet::Draw));
}

/// Returns the colour of the collision shapes of the snake's blocks.
pub(crate) fn block_color() -> Color {
    of_engine(DebugRenderStyle::default().collider_dynamic_color)
}

/// Returns the colour of the collision shapes of stairs and ground.
pub(crate) fn stairs_color() -> Color {
    of_engine(DebugRenderStyle::default().collider_fixed_color)
}

fn of_engine([hue, saturation, lightness, alpha]: [f32; 4]) -> Color {
    Color::hsla(hue, saturation, lightness, alpha)
}

/// Passes the worlds of all lanes to the debug plugin, which draws them later in the frame.
fn hold_worlds(
    overlays: Res<Overlays>,
    mut lines: ResMut<DebugRenderContext>,
    mut worlds: Query<StagedWorld>,
    mut gizmos: Gizmos,
) {
    lines.enabled = overlays.contains(&Overlay::Wireframe);
    if !lines.enabled {
        return;
    }
    for mut world in &mut worlds {
        world.hold_for_lines();
        if !world.lane.is_ghost {
            draw_contacts(world.lane, &mut gizmos);
        }
    }
}

/// Draws the contacts that rapier does not hold in the style in which the plugin draws those of rapier: the gap or the
/// overlap of each point, and the normal.
fn draw_contacts(lane: &Lane, gizmos: &mut Gizmos) {
    let style = DebugRenderStyle::default();
    let contacts = lane.replay.simulation().map(|simulation| simulation.contacts_beside_rapier());
    for contact in contacts.unwrap_or_default() {
        let [from, to] = contact.on_m.map(|at| at + lane.offset());
        let along = from + contact.normal * style.contact_normal_length;
        gizmos.line(from, to, of_engine(style.contact_depth_color));
        gizmos.line(from, along, of_engine(style.contact_normal_color));
    }
}
