//! The stairs of a lane, and the strip of ground before them, each with the look of its surface.

use bevy::light::{NotShadowCaster, NotShadowReceiver};
use bevy::prelude::*;
use bevy::render::render_resource::Face;

use super::mesh_builder::MeshBuilder;
use super::surface_material::SurfaceMaterials;
use super::surface_texture::TILE_M;
use crate::studio::schedule::FrameSet;
use crate::studio::stage::lane::Lane;
use crate::studio::ui::theme::Theme;
use crate::world::Stairs;

/// How far the strip of ground reaches beyond the stairs on both sides, in metres.
pub(crate) const STRIP_ASIDE_M: f32 = 0.4;
/// How far the strip of ground begins behind the snake, in metres.
const STRIP_BEHIND_M: f32 = 3.0;
/// How far the strip goes on where there are no stairs, in metres.
const STRIP_AHEAD_M: f32 = 40.0;
/// Height of the strip above the ground, in metres: below the lines of the grid.
const STRIP_M: f32 = 0.004;
/// Brightness of every other step, so that treads of the same material stand out from each other.
const OTHER_STEP: f32 = 0.86;

/// The material that casts the shadow of stairs.
#[derive(Resource, Debug)]
struct Caster(Handle<StandardMaterial>);

/// The meshes of the last stairs that were built: lanes side by side mostly have the same.
#[derive(Debug, Default)]
struct LastStairs(Option<(Stairs, Handle<Mesh>)>);

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<Caster>().add_systems(Update, build.in_set(FrameSet::Draw));
}

impl FromWorld for Caster {
    fn from_world(world: &mut World) -> Self {
        let mut materials = world.resource_mut::<Assets<StandardMaterial>>();
        // Only faces that look away from the light cast: a face that receives light never shadows itself in the
        // saw-tooth pattern of the shadow map's pixels.
        Self(materials.add(StandardMaterial { cull_mode: Some(Face::Front), ..default() }))
    }
}

/// Spawns the stairs of new lanes. A ghost stands on those of another lane.
fn build(
    lanes: Query<(Entity, &Lane), Added<Lane>>,
    theme: Res<Theme>,
    caster: Res<Caster>,
    mut surfaces: ResMut<SurfaceMaterials>,
    mut last: Local<LastStairs>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    mut images: ResMut<Assets<Image>>,
    mut commands: Commands,
) {
    for (entity, lane) in lanes.iter().filter(|(_, lane)| !lane.is_ghost()) {
        let trial = lane.trial();
        let mut of = |surface| surfaces.of(surface, *theme, &mut materials, &mut images);
        let (on_stairs, on_ground) = (of(&trial.surface), of(trial.ground()));
        let start_m = trial.start_y_m - lane.body().length_m() / 2.0;
        let strip = meshes.add(strip(&trial.stairs, start_m).into_tiled_mesh(TILE_M));
        commands.entity(entity).with_child((
            Mesh3d(strip),
            MeshMaterial3d(on_ground),
            NotShadowCaster,
        ));
        if trial.stairs.steps == 0 {
            continue;
        }
        let mesh = match &last.0 {
            Some((stairs, mesh)) if *stairs == trial.stairs => mesh.clone(),
            _ => meshes.add(solid(&trial.stairs).into_tiled_mesh(TILE_M)),
        };
        last.0 = Some((trial.stairs.clone(), mesh.clone()));
        commands.entity(entity).with_children(|parent| {
            parent.spawn((Mesh3d(mesh.clone()), MeshMaterial3d(on_stairs), NotShadowCaster));
            parent.spawn((Mesh3d(mesh), MeshMaterial3d(caster.0.clone()), NotShadowReceiver));
        });
    }
}

