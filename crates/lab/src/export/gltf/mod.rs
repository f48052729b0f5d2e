//! Moving champions on their stairs as a binary glTF 2.0 scene.
//!
//! A root node turns the program's axes (z up) to glTF's axes (y up). Its children are the lanes, side by side as on the studio's
//! stage, each with its stairs and limbs. Limbs move on straight lines between the samples of their poses.

mod lanes;
mod pieces;

use std::f32::consts::FRAC_1_SQRT_2;
use std::io::Write;
use std::path::Path;

use gltf_json::Root;
use gltf_json::extensions::scene::khr_lights_punctual::{KhrLightsPunctual, Light, Type};
use gltf_json::scene::UnitQuaternion;
use gltf_json::validation::Checked;
use gltf_json::{Asset, Index, Node, Scene};
use serde_json::json;

use super::facts::{facts_as_json, generator};
use super::{ExportError, ExportProgress, ExportedChampion};
use crate::mesh::MeshBuilder;
use lanes::{Bounds, add_lanes};
use pieces::{Look, SceneParts};
use snakes_core::save::UnfinishedFile;
use snakes_core::world::{Rotation, Vector};

/// Rotation from z up to y up: a quarter turn about x.
const Y_UP: UnitQuaternion = UnitQuaternion([-FRAC_1_SQRT_2, 0.0, 0.0, FRAC_1_SQRT_2]);
/// Vertical field of view of the camera, in rad.
const VIEW_RAD: f32 = 0.7;
/// Width of the ground around the lanes, in m. It is small, because viewers choose their view by the size of the whole scene.
const GROUND_BEYOND_M: f32 = 4.0;
const GROUND: Look = Look { name: "ground", color: [0.55, 0.57, 0.53], roughness: 0.95 };

/// Writes a scene with all champions.
pub(super) fn write_glb(
    champions: &[ExportedChampion],
    path: &Path,
    progress: &ExportProgress,
) -> Result<(), ExportError> {
    let failed = ExportError::unwritable::<std::io::Error>(path);
    let bytes = scene(champions, progress)?.map_err(failed)?;
    let mut file = UnfinishedFile::create(path)?;
    file.write_all(&bytes).map_err(ExportError::unwritable(path))?;
    Ok(file.finish()?)
}

/// Returns the bytes of the file.
fn scene(
    champions: &[ExportedChampion],
    progress: &ExportProgress,
) -> Result<std::io::Result<Vec<u8>>, ExportError> {
    let mut pieces = SceneParts::new(asset(champions));
    let (mut below_root, bounds) = add_lanes(&mut pieces, champions, progress)?;
    below_root.push(ground(&mut pieces, &bounds));
    below_root.push(sun(&mut pieces.root));
    below_root.push(camera(&mut pieces.root, &bounds));
    let root = pieces.root.push(Node {
        name: Some("Snakes & Stairs".to_owned()),
        rotation: Some(Y_UP),
        children: Some(below_root),
        ..Node::default()
    });
    let scene = pieces.root.push(Scene {
        extensions: None,
        extras: None,
        name: Some("Snakes & Stairs".to_owned()),
        nodes: vec![root],
    });
    pieces.root.scene = Some(scene);
    Ok(pieces.into_glb())
}

/// Returns the scene's metadata: this program, and the facts about each champion.
fn asset(champions: &[ExportedChampion]) -> Asset {
    Asset {
        generator: Some(generator()),
        extras: serde_json::value::to_raw_value(&json!({ "champions": facts_as_json(champions) }))
            .ok(),
        ..Asset::default()
    }
}

fn ground(pieces: &mut SceneParts, bounds: &Bounds) -> Index<Node> {
    let size = bounds.max - bounds.min + Vector::new(2.0, 2.0, 0.0) * GROUND_BEYOND_M;
    let mut shape = MeshBuilder::default();
    shape.sheet(Vector::ZERO, Vector::X * size.x / 2.0, Vector::Y * size.y / 2.0);
    let material = pieces.material(GROUND);
    let mesh = pieces.mesh("ground", &[(shape, material)]);
    let middle = (bounds.min + bounds.max) / 2.0;
    pieces.root.push(Node {
        name: Some("ground".to_owned()),
        mesh: Some(mesh),
        translation: Some([middle.x, middle.y, 0.0]),
        ..Node::default()
    })
}

