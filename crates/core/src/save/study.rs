//! Finished runs of a study, as RON, and definitions of studies that users write.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use ron::extensions::Extensions;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};

use super::SaveError;
use super::files::{Header, damaged, parse, read_bytes, read_text, store_ron, text_of};
use crate::check::{Invalid, name, within};
use crate::engine::{ENGINE_VERSION, Engine, Processors};
use crate::evolve::StrategyKind;
use crate::genome::ControllerKind;
use crate::schema::is_default;
use crate::score::{FITNESS_RANGE, Fitness};

const KIND: &str = "snakes-and-stairs study";
const FORMAT: u32 = 1;

/// Maximum number of runs in a file; each takes about 2 kB.
pub const MAX_STUDY_RUNS: usize = 10_000;
/// Maximum size of a file that is read, in MiB.
const LARGEST_MIB: u64 = 64;
/// Maximum number of values of a run, and of numbers in a list.
const MOST_VALUES: usize = 10_000;
/// Range of all measured numbers.
const NUMBERS: std::ops::RangeInclusive<f64> = -1.0e15..=1.0e15;

/// Number of points of a learning curve. The budget is divided into as many equal parts.
pub const CURVE_POINTS: usize = 100;

/// Finished runs of a study.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StudyRuns {
    kind: String,
    format: u32,
    engine: u32,
    #[serde(default, skip_serializing_if = "is_default")]
    processors: Processors,
    /// Name of the study.
    pub study: String,
    /// Arms that have runs, in the order in which they were added.
    pub arms: Vec<StudiedArm>,
}

/// Runs of one arm of a study.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StudiedArm {
    /// Name of the arm.
    pub name: String,
    /// Settings and budget of all runs of the arm.
    pub protocol: Protocol,
    /// Finished runs of the arm, in the order of their seeds.
    pub runs: Vec<StudiedRun>,
}

/// Settings, budget and stop rule of an arm. With a seed they determine a run. An arm continues only under an equal protocol.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Protocol {
    /// Name of the preset from which the settings come.
    pub preset: String,
    /// Fingerprint of the settings: see [`settings_fingerprint`](super::settings_fingerprint).
    pub settings: String,
    /// Search strategy of the arm.
    pub strategy: StrategyKind,
    /// Kind of controller of the arm.
    pub controller: ControllerKind,
    /// Fitness that is maximised.
    pub fitness: Fitness,
    /// Number of evaluations that a run may spend.
    pub budget: u64,
    /// Whether a run ends with the generation in which it reaches the goal.
    #[serde(default, skip_serializing_if = "is_default")]
    pub stops_at_goal: bool,
    /// The settings that differ from the preset's, as text by their dotted names; none in files of earlier versions. Equal fingerprints
    /// make protocols equal without this list.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub changed: Option<BTreeMap<String, String>>,
}

impl PartialEq for Protocol {
    fn eq(&self, other: &Self) -> bool {
        self.settings == other.settings
            && self.budget == other.budget
            && self.stops_at_goal == other.stops_at_goal
    }
}

impl Protocol {
    /// The settings in which `now` differs, in words; the fingerprints if one of the two has no list of its settings.
    pub fn difference(&self, now: &Self) -> String {
        let lists = self.changed.as_ref().zip(now.changed.as_ref());
        let differing = lists.map_or_else(Vec::new, |(before, after)| {
            let value = |of: &Self, list: &BTreeMap<String, String>, name| {
                list.get(name).map_or_else(|| format!("as in {}", of.preset), String::clone)
            };
            let names: BTreeSet<&String> = before.keys().chain(after.keys()).collect();
            let differing = names.into_iter().filter_map(|name| {
                let [before, after] = [value(self, before, name), value(now, after, name)];
                (before != after).then(|| format!("{name} was {before} and is {after}"))
            });
            differing.collect()
        });
        if differing.is_empty() {
            let words = |of: &Self| format!("{} with {} evaluations", of.settings, of.budget);
            return format!("the fingerprint was {} and is {}", words(self), words(now));
        }
        differing.join(", ")
    }
}

