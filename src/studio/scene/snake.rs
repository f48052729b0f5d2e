//! Draws the snake as red and blue blocks with joints, interpolated between the last two physics steps.
//!
//! A ghost consists only of pale blocks. Without details, shadow and collar, thirty ghosts are still cheap to draw.

use bevy::camera::visibility::NoFrustumCulling;
use bevy::light::{NotShadowCaster, NotShadowReceiver};
use bevy::mesh::skinning::{SkinnedMesh, SkinnedMeshInverseBindposes};
use bevy::prelude::*;

use super::cache::SceneCache;
use super::lane_marks::{LaneColors, LaneMark};
use super::limb::LimbShape;
use super::props::{Props, over_ghosts, themed};
use crate::studio::schedule::FrameSet;
use crate::studio::stage::StageMode;
use crate::studio::stage::lane::Lane;
use snakes_core::world::{JointPlan, Pose};

/// Index of a part in its lane's snake.
#[derive(Component, Debug)]
struct SnakePart(usize);

/// Meshes of a limb, and the bind poses of its parts.
#[derive(Debug, Clone)]
struct LimbMeshes {
    block: Handle<Mesh>,
    white: Handle<Mesh>,
    dark: Handle<Mesh>,
    collar: Handle<Mesh>,
    /// Transforms from the frame of a soft limb to those of its parts at rest.
    bind_poses: Handle<SkinnedMeshInverseBindposes>,
}

/// Cached meshes by shape, which snakes with the same limbs share.
#[derive(Resource, Debug, Default)]
struct Shapes(SceneCache<LimbShape, LimbMeshes>);

/// Materials of the details on limbs.
#[derive(Resource, Debug)]
struct Trim {
    /// Materials of the light and of the dark details.
    usual: [Handle<StandardMaterial>; 2],
    /// Materials of the details of the best snake of a generation.
    of_best: [Handle<StandardMaterial>; 2],
}

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<Shapes>()
        .init_resource::<StageMode>()
        .init_resource::<Trim>()
        .add_systems(Update, (build, place).chain().in_set(FrameSet::Draw));
}

/// Size of a ghost, as a fraction of the snake's: where a ghost moves as the best does, it is inside the best.
const GHOST_SIZE: f32 = 0.96;
/// Maximum number of cached shapes. Dragging a slider for the snake's size creates many.
const MAX_SHAPES: usize = 64;

impl FromWorld for Trim {
    fn from_world(world: &mut World) -> Self {
        let white = StandardMaterial { perceptual_roughness: 0.4, ..default() };
        let dark = StandardMaterial { perceptual_roughness: 0.35, metallic: 0.4, ..default() };
        let mut both = |[white, dark]: [StandardMaterial; 2]| {
            [
                themed(world, white, |palette| palette.white),
                themed(world, dark, |palette| palette.metal),
            ]
        };
        Self {
            of_best: both([over_ghosts(white.clone()), over_ghosts(dark.clone())]),
            usual: both([white, dark]),
        }
    }
}

