//! Files that were opened or imported recently, for the menu.

use std::path::PathBuf;

use crate::studio::commands::files::FileQuestion;
use snakes_core::save::MAX_RECENT;

/// Files that were opened or imported recently, the latest first.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct RecentFiles(pub Vec<PathBuf>);

impl RecentFiles {
    /// Restores the files from their stored paths.
    pub fn from_texts(texts: &[String]) -> Self {
        Self(texts.iter().map(PathBuf::from).take(MAX_RECENT).collect())
    }

    /// Returns the paths as texts to store. Paths that are not valid Unicode are left out.
    pub fn to_texts(&self) -> Vec<String> {
        self.0.iter().filter_map(|path| path.to_str().map(str::to_owned)).collect()
    }

    /// Adds the files that answer a question, and removes files that do not exist any more.
    pub fn note(&mut self, question: &FileQuestion, paths: &[PathBuf]) {
        if matches!(question, FileQuestion::Export(_)) {
            return;
        }
        for path in paths.iter().rev() {
            // A path relative to the working directory could refer to another file after a restart.
            let path = std::path::absolute(path).unwrap_or_else(|_| path.clone());
            self.0.retain(|known| *known != path);
            if path.exists() {
                self.0.insert(0, path);
            }
        }
        self.0.truncate(MAX_RECENT);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_ten_files_are_remembered_once_each_and_missing_ones_are_removed() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = |number: u32| folder.path().join(format!("{number}.ron"));
        let mut recent = RecentFiles::default();
        for number in (0..12).chain([5]) {
            std::fs::write(path(number), "").expect("written");
            recent.note(&FileQuestion::Open, &[path(number)]);
        }
        recent.note(&FileQuestion::Export(Vec::new()), &[folder.path().to_owned()]);
        let expected: Vec<PathBuf> = [5, 11, 10, 9, 8, 7, 6, 4, 3, 2].map(path).into();
        assert_eq!(recent.0, expected);
        assert_eq!(RecentFiles::from_texts(&recent.to_texts()), recent);
        std::fs::remove_file(path(9)).expect("removed");
        recent.note(&FileQuestion::Import, &[path(9), path(1)]);
        let expected: Vec<PathBuf> = [1, 5, 11, 10, 8, 7, 6, 4, 3, 2].map(path).into();
        assert_eq!(recent.0, expected);
    }
}
