//! The user's preferences for the window: format 1. They cannot change the bits of a run.
//!
//! An unreadable file is renamed and reported, and the window opens with the defaults.

use std::fs;
use std::path::{Path, PathBuf};

use directories::ProjectDirs;
use serde::{Deserialize, Serialize};

use super::SaveError;
use super::files::{Header, parse, read_text, store_ron};
use super::replaced::followed;
use super::whole_file::prepare_folder;
use crate::check::{Invalid, quoted, within};

const KIND: &str = "snakes-and-stairs preferences";
const FORMAT: u32 = 1;
/// Scales of the panels that the user can choose.
pub const UI_SCALES: [f32; 8] = [0.75, 0.9, 1.0, 1.1, 1.25, 1.5, 1.75, 2.0];
/// Maximum number of recently opened files that are stored.
pub const MAX_RECENT: usize = 10;
/// Maximum length of a file's path, in bytes.
const LONGEST_PATH: usize = 4096;
/// Maximum length of a server's address, in bytes.
pub const LONGEST_ADDRESS: usize = 1000;
/// Maximum length of the panels' layout, in bytes.
const LONGEST_LAYOUT: usize = 100_000;

/// The user's preferences for the window.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Preferences {
    /// Name of the colour theme: see `THEMES`.
    pub theme: String,
    /// Scale of the panels: see [`UI_SCALES`].
    pub ui_scale: f32,
    /// Size of the window, in logical pixels. None: the default.
    pub window_size: Option<(u32, u32)>,
    /// Layout of the panels, in the studio's own text form. Empty: the default.
    pub layout: String,
    /// Names of the overlays that are drawn over the scene.
    pub overlays: Vec<String>,
    /// Playback speed, in simulated seconds per second.
    pub speed: f32,
    /// Whether playback repeats at the end.
    pub loops: bool,
    /// Name of the quality of the picture: see [`QUALITIES`]. None: the studio decides by the machine.
    pub quality: Option<String>,
    /// Whether the tour was finished or skipped.
    pub tour_is_over: bool,
    /// Paths of the recently opened or imported files, the latest first.
    pub recent: Vec<String>,
    /// Titles of the sections whose advanced settings are shown.
    pub unfolded: Vec<String>,
    /// Titles of the lessons whose conclusion was reached.
    pub finished_lessons: Vec<String>,
    /// Address of the last used server, without a password; empty if none was used.
    pub server: String,
}

impl Default for Preferences {
    fn default() -> Self {
        Self {
            theme: "light".to_owned(),
            ui_scale: 1.0,
            window_size: None,
            layout: String::new(),
            overlays: Vec::new(),
            speed: 1.0,
            loops: true,
            quality: None,
            tour_is_over: false,
            recent: Vec::new(),
            unfolded: Vec::new(),
            finished_lessons: Vec::new(),
            server: String::new(),
        }
    }
}

/// Names of the colour themes.
pub const THEMES: [&str; 2] = ["light", "dark"];
/// Names of the steps of the picture's quality, the cheapest first.
pub const QUALITIES: [&str; 3] = ["fast", "smooth", "beautiful"];

impl Preferences {
    /// Checks every field against its range.
    ///
    /// # Errors
    /// Names the first field that is out of its range.
    pub fn check(&self) -> Result<(), Invalid> {
        if !THEMES.contains(&self.theme.as_str()) {
            return Err(Invalid::new("theme", quoted(&self.theme), "light, dark"));
        }
        if let Some(quality) = self.quality.as_deref().filter(|name| !QUALITIES.contains(name)) {
            return Err(Invalid::new("quality", quoted(quality), QUALITIES.join(", ")));
        }
        within("ui_scale", self.ui_scale, UI_SCALES[0]..=UI_SCALES[UI_SCALES.len() - 1])?;
        if let Some((width, height)) = self.window_size {
            within("window_size.0", width, 320..=16_384)?;
            within("window_size.1", height, 240..=16_384)?;
        }
        within("layout", self.layout.len(), 0..=LONGEST_LAYOUT)?;
        within("server", self.server.len(), 0..=LONGEST_ADDRESS)?;
        within("unfolded", self.unfolded.len(), 0..=100)?;
        within("finished_lessons", self.finished_lessons.len(), 0..=100)?;
        within("overlays", self.overlays.len(), 0..=20)?;
        within("recent", self.recent.len(), 0..=MAX_RECENT)?;
        for path in &self.recent {
            within("recent", path.len(), 1..=LONGEST_PATH)?;
        }
        within("speed", self.speed, 0.01..=100.0)
    }
}

