//! Lanes of a scene: each has a champion's stairs and limbs, and the animation of the limbs.

use gltf_json::accessor::Type;
use gltf_json::animation::{Animation, Channel, Interpolation, Property, Sampler, Target};
use gltf_json::scene::UnitQuaternion;
use gltf_json::validation::Checked;
use gltf_json::{Accessor, Index, Material, Mesh, Node};

use super::super::mjcf::{LIMB_COLORS, STEP_COLORS, part_name};
use super::super::motion::follow;
use super::super::{ExportError, ExportProgress, ExportedChampion};
use super::pieces::{Look, SceneParts};
use crate::mesh::{Eyes, LIMB_EDGE, MeshBuilder};
use snakes_core::score::{Rollout, Trial};
use snakes_core::world::{BodyPlan, Pose, Rotation, StairSolid, Vector};

/// Number of cells across the rounded edge of a limb.
const EDGE_CELLS: usize = 3;
/// Number of sides of an eye.
const EYE_SIDES: usize = 16;
/// Maximum number of samples of an animation per second.
const SAMPLES_PER_S: u32 = 60;
/// Gap between lanes, in m, as on the studio's stage.
const GAP_M: f32 = 1.0;
const RED: Look = Look { name: "red", color: LIMB_COLORS[0], roughness: 0.45 };
const BLUE: Look = Look { name: "blue", color: LIMB_COLORS[1], roughness: 0.45 };
const LIGHT_STEP: Look = Look { name: "light step", color: STEP_COLORS[0], roughness: 0.9 };
const DARK_STEP: Look = Look { name: "dark step", color: STEP_COLORS[1], roughness: 0.9 };
const EYE: Look = Look { name: "eye", color: [0.95, 0.95, 0.95], roughness: 0.2 };
const PUPIL: Look = Look { name: "pupil", color: [0.05, 0.05, 0.06], roughness: 0.2 };

/// Corners of the space that the lanes occupy, in m.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bounds {
    pub min: Vector,
    pub max: Vector,
}

/// Materials that all lanes share.
struct Looks {
    limbs: [Index<Material>; 2],
    steps: [Index<Material>; 2],
    eye: Index<Material>,
    pupil: Index<Material>,
}

/// Sampled poses of a champion's limbs.
#[derive(Default)]
struct Samples {
    times_s: Vec<f32>,
    /// Poses of each part, one for each time.
    poses: Vec<Vec<Pose>>,
}

/// Adds a lane with its animation for each champion, the first one on the right. Returns the lanes' nodes and bounds.
pub(super) fn add_lanes(
    pieces: &mut SceneParts,
    champions: &[ExportedChampion],
    progress: &ExportProgress,
) -> Result<(Vec<Index<Node>>, Bounds), ExportError> {
    let looks = Looks {
        limbs: [RED, BLUE].map(|look| pieces.material(look)),
        steps: [LIGHT_STEP, DARK_STEP].map(|look| pieces.material(look)),
        eye: pieces.material(EYE),
        pupil: pieces.material(PUPIL),
    };
    let width_m = |exported: &ExportedChampion| {
        let champion = &exported.loaded.champion;
        champion.body().width_m().max(champion.trial.stairs.width_m)
    };
    let spacing_m = champions.iter().map(width_m).fold(0.0, f32::max) + GAP_M;
    let middle = champions.len().saturating_sub(1) as f32 / 2.0;
    let mut animation = Animation {
        extensions: None,
        extras: None,
        channels: Vec::new(),
        name: Some(if champions.len() > 1 { "race" } else { "climb" }.to_owned()),
        samplers: Vec::new(),
    };
    let mut bounds = Bounds { min: Vector::splat(f32::MAX), max: Vector::splat(f32::MIN) };
    let mut lanes = Vec::new();
    for (number, exported) in champions.iter().enumerate() {
        let ExportedChampion { name, loaded, .. } = exported;
        let (body, trial) = (loaded.champion.body(), &loaded.champion.trial);
        let part = progress.part(number, champions.len());
        let samples = samples(exported, &body, &part)?;
        let x_m = (middle - number as f32) * spacing_m;
        let half_m = spacing_m / 2.0;
        let back_m = trial.start_y_m - body.length_m() / 2.0;
        bounds.min = bounds.min.min(Vector::new(x_m - half_m, back_m, 0.0));
        let end_y_m = samples.furthest_y_m(trial, &body);
        let top_m = trial.stairs.highest_m() + 1.0;
        bounds.max = bounds.max.max(Vector::new(x_m + half_m, end_y_m, top_m));
        let mut children = limbs(pieces, name, &body, &samples, &looks);
        let times = pieces.times(&samples.times_s);
        for (limb, poses) in children.iter().zip(&samples.poses) {
            move_limb(pieces, &mut animation, *limb, times, poses);
        }
        children.extend(stairs(pieces, name, trial, end_y_m, &looks));
        lanes.push(pieces.root.push(Node {
            name: Some(name.clone()),
            translation: Some([x_m, 0.0, 0.0]),
            children: Some(children),
            ..Node::default()
        }));
    }
    pieces.root.push(animation);
    Ok((lanes, bounds))
}

