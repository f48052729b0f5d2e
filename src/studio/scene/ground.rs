//! The ground, and a grid that fades out in the distance before it could flicker.

use bevy::asset::RenderAssetUsages;
use bevy::light::NotShadowCaster;
use bevy::mesh::PrimitiveTopology;
use bevy::prelude::*;

use super::props::{GROUND_HALF_M, Props, piece};

/// Half the side of the grid on the ground, in metres.
const GRID_HALF_M: f32 = 70.0;
/// Distance between the lines of the grid, in metres: the tread of the report's stairs.
const GRID_CELL_M: f32 = 2.0;
/// Height of the grid above the ground, in metres, to avoid z-fighting.
const GRID_HEIGHT_M: f32 = 0.01;

pub(super) fn set_up(mut commands: Commands, mut meshes: ResMut<Assets<Mesh>>, props: Res<Props>) {
    let ground = meshes.add(Plane3d::new(Vec3::Z, Vec2::splat(GROUND_HALF_M)));
    // There is nothing below the ground to shade. If the ground cast shadows, it would draw saw-teeth along the foot of every wall.
    commands.spawn((piece(&ground, &props.ground), NotShadowCaster));
    commands.spawn(piece(&meshes.add(grid()), &props.grid));
}

/// Returns the grid on the ground, which makes distances visible. Its lines are one tread apart in both directions, and
/// fade out towards its end.
fn grid() -> Mesh {
    let (mut points, mut colors) = (Vec::new(), Vec::new());
    let mut half_line = |from: [f32; 2], to: [f32; 2], aside_m: f32| {
        points.extend([from, to].map(|[x, y]| [x, y, GRID_HEIGHT_M]));
        let opacity = 1.0 - aside_m.abs() / GRID_HALF_M;
        colors.extend([[1.0, 1.0, 1.0, opacity], [1.0, 1.0, 1.0, 0.0]]);
    };
    let cells = (GRID_HALF_M / GRID_CELL_M) as i32;
    // One line coincides with the first riser of the report's stairs, at y = 3.
    let middle = [-1.0, 1.0];
    for cell in -cells..=cells {
        let aside_m = cell as f32 * GRID_CELL_M;
        for end_m in [-GRID_HALF_M, GRID_HALF_M] {
            let [x, y] = middle;
            half_line([x + aside_m, y], [x + aside_m, y + end_m], aside_m);
            half_line([x, y + aside_m], [x + end_m, y + aside_m], aside_m);
        }
    }
    Mesh::new(PrimitiveTopology::LineList, RenderAssetUsages::RENDER_WORLD)
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, points)
        .with_inserted_attribute(Mesh::ATTRIBUTE_COLOR, colors)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ground_casts_no_shadow_on_the_foot_of_the_stairs() {
        let mut app = App::new();
        app.init_resource::<Assets<Mesh>>()
            .init_resource::<Assets<StandardMaterial>>()
            .init_resource::<Assets<Image>>()
            .init_resource::<Props>()
            .add_systems(Startup, set_up);
        app.update();
        let world = app.world_mut();
        let ground = world.resource::<Props>().ground.clone();
        let mut grounds =
            world.query::<(&MeshMaterial3d<StandardMaterial>, Has<NotShadowCaster>)>();
        let casts = grounds.iter(world).any(|(of, is_without)| of.0 == ground && !is_without);
        assert!(!casts);
    }
}
