//! Presets: named, explained settings, as RON. The shipped ones are embedded in the program.

use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

use super::SaveError;
use super::files::{parse, pretty, read_text, store_ron, write_new};
use super::settings::{SettingsV1, SettingsV2};
use crate::check::{self, Invalid, within};
use crate::evolve::Settings;

/// Named, explained settings.
#[derive(Debug, Clone, PartialEq)]
pub struct Preset {
    /// A short name, for the command line and for file names.
    pub name: String,
    /// A paragraph for a person.
    pub about: String,
    /// All settings.
    pub settings: Settings,
}

/// A preset's file: of format 1 or 2, which differ in their settings. Never changed once released.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct PresetFile<S> {
    /// People write presets by hand: one that does not say its format has the first.
    #[serde(default = "first_format")]
    format: u32,
    name: String,
    about: String,
    settings: S,
}

const FORMAT: u32 = 2;

fn first_format() -> u32 {
    1
}

/// The preset used when none is named.
pub const DEFAULT_PRESET: &str = "climb";

/// Lists the shipped presets by their file names.
macro_rules! shipped {
    ($($name:literal),* $(,)?) => {
        &[$((
            concat!($name, ".ron"),
            include_str!(concat!("../../assets/presets/", $name, ".ron")),
        )),*]
    };
}

const SHIPPED: &[(&str, &str)] = shipped![
    "climb",
    "report",
    "steady",
    "quick",
    "panda-manual",
    "ice",
    "rubber",
    "moon",
    "mud",
    "trampoline",
];

/// The presets that come with the program, the default first.
///
/// # Errors
/// An embedded preset is broken, which a test rules out.
pub fn shipped_presets() -> Result<Vec<Preset>, SaveError> {
    SHIPPED.iter().map(|(file, text)| parse_preset(Path::new(file), text)).collect()
}

/// Loads a preset by the name of a shipped one, or by the path of a person's own file.
///
/// # Errors
/// There is no such preset or file, or something in it is not allowed.
pub fn load_preset(name_or_path: &str) -> Result<Preset, SaveError> {
    let shipped = shipped_presets()?;
    if let Some(preset) = shipped.iter().find(|preset| preset.name == name_or_path) {
        return Ok(preset.clone());
    }
    let path = PathBuf::from(name_or_path);
    if path.exists() {
        return parse_preset(&path, &read_text(&path)?);
    }
    let names: Vec<&str> = shipped.iter().map(|preset| preset.name.as_str()).collect();
    let allowed = format!("{}, or a file", names.join(", "));
    Err(SaveError::UnknownPreset(Invalid::new("preset", format!("{name_or_path:?}"), allowed)))
}

/// Writes a preset so that a person can read and change it, whole or not at all.
///
/// # Errors
/// The file cannot be written.
pub fn store_preset(path: &Path, preset: &Preset) -> Result<(), SaveError> {
    store_ron(path, &file_of(preset))
}

/// The same where there is no file of that name yet: what has taken the name meanwhile stays.
///
/// # Errors
/// There is one, or the file cannot be written.
pub fn store_new_preset(path: &Path, preset: &Preset) -> Result<(), SaveError> {
    write_new(path, pretty(path, &file_of(preset))?.as_bytes())
}

fn file_of(preset: &Preset) -> PresetFile<SettingsV2> {
    let Preset { name, about, settings } = preset.clone();
    PresetFile { format: FORMAT, name, about, settings: SettingsV2::from(settings) }
}

/// Reads a preset from a text; `path` is what errors call it.
///
/// # Errors
/// It is damaged, or something in it is not allowed.
pub fn parse_preset(path: &Path, text: &str) -> Result<Preset, SaveError> {
    #[derive(Deserialize)]
    struct Format {
        #[serde(default = "first_format")]
        format: u32,
        /// Saves and runs have one.
        kind: Option<String>,
    }
    let invalid = |source| SaveError::Invalid { path: path.to_owned(), source };
    let Format { format, kind } = parse(path, text)?;
    if let Some(kind) = kind {
        let start: String = kind.chars().take(60).collect();
        return Err(invalid(Invalid::new("kind", format!("{start:?}"), "none: it is no preset")));
    }
    let PresetFile { name, about, settings, .. } = match format {
        1 => {
            let PresetFile { format, name, about, settings }: PresetFile<SettingsV1> =
                parse(path, text)?;
            PresetFile { format, name, about, settings: SettingsV2::from(settings) }
        }
        FORMAT => parse(path, text)?,
        0 => return Err(invalid(Invalid::new("format", 0, format!("1 to {FORMAT}")))),
        found => {
            return Err(SaveError::Newer { path: path.to_owned(), found, newest: FORMAT });
        }
    };
    let preset = Preset { name, about, settings: settings.into() };
    check::name("name", &preset.name).map_err(invalid)?;
    within("about", preset.about.len(), 0..=LONGEST_ABOUT).map_err(invalid)?;
    preset.settings.check().map_err(invalid)?;
    Ok(preset)
}

/// The longest explanation of a preset, in bytes.
const LONGEST_ABOUT: usize = 10_000;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::rng::{Purpose, stream};
    use crate::score::evaluate;

    #[test]
    fn the_shipped_presets_are_well_formed_and_the_default_is_first() {
        let presets = shipped_presets().expect("the embedded presets are well formed");
        assert_eq!(presets[0].name, DEFAULT_PRESET);
        for (preset, (file, _)) in presets.iter().zip(SHIPPED) {
            assert_eq!(format!("{}.ron", preset.name), *file);
            assert!(preset.about.len() > 60, "{file} has no paragraph for a person");
        }
    }

    #[test]
    fn the_report_preset_keeps_what_the_report_states() {
        let report = load_preset("report").expect("it is shipped").settings;
        assert_eq!(report.evolution, Default::default());
        assert_eq!(report.trial.stairs, Default::default());
        assert_eq!(report.trial.start_y_m, -7.23);
        assert_eq!(report.genome.torque_range_nm, 1000.0);
        assert_eq!(report.genome.torque_step_nm, 1000.0);
        assert_eq!(report.genome.bend_limits_rad, [0.6, 0.8, 1.0, 1.8]);
        assert_eq!(report.genome.twist_limits_rad, [0.0, 0.9, 1.2, 1.5]);
    }

    #[test]
    fn every_preset_lets_one_genome_go_another_way() {
        let presets = shipped_presets().expect("well formed");
        let report = &load_preset("report").expect("shipped").settings;
        let mut rng = stream(1, 1, 0, Purpose::Birth);
        let genome = report.genome.birth(report.trial.descent(), &mut rng);
        // `quick` has the world of the report, and only evolves for a shorter time.
        let worlds = presets.iter().filter(|preset| preset.name != "quick");
        let mut traces: Vec<u64> =
            worlds.map(|preset| evaluate(&genome, &preset.settings.trial).trace_hash).collect();
        let worlds = traces.len();
        traces.sort_unstable();
        traces.dedup();
        assert_eq!(traces.len(), worlds);
    }

    #[test]
    fn a_preset_comes_back_from_its_file() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("own.ron");
        let mut preset = load_preset("ice").expect("it is shipped");
        preset.settings.trial.ground = Some(Default::default());
        store_preset(&path, &preset).expect("written");
        assert_eq!(load_preset(&path.to_string_lossy()).expect("read"), preset);
    }

    #[test]
    fn an_unknown_preset_lists_the_known_ones() {
        let error = load_preset("repotr").unwrap_err().to_string();
        assert!(
            error.starts_with("preset is \"repotr\"; allowed: climb, report, steady, quick,"),
            "{error}"
        );
    }
}
