//! Reading and writing of champions' files.

use std::path::Path;

use super::SaveError;
use super::champion_exam::{exam_in_words, is_programs_comment};
use super::files::{Header, LARGEST_FILE_MIB, parse, pretty, read_text, single_line};
use super::same_engine::has_bits_of_this;
use super::v5::{ChampionV5, FORMAT, KIND};
use super::whole_file::write_whole;
use crate::Engine;
use crate::evolve::Champion;
use crate::score::{Recording, SuiteResult};

/// A champion read from a file.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadedChampion {
    /// Champion with its recorded evaluation.
    pub champion: Champion,
    /// Engine that recorded the champion.
    pub engine: Engine,
    /// Recorded poses. None if the file has no poses.
    pub recording: Option<Recording>,
    /// Results of the champion's exam; empty if the file has none.
    pub exam: Vec<SuiteResult>,
}

/// Reads a champion from its file.
///
/// # Errors
/// Fails if the file is unreadable, too large, damaged, of another kind or format, or has a value out of range.
pub fn load_champion(path: &Path) -> Result<LoadedChampion, SaveError> {
    parse_champion(path, &read_text(path)?)
}

/// Reads a champion, and the comment that the user wrote in the first line of the file.
///
/// # Errors
/// Fails as [`load_champion`] does.
pub fn load_champion_and_note(path: &Path) -> Result<(LoadedChampion, Option<String>), SaveError> {
    let text = read_text(path)?;
    Ok((parse_champion(path, &text)?, note(&text)))
}

/// Returns the user's comment in the first line of a champion's file. None if there is no comment, or if the program wrote it.
pub(super) fn note(text: &str) -> Option<String> {
    let comment = text.lines().next()?;
    let line = comment.strip_prefix("//")?.trim();
    let is_own = line.is_empty() || is_programs_comment(comment);
    (!is_own).then(|| single_line(line))
}

/// Bytes reserved for the comments at the top of a file.
const HEADER: u64 = 10_000;

/// Writes a champion and, if given, its recorded poses as readable text, atomically. The poses are omitted if the file would become too
/// large to be read.
///
/// # Errors
/// Fails if the file cannot be written.
pub fn store_champion(
    path: &Path,
    champion: &Champion,
    recording: Option<&Recording>,
) -> Result<(), SaveError> {
    write_champion(path, "", champion, recording, &[])
}

/// Returns the text of a champion's file. The recorded poses are omitted if the file would become too large to be read.
///
/// # Errors
/// Fails if the file would be too large even without the poses.
pub fn champion_text(
    champion: &Champion,
    recording: Option<&Recording>,
    exam: &[SuiteResult],
) -> Result<String, SaveError> {
    text_with_comments(Path::new("champion.ron"), "", champion, recording, exam)
}

pub(super) fn write_champion(
    path: &Path,
    comments: &str,
    champion: &Champion,
    recording: Option<&Recording>,
    exam: &[SuiteResult],
) -> Result<(), SaveError> {
    let text = text_with_comments(path, comments, champion, recording, exam)?;
    write_whole(path, text.as_bytes())
}

fn text_with_comments(
    path: &Path,
    comments: &str,
    champion: &Champion,
    recording: Option<&Recording>,
    exam: &[SuiteResult],
) -> Result<String, SaveError> {
    let text_with = |recording| pretty(path, &ChampionV5::new(champion.clone(), recording, exam));
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
        "// A champion of Snakes & Stairs: preset {}, seed {}, generation {}, snake {}.\n\
         // Fitness ({}): {}.\n{}\
         // Replay it exactly: snakes replay FILE (add --no-render to check it in a terminal)\n",
        origin.preset,
        origin.seed,
        origin.generation,
        origin.individual + 1,
        champion.trial.fitness.words(),
        champion.reached(),
        exam_in_words(exam).map_or_else(String::new, |words| format!("// Exam: {words}.\n")),
    );
    Ok(format!("{comments}{header}{text}"))
}

/// Reads the champion that the studio shows at its start.
///
/// # Errors
/// Fails if the embedded file is damaged, which a test prevents.
pub fn shipped_champion() -> Result<LoadedChampion, SaveError> {
    parse_champion(Path::new("climber.ron"), include_str!("../../../../saves/climber.ron"))
}

/// Parses a champion; errors name the file `path`.
///
/// # Errors
/// Fails as [`load_champion`] does, except for reading the file.
pub fn parse_champion(path: &Path, text: &str) -> Result<LoadedChampion, SaveError> {
    Header::check(path, text, KIND, FORMAT)?;
    let file: ChampionV5 = parse(path, text)?;
    let engine = Engine { version: file.engine, processors: file.processors };
    let (champion, recording, exam) = file.into_parts().map_err(SaveError::invalid(path))?;
    Ok(LoadedChampion { champion, engine, recording, exam })
}