/// The stairs as one closed body. Boxes side by side would have hidden faces, which cast shadows on those in sight.
fn solid(stairs: &Stairs) -> MeshBuilder {
    let mut solid = MeshBuilder::default();
    let half_m = stairs.width_m / 2.0;
    let boxes = stairs.boxes();
    let mut below_m = 0.0;
    for (index, step) in boxes.iter().enumerate() {
        solid.tone(Vec3::splat(if index % 2 == 0 { 1.0 } else { OTHER_STEP }));
        let ([_, from_m, _], [_, to_m, top_m]) = (step.min_m, step.max_m);
        let (middle_m, depth) = ((from_m + to_m) / 2.0, Vec3::Y * (to_m - from_m) / 2.0);
        // Tread, riser, and both sides down to the ground.
        solid.sheet(Vec3::new(0.0, middle_m, top_m), Vec3::X * half_m, depth);
        let rise_m = top_m - below_m;
        let riser = Vec3::new(0.0, from_m, below_m + rise_m / 2.0);
        solid.sheet(riser, Vec3::X * half_m, Vec3::Z * rise_m / 2.0);
        for side in [1.0, -1.0] {
            let middle = Vec3::new(half_m * side, middle_m, top_m / 2.0);
            solid.sheet(middle, depth * side, Vec3::Z * top_m / 2.0);
        }
        below_m = top_m;
    }
    if let (Some(first), Some(last)) = (boxes.first(), boxes.last()) {
        let (begin_m, end_m, top_m) = (first.min_m[1], last.max_m[1], last.max_m[2]);
        let back = Vec3::new(0.0, end_m, top_m / 2.0);
        solid.sheet(back, Vec3::NEG_X * half_m, Vec3::Z * top_m / 2.0);
        let bottom = Vec3::new(0.0, (begin_m + end_m) / 2.0, 0.0);
        solid.sheet(bottom, Vec3::NEG_X * half_m, Vec3::Y * (end_m - begin_m) / 2.0);
    }
    solid
}

/// Start and end of the strip of ground along y, in metres, for a snake whose tail begins at `start_m`.
pub(crate) fn strip_y_m(stairs: &Stairs, start_m: f32) -> [f32; 2] {
    let from_m = start_m - STRIP_BEHIND_M;
    let to_m = if stairs.steps == 0 { start_m + STRIP_AHEAD_M } else { stairs.first_riser_y_m };
    [from_m, to_m.max(from_m)]
}

/// The strip of ground before the stairs. The physical ground is infinite; the strip shows its surface.
fn strip(stairs: &Stairs, start_m: f32) -> MeshBuilder {
    let mut solid = MeshBuilder::default();
    let [from_m, to_m] = strip_y_m(stairs, start_m);
    let middle = Vec3::new(0.0, (from_m + to_m) / 2.0, STRIP_M);
    let half_width = Vec3::X * (stairs.width_m / 2.0 + STRIP_ASIDE_M);
    solid.sheet(middle, half_width, Vec3::Y * (to_m - from_m) / 2.0);
    solid
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_point_of_the_stairs_lies_on_the_boxes_of_the_physics() {
        let stairs = Stairs::default();
        let solid = solid(&stairs);
        let boxes = stairs.boxes();
        for at in &solid.positions {
            let is_on = |step: &crate::world::StairBox| {
                at.to_array().into_iter().zip(step.min_m).all(|(at, min)| at >= min - 1.0e-4)
                    && at.to_array().into_iter().zip(step.max_m).all(|(at, max)| at <= max + 1.0e-4)
            };
            assert!(boxes.iter().any(is_on), "{at}");
        }
        let top_m = solid.positions.iter().map(|at| at.z).fold(0.0, f32::max);
        assert_eq!((top_m, boxes.len()), (5.0, 10));
    }

    #[test]
    fn the_stairs_have_the_volume_of_their_boxes_and_face_outward() {
        let stairs = Stairs::default();
        let solid = solid(&stairs);
        let volume: f32 = solid
            .indices
            .chunks(3)
            .map(|corners| {
                let [a, b, c] = [0, 1, 2].map(|corner| solid.positions[corners[corner] as usize]);
                a.dot(b.cross(c)) / 6.0
            })
            .sum();
        let of_boxes: f32 = stairs
            .boxes()
            .iter()
            .map(|step| (Vec3::from(step.max_m) - Vec3::from(step.min_m)).element_product())
            .sum();
        assert!((volume / of_boxes - 1.0).abs() < 1.0e-4, "{volume} of {of_boxes}");
    }

    #[test]
    fn the_strip_of_ground_reaches_from_behind_the_snake_to_the_first_riser() {
        let stairs = Stairs::default();
        assert_eq!(strip_y_m(&stairs, -12.0), [-15.0, 3.0]);
        let flat = Stairs { steps: 0, ..Stairs::default() };
        assert!(strip_y_m(&flat, -12.0)[1] > 20.0);
    }
}
