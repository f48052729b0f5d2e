//! An episode of a policy, saved as a champion: it replays to its hash in the program, in a page, in a film and in the window.

use std::path::{Path, PathBuf};

use serde_json::Value;
use snakes_core::evolve::{Champion, Origin};
use snakes_core::genome::Genome;
use snakes_core::genome::controllers::RecordedActions;
use snakes_core::save::{load_champion, store_champion};
use snakes_core::score::evaluate;

use super::program::{folder, json_lines, stdout_of};

/// Physics steps for which an action holds.
const STEPS_PER_ACTION: u32 = 4;

/// Writes an episode with the body and the world of the built-in climber into a folder. Returns its path and its trace hash. The actions are
/// target angles that no formula of a controller gives, as those of a policy that learned elsewhere.
fn episode(folder: &Path) -> (PathBuf, String) {
    let saves = Path::new(env!("CARGO_MANIFEST_DIR")).join("saves");
    let Champion { genome, trial, .. } =
        load_champion(&saves.join("climber.ron")).expect("shipped").champion;
    let joints = trial.agent.body_plan(&genome).joints.len();
    let actions = (trial.steps() / STEPS_PER_ACTION) as usize;
    let angle_rad = |index: usize| {
        let (action, axis) = (index / (2 * joints), index % (2 * joints));
        let bit = (action * 2_654_435_761 + axis * 40_503) >> 7 & 15;
        0.1 * (bit as f32 / 15.0 - 0.5) + if axis == 2 * (action / 8 % joints) { 0.4 } else { 0.0 }
    };
    let values: Vec<f32> = (0..actions * 2 * joints).map(angle_rad).collect();
    let recorded = RecordedActions {
        values: &values,
        joints,
        steps_per_action: STEPS_PER_ACTION,
        steps_per_s: trial.physics.steps_per_s,
        duration_s: trial.duration_s,
        servo: Some([300.0, 20.0]),
    };
    let genome = Genome { controller: recorded.genes(), ..genome };
    let evaluation = evaluate(&genome, &trial);
    assert_eq!(evaluation.disqualified, None);
    let origin = Origin { preset: "climb".to_owned(), seed: 7, generation: 1, individual: 0 };
    let champion = Champion { genome, trial, evaluation, chosen_by: None, origin };
    let path = folder.join("episode.ron");
    store_champion(&path, &champion, None).expect("written");
    (path, format!("{:016x}", evaluation.trace_hash))
}

#[test]
fn r10_an_episode_of_a_policy_has_its_hash_in_the_program_and_in_a_page() {
    let folder = folder();
    let (path, hash) = episode(folder.path());
    let replay = json_lines(folder.path(), "replay episode.ron --no-render --json");
    assert_eq!(
        (&replay[0]["matches"], &replay[0]["trace_hash"]),
        (&true.into(), &hash.clone().into())
    );
    let Some(mut browser) = super::exports::browser("an episode in Chromium") else { return };
    let page = folder.path().join("page.html");
    stdout_of(folder.path(), &format!("export {} -o page.html", path.display()));
    let picture = folder.path().join("page.png");
    let found = browser.arg("moment").arg(&page).args(["3", "side"]).arg(picture);
    let found: Value = serde_json::from_str(&super::exports::succeed(found)).expect("JSON");
    assert_eq!((&found["errors"], &found["check"]), (&serde_json::json!([]), &"equal".into()));
    assert!(found["text"].as_str().is_some_and(|text| text.contains(&hash)), "{found}");
}

#[cfg(all(feature = "studio", target_os = "linux"))]
#[test]
fn r10_an_episode_of_a_policy_is_shown_in_the_window_and_filmed() {
    let folder = folder();
    let (path, _) = episode(folder.path());
    let arguments = format!("replay {} --preset quick", path.display());
    let Some(studio) = super::window::Studio::open("episode", &arguments) else { return };
    // A champion that did not replay to its record would be shown as recorded.
    studio.wait_for_title("showing episode");
    assert!(!studio.title().contains("as recorded"), "{}", studio.title());
    drop(studio);
    let film = "export episode.ron -o film.gif --size 160x90 --fps 5 --end 2";
    stdout_of(folder.path(), film);
    let bytes = std::fs::read(folder.path().join("film.gif")).expect("a film");
    assert!(bytes.starts_with(b"GIF89a"), "{} bytes", bytes.len());
}
