//! Presets: named and described settings, as RON. The shipped presets are embedded in the program.

use serde::{Deserialize, Serialize};
use std::path::Path;

use super::files::{check_format, embedded, parse, pretty, store_ron};
use super::own_files::{OwnKind, load_named};
use super::{SaveError, engine_2};
use crate::check::{self, Invalid, quoted, within};
use crate::evolve::{RunPlan, Settings, changes_in_words};

/// Settings with a name and a description.
#[derive(Debug, Clone, PartialEq)]
pub struct Preset {
    /// Short name for the command line and for file names.
    pub name: String,
    /// Paragraph that describes the preset.
    pub about: String,
    /// All settings of the preset.
    pub settings: Settings,
}

/// Contents of the file. Once released, this struct never changes: see `super::v5`.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct PresetFile {
    format: u32,
    name: String,
    about: String,
    settings: Settings,
}

/// Number of the format. Format 2 differs in the numbers of the world: see [`super::engine_2`].
const FORMAT: u32 = 3;

/// Name of the preset that is used when none is named.
pub const DEFAULT_PRESET: &str = "climb";

const SHIPPED: &[(&str, &str)] = embedded!["presets";
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
    "thick-air",
    "senses",
    "mixed-stairs",
    "q-learning",
    "xcs",
    "zcs",
    "waves-by-rules",
    "limb-neurons",
    "neat",
    "bodies",
    "squishy",
    "creatures",
    "house",
    "ladder",
    "poet",
    "generalist",
];

/// Parses the shipped presets, the default first.
///
/// # Errors
/// Fails if an embedded preset is damaged, which a test prevents.
pub fn shipped_presets() -> Result<Vec<Preset>, SaveError> {
    Preset::built_in()
}

/// Returns the names of the shipped presets, the default first.
pub fn shipped_preset_names() -> Vec<&'static str> {
    Preset::built_in_names()
}

/// Loads a preset by the name of a shipped preset, or by the path of a file.
///
/// # Errors
/// Fails if no preset and no file have the name, or if a value in the file is not allowed.
pub fn load_preset(name_or_path: &str) -> Result<Preset, SaveError> {
    load_named(name_or_path)
}

/// Describes the settings of a run in a few words: the name of its preset and, if that is a shipped one, what differs from it, as in
/// "climb, friction 0.5".
pub fn settings_in_words(plan: &RunPlan) -> String {
    let of_preset = |(file, _): &&(&str, &str)| file.strip_suffix(".ron") == Some(&plan.preset);
    let shipped = SHIPPED.iter().find(of_preset);
    let preset = shipped.and_then(|(file, text)| parse_preset(Path::new(file), text).ok());
    let changes = preset.map(|preset| changes_in_words(&preset.settings, &plan.settings));
    match changes.filter(|changes| !changes.is_empty()) {
        Some(changes) => format!("{}, {changes}", plan.preset),
        None => plan.preset.clone(),
    }
}

/// Writes a preset as readable text, atomically.
///
/// # Errors
/// Fails if the file cannot be written.
pub fn store_preset(path: &Path, preset: &Preset) -> Result<(), SaveError> {
    store_ron(path, &file_of(preset))
}

impl OwnKind for Preset {
    const FOLDER: &'static str = "presets";
    const WORD: &'static str = "preset";
    const FIELD: &'static str = "preset";
    const EMBEDDED: &'static [(&'static str, &'static str)] = SHIPPED;

    fn name(&self) -> &str {
        &self.name
    }

    fn renamed(self, name: &str) -> Self {
        Self { name: name.to_owned(), ..self }
    }

    fn parse(path: &Path, text: &str) -> Result<Self, SaveError> {
        parse_preset(path, text)
    }

    fn text(&self, path: &Path) -> Result<String, SaveError> {
        pretty(path, &file_of(self))
    }
}

fn file_of(preset: &Preset) -> PresetFile {
    let Preset { name, about, settings } = preset.clone();
    PresetFile { format: FORMAT, name, about, settings }
}

/// Parses a preset; errors name the file `path`.
///
/// # Errors
/// Fails if the text is damaged, or if a value in it is not allowed.
pub fn parse_preset(path: &Path, text: &str) -> Result<Preset, SaveError> {
    #[derive(Deserialize)]
    struct PresetHeader {
        #[serde(default)]
        format: u32,
        /// Kind of the file. Champions and runs state a kind, presets do not.
        kind: Option<String>,
    }
    let invalid = SaveError::invalid(path);
    let PresetHeader { format, kind } = parse(path, text)?;
    if let Some(kind) = kind {
        let allowed = "none; this file is not a preset";
        return Err(invalid(Invalid::new("kind", quoted(&kind), allowed)));
    }
    if format != 2 {
        check_format(path, format, FORMAT)?;
    }
    let PresetFile { name, about, mut settings, .. } = parse(path, text)?;
    if format == 2 {
        settings = engine_2::converted_settings(settings);
    }
    let preset = Preset { name, about, settings };
    check::name("name", &preset.name).map_err(invalid)?;
    within("about", preset.about.len(), 0..=MAX_ABOUT_BYTES).map_err(invalid)?;
    preset.settings.check().map_err(invalid)?;
    Ok(preset)
}

