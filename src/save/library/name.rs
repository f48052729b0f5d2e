//! What an entry may be called.

use std::path::{Path, PathBuf};

use crate::check::Invalid;

/// The longest name, in characters.
pub const LONGEST_NAME: usize = 100;
/// The longest name, in bytes: with a number and an ending it is still a file's name everywhere.
const LONGEST_NAME_BYTES: usize = 200;
/// The ending of a champion's file.
pub const ENDING: &str = "ron";

/// Accepts what an entry may be called: it can neither leave its folder nor hide in it.
///
/// # Errors
/// The name is empty or too long, begins with a dot, or has a slash or a control character in it.
pub fn check_entry_name(name: &str) -> Result<(), Invalid> {
    let invalid = |value: String, allowed: &str| Err(Invalid::new("name", value, allowed));
    let characters = name.chars().count();
    let start: String = name.chars().filter(|c| !c.is_control()).take(60).collect();
    if !(1..=LONGEST_NAME).contains(&characters) {
        let allowed = format!("1 to {LONGEST_NAME} characters");
        return invalid(format!("{characters} characters long"), &allowed);
    }
    if name.len() > LONGEST_NAME_BYTES {
        let allowed = format!("up to {LONGEST_NAME_BYTES} bytes");
        return invalid(format!("{} bytes long", name.len()), &allowed);
    }
    if name.starts_with('.') {
        return invalid(format!("{start:?}"), "a name that does not begin with a dot");
    }
    if name.contains(['/', '\\']) {
        return invalid(format!("{start:?}"), "a name without slashes");
    }
    if name.chars().any(char::is_control) {
        return invalid(format!("{start:?}"), "a name without line breaks and control characters");
    }
    if name.trim() != name {
        return invalid(format!("{start:?}"), "a name without spaces at its ends");
    }
    Ok(())
}

/// A name that is allowed, as near as possible to one from elsewhere.
pub fn plain_name(name: &str) -> String {
    let plain: String = name.chars().filter(|c| !c.is_control() && !"/\\".contains(*c)).collect();
    let short = shortened(plain.trim().trim_start_matches('.').trim_start(), "");
    if short.is_empty() { "imported".to_owned() } else { short }
}

/// A name with something added to it, at the expense of its own end if it would become too long.
pub fn shortened(name: &str, added: &str) -> String {
    let fits = |text: &str| {
        text.chars().count() + added.chars().count() <= LONGEST_NAME
            && text.len() + added.len() <= LONGEST_NAME_BYTES
    };
    let mut kept = name;
    while let Some((last, _)) = kept.char_indices().next_back().filter(|_| !fits(kept)) {
        kept = &kept[..last];
    }
    kept.trim_end().to_owned() + added
}

/// The first path in a folder that is not taken: the name, then the name and 2, and so on.
pub fn free_path(folder: &Path, name: &str, ending: Option<&str>) -> PathBuf {
    let path = |number: u32| {
        let number = if number > 1 { format!(" {number}") } else { String::new() };
        let name = shortened(name, &number);
        folder.join(ending.map_or(name.clone(), |ending| format!("{name}.{ending}")))
    };
    let mut free = (1..=u32::MAX).map(path).filter(|path| path.symlink_metadata().is_err());
    free.next().unwrap_or_else(|| path(0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_that_leaves_its_folder_hides_or_is_too_long_is_refused_with_the_reason() {
        for good in ["climber", "My best one, no. 2", "Schlange ü", "x.y", &"é".repeat(100)] {
            assert_eq!(check_entry_name(good), Ok(()), "{good}");
        }
        for (bad, message) in [
            ("", "name is 0 characters long; allowed: 1 to 100 characters"),
            (&"x".repeat(300), "name is 300 characters long; allowed: 1 to 100 characters"),
            (&"龍".repeat(90), "name is 270 bytes long; allowed: up to 200 bytes"),
            ("../up", "name is \"../up\"; allowed: a name that does not begin with a dot"),
            ("a/b", "name is \"a/b\"; allowed: a name without slashes"),
            ("a\\b", "name is \"a\\\\b\"; allowed: a name without slashes"),
            (".hidden", "name is \".hidden\"; allowed: a name that does not begin with a dot"),
            ("a\nb", "name is \"ab\"; allowed: a name without line breaks and control characters"),
            (" a", "name is \" a\"; allowed: a name without spaces at its ends"),
        ] {
            assert_eq!(check_entry_name(bad).expect_err("refused").to_string(), message);
        }
    }

    #[test]
    fn whatever_a_file_is_called_elsewhere_it_gets_a_name_that_is_allowed() {
        for odd in ["", "...", "a/../b", " .x ", "a\u{7}b", &"龍".repeat(300), &"x".repeat(300)] {
            let plain = plain_name(odd);
            assert_eq!(check_entry_name(&plain), Ok(()), "{odd:?} became {plain:?}");
            assert_eq!(check_entry_name(&shortened(&plain, " copy 12")), Ok(()));
        }
        assert_eq!(plain_name("my champion"), "my champion");
    }
}
