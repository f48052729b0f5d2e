//! Results of an exam in a champion's file.

use std::path::Path;

use super::SaveError;
use super::champion::{LoadedChampion, parse_champion, write_champion};
use super::files::read_text;
use super::replaced::Replaced;
use crate::Engine;
use crate::check::Invalid;
use crate::schema::Choices;
use crate::score::{ExamSuite, SuiteResult};

/// Writes the results of an exam into a champion's file, atomically. Results of other suites, and lines that the user wrote above the
/// champion, are kept.
///
/// # Errors
/// Fails if another engine recorded the champion, if the file now has another champion, or if it cannot be read or written.
pub fn store_exam(
    path: &Path,
    loaded: &LoadedChampion,
    exam: &[SuiteResult],
) -> Result<(), SaveError> {
    check_examinable(path, loaded)?;
    let text = read_text(path)?;
    // The file is compared with the examined champion, because it may have been renamed or replaced during a long exam.
    let present = parse_champion(path, &text)?;
    if present.champion != loaded.champion {
        let allowed = "the champion that was examined";
        let source = Invalid::new("champion", "another one by now", allowed);
        return Err(SaveError::Invalid { path: path.to_owned(), source });
    }
    let above = text.lines().take_while(|line| !line.starts_with('('));
    let own = above.filter(|line| !is_programs_comment(line));
    let own: String = own.map(|line| format!("{line}\n")).collect();
    let is_new = |earlier: &SuiteResult| exam.iter().any(|result| result.suite == earlier.suite);
    let mut all = present.exam;
    all.retain(|earlier| !is_new(earlier));
    all.extend_from_slice(exam);
    all.sort_by_key(|result| result.suite);
    write_champion(path, &own, &present.champion, present.recording.as_ref(), &all)
}

/// Checks that the file of a champion may get results of an exam: this engine must have recorded the champion, and the file must not be
/// write-protected.
///
/// # Errors
/// Fails if another engine recorded the champion, or if the file is write-protected.
pub fn check_examinable(path: &Path, loaded: &LoadedChampion) -> Result<(), SaveError> {
    if loaded.is_of_this_engine() {
        return Replaced::file_at(path).map(drop).map_err(SaveError::unwritable(path));
    }
    let allowed = format!("{}, to write results of an exam beside its record", Engine::THIS);
    let source = Invalid::new("engine", loaded.engine.to_string(), allowed);
    Err(SaveError::Invalid { path: path.to_owned(), source })
}

/// Returns whether the program writes comments that begin like this line at the top of a champion's file.
pub(super) fn is_programs_comment(line: &str) -> bool {
    ["// A champion of Snakes & Stairs", "// Fitness (", "// Exam:", "// Replay it exactly"]
        .iter()
        .any(|start| line.starts_with(start))
}

/// Describes the results of an exam in one line. None if there are no results.
pub fn exam_in_words(exam: &[SuiteResult]) -> Option<String> {
    let words = exam.iter().map(|result| {
        let name = result.suite.choice().title.to_lowercase();
        if result.suite == ExamSuite::HeldOut {
            let classes = result.classes();
            let each =
                classes.iter().map(|(class, landed, of)| format!("{class} {landed} of {of}"));
            let each: Vec<String> = each.collect();
            return format!(
                "{name} {} of {} climbed ({})",
                result.landed,
                result.trials,
                each.join(", ")
            );
        }
        if result.each.is_empty() {
            return format!("{name} {} of {} climbed", result.landed, result.trials);
        }
        let each = result.each.iter().map(|(label, kept)| format!("{label} {kept:.2}"));
        format!("way kept at {}", each.collect::<Vec<_>>().join(", "))
    });
    (!exam.is_empty()).then(|| words.collect::<Vec<_>>().join("; "))
}