/// A finished run of an arm.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StudiedRun {
    /// Seed of the run.
    pub seed: u64,
    /// Measured values by their names. A value that does not exist, such as the first landing of a run without one, is missing.
    pub values: BTreeMap<String, StudyValue>,
    /// Best fitness so far after each hundredth of the budget; empty if it was not recorded.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub curve: Vec<Option<f32>>,
    /// Hash over the generations of the run.
    pub run_hash: String,
}

/// A measured value of a run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum StudyValue {
    /// A single number.
    Number(f64),
    /// A text, such as a joint tree of a creature.
    Text(String),
    /// A list of numbers, such as one for each generation.
    Numbers(Vec<Option<f64>>),
}

impl StudiedRun {
    /// Returns a value that is a number. None if the run has no such value.
    pub fn number(&self, name: &str) -> Option<f64> {
        match self.values.get(name)? {
            StudyValue::Number(number) => Some(*number),
            StudyValue::Text(_) | StudyValue::Numbers(_) => None,
        }
    }

    /// Returns a value that is a list; empty if the run has no such value.
    pub fn numbers(&self, name: &str) -> &[Option<f64>] {
        match self.values.get(name) {
            Some(StudyValue::Numbers(numbers)) => numbers,
            _ => &[],
        }
    }

    fn check(&self) -> Result<(), Invalid> {
        within("number of values", self.values.len(), 0..=MOST_VALUES)?;
        for (name, value) in &self.values {
            match value {
                StudyValue::Number(number) => within(name, *number, NUMBERS)?,
                StudyValue::Text(text) => within(name, text.len(), 0..=1000)?,
                StudyValue::Numbers(numbers) => {
                    within(name, numbers.len(), 0..=MOST_VALUES)?;
                    let mut numbers = numbers.iter().flatten();
                    numbers.try_for_each(|number| within(name, *number, NUMBERS))?;
                }
            }
        }
        if !self.curve.is_empty() {
            within("curve", self.curve.len(), CURVE_POINTS..=CURVE_POINTS)?;
        }
        self.curve.iter().flatten().try_for_each(|&fitness| within("curve", fitness, FITNESS_RANGE))
    }
}

impl StudyRuns {
    /// Makes a study without runs.
    pub fn new(study: &str) -> Self {
        Self {
            kind: KIND.to_owned(),
            format: FORMAT,
            engine: ENGINE_VERSION,
            processors: Processors::THIS,
            study: study.to_owned(),
            arms: Vec::new(),
        }
    }

    /// Returns an arm. None if it has no runs.
    pub fn arm(&self, name: &str) -> Option<&StudiedArm> {
        self.arms.iter().find(|arm| arm.name == name)
    }

    /// Returns the runs of an arm, in the order of their seeds.
    pub fn of_arm(&self, name: &str) -> &[StudiedRun] {
        self.arm(name).map_or(&[], |arm| &arm.runs)
    }

    /// Inserts a run in the order of the seeds, in place of an earlier run with the same seed. Earlier runs of the arm under another
    /// protocol are removed.
    pub fn add(&mut self, name: &str, protocol: &Protocol, run: StudiedRun) {
        let place = self.arms.iter().position(|arm| arm.name == name).unwrap_or_else(|| {
            let (name, protocol) = (name.to_owned(), protocol.clone());
            self.arms.push(StudiedArm { name, protocol, runs: Vec::new() });
            self.arms.len() - 1
        });
        let arm = &mut self.arms[place];
        if arm.protocol != *protocol {
            (arm.protocol, arm.runs) = (protocol.clone(), Vec::new());
        }
        arm.runs.retain(|earlier| earlier.seed != run.seed);
        arm.runs.push(run);
        arm.runs.sort_by_key(|run| run.seed);
    }

    fn check(&self) -> Result<(), Invalid> {
        Engine { version: self.engine, processors: self.processors }.check_this()?;
        name("study", &self.study)?;
        within("runs", self.arms.iter().map(|arm| arm.runs.len()).sum(), 0..=MAX_STUDY_RUNS)?;
        for arm in &self.arms {
            name("arm", &arm.name)?;
            arm.runs.iter().try_for_each(StudiedRun::check)?;
        }
        Ok(())
    }
}

