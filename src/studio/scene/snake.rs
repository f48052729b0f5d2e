//! Draws the snake as red and blue blocks with joints, interpolated between the last two physics steps.
//!
//! A ghost consists only of pale blocks. Without details, shadow and collar, thirty ghosts are still cheap to draw.

use bevy::camera::visibility::NoFrustumCulling;
use bevy::light::{NotShadowCaster, NotShadowReceiver};
use bevy::mesh::skinning::{SkinnedMesh, SkinnedMeshInverseBindposes};
use bevy::prelude::*;

use super::cache::cached;
use super::lane_marks::LaneMark;
use super::limb::LimbShape;
use super::props::{Props, piece};
use crate::studio::schedule::FrameSet;
use crate::studio::stage::StageMode;
use crate::studio::stage::lane::Lane;
use snakes_core::world::{JointPlan, Pose};

/// Index of a part in its lane's snake.
#[derive(Component, Debug)]
struct SnakePart(usize);

/// Meshes of a limb's block, white details, dark details and collar, and the transforms from the frame of a soft limb to those of its
/// parts at rest.
type LimbMeshes = ([Handle<Mesh>; 4], Handle<SkinnedMeshInverseBindposes>);

pub(crate) fn plugin(app: &mut App) {
    app.init_resource::<StageMode>()
        .add_systems(Update, (build, place).chain().in_set(FrameSet::Draw));
}

/// Size of a ghost, as a fraction of the snake's: where a ghost moves as the best does, it is inside the best.
const GHOST_SIZE: f32 = 0.96;
/// Maximum number of cached shapes. Dragging a slider for the snake's size creates many.
const MAX_SHAPES: usize = 64;

/// Spawns the limbs of a new lane's snake.
fn build(
    lanes: Query<(Entity, &Lane), Added<Lane>>,
    (props, mode): (Res<Props>, Res<StageMode>),
    mut shapes: Local<Vec<(LimbShape, LimbMeshes)>>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut bind_poses: ResMut<Assets<SkinnedMeshInverseBindposes>>,
    mut commands: Commands,
) {
    for (entity, lane) in &lanes {
        let body = &lane.body;
        let is_best = matches!(*mode, StageMode::Generation { .. });
        let paints = match (lane.is_ghost, is_best) {
            (true, _) => &props.ghosts[..],
            (false, true) => &props.limbs_of_best,
            (false, false) => &props.limbs,
        };
        let poses: Vec<Pose> = lane.drawn_poses().collect();
        for limb in 0..body.limbs() {
            let color = &paints[limb % 2];
            let parts = body.parts_of(limb);
            let bones: Vec<Entity> = parts
                .clone()
                .map(|part| {
                    let Pose { translation, rotation, .. } = poses[part];
                    let place = Transform { translation, rotation, ..default() };
                    let mut bone = commands.spawn((SnakePart(part), place, Visibility::default()));
                    bone.insert(ChildOf(entity));
                    if lane.is_ghost {
                        let size = Vec3::from(body.parts[part].size_m()) * GHOST_SIZE;
                        let cube = piece(&props.ghost_cube, color);
                        let is_plain = (NotShadowCaster, NotShadowReceiver);
                        bone.insert((cube, place.with_scale(size), is_plain));
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
            let shapes = cached(&mut shapes, &shape, MAX_SHAPES, || {
                let solids = [shape.block(), shape.white(), shape.dark(), shape.collar()];
                let bind_poses = bind_poses.add(shape.bind_poses());
                (solids.map(|solid| meshes.add(shape.mesh_of(solid))), bind_poses)
            });
            let ([block, white, dark, collar], inverse_bindposes) = shapes;
            // The meshes of a rigid limb are children of its part. Those of a soft limb follow all of its parts,
            // whatever their own transform is.
            let holder = if bones.len() > 1 { entity } else { bones[0] };
            let drawn = |mesh, material| (piece(mesh, material), ChildOf(holder));
            let mut pieces = vec![
                commands.spawn(drawn(&block, &props.limbs[limb % 2])).id(),
                // The block already casts the shadow.
                commands.spawn((drawn(&white, &paints[2]), NotShadowCaster)).id(),
                commands.spawn((drawn(&dark, &paints[3]), NotShadowCaster)).id(),
            ];
            if is_best {
                // The material that is drawn over ghosts casts no shadow: its caster would be nearer to the light than the limb.
                pieces.push(commands.spawn((drawn(&block, color), NotShadowCaster)).id());
            }
            if limb == 0 {
                let collar = drawn(&collar, props.of_lane(lane.number));
                let is_mark = (LaneMark, Visibility::Hidden);
                pieces.push(commands.spawn((collar, is_mark, NotShadowCaster)).id());
            }
            if bones.len() > 1 {
                let skin = (SkinnedMesh { inverse_bindposes, joints: bones }, NoFrustumCulling);
                for piece in pieces {
                    commands.entity(piece).insert(skin.clone());
                }
            }
        }
    }
}

/// Moves the parts of the snakes. Unchanged transforms are not written, so that Bevy does not propagate them again.
fn place(lanes: Query<(&Lane, &Children)>, mut parts: Query<(&SnakePart, &mut Transform)>) {
    for (lane, children) in &lanes {
        let mut parts = parts.iter_many_mut(children);
        while let Some((part, mut transform)) = parts.fetch_next() {
            if let Some(Pose { translation, rotation, .. }) = lane.drawn_poses().nth(part.0) {
                let scale = transform.scale;
                transform.set_if_neq(Transform { translation, rotation, scale });
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::studio::state::current_run::climber;

    /// Creates an app with a lane and a ghost of the same snake.
    fn app() -> App {
        let lane = |number| Lane::new(climber(number), number);
        let mut app = App::new();
        app.init_resource::<Assets<Mesh>>()
            .init_resource::<Assets<StandardMaterial>>()
            .init_resource::<Assets<SkinnedMeshInverseBindposes>>()
            .init_resource::<Assets<Image>>()
            .init_resource::<Props>()
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
