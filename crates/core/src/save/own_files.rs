//! The user's own presets and stairs, which are also built into the program. Each of these kinds of files has a folder within the saves; a
//! file is named after its content.

use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use super::files::{embedded_names, read_bytes, read_text, refuse_link, text_of};
use super::whole_file::{prepare_folder, write_new};
use super::{Preset, SaveError, SavesFolder};
use crate::check::{self, Invalid};
use crate::evolve::Settings;

/// A kind of named file with built-in examples, of which users make their own.
pub trait OwnKind: Clone {
    /// Name of the folder for own files of this kind, within the saves.
    const FOLDER: &'static str;
    /// Word for a file of this kind in messages, such as "preset".
    const WORD: &'static str;
    /// Name of the field and flag that select a file of this kind, such as "preset".
    const FIELD: &'static str;

    /// Names and texts of the built-in files.
    const EMBEDDED: &'static [(&'static str, &'static str)];

    /// Parses the built-in files.
    ///
    /// # Errors
    /// Fails if an embedded file is damaged, which a test prevents.
    fn built_in() -> Result<Vec<Self>, SaveError> {
        Self::EMBEDDED.iter().map(|(file, text)| Self::parse(Path::new(file), text)).collect()
    }

    /// Returns the names of the built-in files.
    fn built_in_names() -> Vec<&'static str> {
        embedded_names(Self::EMBEDDED)
    }

    /// Returns the name of the file.
    fn name(&self) -> &str;
    /// Returns this file under another name.
    #[must_use]
    fn renamed(self, name: &str) -> Self;
    /// Parses a file; errors name the file `path`.
    ///
    /// # Errors
    /// Fails if the text is damaged, or if a value in it is not allowed.
    fn parse(path: &Path, text: &str) -> Result<Self, SaveError>;
    /// Returns the text of the file; errors name the file `path`.
    ///
    /// # Errors
    /// Fails if the content cannot be written as text.
    fn text(&self, path: &Path) -> Result<String, SaveError>;
}

/// Loads a file by the name of a built-in file, or by a path.
///
/// # Errors
/// Fails if no built-in file has the name and no file the path, or if a value in the file is not allowed.
pub(super) fn load_named<T: OwnKind>(name_or_path: &str) -> Result<T, SaveError> {
    let built_in = T::built_in()?.into_iter().find(|of| of.name() == name_or_path);
    let path = Path::new(name_or_path);
    match built_in {
        Some(built_in) => Ok(built_in),
        None if path.exists() || path.is_symlink() => T::parse(path, &read_text(path)?),
        None => {
            let allowed = format!("{}, or a file", T::built_in_names().join(", "));
            let unknown = Invalid::new(T::FIELD, format!("{name_or_path:?}"), allowed);
            Err(SaveError::Unknown(unknown))
        }
    }
}

/// A file in the folder of the user's own files of a kind.
#[derive(Debug, Clone, PartialEq)]
pub struct OwnFile<T> {
    /// Name of the file without its ending.
    pub name: String,
    /// Content under the name of the file, or the error in one line.
    pub content: Result<T, String>,
}

/// Maximum number of own files of a kind that are listed.
const MAX_OWN_FILES: usize = 200;
/// Maximum size of an own file, in MiB; a built-in file has about 3 KiB.
const LARGEST_MIB: u64 = 1;

impl SavesFolder {
    /// Returns the folder for the user's own files of a kind.
    #[must_use]
    pub fn own_folder<T: OwnKind>(&self) -> PathBuf {
        self.path().join(T::FOLDER)
    }

    /// Returns the names of all of the user's own files of a kind, sorted; empty if their folder does not exist.
    fn own_names<T: OwnKind>(&self) -> Vec<String> {
        let Ok(entries) = fs::read_dir(self.own_folder::<T>()) else { return Vec::new() };
        let mut names: Vec<String> = entries
            .flatten()
            .filter_map(|entry| Some(entry.file_name().to_str()?.strip_suffix(".ron")?.to_owned()))
            // The names of incomplete files begin with a dot.
            .filter(|name| !name.starts_with('.'))
            .collect();
        names.sort();
        names
    }

    /// Reads the first `MAX_OWN_FILES` of the user's own files of a kind by name, damaged ones included.
    pub fn own_files<T: OwnKind>(&self) -> Vec<OwnFile<T>> {
        let names = self.own_names::<T>().into_iter().take(MAX_OWN_FILES);
        let read = |name: String| {
            let content = read_own(&self.own_path::<T>(&name), &name);
            OwnFile { name, content: content.map_err(|error| error.to_string()) }
        };
        names.map(read).collect()
    }

