//! Reading and writing champions, whichever format they are in.

use std::path::Path;

use super::SaveError;
use super::files::{Header, LARGEST_FILE_MIB, parse, pretty, read_text, write_whole};
use super::v1::ChampionV1;
use super::v2::ChampionV2;
use super::v3::{ChampionV3, KIND};
use super::v4::{ChampionV4, FORMAT};
use crate::ENGINE_VERSION;
use crate::evolve::Champion;
use crate::score::Recording;

/// A champion read from a file.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadedChampion {
    /// The champion, with what was recorded of it.
    pub champion: Champion,
    /// The engine that recorded it. Another one than [`ENGINE_VERSION`] may compute other bits.
    pub engine: u32,
    /// What it looked like there; files before format 3 do not know.
    pub recording: Option<Recording>,
}

/// Reads a champion.
///
/// # Errors
/// The file is unreadable, too large, damaged, of another kind, newer, or has a value out of range.
pub fn load_champion(path: &Path) -> Result<LoadedChampion, SaveError> {
    parse_champion(path, &read_text(path)?)
}

/// Room for the comment at the top, in bytes.
const HEADER: u64 = 10_000;

/// Writes a champion and, if known, what it looks like, so that a person can read it, whole or not at all.
/// What it looks like is left out of a file that would become too large to be read again.
///
/// # Errors
/// The file cannot be written.
pub fn store_champion(
    path: &Path,
    champion: &Champion,
    recording: Option<&Recording>,
) -> Result<(), SaveError> {
    let text_with = |recording| pretty(path, &ChampionV4::new(champion.clone(), recording));
    let is_readable = |text: &String| text.len() as u64 <= LARGEST_FILE_MIB * 1024 * 1024 - HEADER;
    let mut text = text_with(recording)?;
    if !is_readable(&text) {
        text = text_with(None)?;
    }
    if !is_readable(&text) {
        return Err(SaveError::TooLarge { path: path.to_owned(), limit_mib: LARGEST_FILE_MIB });
    }
    let origin = &champion.origin;
    let header = format!(
        "// A champion of Snakes & Stairs: preset {}, seed {}, generation {}, individual {}.\n\
         // Fitness ({}): {}.\n\
         // See it again, exactly: snakes replay FILE (with --no-render to check it in a terminal)\n",
        origin.preset,
        origin.seed,
        origin.generation,
        origin.individual,
        champion.trial.fitness.words(),
        champion.reached(),
    );
    write_whole(path, format!("{header}{text}").as_bytes())
}

/// The champion that the studio opens with.
///
/// # Errors
/// The embedded file is broken, which a test rules out.
pub fn shipped_champion() -> Result<LoadedChampion, SaveError> {
    parse_champion(Path::new("climber.ron"), include_str!("../../saves/climber.ron"))
}

/// Reads a champion from a text; `path` is what errors call it.
///
/// # Errors
/// As [`load_champion`], apart from reading.
pub fn parse_champion(path: &Path, text: &str) -> Result<LoadedChampion, SaveError> {
    let file: ChampionV4 = match Header::read(path, text, KIND, FORMAT)? {
        1 => ChampionV3::from(ChampionV2::from(parse::<ChampionV1>(path, text)?)).into(),
        2 => ChampionV3::from(parse::<ChampionV2>(path, text)?).into(),
        3 => parse::<ChampionV3>(path, text)?.into(),
        _ => parse(path, text)?,
    };
    let engine = file.engine;
    let (champion, recording) =
        file.into_parts().map_err(|source| SaveError::Invalid { path: path.to_owned(), source })?;
    Ok(LoadedChampion { champion, engine, recording })
}

impl LoadedChampion {
    /// Whether this program computes the same bits as the one that recorded the champion.
    pub fn is_of_this_engine(&self) -> bool {
        self.engine == ENGINE_VERSION
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    use crate::evolve::{RunPlan, Settings};
    use crate::run::{Control, Experiment, pool};
    use crate::score::{Rollout, evaluate};

    fn champion() -> Champion {
        let mut settings = Settings::default();
        settings.evolution.population = 4;
        settings.trial.duration_s = 1.0;
        let mut experiment = Experiment::new(RunPlan::new("test", 5, settings));
        let report = experiment.run_generation(&pool(1).expect("a pool"), &Control::default());
        report.expect("not cancelled").champion.expect("somebody was healthy")
    }

    #[test]
    fn a_champion_comes_back_from_its_file_in_every_bit() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("champion.ron");
        let champion = champion();
        let recording = Recording::of(&champion.genome, &champion.trial);
        store_champion(&path, &champion, Some(&recording)).expect("written");
        let loaded = load_champion(&path).expect("read");
        assert_eq!(loaded.champion, champion);
        let frames = loaded.recording.as_ref().expect("recorded").frames().len();
        assert_eq!(frames, recording.frames().len());
        assert!(loaded.is_of_this_engine());
        let files = fs::read_dir(folder.path()).expect("a folder").count();
        assert_eq!(files, 1, "and nothing else is left in the folder");
    }

