//! The user's own presets: files in the folder `presets` within the saves, named after their presets.

use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use super::files::{read_bytes, refuse_link, text_of};
use super::preset::{Preset, parse_preset, shipped_preset_names, store_new_preset};
use super::whole_file::prepare_folder;
use super::{SaveError, SavesFolder};
use crate::check::{self, Invalid};

/// A file in the folder of the user's own presets.
#[derive(Debug, Clone, PartialEq)]
pub struct OwnPreset {
    /// The file's name without its ending.
    pub name: String,
    /// The preset under that name, or the error in one line.
    pub preset: Result<Preset, String>,
}

/// Maximum number of own presets that are listed.
const MAX_OWN_PRESETS: usize = 200;
/// Maximum size of an own preset, in MiB; a shipped one has about 3 KiB.
const LARGEST_MIB: u64 = 1;

impl SavesFolder {
    /// Its folder for the user's own presets.
    #[must_use]
    pub fn presets(&self) -> PathBuf {
        self.path().join("presets")
    }

    /// The user's own presets by name, damaged ones included; none if their folder does not exist.
    pub fn own_presets(&self) -> Vec<OwnPreset> {
        let Ok(entries) = fs::read_dir(self.presets()) else { return Vec::new() };
        let mut names: Vec<String> = entries
            .flatten()
            .filter_map(|entry| Some(entry.file_name().to_str()?.strip_suffix(".ron")?.to_owned()))
            // The names of incomplete files begin with a dot.
            .filter(|name| !name.starts_with('.'))
            .collect();
        names.sort();
        names.truncate(MAX_OWN_PRESETS);
        let read = |name: String| {
            let preset = read_own(&self.own_preset_path(&name), &name);
            OwnPreset { name, preset: preset.map_err(|error| error.to_string()) }
        };
        names.into_iter().map(read).collect()
    }

    /// Adds a preset to the user's own; never overwrites one.
    ///
    /// # Errors
    /// The name is not allowed or taken, or the file cannot be written.
    pub fn store_own_preset(&self, preset: &Preset) -> Result<PathBuf, SaveError> {
        let path = self.own_preset_path(&preset.name);
        let invalid = |source| SaveError::Invalid { path: self.presets(), source };
        check_own_name(&preset.name).map_err(invalid)?;
        prepare_folder(&self.presets())?;
        // Writing itself checks that the name is free: another program may take it at any time.
        store_new_preset(&path, preset).map_err(|error| match error {
            SaveError::Unwritable { path, source } if source.kind() == ErrorKind::AlreadyExists => {
                let source = std::io::Error::other("a preset of this name already exists");
                SaveError::Unwritable { path, source }
            }
            other => other,
        })?;
        Ok(path)
    }

    fn own_preset_path(&self, name: &str) -> PathBuf {
        self.presets().join(format!("{name}.ron"))
    }
}

/// Checks the name of an own preset.
///
/// # Errors
/// The name has a character that is not allowed, no file on Windows can have it, or a shipped preset has it.
pub fn check_own_name(name: &str) -> Result<(), Invalid> {
    check::name("name", name)?;
    check::no_device("name", name)?;
    if shipped_preset_names().contains(&name) {
        let allowed = "a name that no built-in preset has";
        return Err(Invalid::new("name", format!("{name:?}"), allowed));
    }
    Ok(())
}

fn read_own(path: &Path, name: &str) -> Result<Preset, SaveError> {
    check_own_name(name).map_err(SaveError::invalid(path))?;
    refuse_link(path).map_err(SaveError::unreadable(path))?;
    let text = text_of(path, read_bytes(path, LARGEST_MIB)?)?;
    let preset = parse_preset(path, &text)?;
    // The file's name counts: in a copied file the preset still has the old name.
    Ok(Preset { name: name.to_owned(), ..preset })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::save::load_preset;

    fn own(name: &str) -> Preset {
        Preset { name: name.to_owned(), ..load_preset("ice").expect("shipped") }
    }

    fn saves() -> (tempfile::TempDir, SavesFolder) {
        let folder = tempfile::tempdir().expect("a folder");
        let saves = SavesFolder::find(Some(folder.path()));
        (folder, saves)
    }

    #[test]
    fn an_own_preset_is_read_back_and_never_overwritten() {
        let (_folder, saves) = saves();
        assert!(saves.own_presets().is_empty(), "no folder yet");
        saves.store_own_preset(&own("my-ice")).expect("written");
        let listed = saves.own_presets();
        assert_eq!(listed.len(), 1);
        assert_eq!(listed[0].preset.as_ref().expect("well formed"), &own("my-ice"));
        let taken = saves.store_own_preset(&own("my-ice")).expect_err("taken").to_string();
        assert!(taken.contains("a preset of this name already exists"), "{taken}");
        let device = saves.store_own_preset(&own("com1")).expect_err("refused").to_string();
        assert!(device.contains("a name that Windows does not keep for a device"), "{device}");
    }

    #[test]
    fn a_file_that_took_the_presets_name_is_not_overwritten() {
        let (folder, _saves) = saves();
        let path = folder.path().join("mine.ron");
        fs::write(&path, "another file").expect("written");
        let refused = store_new_preset(&path, &own("mine")).expect_err("taken");
        assert!(refused.to_string().contains("cannot be written"), "{refused}");
        assert_eq!(fs::read_to_string(&path).expect("there"), "another file");
        assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 1, "nothing is left");
    }

    #[test]
    fn a_name_that_is_invalid_or_shipped_is_refused() {
        let (_folder, saves) = saves();
        let long = "x".repeat(300);
        for name in ["a/b", "../up", "", "Ice", long.as_str(), "climb"] {
            let refused = saves.store_own_preset(&own(name)).expect_err("refused").to_string();
            assert!(refused.contains("name is \"") && refused.len() < 300, "{refused}");
        }
        assert!(!saves.presets().exists(), "nothing was written");
    }

    #[test]
    fn a_damaged_preset_is_listed_with_its_error_beside_the_others() {
        let (_folder, saves) = saves();
        saves.store_own_preset(&own("good")).expect("written");
        fs::write(saves.presets().join("broken.ron"), "(name: \"broken\", about").expect("written");
        fs::write(saves.presets().join("Bad Name.ron"), "()").expect("written");
        fs::write(saves.presets().join("notes.txt"), "no preset").expect("written");
        let copy = saves.presets().join("copy.ron");
        fs::copy(saves.presets().join("good.ron"), copy).expect("copied");
        let listed = saves.own_presets();
        let names: Vec<(&str, bool)> =
            listed.iter().map(|own| (own.name.as_str(), own.preset.is_ok())).collect();
        assert_eq!(names, [("Bad Name", false), ("broken", false), ("copy", true), ("good", true)]);
        let reason = listed[1].preset.as_ref().expect_err("damaged");
        assert!(reason.contains("damaged or incomplete at line 1"), "{reason}");
        assert_eq!(listed[2].preset.as_ref().expect("a copy").name, "copy");
    }

    #[cfg(unix)]
    #[test]
    fn a_link_in_the_folder_of_presets_is_not_followed() {
        let (folder, saves) = saves();
        saves.store_own_preset(&own("good")).expect("written");
        let elsewhere = folder.path().join("elsewhere.ron");
        fs::rename(saves.presets().join("good.ron"), &elsewhere).expect("moved");
        std::os::unix::fs::symlink(&elsewhere, saves.presets().join("good.ron")).expect("linked");
        let listed = saves.own_presets();
        let reason = listed[0].preset.as_ref().expect_err("a link");
        assert!(reason.contains("it is a link"), "{reason}");
    }
}