impl LoadedChampion {
    /// Returns whether this program computes the same bits as the program that recorded the champion.
    pub fn is_of_this_engine(&self) -> bool {
        let Champion { genome, trial, .. } = &self.champion;
        has_bits_of_this(self.engine, trial.physics.engine, genome.body.is_branching())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::save::store_exam;
    use crate::score::{Behaviour, Ending, Endings, ExamSuite};
    use std::fs;

    use crate::evolve::{Origin, RunPlan, Settings, begin};
    use crate::genome::ControllerKind;
    use crate::score::{Rollout, evaluate};

    fn champion() -> Champion {
        champion_of(ControllerKind::Signal)
    }

    fn champion_of(controller: ControllerKind) -> Champion {
        let mut settings = Settings::default();
        settings.genome.controller = controller;
        settings.evolution.population = 4;
        settings.trial.duration_s = 1.0;
        let plan = RunPlan::new("test", 5, settings);
        let genome = begin(&plan).ask().remove(0).genome;
        let trial = plan.settings.trial;
        let evaluation = evaluate(&genome, &trial);
        let origin = Origin { preset: plan.preset, seed: 5, generation: 1, individual: 0 };
        Champion { genome, trial, evaluation, chosen_by: None, origin }
    }

    fn result_of(suite: ExamSuite) -> SuiteResult {
        SuiteResult {
            suite,
            trials: 5,
            landed: 4,
            disqualified: 0,
            median_steps: 10.0,
            kept: 0.7,
            each: Vec::new(),
            endings: Endings::default(),
        }
    }

    #[test]
    fn the_champions_of_the_program_are_written_with_the_bytes_that_they_have() {
        let content = |text: &str| -> String {
            let begins = text.find("\n(\n").expect("its first field");
            // Only the part before the poses is compared, because poses are rounded when they are written.
            text[begins..].split("poses:").next().unwrap_or_default().to_owned()
        };
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../saves");
        let mut count = 0;
        for entry in fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            let text = read_text(&path).expect("read");
            let LoadedChampion { champion, recording, exam, .. } =
                parse_champion(&path, &text).expect("well formed");
            let written = champion_text(&champion, recording.as_ref(), &exam).expect("small");
            assert_eq!(content(&written), content(&text), "{}", path.display());
            count += 1;
        }
        assert!(count > 20, "{count}");
    }

    #[test]
    fn a_champion_is_read_back_bit_for_bit() {
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
        assert_eq!(files, 1, "no other file is left in the folder");
    }

