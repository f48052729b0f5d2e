//! The snake as it is drawn: a red or blue box per limb, between the last two physics steps.

use bevy::prelude::*;

use super::Frame;
use super::lane::Lane;
use super::scene::{Props, box_transform};

/// The limb of a stage's snake with this index; the head is 0.
#[derive(Component, Debug)]
struct Limb(usize);

pub(super) fn plugin(app: &mut App) {
    app.add_systems(Update, (build, place).chain().in_set(Frame::Draw));
}

/// Builds the limbs of a stage that is new.
fn build(stages: Query<(Entity, &Lane), Added<Lane>>, props: Res<Props>, mut commands: Commands) {
    for (entity, stage) in &stages {
        let agent = &stage.trial().agent;
        commands.entity(entity).with_children(|parent| {
            for (index, pose) in stage.drawn_poses().enumerate() {
                let size = Vec3::from(agent.limb_size_m(index));
                let material = if index % 2 == 0 { &props.red } else { &props.blue };
                parent.spawn((
                    Limb(index),
                    Mesh3d(props.cube.clone()),
                    MeshMaterial3d(material.clone()),
                    box_transform(pose.translation, size).with_rotation(pose.rotation),
                ));
            }
        });
    }
}

/// Moves the limbs to where they are now.
fn place(stages: Query<(&Lane, &Children)>, mut limbs: Query<(&Limb, &mut Transform)>) {
    for (stage, children) in &stages {
        let poses: Vec<_> = stage.drawn_poses().collect();
        let mut limbs = limbs.iter_many_mut(children);
        while let Some((limb, mut transform)) = limbs.fetch_next() {
            if let Some(pose) = poses.get(limb.0) {
                transform.translation = pose.translation;
                transform.rotation = pose.rotation;
            }
        }
    }
}
