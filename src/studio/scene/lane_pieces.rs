//! Spawns the parts of a new lane besides its snake. Ghosts have none, because they share the stairs of another lane.

use bevy::light::{NotShadowCaster, NotShadowReceiver};
use bevy::prelude::*;

use super::cache::cached;
use super::dents::{self, Dent};
use super::landing::fittings;
use super::lane_marks::{LaneMark, stripes};
use super::meshes::{to_mesh, to_tiled_mesh};
use super::props::{Props, piece};
use super::stairs::{solid, strip};
use super::step_edges;
use super::step_labels::labels;
use super::surface_material::SurfaceMaterials;
use super::surface_texture::TILE_M;
use super::text::TextMeshes;
use crate::studio::stage::lane::Lane;
use crate::studio::ui::theme::Theme;
use snakes_core::world::Stairs;

pub(super) fn build(
    lanes: Query<(Entity, &Lane), Added<Lane>>,
    (props, lettering, theme): (Res<Props>, Res<TextMeshes>, Res<Theme>),
    mut surfaces: ResMut<SurfaceMaterials>,
    mut last: Local<Vec<(Stairs, [Handle<Mesh>; 7])>>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    mut images: ResMut<Assets<Image>>,
    mut commands: Commands,
) {
    for (entity, lane) in lanes.iter().filter(|(_, lane)| !lane.is_ghost) {
        let (trial, stairs) = (lane.trial(), &lane.trial().stairs);
        let mut of = |surface| surfaces.of(surface, *theme, &mut materials, &mut images);
        let (on_stairs, on_ground) = (of(&trial.surface), of(trial.ground()));
        let start_m = trial.start_y_m - lane.body.length_m() / 2.0;
        let ground = meshes.add(to_tiled_mesh(strip(stairs, start_m), TILE_M));
        let stripes = meshes.add(to_mesh(stripes(stairs, start_m)));
        let labels = meshes.add(labels(lane, &lettering));
        commands.entity(entity).with_children(|parent| {
            parent.spawn((piece(&ground, &on_ground), NotShadowCaster));
            parent.spawn((piece(&labels, &lettering.paint), NotShadowCaster));
            let mark = (LaneMark, Visibility::Hidden, NotShadowCaster);
            parent.spawn((piece(&stripes, props.of_lane(lane.number)), mark));
            if dents::is_soft(lane) {
                let patch = piece(&meshes.add(dents::patch()), &props.dent);
                let dent = (patch, NotShadowCaster, NotShadowReceiver, Visibility::Hidden);
                for part in 0..lane.body.parts.len() {
                    parent.spawn((Dent(part), dent.clone()));
                }
            }
            if stairs.steps == 0 {
                return;
            }
            // Lanes side by side usually have the same stairs.
            let [solid, glow, wood, wall, white, lamps, shine] =
                cached(&mut last, stairs, 1, || {
                    let [wood, wall, white, lamps, shine] = fittings(stairs);
                    let solid = to_tiled_mesh(solid(stairs), TILE_M);
                    [solid, step_edges::glow(stairs), wood, wall, white, lamps, shine]
                        .map(|mesh| meshes.add(mesh))
                });
            parent.spawn((piece(&solid, &on_stairs), NotShadowCaster));
            parent.spawn((piece(&solid, &props.caster), NotShadowReceiver));
            parent.spawn(piece(&wood, &props.wood));
            parent.spawn(piece(&wall, &props.wall));
            parent.spawn((piece(&white, &props.white), NotShadowCaster));
            parent.spawn((piece(&lamps, &props.lamp), NotShadowCaster));
            parent.spawn((piece(&shine, &props.shine), NotShadowCaster));
            step_edges::spawn(parent, stairs, &props, &glow);
        });
    }
}
