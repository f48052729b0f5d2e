//! Wording shared by the messages of the library.

/// Names in a few words: one by itself, several counted.
pub(super) fn listed(names: &[String]) -> String {
    match names {
        [one] => one.clone(),
        several => format!("{} saves", several.len()),
    }
}

pub(super) fn capital(words: &str) -> String {
    let mut letters = words.chars();
    let first = letters.next().map(char::to_uppercase);
    first.into_iter().flatten().chain(letters).collect()
}