/// Path of the file of preferences. None: preferences are neither read nor written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PreferencesFile(Option<PathBuf>);

#[derive(Serialize, Deserialize)]
struct PreferencesContents {
    kind: String,
    format: u32,
    preferences: Preferences,
}

impl PreferencesFile {
    /// Returns the file in the platform's folder for settings. It has no path if the platform has no such folder.
    pub fn find() -> Self {
        let folders = ProjectDirs::from("", "", "snakes-and-stairs");
        let folders = folders.filter(|folders| folders.config_dir().is_absolute());
        Self(folders.map(|folders| folders.config_dir().join("studio.ron")))
    }

    /// Returns the file at a path.
    pub fn at(path: &Path) -> Self {
        Self(Some(path.to_owned()))
    }

    /// Returns a file without a path: every window opens with the defaults.
    pub fn nowhere() -> Self {
        Self(None)
    }

    /// Reads the preferences. None if the file does not exist.
    ///
    /// # Errors
    /// Fails if the file exists but cannot be read, or if a value in it is not allowed.
    pub fn load(&self) -> Result<Option<Preferences>, SaveError> {
        let Some(path) = self.0.as_deref().filter(|path| path.symlink_metadata().is_ok()) else {
            return Ok(None);
        };
        let text = read_text(path)?;
        Header::check(path, &text, KIND, FORMAT)?;
        let PreferencesContents { preferences, .. } = parse(path, &text)?;
        preferences.check().map_err(SaveError::invalid(path))?;
        Ok(Some(preferences))
    }

    /// Renames an unreadable file, so that it is not overwritten. Links to it stay. Returns its new path.
    pub fn put_aside(&self) -> Option<PathBuf> {
        let path = followed(self.0.as_deref()?).ok()?;
        let aside = path.with_extension("ron.unreadable");
        fs::rename(&path, &aside).ok().map(|()| aside)
    }

    /// Writes the preferences atomically.
    ///
    /// # Errors
    /// Fails if the file or its folder cannot be written.
    pub fn store(&self, preferences: &Preferences) -> Result<(), SaveError> {
        let Some(path) = &self.0 else { return Ok(()) };
        if let Some(folder) = path.parent() {
            prepare_folder(folder)?;
        }
        let kind = KIND.to_owned();
        let file = PreferencesContents { kind, format: FORMAT, preferences: preferences.clone() };
        store_ron(path, &file)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn preferences_are_read_back_and_missing_fields_have_their_defaults() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("deep/studio.ron");
        let file = PreferencesFile::at(&path);
        assert_eq!(file.load().expect("no file is no error"), None);
        let chosen = Preferences {
            ui_scale: 1.5,
            theme: "dark".to_owned(),
            quality: Some("smooth".to_owned()),
            ..Preferences::default()
        };
        file.store(&chosen).expect("written");
        assert_eq!(file.load().expect("read"), Some(chosen));
        let short = format!("(kind: \"{KIND}\", format: 1, preferences: (ui_scale: 1.25))");
        fs::write(&path, short).expect("written");
        let read = file.load().expect("read").expect("there");
        assert_eq!(read, Preferences { ui_scale: 1.25, ..Preferences::default() });
    }

    #[test]
    fn an_unreadable_file_is_reported_and_renamed() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("studio.ron");
        let file = PreferencesFile::at(&path);
        for (text, message) in [
            ("(", "damaged or incomplete"),
            ("(kind: \"x\", format: 1)", "kind is \"x\""),
            (
                "(kind: \"snakes-and-stairs preferences\", format: 1, preferences: (ui_scale: 99))",
                "ui_scale is 99; allowed: 0.75 to 2",
            ),
        ] {
            fs::write(&path, text).expect("written");
            let error = file.load().expect_err("refused").to_string();
            assert!(error.contains(message), "{error}");
            let aside = file.put_aside().expect("renamed");
            assert_eq!(fs::read_to_string(aside).expect("there"), text);
            assert!(!path.exists());
        }
    }

    #[test]
    fn without_a_file_nothing_is_written() {
        let file = PreferencesFile::nowhere();
        file.store(&Preferences::default()).expect("nothing to do");
        assert_eq!(file.load().expect("nothing"), None);
    }
}