/// Maximum length of a preset's description, in bytes.
const MAX_ABOUT_BYTES: usize = 10_000;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evolve::{EvolutionSettings, with_fields};
    use crate::rng::{Purpose, stream};
    use crate::score::{Fitness, Repeats, Trial, evaluate};
    use crate::world::{PhysicsEngine, Stairs};

    #[test]
    fn a12_a_run_is_named_after_its_preset_and_what_differs_from_it() {
        let named = |preset: &str, fields: &[(&str, &str)]| {
            let settings = load_preset("climb").expect("shipped").settings;
            let settings = with_fields(&settings, fields.iter().copied()).expect("allowed");
            settings_in_words(&RunPlan::new(preset, 1, settings))
        };
        assert_eq!(named("climb", &[]), "climb");
        assert_eq!(named("climb", &[("surface.friction", "0.5")]), "climb, friction 0.5");
        assert_eq!(named("my-own", &[("surface.friction", "0.5")]), "my-own");
    }

    #[test]
    fn the_shipped_presets_are_well_formed_and_the_default_is_first() {
        let presets = shipped_presets().expect("the embedded presets are well formed");
        assert_eq!(presets[0].name, DEFAULT_PRESET);
        for (preset, (file, _)) in presets.iter().zip(SHIPPED) {
            assert_eq!(format!("{}.ron", preset.name), *file);
            assert!(preset.about.len() > 60, "{file} has no description");
        }
    }

    #[test]
    fn the_report_preset_keeps_what_the_report_states() {
        let report = load_preset("report").expect("it is shipped").settings;
        // The report states 500 to 1,000 snakes per generation.
        let stated = EvolutionSettings { population: 1000, ..Default::default() };
        assert_eq!(report.evolution, stated);
        assert_eq!(report.trial.stairs, Default::default());
        assert_eq!(report.trial.start_y_m, -7.23);
        assert_eq!(report.genome.torque_range_nm, 1000.0);
        assert_eq!(report.genome.torque_step_nm, 1000.0);
        assert_eq!(report.genome.bend_limits_rad, [0.6, 0.8, 1.0, 1.8]);
        assert_eq!(report.genome.twist_limits_rad, [0.0, 0.9, 1.2, 1.5]);
    }

    #[test]
    fn one_genome_moves_differently_in_every_preset() {
        let presets = shipped_presets().expect("well formed");
        let report = &load_preset("report").expect("shipped").settings;
        let mut rng = stream(1, 1, 0, Purpose::Birth);
        let genome = report.genome.random_genome(report.trial.genome_shape(), &mut rng);
        // Some presets differ only in controller, search and reward: `quick` has the world of `report`.
        let mut worlds: Vec<Trial> = Vec::new();
        for preset in presets {
            let (repeats, fitness) = (Repeats::default(), Fitness::default());
            // Stairs are left out, because the genome does not come far enough to tell them apart.
            let stairs = Stairs::default();
            let mut trial = Trial { repeats, fitness, stairs, ..preset.settings.trial };
            // The engine is left out as well: in presets that differ only in the engine, the genome stays in the air and moves alike.
            trial.physics.engine = PhysicsEngine::Rapier;
            if !worlds.contains(&trial) {
                worlds.push(trial);
            }
        }
        assert!(worlds.len() >= 10);
        let mut traces: Vec<u64> =
            worlds.iter().map(|trial| evaluate(&genome, trial).trace_hash).collect();
        let worlds = traces.len();
        traces.sort_unstable();
        traces.dedup();
        assert_eq!(traces.len(), worlds);
    }

    #[test]
    fn a_preset_is_read_back_from_its_file() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("own.ron");
        let mut preset = load_preset("ice").expect("it is shipped");
        preset.settings.trial.ground = Some(Default::default());
        store_preset(&path, &preset).expect("written");
        assert_eq!(load_preset(&path.to_string_lossy()).expect("read"), preset);
    }

    #[test]
    fn a_preset_of_format_2_drives_twists_in_the_range_of_bends() {
        let (_, shipped) = SHIPPED[0];
        let text = shipped.replacen("format: 3", "format: 2", 1).replace("iterations: 4, ", "");
        let is_new = |line: &&str| line.contains("twist_range_rad");
        assert_eq!(text.lines().filter(is_new).count(), 1);
        let lines: Vec<&str> = text.lines().filter(|line| !is_new(line)).collect();
        let settings = parse_preset(Path::new("own.ron"), &lines.join("\n"));
        let Settings { trial, genome: space, .. } = settings.expect("well formed").settings;
        assert_eq!(space.wave.twist_range_rad, space.wave.angle_range_rad);
        assert_eq!(trial.physics.iterations, 1);
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
