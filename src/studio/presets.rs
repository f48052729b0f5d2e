//! The presets that can be chosen: those that come with the program, and a person's own.

use crate::evolve::Settings;
use crate::save::{Preset, SavesFolder, shipped_presets};

/// What is known of all presets.
#[derive(Debug, Default)]
pub(super) struct Presets {
    shipped: Vec<Preset>,
    own: Vec<OwnPreset>,
}

/// One of a person's own presets.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct OwnPreset {
    /// The name of its file.
    pub name: String,
    /// The preset, or what is wrong with its file.
    pub preset: Result<Preset, String>,
}

impl Presets {
    /// Reads them all. Own ones that are damaged are among them, with the reason.
    pub fn read(saves: &SavesFolder) -> Self {
        let own = saves.own_presets().into_iter().map(|own| OwnPreset {
            name: own.name,
            preset: own.preset.map_err(|error| error.to_string()),
        });
        // The shipped presets are well formed; a test holds them to it.
        Self { shipped: shipped_presets().unwrap_or_default(), own: own.collect() }
    }

    /// Those that come with the program, the default first.
    pub fn shipped(&self) -> &[Preset] {
        &self.shipped
    }

    /// A person's own, by name.
    pub fn own(&self) -> &[OwnPreset] {
        &self.own
    }

    /// The preset of a name, if it is known.
    ///
    /// # Errors
    /// It is known, and damaged: the reason.
    pub fn find(&self, name: &str) -> Result<Option<&Preset>, String> {
        if let Some(shipped) = self.shipped.iter().find(|preset| preset.name == name) {
            return Ok(Some(shipped));
        }
        let own = self.own.iter().find(|own| own.name == name);
        own.map(|own| own.preset.as_ref().map_err(Clone::clone)).transpose()
    }

    /// The settings of the preset of a name, if it is known and in order.
    pub fn settings_of(&self, name: &str) -> Option<&Settings> {
        self.find(name).ok().flatten().map(|preset| &preset.settings)
    }

    /// Whether a preset, damaged or not, has this name.
    pub fn has(&self, name: &str) -> bool {
        self.find(name) != Ok(None)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn own_presets_are_found_beside_the_shipped_and_damaged_ones_say_why() {
        let folder = tempfile::tempdir().expect("a folder");
        let saves = SavesFolder::find(Some(folder.path()));
        let shipped = Presets::read(&saves);
        assert!(shipped.own().is_empty() && shipped.has("ice") && !shipped.has("my-ice"));
        let ice = shipped.find("ice").expect("in order").expect("shipped").clone();
        let mine = Preset { name: "my-ice".to_owned(), ..ice };
        saves.store_own_preset(&mine).expect("written");
        std::fs::write(saves.presets().join("torn.ron"), "(name:").expect("written");
        let presets = Presets::read(&saves);
        assert_eq!(presets.settings_of("my-ice"), Some(&mine.settings));
        assert!(presets.has("torn") && presets.settings_of("torn").is_none());
        let reason = presets.find("torn").expect_err("damaged");
        assert!(reason.contains("damaged or incomplete"), "{reason}");
        assert_eq!(presets.find("nobody"), Ok(None));
    }
}