    /// Adds a file to the user's own files. Never overwrites a file.
    ///
    /// # Errors
    /// Fails if the name is not allowed or is taken, or if the file cannot be written.
    pub fn store_own<T: OwnKind>(&self, own: &T) -> Result<PathBuf, SaveError> {
        let path = self.own_path::<T>(own.name());
        let invalid = |source| SaveError::Invalid { path: self.own_folder::<T>(), source };
        check_own_name::<T>(own.name()).map_err(invalid)?;
        prepare_folder(&self.own_folder::<T>())?;
        // Only the writing itself checks that the name is free, because another program may take the name at any time.
        write_new(&path, own.text(&path)?.as_bytes()).map_err(|error| match error {
            SaveError::Unwritable { path, source } if source.kind() == ErrorKind::AlreadyExists => {
                let reason = format!("a file of {} with this name already exists", T::FOLDER);
                SaveError::Unwritable { path, source: std::io::Error::other(reason) }
            }
            other => other,
        })?;
        Ok(path)
    }

    fn own_path<T: OwnKind>(&self, name: &str) -> PathBuf {
        self.own_folder::<T>().join(format!("{name}.ron"))
    }
}

/// Checks the name of an own file.
///
/// # Errors
/// Fails if the name has a character that is not allowed, if no file on Windows can have it, or if a built-in file has it.
pub fn check_own_name<T: OwnKind>(name: &str) -> Result<(), Invalid> {
    check::name("name", name)?;
    check::no_device("name", name)?;
    if T::built_in_names().contains(&name) {
        let allowed = format!("a name that no built-in {} has", T::WORD);
        return Err(Invalid::new("name", format!("{name:?}"), allowed));
    }
    Ok(())
}

fn read_own<T: OwnKind>(path: &Path, name: &str) -> Result<T, SaveError> {
    check_own_name::<T>(name).map_err(SaveError::invalid(path))?;
    refuse_link(path).map_err(SaveError::unreadable(path))?;
    let text = text_of(path, read_bytes(path, LARGEST_MIB)?)?;
    // The file is known by its own name, because a copied file still has the old name in its content.
    Ok(T::parse(path, &text)?.renamed(name))
}

/// All files of a kind that can be chosen: the built-in files and the user's own.
#[derive(Debug)]
pub struct KnownFiles<T> {
    built_in: Vec<T>,
    own: Vec<OwnFile<T>>,
    /// Names of all own files, including those beyond the listed number.
    own_names: Vec<String>,
}

impl<T: OwnKind> KnownFiles<T> {
    /// Reads all files of a kind; damaged own files are included with their errors.
    pub fn read(saves: &SavesFolder) -> Self {
        // The built-in files are well-formed; tests check this.
        Self {
            built_in: T::built_in().unwrap_or_default(),
            own: saves.own_files(),
            own_names: saves.own_names::<T>(),
        }
    }

    /// Returns the built-in files, in their order.
    pub fn built_in(&self) -> &[T] {
        &self.built_in
    }

    /// Returns the listed own files, in the order of their names.
    pub fn own(&self) -> &[OwnFile<T>] {
        &self.own
    }

    /// Returns the file with a name. None if no listed file has it.
    ///
    /// # Errors
    /// Describes the damage in one line, if the file is damaged.
    pub fn find(&self, name: &str) -> Result<Option<&T>, String> {
        if let Some(built_in) = self.built_in.iter().find(|of| of.name() == name) {
            return Ok(Some(built_in));
        }
        let own = self.own.iter().find(|own| own.name == name);
        own.map(|own| own.content.as_ref().map_err(Clone::clone)).transpose()
    }

    /// Returns whether a file, damaged or not, has the name.
    pub fn has(&self, name: &str) -> bool {
        !matches!(self.find(name), Ok(None)) || self.own_names.iter().any(|own| own == name)
    }

    /// Describes the problem with a name for a new file in a sentence. None if the name is allowed and free.
    pub fn problem_with(&self, name: &str) -> Option<String> {
        if self.has(name) {
            return Some(format!(
                "A {} named {name} already exists; choose another name.",
                T::WORD
            ));
        }
        check_own_name::<T>(name).err().map(|invalid| {
            let start: String = name.chars().take(30).collect();
            let rest = if name.chars().count() > 30 { "…" } else { "" };
            format!("The name is \"{start}{rest}\"; allowed: {}.", invalid.allowed)
        })
    }

