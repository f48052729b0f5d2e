//! The champions in `saves/`: each replays as recorded, stands on the landing unless its first line says otherwise, and uses no
//! exploit.

use std::fs;
use std::path::{Path, PathBuf};

use snakes_core::save::{LoadedChampion, load_champion};
use snakes_core::score::evaluate;

/// A climber in the report's world, which climbs three steps.
const REPORT: &str = "first-climber.ron";
/// A champion with a table that was learned by trial and error, which climbs six steps.
const LEARNER: &str = "learner.ron";

fn saves() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("saves");
    let entries = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry"));
    // Runs in this folder belong to the developer and are not part of the project.
    let mut files: Vec<PathBuf> =
        entries.map(|entry| entry.path()).filter(|path| path.is_file()).collect();
    files.sort();
    files
}

#[test]
fn every_shipped_champion_stands_on_the_landing_and_uses_no_exploit() {
    let (mut climbers, mut traces) = (0, Vec::new());
    for path in saves() {
        let name = path.file_name().expect("a name").to_string_lossy().into_owned();
        let LoadedChampion { champion, recording, .. } = load_champion(&path).expect(&name);
        assert!(recording.is_some(), "{name}");
        let seen = evaluate(&champion.genome, &champion.trial);
        assert!(seen.agrees_with(&champion.evaluation), "{name} does not replay as recorded");
        if name == REPORT {
            continue;
        }
        climbers += 1;
        traces.push(seen.trace_hash);
        let recorded = champion.evaluation;
        if name == LEARNER {
            let steps = recorded.behaviour.as_ref().map(|behaviour| behaviour.steps_climbed);
            assert_eq!(steps, Some(6), "as its first line says");
        } else {
            assert!(recorded.is_on_landing(&champion.trial.stairs), "{name}");
        }
        // The effort stays far from every limit of disqualification.
        let (effort, limits) = (recorded.effort.expect("measured"), &champion.trial.health);
        assert!(effort.joint_drift_m < 0.8 * limits.joint_drift_m, "{name}: {effort:?}");
        assert!(effort.top_speed_m_s < 0.8 * limits.speed_m_s, "{name}: {effort:?}");
        // A creature's arms may lie beside its middle from the start; blocks in a row do not.
        let at_rest = champion.body().rest_poses().into_iter().map(|pose| pose.translation.x.abs());
        let reach_m = champion.trial.stairs.width_m / 2.0 + at_rest.fold(0.0, f32::max);
        assert!(effort.sideways_m < reach_m, "{name}: {effort:?}");
        let text = fs::read_to_string(&path).expect("read");
        let line = text.lines().next().expect("a line");
        assert!(line.starts_with("// ") && line.contains("Found by: snakes "), "{name}: {line}");
    }
    assert!(climbers >= 6, "{climbers} climbers");
    traces.sort_unstable();
    traces.dedup();
    assert_eq!(traces.len(), climbers, "no two are the same");
}
