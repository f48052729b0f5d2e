//! The finished runs of `snakes families`, as RON: `families.ron`. The champions are in files of their own.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::SaveError;
use super::files::{Header, parse, read_bytes, store_ron, text_of};
use crate::check::{Invalid, name, within};
use crate::engine::{ENGINE_VERSION, Engine, Processors};
use crate::genome::MOST_LIBRARY_WAVES;
use crate::schema::is_default;
use crate::score::FITNESS_RANGE;

const KIND: &str = "snakes-and-stairs families";
const FORMAT: u32 = 1;

/// Maximum number of runs in the file; each takes about 500 bytes.
pub const MAX_FAMILY_RUNS: usize = 10_000;
/// Maximum size of a file that is read, in MiB.
const LARGEST_MIB: u64 = 64;
/// Maximum number of rules that a champion may have.
const MOST_RULES: u32 = 1_000_000;

/// The runs of several families.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FamilyRuns {
    kind: String,
    format: u32,
    engine: u32,
    #[serde(default, skip_serializing_if = "is_default")]
    processors: Processors,
    /// The families, in the order of their names.
    pub families: Vec<TrainedFamily>,
}

/// The runs of one family.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrainedFamily {
    /// What all its runs have in common.
    pub protocol: FamilyProtocol,
    /// Its finished runs, in the order of their seeds.
    pub runs: Vec<FamilyRun>,
}

/// What decides the runs of a family, apart from their seeds. A family continues only under the same protocol.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FamilyProtocol {
    /// Name of the family.
    pub family: String,
    /// Fingerprint of its settings.
    pub settings: String,
    /// Whether a run ends with the generation that first lands.
    pub stops_at_landing: bool,
}

/// One run of a family.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FamilyRun {
    /// The seed.
    pub seed: u64,
    /// Number of evaluations that it spent.
    pub evaluations: u32,
    /// The number of the first evaluation, counted from 1, that ended on the landing.
    pub first_landing: Option<u32>,
    /// Its champion; none if all were disqualified.
    pub champion: Option<FamilyChampion>,
    /// Hash over the run.
    pub run_hash: String,
}

/// The champion of a run, in its own trial.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FamilyChampion {
    /// Its fitness.
    pub fitness: f32,
    /// Steps that its middle limb had climbed at the end.
    pub steps_climbed: u32,
    /// Whether it ended on the landing.
    pub has_landed: bool,
    /// For a controller that chooses among waves: the share of its decisions for each.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub wave_shares: Vec<f32>,
    /// For a controller that decides by rules: how it used them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rules: Option<RuleUse>,
}

/// How a champion used its rules in its own trial.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RuleUse {
    /// Number of its rules.
    pub count: u32,
    /// Share of its decisions that the twenty rules made that made most.
    pub share_of_twenty: f32,
}

impl FamilyRuns {
    /// No runs yet.
    pub fn new() -> Self {
        Self {
            kind: KIND.to_owned(),
            format: FORMAT,
            engine: ENGINE_VERSION,
            processors: Processors::THIS,
            families: Vec::new(),
        }
    }

    /// The runs of the family with this name, if it has any.
    pub fn family(&self, name: &str) -> Option<&TrainedFamily> {
        self.families.iter().find(|trained| trained.protocol.family == name)
    }

    /// Inserts a run in the order of the seeds, in the place of an earlier one with its seed.
    pub fn add(&mut self, protocol: &FamilyProtocol, run: FamilyRun) {
        let same = |trained: &TrainedFamily| trained.protocol == *protocol;
        let place = self.families.iter().position(same).unwrap_or_else(|| {
            self.families.retain(|trained| trained.protocol.family != protocol.family);
            let protocol = protocol.clone();
            let after = |trained: &TrainedFamily| trained.protocol.family < protocol.family;
            let place = self.families.partition_point(after);
            self.families.insert(place, TrainedFamily { protocol, runs: Vec::new() });
            place
        });
        let runs = &mut self.families[place].runs;
        runs.retain(|earlier| earlier.seed != run.seed);
        runs.push(run);
        runs.sort_by_key(|run| run.seed);
    }