/// Simulates a champion and samples its poses: at every step, or at high step rates at every second, third and so on. The last pose
/// is always kept.
fn samples(
    exported: &ExportedChampion,
    body: &BodyPlan,
    progress: &ExportProgress,
) -> Result<Samples, ExportError> {
    let champion = &exported.loaded.champion;
    let steps_per_s = champion.trial.physics.steps_per_s;
    let every = steps_per_s.div_ceil(SAMPLES_PER_S);
    let mut samples = Samples { times_s: Vec::new(), poses: vec![Vec::new(); body.parts.len()] };
    let mut last: Option<(u32, Vec<Pose>)> = None;
    let mut keep = |step: u32, poses: &[Pose]| {
        samples.times_s.push((f64::from(step) / f64::from(steps_per_s)) as f32);
        for (kept, pose) in samples.poses.iter_mut().zip(poses) {
            let mut pose = *pose;
            // Two quaternions describe the same rotation. The one closer to the previous sample makes the interpolation short.
            pose.rotation = pose.rotation.normalize();
            if kept.last().is_some_and(|last: &Pose| last.rotation.dot(pose.rotation) < 0.0) {
                pose.rotation = -pose.rotation;
            }
            kept.push(pose);
        }
    };
    follow(champion, progress, |rollout: &Rollout| {
        let step = rollout.step();
        if step.is_multiple_of(every) {
            keep(step, rollout.poses());
            last = None;
        } else {
            last = Some((step, rollout.poses().to_vec()));
        }
        Ok(())
    })?;
    if let Some((step, poses)) = last {
        keep(step, &poses);
    }
    Ok(samples)
}

/// Adds the nodes of the limbs at their first poses, head first. Limbs of equal size and colour share a mesh.
fn limbs(
    pieces: &mut SceneParts,
    name: &str,
    body: &BodyPlan,
    samples: &Samples,
    looks: &Looks,
) -> Vec<Index<Node>> {
    let mut meshes: Vec<([f32; 3], usize, Index<Mesh>)> = Vec::new();
    let mut nodes = Vec::new();
    for (index, part) in body.parts.iter().enumerate() {
        let (size_m, color) = (part.size_m(), part.limb % 2);
        let known =
            meshes.iter().find(|(size, of, _)| index > 0 && (*size, *of) == (size_m, color));
        let mesh = match known {
            Some((_, _, mesh)) => *mesh,
            None => {
                let size = Vector::from(size_m);
                let edge_m = size.min_element() * LIMB_EDGE;
                let mut block = MeshBuilder::default();
                block.rounded_box(Vector::ZERO, size, edge_m, EDGE_CELLS);
                let mut shapes = vec![(block, looks.limbs[color])];
                if index == 0 {
                    let (of_head, [mut eyes, mut pupils]) =
                        (Eyes::of(size, edge_m), <[MeshBuilder; 2]>::default());
                    of_head.add_to(&mut eyes, EYE_SIDES);
                    of_head.add_pupils_to(&mut pupils, EYE_SIDES);
                    shapes.extend([(eyes, looks.eye), (pupils, looks.pupil)]);
                }
                let mesh = pieces.mesh(if index == 0 { "head" } else { "limb" }, &shapes);
                if index > 0 {
                    meshes.push((size_m, color, mesh));
                }
                mesh
            }
        };
        let start = samples.poses[index].first().copied().unwrap_or(Pose::IDENTITY);
        nodes.push(pieces.root.push(Node {
            name: Some(format!("{name}, {}", part_name(body, index))),
            mesh: Some(mesh),
            translation: Some(start.translation.to_array()),
            rotation: Some(UnitQuaternion(start.rotation.to_array())),
            ..Node::default()
        }));
    }
    nodes
}

