//! Names of library entries.

use std::path::{Path, PathBuf};

use crate::check::{self, Invalid, quoted};
use crate::save::notes::{MAX_NAME_CHARS, check_run_name};

/// Maximum length of a name, in bytes. With a number and an extension it is still a valid file name on every system.
const MAX_NAME_BYTES: usize = 200;
/// Extension of a champion's file.
pub const ENDING: &str = "ron";

/// Extension of the notes beside a champion's file. It differs from that of champions, which the library lists.
pub const NOTES_ENDING: &str = "about";

/// Returns the path of the notes beside a champion's file.
pub fn notes_beside(champion: &Path) -> PathBuf {
    champion.with_extension(NOTES_ENDING)
}

/// Characters that a file's name must not have: separators of paths, and characters that Windows does not allow. The same names are allowed
/// on all systems, because champions are shared between them.
const NOT_IN_NAMES: &str = "/\\<>:\"|?*";

/// Checks a name: a file on every system can have it, and it can neither lead to another folder nor make a hidden file.
///
/// # Errors
/// Fails if the name is empty or too long, begins or ends with a dot, has a slash, another forbidden character or a control character, or
/// is the name of a device of Windows.
pub fn check_entry_name(name: &str) -> Result<(), Invalid> {
    let invalid = |value: String, allowed: &str| Err(Invalid::new("name", value, allowed));
    check_run_name(name)?;
    if name.len() > MAX_NAME_BYTES {
        let allowed = format!("up to {MAX_NAME_BYTES} bytes");
        return invalid(format!("{} bytes long", name.len()), &allowed);
    }
    if name.starts_with('.') {
        return invalid(quoted(name), "a name that does not begin with a dot");
    }
    if name.contains(|c| NOT_IN_NAMES.contains(c)) {
        let allowed = "a name without the characters / \\ < > : \" | ? *";
        return invalid(quoted(name), allowed);
    }
    if name.ends_with('.') {
        return invalid(quoted(name), "a name that does not end with a dot");
    }
    check::no_device("name", name)
}

/// Returns the allowed name that is most similar to `name`.
pub fn plain_name(name: &str) -> String {
    let is_allowed = |c: &char| !c.is_control() && !NOT_IN_NAMES.contains(*c);
    let plain: String = name.chars().filter(is_allowed).collect();
    let short = shortened(plain.trim_start_matches(|c: char| c == '.' || c.is_whitespace()), "");
    match short.split_once('.') {
        _ if short.is_empty() => "imported".to_owned(),
        Some((device, rest)) if check::no_device("name", device).is_err() => {
            shortened(&format!("{device}_.{rest}"), "")
        }
        None if check::no_device("name", &short).is_err() => short + "_",
        _ => short,
    }
}

/// Returns a name with `added` appended. The end of the name is cut off if the result would be too long.
pub fn shortened(name: &str, added: &str) -> String {
    let fits = |text: &str| {
        text.chars().count() + added.chars().count() <= MAX_NAME_CHARS
            && text.len() + added.len() <= MAX_NAME_BYTES
    };
    let mut kept = name;
    while let Some((last, _)) = kept.char_indices().next_back().filter(|_| !fits(kept)) {
        kept = &kept[..last];
    }
    kept.trim_end_matches(|c: char| c == '.' || c.is_whitespace()).to_owned() + added
}

/// Returns the first free path in a folder: the name, then the name with 2, 3 and so on.
pub fn free_path(folder: &Path, name: &str, ending: Option<&str>) -> PathBuf {
    let path = |number: u32| {
        let number = if number > 1 { format!(" {number}") } else { String::new() };
        let name = shortened(name, &number);
        folder.join(ending.map_or(name.clone(), |ending| format!("{name}.{ending}")))
    };
    let mut free = (1..=u32::MAX).map(path).filter(|path| is_free(path, ending.is_none()));
    free.next().unwrap_or_else(|| path(0))
}

/// Returns whether a path is free for a new folder, or for a new file. Notes of a removed file may remain; they must not become notes of
/// a new file.
pub fn is_free(path: &Path, is_folder: bool) -> bool {
    let is_missing = |path: &Path| path.symlink_metadata().is_err();
    is_missing(path) && (is_folder || is_missing(&notes_beside(path)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_that_is_a_path_hidden_or_too_long_is_refused_with_the_reason() {
        for good in [
            "climber",
            "My best one, no. 2",
            "Schlange ü",
            "x.y",
            "com10",
            "conic",
            &"é".repeat(100),
        ] {
            assert_eq!(check_entry_name(good), Ok(()), "{good}");
        }
        for (bad, message) in [
            ("", "name is 0 characters long; allowed: 1 to 100 characters"),
            (&"x".repeat(300), "name is 300 characters long; allowed: 1 to 100 characters"),
            (&"龍".repeat(90), "name is 270 bytes long; allowed: up to 200 bytes"),
            ("../up", "name is \"../up\"; allowed: a name that does not begin with a dot"),
            ("a/b", "name is \"a/b\"; allowed: a name without the characters / \\ < > : \" | ? *"),
            (
                "a\\b",
                "name is \"a\\\\b\"; allowed: a name without the characters / \\ < > : \" | ? *",
            ),
            (
                "a: b",
                "name is \"a: b\"; allowed: a name without the characters / \\ < > : \" | ? *",
            ),
            (
                "what?",
                "name is \"what?\"; allowed: a name without the characters / \\ < > : \" | ? *",
            ),
            ("end.", "name is \"end.\"; allowed: a name that does not end with a dot"),
            ("con", "name is \"con\"; allowed: a name that Windows does not keep for a device"),
            (
                "Nul.best",
                "name is \"Nul.best\"; allowed: a name that Windows does not keep for a device",
            ),
            ("COM1", "name is \"COM1\"; allowed: a name that Windows does not keep for a device"),
            (".hidden", "name is \".hidden\"; allowed: a name that does not begin with a dot"),
            (
                "a\nb",
                "name is \"a\\nb\"; allowed: a name without line breaks and control characters",
            ),
            (" a", "name is \" a\"; allowed: a name without spaces at its ends"),
        ] {
            assert_eq!(check_entry_name(bad).expect_err("refused").to_string(), message);
        }
    }

    #[test]
    fn any_name_is_turned_into_an_allowed_one() {
        let (long, wide) = ("x".repeat(300), "龍".repeat(300));
        let dots = format!("{}{}", "y".repeat(99), "...");
        for odd in [
            "",
            "...",
            "a/../b",
            " .x ",
            "a\u{7}b",
            "x. .",
            "con",
            "nul.ron",
            "aux .b",
            "LPT9.",
            "a<b>c:d\"|?*",
            &wide,
            &long,
            &dots,
        ] {
            let plain = plain_name(odd);
            assert_eq!(check_entry_name(&plain), Ok(()), "{odd:?} became {plain:?}");
            assert_eq!(check_entry_name(&shortened(&plain, " copy 12")), Ok(()));
        }
        assert_eq!(plain_name("my champion"), "my champion");
        assert_eq!(plain_name("con.x"), "con_.x");
    }
}