    fn check(&self) -> Result<(), Invalid> {
        Engine { version: self.engine, processors: self.processors }.check_this()?;
        let runs = || self.families.iter().flat_map(|trained| &trained.runs);
        within("runs", runs().count(), 0..=MAX_FAMILY_RUNS)?;
        for trained in &self.families {
            name("family", &trained.protocol.family)?;
        }
        for champion in runs().filter_map(|run| run.champion.as_ref()) {
            within("fitness", champion.fitness, FITNESS_RANGE)?;
            within("number of wave_shares", champion.wave_shares.len(), 0..=MOST_LIBRARY_WAVES)?;
            for share in &champion.wave_shares {
                within("wave_shares", *share, 0.0..=1.0)?;
            }
            if let Some(rules) = champion.rules {
                within("rules.count", rules.count, 0..=MOST_RULES)?;
                within("rules.share_of_twenty", rules.share_of_twenty, 0.0..=1.0)?;
            }
        }
        Ok(())
    }
}

impl Default for FamilyRuns {
    fn default() -> Self {
        Self::new()
    }
}

/// Reads the runs of families.
///
/// # Errors
/// The file is unreadable, damaged, of another kind, format or engine, or has a value out of range.
pub fn load_families(path: &Path) -> Result<FamilyRuns, SaveError> {
    let text = text_of(path, read_bytes(path, LARGEST_MIB)?)?;
    Header::check(path, &text, KIND, FORMAT)?;
    let runs: FamilyRuns = parse(path, &text)?;
    runs.check().map_err(SaveError::invalid(path))?;
    Ok(runs)
}

/// Writes the runs of families, atomically.
///
/// # Errors
/// The file cannot be written.
pub fn store_families(path: &Path, runs: &FamilyRuns) -> Result<(), SaveError> {
    store_ron(path, runs)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    fn protocol(settings: &str) -> FamilyProtocol {
        let (family, settings) = ("xcs".to_owned(), settings.to_owned());
        FamilyProtocol { family, settings, stops_at_landing: false }
    }

    fn run(seed: u64) -> FamilyRun {
        let rules = Some(RuleUse { count: 7, share_of_twenty: 1.0 });
        let champion = FamilyChampion {
            fitness: 6.5,
            steps_climbed: 2,
            has_landed: false,
            wave_shares: vec![0.25, 0.75],
            rules,
        };
        let (evaluations, run_hash) = (64, "0".repeat(16));
        FamilyRun { seed, evaluations, first_landing: None, champion: Some(champion), run_hash }
    }

    #[test]
    fn runs_are_kept_by_seed_and_a_new_protocol_replaces_those_of_the_old_one() {
        let mut runs = FamilyRuns::new();
        for seed in [3, 1, 2, 1] {
            runs.add(&protocol("a"), run(seed));
        }
        let seeds = |runs: &FamilyRuns| -> Vec<u64> {
            runs.family("xcs").expect("trained").runs.iter().map(|run| run.seed).collect()
        };
        assert_eq!(seeds(&runs), [1, 2, 3]);
        runs.add(&protocol("b"), run(9));
        assert_eq!((seeds(&runs), runs.families.len()), (vec![9], 1));
        assert_eq!(runs.family("zcs"), None);
    }

    #[test]
    fn a_file_is_read_back_and_one_with_values_out_of_range_refused_by_their_names() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("families.ron");
        let mut runs = FamilyRuns::new();
        runs.add(&protocol("a"), run(1));
        store_families(&path, &runs).expect("written");
        assert_eq!(load_families(&path).expect("read"), runs);
        let text = fs::read_to_string(&path).expect("read");
        for (from, to, message) in [
            ("fitness: 6.5", "fitness: NaN", "fitness is NaN; allowed: "),
            ("share_of_twenty: 1.0", "share_of_twenty: 1.5", "share_of_twenty is 1.5; allowed: 0"),
            ("0.25", "-0.25", "wave_shares is -0.25; allowed: 0 to 1"),
            ("count: 7", "count: 4000000000", "rules.count is 4000000000; allowed: 0 to 1000000"),
            ("\"xcs\"", "\"../xcs\"", "family is \"../xcs\"; allowed: "),
            ("families\",", "comparison\",", "kind is"),
        ] {
            assert!(text.contains(from), "{from}: {text}");
            fs::write(&path, text.replace(from, to)).expect("written");
            let refusal = load_families(&path).expect_err("refused").to_string();
            assert!(refusal.contains(message), "{refusal}");
        }
    }
}
