//! Work that is lost if the program ends now. The run is not, because every finished generation is saved.

use super::body_editor::BodyEditor;
use super::library::Library;
use super::shares::Shares;
use super::stairs_exams::StairsExams;

/// Returns a sentence for each piece of work that is lost if the program ends now.
pub(crate) fn unfinished(
    shares: &Shares,
    exams: &StairsExams,
    bodies: &BodyEditor,
    library: &Library,
) -> Vec<String> {
    let share = shares.progress().map(|of| format!("A file is being written: {}.", of.in_words()));
    let exam = exams.progress().map(|(name, [done, all])| {
        format!("{name} is being examined on other stairs: {done} of {all} trials are done.")
    });
    let body = bodies.edited().filter(|of| of.steps != [false; 2] || of.tuning.is_some());
    let body = body.map(|of| format!("The changed body of {} is not saved.", of.original.name()));
    let batches = library.under_way().map(|(words, _)| format!("{words} saves is in progress."));
    share.into_iter().chain(exam).chain(body).chain(batches).collect()
}