    /// Returns a free name for a copy: "my-ice", then "my-ice-2" and so on.
    pub fn name_for_copy(&self, copied: &str) -> String {
        let is_plain = |c: &char| c.is_ascii_lowercase() || c.is_ascii_digit() || *c == '-';
        let plain: String = copied.chars().filter(is_plain).collect();
        let own = if plain.is_empty() { T::WORD } else { plain.trim_start_matches("my-") };
        self.numbered_if_taken(&format!("my-{own}"))
    }

    /// Returns an allowed and free name that is similar to `wanted`: "my-ice-1-2" for "My ice: 1/2".
    pub fn allowed_name(&self, wanted: &str) -> String {
        let wanted = wanted.to_ascii_lowercase();
        let words =
            wanted.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty());
        let plain = words.collect::<Vec<&str>>().join("-");
        self.numbered_if_taken(&if plain.is_empty() { format!("my-{}", T::WORD) } else { plain })
    }

    /// Returns the name if it is free, otherwise the name with the first free number.
    fn numbered_if_taken(&self, name: &str) -> String {
        let start: String = name.chars().take(36).collect();
        let numbered = (2..1000).map(|number| format!("{start}-{number}"));
        let mut names = std::iter::once(start.clone()).chain(numbered);
        names.find(|name| self.problem_with(name).is_none()).unwrap_or_default()
    }
}