    #[test]
    fn r10_a_disqualified_champion_is_read_back_and_equals_its_replay() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("champion.ron");
        let mut champion = champion();
        champion.trial.health.speed_m_s = 1.0;
        champion.evaluation = evaluate(&champion.genome, &champion.trial);
        assert!(champion.evaluation.disqualified.is_some());
        store_champion(&path, &champion, None).expect("written");
        let loaded = load_champion(&path).expect("read").champion;
        assert_eq!(loaded, champion);
        assert!(evaluate(&loaded.genome, &loaded.trial).agrees_with(&loaded.evaluation));
        let healthy = champion_text(&self::champion(), None, &[]).expect("written");
        assert!(
            !healthy.contains("disqualified: Some"),
            "files of healthy champions stay as they were"
        );
    }

    #[test]
    fn only_files_of_rules_have_uses_of_waves_and_their_conditions_are_readable() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("champion.ron");
        for &controller in ControllerKind::ALL {
            let champion = champion_of(controller);
            store_champion(&path, &champion, None).expect("written");
            assert_eq!(load_champion(&path).expect("read").champion, champion);
            let text = fs::read_to_string(&path).expect("read");
            let has_rules = controller == ControllerKind::Rules;
            assert_eq!(text.contains("wave_uses"), has_rules, "{controller}");
            assert_eq!(text.contains("condition: \""), has_rules);
        }
        store_champion(&path, &champion_of(ControllerKind::Rules), None).expect("written");
        let text = fs::read_to_string(&path).expect("read");
        for (from, to, says) in [
            ("condition: \"", "condition: \"2", "condition is \"2"),
            ("wave: ", "wave: 9", "genome.rules.rules[0].wave is 9"),
            ("group: ", "group: x", "damaged"),
        ] {
            fs::write(&path, text.replacen(from, to, 1)).expect("written");
            let error = load_champion(&path).expect_err(to).to_string();
            assert!(error.contains(says), "{error}");
        }
    }

    #[test]
    fn results_of_an_exam_are_written_beside_the_users_comment_and_read_back() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("champion.ron");
        store_champion(&path, &champion(), None).expect("written");
        let text = fs::read_to_string(&path).expect("read");
        fs::write(&path, format!("// My favourite.\n{text}")).expect("written");
        let loaded = load_champion(&path).expect("read");
        let result = SuiteResult {
            each: vec![("120 Hz".to_owned(), 0.9), ("240 Hz".to_owned(), 0.7)],
            endings: Endings::of([Ending::CRASHED; 5].iter()),
            ..result_of(ExamSuite::StepRate)
        };
        // The exam is stored twice, as when it is repeated.
        for _ in 0..2 {
            store_exam(&path, &loaded, std::slice::from_ref(&result)).expect("written");
        }
        let text = fs::read_to_string(&path).expect("read");
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[0], "// My favourite.");
        assert_eq!(lines[3], "// Exam: way kept at 120 Hz 0.90, 240 Hz 0.70.");
        assert_eq!(text.matches("// Exam").count(), 1);
        let read = load_champion(&path).expect("read");
        assert_eq!((read.champion, read.exam), (loaded.champion, vec![result]));
        fs::write(&path, text.replace("landed: 4", "landed: 6")).expect("written");
        let error = load_champion(&path).expect_err("more than there were").to_string();
        assert!(error.contains("exam.landed is 6; allowed: 0 to 5"), "{error}");
    }

    #[test]
    fn an_exam_of_one_suite_keeps_the_results_of_the_others_and_never_overwrites_another_champion()
    {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("champion.ron");
        store_champion(&path, &champion(), None).expect("written");
        let text = fs::read_to_string(&path).expect("read");
        fs::write(&path, format!("// Mine.\n\n// For the lesson.\n{text}")).expect("written");
        let loaded = load_champion(&path).expect("read");
        for suite in [ExamSuite::Shove, ExamSuite::Trials] {
            store_exam(&path, &loaded, &[result_of(suite)]).expect("written");
        }
        let exam = load_champion(&path).expect("read").exam;
        assert_eq!(exam, [result_of(ExamSuite::Trials), result_of(ExamSuite::Shove)]);
        let text = fs::read_to_string(&path).expect("read");
        assert!(text.starts_with("// Mine.\n\n// For the lesson.\n// A champion of"), "{text}");
        let mut other = champion();
        other.origin.seed += 1;
        store_champion(&path, &other, None).expect("renamed to this name meanwhile");
        let shove = [result_of(ExamSuite::Shove)];
        let error = store_exam(&path, &loaded, &shove).expect_err("another one");
        assert!(error.to_string().contains("the champion that was examined"), "{error}");
        assert_eq!(load_champion(&path).expect("kept").champion, other);
    }

    #[test]
    fn the_shipped_champion_matches_its_record_and_climbs_all_steps() {
        let LoadedChampion { champion, engine, .. } = shipped_champion().expect("well formed");
        assert_eq!(engine, Engine::THIS);
        assert!(evaluate(&champion.genome, &champion.trial).agrees_with(&champion.evaluation));
        let climbed = champion.trial.stairs.steps_climbed(champion.evaluation.centre_y_m.into());
        assert_eq!(climbed, 10, "a champion to open with climbs");
        let mut rollout = Rollout::new(&champion.genome, &champion.trial);
        while rollout.advance() {}
        let at = rollout.poses()[2].translation;
        assert!(at.x.abs() < 2.5 && at.z > 5.0, "on the landing, not beside it: {at}");
    }

    #[test]
    fn a_snake_beside_the_stairs_is_not_said_to_climb_steps() {
        let mut champion = shipped_champion().expect("well formed").champion;
        let landed = champion.trial.stairs.end_y_m() - 1.0;
        for (end_m, steps_climbed, words) in [
            (5.59, 2, "climbs 2 steps"),
            (5.59, 0, "lies beside step 2 of the stairs"),
            (3.84, 0, "lies beside step 1 of the stairs"),
            (landed, 10, "stands on the landing"),
            (landed, 0, "lies beside step 10 of the stairs"),
            (landed + 2.0, 0, "lies behind the stairs"),
            (-7.23, 0, "starting position"),
        ] {
            champion.evaluation.centre_y_m = end_m;
            champion.evaluation.behaviour = Some(Behaviour { steps_climbed, ..Default::default() });
            let reached = champion.reached();
            assert!(reached.ends_with(&format!(", {words}")), "{end_m} m: {reached}");
        }
        champion.evaluation.centre_y_m = 5.59;
        champion.evaluation.behaviour = None;
        assert!(
            champion.reached().ends_with("climbs 2 steps"),
            "the distance is all that is known"
        );
    }

    /// Returns the error of `load_champion` for a champion's text after `edit`.
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
            refusal(|text| text.replace("format: 5", "format: 9")),
            &["format is 9", "allowed: 5", "newer version"],
        );
        says(
            refusal(|text| text.replace("format: 5", "format: 4")),
            &["format is 4; allowed: 5 (a version before the first release wrote this file)"],
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