    #[test]
    fn the_shipped_champion_does_what_it_did_when_it_was_found() {
        let LoadedChampion { champion, engine, .. } = shipped_champion().expect("well formed");
        assert_eq!(engine, ENGINE_VERSION);
        assert!(evaluate(&champion.genome, &champion.trial).agrees_with(&champion.evaluation));
        let climbed = champion.trial.stairs.steps_climbed(champion.evaluation.centre_y_m.into());
        assert_eq!(climbed, 10, "a champion to open with climbs");
        let mut rollout = Rollout::new(&champion.genome, &champion.trial);
        while rollout.advance() {}
        let at = rollout.poses()[2].translation;
        assert!(at.x.abs() < 2.5 && at.z > 5.0, "on the landing, not beside it: {at}");
    }

    #[test]
    fn a_file_of_format_1_loads_for_ever() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/saves/format-1.ron");
        let LoadedChampion { champion, engine, .. } = load_champion(&path).expect("it loads");
        assert_eq!(engine, 1);
        assert_eq!(champion.trial.surface, crate::world::Surface::default());
        assert_eq!(champion.trial.ground, None);
        assert_eq!(champion.trial.agent, crate::score::AgentSettings::default());
        assert!((champion.evaluation.fitness - 10.89).abs() < 0.01);
        assert_eq!(champion.genome.controller.joints(), 4);
    }

    #[test]
    fn a_file_of_format_2_loads_for_ever_and_does_what_it_did() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/saves/format-2.ron");
        let loaded = load_champion(&path).expect("it loads");
        assert_eq!((loaded.engine, loaded.recording), (2, None));
        let Champion { genome, trial, evaluation, .. } = loaded.champion;
        assert_eq!(evaluation.effort, None, "not measured then");
        assert!(evaluate(&genome, &trial).agrees_with(&evaluation));
    }

    #[test]
    fn a_file_of_format_3_loads_for_ever_and_does_what_it_did() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/saves/format-3.ron");
        let loaded = load_champion(&path).expect("it loads");
        assert_eq!(loaded.engine, 2);
        assert!(loaded.recording.is_some());
        let Champion { genome, trial, evaluation, .. } = loaded.champion;
        assert_eq!(evaluation.behaviour, None, "not observed then");
        assert!(evaluation.effort.is_some());
        assert!(evaluate(&genome, &trial).agrees_with(&evaluation));
    }

    /// What `load_champion` says to a champion's text after `edit`.
    fn refusal(edit: impl FnOnce(String) -> String) -> String {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("champion.ron");
        store_champion(&path, &champion(), None).expect("written");
        let text = fs::read_to_string(&path).expect("read");
        let edited = edit(text.clone());
        assert_ne!(text, edited, "the edit did nothing");
        fs::write(&path, edited).expect("written");
        let message = load_champion(&path).expect_err("refused").to_string();
        assert_eq!(message.lines().count(), 1, "{message}");
        message
    }

    #[test]
    fn a_bad_champion_is_refused_with_field_value_and_range() {
        let says = |message: String, parts: &[&str]| {
            parts.iter().for_each(|part| assert!(message.contains(part), "{part:?} in {message}"));
        };
        says(refusal(|text| text[..text.len() / 2].to_owned()), &["damaged or incomplete at line"]);
        says(
            refusal(|text| text.replace("format: 4", "format: 9")),
            &["format is 9", "allowed: 1 to 4", "newer version"],
        );
        says(
            refusal(|text| text.replace("snakes-and-stairs champion", "chess opening")),
            &["kind is \"chess opening\"", "allowed: \"snakes-and-stairs champion\""],
        );
        says(
            refusal(|text| text.replace("duration_s: 1.0", "duration_s: -1.0")),
            &["trial.duration_s is -1", "allowed: 0.1 to 600"],
        );
        says(
            refusal(|text| text.replace("limbs: 5", "limbs: 6")),
            &["genome.controller joints is 4 joints", "allowed: 5"],
        );
        says(
            refusal(|text| text.replace("friction: 1.0", "friction: NaN")),
            &["trial.surface.friction is NaN", "allowed: 0 to 1000"],
        );
    }
}
