//! Files of staircases: named and described, as RON. The built-in stairs are embedded in the program.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::SaveError;
use super::files::{Header, embedded, parse, pretty};
use super::own_files::{OwnKind, load_named};
use crate::check::{self, Invalid, quoted, within};
use crate::schema;
use crate::world::Stairs;

/// A staircase with a name and a description.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedStairs {
    /// Short name for the command line and for file names.
    pub name: String,
    /// Sentence that describes the staircase.
    pub about: String,
    /// Shape of the staircase.
    pub stairs: Stairs,
}

/// Contents of the file, whose kind and format are checked before. Once released, this struct never changes.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct StairsFile {
    kind: String,
    format: u32,
    name: String,
    about: String,
    stairs: Stairs,
}

const KIND: &str = "snakes-and-stairs stairs";
const FORMAT: u32 = 1;
/// Maximum length of a description, in bytes.
const MAX_ABOUT_BYTES: usize = 2_000;

const BUILT_IN: &[(&str, &str)] = embedded!["stairs";
    "house",
    "public",
    "garden",
    "irregular",
    "nosing",
    "landing",
    "missing-step",
    "ramps",
    "over-the-top",
];

/// Parses the built-in stairs.
///
/// # Errors
/// Fails if an embedded file is damaged, which a test prevents.
pub fn built_in_stairs() -> Result<Vec<NamedStairs>, SaveError> {
    NamedStairs::built_in()
}

/// Returns the names of the built-in stairs.
pub fn built_in_stairs_names() -> Vec<&'static str> {
    NamedStairs::built_in_names()
}

/// Loads stairs by the name of built-in stairs, or by the path of a file.
///
/// # Errors
/// Fails if no stairs and no file have the name, or if a value in the file is not allowed.
pub fn load_stairs(name_or_path: &str) -> Result<NamedStairs, SaveError> {
    load_named(name_or_path)
}

/// Returns whether a text, perhaps damaged, states the kind of a file of stairs.
pub fn is_stairs_file(text: &str) -> bool {
    Header::kind_of(text).is_some_and(|kind| kind == KIND)
}

impl OwnKind for NamedStairs {
    const FOLDER: &'static str = "stairs";
    const WORD: &'static str = "staircase";
    const FIELD: &'static str = "stairs";
    const EMBEDDED: &'static [(&'static str, &'static str)] = BUILT_IN;

    fn name(&self) -> &str {
        &self.name
    }

    fn renamed(self, name: &str) -> Self {
        Self { name: name.to_owned(), ..self }
    }

    fn parse(path: &Path, text: &str) -> Result<Self, SaveError> {
        parse_stairs(path, text)
    }

    fn text(&self, path: &Path) -> Result<String, SaveError> {
        let Self { name, about, stairs } = self.clone();
        pretty(path, &StairsFile { kind: KIND.to_owned(), format: FORMAT, name, about, stairs })
    }
}

/// Parses stairs; errors name the file `path`.
///
/// # Errors
/// Fails if the text is damaged, or if a value in it is not allowed.
pub fn parse_stairs(path: &Path, text: &str) -> Result<NamedStairs, SaveError> {
    Header::check(path, text, KIND, FORMAT)?;
    let StairsFile { name, about, stairs, .. } = parse(path, text)?;
    let invalid = SaveError::invalid(path);
    check::name("name", &name).map_err(invalid)?;
    within("about", about.len(), 0..=MAX_ABOUT_BYTES).map_err(invalid)?;
    if about.contains(char::is_control) {
        let allowed = "a text without line breaks and control characters";
        return Err(invalid(Invalid::new("about", quoted(&about), allowed)));
    }
    schema::check(&stairs).map_err(|error| invalid(error.inside("stairs")))?;
    Ok(NamedStairs { name, about, stairs })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::genome::StairsGenome;

    #[test]
    fn the_built_in_stairs_are_well_formed() {
        let all = built_in_stairs().expect("well formed");
        for (stairs, (file, _)) in all.iter().zip(BUILT_IN) {
            assert_eq!(format!("{}.ron", stairs.name), *file);
            assert!(stairs.about.len() > 40, "{file} has no description");
        }
    }

    /// The built-in stairs with features must be equal to the stairs that genomes build, so that, for example, a missing step means the
    /// same in the two.
    #[test]
    fn built_in_stairs_with_features_are_those_of_their_genome() {
        let plain = || StairsGenome { steps: 8, ..StairsGenome::default() };
        for (name, genome) in [
            ("landing", StairsGenome { steps: 10, landing: 5, ..plain() }),
            ("missing-step", StairsGenome { missing: 4, ..plain() }),
            ("ramps", StairsGenome { ramp: 1.0, ..plain() }),
            ("over-the-top", StairsGenome { landing: 4, down: 4, ..plain() }),
        ] {
            let built = load_stairs(name).expect("built in").stairs;
            let landing_m = built.landing_m;
            assert_eq!(built, Stairs { landing_m, ..genome.stairs() }, "{name}");
        }
    }

    #[test]
    fn stairs_are_read_from_a_file_of_the_user() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("own.ron");
        std::fs::write(&path, BUILT_IN[0].1.replace("\"house\"", "\"own\"")).expect("written");
        let own = load_stairs(&path.to_string_lossy()).expect("read");
        assert_eq!((own.name.as_str(), own.stairs.steps), ("own", 10));
    }

    #[test]
    fn stairs_that_cannot_be_built_are_refused_in_one_line() {
        let text = BUILT_IN[0].1;
        for (from, to, message) in [
            ("steps: 10", "steps: 1000000", "stairs.steps is 1000000; allowed: 0 to 100"),
            (
                "rise_m: 0.5",
                "rise_m: -0.5",
                "stairs.rise_m of step 1 is -0.5; allowed: a rise that ends",
            ),
            ("rise_m: 0.5", "rise_m: 0.0", "stairs.rise_m is 0; allowed: -5 to -0.01 or 0.01 to 5"),
            (
                "rise_m: 0.5",
                "rise_m: NaN",
                "stairs.rise_m is NaN; allowed: -5 to -0.01 or 0.01 to 5",
            ),
            ("tread_m: 0.8", "tread_m: 0.000001", "stairs.tread_m is 0.000001; allowed: 0.1 to 20"),
            ("tread_m: 0.8", "tread_m: [1.0, 2.0]", "stairs.tread_m is "),
            (
                "steps: 10",
                "steps: 10, nosing_m: 0.41",
                "stairs.nosing_m is 0.41; allowed: 0 to 0.3",
            ),
            (
                "steps: 10",
                "steps: 10, slope_m: 0.8",
                "stairs.slope_m of step 1 is 0.8; allowed: 0, or 0.01 m to 0.55",
            ),
            ("snakes-and-stairs stairs", "snakes preset", "kind is "),
            ("format: 1", "format: 9", "format"),
        ] {
            assert!(text.contains(from), "{from}");
            let error = parse_stairs(Path::new("x"), &text.replacen(from, to, 1));
            let said = error.expect_err(to).to_string();
            assert!(said.contains(message) && !said.contains('\n'), "{to}: {said}");
        }
        let unknown = load_stairs("escalator").expect_err("unknown").to_string();
        assert!(unknown.contains("house, public, garden"), "{unknown}");
    }
}