/// Reads the runs of a study.
///
/// # Errors
/// Fails if the file is unreadable, damaged, of another kind, format or engine, or has a value out of range.
pub fn load_study(path: &Path) -> Result<StudyRuns, SaveError> {
    let text = text_of(path, read_bytes(path, LARGEST_MIB)?)?;
    Header::check(path, &text, KIND, FORMAT)?;
    let runs: StudyRuns = parse(path, &text)?;
    runs.check().map_err(SaveError::invalid(path))?;
    Ok(runs)
}

/// Writes the runs of a study atomically.
///
/// # Errors
/// Fails if the file cannot be written.
pub fn store_study(path: &Path, runs: &StudyRuns) -> Result<(), SaveError> {
    store_ron(path, runs)
}

/// Reads the definition of a study that a user wrote. Optional values need no `Some`.
///
/// # Errors
/// Fails if the file is unreadable, or is not RON of the type `T`.
pub fn load_definition<T: DeserializeOwned>(path: &Path) -> Result<T, SaveError> {
    parse_definition(path, &read_text(path)?)
}

/// Parses the definition of a study; errors name the file `path`.
///
/// # Errors
/// Fails if the text is not RON of the type `T`.
pub fn parse_definition<T: DeserializeOwned>(path: &Path, text: &str) -> Result<T, SaveError> {
    let options = ron::Options::default().with_default_extension(Extensions::IMPLICIT_SOME);
    options.from_str(text).map_err(|error| damaged(path, error))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    fn protocol(settings: &str) -> Protocol {
        Protocol {
            preset: "climb".to_owned(),
            settings: settings.to_owned(),
            strategy: StrategyKind::CmaEs,
            controller: ControllerKind::Gait,
            fitness: Fitness::Climb,
            budget: 64,
            stops_at_goal: false,
            changed: None,
        }
    }

    fn run(seed: u64) -> StudiedRun {
        let values = [
            ("fitness", StudyValue::Number(6.5)),
            ("steps_climbed", StudyValue::Number(2.0)),
            ("tree", StudyValue::Text("O(U)".to_owned())),
            ("generation_means", StudyValue::Numbers(vec![Some(1.5), None, Some(2.0)])),
        ];
        StudiedRun {
            seed,
            values: values.map(|(name, value)| (name.to_owned(), value)).into(),
            curve: vec![Some(1.0); CURVE_POINTS],
            run_hash: "0".repeat(16),
        }
    }

    #[test]
    fn runs_are_kept_by_seed_and_a_new_protocol_replaces_those_of_the_old_one() {
        let mut runs = StudyRuns::new("test");
        for seed in [3, 1, 2, 1] {
            runs.add("a", &protocol("x"), run(seed));
        }
        let seeds = |runs: &StudyRuns| -> Vec<u64> {
            runs.of_arm("a").iter().map(|run| run.seed).collect()
        };
        assert_eq!(seeds(&runs), [1, 2, 3]);
        runs.add("b", &protocol("x"), run(4));
        runs.add("a", &protocol("y"), run(9));
        assert_eq!((seeds(&runs), runs.arms.len()), (vec![9], 2));
        assert!(runs.of_arm("c").is_empty());
    }

    #[test]
    fn a_file_is_read_back_and_one_with_values_out_of_range_refused_by_their_names() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("study.ron");
        let mut runs = StudyRuns::new("test");
        runs.add("xcs", &protocol("x"), run(1));
        store_study(&path, &runs).expect("written");
        assert_eq!(load_study(&path).expect("read"), runs);
        let text = fs::read_to_string(&path).expect("read");
        for (from, to, message) in [
            ("\"fitness\": 6.5", "\"fitness\": NaN", "fitness is NaN; allowed: "),
            ("\"steps_climbed\": 2.0", "\"steps_climbed\": 1e300", "steps_climbed is 1"),
            ("\"xcs\"", "\"../xcs\"", "arm is \"../xcs\"; allowed: "),
            ("stairs study\"", "stairs comparison\"", "kind is"),
        ] {
            assert!(text.contains(from), "{from}: {text}");
            fs::write(&path, text.replace(from, to)).expect("written");
            let refusal = load_study(&path).expect_err("refused").to_string();
            assert!(refusal.contains(message), "{refusal}");
        }
    }
}