/// Adds the animation of a limb.
fn move_limb(
    pieces: &mut SceneParts,
    animation: &mut Animation,
    limb: Index<Node>,
    times: Index<Accessor>,
    poses: &[Pose],
) {
    let places: Vec<f32> = poses.iter().flat_map(|pose| pose.translation.to_array()).collect();
    let turns: Vec<f32> = poses.iter().flat_map(|pose| pose.rotation.to_array()).collect();
    let outputs = [
        (Property::Translation, pieces.floats(&places, Type::Vec3, None)),
        (Property::Rotation, pieces.floats(&turns, Type::Vec4, None)),
    ];
    for (property, output) in outputs {
        let sampler = Index::push(
            &mut animation.samplers,
            Sampler {
                extensions: None,
                extras: None,
                input: times,
                interpolation: Checked::Valid(Interpolation::Linear),
                output,
            },
        );
        let path = Checked::Valid(property);
        let target = Target { extensions: None, extras: None, node: limb, path };
        animation.channels.push(Channel { sampler, target, extensions: None, extras: None });
    }
}

impl Samples {
    /// Returns how far along y the scene must reach, in m: to the end of a snake that lies on the landing, and as far as this snake
    /// got.
    fn furthest_y_m(&self, trial: &Trial, body: &BodyPlan) -> f32 {
        let places = self.poses.iter().flatten().map(|pose| pose.translation.y);
        let reach_m = body.parts.iter().map(|limb| limb.length_m).fold(0.0, f32::max);
        let on_landing_m = trial.stairs.landing_y_m() + body.length_m();
        (places.fold(f32::MIN, f32::max) + reach_m).max(on_landing_m)
    }
}

/// Returns the part of a solid with y less than `end_y_m`.
fn cut_off(solid: StairSolid, end_y_m: f32) -> StairSolid {
    let over_m = solid.pose.translation.y + solid.half_m.y - end_y_m;
    if over_m <= 0.0 || solid.pose.rotation != Rotation::IDENTITY {
        return solid;
    }
    let ahead = Vector::Y * over_m / 2.0;
    let pose = Pose::from_translation(solid.pose.translation - ahead);
    StairSolid { pose, half_m: solid.half_m - ahead, ..solid }
}

/// Adds a box with sharp edges, without its bottom face.
fn add_step(shape: &mut MeshBuilder, solid: &StairSolid) {
    let (centre, turn) = (solid.pose.translation, solid.pose.rotation);
    let half = solid.half_m;
    let [x, y, z] =
        [Vector::X * half.x, Vector::Y * half.y, Vector::Z * half.z].map(|to| turn * to);
    for (out, right, up) in [(x, y, z), (-x, -y, z), (y, -x, z), (-y, x, z), (z, x, y)] {
        shape.sheet(centre + out, right, up);
    }
}

/// Adds the node of the stairs, if there are any. Steps alternate between two tones. A long landing ends at `end_y_m`.
fn stairs(
    pieces: &mut SceneParts,
    name: &str,
    trial: &Trial,
    end_y_m: f32,
    looks: &Looks,
) -> Option<Index<Node>> {
    let mut tones = <[MeshBuilder; 2]>::default();
    for solid in trial.stairs.solids() {
        add_step(&mut tones[solid.step as usize % 2], &cut_off(solid, end_y_m));
    }
    let shapes = tones.into_iter().zip(looks.steps);
    let shapes: Vec<_> = shapes.filter(|(shape, _)| !shape.indices.is_empty()).collect();
    if shapes.is_empty() {
        return None;
    }
    let mesh = pieces.mesh("stairs", &shapes);
    let name = Some(format!("{name}, stairs"));
    Some(pieces.root.push(Node { name, mesh: Some(mesh), ..Node::default() }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_has_five_faces_that_look_outward() {
        let mut shape = MeshBuilder::default();
        let centre = Vector::new(0.0, 1.0, 0.25);
        let pose = Pose::from_translation(centre);
        add_step(&mut shape, &StairSolid { step: 0, pose, half_m: Vector::new(1.0, 1.0, 0.25) });
        assert_eq!(shape.indices.len(), 5 * 6);
        for corners in shape.indices.as_chunks::<3>().0 {
            let [a, b, c] = corners.map(|corner| shape.positions[corner as usize]);
            let facing = (b - a).cross(c - a);
            assert!(facing.dot(a - centre) > 0.0);
            assert!(facing.normalize().distance(shape.normals[corners[0] as usize]) < 1e-6);
        }
    }
}
