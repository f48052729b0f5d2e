//! The presets that can be chosen: the shipped ones and the user's own.

use super::{OwnPreset, Preset, SavesFolder, shipped_presets};
use crate::evolve::Settings;

/// All presets that can be chosen.
#[derive(Debug, Default)]
pub struct PresetList {
    shipped: Vec<Preset>,
    own: Vec<OwnPreset>,
}

impl PresetList {
    /// Reads all presets; damaged own ones are included with their errors.
    pub fn read(saves: &SavesFolder) -> Self {
        // The shipped presets are well-formed; a test checks this.
        Self { shipped: shipped_presets().unwrap_or_default(), own: saves.own_presets() }
    }

    /// The shipped presets, the default first.
    pub fn shipped(&self) -> &[Preset] {
        &self.shipped
    }

    /// The user's own presets, by name.
    pub fn own(&self) -> &[OwnPreset] {
        &self.own
    }

    /// The preset with this name, if there is one.
    ///
    /// # Errors
    /// It is damaged: the error in one line.
    pub fn find(&self, name: &str) -> Result<Option<&Preset>, String> {
        if let Some(shipped) = self.shipped.iter().find(|preset| preset.name == name) {
            return Ok(Some(shipped));
        }
        let own = self.own.iter().find(|own| own.name == name);
        own.map(|own| own.preset.as_ref().map_err(Clone::clone)).transpose()
    }

    /// The settings of the preset with this name, if there is one and it is not damaged.
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
    fn own_presets_are_found_beside_the_shipped_ones_and_damaged_ones_give_their_error() {
        let folder = tempfile::tempdir().expect("a folder");
        let saves = SavesFolder::find(Some(folder.path()));
        let shipped = PresetList::read(&saves);
        assert!(shipped.own().is_empty() && shipped.has("ice") && !shipped.has("my-ice"));
        let ice = shipped.find("ice").expect("well-formed").expect("shipped").clone();
        let mine = Preset { name: "my-ice".to_owned(), ..ice };
        saves.store_own_preset(&mine).expect("written");
        std::fs::write(saves.presets().join("torn.ron"), "(name:").expect("written");
        let presets = PresetList::read(&saves);
        assert_eq!(presets.settings_of("my-ice"), Some(&mine.settings));
        assert!(presets.has("torn") && presets.settings_of("torn").is_none());
        let error = presets.find("torn").expect_err("damaged");
        assert!(error.contains("damaged or incomplete"), "{error}");
        assert_eq!(presets.find("missing"), Ok(None));
    }
}
