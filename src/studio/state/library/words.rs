//! Wording of the library's messages.

/// One name, or the number of several.
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