impl KnownFiles<Preset> {
    /// Returns the settings of the preset with a name. None if it does not exist or is damaged.
    pub fn settings_of(&self, name: &str) -> Option<&Settings> {
        self.find(name).ok().flatten().map(|preset| &preset.settings)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::save::library::fixtures::saves;
    use crate::save::{NamedStairs, load_preset, load_stairs};

    fn preset(name: &str) -> Preset {
        load_preset("ice").expect("built in").renamed(name)
    }

    fn stairs(name: &str) -> NamedStairs {
        load_stairs("ramps").expect("built in").renamed(name)
    }

    fn is_read_back_and_never_overwritten<T: OwnKind + PartialEq + std::fmt::Debug>(own: &T) {
        let (_folder, saves) = saves();
        assert!(saves.own_files::<T>().is_empty(), "no folder yet");
        saves.store_own(own).expect("written");
        let listed = saves.own_files::<T>();
        assert_eq!(listed.len(), 1);
        assert_eq!(listed[0].content.as_ref().expect("well formed"), own);
        let taken = saves.store_own(own).expect_err("taken").to_string();
        let expected = format!("a file of {} with this name already exists", T::FOLDER);
        assert!(taken.contains(&expected), "{taken}");
        let device = saves.store_own(&own.clone().renamed("com1")).expect_err("refused");
        assert!(
            device.to_string().contains("a name that Windows does not keep for a device"),
            "{device}"
        );
    }

    #[test]
    fn own_files_are_read_back_and_never_overwritten() {
        is_read_back_and_never_overwritten(&preset("my-ice"));
        is_read_back_and_never_overwritten(&stairs("my-ramps"));
    }

    #[test]
    fn a_file_that_took_the_name_is_not_overwritten() {
        let (_folder, saves) = saves();
        let folder = saves.own_folder::<Preset>();
        fs::create_dir_all(&folder).expect("created");
        fs::write(folder.join("mine.ron"), "another file").expect("written");
        let refused = saves.store_own(&preset("mine")).expect_err("taken");
        assert!(refused.to_string().contains("cannot be written"), "{refused}");
        assert_eq!(fs::read_to_string(folder.join("mine.ron")).expect("there"), "another file");
        assert_eq!(fs::read_dir(folder).expect("a folder").count(), 1, "nothing is left");
    }

    #[test]
    fn a_name_that_is_invalid_or_built_in_is_refused() {
        let (_folder, saves) = saves();
        let long = "x".repeat(300);
        for name in ["a/b", "../up", "", "Ice", long.as_str(), "climb"] {
            let refused = saves.store_own(&preset(name)).expect_err("refused").to_string();
            assert!(refused.contains("name is \"") && refused.len() < 300, "{refused}");
        }
        let refused = saves.store_own(&stairs("house")).expect_err("refused").to_string();
        assert!(refused.contains("a name that no built-in staircase has"), "{refused}");
        assert!(!saves.path().join("presets").exists(), "nothing was written");
        assert!(!saves.path().join("stairs").exists(), "nothing was written");
    }

    #[test]
    fn a_damaged_file_is_listed_with_its_error_beside_the_others() {
        let (_folder, saves) = saves();
        saves.store_own(&preset("good")).expect("written");
        let folder = saves.own_folder::<Preset>();
        fs::write(folder.join("broken.ron"), "(name: \"broken\", about").expect("written");
        fs::write(folder.join("Bad Name.ron"), "()").expect("written");
        fs::write(folder.join("notes.txt"), "no preset").expect("written");
        fs::copy(folder.join("good.ron"), folder.join("copy.ron")).expect("copied");
        let listed = saves.own_files::<Preset>();
        let names: Vec<(&str, bool)> =
            listed.iter().map(|own| (own.name.as_str(), own.content.is_ok())).collect();
        assert_eq!(names, [("Bad Name", false), ("broken", false), ("copy", true), ("good", true)]);
        let reason = listed[1].content.as_ref().expect_err("damaged");
        assert!(reason.contains("damaged or incomplete at line 1"), "{reason}");
        assert_eq!(listed[2].content.as_ref().expect("a copy").name, "copy");
    }

    #[test]
    fn own_files_are_found_beside_the_built_in_ones_and_damaged_ones_give_their_error() {
        let (_folder, saves) = saves();
        let built_in = KnownFiles::<NamedStairs>::read(&saves);
        assert!(built_in.own().is_empty() && built_in.has("house") && !built_in.has("mine"));
        saves.store_own(&stairs("mine")).expect("written");
        fs::write(saves.own_folder::<NamedStairs>().join("torn.ron"), "(kind:").expect("written");
        let known = KnownFiles::read(&saves);
        assert_eq!(known.find("mine"), Ok(Some(&stairs("mine"))));
        assert!(known.has("torn"));
        let error = known.find("torn").expect_err("damaged");
        assert!(error.contains("damaged or incomplete"), "{error}");
        assert_eq!(known.find("missing"), Ok(None));
    }

    #[test]
    fn files_beyond_those_that_are_listed_keep_their_names() {
        let (_folder, saves) = saves();
        let folder = saves.own_folder::<NamedStairs>();
        fs::create_dir_all(&folder).expect("created");
        for number in 0..MAX_OWN_FILES {
            fs::write(folder.join(format!("a{number}.ron")), "").expect("written");
        }
        saves.store_own(&stairs("z")).expect("written");
        let known = KnownFiles::<NamedStairs>::read(&saves);
        assert_eq!((known.own().len(), known.find("z")), (MAX_OWN_FILES, Ok(None)));
        assert_eq!(known.allowed_name("z"), "z-2");
    }

    #[test]
    fn a_suggested_name_is_allowed_and_free() {
        let (_folder, saves) = saves();
        let name = |copied: &str| KnownFiles::<Preset>::read(&saves).name_for_copy(copied);
        assert_eq!((name("ice"), name("my-ice")), ("my-ice".to_owned(), "my-ice".to_owned()));
        saves.store_own(&preset("my-ice")).expect("written");
        assert_eq!((name("ice"), name("my-ice")), ("my-ice-2".to_owned(), "my-ice-2".to_owned()));
        for odd in ["", "Größe 1/2", &"x".repeat(90)] {
            assert_eq!(check_own_name::<Preset>(&name(odd)), Ok(()), "{odd}");
        }
        let known = KnownFiles::<Preset>::read(&saves);
        assert_eq!(known.allowed_name("ÄÖ/!"), "my-preset");
        assert_eq!(known.allowed_name("My ice: 1/2"), "my-ice-1-2");
        assert_eq!(known.allowed_name("Ice"), "ice-2", "the program has an ice");
        let stairs = KnownFiles::<NamedStairs>::read(&saves);
        assert_eq!(stairs.allowed_name("House"), "house-2");
    }

    #[cfg(unix)]
    #[test]
    fn a_link_in_the_folder_of_own_files_is_not_followed() {
        let (folder, saves) = saves();
        saves.store_own(&preset("good")).expect("written");
        let (elsewhere, own) = (folder.path().join("elsewhere.ron"), saves.own_folder::<Preset>());
        fs::rename(own.join("good.ron"), &elsewhere).expect("moved");
        std::os::unix::fs::symlink(&elsewhere, own.join("good.ron")).expect("linked");
        let listed = saves.own_files::<Preset>();
        let reason = listed[0].content.as_ref().expect_err("a link");
        assert!(reason.contains("it is a link"), "{reason}");
    }
}