/// Adds a directional light from the right, behind and above.
fn sun(root: &mut Root) -> Index<Node> {
    root.extensions_used.push("KHR_lights_punctual".to_owned());
    let light = root.push(Light {
        color: [1.0, 0.98, 0.95],
        extensions: None,
        extras: None,
        intensity: 4.0,
        name: Some("sun".to_owned()),
        range: None,
        spot: None,
        type_: Checked::Valid(Type::Directional),
    });
    let lights = gltf_json::extensions::scene::Node {
        khr_lights_punctual: Some(KhrLightsPunctual { light }),
    };
    root.push(Node {
        name: Some("sun".to_owned()),
        extensions: Some(lights),
        rotation: Some(looking(Vector::new(-0.5, 0.6, -1.0))),
        ..Node::default()
    })
}

/// Adds a camera at the side of the first lane that sees the whole scene.
fn camera(root: &mut Root, bounds: &Bounds) -> Index<Node> {
    let middle = (bounds.min + bounds.max) / 2.0;
    let radius_m = bounds.min.distance(bounds.max) / 2.0;
    let away_m = radius_m / libm::sinf(VIEW_RAD / 2.0) * 0.6;
    let direction = Vector::new(-0.84, 0.32, -0.44).normalize();
    let place = middle - direction * away_m;
    let camera = root.push(gltf_json::Camera {
        name: Some("overview".to_owned()),
        orthographic: None,
        perspective: Some(gltf_json::camera::Perspective {
            aspect_ratio: Some(16.0 / 9.0),
            yfov: VIEW_RAD,
            zfar: Some(away_m + 4.0 * radius_m + 100.0),
            znear: 0.1,
            extensions: None,
            extras: None,
        }),
        type_: Checked::Valid(gltf_json::camera::Type::Perspective),
        extensions: None,
        extras: None,
    });
    root.push(Node {
        name: Some("overview".to_owned()),
        camera: Some(camera),
        translation: Some(place.to_array()),
        rotation: Some(looking(direction)),
        ..Node::default()
    })
}

/// Returns the rotation that turns a camera or light from its negative z axis towards `direction`, with z up.
fn looking(direction: Vector) -> UnitQuaternion {
    let turn = Rotation::look_to_rh(direction.normalize(), Vector::Z).inverse().normalize();
    UnitQuaternion(turn.to_array())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::RunControl;
    use snakes_core::save::shipped_champion;

    /// Reads a 32-bit number in little endian.
    fn number(bytes: &[u8], at: usize) -> usize {
        u32::from_le_bytes(bytes[at..at + 4].try_into().expect("four bytes")) as usize
    }

    /// Checks the chunks of a file, and returns its JSON.
    fn json_of(bytes: &[u8]) -> Root {
        assert_eq!((&bytes[..4], number(bytes, 4)), (&b"glTF"[..], 2));
        assert_eq!(number(bytes, 8), bytes.len());
        let json_length = number(bytes, 12);
        let binary = 20 + json_length;
        assert_eq!((&bytes[16..20], &bytes[binary + 4..binary + 8]), (&b"JSON"[..], &b"BIN\0"[..]));
        assert_eq!(binary + 8 + number(bytes, binary), bytes.len());
        serde_json::from_slice(&bytes[20..binary]).expect("a glTF")
    }

    #[test]
    fn a_race_has_a_lane_for_each_champion_and_every_limb_moves() {
        let mut loaded = shipped_champion().expect("well formed");
        loaded.champion.trial.duration_s = 1.0;
        let named = |name: &str| ExportedChampion {
            name: name.to_owned(),
            file: format!("{name}.ron").into(),
            loaded: loaded.clone(),
            note: None,
        };
        let champions = [named("a"), named("<b>\"")];
        let control = RunControl::default();
        let progress = ExportProgress::new(&|_| (), &control);
        let bytes = scene(&champions, &progress).expect("not cancelled").expect("in memory");
        let root = json_of(&bytes);
        let names: Vec<&str> = root.nodes.iter().filter_map(|node| node.name.as_deref()).collect();
        for name in ["a", "a, limb 1", "<b>\", limb 5", "<b>\", stairs", "ground", "overview"] {
            assert!(names.contains(&name), "{name} in {names:?}");
        }
        let limbs = names.iter().filter(|name| name.contains(", limb ")).count();
        assert_eq!((limbs, root.animations[0].channels.len()), (10, 20));
        let extras = root.asset.extras.expect("facts");
        assert!(extras.get().contains(&format!("{:016x}", loaded.champion.evaluation.trace_hash)));
        control.cancel();
        let cancelled = ExportProgress::new(&|_| (), &control);
        assert!(matches!(scene(&champions, &cancelled), Err(ExportError::Cancelled)));
    }
}