/// Spawns the limbs of a new lane's snake.
fn build(
    lanes: Query<(Entity, &Lane), Added<Lane>>,
    (props, trim, colors): (Res<Props>, Res<Trim>, Res<LaneColors>),
    mode: Res<StageMode>,
    mut shapes: ResMut<Shapes>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut bind_poses: ResMut<Assets<SkinnedMeshInverseBindposes>>,
    mut commands: Commands,
) {
    for (entity, lane) in &lanes {
        let body = &lane.body;
        let is_best = matches!(*mode, StageMode::Generation { .. });
        let ([red, blue], [white, dark]) = match (lane.is_ghost, is_best) {
            (true, _) => (&props.ghosts, &trim.usual),
            (false, true) => (&props.limbs_of_best, &trim.of_best),
            (false, false) => (&props.limbs, &trim.usual),
        };
        let poses: Vec<Pose> = lane.drawn_poses().collect();
        for limb in 0..body.limbs() {
            let color = MeshMaterial3d(if limb % 2 == 0 { red } else { blue }.clone());
            let parts = body.parts_of(limb);
            let bones: Vec<Entity> = parts
                .clone()
                .map(|part| {
                    let pose = poses[part];
                    let place = Transform::from_translation(pose.translation);
                    let place = place.with_rotation(pose.rotation);
                    let mut bone = commands.spawn((SnakePart(part), place, Visibility::default()));
                    bone.insert(ChildOf(entity));
                    if lane.is_ghost {
                        let size = Vec3::from(body.parts[part].size_m()) * GHOST_SIZE;
                        let cube = Mesh3d(props.ghost_cube.clone());
                        let place = place.with_scale(size);
                        bone.insert((cube, color.clone(), place));
                        bone.insert((NotShadowCaster, NotShadowReceiver));
                    }
                    bone.id()
                })
                .collect();
            if lane.is_ghost {
                continue;
            }
            let bends = |joint: &JointPlan| joint.bend_limit_rad > 0.0;
            let shape = LimbShape {
                size: Vec3::from(body.limb_size_m(limb)),
                has_front: limb > 0,
                has_rear: limb + 1 < body.limbs() && !body.is_branching(),
                has_own_hinge: body.is_branching() && body.joint_before(limb).is_some_and(bends),
                parts: parts.len(),
            };
            let shapes = shapes.0.get(&shape, MAX_SHAPES, || {
                let [block, white, dark, collar] =
                    [shape.block(), shape.white(), shape.dark(), shape.collar()]
                        .map(|solid| meshes.add(shape.mesh_of(solid)));
                let bind_poses = bind_poses.add(shape.bind_poses());
                LimbMeshes { block, white, dark, collar, bind_poses }
            });
            // The meshes of a rigid limb are children of its part. Those of a soft limb follow all of its parts,
            // whatever their own transform is.
            let joints = bones.clone();
            let skin = (bones.len() > 1).then(|| {
                let inverse_bindposes = shapes.bind_poses.clone();
                (SkinnedMesh { inverse_bindposes, joints }, NoFrustumCulling)
            });
            let mut spawn = |mesh: Handle<Mesh>, material| {
                let mut piece = commands.spawn((Mesh3d(mesh), material, Visibility::default()));
                let holder = if skin.is_some() { entity } else { bones[0] };
                piece.insert(ChildOf(holder));
                if let Some(skin) = &skin {
                    piece.insert(skin.clone());
                }
                piece.id()
            };
            spawn(shapes.block.clone(), color);
            let white = spawn(shapes.white.clone(), MeshMaterial3d(white.clone()));
            let dark = spawn(shapes.dark.clone(), MeshMaterial3d(dark.clone()));
            let collar = (limb == 0)
                .then(|| spawn(shapes.collar.clone(), MeshMaterial3d(colors.of(lane.number))));
            if let Some(collar) = collar {
                commands.entity(collar).insert((LaneMark, Visibility::Hidden));
            }
            // The block already casts the shadow.
            for piece in [Some(white), Some(dark), collar].into_iter().flatten() {
                commands.entity(piece).insert(NotShadowCaster);
            }
        }
    }
}

/// Moves the parts of the snakes. Unchanged transforms are not written, so that Bevy does not propagate them again.
fn place(lanes: Query<(&Lane, &Children)>, mut parts: Query<(&SnakePart, &mut Transform)>) {
    for (lane, children) in &lanes {
        let mut parts = parts.iter_many_mut(children);
        while let Some((part, mut transform)) = parts.fetch_next() {
            if let Some(pose) = lane.drawn_poses().nth(part.0) {
                let place = Transform::from_translation(pose.translation);
                let size = transform.scale;
                transform.set_if_neq(place.with_rotation(pose.rotation).with_scale(size));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::stage::staged_champion::StagedChampion;
    use snakes_core::save::shipped_champion;

    /// Creates an app with a lane and a ghost of the same snake.
    fn app() -> App {
        let loaded = shipped_champion().expect("well formed");
        let lane = |number| Lane::new(StagedChampion::from_file(&loaded, number, "one"), number);
        let mut app = App::new();
        app.init_resource::<Assets<Mesh>>()
            .init_resource::<Assets<StandardMaterial>>()
            .init_resource::<Assets<SkinnedMeshInverseBindposes>>()
            .init_resource::<Props>()
            .init_resource::<LaneColors>()
            .add_plugins(plugin);
        for lane in [lane(0), lane(1).into_ghost()] {
            app.world_mut().spawn((Transform::default(), Visibility::default(), lane));
        }
        app.update();
        app
    }

    #[test]
    fn a_ghost_is_pale_without_details_and_shadow() {
        let mut app = app();
        let world = app.world_mut();
        let props = world.resource::<Props>();
        let ghosts = props.ghosts.clone();
        let mut parts = world.query::<(
            &SnakePart,
            Option<&MeshMaterial3d<StandardMaterial>>,
            Has<NotShadowCaster>,
            Option<&Children>,
        )>();
        let (mut seen, mut of_ghost) = (0, 0);
        for (_, material, is_without_shadow, details) in parts.iter(world) {
            let is_ghost = material.is_some_and(|material| ghosts.contains(&material.0));
            assert_eq!((is_without_shadow, details.is_none()), (is_ghost, is_ghost));
            seen += 1;
            of_ghost += usize::from(is_ghost);
        }
        assert_eq!((seen, of_ghost), (10, 5));
    }

    #[test]
    fn a_snake_that_rests_writes_no_transform() {
        #[derive(Resource, Default)]
        struct Moved(usize);
        let mut app = app();
        app.init_resource::<Moved>().add_systems(
            PostUpdate,
            |parts: Query<(), (With<SnakePart>, Changed<Transform>)>, mut moved: ResMut<Moved>| {
                moved.0 = parts.iter().count();
            },
        );
        app.update();
        app.update();
        assert_eq!(app.world().resource::<Moved>().0, 0);
    }
}
