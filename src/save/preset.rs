//! Presets: named, explained settings, as RON. The shipped ones are embedded in the program.

use ron::ser::PrettyConfig;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

use super::SaveError;
use super::files::{parse, read_text, write_whole};
use crate::check::Invalid;
use crate::evolve::Settings;

/// A preset as its file holds it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Preset {
    /// A short name, for the command line and for file names.
    pub name: String,
    /// A paragraph for a person.
    pub about: String,
    /// All settings.
    pub settings: Settings,
}

/// The preset used when none is named.
pub const DEFAULT_PRESET: &str = "report";

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
    SHIPPED.iter().map(|(file, text)| read(Path::new(file), text)).collect()
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
        return read(&path, &read_text(&path)?);
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
    let layout = PrettyConfig::new().compact_arrays(true).struct_names(false);
    let text = ron::ser::to_string_pretty(preset, layout).map_err(|error| {
        SaveError::Unwritable { path: path.to_owned(), source: std::io::Error::other(error) }
    })?;
    write_whole(path, format!("{text}\n").as_bytes())
}

fn read(path: &Path, text: &str) -> Result<Preset, SaveError> {
    let preset: Preset = parse(path, text)?;
    let checked = check_name(&preset.name).and_then(|()| preset.settings.check());
    checked.map_err(|source| SaveError::Invalid { path: path.to_owned(), source })?;
    Ok(preset)
}

/// A preset's name becomes part of file names.
fn check_name(name: &str) -> Result<(), Invalid> {
    let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
    if (1..=40).contains(&name.len()) && name.chars().all(plain) {
        Ok(())
    } else {
        let allowed = "1 to 40 of a-z, 0-9 and -";
        Err(Invalid::new("name", format!("{name:?}"), allowed))
    }
}

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
        let report = &presets[0].settings;
        let mut rng = stream(1, 1, 0, Purpose::Birth);
        let genome = report.genome.birth(4, report.trial.duration_s, &mut rng);
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
            error.starts_with("preset is \"repotr\"; allowed: report, steady, quick,"),
            "{error}"
        );
    }
}
