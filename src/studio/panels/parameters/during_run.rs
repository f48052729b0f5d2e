//! What may be changed while a run is under way.

/// When a change takes effect, in a sentence.
pub fn when(answer: Result<(), &'static str>) -> String {
    match answer {
        Ok(()) => "Takes effect from the next generation.".to_owned(),
        Err(reason) => format!("{}.", reason.trim_end_matches('.')),
    }
}
