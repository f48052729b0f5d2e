//! Reasons why a library entry cannot be read, in few words for its row and in a sentence for its details.

use crate::save::SaveError;

/// Reason why a library entry cannot be read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct EntryProblem {
    /// A few words for a row of the list, such as "damaged".
    pub words: &'static str,
    /// Whole reason, in one line.
    pub message: String,
}

impl EntryProblem {
    /// Makes the problem of a damaged entry.
    pub fn damaged(message: &str) -> Self {
        Self { words: "damaged", message: message.to_owned() }
    }
}

impl From<SaveError> for EntryProblem {
    fn from(error: SaveError) -> Self {
        let words = match &error {
            SaveError::OtherFormat { found, supported, .. } if found > supported => {
                "from a newer version"
            }
            SaveError::OtherFormat { .. } => "from an old version",
            SaveError::Unreadable { .. } => "cannot be read",
            SaveError::TooLarge { .. } => "too large",
            SaveError::Foreign { .. } => "another kind of file",
            _ => "damaged",
        };
        Self { words, message: error.to_string() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::save::library::fixtures::{champion_in, run_in, saves};
    use crate::save::library::{SavePlace, read_entry};
    use std::fs;

    #[test]
    fn a_file_of_a_newer_version_is_told_from_a_damaged_one() {
        let (folder, saves) = saves();
        champion_in(&saves, "good");
        let good = fs::read_to_string(folder.path().join("good.ron")).expect("read");
        for (name, text, words) in [
            ("newer", good.replacen("format: 5", "format: 99", 1), "from a newer version"),
            ("older", good.replacen("format: 5", "format: 1", 1), "from an old version"),
            ("cut", good[..good.len() / 2].to_owned(), "damaged"),
            ("other", "(kind: \"a recipe\", format: 1)".to_owned(), "another kind of file"),
        ] {
            let path = folder.path().join(format!("{name}.ron"));
            fs::write(&path, text).expect("written");
            let error = read_entry(&SavePlace::Champion(path)).expect_err("not readable");
            assert_eq!(EntryProblem::from(error).words, words, "{name}");
        }
        let run = run_in(&saves, 1);
        let plan = run.path().expect("a folder").join("run.ron");
        let text = fs::read_to_string(&plan).expect("read");
        let format = text.split("format: ").nth(1).and_then(|rest| rest.split(',').next());
        let format = format!("format: {}", format.expect("stated"));
        fs::write(&plan, text.replacen(&format, "format: 99", 1)).expect("written");
        let error = read_entry(&run).expect_err("newer");
        assert_eq!(EntryProblem::from(error).words, "from a newer version");
    }
}
