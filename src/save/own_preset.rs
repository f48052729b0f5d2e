//! A person's own presets: files in the folder `presets` within the saves, named after their presets.

use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use super::files::{prepare_folder, read_bytes, refuse_link, text_of};
use super::preset::{Preset, parse_preset, shipped_presets, store_new_preset};
use super::{SaveError, SavesFolder};
use crate::check::{self, Invalid};

/// A file that should be a person's own preset.
#[derive(Debug)]
pub struct OwnPreset {
    /// The file's name without its ending.
    pub name: String,
    /// What is in it, under that name; or what is wrong with it.
    pub preset: Result<Preset, SaveError>,
}

/// More than so many of a person's own presets are not listed: nobody would find one among them.
const MOST_OWN_PRESETS: usize = 200;
/// The largest preset of a person's own, in MiB: a shipped one has some 3 KiB.
const LARGEST_MIB: u64 = 1;

impl SavesFolder {
    /// The folder in it for a person's own presets.
    #[must_use]
    pub fn presets(&self) -> PathBuf {
        self.path().join("presets")
    }

    /// A person's own presets by name, the damaged ones too; nothing if there is no folder of them.
    pub fn own_presets(&self) -> Vec<OwnPreset> {
        let Ok(entries) = fs::read_dir(self.presets()) else { return Vec::new() };
        let mut names: Vec<String> = entries
            .flatten()
            .filter_map(|entry| Some(entry.file_name().to_str()?.strip_suffix(".ron")?.to_owned()))
            // What is half written begins with a point.
            .filter(|name| !name.starts_with('.'))
            .collect();
        names.sort();
        names.truncate(MOST_OWN_PRESETS);
        let read = |name: String| {
            let preset = read_own(&self.own_preset_path(&name), &name);
            OwnPreset { name, preset }
        };
        names.into_iter().map(read).collect()
    }

    /// Keeps a preset among a person's own. What is there under its name stays there.
    ///
    /// # Errors
    /// The name cannot be that of a file, or is taken; or the file cannot be written.
    pub fn store_own_preset(&self, preset: &Preset) -> Result<PathBuf, SaveError> {
        let path = self.own_preset_path(&preset.name);
        let invalid = |source| SaveError::Invalid { path: self.presets(), source };
        check_own_name(&preset.name).map_err(invalid)?;
        prepare_folder(&self.presets())?;
        // Whether the name is free is asked by the writing itself: another program may take it at any time.
        store_new_preset(&path, preset).map_err(|error| match error {
            SaveError::Unwritable { path, source } if source.kind() == ErrorKind::AlreadyExists => {
                let source = std::io::Error::other("there is a preset of that name already");
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

/// Accepts what a person may call a preset: a plain name that no shipped one has.
///
/// # Errors
/// It is not plain, or taken.
pub fn check_own_name(name: &str) -> Result<(), Invalid> {
    check::name("name", name)?;
    let shipped = shipped_presets().unwrap_or_default();
    if shipped.iter().any(|preset| preset.name == name) {
        let allowed = "a name that no preset of the program has";
        return Err(Invalid::new("name", format!("{name:?}"), allowed));
    }
    Ok(())
}

fn read_own(path: &Path, name: &str) -> Result<Preset, SaveError> {
    let invalid = |source| SaveError::Invalid { path: path.to_owned(), source };
    check_own_name(name).map_err(invalid)?;
    refuse_link(path).map_err(|source| SaveError::Unreadable { path: path.to_owned(), source })?;
    let text = text_of(path, read_bytes(path, LARGEST_MIB)?)?;
    let preset = parse_preset(path, &text)?;
    // A copy by hand has a new name outside and the old one inside.
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
    fn an_own_preset_comes_back_and_is_never_overwritten() {
        let (_folder, saves) = saves();
        assert!(saves.own_presets().is_empty(), "no folder yet");
        saves.store_own_preset(&own("my-ice")).expect("written");
        let listed = saves.own_presets();
        assert_eq!(listed.len(), 1);
        assert_eq!(listed[0].preset.as_ref().expect("well formed"), &own("my-ice"));
        let taken = saves.store_own_preset(&own("my-ice")).expect_err("taken").to_string();
        assert!(taken.contains("there is a preset of that name already"), "{taken}");
    }

    #[test]
    fn what_took_a_presets_name_a_moment_before_stays() {
        let (folder, _saves) = saves();
        let path = folder.path().join("mine.ron");
        fs::write(&path, "somebody else's").expect("written");
        let refused = store_new_preset(&path, &own("mine")).expect_err("taken");
        assert!(refused.to_string().contains("cannot be written"), "{refused}");
        assert_eq!(fs::read_to_string(&path).expect("there"), "somebody else's");
        assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 1, "nothing is left");
    }

    #[test]
    fn a_name_that_is_none_or_is_shipped_is_refused() {
        let (_folder, saves) = saves();
        let long = "x".repeat(300);
        for name in ["a/b", "../up", "", "Ice", long.as_str(), "climb"] {
            let refused = saves.store_own_preset(&own(name)).expect_err("refused").to_string();
            assert!(refused.contains("name is \"") && refused.len() < 300, "{refused}");
        }
        assert!(!saves.presets().exists(), "nothing was written");
    }

    #[test]
    fn a_damaged_preset_is_listed_with_its_reason_and_stops_no_other() {
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
        let reason = listed[1].preset.as_ref().expect_err("damaged").to_string();
        assert!(reason.contains("damaged or incomplete at line 1"), "{reason}");
        assert_eq!(listed[2].preset.as_ref().expect("a copy").name, "copy");
    }

    #[cfg(unix)]
    #[test]
    fn a_link_among_own_presets_is_not_followed() {
        let (folder, saves) = saves();
        saves.store_own_preset(&own("good")).expect("written");
        let elsewhere = folder.path().join("elsewhere.ron");
        fs::rename(saves.presets().join("good.ron"), &elsewhere).expect("moved");
        std::os::unix::fs::symlink(&elsewhere, saves.presets().join("good.ron")).expect("linked");
        let listed = saves.own_presets();
        let reason = listed[0].preset.as_ref().expect_err("a link").to_string();
        assert!(reason.contains("it is a link"), "{reason}");
    }
}
