//! Animated scenes, checked by the validator of Khronos.

use std::path::Path;

use super::{peer, peer_script, succeed};
use crate::program::{folder, snakes};

#[test]
fn the_khronos_validator_finds_no_error_and_no_warning() {
    let test = "the_khronos_validator_finds_no_error_and_no_warning";
    // The probe only loads the validator.
    let script = peer_script("gltf.cjs");
    let script = script.to_string_lossy();
    let Some(mut node) = peer("node", &[&script, "--probe"], test) else { return };
    let folder = folder();
    let saves = Path::new(env!("CARGO_MANIFEST_DIR")).join("saves");
    let all = ["climber", "feeler", "first-climber", "learner"];
    for (name, champions) in [("one.glb", &all[..1]), ("race.glb", &all[..])] {
        let mut export = snakes(folder.path(), "export -o");
        export
            .arg(name)
            .args(champions.iter().map(|champion| saves.join(format!("{champion}.ron"))));
        succeed(&mut export);
    }
    let files = ["one.glb", "race.glb"].map(|name| folder.path().join(name));
    let said = succeed(node.arg(&*script).args(files));
    assert_eq!(said.matches(": 0 errors, 0 warnings, ").count(), 2, "{said}");
    assert_eq!(said.matches("; 1 animations, ").count(), 2, "{said}");
}
